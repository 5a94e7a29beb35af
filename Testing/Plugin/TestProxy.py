"""The proxies in pvpython: XML against C++, panel, help, and the filter on the wake."""
import xml.etree.ElementTree as ElementTree

import numpy
import plugintest as pt
import steerablenoise
from paraview import simple

pt.load_plugin()
XML = {}
LABELS = []
for file in ("SteerableNoise.xml", "SubbandNoise.xml"):
    try:
        tree = ElementTree.parse("%s/Plugin/%s" % (pt.SOURCE, file))
    except FileNotFoundError:
        continue
    for proxy in tree.getroot().iter("SourceProxy"):
        LABELS.append(proxy.get("label"))
        # The first has no properties, the other some defaults of its own: TestFirstLook.py and
        # TestSubbandNoise.py have their tests.
        if proxy.get("name") not in ("FlowNoise", "SubbandTexture"):
            XML[proxy.get("class")] = proxy

PROPERTY_TAGS = ("DoubleVectorProperty", "IntVectorProperty", "StringVectorProperty")
pt.check("vtkSteerableNoiseFilter" in XML, "the XML names vtkSteerableNoiseFilter")
for name, proxy in XML.items():
    algorithm = getattr(steerablenoise, name)()
    properties = [p for tag in PROPERTY_TAGS for p in proxy.iter(tag)]
    grouped = {p.get("name") for group in proxy.iter("PropertyGroup") for p in group}
    for prop in properties:
        key = prop.get("name")
        if prop.get("default_values") is None or prop.get("command") != "Set" + key:
            continue
        where = "%s.%s" % (name, key)
        # One default: XML and C++ share it.
        expected = prop.get("default_values").split()
        value = getattr(algorithm, "Get" + key)()
        value = value if isinstance(value, (tuple, list)) else (value,)
        if prop.tag == "StringVectorProperty":
            same = str(value[0]) == prop.get("default_values")
        else:
            same = [float(v) for v in value] == [float(e) for e in expected]
        if key == "Magnification":
            # For who looks it is automatic; programs keep the samples that they know.
            same = (value, expected) == ((1,), ["0"])
        pt.check(same, "%s: C++ default %s, XML %s" % (where, value, expected))
        # Help for each, in a group of the panel.
        text = prop.find("Documentation")
        pt.check(text is not None and len(text.text.strip()) > 20, where + " has help")
        pt.check(key in grouped, where + " is in a group of the panel")
        # The C++ class clamps to the XML's range.
        for domain in list(prop.iter("DoubleRangeDomain")) + list(prop.iter("IntRangeDomain")):
            for bound, beyond in (("min", -1e6), ("max", 1e6)):
                # A phase goes around; a size that is negative is refused.
                if domain.get(bound) is None or len(expected) > 1 or key in ("Phase", "FeatureSize"):
                    continue
                convert = int if prop.tag.startswith("Int") else float
                getattr(algorithm, "Set" + key)(convert(beyond))
                clamped = getattr(algorithm, "Get" + key)()
                pt.check(
                    abs(clamped - float(domain.get(bound))) < 1e-12,
                    "%s is clamped to its %s %s, got %s" % (where, bound, domain.get(bound), clamped),
                )
# The panel: few properties at first sight, in plain words, and none that does not apply.
panel = {p.get("name"): p for tag in PROPERTY_TAGS for p in XML["vtkSteerableNoiseFilter"].iter(tag)
         if p.get("information_only") != "1"}
first_sight = [name for name, p in panel.items() if p.get("panel_visibility") != "advanced"]
pt.check(len(first_sight) <= 10, "ten properties at most without 'advanced': %s" % first_sight)
for name, prop in panel.items():
    # pvpython 5.11 takes its names from the labels.
    label = (prop.get("label") or name).replace(" ", "")
    pt.check(label == name, "%s: a label of '%s' would be another name in scripts" % (name, label))
    words = prop.find("Documentation").text.lower()
    for word in ("surflet", "lattice corner has", "eigenvalue of", "metric at"):
        pt.check(word not in words, "%s says '%s' in plain words" % (name, word))
CONDITIONS = {
    "Density": ("Basis", "2", None), "ReferenceMagnitude": ("StrengthMode", "1", None),
    "StreakLength": ("LatticeWindow", "0", None), "Quality": ("LatticeWindow", "1", None),
    "MinimumEigenvalue": ("LatticeWindow", "1", None), "AnisotropicWeight": ("LatticeWindow", "1", None),
    "Falloff": ("LatticeWindow", "1", None),
    "Lacunarity": ("Octaves", "1", "1"), "Gain": ("Octaves", "1", "1"), "TimeSteps": ("TimePeriod", "0", "1"),
}
shown_if = {}
for name, prop in panel.items():
    for decorator in prop.iter("PropertyWidgetDecorator"):
        pt.check(decorator.get("mode") == "visibility", name + " is hidden, not only grey")
        shown_if[name] = tuple(decorator.get(key) for key in ("property", "value", "inverse"))
pt.check(shown_if == CONDITIONS, "what does not apply is hidden: %s" % shown_if)
pt.check({c[0] for c in CONDITIONS.values()} <= set(panel), "conditions name properties that there are")

# The filter on the wake, by the names scripts use.
wake = simple.OpenDataFile(pt.WAKE)
simple.UpdatePipeline(proxy=wake)
noise = simple.SteerableNoise(Input=wake, Magnification=1)
pt.check(list(noise.SelectInputVectors) == ["CELLS", "velocity"], "the vectors are found")
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=noise)
pt.check(messages.errors == 0, "no error: " + messages.text)
data = noise.GetClientSideObject().GetOutput()
values = pt.array(data)
pt.check(values is not None and values.shape == (64000,), "one value for each cell")
pt.check(values.dtype == numpy.float32, "float values")
pt.check(bool(numpy.isfinite(values).all()), "finite values")
pt.check(0.9 < values.std() < 1.1, "unit variance, got %g" % values.std())
pt.check(abs(values.mean()) < 0.05, "zero mean, got %g" % values.mean())
pt.check(data.GetCellData().GetScalars().GetName() == "SteerableNoise", "the noise is active")
for name in ("velocity", "solid"):
    pt.check(data.GetCellData().GetArray(name) is not None, name + " is passed on")
pt.check(
    wake.GetClientSideObject().GetOutput().GetCellData().GetArray("SteerableNoise") is None,
    "the input is not written",
)

# Quick launch finds it by the words of who knows LIC; ParaView 5.11 looks at labels only.
for word in ("flow", "lic", "noise", "streak", "convolution"):
    pt.check(any(word in label.lower() for label in LABELS), "'%s' is in a label of %s" % (word, LABELS))

# Each property through the proxy changes the noise.
CHANGES = dict(
    FeatureSize=0.5, Model="Perlin Noise", MetricInProjection=0, StreakLength=3, EigenvalueSum=6.0, LatticeWindow=1,
    Strength=0.5, StrengthMode="Magnitude", Normalization="None", FollowCurvature=0, Basis="Value",
    Phase=0.3, Animate=1, Octaves=2, Turbulence=1, Fade="Cubic",
    Lattice="Jittered", GradientSet="Perlin", Period=[4, 4, 0], MaskThreshold=0.5, MaskUpperThreshold=1.0, Seed=7,
)
for name, value in CHANGES.items():
    changed = simple.SteerableNoise(Input=wake, Magnification=1, **{name: value})
    simple.UpdatePipeline(proxy=changed)
    other = pt.array(changed.GetClientSideObject().GetOutput())
    pt.check(numpy.isfinite(other).all() and abs(other - values).max() > 1e-3, name + " matters")
    simple.Delete(changed)
# Those of the paper's own model change the noise with its window.
paper = simple.SteerableNoise(Input=wake, Magnification=1, LatticeWindow=1)
simple.UpdatePipeline(proxy=paper)
values = pt.array(paper.GetClientSideObject().GetOutput())
for name, value in dict(Quality=0, MinimumEigenvalue=0.2, AnisotropicWeight=0, Falloff="Radial").items():
    changed = simple.SteerableNoise(Input=wake, Magnification=1, LatticeWindow=1, **{name: value})
    simple.UpdatePipeline(proxy=changed)
    other = pt.array(changed.GetClientSideObject().GetOutput())
    pt.check(abs(other - values).max() > 1e-3, name + " matters with LatticeWindow")
    simple.Delete(changed)
# A tensor as the metric itself: (0.8, 2.0) stays as it is.
measured = simple.ProgrammableFilter(Input=simple.Wavelet(), Script="""
import numpy
output.ShallowCopy(inputs[0].VTKObject)
output.PointData.append(numpy.tile([0.8, 2.0, 1.0, 0.0, 0.0, 0.0], (output.GetNumberOfPoints(), 1)), "G6")
""")
simple.UpdatePipeline(proxy=measured)
for use, expected in (("Metric", 2.0), ("World Metric", 8.0)):
    spots = simple.SteerableNoise(Input=measured, SelectInputVectors=["POINTS", "G6"], TensorUse=use,
                                  FeatureSize=2, OutputMetric=1)
    simple.UpdatePipeline(proxy=spots)
    metric = spots.GetClientSideObject().GetOutput().GetPointData().GetArray("Metric").GetTuple(100)
    pt.check(abs(metric[1] - expected) < 1e-9, "%s keeps the metric: %s" % (use, metric))
    simple.Delete(spots)
# Length, strength and sum by an array.
slow = simple.Calculator(Input=wake, AttributeType="Cell Data", ResultArrayName="slow", Function="0.1")
simple.UpdatePipeline(proxy=slow)
plain = simple.SteerableNoise(Input=slow, Strength=0.1)
varied = simple.SteerableNoise(Input=slow)
pt.check(list(varied.StrengthArray) == ["POINTS", "None"], "no array by default: %s" % varied.StrengthArray)
varied.StrengthArray = ["CELLS", "slow"]
for proxy in (plain, varied):
    simple.UpdatePipeline(proxy=proxy)
one, other = (pt.array(proxy.GetClientSideObject().GetOutput()) for proxy in (plain, varied))
pt.check(float(abs(one - other).max()) < 1e-5 and one.std() > 0.5, "StrengthArray is Strength")
# Without a direction any data will do.
ball = simple.Sphere()
clouds = simple.SteerableNoise(Input=ball, Direction="None", FeatureSize=0.2, Octaves=2)
with pt.Messages() as messages:
    simple.UpdatePipeline(proxy=clouds)
pt.check(messages.errors == 0, "no vectors are needed: " + messages.text)
pt.check(pt.array(clouds.GetClientSideObject().GetOutput()).std() > 0.5, "clouds on a ball")
simple.Delete(clouds)
simple.Delete(ball)
fine = simple.SteerableNoise(Input=wake, Magnification=2, OutputMetric=1, ResultArrayName="n")
simple.UpdatePipeline(proxy=fine)
data = fine.GetClientSideObject().GetOutput()
pt.check(pt.array(data, "n").shape == (4 * 64000,), "Magnification refines the image")
pt.check(data.GetBounds() == wake.GetClientSideObject().GetOutput().GetBounds(), "same bounds")
pt.check(pt.array(data, "Metric").shape == (4 * 64000, 6), "OutputMetric adds six components")
pt.finish()
