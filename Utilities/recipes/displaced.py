# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A sphere displaced along its normals (the lecture): noise as a height.

Usage: pvpython Utilities/recipes/displaced.py displaced.png
"""
from recipe import *

shown = view()
sphere = Sphere(Radius=1, ThetaResolution=400, PhiResolution=300)
noise = SteerableNoise(Input=sphere, Direction="None", FeatureSize=0.45, Octaves=3)
blob = WarpByScalar(Input=noise, Scalars=["POINTS", "SteerableNoise"], ScaleFactor=0.07)
show_surface(blob, "SteerableNoise", (-2.0, (0.25, 0.32, 0.50)), (0.0, (0.75, 0.70, 0.62)), (2.0, (0.98, 0.95, 0.85)))
save(shown, azimuth=20, elevation=20, zoom=1.3)
