# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of vtkSubbandNoiseMapper: the paper's figures 3, 6, 12 and 13 and Spot, each from a mesh as coarse as its shape allows.

pvpython subbandInTheView.py FOLDER [folder of spot.vtp]

Needs the module steerablenoise on PYTHONPATH and a display.
"""
import os
import sys

import numpy
from greyPictures import beside, render, write
from steerablenoise import vtkPolyDataSubbandNoise, vtkSubbandNoiseMapper
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

OUTPUT = sys.argv[1]


def sheet(columns, rows, place):
    """Quads with points at place(u, v) and texture coordinates u, v in [0, 1]."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, columns + 1), numpy.linspace(0, 1, rows + 1))
    u, v = u.ravel(), v.ravel()
    mesh, points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(numpy.stack(place(u, v), axis=1), deep=True))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            cells.InsertNextCell(4, (a, a + 1, a + columns + 2, a + columns + 1))
    texture = numpy_to_vtk(numpy.stack((u, v), axis=1), deep=True)
    mesh.SetPoints(points)
    mesh.SetPolys(cells)
    mesh.GetPointData().SetTCoords(texture)
    return mesh


def mapper_of(mesh, vectors=None, **properties):
    mapper = vtkSubbandNoiseMapper()
    mapper.SetInputDataObject(mesh)
    mapper.ScalarVisibilityOff()
    mapper.SetNoiseColorMode(mapper.BLEND)
    mapper.SetNoiseIntensity(1.0)
    mapper.SetNoiseContrast(0.8)
    if vectors:
        mapper.SetInputArrayToProcess(0, 0, 0, 0, vectors)
    for name, value in properties.items():
        getattr(mapper, "Set" + name)(value)
    return mapper


# Fig. 3, on one square: four bands of one scale, by weights of the user's own, and their sum.
square = sheet(1, 1, lambda u, v: (u, v, 0 * u))
probe = vtkPolyDataSubbandNoise()
probe.SetInputData(square)
probe.SetOrientations(4)
probe.SetWavelength(0.05)
probe.SetTileSize(512)  # the mapper's
probe.WeightsOnlyOn()
probe.Update()
weights = vtk_to_numpy(probe.GetOutput().GetPointData().GetArray("SubbandWeights"))
scales = weights.shape[1] // 4
finest = numpy.abs(weights[0]).reshape(scales, 4).sum(axis=1).argmax()
pictures = []
for bands in ([0], [1], [2], [3], [0, 1, 2, 3]):
    chosen = numpy.zeros((4, 4 * scales), dtype=numpy.float32)
    chosen[:, [4 * finest + band for band in bands]] = 2.13 / 0.125 * 2.0 ** finest / 4.0
    own = numpy_to_vtk(chosen, deep=True)
    own.SetName("own")
    square.GetPointData().AddArray(own)
    square.Modified()
    mapper = mapper_of(square, Orientations=4, Wavelength=0.05)
    mapper.SetInputArrayToProcess(1, 0, 0, 0, "own")
    pictures.append(render(mapper, (200, 200)))
write(OUTPUT, "subband-view-bands.png", beside(pictures))

# Fig. 6: two octaves on a trapezoid of 8 x 8 quads: plain, least squares, heuristic.
trapezoid = sheet(8, 8, lambda u, v: ((u - 0.5) * (2.0 - v), v, 0 * u))
write(OUTPUT, "subband-view-trapezoid.png", beside([render(
    mapper_of(trapezoid, Wavelength=0.08, Octaves=2, Method=method), (400, 200)) for method in (3, 0, 2)]))


# Fig. 12, the sphere: 64 x 32 quads by longitude and latitude, from above a pole. Plain, least squares, and with planar
# projections that take over at the poles.
def longitude_latitude(u, v):
    east, north = 2 * numpy.pi * u, numpy.pi * (v - 0.5)
    return numpy.cos(north) * numpy.cos(east), numpy.cos(north) * numpy.sin(east), numpy.sin(north)


sphere = sheet(64, 32, longitude_latitude)
normals = numpy_to_vtk(vtk_to_numpy(sphere.GetPoints().GetData()).copy(), deep=True)
sphere.GetPointData().SetNormals(normals)
write(OUTPUT, "subband-view-sphere.png", beside([
    render(mapper_of(sphere, Wavelength=0.12, **options), (300, 300), (1.2, -1.2, 2.2), (0, 0, 1), 1.4)
    for options in (dict(Method=3), dict(), dict(BlendSeams=True))]))

# Fig. 13: a field of vortices on 32 x 32 quads, anisotropy 1, 2 and 4.
field = sheet(32, 32, lambda u, v: (u, v, 0 * u))
x, y = vtk_to_numpy(field.GetPoints().GetData())[:, :2].T
vectors = numpy.stack((numpy.sin(2 * numpy.pi * y) + 0.3, numpy.sin(2 * numpy.pi * x), 0 * x), axis=1)
array = numpy_to_vtk(vectors, deep=True)
array.SetName("V")
field.GetPointData().AddArray(array)
write(OUTPUT, "subband-view-steered.png", beside([
    render(mapper_of(field, "V", Wavelength=0.035, Anisotropy=a), (330, 330)) for a in (1, 2, 4)]))

if len(sys.argv) > 2:
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(sys.argv[2], "spot.vtp"))
    smooth = vtkPolyDataNormals()
    smooth.SetInputConnection(reader.GetOutputPort())
    smooth.SplittingOff()
    smooth.Update()
    write(OUTPUT, "subband-view-spot.png", beside([
        render(mapper_of(smooth.GetOutput(), Wavelength=0.1, **options), (330, 330), (1.6, 0.5, -2.0), (0, 1, 0), 1.4)
        for options in (dict(Method=3), dict(), dict(Parameterization=2))]))
