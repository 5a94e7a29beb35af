"""Utilities/animate.py makes a loop: frames differ, and after one period comes the first one again."""
import os
import runpy
import sys
import tempfile

import numpy
import plugintest as pt
import steerablenoise  # so that the filter's own object has its methods
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource

FRAMES = 4


with tempfile.TemporaryDirectory() as folder:
    sys.argv = ["animate.py", pt.WAKE, folder, str(FRAMES)]
    made = runpy.run_path(os.path.join(pt.SOURCE, "Utilities", "animate.py"))
    noise, view = made["noise"], made["view"]
    paths = [os.path.join(folder, "frame.%04d.png" % i) for i in range(FRAMES)]
    pt.check(sorted(os.listdir(folder)) == [os.path.basename(p) for p in paths], "the frames that were asked for: %s" % sorted(os.listdir(folder)))
    frames = [pt.pixels(path) for path in paths]
    pt.check(min(frame.std() for frame in frames) > 20, "noise in every frame")
    for i in range(FRAMES):
        difference = abs(frames[i] - frames[(i + 1) % FRAMES]).mean()
        pt.check(difference > 3, "frame %d differs from the next one, mean %g" % (i, difference))

    # One period later the picture is the first one.
    view.ViewTime = FRAMES
    later = os.path.join(folder, "later.png")
    simple.SaveScreenshot(later, view)
    pt.check(abs(pt.pixels(later) - frames[0]).max() <= 1, "after one period comes the first frame")

filter_object = noise.GetClientSideObject()
offered = filter_object.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
pt.check(list(offered) == list(range(FRAMES)), "the filter offers the frames of one loop, got %s" % (offered,))
values = []
for periods in (0.0, 0.5, 1.0, 1.5):
    simple.UpdatePipeline(time=periods * FRAMES, proxy=noise)
    values.append(pt.array(filter_object.GetOutput()))
pt.check(abs(values[0] - values[2]).max() < 1e-3 and abs(values[1] - values[3]).max() < 1e-3, "the loop closes")
pt.check(abs(values[0] - values[1]).max() > 0.5, "half a period is another picture")
spread = [v.std() for v in values[:2]]
pt.check(abs(spread[0] / spread[1] - 1.0) < 0.1, "contrast does not pulse: %s" % spread)
# In the free stream, which flows to the right, the pattern moves to the right.
simple.UpdatePipeline(time=0.01 * FRAMES, proxy=noise)
image = filter_object.GetOutput()
columns, rows = image.GetDimensions()[0] - 1, image.GetDimensions()[1] - 1
first, second = (v.reshape(rows, columns)[: rows // 6].astype(float) for v in (values[0], pt.array(image)))
slope = numpy.gradient(0.5 * (first + second), axis=1)
drift = -(slope * (second - first)).sum() / (slope**2).sum()
pt.check(drift > 0.05, "the pattern moves downstream, %g samples" % drift)
# Play and Save Animation take the time steps as they are, 24 where nobody says another number.
noise.TimePeriod = 3.0
noise.TimeSteps = 24
noise.UpdatePipelineInformation()
scene = simple.GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
steps = list(simple.GetTimeKeeper().TimestepValues)
pt.check(len(steps) == 24 and numpy.allclose(steps, numpy.arange(24) / 8.0), "24 steps without the doubled end: %s" % steps)
pt.check(scene.PlayMode == "Snap To TimeSteps", "the animation goes by the steps, not %s" % scene.PlayMode)
pt.check(scene.EndTime == steps[-1], "and ends one step before the loop closes, at %g" % scene.EndTime)
# Without TimePeriod time does not matter, and there is no range on offer.
noise.TimePeriod = 0.0
simple.UpdatePipeline(time=0.3, proxy=noise)
still = pt.array(filter_object.GetOutput())
simple.UpdatePipeline(time=0.6, proxy=noise)
pt.check(bool((still == pt.array(filter_object.GetOutput())).all()), "still noise at any time")
simple.Delete(view)

# A file of a single time, 313, is steady data too.
with tempfile.TemporaryDirectory() as folder:
    image = vtkRTAnalyticSource()
    image.SetWholeExtent(-16, 16, -16, 16, 0, 0)
    image.Update()
    once = image.GetOutput()
    flow = numpy_to_vtk(numpy.tile([1.0, 0.4, 0.0], (33 * 33, 1)), deep=1)
    flow.SetName("flow")
    once.GetPointData().SetVectors(flow)
    time = numpy_to_vtk(numpy.array([313.0]), deep=1)
    time.SetName("TimeValue")
    once.GetFieldData().AddArray(time)
    writer = vtkXMLImageDataWriter()
    writer.SetDataModeToBinary()
    writer.SetFileName(os.path.join(folder, "once.vti"))
    writer.SetInputData(once)
    writer.Write()
    sys.argv = ["animate.py", writer.GetFileName(), os.path.join(folder, "frames"), str(FRAMES)]
    made = runpy.run_path(os.path.join(pt.SOURCE, "Utilities", "animate.py"))
    simple.Delete(made["view"])
    frames = [pt.pixels(os.path.join(folder, "frames", "frame.%04d.png" % i)) for i in range(FRAMES)]
    for i in range(FRAMES):
        difference = abs(frames[i] - frames[(i + 1) % FRAMES]).mean()
        pt.check(difference > 3, "one time in the file: frame %d differs from the next one, mean %g" % (i, difference))
pt.finish()
