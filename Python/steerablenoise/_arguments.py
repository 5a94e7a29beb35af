# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Arguments as the kernel wants them, or a ValueError with name, shape and remedy."""
from __future__ import annotations

import math
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from typing_extensions import TypedDict

    class MoreOptions(TypedDict, total=False):
        """The keywords of `noise` that every function passes on."""

        streak_length: float
        seed: int
        follow_curvature: bool
        phase: float | None
        speed: float
        basis: Literal["gradient", "value", "streaks"]
        density: float
        strength: float
        reference_magnitude: float | None
        eigenvalue_sum: float
        normalization: Literal["unit_variance", "weight_sum", "none"]
        mask_threshold: float
        mask_upper_threshold: float
        blank: float
        octaves: int
        lacunarity: float
        gain: float
        turbulence: bool
        period: int | tuple[int, ...]
        threads: int | None

    class Options(MoreOptions, total=False):
        feature_size: float

LARGEST = float(np.finfo(np.float64).max)


def numbers(name: str, values: Any) -> NDArray[Any]:
    """As float32 or float64 in native byte order, masked ones as NaN; a copy only where it must be."""
    array: Any = np.ma.asanyarray(values)  # type: ignore[no-untyped-call,unused-ignore]
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{name} of shape {array.shape} holds {array.dtype}; it must be real numbers, "
                         "such as float32 or float64.")
    double = array.dtype.kind != "f" or array.dtype.itemsize > 4
    array = array.astype(np.float64 if double else np.float32, copy=False)
    plain: NDArray[Any] = array.filled(np.nan) if isinstance(array, np.ma.MaskedArray) else np.asarray(array)
    return plain if all(s % plain.itemsize == 0 for s in plain.strides) and plain.flags.aligned else plain.copy()


def grid_components(vectors: Any) -> list[NDArray[Any]]:
    """u, v[, w] of shape (ny, nx) or (nz, ny, nx)."""
    if isinstance(vectors, tuple):
        parts = [numbers(f"component {'uvw'[min(i, 2)]}", part) for i, part in enumerate(vectors)]
        shapes = [part.shape for part in parts]
        if len(parts) not in (2, 3) or any(shape != shapes[0] or len(shape) != len(parts) for shape in shapes):
            raise ValueError(f"vectors is a tuple of components with shapes {shapes}; it must be (u, v) of shape "
                             "(ny, nx), or (u, v, w) of shape (nz, ny, nx). Make them alike, as numpy.meshgrid does.")
        common = np.result_type(*parts)
        return [part.astype(common, copy=False) for part in parts]
    array = numbers("vectors", vectors)
    if (array.ndim, array.shape[-1:]) not in ((3, (2,)), (4, (3,))):
        raise ValueError(f"vectors has shape {array.shape}; it must be (ny, nx, 2) or (nz, ny, nx, 3). "
                         "Components of their own go into a tuple, (u, v) or (u, v, w).")
    return [array[..., c] for c in range(array.shape[-1])]


def rows(name: str, values: Any, shape: tuple[int, ...], of: str = "points") -> NDArray[Any]:
    array = numbers(name, values)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be that of {of}, {shape}.")
    return array


def row_components(array: NDArray[Any]) -> list[NDArray[Any]]:
    return [array[np.newaxis, np.newaxis, :, c] for c in range(array.shape[1])]


def per_axis(name: str, value: Any, axes: int, filler: float) -> tuple[float, float, float]:
    """Three numbers from one or `axes`; in 2D the third is `filler`, which counts for nothing."""
    try:
        values = np.broadcast_to(np.asarray(value, dtype=np.float64), (axes,))
    except (TypeError, ValueError):
        raise ValueError(f"{name} is {value!r}; it must be one number or {axes}, along "
                         f"{', '.join('xyz'[:axes])}.") from None
    if not np.isfinite(values).all():
        raise ValueError(f"{name} is {value!r}; it must be finite.")
    x, y, z = values.tolist() + [filler] * (3 - axes)
    return x, y, z


def number(name: str, value: Any, least: float, most: float, remedy: str, *, above: bool = False) -> float:
    try:
        result = float(value)
    except (TypeError, ValueError):
        result = math.nan
    if not (least < result if above else least <= result) or not result <= most:
        raise ValueError(f"{name} is {value!r}; it must be {remedy}.")
    return result


def whole(name: str, value: Any, least: int, most: int, remedy: str) -> int:
    result = number(name, value, least, most, remedy)
    if result != int(result):
        raise ValueError(f"{name} is {value!r}; it must be {remedy}.")
    return int(value)


def choice(name: str, value: Any, kinds: Any) -> Any:
    names = kinds.__members__
    if value not in names:
        raise ValueError(f"{name} is {value!r}; it must be one of {', '.join(map(repr, names))}.")
    return names[value]


def thread_count(threads: int | None) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return whole("threads", threads, 1, 1024, "None or a whole number from 1 to 1024")


class Settings:
    """What options say, checked."""

    def __init__(self, *, feature_size: float = 8.0, streak_length: float = 6.0, seed: int = 0,
                 follow_curvature: bool = True, phase: float | None = None, speed: float = 1.0,
                 basis: str = "gradient", density: float = 0.25, strength: float = 1.0,
                 reference_magnitude: float | None = None, eigenvalue_sum: float = 3.2,
                 normalization: str = "unit_variance", mask_threshold: float = 0.0,
                 mask_upper_threshold: float = 0.0, blank: float = 0.0, octaves: int = 1,
                 lacunarity: float = 2.0, gain: float = 0.5, turbulence: bool = False,
                 period: int | tuple[int, ...] = 0, threads: int | None = None) -> None:
        p = self.parameters = _kernel.Parameters()
        p.feature_size = number("feature_size", feature_size, 0.0, LARGEST, "positive and finite", above=True)
        p.streak_length = number("streak_length", streak_length, 1.0, 20.0, "from 1 to 20")
        p.seed = whole("seed", seed, 0, 2**32 - 1, "a whole number from 0 to 2**32 - 1")
        p.follow_curvature = bool(follow_curvature)
        if phase is not None:
            p.motion = True
            place = number("phase", phase, -LARGEST, LARGEST, "None or finite")
            p.phase = place - math.floor(place)
        p.speed = number("speed", speed, -4.0, 4.0, "from -4 to 4")
        p.basis = choice("basis", basis, _kernel.Basis)
        p.density = number("density", density, 0.01, 1.0, "from 0.01 to 1")
        p.strength = number("strength", strength, 0.0, 1.0, "from 0 to 1")
        if reference_magnitude is not None:
            p.strength_mode = _kernel.StrengthMode.magnitude
            p.reference_magnitude = number("reference_magnitude", reference_magnitude, 0.0, LARGEST,
                                           "None or positive and finite", above=True)
        p.eigenvalue_sum = number("eigenvalue_sum", eigenvalue_sum, 2.0, 16.0, "from 2 to 16")
        p.normalization = choice("normalization", normalization, _kernel.Normalization)
        if normalization == "weight_sum" and p.eigenvalue_sum > 4.0:
            raise ValueError(f"eigenvalue_sum is {eigenvalue_sum!r}; with normalization 'weight_sum' it must be 4 or less.")
        p.mask_threshold = number("mask_threshold", mask_threshold, 0.0, LARGEST, "0 or more, and finite")
        self.upper = number("mask_upper_threshold", mask_upper_threshold, 0.0, LARGEST,
                            "above 0 and finite, or 0 to have fill values found")
        self.blank = math.nan if blank != blank else number("blank", blank, -LARGEST, LARGEST, "finite or NaN")
        p.octaves = whole("octaves", octaves, 1, 16, "a whole number from 1 to 16")
        p.lacunarity = number("lacunarity", lacunarity, 1.0, 8.0, "from 1 to 8")
        p.gain = number("gain", gain, 0.0, 1.0, "from 0 to 1")
        p.turbulence = bool(turbulence)
        self.period = period
        self.threads = thread_count(threads)

    def for_axes(self, axes: int) -> _kernel.Parameters:
        """The parameters with the period of so many axes."""
        per = per_axis("period", self.period, axes, 0.0)
        x, y, z = (whole("period", cells, 0, 2**30 - 1, "whole numbers of cells, 0 or more") for cells in per)
        if (x or y or z) and self.parameters.octaves > 1 and self.parameters.lacunarity % 1.0:
            raise ValueError(f"lacunarity is {self.parameters.lacunarity}; with period and more than one octave it "
                             "must be a whole number.")
        self.parameters.period = [x, y, z]
        return self.parameters

    def limit(self, components: list[NDArray[Any]]) -> float:
        """How long vectors may be; a warning says which are taken for fill values."""
        if self.upper > 0.0:
            return self.upper
        overlong = _kernel.overlong(components, self.threads)
        if overlong is None:
            return math.inf
        found, value = overlong
        if found.fill:
            warn(f"{int(found.count)} samples hold {value:g}, far more than all others (the longest vector is "
                 f"{found.longest:g}, the next {found.rest:g}), as values do that stand for missing ones: they are "
                 "blank and count for nothing. mask_upper_threshold sets the limit by hand; 1e300 takes all of them.")
            return float(found.rest)
        warn(f"{int(found.count)} vectors are far longer than all others: with components up to {value:g}, "
             f"{found.longest:g} long, the next {found.rest:g}. If they stand for missing values, set "
             f"mask_upper_threshold={2 * found.rest:g}.")
        return math.inf


def tell(counts: tuple[int, int, int], samples: int) -> None:
    if 2 * counts[0] > samples:
        warn(f"{counts[0]} of {samples} samples have no direction (zero, NaN, infinite or along the surface's "
             "normal). Check that these are the right vectors.")


def warn(message: str) -> None:
    """A warning at the first caller outside this package."""
    package = __name__.rpartition(".")[0]
    level, frame = 1, sys._getframe()
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == package:
        level, frame = level + 1, frame.f_back
    warnings.warn(message, stacklevel=level)


def output(out: Any, shape: tuple[int, ...], *inputs: NDArray[Any] | None) -> NDArray[np.float32]:
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
