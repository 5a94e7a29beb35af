# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A tornado (Rice, Fig. 1): noise along a field that swirls and rises, volume rendered.

Usage: pvpython Utilities/recipes/tornado.py tornado.png
"""
from recipe import *

shown = view(background=(0.62, 0.66, 0.70), size=(400, 480))
air = Wavelet(WholeExtent=[-40, 40, -40, 40, 0, 100])
swirl = Calculator(Input=air, ResultArrayName="wind", Function="-coordsY*iHat + coordsX*jHat + 12*kHat")
noise = SteerableNoise(Input=swirl, SelectInputVectors=["POINTS", "wind"], FeatureSize=8, Octaves=2, StreakLength=5)
# The funnel: a wall around a radius that grows with the height, torn by the noise.
funnel = Calculator(Input=noise, ResultArrayName="dust", Function=(
    "exp(-((sqrt(coordsX^2 + coordsY^2) - 5 - 0.0022*coordsZ^2)/5)^2)*max(0, 0.55 + 0.6*SteerableNoise)"))
show_volume(funnel, "dust", ((0.0, 0.0), (0.15, 0.0), (0.5, 0.25), (1.2, 0.6)),
            (0.0, (0.30, 0.28, 0.26)), (0.6, (0.55, 0.52, 0.48)), (1.2, (0.92, 0.90, 0.86)))
shown.CameraPosition, shown.CameraFocalPoint, shown.CameraViewUp = [0, -250, 45], [0, 0, 50], [0, 0, 1]
save(shown, zoom=1.25)
