# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Noise that streaks along a vector field, over NumPy arrays.

The model is Rice's "Steerable Perlin Noise" (2025). The arithmetic is that of vtkSteerableNoiseFilter,
and so are the bits, but neither VTK nor ParaView is needed.
"""
from __future__ import annotations

import math
import os

import numpy as np

from . import _kernel

__all__ = ["noise", "noise_at"]


def noise(vectors, *, spacing=1.0, origin=0.0, feature_size=8.0, streak_length=6.0, seed=0,
          follow_curvature=True, phase=None, mask_threshold=0.0, octaves=1, threads=None, out=None):
    """Noise on a regular grid, streaking along the vectors of its samples.

    vectors: shape (ny, nx, 2), or (nz, ny, nx, 3) with 2 or more samples along each axis; the components are
        along x, y[, z]. float32 and float64 are read where they lie, whatever their strides; other real numbers
        and masked arrays are copied. Samples that are masked, NaN or infinite get 0.
    spacing, origin: distance of the samples, above 0, and place of the first, in world units: one number,
        or one for each of x, y[, z] in this order.
    feature_size: side of a lattice cell in world units, above 0: how wide streaks are.
    streak_length: half-length of a streak in cells, 1 to 20.
    seed: 0 to 2**32 - 1; another seed is other noise of the same kind.
    follow_curvature: streaks bend with the streamlines.
    phase: None for still noise; a number for one picture of a loop of motion along the flow, from 0 to 1.
    mask_threshold: vectors no longer than this get 0; 0 switches the mask off.
    octaves: 1 to 16 terms of a fractal sum, each twice as fine and half as strong as the one before.
    threads: how many, 1 or more; None: as many as there are processors for this process. Never changes a bit.
    out: where to write, a C-contiguous float32 array of the result's shape that shares no memory with vectors.

    Returns float32 of shape (ny, nx) or (nz, ny, nx), mean 0 and variance about 1. Raises ValueError for an
    argument that cannot be used, with its name and what would do. The GIL is released; Ctrl-C is answered.
    """
    vectors = _numbers("vectors", vectors)
    if (vectors.ndim, vectors.shape[-1:]) not in ((3, (2,)), (4, (3,))):
        raise ValueError(f"vectors has shape {vectors.shape}; it must be (ny, nx, 2) or (nz, ny, nx, 3). "
                         "Stack components with numpy.stack((u, v[, w]), axis=-1).")
    shape = vectors.shape[:-1]
    if vectors.ndim == 4 and 0 < min(shape) < 2:
        raise ValueError(f"vectors has shape {vectors.shape}; a volume needs 2 or more samples along each axis. "
                         "Pass a flat one as (ny, nx, 2).")
    spacing = _per_axis("spacing", spacing, len(shape))
    if min(spacing[:len(shape)]) <= 0.0:
        raise ValueError(f"spacing is {spacing[:len(shape)]}; it must be above 0. Flip the array and the component "
                         "along an axis that runs backwards.")
    origin = _per_axis("origin", origin, len(shape))
    parameters = _parameters(feature_size, streak_length, seed, follow_curvature, phase, mask_threshold, octaves)
    threads = _threads(threads)
    out = _output(out, shape, vectors)
    if out.size:
        if len(shape) == 2:
            vectors = vectors[np.newaxis]
        _kernel.image(parameters, vectors, spacing, origin, threads, out.reshape(-1))
    return out


def noise_at(points, vectors, normals=None, bends=None, *, feature_size=8.0, streak_length=6.0, seed=0,
             phase=None, mask_threshold=0.0, octaves=1, threads=None, out=None):
    """Noise at places in any order, streaking along the vectors there.

    points: shape (n, 2) or (n, 3), in world units, finite.
    vectors: the same shape. Samples that are masked, NaN or infinite get 0.
    normals: shape (n, 3), of any length, where the points lie on surfaces; needs points in 3D. Where a normal
        is 0 or NaN the sample is taken as one in space.
    bends: the same shape as points: curvature (u . grad) u of the streamlines through the points, u being unit
        vectors, in 1 / world units. None: streaks are straight, since places alone do not tell it.

    The other arguments, the result (shape (n,)) and the errors are those of `noise`.
    """
    points = _numbers("points", points)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"points has shape {points.shape}; it must be (n, 2) or (n, 3), a row for each place.")
    if not np.isfinite(points).all():
        raise ValueError(f"points of shape {points.shape} holds NaN, infinite or masked places; leave those rows out.")
    vectors = _rows("vectors", vectors, points.shape)
    if normals is not None:
        if points.shape[1] != 3:
            raise ValueError(f"normals need points in 3D, but points has shape {points.shape}; leave them out.")
        normals = _rows("normals", normals, points.shape)
    if bends is not None:
        bends = _rows("bends", bends, points.shape)
    parameters = _parameters(feature_size, streak_length, seed, True, phase, mask_threshold, octaves)
    threads = _threads(threads)
    out = _output(out, points.shape[:1], points, vectors, normals, bends)
    if out.size:
        _kernel.points(parameters, *(a if a is None else a[np.newaxis, np.newaxis]
                                     for a in (points, vectors, normals, bends)), threads, out)
    return out


def _numbers(name, values):
    """As float32 or float64 in native byte order, masked ones as NaN; a copy only where it must be."""
    array = np.ma.asanyarray(values)
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{name} of shape {array.shape} holds {array.dtype}; it must be real numbers, "
                         "such as float32 or float64.")
    double = array.dtype.kind != "f" or array.dtype.itemsize > 4
    array = array.astype(np.float64 if double else np.float32, copy=False)
    array = array.filled(np.nan)
    return array if all(s % array.itemsize == 0 for s in array.strides) and array.flags.aligned else array.copy()


def _rows(name, values, shape):
    array = _numbers(name, values)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be that of points, {shape}.")
    return array


def _per_axis(name, value, axes):
    """Three numbers from one or `axes`; in 2D the third counts for nothing."""
    try:
        values = np.broadcast_to(np.asarray(value, dtype=np.float64), (axes,))
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; it must be one number or {axes}, along {', '.join('xyz'[:axes])}.") from None
    if not np.isfinite(values).all():
        raise ValueError(f"{name} is {value!r}; it must be finite.")
    filler = 1.0 if name == "spacing" else 0.0
    return tuple(values.tolist() + [filler] * (3 - axes))


def _number(name, value, least, most, remedy, above=False, whole=False):
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not (least < number if above else least <= number) or not number <= most or (whole and number != int(number)):
        raise ValueError(f"{name} is {value!r}; it must be {remedy}.")
    return int(value) if whole else number


def _parameters(feature_size, streak_length, seed, follow_curvature, phase, mask_threshold, octaves):
    largest = float(np.finfo(np.float64).max)
    p = _kernel.Parameters()
    p.feature_size = _number("feature_size", feature_size, 0.0, largest, "positive and finite", above=True)
    p.streak_length = _number("streak_length", streak_length, 1.0, 20.0, "from 1 to 20")
    p.seed = _number("seed", seed, 0, 2**32 - 1, "a whole number from 0 to 2**32 - 1", whole=True)
    p.follow_curvature = bool(follow_curvature)
    if phase is not None:
        p.motion = True
        number = _number("phase", phase, -largest, largest, "None or finite")
        p.phase = number - math.floor(number)
    p.mask_threshold = _number("mask_threshold", mask_threshold, 0.0, largest, "0 or more, and finite")
    p.octaves = _number("octaves", octaves, 1, 16, "a whole number from 1 to 16", whole=True)
    return p


def _threads(threads):
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return _number("threads", threads, 1, 1024, "None or a whole number from 1 to 1024", whole=True)


def _output(out, shape, *inputs):
    if out is None:
        return np.empty(shape, np.float32)
    if not isinstance(out, np.ndarray) or out.shape != shape or out.dtype != np.float32 or \
            not out.flags.c_contiguous or not out.flags.writeable:
        raise ValueError(f"out has shape {getattr(out, 'shape', None)} and type {getattr(out, 'dtype', type(out))}; it must "
                         f"be a writable C-contiguous float32 array of shape {shape}, as numpy.empty makes.")
    for array in inputs:
        if array is not None and np.may_share_memory(out, array):
            raise ValueError(f"out of shape {shape} shares memory with an input; pass another array.")
    return out
