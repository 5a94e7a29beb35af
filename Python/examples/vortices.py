# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Three vortices as a grey picture, vortices.pgm, with NumPy alone (after pip install .)."""
import numpy as np
from steerablenoise import noise

y, x = np.mgrid[:512, :768].astype(np.float32)
u = np.zeros((512, 768, 2), np.float32)
for x0, y0, strength in ((180, 160, 1), (560, 200, -1), (380, 390, 1)):
    r2 = (x - x0) ** 2 + (y - y0) ** 2 + 400.0
    u[..., 0] -= strength * (y - y0) / r2
    u[..., 1] += strength * (x - x0) / r2
grey = np.clip(128 + 48 * noise(u, feature_size=6, mask_threshold=1e-4), 0, 255).astype(np.uint8)
with open("vortices.pgm", "wb") as picture:
    picture.write(b"P5 768 512 255\n" + grey[::-1].tobytes())  # y up
