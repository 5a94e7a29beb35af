// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How long features are that a feature metric steers, and the metric for those of a wanted length.
 *
 * K directions cannot follow every metric: features are rounder than it asks for (K = 8: 3.5 for
 * 4). Length over width is the root of the ratio of the structure tensor's eigenvalues; it is found
 * from the spectrum by quadrature and its inverse is tabulated.
 */
#ifndef SubbandAnisotropy_h
#define SubbandAnisotropy_h

#include "Subband/SubbandWeights.h"

#include <vector>

namespace steerable
{
class SubbandAnisotropy
{
public:
  /// Largest anisotropy of a feature metric: beyond it features hardly become longer.
  static constexpr double MostSteering = 8.0;

  /// For tiles of K orientations. Takes milliseconds. Throws std::invalid_argument for other K than
  /// 3, 4, 6 and 8.
  SubbandAnisotropy(int orientations, WeightMethod method);

  /**
   * Length over width of features steered with SteeredFeature's `anisotropy` on a texture that is
   * not stretched: the geometric mean over directions of the field and wavelengths between two
   * scales.
   */
  double Measure(double anisotropy) const;

  /// The most that Measure gives.
  double GetMost() const { return this->Measured.back(); }

  /**
   * SteeredFeature's anisotropy for features that are `wanted` times longer than wide, 1 or more;
   * that of the most where it is less. Method None, which no metric moves, takes what is wanted.
   */
  double GetSteering(double wanted) const;

private:
  WeightMethod Method;
  SubbandWeights Weights;
  // Of all pairs of orientations the integrals of G G' (e e^T), XX YY XY, and of scales those of
  // h h' r^3 dr.
  Eigen::MatrixXd Angular[3];
  Eigen::MatrixXd Radial;
  std::vector<double> Measured; // at steps of the logarithm up to MostSteering
};
} // namespace steerable

#endif
