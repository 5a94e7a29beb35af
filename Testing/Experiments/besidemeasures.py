# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Fields that pictures of flow are compared on, and what is measured in them (as Testing/Kernel/PictureMetrics.h has it)."""
import numpy

FEATURE = 8.0  # pixels
BORDER = 20


# ---- fields: vectors of shape (rows, columns, 2), and the pixels that count ---------------------------

def inner(shape):
    counts = numpy.zeros(shape, dtype=bool)
    counts[BORDER:-BORDER, BORDER:-BORDER] = True
    return counts


def circular(scale=1):
    """512 pixels times `scale` along a side."""
    side = 512 * scale
    y, x = numpy.mgrid[:side, :side] / float(scale)
    return numpy.stack((256.3 - y, x - 256.3), axis=-1), inner((side, side))


def three_vortices(scale=1):
    side = 512 * scale
    y, x = numpy.mgrid[:side, :side] / float(scale)
    field = numpy.zeros((side, side, 2))
    for cx, cy, sense in ((150.0, 170.0, 1.0), (370.0, 190.0, 1.0), (250.0, 380.0, -1.0)):
        dx, dy = x - cx, y - cy
        field += (sense / (dx * dx + dy * dy + 400.0))[..., None] * numpy.stack((-dy, dx), axis=-1)
    return field, inner((side, side))


def linear(values, count, axis):
    """Values at `count` even places along an axis, from the first to the last."""
    place = numpy.linspace(0.0, values.shape[axis] - 1.0, count)
    left = numpy.minimum(place.astype(int), values.shape[axis] - 2)
    share = (place - left).reshape([-1 if i == axis else 1 for i in range(values.ndim)])
    return (1.0 - share) * values.take(left, axis) + share * values.take(left + 1, axis)


def wake(values, fine):
    """From velocities at the points of the wake's image, shape (rows, columns, 2): `fine` pixels for each cell."""
    rows, columns = values.shape[:2]
    field = linear(linear(values, fine * (rows - 1), 0), fine * (columns - 1), 1)
    # Nor do the cylinder and its boundary layer count, where there is no flow or all of it is within a line.
    still = numpy.linalg.norm(field, axis=-1) < 1e-6
    return field, inner(still.shape) & (smooth(still.astype(float), FEATURE) < 1e-3)


# ---- measures -----------------------------------------------------------------------------------------

def convolve(values, kernel, axis):
    """Along an axis, the picture mirrored at its borders."""
    radius = len(kernel) // 2
    widths = [(radius, radius) if i == axis else (0, 0) for i in range(2)]
    padded = numpy.pad(values, widths, mode="symmetric")
    length = values.shape[axis]
    return sum(weight * padded.take(numpy.arange(i, i + length), axis) for i, weight in enumerate(kernel[::-1]))


def gaussian(sigma, derivative=False):
    at = numpy.arange(-int(numpy.ceil(4.0 * sigma)), int(numpy.ceil(4.0 * sigma)) + 1)
    kernel = numpy.exp(-0.5 * at * at / (sigma * sigma))
    kernel /= kernel.sum()
    return -at / (sigma * sigma) * kernel if derivative else kernel


def smooth(values, sigma):
    return convolve(convolve(values, gaussian(sigma), 0), gaussian(sigma), 1)


def gradient(values):
    g, d = gaussian(1.0), gaussian(1.0, derivative=True)
    return convolve(convolve(values, d, 1), g, 0), convolve(convolve(values, g, 1), d, 0)


def unit(field):
    return field / numpy.maximum(numpy.linalg.norm(field, axis=-1, keepdims=True), 1e-30)


def width(picture, field, counts):
    """Of lines, in pixels; nothing is smoothed before the differences, else the finest would not count."""
    dy, dx = numpy.gradient(picture)
    u = unit(field)
    return picture[counts].std() / (dy * u[..., 0] - dx * u[..., 1])[counts].std()


def measure(picture, field, counts):
    """Median and mean angle between lines and flow in degrees, ratio of gradients, coherence."""
    gx, gy = gradient(picture)
    xx, xy, yy = (smooth(product, FEATURE) for product in (gx * gx, gx * gy, gy * gy))
    major = 0.5 * numpy.arctan2(2.0 * xy, xx - yy)
    u = unit(field)
    # The lines are at right angles to the largest change.
    sine = numpy.abs(numpy.cos(major) * u[..., 0] + numpy.sin(major) * u[..., 1])
    angles = numpy.degrees(numpy.arcsin(numpy.minimum(sine, 1.0)))[counts]
    coherence = (numpy.hypot(xx - yy, 2.0 * xy) / numpy.maximum(xx + yy, 1e-30))[counts]
    along = gx * u[..., 0] + gy * u[..., 1]
    across = gy * u[..., 0] - gx * u[..., 1]
    ratio = numpy.sqrt((across[counts] ** 2).mean() / (along[counts] ** 2).mean())
    return numpy.median(angles), angles.mean(), ratio, coherence.mean()
