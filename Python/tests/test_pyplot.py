# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Flow in axes of matplotlib: what is drawn, in the pixels of the axes."""
import io

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from steerablenoise.pyplot import flow  # noqa: E402

X, Y = np.linspace(-3.0, 3.0, 61), np.linspace(10.0, 12.0, 41)


@pytest.fixture
def ax():
    figure, axes = plt.subplots(figsize=(5, 3), dpi=100)
    yield axes
    plt.close(figure)


def uniform(u, v):
    return np.full((41, 61), float(u)), np.full((41, 61), float(v))


def drawn(image):
    """RGBA in 0 to 1, the first row at the bottom."""
    renderer = image.get_figure().canvas.get_renderer()
    image.axes.apply_aspect()
    rgba, *_ = image.make_image(renderer)
    return rgba / 255.0


def direction(picture):
    """Of lines, in degrees from the rows, 0 to 180."""
    gy, gx = np.gradient(picture)
    return np.degrees(0.5 * np.arctan2(2 * (gx * gy).sum(), (gx * gx).sum() - (gy * gy).sum()) + np.pi / 2) % 180


@pytest.mark.parametrize("backwards", ["", "x", "y"])
@pytest.mark.parametrize("u, v", [(1.0, 1.0), (2.0, -0.5)])
def test_streaks_have_the_direction_on_the_page(ax, u, v, backwards):
    image = flow(ax, X, Y, *uniform(u, v), feature_size=12.0)
    if backwards:
        getattr(ax, f"invert_{backwards}axis")()
    (x0, y0), (x1, y1) = ax.transData.transform([(0.0, 11.0), (u, 11.0 + v)])
    wanted = np.degrees(np.arctan2(y1 - y0, x1 - x0)) % 180
    assert abs(direction(drawn(image)[..., 0]) - wanted) < 3.0


def test_a_sample_for_each_pixel_of_the_axes(ax):
    image = flow(ax, X, Y, *uniform(1, 1))
    box = ax.bbox
    rows, columns, _ = drawn(image).shape
    assert abs(rows - box.height) <= 1 and abs(columns - box.width) <= 1
    # Half of it in view: the same pixels, half of the data.
    ax.set_xlim(0.0, 3.0)
    assert abs(drawn(image).shape[1] - box.width) <= 1
    ax.set_xlim(0.0, 6.0)
    assert abs(drawn(image).shape[1] - box.width / 2) <= 2
    ax.set_xlim(4.0, 6.0)
    assert image.make_image(image.get_figure().canvas.get_renderer())[0] is None
    image.get_figure().canvas.draw()


def test_streaks_are_as_wide_at_every_resolution(ax):
    image = flow(ax, X, Y, *uniform(1, 0.5), feature_size=6.0)
    coarse = drawn(image)[..., 0]
    image.get_figure().set_dpi(200)
    fine = drawn(image)[..., 0]
    rows, columns = (min(a, b // 2) for a, b in zip(coarse.shape, fine.shape))
    mean = fine[:2 * rows, :2 * columns].reshape(rows, 2, columns, 2).mean(axis=(1, 3))
    assert np.corrcoef(mean.ravel(), coarse[:rows, :columns].ravel())[0, 1] > 0.95


def test_streaks_go_with_the_data(ax):
    image = flow(ax, X, Y, *uniform(1, 0.5))
    ax.set_xlim(-3.0, 0.0)
    before = drawn(image)[..., 0]
    width = before.shape[1]
    pixels = 30
    step = 3.0 * pixels / ax.bbox.width
    ax.set_xlim(-3.0 + step, step)
    after = drawn(image)[..., 0]
    assert np.abs(after[:, :width - pixels - 2] - before[:, pixels:width - 2]).max() < 0.05


def test_colours_keep_their_mean(ax):
    image = flow(ax, X, Y, *uniform(1, 1), color=np.full((41, 61), 0.7), cmap="gray", vmin=0.3, vmax=1.1)
    np.testing.assert_allclose(drawn(image)[..., :3].mean(axis=(0, 1)), 0.5, atol=0.02)
    assert image.get_clim() == (0.3, 1.1)
    plain = flow(ax, X, Y, *uniform(1, 1), color="tab:red", intensity=0.0, alpha=0.5)
    np.testing.assert_allclose(drawn(plain)[5, 5], (*matplotlib.colors.to_rgb("tab:red"), 0.5), atol=0.005)
    shown = flow(ax, X, Y, *uniform(1, 1), color=np.tile(X, (41, 1)), cmap="gray", intensity=0.0)
    np.testing.assert_allclose(drawn(shown)[20, :, 0], np.linspace(0, 1, drawn(shown).shape[1]), atol=0.01)


@pytest.mark.parametrize("missing", [np.nan, -30000.0, "masked"])
@pytest.mark.filterwarnings("ignore:.*missing")
def test_missing_vectors_are_not_drawn(ax, missing):
    u, v = uniform(1, 1)
    u = np.ma.array(u)
    u[:, 40:] = np.ma.masked if missing == "masked" else missing
    alpha = drawn(flow(ax, X, Y, u, v))[20, :, 3]
    # Up to the last column that is there.
    assert abs((alpha == 1.0).mean() - 39 / 60) < 0.01 and abs((alpha == 0.0).mean() - 21 / 60) < 0.01


def test_still_places_have_the_plain_colour(ax):
    u, v = uniform(1, 1)
    u[:, :30] = v[:, :30] = 1e-3
    rgba = drawn(flow(ax, X, Y, u, v, color="blue", mask_threshold=0.1))
    assert np.ptp(rgba[:, :100, 2]) == 0.0 and np.ptp(rgba[:, 200:, 2]) > 0.1


def test_places_may_be_a_mesh_uneven_or_backwards(ax):
    field = Y[:, np.newaxis] - 11.0 + 0 * X, 0 * Y[:, np.newaxis] + X
    wanted = drawn(flow(ax, X, Y, *field))
    assert np.array_equal(drawn(flow(ax, *np.meshgrid(X, Y), *field)), wanted)
    assert np.array_equal(drawn(flow(ax, X[::-1], Y, *(part[:, ::-1] for part in field))), wanted)
    some = np.r_[0:20:3, 20:60, 60]
    uneven = drawn(flow(ax, X[some], Y, *(part[:, some] for part in field)))
    assert np.abs(uneven - wanted).mean() < 0.01


def test_limits_are_those_of_the_data_unless_set(ax):
    ax.invert_yaxis()
    flow(ax, X, Y, *uniform(1, 1))
    assert ax.get_xlim() == (-3.0, 3.0) and ax.get_ylim() == (12.0, 10.0)
    ax.set_xlim(-1.0, 1.0)
    flow(ax, X, Y, *uniform(1, 1))
    assert ax.get_xlim() == (-1.0, 1.0)


@pytest.mark.parametrize("kind", ["png", "pdf", "svg"])
def test_files(ax, kind):
    image = flow(ax, X, Y, *uniform(1, 1), color=np.tile(X, (41, 1)), phase=0.25)
    image.get_figure().colorbar(image)
    before = drawn(image)
    image.set_phase(0.5)
    assert not np.array_equal(drawn(image), before)
    file = io.BytesIO()
    image.get_figure().savefig(file, format=kind, dpi=50)
    assert file.tell() > 1000


@pytest.mark.parametrize("axis", ["x", "y"])
def test_axes_that_are_not_linear_are_refused(ax, axis):
    getattr(ax, f"set_{axis}scale")("log")
    with pytest.raises(ValueError, match=rf"{axis} axis is log; flow needs linear axes.*log10\({axis}\)"):
        flow(ax, X + 4.0, Y, *uniform(1, 1))


def test_round_axes_are_refused():
    figure, ax = plt.subplots(subplot_kw={"projection": "polar"})
    with pytest.raises(ValueError, match="polar; flow needs rectilinear"):
        flow(ax, X, Y, *uniform(1, 1))
    plt.close(figure)


@pytest.mark.parametrize("change, words", [
    ({"u": np.zeros((4, 5))}, ("u has shape (4, 5)", "v (41, 61)", "meshgrid")),
    ({"x": np.arange(5.0)}, ("x has shape (5,)", "(61,)")),
    ({"y": np.zeros(41)}, ("y of shape (41,)", "go one way")),
    ({"x": np.random.default_rng(0).normal(size=(41, 61))}, ("x of shape (41, 61)", "Interpolate")),
    ({"color": np.zeros((3, 3))}, ("color has shape (3, 3)", "u's shape (41, 61)")),
    ({"intensity": 2.0}, ("intensity is 2.0", "from 0 to 1")),
    ({"feature_size": 0.0}, ("feature_size is 0.0", "points")),
    ({"streak_length": 50.0}, ("streak_length is 50.0", "from 1 to 20"))])
def test_errors(ax, change, words):
    u, v = uniform(1, 1)
    arguments = {"x": X, "y": Y, "u": u, "v": v, **change}
    with pytest.raises(ValueError) as error:
        flow(ax, **arguments)
    for word in words:
        assert word in str(error.value)
