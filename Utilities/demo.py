"""Pictures of the cylinder wake in Data/: the noise in the view, as an array in grey, and over the colours of speed.

Usage: pvpython demo.py DATA.vti OUTPUT_FOLDER, with STEERABLENOISE_PLUGIN naming the plugin.
"""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["STEERABLENOISE_PLUGIN"], remote=False, ns=globals())
data, folder = sys.argv[1:3]

wake = OpenDataFile(data)
UpdatePipeline(proxy=wake)
noise = SteerableNoise(
    Input=wake,
    SelectInputVectors=["CELLS", "velocity"],
    Magnification=4,
    FeatureSize=0.12,
    MaskThreshold=1e-6,  # the cylinder
)
noise.UpdatePipeline()

view = CreateView("RenderView")
view.ViewSize = [1600, 640]
view.OrientationAxesVisibility = 0
view.CameraParallelProjection = 1
view.CameraFocalPoint = [10, 4, 0]
view.CameraPosition = [10, 4, 10]
view.CameraParallelScale = 4

# The noise in the view: the representation finds the vectors, here on cells, by itself.
display = Show(wake, view)
display.SetRepresentationType("Steerable Noise")
ColorBy(display, ("CELLS", "velocity", "Magnitude"))
display.RescaleTransferFunctionToDataRange(True)
display.SetScalarBarVisibility(view, False)
path = os.path.join(folder, "wake_in_the_view.png")
SaveScreenshot(path, view)
print(path)
Hide(wake, view)

# The noise in grey, two standard deviations to either side.
grey = Show(noise, view)
ColorBy(grey, ("CELLS", "SteerableNoise"))
colors = GetColorTransferFunction("SteerableNoise")
colors.ApplyPreset("Grayscale", True)
colors.RescaleTransferFunction(-2.0, 2.0)
grey.SetScalarBarVisibility(view, False)
path = os.path.join(folder, "wake_noise.png")
SaveScreenshot(path, view)
print(path)

# Over speed: dark and light streaks whose opacity is how far they are from the mean.
grey.Representation = "Surface"  # a slice has no opacity
grey.SetScalarBarVisibility(view, False)
speed = Show(wake, view)
speed.Representation = "Surface"
ColorBy(speed, ("CELLS", "velocity", "Magnitude"))
speedColors = GetColorTransferFunction("velocity")
# ParaView 6.1 has shortened the name of the preset.
speedColors.ApplyPreset("Viridis" if GetParaViewVersion() >= (6, 1) else "Viridis (matplotlib)", True)
speedColors.RescaleTransferFunction(0.0, 1.5)
speed.SetScalarBarVisibility(view, False)
colors.RGBPoints = [-2.0, 0, 0, 0, -0.01, 0, 0, 0, 0.01, 1, 1, 1, 2.0, 1, 1, 1]
colors.EnableOpacityMapping = 1
opacity = GetOpacityTransferFunction("SteerableNoise")
opacity.Points = [-2.0, 0.75, 0.5, 0, 0.0, 0.0, 0.5, 0, 2.0, 0.55, 0.5, 0]
# Called Position before ParaView 5.12.
setattr(grey, "Translation" if GetParaViewVersion() >= (5, 12) else "Position", [0, 0, 0.01])
path = os.path.join(folder, "wake_noise_over_speed.png")
SaveScreenshot(path, view)
print(path)
