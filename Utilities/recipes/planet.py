# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Goldberg's Fig. 12: a planet whose texture, longitude and latitude, has poles and a mirror; Blend Seams hides them.

Usage: pvpython Utilities/recipes/planet.py planet.png
"""
from recipe import *

shown = view(background=(0.03, 0.03, 0.06))
ball = Sphere(Radius=1, ThetaResolution=480, PhiResolution=320)
mapped = TextureMaptoSphere(Input=ball)
noise = SubbandNoise(Input=mapped, Wavelength=0.3, Octaves=4, Persistence=0.6, BlendSeams=1, Seed=2)
slope = Gradient(Input=noise, ScalarArray=["POINTS", "SubbandNoise"], ResultArrayName="slope")
tilted = Calculator(Input=slope, ResultArrayName="tilted", Function="Normals - 0.012*slope", ResultNormals=1)
show_surface(tilted, "SubbandNoise", (-2.0, (0.05, 0.14, 0.35)), (-0.02, (0.22, 0.45, 0.62)), (0.0, (0.76, 0.70, 0.50)),
             (0.5, (0.33, 0.48, 0.22)), (1.5, (0.45, 0.38, 0.30)), (2.5, (0.95, 0.95, 0.97)))
save(shown, azimuth=15, elevation=20, zoom=1.3)  # from above a pole
