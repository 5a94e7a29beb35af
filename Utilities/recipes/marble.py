# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Marble: planes through the stone, folded by turbulence.

Usage: pvpython Utilities/recipes/marble.py marble.png
"""
from recipe import *

shown = view()
stone = Sphere(Radius=1, ThetaResolution=500, PhiResolution=400)
noise = SteerableNoise(Input=stone, Direction="None", FeatureSize=0.8, Octaves=4, Turbulence=1)
marble = Calculator(Input=noise, ResultArrayName="veins", Function=(
    "sin(6*coordsX + 3*coordsY + 4*SteerableNoise)"))
show_surface(marble, "veins", (-1.0, (0.32, 0.34, 0.40)), (-0.7, (0.62, 0.64, 0.68)), (0.2, (0.93, 0.92, 0.90)), (1.0, (0.98, 0.98, 0.96)))
save(shown, azimuth=30, elevation=25, zoom=1.4)
