# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The same bits as the VTK classes, where their Python module is built.

STEERABLENOISE_VTK_PYTHON: an interpreter with VTK, STEERABLENOISE_VTK_MODULES: the folder of the built package.
"""
import json
import os
import subprocess

import numpy as np
import pytest

from steerablenoise import metric, noise, subband_tiles

# Under pvpython the name steerablenoise has the VTK classes.
SCRIPT = """
import json, sys
import numpy as np
sys.path.insert(0, sys.argv[2])
from steerablenoise import vtkImageSubbandNoiseSource, vtkSteerableNoiseFilter
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData

folder = sys.argv[1]
for name, case in json.load(open(folder + "/cases.json")).items():
    vectors = np.load(folder + "/" + case["field"] + ".npy")
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
    f.SetOutputMetric(True)
    for option, value in case["setters"].items():
        getattr(f, "Set" + option)(value)
    f.Update()
    data = f.GetOutput().GetPointData()
    np.savez(folder + "/" + name, noise=vtk_to_numpy(data.GetArray("SteerableNoise")).reshape(shape),
             metric=vtk_to_numpy(data.GetArray("Metric")).reshape(*shape, 6))
source = vtkImageSubbandNoiseSource()
source.SetTileSize(64)
source.SetOrientations(6)
source.SetScales(3)
source.SetSeed(5)
source.Update()
np.save(folder + "/tiles", vtk_to_numpy(source.GetOutput().GetPointData().GetScalars()).reshape(64, 64, 3, 6))
"""


def fields():
    rng = np.random.default_rng(1)
    y, x = np.mgrid[:61, :83]
    flat = np.stack((-(y - 20.3), x - 31.7), axis=-1) + rng.normal(size=(61, 83, 2))
    z, y, x = np.mgrid[:12, :14, :17]
    solid = np.stack((-(y - 6.2), x - 7.1, 0.3 * z + 1.0), axis=-1)
    holes = flat.copy()
    holes[5:9, 7:20] = 0.0
    holes[30, 40] = np.nan
    holes[31, 41] = np.inf, 1.0
    fills = solid.astype(np.float32)
    fills[3, 4:7] = -30000.0
    fills[5, 5, 5, 2] = -30000.0
    return {"flat": flat, "flat32": flat.astype(np.float32), "tiny": flat * 1e-200, "solid": solid,
            "solid32": solid.astype(np.float32), "holes": holes, "fills": fills}


# Keywords of noise beside the setters of the filter.
OPTIONS = {
    "plain": ({}, {}),
    "straight": ({"follow_curvature": False, "streak_length": 3.0}, {"FollowCurvature": False, "StreakLength": 3.0}),
    "moving": ({"phase": 0.375, "octaves": 2, "speed": -2.0}, {"Animate": True, "Phase": 0.375, "Octaves": 2, "Speed": -2.0}),
    "masked": ({"seed": 7, "mask_threshold": 9.0, "blank": np.nan}, {"Seed": 7, "MaskThreshold": 9.0, "BlankValue": 1}),
    "below": ({"mask_upper_threshold": 21.0}, {"MaskUpperThreshold": 21.0}),
    "streaks": ({"basis": "streaks", "density": 0.6}, {"Basis": 2, "Density": 0.6}),
    "value": ({"basis": "value", "normalization": "weight_sum"}, {"Basis": 1, "Normalization": 1}),
    "fractal": ({"normalization": "none", "octaves": 3, "lacunarity": 3.0, "gain": 0.7, "turbulence": True, "period": 4},
                {"Normalization": 0, "Octaves": 3, "Lacunarity": 3.0, "Gain": 0.7, "Turbulence": True, "Period": [4] * 3}),
    "weak": ({"strength": 0.6, "reference_magnitude": 12.0, "eigenvalue_sum": 5.0},
             {"Strength": 0.6, "StrengthMode": 1, "ReferenceMagnitude": 12.0, "EigenvalueSum": 5.0}),
}
PLACED = {"spacing": (0.9, 1.1, 1.3), "origin": (3.7, -40.2, 5.5), "feature_size": 5.0}


@pytest.fixture(scope="module")
def of_filter(tmp_path_factory):
    """Results of the VTK classes: one run of their interpreter for all cases."""
    interpreter = os.environ.get("STEERABLENOISE_VTK_PYTHON")
    modules = os.environ.get("STEERABLENOISE_VTK_MODULES")
    if not interpreter or not modules:
        pytest.skip("STEERABLENOISE_VTK_PYTHON and STEERABLENOISE_VTK_MODULES do not name a built VTK module")
    folder = tmp_path_factory.mktemp("filter")
    cases = {}
    for field, vectors in fields().items():
        np.save(folder / field, vectors)
        axes = vectors.shape[-1]
        for name, (_, setters) in OPTIONS.items():
            cases[f"{field}-{name}"] = {
                "field": field, "spacing": PLACED["spacing"][:axes], "origin": PLACED["origin"][:axes],
                "setters": {"FeatureSize": PLACED["feature_size"], **setters}}
    (folder / "cases.json").write_text(json.dumps(cases))
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    subprocess.run([interpreter, "-c", SCRIPT, str(folder), modules], check=True, env=environment)
    return folder


@pytest.mark.filterwarnings("ignore:The samples are", "ignore:.*fill|.*missing")
@pytest.mark.parametrize("field", fields())
@pytest.mark.parametrize("options", OPTIONS)
def test_same_bits(of_filter, field, options):
    vectors = fields()[field]
    axes = vectors.shape[-1]
    with np.load(of_filter / f"{field}-{options}.npz") as results:
        wanted = results["noise"]
    ours = noise(vectors, spacing=PLACED["spacing"][:axes], origin=PLACED["origin"][:axes],
                 feature_size=PLACED["feature_size"], **OPTIONS[options][0])
    assert np.array_equal(ours, wanted, equal_nan=True)


@pytest.mark.parametrize("field", [name for name in fields() if name != "fills"])  # which metric does not look for
@pytest.mark.parametrize("options", ["plain", "weak"])
def test_same_metric(of_filter, field, options):
    vectors = fields()[field]
    axes = vectors.shape[-1]
    with np.load(of_filter / f"{field}-{options}.npz") as results:
        wanted = results["metric"]
    ours = metric(vectors, **OPTIONS[options][0])
    # XX YY ZZ XY YZ XZ
    for component, (row, column) in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))):
        if column < axes:
            assert np.array_equal(ours[..., row, column], wanted[..., component])
            assert np.array_equal(ours[..., column, row], wanted[..., component])


def test_same_tiles(of_filter):
    ours = subband_tiles(tile_size=64, orientations=6, scales=3, seed=5)
    assert np.array_equal(ours, np.load(of_filter / "tiles.npy"))
