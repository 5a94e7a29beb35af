# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Steerable noise of the wheel beside rLIC and lic from PyPI on the same fields; the table in performance.md.

python besidePythonLic.py Data/cylinder_wake.vti [large]

In a virtual environment with this package, rlic, lic and pyvista (which reads the wake). Line integral convolution takes
20 pixels each way with equal weights, of white noise that is smoothed so that its lines are as wide as the noise's.
All arrays are float32. Seconds are the least of some runs: of the
processor for one thread, by the clock for two. `large`: 8 times as many pixels along each
side too (of the wake 3.3 times), without lic, which would take an hour.
"""
import os
import sys
import time

import numpy
import pyvista
from besidemeasures import FEATURE, circular, measure, smooth, three_vortices, wake, width
from lic import lic
from rlic import convolve
from steerablenoise import noise

STEPS = 20
RUNS = 7


def least_seconds(make, runs, clock=time.process_time):
    seconds = []
    for _ in range(runs):
        start = clock()
        picture = make()
        seconds.append(clock() - start)
    return picture, min(seconds)


def noise_of(field, threads, runs=RUNS):
    clock = time.process_time if threads == 1 else time.perf_counter
    return least_seconds(
        lambda: noise(field, feature_size=FEATURE, mask_threshold=1e-6, threads=threads), runs, clock)


def grain_of(shape, sigma):
    white = smooth(numpy.random.default_rng(1).standard_normal(shape), sigma)
    return numpy.clip(0.5 + 0.1 * white / white.std(), 0.01, 1.0).astype(numpy.float32)  # rLIC takes none below 0


def rlic_of(field, sigma, runs=RUNS):
    u, v = (numpy.ascontiguousarray(field[..., i]) for i in (0, 1))
    kernel = numpy.full(2 * STEPS + 1, 1.0 / (2 * STEPS + 1), numpy.float32)
    grain = grain_of(u.shape, sigma)
    return least_seconds(lambda: convolve(grain, u, v, kernel=kernel), runs)


def lic_of(field, sigma):
    # Its first axis is x.
    u, v = (numpy.ascontiguousarray(field[..., i].T) for i in (0, 1))
    grain = grain_of(field.shape[:2], sigma).T
    picture, seconds = least_seconds(lambda: lic(u, v, seed=grain, length=2 * STEPS), 1)
    return picture.T, seconds


def as_wide(field, counts, wanted):
    """How much rLIC's noise is smoothed for lines of this width, by bisection."""
    low, high = 0.3, 1.7
    for _ in range(7):
        middle = 0.5 * (low + high)
        picture, _ = rlic_of(field, middle, runs=1)
        low, high = (middle, high) if width(picture.astype(float), field, counts) < wanted else (low, middle)
    return 0.5 * (low + high)


def row(name, what, picture, field, counts, *seconds):
    picture = picture.astype(float)
    median, mean, ratio, coherence = measure(picture, field, counts)
    print("| %s | %s | %.2f | %.2f° | %.2f° | %.1f | %.3f | %s |" % (
        name, what, width(picture, field, counts), median, mean, ratio, coherence,
        " | ".join("%.3g" % s if s else "" for s in seconds)), flush=True)


smoothed = {}  # by field
image = pyvista.read(sys.argv[1]).cell_data_to_point_data()
velocity = image["velocity"].reshape(image.dimensions[1], image.dimensions[0], 3)[..., :2]
FIELDS = (("circular", circular), ("three vortices", three_vortices), ("wake", lambda scale: wake(velocity, 3 if scale == 1 else 10)))
print("%d processors" % len(os.sched_getaffinity(0)))
print("| field | picture | width | median | mean | ratio | coherence | s, one thread | two | times as long as noise |")
print("|---|---|---|---|---|---|---|---|---|---|")
for scale in (1, 8)[:1 + ("large" in sys.argv)]:
    for name, make in FIELDS:
        field, counts = make(scale)
        field = field.astype(numpy.float32)
        name = "%s, %d × %d" % (name, field.shape[1], field.shape[0])
        picture, seconds = noise_of(field, 1)
        _, two = noise_of(field, 2)
        row(name, "steerable noise", picture, field, counts, seconds, two, 1.0)
        if scale == 1:
            smoothed[make] = as_wide(field, counts, width(picture.astype(float), field, counts))
        picture, longer = rlic_of(field, smoothed[make], RUNS if scale == 1 else 1)
        row("", "rLIC", picture, field, counts, longer, None, longer / seconds)
        if scale == 1:
            picture, longer = lic_of(field, smoothed[make])
            row("", "lic", picture, field, counts, longer, None, longer / seconds)
