"""Run by TestRanks.py under pvbatch: noise of several datasets, saved with places for comparison."""
import os
import sys

import numpy
import plugintest as pt
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet
from vtkmodules.vtkIOExodus import vtkExodusIIReader
from vtkmodules.vtkParallelCore import vtkMultiProcessController

folder = sys.argv[1]
pt.load_plugin()
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def layers():
    """A volume and the layer of cells on top of it, each on one rank: the layer is no flat image anywhere."""
    blocks = vtkMultiBlockDataSet()
    blocks.SetNumberOfBlocks(2)
    for i, heights in enumerate(([-7, 8], [8, 9])):
        if i % ranks != rank:
            continue
        image = vtkImageData()
        image.SetExtent(-12, 12, -9, 9, *heights)
        shape = (heights[1] - heights[0], 18, 24)
        z, y, x = numpy.indices(shape).reshape(3, -1)
        flow = numpy.stack([1.3 + numpy.sin(0.3 * y), numpy.cos(0.25 * x), 0.2 + 0 * z], axis=1)
        array = numpy_to_vtk(flow, deep=1)
        array.SetName("Gradient")
        image.GetCellData().SetVectors(array)
        blocks.SetBlock(i, image)
    producer = simple.TrivialProducer()
    producer.GetClientSideObject().SetOutput(blocks)
    return producer


def sources():
    yield "layers", layers(), "Layers"
    yield "wavelet", simple.Wavelet(WholeExtent=[-12, 12, -9, 9, -7, 8]), "Gradient"
    # A fill value in a corner that one of the ranks has, and strength by the longest of the others.
    missing = "if(coordsX > 5 & coordsY > 3, -9999, 0.01 * coordsY)"
    yield "fill", simple.Calculator(
        Input=simple.Wavelet(WholeExtent=[-12, 12, -9, 9, -7, 8]), ResultArrayName="Gradient",
        Function="iHat * %s + jHat * 0.01 * (1 + coordsX)" % missing), "Fill"
    # Without flow in a third, which is all that one of three ranks has.
    yield "still", simple.Calculator(
        Input=simple.Wavelet(WholeExtent=[-12, 12, -9, 9, -7, 8]), ResultArrayName="Gradient",
        Function="iHat * if(coordsX < -3, 0, 1)"), "Still"
    yield "wake", simple.OpenDataFile(pt.WAKE), None
    shared = lambda name: os.path.join(pt.SHARED, name)
    if os.path.exists(shared("disk_out_ref.ex2")):
        yield "disk", simple.ExodusIIReader(FileName=[shared("disk_out_ref.ex2")]), None
        # ParaView's reader leaves all of this file to the first rank; VTK's gives it to every one.
        reader = vtkExodusIIReader()
        reader.SetFileName(shared("disk_out_ref.ex2"))
        reader.UpdateInformation()
        reader.SetAllArrayStatus(vtkExodusIIReader.NODAL, 1)
        reader.Update()
        [block] = pt.leaves(reader.GetOutput())
        yield "disk_distributed", pt.distributed(block), "Ghosts"
        yield "multicomb", simple.OpenDataFile(shared("multicomb.vtm")), None


def save(name, noise):
    """Places and values of all samples that are not ghosts, one file a rank."""
    rows = []
    for leaf in pt.leaves(noise.GetClientSideObject().GetOutputDataObject(0)):
        values = pt.array(leaf)
        if values is None or len(values) == 0:
            continue
        cells = len(values) != leaf.GetNumberOfPoints() or leaf.GetPointData().GetArray("SteerableNoise") is None
        ghosts = (leaf.GetCellData() if cells else leaf.GetPointData()).GetArray("vtkGhostType")
        for i, value in enumerate(values):
            if ghosts and ghosts.GetTuple1(i):
                continue
            if cells:
                bounds = leaf.GetCell(i).GetBounds()
                place = [(bounds[2 * a] + bounds[2 * a + 1]) / 2 for a in range(3)]
            else:
                place = leaf.GetPoint(i)
            rows.append(list(place) + [value])
    numpy.save(os.path.join(folder, "%s.%d.%d.npy" % (name, ranks, rank)), numpy.array(rows).reshape(-1, 4))


for name, source, preparation in sources():
    vectors = None
    if preparation == "Gradient":
        source = simple.Gradient(Input=source, ScalarArray=["POINTS", "RTData"])
        vectors = ["POINTS", "Gradient"]
    elif preparation == "Layers":
        vectors = ["CELLS", "Gradient"]
    elif preparation in ("Fill", "Still"):
        vectors = ["POINTS", "Gradient"]
    elif preparation == "Ghosts":
        # Renamed after 5.11.
        ghosts = getattr(simple, "GhostCells", None) or simple.GhostCellsGenerator
        source = ghosts(Input=source)
    if name == "wake":
        vectors = ["CELLS", "velocity"]
    if name.startswith("disk"):
        vectors = ["POINTS", "V"]
    if name == "multicomb":
        vectors = ["POINTS", "Momentum"]
    for curvature in (0, 1):
        noise = simple.SteerableNoise(
            Input=source, SelectInputVectors=vectors, FollowCurvature=curvature, Magnification=1,
            StrengthMode="Magnitude" if name == "fill" else "Constant")
        warnings = []
        noise.GetClientSideObject().AddObserver("WarningEvent", lambda *_: warnings.append(1))
        simple.UpdatePipeline(proxy=noise)
        if name == "layers":
            assert not warnings, "no warning on rank %d, which may have no data" % rank
        if name == "still":
            data = noise.GetClientSideObject().GetOutput()
            still = (pt.array(data) == 0).mean()
            assert ranks < 3 or rank > 0 or still > 0.7, "one rank has no flow: %g" % still
            assert not warnings, "no warning on rank %d" % rank
        save("%s_%d" % (name, curvature), noise)
        if name == "fill":
            data = noise.GetClientSideObject().GetOutput()
            places = numpy.array([data.GetPoint(i) for i in range(data.GetNumberOfPoints())])
            missing = (places[:, 0] > 5) & (places[:, 1] > 3)
            # Elsewhere it is 0 at corners of the lattice at most.
            zero = pt.array(data) == 0
            assert zero[missing].all() and zero[~missing].mean() < 0.01, "fill values give 0 on rank %d" % rank

print("rank %d of %d done" % (rank, ranks))
