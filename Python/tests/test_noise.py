# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The installed wheel: python -m pytest Python/tests"""
import numpy as np
import pytest

from steerablenoise import noise, noise_at


def vortex(ny=60, nx=80):
    y, x = np.mgrid[:ny, :nx].astype(np.float64)
    return np.stack((-(y - 20.3), x - 31.7), axis=-1)


def swirl():
    z, y, x = np.mgrid[:12, :14, :16].astype(np.float64)
    return np.stack((-(y - 6.2), x - 7.1, 0.3 * z + 1.0), axis=-1)


@pytest.mark.parametrize("field", [vortex(), swirl()])
def test_threads_types_and_strides_change_nothing(field):
    field = field.astype(np.float32)
    plain = noise(field, feature_size=5, threads=1)
    assert plain.shape == field.shape[:-1] and plain.dtype == np.float32
    assert 0.3 < plain.std() < 2.0 and abs(plain.mean()) < 0.5
    wide = np.empty((*(2 * n for n in field.shape[:-1]), 2 * field.shape[-1]))
    strided = wide[(slice(None, None, 2),) * field.ndim]
    strided[...] = field
    backwards = np.asfortranarray(field[::-1].copy())[::-1]
    swapped = field.astype(field.dtype.newbyteorder())
    out = np.empty_like(plain)
    for same in (strided, backwards, swapped, field.astype(np.float64)):
        assert noise(same, feature_size=5, threads=3, out=out) is out
        assert np.array_equal(out, plain)


@pytest.mark.parametrize("change", [
    {"spacing": (1.0, 1.5)}, {"origin": (3.3, 0.0)}, {"feature_size": 6}, {"streak_length": 3}, {"seed": 1},
    {"follow_curvature": False}, {"phase": 0.25}, {"mask_threshold": 20.0}, {"octaves": 2}])
def test_every_option_counts(change):
    assert not np.array_equal(noise(vortex(), **change), noise(vortex()))


def test_streaks_lie_along_the_flow():
    field = np.zeros((200, 200, 2))
    field[..., 0] = 1.0
    n = noise(field)
    assert np.abs(np.diff(n, axis=0)).mean() > 2.0 * np.abs(np.diff(n, axis=1)).mean()


def test_missing_and_stagnant_samples_are_zero():
    field = vortex()
    mask = np.zeros(field.shape, bool)
    mask[5, 7, 1] = True
    field[9, 11, 0] = np.nan
    field[13, 17, 1] = np.inf
    n = noise(np.ma.array(field, mask=mask), mask_threshold=4.0)
    assert n[5, 7] == n[9, 11] == n[13, 17] == 0.0
    assert not n[np.hypot(*np.moveaxis(vortex(), -1, 0)) <= 4.0].any()
    assert np.count_nonzero(n) > 0.9 * n.size


def test_points_are_the_grid_without_curvature():
    field = vortex()
    places = np.stack(np.meshgrid(np.arange(80.0), np.arange(60.0)), axis=-1).reshape(-1, 2)
    straight = noise(field, follow_curvature=False)
    np.testing.assert_allclose(noise_at(places, field.reshape(-1, 2)), straight.ravel(), atol=1e-5)
    # Around a vortex (u . grad) u points to its centre and is 1 / r long.
    r = np.stack((places[:, 0] - 31.7, places[:, 1] - 20.3), axis=-1)
    bent = noise_at(places, field.reshape(-1, 2), bends=-r / (r**2).sum(1, keepdims=True))
    far = np.hypot(*r.T) > 20
    curved = noise(field).ravel()
    inside = far & (places > 0).all(1) & (places[:, 0] < 79) & (places[:, 1] < 59)
    assert np.abs(bent - curved)[inside].max() < 0.25 * np.abs(straight.ravel() - curved)[inside].max()


def test_normals_count():
    rng = np.random.default_rng(0)
    places, vectors = rng.uniform(0, 50, (100, 3)), rng.normal(size=(100, 3))
    normals = np.tile((0.0, 0.0, 2.0), (100, 1))
    assert not np.array_equal(noise_at(places, vectors, normals), noise_at(places, vectors))


@pytest.mark.parametrize("call, words", [
    (lambda: noise(np.zeros((4, 5, 3))), ("vectors", "(4, 5, 3)", "(ny, nx, 2)")),
    (lambda: noise(np.zeros((1, 5, 5, 3))), ("vectors", "(1, 5, 5, 3)", "2 or more")),
    (lambda: noise(np.zeros((4, 5, 2), complex)), ("vectors", "complex128", "real")),
    (lambda: noise(vortex(), spacing=(1, 2, 3)), ("spacing", "2, along x, y")),
    (lambda: noise(vortex(), spacing=(1, -2)), ("spacing", "above 0")),
    (lambda: noise(vortex(), feature_size=0), ("feature_size is 0", "positive")),
    (lambda: noise(vortex(), streak_length=np.nan), ("streak_length is nan", "from 1 to 20")),
    (lambda: noise(vortex(), seed=-1), ("seed is -1", "whole number")),
    (lambda: noise(vortex(), phase=np.inf), ("phase is inf", "finite")),
    (lambda: noise(vortex(), mask_threshold=-1), ("mask_threshold is -1", "0 or more")),
    (lambda: noise(vortex(), octaves=1.5), ("octaves is 1.5", "whole number")),
    (lambda: noise(vortex(), threads=0), ("threads is 0", "from 1")),
    (lambda: noise(vortex(), out=np.empty((60, 80))), ("out", "float64", "(60, 80)")),
    (lambda: noise_at(np.zeros((5, 4)), np.zeros((5, 4))), ("points", "(5, 4)", "(n, 3)")),
    (lambda: noise_at(np.full((5, 3), np.nan), np.zeros((5, 3))), ("points", "(5, 3)", "leave those rows out")),
    (lambda: noise_at(np.zeros((5, 3)), np.zeros((4, 3))), ("vectors", "(4, 3)", "(5, 3)")),
    (lambda: noise_at(np.zeros((5, 2)), np.zeros((5, 2)), np.zeros((5, 2))), ("normals", "(5, 2)", "3D")),
])
def test_errors_name_the_argument_and_a_remedy(call, words):
    with pytest.raises(ValueError) as error:
        call()
    for word in words:
        assert word in str(error.value)


def test_nothing_is_no_noise():
    assert noise(np.zeros((0, 5, 2))).shape == (0, 5)
    assert noise_at(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)
