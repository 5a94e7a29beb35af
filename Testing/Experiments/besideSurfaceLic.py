# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Frames of vtkSteerableNoiseMapper, vtkSubbandNoiseMapper and vtkSurfaceLICMapper, timed in one run with a moving camera; the
tables in Documentation/performance.md.

pvpython besideSurfaceLic.py [WIDTH...]

Needs the module steerablenoise on PYTHONPATH and a display at least as large as the widest picture. A plane and a
sphere of 64 cells, LIC with 40 steps of a quarter pixel. Pixels is the mean over an octave of sizes about 6, since
some take one lattice and others two. Subband noise is shown at texture coordinates, along the vectors too, and on planar
projections. The last rows are the first frames of a million triangles.
"""
import resource
import sys
import time

import numpy
from steerablenoise import vtkSteerableNoiseFilter, vtkSteerableNoiseMapper, vtkSubbandNoiseMapper
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkFiltersTexture import vtkTextureMapToPlane, vtkTextureMapToSphere
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

FRAMES = 7  # of each; the median counts
VORTICES = ((130.0, 180.0, 100.0), (300.0, 330.0, -100.0), (420.0, 160.0, 83.0))


def surface(source):
    """The output of a source with the vectors of a wind and three vortices."""
    source.Update()
    data = source.GetOutput()
    data.GetPointData().Initialize()
    places = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    vectors = numpy.zeros((len(places), 3), dtype=numpy.float32)
    vectors[:, 0] = 1.0
    for x, y, strength in VORTICES:
        dx, dy = places[:, 0] - x, places[:, 1] - y
        share = strength / (dx * dx + dy * dy + 400.0)
        vectors[:, 0] -= share * dy
        vectors[:, 1] += share * dx
    array = numpy_to_vtk(vectors, deep=True)
    array.SetName("V")
    data.GetPointData().SetVectors(array)
    return data


def plane(cells):
    source = vtkPlaneSource()
    source.SetPoint1(512, 0, 0)
    source.SetPoint2(0, 512, 0)
    source.SetResolution(cells, cells)
    return surface(source)


def sphere():
    source = vtkSphereSource()
    source.SetThetaResolution(64)
    source.SetPhiResolution(32)
    source.SetRadius(250)
    source.SetCenter(256, 256, 0)
    return surface(source)


def window_of(mapper, data, width):
    mapper.SetInputDataObject(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    renderer = vtkRenderer()
    renderer.AddActor(actor)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(width, width)
    window.AddRenderer(renderer)
    renderer.ResetCamera(data.GetBounds())
    renderer.GetActiveCamera().Zoom(1.4)
    return window, renderer


def processor_seconds():
    return sum(resource.getrusage(resource.RUSAGE_SELF)[:2])


def seconds(window):
    """Of a frame: by the clock, and of the processor."""
    clock, processor = time.perf_counter(), processor_seconds()
    window.Render()
    window.WaitForCompletion()
    return time.perf_counter() - clock, processor_seconds() - processor


def frames(mapper, data, width, sizes=None):
    """Median of frames, or mean over sizes in pixels."""
    window, renderer = window_of(mapper, data, width)
    seconds(window)
    times = []
    for frame in range(FRAMES):
        renderer.GetActiveCamera().Azimuth(0.01)
        if sizes:
            mapper.SetFeaturePixels(sizes[frame])
        times.append(seconds(window))
    return (numpy.mean if sizes else numpy.median)(times, axis=0)


def lic():
    mapper = vtkSurfaceLICMapper()
    mapper.SetInputArrayToProcess(0, 0, 0, 0, "V")
    mapper.GetLICInterface().SetNumberOfSteps(40)
    mapper.GetLICInterface().SetStepSize(0.25)
    return mapper


def noise(world):
    mapper = vtkSteerableNoiseMapper()
    if world:
        mapper.SetFeatureSizeMode(mapper.WORLD)
        mapper.SetFeatureSize(8.0)
    return mapper


def subband(orientations, steered=False, projected=False):
    mapper = vtkSubbandNoiseMapper()
    mapper.SetOrientations(orientations)
    mapper.SetWavelength(16.0)
    mapper.SetParameterization(2 if projected else 1)
    if steered:
        mapper.SetInputArrayToProcess(0, 0, 0, 0, "V")
    return mapper


SUBBAND = [("subband K %d%s" % (k, name), options, k) for k in (8, 4) for name, options in (
    ("", {}), (" steered", {"steered": True}), (" planes", {"projected": True}))]


def with_texture(data, name):
    texture = vtkTextureMapToPlane() if name == "plane" else vtkTextureMapToSphere()
    texture.SetInputData(data)
    texture.Update()
    return texture.GetOutput()


for width in [int(word) for word in sys.argv[1:]] or [1000, 1600]:
    for name, data in (("plane", plane(64)), ("sphere", sphere())):
        base = frames(lic(), data, width)
        print("%-6s %4d  Surface LIC %6.2f s, of the processor %6.2f" % (name, width, *base), flush=True)
        octave = [6.0 * 2.0 ** ((frame + 0.5) / FRAMES - 0.5) for frame in range(FRAMES)]
        for mode, mapper, sizes in (("World", noise(True), None), ("Pixels", noise(False), octave)):
            now = frames(mapper, data, width, sizes)
            print("%-6s %4d  %-11s %6.3f s, of the processor %6.3f: LIC takes %.1f and %.1f times as long" % (
                name, width, mode, *now, *(base / now)), flush=True)
        data = with_texture(data, name)
        for mode, options, k in SUBBAND:
            mapper = subband(k, **options)
            now = frames(mapper, data, width)
            print("%-6s %4d  %-19s %6.3f s, of the processor %6.3f: LIC takes %.1f and %.1f times as long; tiles %.2f MB, "
                  "weights %.2f MB" % (name, width, mode, *now, *(base / now), mapper.GetTileBytes() / 2.0 ** 20,
                                       mapper.GetWeightBytes() / 2.0 ** 20), flush=True)

fine = plane(708)
for name, mapper in (("Surface", vtkPolyDataMapper()), ("noise", noise(True))):
    window, renderer = window_of(mapper, fine, 800)
    first = seconds(window)
    renderer.GetActiveCamera().Azimuth(0.01)
    print("first frame of %d quads as %s: %.2f s, of the processor %.2f; the next one %.2f, %.2f" % (
        fine.GetNumberOfCells(), name, *first, *seconds(window)))
times = []
for follows in (True, False):
    noise_filter = vtkSteerableNoiseFilter()
    noise_filter.SetInputData(fine)
    noise_filter.SetFeatureSize(8.0)
    noise_filter.SetFollowCurvature(follows)
    before = processor_seconds()
    noise_filter.Update()
    times.append(processor_seconds() - before)
print("the filter's curvature there: of the processor %.2f s" % (times[0] - times[1]))
