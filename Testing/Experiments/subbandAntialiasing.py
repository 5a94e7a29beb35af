# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's Fig. 8 on the screen: how far antialiased noise is from supersampled noise; the table in
Documentation/subband-noise.md.

pvpython subbandAntialiasing.py [FOLDER for pictures]

Needs the module steerablenoise on PYTHONPATH and a display of 2560 x 1920 pixels. Two scenes of 320 x 240 pixels: a square of
texture on a trapezoid with sheared sides, seen from far, and a plane up to the horizon. The reference is the noise at 8 x 8 places of
each pixel, weighted by a Gaussian with a deviation of one pixel (paper, equation 4), or by a box of a pixel. Beside the mapper's
noise without and with antialiasing stands the same noise as an image of 2048^2 texels, by OpenGL's mip maps and its anisotropic
filter with 16 samples.
"""
import sys

import numpy
from greyPictures import pixels_of, write
from steerablenoise import vtkPolyDataSubbandNoise, vtkSubbandNoiseMapper
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkObject, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTexture
import vtkmodules.vtkRenderingOpenGL2

vtkObject.GlobalWarningDisplayOff()  # of weights that are not from the surface they are on

WIDTH, HEIGHT, FINER, TEXELS = 320, 240, 8, 2048


def sheet(side, place, repeats):
    """A grid of `side`^2 points at place(u, v), with texture coordinates up to `repeats`."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, side), numpy.linspace(0, 1, side))
    u, v = u.ravel(), v.ravel()
    mesh, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(numpy.stack(place(u, v), axis=1), deep=True))
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i
            for triangle in ((a, a + 1, a + side + 1), (a, a + side + 1, a + side)):
                cells.InsertNextCell(3, triangle)
    texture = numpy_to_vtk(repeats * numpy.stack((u, v), axis=1), deep=True)
    texture.SetName("uv")
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    mesh.GetPointData().SetTCoords(texture)
    return mesh


class Scene:
    def __init__(self, mapper, look, size):
        self.mapper, self.actor, self.renderer, self.window = mapper, vtkActor(), vtkRenderer(), vtkRenderWindow()
        self.actor.SetMapper(mapper)
        self.actor.GetProperty().LightingOff()
        self.renderer.AddActor(self.actor)
        self.renderer.SetBackground(1, 1, 1)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(*size)
        self.window.AddRenderer(self.renderer)
        look(self.renderer)
        self.renderer.ResetCameraClippingRange()

    def bytes(self):
        return pixels_of(self.window).astype(int)

    def noise(self):
        """NaN where there is none."""
        self.mapper.OutputValueOn()
        rgb = self.bytes()
        value = rgb[..., 0] * 65536 + rgb[..., 1] * 256 + rgb[..., 2]
        return numpy.where((value == 0) | (value == 0xFFFFFF), numpy.nan, value / 16777215.0 * 16.0 - 8.0)


def noise_mapper(mesh, wavelength, fades):
    mapper = vtkSubbandNoiseMapper()
    mapper.SetInputDataObject(mesh)
    mapper.ScalarVisibilityOff()
    mapper.SetWavelength(wavelength)
    mapper.SetParameterization(vtkPolyDataSubbandNoise.TEXTURE_COORDINATES)
    mapper.SetAntiAlias(fades)
    return mapper


def look_at_square(renderer):
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.5, 0.5, 1)
    camera.SetFocalPoint(0.5, 0.5, 0)
    camera.SetParallelScale(0.5)


def bake(mesh, side, shown, wavelength):
    """The noise of a mesh over one repeat of its texture, as a texture of 8 bits from -4 to 4."""
    scene = Scene(shown, look_at_square, (16, 16))
    scene.window.Render()
    weights = vtkPolyDataSubbandNoise()
    weights.SetInputData(mesh)
    weights.SetWavelength(wavelength)
    weights.SetParameterization(vtkPolyDataSubbandNoise.TEXTURE_COORDINATES)
    weights.SetTileSize(shown.GetTileSize())
    weights.WeightsOnlyOn()
    weights.Update()
    flat = sheet(side, lambda u, v: (u, v, 0 * u), 1.0)
    flat.GetPointData().AddArray(weights.GetOutput().GetPointData().GetArray("SubbandWeights"))
    mapper = noise_mapper(flat, wavelength, False)
    mapper.SetInputArrayToProcess(1, 0, 0, 0, "SubbandWeights")
    mapper.ShareExtremes(shown)  # the same tiles
    mapper.SetInterpolation(mapper.CUBIC)
    values = Scene(mapper, look_at_square, (TEXELS, TEXELS)).noise()
    assert not numpy.isnan(values).any()
    image = vtkImageData()
    image.SetDimensions(TEXELS, TEXELS, 1)
    grey = numpy.clip(numpy.round((values + 4) / 8 * 255), 0, 255).astype(numpy.uint8)
    image.GetPointData().SetScalars(numpy_to_vtk(grey.ravel(), deep=True))
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.InterpolateOn()
    texture.RepeatOn()
    texture.SetColorModeToDirectScalars()
    return texture


def textured(mesh, texture, look, anisotropic):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.ScalarVisibilityOff()
    scene = Scene(mapper, look, (WIDTH, HEIGHT))
    texture.MipmapOn()
    texture.SetMaximumAnisotropicFiltering(16.0 if anisotropic else 1.0)
    texture.Modified()
    scene.actor.SetTexture(texture)
    return scene.bytes()[..., 0] / 255.0 * 8.0 - 4.0


def filtered(fine, kernel):
    """At the middle of each pixel; NaN where the kernel reaches beyond the surface."""
    reach = len(kernel) // 2 - FINER // 2
    padded = numpy.pad(fine, reach, constant_values=numpy.nan)
    rows = sum(weight * padded[k:k + FINER * HEIGHT:FINER] for k, weight in enumerate(kernel))
    return sum(weight * rows[:, k:k + FINER * WIDTH:FINER] for k, weight in enumerate(kernel))


def kernels():
    x = (numpy.arange(8 * FINER) + 0.5) / FINER - 4.0
    gauss = numpy.exp(-0.5 * x * x)
    return {"Gaussian": gauss / gauss.sum(), "box": numpy.full(FINER, 1.0 / FINER)}


def trapezoid(u, v):
    return (0.1 + (0.8 - 0.5 * v) * u + 0.35 * v, 0.6 * v, 0 * u)


def look_at_trapezoid(renderer):
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.52, 0.3, 1)
    camera.SetFocalPoint(0.52, 0.3, 0)
    camera.SetParallelScale(0.4)


def plane(u, v):
    return (40 * (u - 0.5), 40 * v, 0 * u)


def look_to_horizon(renderer):
    camera = renderer.GetActiveCamera()
    camera.SetPosition(0, 0.5, 1)
    camera.SetFocalPoint(0, 3, 0.3)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(50)


def write_noise(name, values):
    write(sys.argv[1], name + ".png", 0.5 + numpy.nan_to_num(values[::-1]) / 6.4)


SCENES = (("trapezoid", sheet(33, trapezoid, 1.0), 33, look_at_trapezoid, 0.012),
          ("plane", sheet(33, plane, 8.0), 33, look_to_horizon, 0.2))
for name, mesh, side, look, wavelength in SCENES:
    fine = noise_mapper(mesh, wavelength, False)
    fine.SetInterpolation(fine.CUBIC)
    reference = Scene(fine, look, (FINER * WIDTH, FINER * HEIGHT)).noise()
    texture = bake(mesh, side, noise_mapper(mesh, wavelength, False), wavelength)
    results = {"none": Scene(noise_mapper(mesh, wavelength, False), look, (WIDTH, HEIGHT)).noise(),
               "mip map": textured(mesh, texture, look, False), "anisotropic": textured(mesh, texture, look, True),
               "ours": Scene(noise_mapper(mesh, wavelength, True), look, (WIDTH, HEIGHT)).noise()}
    for filter_name, kernel in kernels().items():
        wanted = filtered(reference, kernel)
        inside = ~numpy.isnan(wanted) & ~numpy.isnan(results["none"])
        print("%-9s %-8s" % (name, filter_name), "variance %.3f" % wanted[inside].var(), "  ".join(
            "%s %.4f" % (way, ((values - wanted)[inside] ** 2).mean()) for way, values in results.items()), flush=True)
        if len(sys.argv) > 1:
            write_noise(name + filter_name, wanted)
    if len(sys.argv) > 1:
        for way, values in results.items():
            write_noise(name + " " + way, values)
