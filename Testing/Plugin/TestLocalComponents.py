"""The user guide's recipes for local components: east and north on a globe, radial and tangential about an axis."""
import os
import re

import numpy
import plugintest as pt
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkStructuredGrid

pt.load_plugin()
with open(os.path.join(pt.SOURCE, "Documentation", "user-guide.md"), encoding="utf-8") as page:
    section = page.read().split("## Local components")[1].split("\n## ")[0]
recipes = re.findall(r"```python\n(.*?)```", section, re.S)
pt.check(len(recipes) == 2, "two recipes")


def grid(places, shape, **arrays):
    """A structured surface with point arrays, as a source."""
    data = vtkStructuredGrid()
    data.SetDimensions(shape[1], shape[0], 1)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(places, deep=1))
    data.SetPoints(points)
    for name, values in arrays.items():
        array = numpy_to_vtk(numpy.ascontiguousarray(values), deep=1)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    source = simple.TrivialProducer()
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def angles(filtered, expected, places, normals, name):
    """Degrees between streaks, by the metric's smallest eigenvalue, and a flow; and the error of the vectors."""
    noise = simple.SteerableNoise(
        Input=filtered, SelectInputVectors=["POINTS", name], FeatureSize=0.2, FollowCurvature=0, OutputMetric=1)
    simple.UpdatePipeline(proxy=noise)
    output = noise.GetClientSideObject().GetOutputDataObject(0)
    m = vtk_to_numpy(output.GetPointData().GetArray("Metric")).astype(float)
    metric = m[:, [0, 3, 5, 3, 1, 4, 5, 4, 2]].reshape(-1, 3, 3)
    along = numpy.linalg.eigh(metric)[1][:, :, 0]
    flow = expected / numpy.linalg.norm(expected, axis=1)[:, None]
    inside = abs(normals[:, 2]) < 0.98  # the poles of longitude and latitude have neither east nor north
    cosines = abs((along * flow).sum(axis=1)).clip(0, 1)
    return numpy.degrees(numpy.arccos(cosines))[inside]


# A globe that turns about a tilted axis.
rows, columns = 91, 181
latitude, longitude = (a.ravel() for a in numpy.meshgrid(
    numpy.radians(numpy.linspace(-89, 89, rows)), numpy.radians(numpy.linspace(0, 360, columns)), indexing="ij"))
radial = numpy.stack([numpy.cos(latitude) * numpy.cos(longitude), numpy.cos(latitude) * numpy.sin(longitude),
                      numpy.sin(latitude)], axis=1)
east = numpy.stack([-numpy.sin(longitude), numpy.cos(longitude), 0 * longitude], axis=1)
north = numpy.cross(radial, east)
wind = numpy.cross([0.6, 0.0, 0.8], radial)
data = grid(radial, (rows, columns), u=(wind * east).sum(axis=1), v=(wind * north).sum(axis=1))
names = dict(simple=simple, Calculator=simple.Calculator, data=data)
exec(recipes[0], names)
error = angles(names["world"], wind, radial, radial, "wind")
pt.check(error.max() < 1.0, "east and north: streaks leave the wind by up to %.2f degrees" % error.max())
merged = simple.Calculator(Input=data, ResultArrayName="wind", Function="u*iHat + v*jHat")
wrong = angles(merged, wind, radial, radial, "wind")
pt.check(numpy.median(wrong) > 20.0, "without the recipe by %.0f degrees in the median" % numpy.median(wrong))

# A swirl in a pipe's cross-section, out from and around the axis z.
radius, angle = (a.ravel() for a in numpy.meshgrid(
    numpy.linspace(0.2, 1.0, 41), numpy.radians(numpy.linspace(0, 360, 181)), indexing="ij"))
outward = numpy.stack([numpy.cos(angle), numpy.sin(angle), 0 * angle], axis=1)
around = numpy.stack([-numpy.sin(angle), numpy.cos(angle), 0 * angle], axis=1)
flow = 0.4 * outward + around / radius[:, None]
data = grid(outward * radius[:, None], (41, 181), radial=0.4 + 0 * radius, tangential=1 / radius, axial=0 * radius)
names["data"] = data
exec(recipes[1], names)
error = angles(names["world"], flow, outward, 0 * outward, "velocity")
pt.check(error.max() < 1.0, "radial and tangential: streaks leave the flow by up to %.2f degrees" % error.max())
pt.finish()
