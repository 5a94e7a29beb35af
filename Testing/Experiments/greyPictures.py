# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures in grey levels from 0 to 1, rows from the top: rendered, put side by side, written as PNG."""
import os

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, registers the factory

GREYS = 48  # levels of a picture: few, so that noise compresses


def pixels_of(window):
    """Rows from the bottom, columns, red, green and blue as bytes."""
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    width, height = window.GetSize()
    return vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(height, width, 3)


def render(mapper, size, position=None, up=(0, 1, 0), zoom=1.0):
    """Seen from a position towards the middle, lit; without one flat, from above, as high as the picture."""
    actor, renderer, window = vtkActor(), vtkRenderer(), vtkRenderWindow()
    actor.SetMapper(mapper)
    renderer.AddActor(actor)
    renderer.SetBackground(1, 1, 1)
    camera = renderer.GetActiveCamera()
    if position:
        actor.GetProperty().SetAmbient(0.35)
        actor.GetProperty().SetDiffuse(0.7)
        camera.SetPosition(*position)
    else:
        actor.GetProperty().LightingOff()
        camera.ParallelProjectionOn()
    camera.SetViewUp(*up)
    renderer.ResetCamera()
    if not position:
        bounds = mapper.GetBounds()
        camera.SetParallelScale(0.5 * (bounds[3] - bounds[2]))
    camera.Zoom(zoom)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(4)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    return pixels_of(window)[::-1, :, 0] / 255.0


def beside(pictures, gap=6):
    """Pictures in a row, white between them."""
    row = [pictures[0]]
    for picture in pictures[1:]:
        row += [numpy.ones((picture.shape[0], gap)), picture]
    return numpy.hstack(row)


def write(folder, name, values):
    levels = numpy.round(numpy.clip(values, 0.0, 1.0) * (GREYS - 1)) * (255.0 / (GREYS - 1))
    image = vtkImageData()
    image.SetDimensions(values.shape[1], values.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(levels[::-1].astype(numpy.uint8).ravel(), deep=True))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetInputData(image)
    path = os.path.join(folder, name)
    writer.SetFileName(path)
    writer.Write()
    print("%-28s %4d kB" % (name, os.path.getsize(path) // 1000))
