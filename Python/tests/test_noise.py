# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The installed wheel: python -m pytest Python/tests"""
import re
import subprocess
import sys
import threading

import numpy as np
import pytest

from steerablenoise import metric, noise, noise_at, subband_tiles


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
    {"follow_curvature": False}, {"phase": 0.25}, {"mask_threshold": 20.0}, {"octaves": 2}, {"basis": "value"},
    {"basis": "streaks"}, {"strength": 0.5}, {"reference_magnitude": 30.0}, {"eigenvalue_sum": 6.0},
    {"normalization": "none"}, {"normalization": "weight_sum"}, {"mask_upper_threshold": 20.0}, {"turbulence": True},
    {"period": 3}, {"period": (0, 2)}])
def test_every_option_counts(change):
    assert not np.array_equal(noise(vortex(), **change), noise(vortex()))


@pytest.mark.parametrize("base, change", [
    ({"phase": 0.25}, {"speed": 2.0}), ({"octaves": 2}, {"gain": 0.9}), ({"octaves": 2}, {"lacunarity": 1.5}),
    ({"basis": "streaks"}, {"density": 0.9})])
def test_options_of_options_count(base, change):
    assert not np.array_equal(noise(vortex(), **base, **change), noise(vortex(), **base))
    assert np.array_equal(noise(vortex(), **change), noise(vortex()))


@pytest.mark.parametrize("field", [vortex(), swirl()])
def test_components_are_vectors(field):
    plain = noise(field)
    parts = [np.ascontiguousarray(field[..., c]) for c in range(field.shape[-1])]
    assert np.array_equal(noise(tuple(parts)), plain)
    # Each with strides of its own, one of another type: 64 bits for all.
    parts[0] = np.asfortranarray(parts[0])
    parts[1] = parts[1].astype(np.float32) if np.array_equal(parts[1], parts[1].astype(np.float32)) else parts[1][::-1].copy()[::-1]
    assert np.array_equal(noise(tuple(parts)), plain)


def test_noise_repeats_after_a_period():
    field = np.broadcast_to(np.float32((1.0, 0.3)), (60, 80, 2))
    n = noise(field, feature_size=8, period=(5, 3))
    assert np.abs(n[:, :40] - n[:, 40:]).max() < 1e-5
    assert np.abs(n[:24] - n[24:48]).max() < 1e-5


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


def test_blank_is_what_is_asked_for():
    field = vortex()
    field[3, 4] = 0.0
    field[9, 11, 0] = np.nan
    n = noise(field, mask_threshold=2.0, mask_upper_threshold=50.0, blank=np.nan)
    length = np.hypot(*np.moveaxis(field, -1, 0))
    assert np.array_equal(np.isnan(n), ~((length > 2.0) & (length <= 50.0)))
    assert (noise(field, blank=-7.0) == -7.0).sum() == 2


@pytest.mark.parametrize("fill", [-30000.0, 1e20])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_fill_values_are_blank_and_named(fill, dtype):
    field = vortex().astype(dtype)
    field[20:30, 40:50] = fill
    field[40, 5, 0] = fill
    with pytest.warns(UserWarning, match=re.escape(f"101 samples hold {fill:g},")) as told:
        n = noise(field)
    assert told[0].filename == __file__
    assert not n[20:30, 40:50].any() and n[40, 5] == 0.0
    missing = field.copy()
    missing[np.abs(missing).max(-1) > 1000] = np.nan
    assert np.array_equal(n, noise(missing))
    # By hand, without a word.
    assert np.array_equal(n, noise(field, mask_upper_threshold=1000.0))


@pytest.mark.parametrize("field", [vortex(), swirl()])
def test_fill_values_are_found_wherever_components_lie(field):
    for component in range(field.shape[-1]):
        field[-1, ..., -1, component] = 1e20
        apart = tuple(field[..., c].copy() for c in range(field.shape[-1]))
        beside = np.full((*field.shape[:-1], 5), np.nan)  # what no array of ours may look at
        beside[..., :field.shape[-1]] = field
        for layout in (field, apart, beside[..., :field.shape[-1]], np.asfortranarray(field),
                       field.astype(np.float32)):
            with pytest.warns(UserWarning, match="hold 1e[+]20"):
                assert not noise(layout)[-1, ..., -1].any()
        field[-1, ..., -1, component] = 1.0


def test_some_vectors_too_short_to_square_keep_their_direction():
    field = vortex()
    short = field.copy()
    short[30:] *= 1e-30
    expected = noise(field, follow_curvature=False)
    np.testing.assert_allclose(noise(short, follow_curvature=False), expected, atol=1e-4)


def test_far_vectors_that_are_no_fill_values_stay():
    field = vortex()
    field[5, 5], field[6, 6] = (4000.0, 0.0), (0.0, 9000.0)
    with pytest.warns(UserWarning, match="2 vectors are far longer.*mask_upper_threshold"):
        assert noise(field)[5, 5] != 0.0


def test_fill_values_are_found_beside_negative_nan_and_tiny_vectors():
    field = vortex() * 1e-150
    field[0, 0] = -np.nan
    field[20:30, 40:50] = 1e20
    with pytest.warns(UserWarning, match="100 samples hold"):
        assert not noise(field)[20:30, 40:50].any()


def test_data_without_directions_and_coarse_data_are_told_of():
    with pytest.warns(UserWarning, match="4800 of 4800 samples have no direction"):
        noise(np.zeros((60, 80, 2)))
    with pytest.warns(UserWarning, match="1.5 apart.*feature_size to at least 6"):
        noise(vortex(), spacing=(1.0, 1.5), feature_size=5.0)


def test_metric_is_short_along_the_vector():
    angle = np.linspace(0.0, 3.0, 24).reshape(2, 3, 4)
    vectors = 5.0 * np.stack((np.cos(angle), np.sin(angle)), axis=-1)
    g = metric(vectors, streak_length=4.0, eigenvalue_sum=3.0)
    assert g.shape == (2, 3, 4, 2, 2) and g.dtype == np.float64
    values, axes = np.linalg.eigh(g)
    np.testing.assert_allclose(values[..., 0], 1.0 / 16.0, rtol=1e-5)
    np.testing.assert_allclose(values[..., 1], 3.0 - 1.0 / 16.0 - 1e-4, rtol=1e-5)
    np.testing.assert_allclose(np.abs((axes[..., 0] * vectors).sum(-1)), 5.0, rtol=1e-5)
    # On a surface the normal takes half a unit of the trace.
    on = metric((1.0, 0.0, 7.0), (0.0, 0.0, 2.0))
    np.testing.assert_allclose(on[2, 2], 0.5, rtol=1e-6)
    np.testing.assert_allclose(on[0, 0], 1.0 / 36.0, rtol=1e-5)
    np.testing.assert_allclose(metric((0.0, np.nan)), np.eye(2))


@pytest.mark.parametrize("orientations", [3, 4, 6, 8])
def test_subband_tiles_add_up_to_noise_without_a_direction(orientations):
    tiles = subband_tiles(tile_size=64, orientations=orientations, scales=2)
    assert tiles.shape == (64, 64, 2, orientations) and tiles.dtype == np.float32
    # The angular filters of an octave sum to one, so that its spectrum is that of a ring.
    power = np.abs(np.fft.fft2(tiles[:, :, 0].sum(-1))) ** 2
    k = np.hypot(*np.meshgrid(*[np.fft.fftfreq(64, 1 / 64)] * 2))
    inside = power[(k > 4.5) & (k < 15.5)]
    assert power[(k <= 4) | (k >= 16)].max() < 1e-6 * inside.max()
    assert not np.array_equal(tiles, subband_tiles(tile_size=64, orientations=orientations, scales=2, seed=1))


def test_other_threads_run_meanwhile():
    # The other one waits for the call to begin and then marks the end of what has yet to be written. Nobody takes the
    # GIL from a thread that has it, so without its release the mark would come after the call, and last. Vectors are not
    # looked through before, which releases it too.
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000.0)
    field = np.tile(vortex(), (8, 8, 1))
    out = np.empty(field.shape[:-1], np.float32)
    out[...] = np.nan
    go = threading.Event()

    def mark():
        go.wait()
        out[-1, -1] = 9.0

    other = threading.Thread(target=mark)
    other.start()
    try:
        go.set()
        noise(field, feature_size=32, octaves=4, threads=1, mask_upper_threshold=1e300, out=out)
    finally:
        sys.setswitchinterval(interval)
        other.join()
    assert out[-1, -1] != 9.0


@pytest.mark.skipif(sys.platform == "win32", reason="signals as POSIX has them")
def test_ctrl_c_ends_it():
    program = """
import os, signal, threading
import numpy as np
from steerablenoise import noise
signal.signal(signal.SIGINT, signal.default_int_handler) # shells let jobs in the background ignore it
out = np.full((4096, 4096), np.nan, np.float32)
field = np.random.default_rng(0).normal(size=(4096, 4096, 2)).astype(np.float32)
def interrupt():
    while np.isnan(out[:64]).all(): # until it has begun
        pass
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt, daemon=True).start()
try:
    noise(field, octaves=16, feature_size=1e6, threads=1, out=out)
except KeyboardInterrupt:
    print("interrupted", np.isnan(out[-1]).all())
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=300)
    assert done.stdout.split() == ["interrupted", "True"], done.stderr


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
    (lambda: noise((np.zeros((4, 5)), np.zeros((5, 4)))), ("vectors", "(4, 5), (5, 4)", "meshgrid")),
    (lambda: noise((np.zeros((4, 5)),) * 3), ("vectors", "(u, v, w) of shape (nz, ny, nx)")),
    (lambda: noise(vortex(), basis="worley"), ("basis is 'worley'", "'gradient', 'value', 'streaks'")),
    (lambda: noise(vortex(), normalization="l2"), ("normalization is 'l2'", "'unit_variance'")),
    (lambda: noise(vortex(), normalization="weight_sum", eigenvalue_sum=5), ("eigenvalue_sum is 5", "4 or less")),
    (lambda: noise(vortex(), eigenvalue_sum=1), ("eigenvalue_sum is 1", "from 2 to 16")),
    (lambda: noise(vortex(), strength=2), ("strength is 2", "from 0 to 1")),
    (lambda: noise(vortex(), reference_magnitude=0), ("reference_magnitude is 0", "None or positive")),
    (lambda: noise(vortex(), mask_upper_threshold=-1), ("mask_upper_threshold is -1", "fill values")),
    (lambda: noise(vortex(), blank="none"), ("blank is 'none'", "finite or NaN")),
    (lambda: noise(vortex(), speed=5), ("speed is 5", "from -4 to 4")),
    (lambda: noise(vortex(), density=0), ("density is 0", "from 0.01 to 1")),
    (lambda: noise(vortex(), lacunarity=9), ("lacunarity is 9", "from 1 to 8")),
    (lambda: noise(vortex(), gain=-1), ("gain is -1", "from 0 to 1")),
    (lambda: noise(vortex(), period=(1, 2, 3)), ("period", "2, along x, y")),
    (lambda: noise(vortex(), period=2.5), ("period is 2.5", "whole")),
    (lambda: noise(vortex(), period=2, octaves=2, lacunarity=1.5), ("lacunarity is 1.5", "whole number")),
    (lambda: metric(np.zeros((5, 4))), ("vectors", "(5, 4)", "(..., 3)")),
    (lambda: metric(np.zeros((5, 3)), np.zeros((4, 3))), ("normals", "(4, 3)", "(5, 3)")),
    (lambda: metric(np.zeros((5, 2)), np.zeros((5, 2))), ("normals", "(5, 2)", "3D")),
    (lambda: subband_tiles(orientations=5), ("orientations is 5", "3, 4, 6 or 8")),
    (lambda: subband_tiles(tile_size=8), ("tile_size is 8", "from 16")),
    (lambda: subband_tiles(band_center=0.5), ("band_center is 0.5", "0.25")),
    (lambda: subband_tiles(tile_size=32, scales=6), ("scales is 6", "larger tile_size")),
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
    assert metric(np.zeros((0, 3))).shape == (0, 3, 3)
