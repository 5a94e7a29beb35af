# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Noise that streaks along a vector field, over NumPy arrays.

The model is Rice's "Steerable Perlin Noise" (SIGGRAPH Talks 2025, doi 10.1145/3721239.3734101). The arithmetic is
that of vtkSteerableNoiseFilter, and so are the bits, but neither VTK nor ParaView is needed.

`noise` is for grids, `noise_at` for points; `metric` gives the tensors that steer both, and `subband_tiles` the tiles
of subband noise. `steerablenoise.pyplot.flow` draws a flow into axes of matplotlib, and with PyVista 0.48 or newer
every mesh has `mesh.steerable`.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from . import _arguments as arguments
from . import _kernel

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Unpack

__all__ = ["metric", "noise", "noise_at", "subband_tiles"]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("steerablenoise")
    if name.startswith("vtk"):
        raise ImportError(f"{name} is not in the wheel for NumPy, but in the package of the same name that the VTK module "
                          "builds. Run pvpython, or the Python of that VTK, with the folder of that package on PYTHONPATH.")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def noise(vectors: ArrayLike | tuple[ArrayLike, ...], *, spacing: float | tuple[float, ...] = 1.0,
          origin: float | tuple[float, ...] = 0.0, feature_size: float = 8.0, streak_length: float = 6.0,
          seed: int = 0, follow_curvature: bool = True, phase: float | None = None, speed: float = 1.0,
          basis: Literal["gradient", "value", "streaks"] = "gradient", density: float = 0.25, strength: float = 1.0,
          reference_magnitude: float | None = None, eigenvalue_sum: float = 3.2,
          normalization: Literal["unit_variance", "weight_sum", "none"] = "unit_variance",
          mask_threshold: float = 0.0, mask_upper_threshold: float = 0.0, blank: float = 0.0, octaves: int = 1,
          lacunarity: float = 2.0, gain: float = 0.5, turbulence: bool = False, period: int | tuple[int, ...] = 0,
          threads: int | None = None, out: NDArray[np.float32] | None = None) -> NDArray[np.float32]:
    """Noise on a regular grid, streaking along the vectors of its samples.

    vectors: shape (ny, nx, 2), or (nz, ny, nx, 3) with 2 or more samples along each axis; the components are along
        x, y[, z]. Or a tuple of components, (u, v) of shape (ny, nx) or (u, v, w) of shape (nz, ny, nx). float32
        and float64 are read where they lie, whatever their strides; other real numbers and masked arrays are
        copied. Only the directions count, but for the masks and `reference_magnitude`.
    spacing, origin: distance of the samples, above 0, and place of the first, in world units: one number, or one
        for each of x, y[, z] in this order.
    feature_size: side of a lattice cell in world units, above 0: about the width of a streak. Samples should be no
        further apart than a fourth of it; a warning says if they are.
    streak_length: half-length of a streak in cells, 1 to 20.
    seed: 0 to 2**32 - 1; another seed is other noise of the same kind.
    follow_curvature: streaks bend with the streamlines.
    phase: None for still noise; a number for one picture of a loop of motion along the flow, of which only the
        fraction counts.
    speed: half-lengths of a streak that it travels in a loop, -4 to 4.
    basis: "gradient": signed noise; "value": blobs; "streaks": sparse bright streaks from 0 up whose heads point
        downstream, `density` (0.01 to 1) saying how densely they lie.
    strength: 0 (no direction) to 1 (full streaks).
    reference_magnitude: None: the same strength everywhere; a length above 0: the strength grows with the vectors up
        to it.
    eigenvalue_sum: trace of the metric, 2 to 16: larger is thinner, with gaps from 4 on.
    normalization: what the sum of surflets is divided by: its standard deviation ("unit_variance", even contrast),
        the sum of its weights ("weight_sum", the paper's; needs eigenvalue_sum of at most 4) or nothing ("none").
    mask_threshold: vectors no longer than this are blank; 0: only those that are 0.
    mask_upper_threshold: vectors longer than this are blank and lend no direction to their neighbours; 0: fill
        values, such as -30000 or 1e20, are found and named in a warning. These are at least 99, 16 times as long
        as any other vector, and as alike as one number in 1 to 3 components.
    blank: what samples get that are beyond a threshold, 0, masked, NaN or infinite, such as 0 or NaN.
    octaves: 1 to 16 terms of a fractal sum, each `lacunarity` (1 to 8) times as fine and `gain` (0 to 1) times as
        strong as the one before; `turbulence`: of absolute values.
    period: cells along each axis after which the noise repeats, one number or one for each axis; 0: never.
    threads: how many, 1 or more; None: as many as there are processors for this process. Never changes a bit.
    out: where to write, a C-contiguous float32 array of the result's shape that shares no memory with vectors.

    Returns float32 of shape (ny, nx) or (nz, ny, nx), mean 0 and variance about 1. Raises ValueError for an argument
    that cannot be used, with its name and what would do. The GIL is released; Ctrl-C is answered.

    Source: Rice 2025 for the metric and the surflets; bends, motion and masks are this project's
    (Documentation/noise-model.md).
    """
    settings = arguments.Settings(
        feature_size=feature_size, streak_length=streak_length, seed=seed, follow_curvature=follow_curvature,
        phase=phase, speed=speed, basis=basis, density=density, strength=strength,
        reference_magnitude=reference_magnitude, eigenvalue_sum=eigenvalue_sum, normalization=normalization,
        mask_threshold=mask_threshold, mask_upper_threshold=mask_upper_threshold, blank=blank, octaves=octaves,
        lacunarity=lacunarity, gain=gain, turbulence=turbulence, period=period, threads=threads)
    return _on_grid(arguments.grid_components(vectors), settings, spacing, origin, out)


def _on_grid(components: list[NDArray[Any]], settings: arguments.Settings, spacing: Any, origin: Any,
             out: NDArray[np.float32] | None = None, stride: int = 1) -> NDArray[np.float32]:
    """`components` of a flat grid may be three: the third counts for the length alone.

    stride: samples for each one that the components were interpolated from.
    """
    shape = components[0].shape
    axes = len(shape)
    if axes == 3 and 0 < min(shape) < 2:
        raise ValueError(f"vectors has shape {(*shape, 3)}; a volume needs 2 or more samples along each axis. "
                         "Pass a flat one as (ny, nx, 2).")
    spacing = arguments.per_axis("spacing", spacing, axes, 1.0)
    if min(spacing[:axes]) <= 0.0:
        raise ValueError(f"spacing is {spacing[:axes]}; it must be above 0. Flip the array and the component "
                         "along an axis that runs backwards.")
    origin = arguments.per_axis("origin", origin, axes, 0.0)
    parameters = settings.for_axes(axes)
    finest = parameters.feature_size / parameters.lacunarity ** (parameters.octaves - 1)
    if finest < 3.99 * max(spacing[:axes]):
        arguments.warn(f"The samples are {max(spacing[:axes]):g} apart, too far for noise of feature_size {finest:g}. "
                       f"Set feature_size to at least {4 * max(spacing[:axes]):g}, or interpolate to a finer grid.")
    out = arguments.output(out, shape, *components)
    if out.size:
        if axes == 2:
            components = [component[np.newaxis] for component in components]
        counts = _kernel.image(parameters, axes, components, spacing, origin, stride,
                               settings.limit(components), settings.blank, settings.threads, out.reshape(-1))
        arguments.tell(counts, out.size)
    return out


def noise_at(points: ArrayLike, vectors: ArrayLike, normals: ArrayLike | None = None, bends: ArrayLike | None = None,
             *, out: NDArray[np.float32] | None = None,
             **options: Unpack[arguments.Options]) -> NDArray[np.float32]:
    """Noise at places in any order, streaking along the vectors there.

    points: shape (n, 2) or (n, 3), in world units, finite.
    vectors: the same shape.
    normals: shape (n, 3), of any length, where the points lie on surfaces; needs points in 3D. Where a normal is 0 or
        NaN the sample is taken as one in space.
    bends: the same shape as points: curvature (u . grad) u of the streamlines through the points, u being unit
        vectors, in 1 / world units. None: streaks are straight, since places alone do not tell it.
    options: the other keywords of `noise` but spacing and origin.

    Result (shape (n,)) and errors are those of `noise`.
    """
    points = arguments.numbers("points", points)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError(f"points has shape {points.shape}; it must be (n, 2) or (n, 3), a row for each place.")
    if not np.isfinite(points).all():
        raise ValueError(f"points of shape {points.shape} holds NaN, infinite or masked places; leave those rows out.")
    axes = points.shape[1]
    vectors = arguments.rows("vectors", vectors, points.shape)
    if normals is not None:
        if axes != 3:
            raise ValueError(f"normals need points in 3D, but points has shape {points.shape}; leave them out.")
        normals = arguments.rows("normals", normals, points.shape)
    if bends is not None:
        bends = arguments.rows("bends", bends, points.shape)
    settings = arguments.Settings(**options)
    out = arguments.output(out, points.shape[:1], points, vectors, normals, bends)
    if out.size:
        steering = arguments.row_components(vectors)
        counts = _kernel.points(settings.for_axes(axes), axes, arguments.row_components(points), steering,
                                normals if normals is None else arguments.row_components(normals),
                                bends if bends is None else arguments.row_components(bends),
                                settings.limit(steering), settings.blank, settings.threads, out)
        arguments.tell(counts, out.size)
    return out


def metric(vectors: ArrayLike, normals: ArrayLike | None = None, *, streak_length: float = 6.0, strength: float = 1.0,
           reference_magnitude: float | None = None, eigenvalue_sum: float = 3.2,
           threads: int | None = None) -> NDArray[np.float64]:
    """The metric tensors that steer the noise, before curvature.

    vectors: shape (..., 2) or (..., 3). Where a vector is 0, NaN or infinite the metric is the unit matrix.
    normals: the same shape with 3 components, of any length: the metrics of surfaces.
    streak_length, strength, reference_magnitude, eigenvalue_sum, threads: as for `noise`.

    Returns float64 of shape (..., 2, 2) or (..., 3, 3) in units of 1 / feature_size**2: symmetric, positive
    definite, smallest eigenvalue 1 / streak_length**2 along the vector. Raises ValueError as `noise` does.
    Source: Rice 2025, supplementary, section 1.
    """
    vectors = arguments.numbers("vectors", vectors)
    if vectors.ndim == 0 or vectors.shape[-1] not in (2, 3):
        raise ValueError(f"vectors has shape {vectors.shape}; it must be (..., 2) or (..., 3). "
                         "Stack components with numpy.stack((u, v[, w]), axis=-1).")
    axes = vectors.shape[-1]
    parts = None
    if normals is not None:
        if axes != 3:
            raise ValueError(f"normals need vectors in 3D, but vectors has shape {vectors.shape}; leave them out.")
        normals = arguments.rows("normals", normals, vectors.shape, "vectors")
        parts = arguments.row_components(normals.reshape(-1, 3))
    settings = arguments.Settings(streak_length=streak_length, strength=strength, eigenvalue_sum=eigenvalue_sum,
                                  reference_magnitude=reference_magnitude, threads=threads)
    out = np.empty((*vectors.shape, axes), np.float64)
    if out.size:
        _kernel.metrics(settings.parameters, axes, arguments.row_components(vectors.reshape(-1, axes)), parts,
                        settings.threads, out.reshape(-1))
    return out


def subband_tiles(*, orientations: int = 8, scales: int = 4, tile_size: int = 256, band_center: float = 0.125,
                  seed: int = 0) -> NDArray[np.float32]:
    """Periodic tiles of noise, one for each direction and octave of frequency.

    orientations: 3, 4, 6 or 8 directions. scales: 1 to 6 octaves, the finest first. tile_size: texels along a side, 16 to
    2048. band_center: frequency of the finest octave in cycles per texel, above 0 up to 1/4; the coarsest must
    have 2 or more cycles in a tile. seed: 0 to 2**32 - 1.

    Returns float32 of shape (tile_size, tile_size, scales, orientations), axes y, x, octave, direction: texel (x, y)
    lies at (x, y) / tile_size of the tile. Weighted sums of the bands are noise of any direction and size. Raises
    ValueError for an argument out of range. Source: Goldberg, Zwicker, Durand, "Anisotropic Noise" (SIGGRAPH 2008),
    section 2; the bits of vtkImageSubbandNoiseSource.
    """
    p = _kernel.SubbandParameters()
    p.orientations = arguments.whole("orientations", orientations, 3, 8, "3, 4, 6 or 8")
    p.scales = arguments.whole("scales", scales, 1, 6, "a whole number from 1 to 6")
    p.tile_size = arguments.whole("tile_size", tile_size, 16, 2048, "a whole number from 16 to 2048")
    p.band_center = arguments.number("band_center", band_center, 0.0, 0.25, "above 0, up to 0.25", above=True)
    p.seed = arguments.whole("seed", seed, 0, 2**32 - 1, "a whole number from 0 to 2**32 - 1")
    if p.orientations in (5, 7):
        raise ValueError(f"orientations is {orientations!r}; it must be 3, 4, 6 or 8.")
    coarsest = p.tile_size * p.band_center / 2 ** (p.scales - 1)
    if coarsest < 2.0:
        raise ValueError(f"scales is {scales}; the coarsest octave has {coarsest:g} cycles in a tile and needs 2. Take fewer "
                         "scales, a larger tile_size or a larger band_center.")
    tiles = np.empty((p.tile_size, p.tile_size, p.scales, p.orientations), np.float32)
    _kernel.tiles(p, tiles.reshape(-1))
    return tiles
