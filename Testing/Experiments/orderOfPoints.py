# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""How the rate of vtkSteerableNoiseFilter off images depends on the order of the points; a table in
Documentation/performance.md.

pvpython orderOfPoints.py [MESH.vtu|MESH.vtp...]

The meshes of offImages.py, and those of the files, whose active vectors steer, with the same points in the order of
the file, shuffled, and along a Hilbert and a Morton curve. Updates change the Seed alone, so that the kernel is most of what they
do; Mpoints/s of the processor, medians of 7 that take turns. Values must be the same to the bit in every order.
"""
import resource
import statistics
import sys

import numpy
from offImages import make
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints

TURNS = 7
BITS = 16  # of places along a curve


def hilbert(places, bits=BITS):
    """Order of places along a Hilbert curve (Skilling 2004)."""
    x = whole_numbers(places, bits)
    dimension = len(x)
    q = 1 << (bits - 1)
    while q > 1:
        for i in range(dimension):
            high = (x[i] & numpy.uint64(q)) != 0
            rest = numpy.uint64(q - 1)
            swap = numpy.where(high, numpy.uint64(0), (x[0] ^ x[i]) & rest)
            x[0] = numpy.where(high, x[0] ^ rest, x[0] ^ swap)
            x[i] ^= swap
        q >>= 1
    for i in range(1, dimension):
        x[i] ^= x[i - 1]
    t = numpy.zeros_like(x[0])
    q = 1 << (bits - 1)
    while q > 1:
        t = numpy.where((x[-1] & numpy.uint64(q)) != 0, t ^ numpy.uint64(q - 1), t)
        q >>= 1
    return interleaved(x ^ t, bits)


def interleaved(x, bits):
    key = numpy.zeros_like(x[0])
    for bit in reversed(range(bits)):
        for axis in x:
            key = (key << numpy.uint64(1)) | ((axis >> numpy.uint64(bit)) & numpy.uint64(1))
    return numpy.argsort(key, kind="stable")


def morton(places):
    """Order of places along a Morton curve."""
    return interleaved(whole_numbers(places, BITS), BITS)


def whole_numbers(places, bits):
    places = places - places.min(axis=0)
    return (places / max(places.max(), 1e-300) * (2**bits - 1)).astype(numpy.uint64).T.copy()


def reordered(mesh, order):
    """The same mesh; point i is the old point order[i]."""
    copy = mesh.NewInstance()
    copy.DeepCopy(mesh)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(vtk_to_numpy(mesh.GetPoints().GetData())[order], deep=True))
    copy.SetPoints(points)
    copy.GetPointData().Initialize()
    vectors = mesh.GetPointData().GetVectors()
    array = numpy_to_vtk(vtk_to_numpy(vectors)[order], deep=True)
    array.SetName(vectors.GetName())
    copy.GetPointData().SetVectors(array)
    new = numpy.empty_like(order)
    new[order] = numpy.arange(len(order))
    cells = copy.GetPolys() if copy.IsA("vtkPolyData") else copy.GetCells()
    ids = vtk_to_numpy(cells.GetConnectivityArray())
    ids[:] = new[ids]
    return copy


def read(name):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

    reader = vtkXMLPolyDataReader() if name.endswith("vtp") else vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    return reader.GetOutput()


def measure(name, mesh):
    from steerablenoise import vtkSteerableNoiseFilter

    count = mesh.GetNumberOfPoints()
    places = vtk_to_numpy(mesh.GetPoints().GetData())
    orders = {"as it is": numpy.arange(count), "shuffled": numpy.random.default_rng(0).permutation(count),
              "Hilbert": hilbert(places.astype(float)), "Morton": morton(places.astype(float))}
    filters = {}
    for order, ids in orders.items():
        filters[order] = vtkSteerableNoiseFilter()
        filters[order].SetInputData(reordered(mesh, ids))
        filters[order].Update()
    seconds = {order: [] for order in orders}
    values = {}
    for turn in range(TURNS):
        for order, noise in filters.items():
            noise.SetSeed(turn + 1)
            before = sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
            noise.Update()
            seconds[order].append(sum(resource.getrusage(resource.RUSAGE_SELF)[:2]) - before)
            values[order] = numpy.empty(count, numpy.float32)
            values[order][orders[order]] = vtk_to_numpy(noise.GetOutput().GetPointData().GetArray("SteerableNoise"))
    for other in values.values():
        assert (other == values["as it is"]).all(), "the order shows in the values"
    print("%-12s %8d points: " % (name, count) +
          ", ".join("%s %.2f" % (order, 1e-6 * count / statistics.median(taken)) for order, taken in seconds.items()),
          flush=True)


if __name__ == "__main__":
    for name in ("triangles", "quads", "hexahedra", "tetrahedra"):
        measure(name, make(name))
    for name in sys.argv[1:]:
        measure(name.split("/")[-1], read(name))
