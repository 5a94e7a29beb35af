// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The specification: steerable noise at one point, in double precision, as slowly and plainly as
 * Documentation/noise-model.md writes it. SteerableNoise.h is tested against it.
 */
#ifndef SteerableNoiseReference_h
#define SteerableNoiseReference_h

#include "MetricTensor.h"

namespace steerable
{
/**
 * Noise at a point. `position` is in world units, `metric` comes from MetricTensor.h, `curvature` is
 * the streamline's curvature vector (u . grad) u in 1 / world units. Throws std::invalid_argument for
 * parameters out of range.
 */
template <int N>
double SteerableNoiseReference(const NoiseParameters& parameters, const Vector<N>& position,
  const AxialMetric<N>& metric, const Vector<N>& curvature = Vector<N>::Zero());
} // namespace steerable

#endif
