# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What is in the wheel that STEERABLENOISE_WHEEL names, and what its import brings."""
import os
import re
import shutil
import subprocess
import sys
import zipfile

import pytest


@pytest.fixture
def wheel():
    path = os.environ.get("STEERABLENOISE_WHEEL")
    if not path:
        pytest.skip("STEERABLENOISE_WHEEL does not name a wheel")
    with zipfile.ZipFile(path) as archive:
        yield archive


def test_one_wheel_for_python_3_12_and_newer(wheel):
    tags = re.search(r"Tag: (\S+)", wheel.read(next(n for n in wheel.namelist() if n.endswith("/WHEEL"))).decode())[1]
    if sys.version_info >= (3, 12):
        assert tags.startswith("cp312-abi3-")
        assert "steerablenoise/_kernel.abi3.so" in wheel.namelist() or sys.platform != "linux"
    else:
        own = f"cp3{sys.version_info[1]}"
        assert tags.startswith(f"{own}-{own}-")


def test_the_version_is_that_of_the_project(wheel):
    import steerablenoise

    assert f"steerablenoise-{steerablenoise.__version__}-" in os.path.basename(wheel.filename)


def test_types_and_licences_are_in_it_and_it_is_small(wheel):
    names = wheel.namelist()
    assert {"steerablenoise/py.typed", "steerablenoise/_kernel.pyi"} <= set(names)
    licences = {name.rpartition("/")[2] for name in names if "/licenses/" in name}
    assert {"LICENSE", "Apache-2.0.txt", "MPL-2.0.txt", "nanobind.txt", "robin-map.txt"} <= licences
    assert os.path.getsize(wheel.filename) <= 5e6


@pytest.mark.skipif(not shutil.which("readelf"), reason="needs readelf")
def test_nothing_but_the_system_is_needed(wheel, tmp_path):
    wheel.extractall(tmp_path)
    for library in tmp_path.glob("steerablenoise/*.so*"):
        text = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=True).stdout
        for needed in re.findall(r"NEEDED.*\[(.*)\]", text):
            assert (tmp_path / "steerablenoise" / needed).exists() or re.match(
                r"(libc|libm|libgcc_s|libstdc\+\+|libpthread|ld-linux.*)\.so", needed), needed
        for path in re.findall(r"RU?N?PATH.*\[(.*)\]", text):
            assert path == "$ORIGIN"


def test_import_brings_numpy_and_no_more():
    program = "import sys, numpy; before = set(sys.modules); import steerablenoise; print(*set(sys.modules) - before)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    brought = {name.partition(".")[0] for name in done.stdout.split()}
    assert not brought & {"vtk", "vtkmodules", "pyvista", "matplotlib", "typing_extensions"}


def test_vtk_classes_are_said_to_be_elsewhere():
    with pytest.raises(ImportError, match="vtkSteerableNoiseFilter is not in the wheel.*pvpython"):
        from steerablenoise import vtkSteerableNoiseFilter  # noqa: F401
    with pytest.raises(ImportError, match="noises"):
        from steerablenoise import noises  # noqa: F401


def test_the_package_tells_its_types():
    mypy = pytest.importorskip("mypy.api")
    program = """
import numpy as np
from steerablenoise import metric, noise, noise_at, subband_tiles
a: "np.ndarray[tuple[int, ...], np.dtype[np.float32]]" = noise((np.zeros((4, 5)), np.zeros((4, 5))), basis="value")
b = noise_at(np.zeros((4, 2)), np.zeros((4, 2)), seed=1, feature_size=2.0).sum()
c = metric((1.0, 0.0)), subband_tiles(orientations=4)
noise(a, bases=1)
noise_at(a, a, basis="worley")
"""
    output, errors, _ = mypy.run(["--no-incremental", "--cache-dir", os.devnull, "-c", program])
    complaints = re.findall(r"<string>:(\d+): error", output)
    assert complaints == ["7", "8"], output + errors
