# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Goldberg's Fig. 11 a: bump mapping. Turbulence tilts the normals of a smooth sphere and looks up its colours.

Usage: pvpython Utilities/recipes/bumps.py bumps.png
"""
from recipe import *

shown = view()
ball = Sphere(Radius=1, ThetaResolution=400, PhiResolution=300)
noise = SubbandNoise(Input=ball, Wavelength=0.7, Octaves=3, Function="Turbulence")
slope = Gradient(Input=noise, ScalarArray=["POINTS", "SubbandNoise"], ResultArrayName="slope")
tilted = Calculator(Input=slope, ResultArrayName="tilted", Function="Normals - 0.05*slope", ResultNormals=1)
display = show_surface(tilted, "SubbandNoise", (0.0, (0.30, 0.13, 0.07)), (0.6, (0.62, 0.33, 0.17)), (1.4, (0.85, 0.66, 0.42)),
                       (2.8, (0.97, 0.92, 0.80)))
display.Specular, display.SpecularPower = 0.25, 20
save(shown, azimuth=20, elevation=20, zoom=1.3)
