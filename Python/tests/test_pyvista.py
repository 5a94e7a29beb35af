# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""mesh.steerable of PyVista."""
import subprocess
import sys

import numpy as np
import pytest

pyvista = pytest.importorskip("pyvista", minversion="0.48")

from steerablenoise import noise, noise_at  # noqa: E402


def around(points, axis=2):
    """A vortex around an axis of the world."""
    a, b = [(1, 2), (2, 0), (0, 1)][axis]
    vectors = np.zeros((len(points), 3))
    vectors[:, a], vectors[:, b] = -points[:, b], points[:, a]
    return vectors


def image(dimensions, **where):
    mesh = pyvista.ImageData(dimensions=dimensions, **where)
    mesh["U"] = around(mesh.points - np.asarray(mesh.center), 2) + (0.3, 0.1, 0.2)
    return mesh


def alike(a, b):
    return np.corrcoef(np.ravel(a), np.ravel(b))[0, 1]


def test_it_is_found_by_its_entry_point():
    program = "import pyvista; print(type(pyvista.Sphere().steerable).__module__, pyvista.MultiBlock().steerable is not None)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["steerablenoise._accessor", "True"]


def test_volumes_have_the_noise_of_the_grid():
    mesh = image((12, 14, 16), spacing=(0.9, 1.1, 1.3), origin=(3.0, -4.0, 5.0))
    done = mesh.steerable.noise("U", feature_size=5.4, seed=3)
    vectors = mesh["U"].reshape(16, 14, 12, 3)
    wanted = noise(vectors, spacing=(0.9, 1.1, 1.3), origin=(3.0, -4.0, 5.0), feature_size=5.4, seed=3)
    assert np.array_equal(done["SteerableNoise"], wanted.ravel())
    assert isinstance(done, pyvista.ImageData) and done.active_scalars_name == "SteerableNoise"
    assert mesh.array_names == ["U"]


@pytest.mark.parametrize("plane", [(0, 1), (1, 2), (0, 2)])
def test_flat_images_lie_in_any_plane(plane):
    a, b = plane
    dimensions = np.ones(3, int)
    dimensions[[a, b]] = 40, 30
    mesh = pyvista.ImageData(dimensions=dimensions, spacing=(0.5, 0.5, 0.5), origin=(1.0, 2.0, 3.0))
    mesh["U"] = around(mesh.points - mesh.center, 3 - a - b) + 0.1
    flat = mesh["U"].reshape(30, 40, 3)[..., [a, b]]
    origin = np.asarray(mesh.origin)[[a, b]]
    wanted = noise(flat, spacing=0.5, origin=origin, feature_size=4.0)
    assert np.array_equal(mesh.steerable.noise("U", feature_size=4.0)["SteerableNoise"], wanted.ravel())
    mesh["U"] = flat.reshape(-1, 2)  # along the image's own axes
    assert np.array_equal(mesh.steerable.noise("U", feature_size=4.0)["SteerableNoise"], wanted.ravel())


def test_turned_images_have_the_noise_of_their_own_axes():
    mesh = image((30, 40, 1))
    wanted = mesh.steerable.noise("U", feature_size=6.0)["SteerableNoise"]
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    turned = pyvista.ImageData(dimensions=(30, 40, 1))
    turned.direction_matrix = turn
    turned["U"] = mesh["U"] @ turn.T
    assert np.array_equal(turned.steerable.noise("U", feature_size=6.0)["SteerableNoise"], wanted)


def test_vectors_on_cells_give_noise_on_cells():
    mesh = pyvista.ImageData(dimensions=(31, 41, 1), origin=(1.0, 2.0, 0.0))
    mesh.cell_data["U"] = around(mesh.cell_centers().points - mesh.center)
    done = mesh.steerable.noise("U", feature_size=6.0, name="N")
    wanted = noise(mesh.cell_data["U"].reshape(40, 30, 3)[..., :2], origin=(1.5, 2.5), feature_size=6.0)
    assert np.array_equal(done.cell_data["N"], wanted.ravel()) and "N" not in done.point_data


@pytest.mark.parametrize("kind", ["cast_to_unstructured_grid", "cast_to_structured_grid", "cast_to_rectilinear_grid"])
@pytest.mark.parametrize("cells", [False, True])
def test_other_grids_have_nearly_the_noise_of_images(kind, cells):
    mesh = image((20, 22, 24))
    if cells:
        mesh = mesh.point_data_to_cell_data()
    wanted = mesh.steerable.noise("U", feature_size=7.0)["SteerableNoise"]
    got = getattr(mesh, kind)().steerable.noise("U", feature_size=7.0)["SteerableNoise"]
    straight = mesh.steerable.noise("U", feature_size=7.0, follow_curvature=False)["SteerableNoise"]
    assert alike(got, wanted) > max(0.99, alike(straight, wanted))


@pytest.mark.parametrize("cast", [False, True])
def test_surfaces_have_normals_and_bends(cast):
    mesh = pyvista.Plane(i_size=80, j_size=60, i_resolution=160, j_resolution=120)
    mesh.clear_data()
    mesh["U"] = around(mesh.points)
    r = mesh.points.astype(float)
    bends = -r / np.maximum((r**2).sum(1, keepdims=True), 1e-9)
    wanted = noise_at(mesh.points, mesh["U"], np.tile((0.0, 0.0, 1.0), (mesh.n_points, 1)), bends, feature_size=4.0)
    straight = noise_at(mesh.points, mesh["U"], np.tile((0.0, 0.0, 1.0), (mesh.n_points, 1)), feature_size=4.0)
    if cast:
        mesh = mesh.cast_to_unstructured_grid()
    got = mesh.steerable.noise("U", feature_size=4.0)["SteerableNoise"]
    assert alike(got, wanted) > 0.995 > alike(straight, wanted)


@pytest.mark.parametrize("cells", [False, True])
def test_normals_are_those_of_the_surface(cells):
    mesh = pyvista.Sphere(radius=10.0, theta_resolution=90, phi_resolution=90)
    mesh.clear_data()
    places = mesh.cell_centers().points if cells else mesh.points
    (mesh.cell_data if cells else mesh.point_data)["U"] = np.tile((0.0, 0.5, 1.0), (len(places), 1))
    vectors = np.tile((0.0, 0.5, 1.0), (len(places), 1))
    wanted = noise_at(places, vectors, places, feature_size=1.5)
    got = mesh.steerable.noise("U", feature_size=1.5, follow_curvature=False)["SteerableNoise"]
    assert alike(got, wanted) > 0.98 > alike(noise_at(places, vectors, feature_size=1.5), wanted)


def test_the_size_is_a_share_of_the_bounds_that_samples_carry():
    mesh = image((401, 301, 1), spacing=(0.1, 0.1, 0.1))
    # 1/100 of the diagonal of 50 is 0.5 (on the ladder), 4 distances are 0.4.
    assert np.array_equal(mesh.steerable.noise("U")["SteerableNoise"],
                          mesh.steerable.noise("U", feature_size=0.5)["SteerableNoise"])
    coarse = image((41, 31, 1))
    assert np.array_equal(coarse.steerable.noise("U")["SteerableNoise"],
                          coarse.steerable.noise("U", feature_size=4.0)["SteerableNoise"])


def test_composites_share_a_size_and_pass_on_what_has_no_vectors():
    left, right = image((30, 20, 1)), image((30, 20, 1), origin=(29.0, 0.0, 0.0))
    bare = pyvista.Sphere()
    mesh = pyvista.MultiBlock({"left": left, "rest": pyvista.MultiBlock({"right": right, "bare": bare})})
    mesh.append(None)
    done = mesh.steerable.noise("U", seed=1)
    assert isinstance(done, pyvista.MultiBlock) and done.keys()[:2] == ["left", "rest"] and done[2] is None
    size = 4.0  # distances of 1
    for block, here in ((left, done["left"]), (right, done["rest"]["right"])):
        assert np.array_equal(here["SteerableNoise"], block.steerable.noise("U", feature_size=size, seed=1)["SteerableNoise"])
    assert "SteerableNoise" not in done["rest"]["bare"].array_names
    assert left.array_names == ["U"] and right.array_names == ["U"]


def test_fill_values_are_found_over_all_blocks():
    left, right = image((30, 20, 1)), image((30, 20, 1), origin=(29.0, 0.0, 0.0))
    right["U"][:] = 1e20
    left["U"][40] = 1e20
    with pytest.warns(UserWarning, match="601 samples hold 1e.20"):
        done = pyvista.MultiBlock([left, right]).steerable.noise("U")
    assert not done[1]["SteerableNoise"].any() and done[0]["SteerableNoise"][40] == 0.0
    surface = left.extract_surface(algorithm=None)
    with pytest.warns(UserWarning, match="1 samples hold"):
        assert surface.steerable.noise("U")["SteerableNoise"][40] == 0.0


def test_active_vectors_need_no_name():
    mesh = image((30, 20, 1))
    mesh.set_active_vectors("U")
    assert np.array_equal(mesh.steerable.noise()["SteerableNoise"], mesh.steerable.noise("U")["SteerableNoise"])


def pixels(texture):
    """In 0 to 1, the first row at the bottom."""
    return np.asarray(texture.to_array())[::-1] / 255.0


def test_textures_lie_as_the_mesh_does():
    mesh = image((41, 21, 1))
    mesh["x"], mesh["y"] = mesh.points[:, 0].copy(), mesh.points[:, 1].copy()
    before = mesh.copy()
    for axis, name in enumerate("xy"):
        surface, texture = mesh.steerable.texture("U", size=200, scalars=name, cmap="gray", intensity=0.0)
        picture = pixels(texture)
        assert picture.shape == (100, 200, 3)
        ramp = np.mgrid[:100, :200][1 - axis] / (199, 99)[axis]
        np.testing.assert_allclose(picture[..., 0], ramp, atol=0.02)
        corner = surface.active_texture_coordinates[np.argmin(surface.points @ (1, 1, 0))]
        assert tuple(corner) == (0.0, 0.0)
    assert mesh == before


def test_textures_are_finer_than_the_mesh():
    mesh = pyvista.Plane(i_size=40, j_size=20, i_resolution=80, j_resolution=40)
    mesh.clear_data()
    mesh["U"] = around(mesh.points)
    _, texture = mesh.steerable.texture("U", size=400, feature_size=0.6)
    y, x = (np.mgrid[:200, :400] + 0.5) / 10.0
    points = np.stack((x.ravel() - 20.0, y.ravel() - 10.0, np.zeros(x.size)), axis=-1)
    bends = -points / (points**2).sum(1, keepdims=True)
    wanted = noise_at(points, around(points), np.tile((0.0, 0.0, 1.0), (len(points), 1)), bends, feature_size=0.6)
    far = np.hypot(*points[:, :2].T) > 3.0
    # White is not lightened.
    assert alike(pixels(texture)[..., 0].ravel()[far], np.minimum(wanted, 0.0)[far]) > 0.95


def test_textures_take_the_coordinates_of_the_mesh():
    mesh = pyvista.Plane(i_size=40, j_size=20, i_resolution=20, j_resolution=10)
    mesh["U"] = np.tile((1.0, 0.0, 0.0), (mesh.n_points, 1))
    places = mesh.active_texture_coordinates * 0.5 + 0.25  # a part of the texture
    mesh.active_texture_coordinates = places
    surface, texture = mesh.steerable.texture("U", size=128)
    picture = pixels(texture)
    assert np.array_equal(surface.active_texture_coordinates, places) and picture.shape == (128, 128, 3)
    assert picture[40:88, 40:88].std() > 0.05 and np.all(picture[:28] == 1.0)


@pytest.mark.parametrize("call, words", [
    (lambda: image((30, 20, 1)).steerable.noise("V"), ("'V'", "no such array", "'U': (600, 3)")),
    (lambda: pyvista.Sphere().steerable.noise(), ("no active vectors", "column_stack")),
    (lambda: pyvista.MultiBlock([pyvista.Sphere()]).steerable.noise("U"), ("'U'", "no such array")),
    (lambda: image((30, 20, 1)).elevation().steerable.noise("Elevation"), ("'Elevation'", "(600,)", "(n, 3)")),
    (lambda: image((30, 20, 1)).steerable.noise("U", streak_length=30), ("streak_length is 30", "from 1 to 20")),
    (lambda: image((30, 20, 1)).steerable.texture("V"), ("'V'", "no such array")),
    (lambda: image((30, 20, 1)).steerable.texture("U", size=1), ("size is 1", "from 2")),
    (lambda: image((30, 20, 1)).steerable.texture("U", scalars="U"), ("scalars is 'U'", "1 component")),
    (lambda: image((30, 20, 5)).steerable.texture("U"), ("not flat", "texture_map_to_plane")),
    (lambda: pyvista.MultiBlock([image((30, 20, 1))]).steerable.texture("U"), ("MultiBlock", "one by one")),
])
def test_errors(call, words):
    with pytest.raises(ValueError) as error:
        call()
    for word in words:
        assert word in str(error.value)
