"""What the first Apply shows: noise in grey, the finer image, no outline, and the representation by the name of LIC."""
import os
import subprocess
import sys
import tempfile

import plugintest as pt
from paraview import simple

pt.load_plugin()
if sys.argv[1].endswith(".pvsm"):
    simple.LoadState(sys.argv[1])
    for shown in simple.GetRepresentations().values():
        if shown.Input.SMProxy.GetXMLName() == "SteerableNoise":
            print("is", shown.Representation)
    pt.finish()
wake = simple.OpenDataFile(pt.WAKE)
simple.UpdatePipeline(proxy=wake)
view = simple.GetActiveViewOrCreate("RenderView")
view.ViewSize = [800, 400]
simple.Show(wake, view)

# The filter: its own array, in grey, and an image fine enough for its streaks.
noise = simple.SteerableNoise(Input=wake)
display = simple.Show(noise, view)
simple.Hide(wake, view)
simple.Render(view)
pt.check(list(display.ColorArrayName) == ["CELLS", "SteerableNoise"], "coloured by the noise: %s" % display.ColorArrayName)
table = simple.GetColorTransferFunction("SteerableNoise")
points = list(table.RGBPoints)
pt.check(points == [-2, 0, 0, 0, 2, 1, 1, 1], "grey from -2 to 2: %s" % points)
noise.SMProxy.UpdatePropertyInformation()
finer = noise.GetPropertyValue("ResolvedMagnification")
size = noise.GetPropertyValue("ResolvedFeatureSize")
spacing = noise.GetClientSideObject().GetOutput().GetSpacing()[0]
pt.check(finer == 2 and size >= 6 * spacing > 0.5 * size, "Magnification %d: %g samples a streak" % (finer, size / spacing))
# A colour map that a script or a user sets stays.
table.RGBPoints = [-1, 1, 1, 1, 1, 0, 0, 0]
noise.Seed = 3
simple.Render(view)
pt.check(list(table.RGBPoints)[0] == -1, "the range is not reset")

# Reset of Feature Size fills in the size in use.
feature = noise.SMProxy.GetProperty("FeatureSize")
pt.check(noise.FeatureSize == 0, "automatic at first")
feature.ResetToDomainDefaults()
pt.check(noise.FeatureSize == size, "reset gives %g, in use is %g" % (noise.FeatureSize, size))
simple.Delete(noise)

# A volume is no outline, and stays what the user makes of it in a state.
volume = simple.Wavelet(WholeExtent=[-6, 6, -6, 6, -6, 6])
flow = simple.Gradient(Input=volume, ScalarArray=["POINTS", "RTData"])
simple.UpdatePipeline(proxy=flow)
pt.check(simple.Show(flow, view).Representation == "Outline", "ParaView's own first look at a volume")
solid = simple.SteerableNoise(Input=flow)
display = simple.Show(solid, view)
pt.check(display.Representation == "Surface", "not the noise of a volume: %s" % display.Representation)
pt.check(list(display.ColorArrayName) == ["POINTS", "SteerableNoise"], "coloured by the noise: %s" % display.ColorArrayName)
cells = solid.GetDataInformation().GetNumberOfCells()
pt.check(12**3 * 8 <= cells <= 4194304, "a finer volume, within bounds: %d" % cells)
display.Representation = "Outline"
with tempfile.TemporaryDirectory() as folder:
    state = os.path.join(folder, "outline.pvsm")
    simple.SaveState(state)
    # In a process of its own, as a user would.
    loaded = subprocess.run([sys.argv[1], os.path.abspath(__file__), state], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)
pt.check("is 'Outline'" in loaded.stdout, "the state's outline stays: " + loaded.stdout)

# By the name that who knows LIC looks for: the representation, over the colours of the input.
for path in (pt.WAKE, os.path.join(pt.SHARED, "airfoil_rans.vtm"), os.path.join(pt.SHARED, "carotid.vtk")):
    if not os.path.exists(path):
        print("skipped, absent: " + path)
        continue
    data = simple.OpenDataFile(path)
    simple.UpdatePipeline(proxy=data)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [800, 400]
    colors = list(simple.Show(data, view).ColorArrayName)
    flow = simple.FlowNoiseLICStreaksConvolution(Input=data)
    display = simple.Show(flow, view)
    simple.Hide(data, view)
    simple.ResetCamera(view)
    simple.Render(view)
    where = os.path.basename(path)
    pt.check(display.Representation == "Steerable Noise", where + " is shown as " + str(display.Representation))
    pt.check(list(display.ColorArrayName) == colors or where != "cylinder_wake.vti", where + " keeps its colours")
    picture = os.path.join(pt.OUTPUT, "flow_noise_%s.png" % where)
    simple.SaveScreenshot(picture, view)
    same = flow.GetDataInformation().GetNumberOfCells() == data.GetDataInformation().GetNumberOfCells()
    pt.check(same, where + " is passed on")
    display.NoiseIntensity = 0.0
    plain = os.path.join(pt.OUTPUT, "flow_noise_off.png")
    simple.SaveScreenshot(plain, view)
    change = abs(pt.pixels(picture) - pt.pixels(plain)).max()
    pt.check(change > 50, "%s shows noise: %g" % (where, change))
    simple.Delete(flow)
    simple.Delete(data)
pt.finish()
