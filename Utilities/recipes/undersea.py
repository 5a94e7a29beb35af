# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Water under the surface of the sea: noise along a slow waving flow as fog, without advecting anything.

Usage: pvpython Utilities/recipes/undersea.py undersea.png
"""
from recipe import *

shown = view(background=(0.01, 0.10, 0.17))
water = Wavelet(WholeExtent=[0, 110, 0, 60, 0, 60])
flow = Calculator(Input=water, ResultArrayName="flow", Function=(
    "iHat + 0.5*sin(0.08*coordsX + 0.05*coordsZ)*jHat + 0.4*cos(0.07*coordsX + 0.06*coordsY)*kHat"))
noise = SteerableNoise(Input=flow, SelectInputVectors=["POINTS", "flow"], FeatureSize=8, Octaves=2)
fog = Calculator(Input=noise, ResultArrayName="fog", Function="max(0, SteerableNoise)*exp(-0.02*(60 - coordsY))")
show_volume(fog, "fog", ((0.0, 0.0), (0.3, 0.01), (1.0, 0.12), (2.5, 0.3)),
            (0.0, (0.02, 0.18, 0.28)), (1.0, (0.15, 0.55, 0.62)), (2.5, (0.85, 1.0, 0.95)))
save(shown, azimuth=20, elevation=-15, zoom=1.4)
