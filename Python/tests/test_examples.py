# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Every example runs and writes a picture."""
import importlib.util
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = sorted(pathlib.Path(__file__).parents[1].glob("examples/*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_writes_a_picture(example, tmp_path):
    for package in ("matplotlib", "pyvista"):
        if f"import {package}" in example.read_text(encoding="utf-8") and not importlib.util.find_spec(package):
            pytest.skip(f"{package} is not installed")
    subprocess.run([sys.executable, str(example)], cwd=tmp_path, check=True)
    (picture,) = tmp_path.iterdir()
    assert picture.stem == example.stem and picture.stat().st_size > 10000
