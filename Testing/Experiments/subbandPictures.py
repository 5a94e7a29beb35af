"""Pictures of Documentation/subband-noise.md: the paper's figures 3, 6 and 13, and real meshes.

pvpython subbandPictures.py <folder of pictures> <folder of the real meshes>

Needs the module steerablenoise on PYTHONPATH and a display.
"""
import os
import sys

import numpy
from greyPictures import beside, render, write
from paraview import simple  # noqa: F401, registers the readers' factories
from steerablenoise import vtkImageSubbandNoiseSource, vtkPolyDataSubbandNoise
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals, vtkTriangleFilter
from vtkmodules.vtkFiltersModeling import vtkLoopSubdivisionFilter
from vtkmodules.vtkFiltersSources import vtkPlaneSource, vtkSphereSource
from vtkmodules.vtkFiltersTexture import vtkTextureMapToSphere
from vtkmodules.vtkIOLegacy import vtkPolyDataReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

OUTPUT, DATA = sys.argv[1], sys.argv[2]


def grey(noise, deviations=2.5):
    return 0.5 + noise / (2.0 * deviations)


def subband(mesh, vectors=None, **properties):
    """The mesh with noise; the numbers that matter are printed."""
    algorithm = vtkPolyDataSubbandNoise()
    algorithm.SetInputData(mesh)
    if vectors:
        algorithm.SetInputArrayToProcess(0, 0, 0, vtkDataObject.POINT, vectors)
    for name, value in properties.items():
        getattr(algorithm, "Set" + name)(value)
    algorithm.Update()
    return algorithm.GetOutputDataObject(0)


def values(mesh, name="SubbandNoise"):
    return vtk_to_numpy(mesh.GetPointData().GetArray(name))


def noise_mapper(mesh):
    """Colours a surface by its noise."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for i in range(256):
        table.SetTableValue(i, i / 255.0, i / 255.0, i / 255.0, 1.0)
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(mesh)
    mapper.SetLookupTable(table)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("SubbandNoise")
    mapper.SetScalarRange(-2.5, 2.5)
    mapper.InterpolateScalarsBeforeMappingOn()
    return mapper


def refine(mesh, times):
    """Triangles cut in four, smoothly, with all point arrays."""
    triangles = vtkTriangleFilter()
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.SetInputData(mesh)
    loop = vtkLoopSubdivisionFilter()
    loop.SetInputConnection(triangles.GetOutputPort())
    loop.SetNumberOfSubdivisions(times)
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(loop.GetOutputPort())
    normals.SplittingOff()
    normals.ConsistencyOff()
    normals.Update()
    return normals.GetOutput()


def read(name):
    reader = vtkXMLPolyDataReader() if name.endswith(".vtp") else vtkPolyDataReader()
    reader.SetFileName(os.path.join(DATA, name))
    reader.Update()
    return reader.GetOutput()


def plane(points, width=1.0, height=1.0, shape=None):
    """A square of texture coordinates; `shape` moves its points."""
    source = vtkPlaneSource()
    source.SetOrigin(0.0, 0.0, 0.0)
    source.SetPoint1(width, 0.0, 0.0)
    source.SetPoint2(0.0, height, 0.0)
    source.SetResolution(points - 1, points - 1)
    source.Update()
    mesh = vtkPolyData()
    mesh.ShallowCopy(source.GetOutput())
    if shape:
        places = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
        places[:, 0], places[:, 1] = shape(places[:, 0], places[:, 1])
        points = mesh.GetPoints().NewInstance()
        points.SetData(numpy_to_vtk(places, deep=True))
        mesh.SetPoints(points)
    return mesh


def figure_3():
    """Four bands of one scale, and their sum."""
    source = vtkImageSubbandNoiseSource()
    source.SetOrientations(4)
    source.SetScales(1)
    source.SetBandCenter(1.0 / 16)
    source.Update()
    bands = vtk_to_numpy(source.GetOutput().GetPointData().GetScalars()).reshape(256, 256, 4)[:128, :128]
    total = bands.sum(axis=2)
    scale = 1.0 / total.std()
    write(OUTPUT, "subband-bands.png", beside([grey(bands[:, :, i] * scale, 1.6) for i in range(4)] + [grey(total * scale)]))


def figure_6():
    """A square of texture on a trapezoid, 2 wide at the bottom and 1 at the top: two octaves."""
    points = 513

    def trapezoid(u, v):
        return (u - 0.5) * (2.0 - v), v

    mesh = plane(points, shape=trapezoid)
    pictures = []
    for method in (3, 0, 2):
        noise = subband(mesh, Wavelength=0.08, Octaves=2, Method=method, AntiAlias=0)
        grid = values(noise).reshape(points, points)
        # Pixels of the trapezoid: its texture coordinates in closed form.
        width, height = 400, 200
        y, x = numpy.mgrid[height - 1 : -1 : -1, 0:width]
        v = (y + 0.5) / height
        u = (2.0 * (x + 0.5) / width - 1.0) / (2.0 - v) + 0.5
        inside = (u >= 0.0) & (u <= 1.0)
        column = numpy.clip(u * (points - 1), 0, points - 1.001)
        row = numpy.clip(v * (points - 1), 0, points - 1.001)
        c, r = column.astype(int), row.astype(int)
        a, b = column - c, row - r
        sampled = (grid[r, c] * (1 - a) + grid[r, c + 1] * a) * (1 - b) + (
            grid[r + 1, c] * (1 - a) + grid[r + 1, c + 1] * a
        ) * b
        pictures.append(numpy.where(inside, grey(sampled, 3.2), 1.0))
    # Above one another, as rows of the page.
    white = numpy.ones((6, pictures[0].shape[1]))
    write(OUTPUT, "subband-trapezoid.png", numpy.vstack([pictures[0], white, pictures[1], white, pictures[2]]))


def figure_13():
    """Noise that follows a field of vortices, at two anisotropies."""
    points = 400
    mesh = plane(points)
    places = vtk_to_numpy(mesh.GetPoints().GetData())
    x, y = 2.0 * numpy.pi * places[:, 0], 2.0 * numpy.pi * places[:, 1]
    field = numpy.zeros((len(places), 3))
    field[:, 0] = numpy.sin(x) * numpy.cos(y) + 0.3
    field[:, 1] = -numpy.cos(x) * numpy.sin(y)
    array = numpy_to_vtk(field, deep=True)
    array.SetName("field")
    mesh.GetPointData().AddArray(array)
    pictures = []
    for anisotropy in (1.0, 2.0, 4.0):
        noise = subband(mesh, "field", Wavelength=0.05, Anisotropy=anisotropy, AntiAlias=0, TileSize=512)
        pictures.append(grey(values(noise).reshape(points, points)[::-1][:300, :300]))
    write(OUTPUT, "subband-steered.png", beside(pictures))


def meshes():
    """Each beside plain texture mapping of the same noise."""
    size = (330, 330)

    def compare(name, mesh, position, up, zoom, vectors=None, first=None, **properties):
        plain = dict(properties, Method=3) if first is None else dict(properties, **first)
        pictures = []
        for choice in (plain, properties):
            noise = subband(mesh, vectors if choice is properties or first is None else None, **choice)
            pictures.append(render(noise_mapper(noise), size, position, up, zoom))
        write(OUTPUT, name, beside(pictures))

    compare("subband-spot.png", refine(read("spot.vtp"), 3), (1.6, 0.5, -2.0), (0, 1, 0), 1.4, Wavelength=0.1)
    compare("subband-face.png", refine(read("fran_cut.vtk"), 3), (1.0, 0.1, 0.45), (0, 1, 0), 1.4, Wavelength=0.012)

    sphere = vtkSphereSource()
    sphere.SetThetaResolution(512)
    sphere.SetPhiResolution(256)
    texture = vtkTextureMapToSphere()
    texture.SetInputConnection(sphere.GetOutputPort())
    texture.AutomaticSphereGenerationOff()
    texture.SetCenter(0.0, 0.0, 0.0)
    texture.PreventSeamOff()
    texture.Update()
    compare(
        "subband-latlong.png", texture.GetOutput(), (1.0, 0.4, 0.9), (0, 0, 1), 1.45, Wavelength=0.06, WrapSeams=1
    )
    # From above, where the image of the texture turns back too: it is the same on both sides of a plane.
    texture.PreventSeamOn()
    texture.Update()
    compare(
        "subband-poles.png",
        texture.GetOutput(),
        (0.1, 0.3, 1.0),
        (0, 1, 0),
        1.45,
        first=dict(BlendSeams=0),
        Wavelength=0.06,
        BlendSeams=1,
    )
    compare("subband-artery.png", refine(read("carotid_iso150.vtp"), 2), (1.0, 0.6, 0.4), (0, 0, 1), 2.6, Wavelength=2.2)
    compare(
        "subband-wind.png",
        refine(read("gfs_wind_sphere.vtp"), 2),
        (1.0, -0.4, 0.6),
        (0, 0, 1),
        1.45,
        vectors="wind",
        first=dict(Anisotropy=1.0),
        Wavelength=0.112,
        Anisotropy=4.0,
    )


if __name__ == "__main__":
    figure_3()
    figure_6()
    figure_13()
    meshes()
