# SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Noise over colour."""
from __future__ import annotations

from typing import Any

import numpy as np


def shade(rgb: np.ndarray[Any, Any], noise: np.ndarray[Any, Any], intensity: float) -> np.ndarray[Any, Any]:
    """Colours (..., 3) in 0 to 1, darker where the noise is below 0 and lighter where it is above.

    Colours of middle lightness stay what they are in the mean. intensity: 0 (no noise) to 1 (up to black and white).
    """
    share = np.clip(intensity / 2.0 * noise, -intensity, intensity)[..., np.newaxis]
    return np.asarray(rgb + np.where(share < 0.0, rgb, 1.0 - rgb) * share)
