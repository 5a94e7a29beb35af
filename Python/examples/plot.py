# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Flow around a cylinder over its speed, plot.png, beside matplotlib's streamplot (after pip install .[matplotlib])."""
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from steerablenoise.pyplot import flow  # noqa: E402

x, y = np.linspace(-3.0, 5.0, 321), np.linspace(-2.0, 2.0, 161)
z = x + 1j * y[:, np.newaxis]
inside = np.abs(z) < 1.0
# The potential z + 1/z and a vortex of circulation -4 in the cylinder.
velocity = np.conj(1.0 - 1.0 / np.where(inside, 1.0, z) ** 2 + 4j / (2.0 * np.pi * np.where(inside, 1.0, z)))
u, v = np.ma.array(velocity.real, mask=inside), np.ma.array(velocity.imag, mask=inside)

figure, axes = plt.subplots(2, 1, figsize=(8, 8), layout="constrained")
image = flow(axes[0], x, y, u, v, color=np.hypot(u, v), cmap="viridis")
figure.colorbar(image, label="speed")
axes[1].streamplot(x, y, u, v, color="0.3", density=1.5, linewidth=0.8)
for ax in axes:
    ax.set_aspect("equal")
figure.savefig("plot.png")
