"""The panel shows the array that the filter would take by itself, and none that cannot steer."""
import numpy
import plugintest as pt
import steerablenoise
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkFiltersSources import vtkPlaneSource

pt.load_plugin()
random = numpy.random.RandomState(1)


def source(cells=False, without=(), active=None):
    """A plane whose array of the first name by the alphabet is not the one that steers."""
    plane = vtkPlaneSource()
    plane.SetResolution(8, 8)
    plane.Update()
    data = plane.GetOutput()
    data.GetPointData().Initialize()
    attributes = data.GetCellData() if cells else data.GetPointData()
    count = data.GetNumberOfCells() if cells else data.GetNumberOfPoints()
    arrays = dict(
        a_stress=random.rand(count, 6), b_colours=(255 * random.rand(count, 3)).astype(numpy.uint8),
        c_facing=random.rand(count, 3), d_numbers=(9 * random.rand(count, 3)).astype(numpy.int32),
        wind=random.rand(count, 3), velocity=random.rand(count, 3), z_place=random.rand(count, 2))
    for name in ("wind", "a_stress", "b_colours", "c_facing", "d_numbers", "velocity", "z_place"):
        if name not in without:
            array = numpy_to_vtk(arrays[name], deep=1)
            array.SetName(name)
            attributes.AddArray(array)
    attributes.SetActiveNormals("c_facing")
    attributes.SetActiveTCoords("z_place")
    if active == "a_stress":
        attributes.SetActiveTensors(active)
    elif active:
        attributes.SetActiveVectors(active)
    producer = simple.TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    return producer, data


def own_choice(data):
    """The noise of the filter that nobody told an array."""
    algorithm = steerablenoise.vtkSteerableNoiseFilter()
    algorithm.SetInputData(data)
    algorithm.Update()
    return pt.array(algorithm.GetOutput())


view = simple.CreateView("RenderView")
for cells in (False, True):
    association = "CELLS" if cells else "POINTS"
    for expected, options in (
        ("velocity", {}),
        ("wind", dict(active="wind")),
        ("d_numbers", dict(active="d_numbers")),
        ("a_stress", dict(without=("wind", "velocity"), active="a_stress")),
    ):
        producer, data = source(cells, **options)
        noise = simple.SteerableNoise(Input=producer)
        chosen = list(noise.SelectInputVectors)
        pt.check(chosen == [association, expected], "the filter's panel shows %s for %s" % (chosen, expected))
        simple.UpdatePipeline(proxy=noise)
        own, shown = own_choice(data), pt.array(noise.GetClientSideObject().GetOutput())
        pt.check((own == shown).all(), "the filter itself takes %s" % expected)
        domain = noise.SMProxy.GetProperty("SelectInputVectors").GetDomain("array_list")
        pt.check(domain.IsA("vtkSMSteeringArrayDomain"), "the domain is the plugin's")
        names = [domain.GetString(i) for i in range(domain.GetNumberOfStrings())]
        pt.check(expected in names and "a_stress" in names, "arrays that steer are in the list: %s" % names)
        pt.check(not {"b_colours", "c_facing", "z_place"} & set(names), "others are not in the list: %s" % names)
        display = simple.Show(producer, view)
        display.SetRepresentationType("Steerable Noise")
        chosen = list(display.NoiseVectors)
        pt.check(chosen == [association, expected], "the representation shows %s for %s" % (chosen, expected))
        simple.Delete(display)
        simple.Delete(noise)
        simple.Delete(producer)
# Nothing that the filter takes by itself: the first of the list, so that the user sees one.
producer, data = source(without=("wind", "velocity", "d_numbers"))
noise = simple.SteerableNoise(Input=producer)
pt.check(list(noise.SelectInputVectors) == ["POINTS", "a_stress"], "a tensor that is not active is offered")
pt.finish()
