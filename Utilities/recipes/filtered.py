# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Goldberg's Fig. 8: an image of one's own, rings that become ever finer, on points too far apart for it: plain, and filtered by its bands.

Usage: pvpython Utilities/recipes/filtered.py filtered.png
"""
from recipe import *

shown = view(size=(640, 340))
plane = Wavelet(WholeExtent=[-128, 127, -128, 127, 0, 0])  # its array is not used
rings = Calculator(Input=plane, ResultArrayName="rings", Function="cos(0.01227*(coordsX^2 + coordsY^2))")
bands = SubbandDecomposition(Input=rings, SelectInputScalars=["POINTS", "rings"], Scales=5)
for side, filtered in ((-1.08, 0), (0.08, 1)):
    sheet = Plane(XResolution=255, YResolution=85, Origin=[side, 0, 0], Point1=[side + 1, 0, 0], Point2=[side, 1, 0])
    texture = SubbandTexture(Input=sheet, Subbands=bands, AntiAlias=filtered)
    display = show_surface(texture, "SubbandTexture", (-1.0, (0.0, 0.0, 0.0)), (1.0, (1.0, 1.0, 1.0)))
    display.Ambient, display.Diffuse = 1.0, 0.0
save(shown, zoom=1.9)
