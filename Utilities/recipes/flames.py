# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Flames: noise along a rising field that travels with Phase, as heat through a table of colours.

Usage: pvpython Utilities/recipes/flames.py flames.png
"""
from recipe import *

shown = view(background=(0.0, 0.0, 0.0), size=(400, 480))
air = Wavelet(WholeExtent=[-120, 120, 0, 300, 0, 0])
draught = Calculator(Input=air, ResultArrayName="draught", Function=(
    "(0.5*sin(0.03*coordsY + 0.02*coordsX) - 0.004*coordsX)*iHat + jHat"))
noise = SteerableNoise(Input=draught, SelectInputVectors=["POINTS", "draught"], FeatureSize=16, Octaves=3, Gain=0.6,
                       StreakLength=4, Phase=0.3)
flames = Calculator(Input=noise, ResultArrayName="heat", Function=(
    "1.1 - coordsY/230 - abs(coordsX)/150 + 0.28*SteerableNoise"))
show_surface(flames, "heat", (0.0, (0.0, 0.0, 0.0)), (0.25, (0.55, 0.05, 0.0)), (0.5, (0.95, 0.40, 0.03)),
             (0.8, (1.0, 0.85, 0.25)), (1.2, (1.0, 1.0, 0.85)))
save(shown, zoom=1.3)
