# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A flow as noise over colour in axes of matplotlib."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.image import AxesImage
from matplotlib.transforms import IdentityTransform

from . import _arguments as arguments
from . import _on_grid
from ._color import shade

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize
    from matplotlib.typing import ColorType
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import Unpack

__all__ = ["FlowImage", "flow"]
FEWEST_PIXELS = 4.0  # of a lattice cell


def flow(ax: Axes, x: ArrayLike, y: ArrayLike, u: ArrayLike, v: ArrayLike, *,
         color: ArrayLike | ColorType | None = None, cmap: str | Colormap | None = None,
         norm: str | Normalize | None = None, vmin: float | None = None, vmax: float | None = None,
         feature_size: float = 4.0, intensity: float = 0.6, alpha: float | None = None, zorder: float = 0.0,
         **options: Unpack[arguments.MoreOptions]) -> FlowImage:
    """Draw the flow (u, v) into `ax` as streaks over colour, sharp at every zoom and resolution.

    x, y: where the rows and columns lie, in data units: 1-D, evenly spaced or not, or as numpy.meshgrid makes them.
    u, v: shape (len(y), len(x)), along x and y in data units. Where one is masked or NaN nothing is drawn.
    color: an array of the same shape for `cmap`, `norm`, `vmin` and `vmax`, or one colour; None: grey.
    feature_size: width of a streak in points (1/72 inch); it is never drawn with less than 4 pixels.
    intensity: how much the noise lightens and darkens the colours, 0 to 1.
    alpha, zorder: as for every artist.
    options: other keywords of `steerablenoise.noise`, such as streak_length, seed, phase and basis.

    Returns the image, which fig.colorbar takes. The noise is made when the axes are drawn, one sample for each
    pixel of them. Raises ValueError for shapes that do not fit, and for axes that are not linear: a straight flow
    would be bent there.
    """
    _refuse_other_than_linear(ax)
    image = FlowImage(ax, x, y, u, v, color=color, cmap=cmap, norm=norm, feature_size=feature_size,
                      intensity=intensity, **options)
    image.set_clim(vmin, vmax)
    image.set_alpha(alpha)
    image.set_zorder(zorder)
    image.set_clip_path(ax.patch)
    image.autoscale_None()
    ax.add_image(image)
    left, right, bottom, top = image.get_extent()
    image.sticky_edges.x[:] = left, right
    image.sticky_edges.y[:] = bottom, top
    ax.update_datalim(((left, bottom), (right, top)))
    ax.autoscale_view()
    return image


class FlowImage(AxesImage):
    """What `flow` returns: an image that makes its noise at the pixels it is drawn to."""

    def __init__(self, ax: Axes, x: ArrayLike, y: ArrayLike, u: ArrayLike, v: ArrayLike, *, color: Any, cmap: Any,
                 norm: Any, feature_size: float, intensity: float, **options: Unpack[arguments.MoreOptions]) -> None:
        parts = [arguments.numbers("u", u), arguments.numbers("v", v)]
        shape = parts[0].shape
        if len(shape) != 2 or parts[1].shape != shape or min(shape) < 2:
            raise ValueError(f"u has shape {shape} and v {parts[1].shape}; both must be (ny, nx), 2 or more of each. "
                             "Make them alike, as numpy.meshgrid does.")
        self._places = [_line("x", x, shape, 1), _line("y", y, shape, 0)]
        self._single = None
        values = np.zeros(shape)
        if color is None or isinstance(color, str) or np.ndim(color) == 1:
            self._single = to_rgb("0.6" if color is None else color)
        else:
            values = arguments.numbers("color", color)
            if values.shape != shape:
                raise ValueError(f"color has shape {values.shape}; it must be one colour, or an array of u's shape {shape}.")
        self._fields = [*parts, values]
        for i, (place, axis) in enumerate(zip(self._places, (1, 0))):
            if place[0] > place[-1]:
                self._places[i] = place[::-1]
                self._fields = [np.flip(field, axis) for field in self._fields]
        self._feature_size = arguments.number("feature_size", feature_size, 0.0, 1000.0,
                                              "a width in points above 0, up to 1000", above=True)
        self._intensity = arguments.number("intensity", intensity, 0.0, 1.0, "from 0 to 1")
        self._options = options
        # Complaints come here, not in the middle of drawing; fill values must not be interpolated.
        limit = arguments.Settings(**options).limit([part[np.newaxis] for part in parts])
        if math.isfinite(limit):
            self._fields[:2] = np.where(np.hypot(*self._fields[:2]) > limit, np.nan, self._fields[:2])
        (left, right), (bottom, top) = ((place[0], place[-1]) for place in self._places)
        super().__init__(ax, cmap=cmap, norm=norm, extent=(left, right, bottom, top), origin="lower")
        self.set_data(np.ma.masked_invalid(self._fields[2]))  # type: ignore[no-untyped-call,unused-ignore]

    def set_phase(self, phase: float | None) -> None:
        """Another picture of the loop of motion, 0 to 1, for an animation; None: still noise."""
        self._options["phase"] = phase
        arguments.Settings(**self._options)
        self.stale = True

    def get_cursor_data(self, event: Any) -> None:
        """Nothing: the pixels are not the data."""

    def make_image(self, renderer: Any, magnification: float = 1.0, unsampled: bool = False) -> Any:
        """RGBA of the axes' pixels that data lie under."""
        if unsampled:
            raise ValueError("a FlowImage has no pixels before it is drawn")
        _refuse_other_than_linear(self.axes)
        (x0, y0), (x1, y1) = self.axes.transData.transform([(p[0], q) for p, q in
                                                            zip([self._places[0], self._places[0][::-1]],
                                                                (self._places[1][0], self._places[1][-1]))])
        # Pixels of the drawn picture: those of the figure times `magnification`.
        box = self.axes.bbox.extents
        left, right = _overlap(x0, x1, box[0], box[2])
        bottom, top = _overlap(y0, y1, box[1], box[3])
        columns = math.ceil((right - left) * magnification)
        rows = math.ceil((top - bottom) * magnification)
        if columns < 2 or rows < 2:
            return None, 0, 0, IdentityTransform()
        at = [np.arange(columns) + 0.5, np.arange(rows) + 0.5]
        at[0] = left + at[0] / magnification
        at[1] = bottom + at[1] / magnification
        # Along axes that run backwards too.
        data = [place[0] + (pixels - start) * ((place[-1] - place[0]) / (end - start))
                for place, pixels, start, end in zip(self._places, at, (x0, y0), (x1, y1))]
        u, v, values = (_bilinear(field, self._places, data) for field in self._fields)
        # The direction that they have on the page, and the length that the thresholds speak of.
        across = u * ((x1 - x0) / (self._places[0][-1] - self._places[0][0]))
        up = v * ((y1 - y0) / (self._places[1][-1] - self._places[1][0]))
        length = np.hypot(across, up)
        scale = np.divide(np.hypot(u, v), length, out=np.zeros_like(length), where=length > 0.0)
        size = max(self._feature_size * self.axes.figure.dpi / 72.0 * magnification, FEWEST_PIXELS)
        steps = [abs((end - start) * magnification) / (len(place) - 1)
                 for place, start, end in zip(self._places, (x0, y0), (x1, y1))]
        changed: dict[str, Any] = {**self._options, "feature_size": size, "mask_upper_threshold": arguments.LARGEST}
        known = np.isfinite(u) & np.isfinite(v) & np.isfinite(values)
        # The lattice hangs on the data, so that streaks go with them when the view is moved.
        shown = _on_grid([across * scale, up * scale], arguments.Settings(**changed), 1.0, (magnification * (at[0][0] - x0), magnification * (at[1][0] - y0)),
                         stride=int(round(min(steps))))
        if self._single is None:
            rgb = self.to_rgba(np.where(known, values, 0.0))[..., :3]
        else:
            rgb = np.broadcast_to(self._single, (*u.shape, 3))
        rgba = np.empty((*u.shape, 4), np.uint8)
        rgba[..., :3] = np.round(255.0 * shade(rgb, np.nan_to_num(shown), self._intensity))
        alpha = self.get_alpha()
        rgba[..., 3] = np.where(known, round(255.0 * (1.0 if alpha is None else float(alpha))), 0)
        return rgba, left, bottom, IdentityTransform()


def _refuse_other_than_linear(ax: Axes) -> None:
    if ax.name != "rectilinear":
        raise ValueError(f"the axes are {ax.name}; flow needs rectilinear ones, as pyplot.subplots makes.")
    for name, scale in (("x", ax.get_xscale()), ("y", ax.get_yscale())):
        if scale != "linear":
            raise ValueError(f"the {name} axis is {scale}; flow needs linear axes, since others bend a straight flow. Draw "
                             f"against log10({name}) on a linear axis, with that component divided by {name} * ln(10).")


def _line(name: str, values: Any, shape: tuple[int, ...], axis: int) -> NDArray[Any]:
    """1-D places from themselves or from a mesh of them."""
    array = arguments.numbers(name, values).astype(np.float64)
    if array.ndim == 2 and array.shape == shape:
        line = array[0] if axis else array[:, 0]
        if not np.array_equal(array, np.broadcast_to(line if axis else line[:, np.newaxis], shape)):
            raise ValueError(f"{name} of shape {shape} differs from one {'row' if axis else 'column'} to the next; the grid "
                             "must be that of numpy.meshgrid. Interpolate to such a one first.")
        array = line
    if array.shape != (shape[axis],):
        raise ValueError(f"{name} has shape {array.shape}; it must be ({shape[axis]},), one place for each "
                         f"{'column' if axis else 'row'} of u, or u's shape {shape}.")
    steps = np.diff(array)
    if not np.isfinite(array).all() or not ((steps > 0).all() or (steps < 0).all()):
        raise ValueError(f"{name} of shape {array.shape} must be finite and go one way, without steps of 0. Sort it with "
                         "the columns and rows that belong to it.")
    return array


def _overlap(start: float, end: float, low: float, high: float) -> tuple[int, int]:
    """Whole pixels in which both intervals lie."""
    return (math.floor(max(min(start, end), low) + 1e-6), math.ceil(min(max(start, end), high) - 1e-6))


def _bilinear(field: NDArray[Any], places: list[NDArray[Any]], at: list[NDArray[Any]]) -> NDArray[Any]:
    """Values of a rectilinear grid at the columns at[0] and rows at[1]; half a pixel outside it goes on."""
    for axis, place, here in ((0, places[1], at[1]), (1, places[0], at[0])):
        left = np.clip(np.searchsorted(place, here, side="right") - 1, 0, len(place) - 2)
        share = np.clip((here - place[left]) / (place[left + 1] - place[left]), 0.0, 1.0).astype(field.dtype)
        share = share[:, np.newaxis] if axis == 0 else share
        low, high = field.take(left, axis), field.take(left + 1, axis)
        # Not low + share (high - low), in which an unknown value spoils its neighbour.
        field = np.where(share == 0.0, low, np.where(share == 1.0, high, (1 - share) * low + share * high))
    return field
