"""Run by TestSubbandRanks.py under pvbatch: noise of surfaces in pieces, saved with places."""
import os
import sys

import numpy
import plugintest as pt
from paraview import simple
from steerablenoise import vtkPolyDataSubbandNoise
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.vtkCommonCore import VTK_STRING, vtkIdList
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkTriangleFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkFiltersTexture import vtkTextureMapToSphere
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkParallelCore import vtkMultiProcessController

folder = sys.argv[1]
pt.load_plugin()
controller = vtkMultiProcessController.GetGlobalController()
rank, ranks = controller.GetLocalProcessId(), controller.GetNumberOfProcesses()


def piece(mesh, owner):
    """The triangles of this rank, and those that touch their points as ghosts."""
    triangles = vtkTriangleFilter()
    triangles.SetInputData(mesh)
    triangles.Update()
    mesh = triangles.GetOutput()
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    places = vtk_to_numpy(mesh.GetPoints().GetData())
    mine = owner(places[corners].mean(axis=1)) == rank
    touched = numpy.zeros(mesh.GetNumberOfPoints(), dtype=bool)
    touched[corners[mine].ravel()] = True
    kept = touched[corners].any(axis=1)
    ghosts = numpy.where(mine, 0, 1).astype(numpy.uint8)[kept]

    part = vtkPolyData()
    part.SetPoints(mesh.GetPoints())
    part.GetPointData().ShallowCopy(mesh.GetPointData())
    cells = mesh.GetPolys().NewInstance()
    for ids in corners[kept]:
        cells.InsertNextCell(3)
        for point in ids:
            cells.InsertCellPoint(int(point))
    part.SetPolys(cells)
    array = numpy_to_vtk(ghosts, deep=True)
    array.SetName("vtkGhostType")
    part.GetCellData().AddArray(array)
    # Only the points in use: bounds are those of the piece.
    clean = vtkCleanPolyData()
    clean.PointMergingOff()
    clean.ConvertLinesToPointsOff()
    clean.ConvertPolysToLinesOff()
    clean.SetInputData(part)
    clean.Update()
    return clean.GetOutput()


def save(name, mesh):
    """Places and values of all points of triangles that are not ghosts, one file a rank."""
    values = pt.array(mesh, "SubbandNoise")
    ghosts = mesh.GetCellData().GetArray("vtkGhostType")
    owned = set()
    ids = vtkIdList()
    for cell in range(mesh.GetNumberOfCells()):
        if not ghosts or not ghosts.GetTuple1(cell):
            mesh.GetCellPoints(cell, ids)
            owned.update(ids.GetId(i) for i in range(ids.GetNumberOfIds()))
    rows = [list(mesh.GetPoint(i)) + [values[i]] for i in sorted(owned)]
    numpy.save(os.path.join(folder, "%s.%d.%d.npy" % (name, ranks, rank)), numpy.array(rows).reshape(-1, 4))


def all_on_first(places):
    return numpy.zeros(len(places), dtype=int)


def read(name):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(os.path.join(pt.SHARED, name))
    reader.Update()
    return reader.GetOutput()


def surfaces():
    sphere = vtkSphereSource()
    sphere.SetThetaResolution(96)
    sphere.SetPhiResolution(48)
    sphere.Update()
    yield "sphere", sphere.GetOutput(), pt.slabs, None
    yield "lonely", sphere.GetOutput(), all_on_first, None
    # Mirrored half way around, and stretched at the poles.
    mapped = vtkTextureMapToSphere()
    mapped.SetInputConnection(sphere.GetOutputPort())
    mapped.Update()
    yield "seams", mapped.GetOutput(), pt.slabs, None
    if os.path.exists(os.path.join(pt.SHARED, "spot.vtp")):
        yield "spot", read("spot.vtp"), pt.slabs, None
        yield "wind", read("gfs_wind_sphere.vtp"), pt.slabs, "wind"


# The class, on pieces made here. Wavelength 0 is agreed on.
for name, mesh, owner, vectors in surfaces():
    algorithm = vtkPolyDataSubbandNoise()
    algorithm.SetInputData(piece(mesh, owner))
    algorithm.SetOctaves(2)
    algorithm.SetBlendSeams(name == "seams")
    if vectors:
        algorithm.SetInputArrayToProcess(0, 0, 0, vtkDataObject.POINT, vectors)
    algorithm.Update()
    output = algorithm.GetOutputDataObject(0)
    if output.GetNumberOfPoints():
        save(name, output)

# The proxy, with ParaView's own ghost cells.
if os.path.exists(os.path.join(pt.SHARED, "gfs_wind_sphere.vtp")):
    source = simple.ExtractSurface(Input=pt.distributed(read("gfs_wind_sphere.vtp")))
    # Renamed after 5.11.
    ghosts = getattr(simple, "GhostCells", None) or simple.GhostCellsGenerator
    source = ghosts(Input=source)
    noise = simple.SubbandNoise(Input=source, SelectInputVectors=["POINTS", "wind"])
    simple.UpdatePipeline(proxy=noise)
    for i, leaf in enumerate(pt.leaves(noise.GetClientSideObject().GetOutputDataObject(0))):
        if leaf.GetNumberOfPoints():
            save("ghosts_%d" % i, leaf)

# One rank without the vectors that the others have: it says so, and nobody waits for it for ever.
sphere = next(surfaces())[1]
swirl = numpy.cross([0.0, 0.0, 1.0], vtk_to_numpy(sphere.GetPoints().GetData()))
field = numpy_to_vtk(swirl, deep=True)
field.SetName("swirl")
sphere.GetPointData().AddArray(field)
part = piece(sphere, pt.slabs)
lacks = rank == ranks - 1 and ranks > 1
if lacks:
    part.GetPointData().RemoveArray("swirl")
algorithm = vtkPolyDataSubbandNoise()
algorithm.SetInputData(part)
algorithm.SetInputArrayToProcess(0, 0, 0, vtkDataObject.POINT, "swirl")
errors = []


@calldata_type(VTK_STRING)
def note(_algorithm, _event, text):
    errors.append(text)


algorithm.AddObserver("ErrorEvent", note)
algorithm.Update()
assert len(errors) == lacks and all("There is no array 'swirl'" in text for text in errors), errors
assert (algorithm.GetOutputDataObject(0).GetNumberOfPoints() == 0) == lacks

print("rank %d of %d done" % (rank, ranks))
