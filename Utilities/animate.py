"""Saves a looping animation of the noise travelling along a steady flow, as PNG files.

Usage: pvpython Utilities/animate.py DATA OUTPUT_FOLDER [frames, 24]
DATA is any file that ParaView opens, with vectors. STEERABLENOISE_PLUGIN names the plugin; without it
the plugin has to be one that ParaView loads by itself (PV_PLUGIN_PATH).

The frames are one loop: frame.0000.png follows the last one. Encoders make a film of them, for example
ffmpeg -stream_loop 3 -framerate 12 -i frame.%04d.png -pix_fmt yuv420p wake.mp4
"""
import os
import sys

from paraview.simple import *

if len(sys.argv) < 3:
    sys.exit(__doc__)
data, folder = sys.argv[1:3]
frames = int(sys.argv[3]) if len(sys.argv) > 3 else 24
if frames < 2:
    sys.exit("A loop needs 2 frames or more.")
if "STEERABLENOISE_PLUGIN" in os.environ:
    LoadPlugin(os.environ["STEERABLENOISE_PLUGIN"], remote=False, ns=globals())

# Steady data have no time: with TimePeriod the filter offers time steps, one for each frame, and the loop closes after
# the last one. ParaView's animation takes them by itself.
reader = OpenDataFile(data)
reader.UpdatePipeline()
if len(getattr(reader, "TimestepValues", None) or []) > 1:
    sys.exit("%s has time steps of its own: animate those. This script is for steady data." % data)
# Vectors that are 0, the inside of bodies for example, are blank.
noise = SteerableNoise(Input=reader, TimePeriod=frames, TimeSteps=frames)
information = reader.GetDataInformation()
image = information.GetDataSetTypeAsString() == "vtkImageData"
bounds = information.GetBounds()
sides = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
if image:
    noise.Magnification = 3
    # Streaks of about 1/150 of the picture's width.
    noise.FeatureSize = max(sides) / 150.0
UpdatePipeline(time=0.0, proxy=noise)

view = CreateView("RenderView")
width = 960
flat = sides[2] <= 1e-6 * max(sides)
height = int(width * sides[1] / sides[0] / 2) * 2 if flat and sides[0] > 0.0 else 720
view.ViewSize = [width, max(160, min(height, 960))]
view.OrientationAxesVisibility = 0
view.CameraParallelProjection = 1
shown = Show(noise, view)
if not flat:
    shown.Representation = "Surface"  # ParaView shows volumes as outlines
association = noise.SelectInputVectors[0]
ColorBy(shown, (association, "SteerableNoise"))
shown.SetScalarBarVisibility(view, False)
colors = GetColorTransferFunction("SteerableNoise")
colors.ApplyPreset("Grayscale", True)
colors.RescaleTransferFunction(-2.2, 2.2)
ResetCamera(view)
if flat:
    # The data fill the picture.
    view.CameraParallelScale = sides[1] / 2.0

GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
os.makedirs(folder, exist_ok=True)
# ParaView numbers them: frame.0000.png. (How a format for that is written differs from version to version.)
path = os.path.join(folder, "frame.png")
SaveAnimation(path, view)
print("%d frames: %s" % (frames, os.path.join(folder, "frame.0000.png")))
