# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A ball turned out of wood (the lecture): rings around an axis, their phase moved by noise without a direction.

Usage: pvpython Utilities/recipes/wood.py wood.png
"""
from recipe import *

shown = view()
ball = Sphere(Radius=1, ThetaResolution=500, PhiResolution=400, Center=[0.2, 0, 0.3])
noise = SteerableNoise(Input=ball, Direction="None", FeatureSize=0.6)
wood = Calculator(Input=noise, ResultArrayName="grain", Function=(
    "sin(45*sqrt(coordsX^2 + coordsZ^2) + 2*SteerableNoise)"))
show_surface(wood, "grain", (-1.0, (0.42, 0.22, 0.09)), (-0.5, (0.70, 0.42, 0.18)), (1.0, (0.86, 0.60, 0.32)))
save(shown, azimuth=25, elevation=50, zoom=1.4)
