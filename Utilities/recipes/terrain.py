# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Terrain: six octaves of noise as the height of a plane.

Usage: pvpython Utilities/recipes/terrain.py terrain.png
"""
from recipe import *

shown = view(background=(0.75, 0.84, 0.93))
ground = Plane(XResolution=500, YResolution=500, Origin=[0, 0, 0], Point1=[10, 0, 0], Point2=[0, 10, 0])
noise = SteerableNoise(Input=ground, Direction="None", FeatureSize=2.5, Octaves=6, Seed=4)
height = Calculator(Input=noise, ResultArrayName="height", Function="max(-0.35, SteerableNoise)")
hills = WarpByScalar(Input=height, Scalars=["POINTS", "height"], ScaleFactor=0.55, UseNormal=1, Normal=[0, 0, 1])
show_surface(hills, "height", (-0.35, (0.20, 0.40, 0.62)), (-0.34, (0.76, 0.70, 0.50)), (0.0, (0.36, 0.52, 0.25)),
             (1.0, (0.45, 0.40, 0.34)), (1.7, (0.95, 0.95, 0.97)))
shown.CameraPosition, shown.CameraFocalPoint, shown.CameraViewUp = [5, -9, 6], [5, 5, 0], [0, 0, 1]
save(shown, zoom=1.15)
