# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The same bits as vtkSteerableNoiseFilter, where its Python module is built.

STEERABLENOISE_VTK_PYTHON: an interpreter with VTK, STEERABLENOISE_VTK_MODULES: the folder of the built package.
"""
import os
import subprocess
import sys

import numpy as np
import pytest

SCRIPT = """
import sys
import numpy as np
sys.path.insert(0, sys.argv[2])
from steerablenoise import vtkSteerableNoiseFilter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

case = np.load(sys.argv[1])
vectors = case["vectors"]
shape = vectors.shape[:-1]
image = vtkImageData()
image.SetDimensions(*shape[::-1], *[1] * (3 - len(shape)))
image.SetSpacing(*case["spacing"], *[1.0] * (3 - len(shape)))
image.SetOrigin(*case["origin"], *[0.0] * (3 - len(shape)))
tuples = np.zeros((vectors[..., 0].size, 3), vectors.dtype)
tuples[:, :len(shape)] = vectors.reshape(-1, len(shape))
array = numpy_to_vtk(tuples)
array.SetName("U")
image.GetPointData().SetVectors(array)
f = vtkSteerableNoiseFilter()
f.SetInputData(image)
f.SetFeatureSize(float(case["feature_size"]))
f.SetStreakLength(float(case["streak_length"]))
f.SetSeed(int(case["seed"]))
f.SetFollowCurvature(bool(case["follow_curvature"]))
f.SetMaskThreshold(float(case["mask_threshold"]))
f.SetOctaves(int(case["octaves"]))
if "phase" in case:
    f.SetAnimate(True)
    f.SetPhase(float(case["phase"]))
f.Update()
np.save(sys.argv[1] + ".npy", vtk_to_numpy(f.GetOutput().GetPointData().GetArray("SteerableNoise")).reshape(shape))
"""


def fields():
    rng = np.random.default_rng(1)
    y, x = np.mgrid[:61, :83]
    flat = np.stack((-(y - 20.3), x - 31.7), axis=-1) + rng.normal(size=(61, 83, 2))
    z, y, x = np.mgrid[:12, :14, :17]
    solid = np.stack((-(y - 6.2), x - 7.1, 0.3 * z + 1.0), axis=-1)
    return {"flat": flat, "flat32": flat.astype(np.float32), "tiny": flat * 1e-200, "solid": solid}


@pytest.mark.parametrize("name", fields())
@pytest.mark.parametrize("options", [
    {}, {"follow_curvature": False, "streak_length": 3.0}, {"phase": 0.375, "octaves": 2},
    {"seed": 7, "mask_threshold": 9.0}])
def test_same_bits(tmp_path, name, options):
    interpreter = os.environ.get("STEERABLENOISE_VTK_PYTHON")
    modules = os.environ.get("STEERABLENOISE_VTK_MODULES")
    if not interpreter or not modules:
        pytest.skip("STEERABLENOISE_VTK_PYTHON and STEERABLENOISE_VTK_MODULES do not name a built VTK module")
    from steerablenoise import noise
    vectors = fields()[name]
    axes = vectors.shape[-1]
    case = {"spacing": (0.9, 1.1, 1.3)[:axes], "origin": (3.7, -40.2, 5.5)[:axes], "feature_size": 5.0,
            "streak_length": 6.0, "seed": 0, "follow_curvature": True, "mask_threshold": 0.0, "octaves": 1, **options}
    file = str(tmp_path / "case.npz")
    np.savez(file, vectors=vectors, **case)
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    subprocess.run([interpreter, "-c", SCRIPT, file, modules], check=True, env=environment)
    assert np.array_equal(noise(vectors, **case), np.load(file + ".npy"))
