# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Goldberg's Fig. 11 b: turbulence of subband noise moves the place at which a table of colours is looked up; and a, as a height.

Usage: pvpython Utilities/recipes/corona.py corona.png
"""
from recipe import *

shown = view(background=(0.02, 0.02, 0.05))
sun = Sphere(Radius=1, ThetaResolution=500, PhiResolution=400)
noise = SubbandNoise(Input=sun, Wavelength=0.6, Octaves=3, Function="Turbulence")
corona = Calculator(Input=noise, ResultArrayName="place", Function="0.5 + 0.5*sin(4*coordsZ + 1.6*SubbandNoise)")
bumps = WarpByScalar(Input=corona, Scalars=["POINTS", "SubbandNoise"], ScaleFactor=0.02)
show_surface(bumps, "place", (0.0, (0.35, 0.02, 0.0)), (0.4, (0.85, 0.25, 0.02)), (0.75, (1.0, 0.70, 0.15)), (1.0, (1.0, 0.97, 0.75)))
save(shown, azimuth=10, elevation=15, zoom=1.3)
