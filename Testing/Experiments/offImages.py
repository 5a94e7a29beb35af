# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Updates of vtkSteerableNoiseFilter on surfaces and unstructured grids and of vtkPolyDataSubbandNoise, of one build or
of several in turn; the tables in Documentation/performance.md.

pvpython offImages.py [BUILD...]

Each BUILD is a build folder; none: the module steerablenoise on PYTHONPATH. For each mesh: the first update, and next
ones, which change one property alone; Mpoints/s by the clock and of the processor, medians of turns.
Other options are their defaults, sizes are automatic. VTK's own choice of threads is left as it is.

On surfaces with texture coordinates, with and without planar projections in their place, vtkPolyDataSubbandNoise is
steered by the vectors. "raised": Octaves from 1 to 2 for the first time; "octaves": back and forth.
"""
import os
import resource
import statistics
import subprocess
import sys
import time

TURNS = 3
NOISE = ("first", "seed")
SUBBAND = ("first", "phase", "raised", "octaves")
MESHES = {"triangles": NOISE, "quads": NOISE, "hexahedra": NOISE, "tetrahedra": NOISE, "texture": SUBBAND,
          "projections": SUBBAND}


def wavy(points):
    """Heights for a plane, so that normals differ."""
    import numpy

    points[:, 2] += 0.05 * numpy.sin(6.0 * points[:, 0]) * numpy.cos(5.0 * points[:, 1])
    return points


def with_flow(mesh):
    import numpy
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    x, y, z = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float).T
    flow = numpy.stack([1.0 + numpy.sin(3.0 * y), numpy.cos(4.0 * x), 0.3 * numpy.sin(5.0 * x + z)], axis=1)
    array = numpy_to_vtk(flow.astype(numpy.float32), deep=True)
    array.SetName("flow")
    mesh.GetPointData().SetVectors(array)
    return mesh


def surface(triangles):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkFiltersSources import vtkPlaneSource

    plane = vtkPlaneSource()
    plane.SetResolution(511, 511)
    plane.Update()
    mesh = plane.GetOutput()
    mesh.GetPointData().SetNormals(None)
    wavy(vtk_to_numpy(mesh.GetPoints().GetData()))
    if triangles:
        cut = vtkTriangleFilter()
        cut.SetInputData(mesh)
        cut.Update()
        mesh = cut.GetOutput()
    return with_flow(mesh)


def volume(tetrahedra):
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkFiltersCore import vtkAppendFilter
    from vtkmodules.vtkFiltersGeneral import vtkDataSetTriangleFilter

    image = vtkImageData()
    image.SetDimensions(80, 80, 80)
    image.SetSpacing(1 / 79, 1 / 79, 1 / 79)
    change = vtkDataSetTriangleFilter() if tetrahedra else vtkAppendFilter()
    change.SetInputData(image)
    change.Update()
    return with_flow(change.GetOutput())


def make(name):
    if name in ("hexahedra", "tetrahedra"):
        return volume(name == "tetrahedra")
    mesh = surface(name != "quads")
    if name != "texture":
        mesh.GetPointData().SetTCoords(None)
    return mesh


def make_filter(name):
    """Of subband noise with all tiles that a Phase may need, which are made once."""
    from steerablenoise import vtkPolyDataSubbandNoise, vtkSteerableNoiseFilter

    if MESHES[name] == NOISE:
        return vtkSteerableNoiseFilter()
    noise = vtkPolyDataSubbandNoise()
    noise.SetInputArrayToProcess(0, 0, 0, 0, "flow")
    noise.SetPhase(0.1)
    return noise


def change(noise, which):
    if which == "seed":
        noise.SetSeed(noise.GetSeed() + 1)
    elif which == "phase":
        noise.SetPhase(noise.GetPhase() + 0.01)
    elif which in ("raised", "octaves"):
        noise.SetOctaves(3 - noise.GetOctaves())


def serve():
    """A build's own process: for each line "mesh change" on stdin, the seconds of an update."""

    usage = lambda: sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
    meshes = {name: make(name) for name in MESHES}
    filters = {}
    print("ready", flush=True)
    for line in os.fdopen(0):
        name, which = line.split()
        if which == "first":
            filters[name] = make_filter(name)
            filters[name].SetInputData(meshes[name])
        change(filters[name], which)
        clock, processor = time.perf_counter(), usage()
        filters[name].Update()
        print(time.perf_counter() - clock, usage() - processor, meshes[name].GetNumberOfPoints(), flush=True)


def start(build):
    environment = dict(os.environ)
    if build:
        environment["LD_LIBRARY_PATH"] = os.path.join(build, "lib")
        environment["PYTHONPATH"] = os.path.join(build, "lib", "python3", "dist-packages")
    server = subprocess.Popen(["pvpython", os.path.abspath(__file__), "--serve"], env=environment,
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    while server.stdout.readline() != "ready\n":
        pass
    return server


def ask(server, name, which):
    server.stdin.write("%s %s\n" % (name, which))
    server.stdin.flush()
    clock, processor, points = map(float, server.stdout.readline().split())
    return 1e-6 * points / clock, 1e-6 * points / processor


def main():
    if sys.argv[1:] == ["--serve"]:
        return serve()
    servers = [start(build) for build in sys.argv[1:] or [None]]
    for name, changes in MESHES.items():
        rates = {(server, which): [] for server in servers for which in changes}
        for turn in range(TURNS):
            for server in servers:
                for which in changes:
                    rates[server, which].append(ask(server, name, which))
        for which in changes:
            medians = [[statistics.median(column) for column in zip(*rates[server, which])] for server in servers]
            print("%-11s %-7s" % (name, which), "; ".join("%.2f by the clock, %.2f of the processor" % tuple(m) for m in medians),
                  "" if len(servers) < 2 else "ratio %.1f, %.1f" % tuple(medians[-1][i] / medians[0][i] for i in (0, 1)))


if __name__ == "__main__":
    main()
