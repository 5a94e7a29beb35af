# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the representation, for TestRepresentationRanks.py: pvbatch representationranks.py FOLDER PREFIX."""
import os
import sys

from paraview.simple import *

LoadPlugin(os.environ["STEERABLENOISE_PLUGIN"], remote=True, ns=globals())
wavelet = Wavelet(WholeExtent=[0, 40, 0, 40, 0, 40])
vectors = Calculator(
    Input=wavelet, ResultArrayName="V", Function="iHat*(coordsY-19)-jHat*(coordsX-20)+kHat*5")
UpdatePipeline(proxy=vectors)
view = CreateView("RenderView")
view.ViewSize = [400, 300]
view.OrientationAxesVisibility = 0
view.CameraPosition = [120, 90, 130]
view.CameraFocalPoint = [20, 20, 20]
display = Show(vectors, view)
display.SetRepresentationType("Steerable Noise")
display.NoiseVectors = ["POINTS", "V"]
display.ColorArrayName = ["POINTS", ""]
for mode in ("Pixels", "World"):  # World: a size from the bounds of all ranks
    display.NoiseFeatureSizeMode = mode
    display.NoiseStrengthMode = "Constant" if mode == "Pixels" else "Magnitude"
    SaveScreenshot(os.path.join(sys.argv[1], sys.argv[2] + mode + ".png"), view, ImageResolution=[400, 300])

# Wavelength and tiles from the surfaces of all ranks.
display.SetRepresentationType("Subband Noise")
display.SubbandIntensity = 0.5
SaveScreenshot(os.path.join(sys.argv[1], sys.argv[2] + "Subband.png"), view, ImageResolution=[400, 300])
