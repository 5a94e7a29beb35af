// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a steerable noise is made of: plain numbers with their defaults.
 *
 * Sources named in this folder: Rice 2025, "Steerable Perlin Noise" and its supplementary;
 * Kensler 2015, "Building Up Perlin Noise". Documentation/noise-model.md states the whole model.
 */
#ifndef NoiseParameters_h
#define NoiseParameters_h

#include <algorithm>
#include <array>
#include <cstdint>

namespace steerable
{
/// What stands at a lattice corner: a gradient, a value, or a sparse bright streak with a head.
enum class Basis
{
  Gradient,
  Value,
  Streaks
};

/// What the sum of surflets is divided by (see NoiseParameters::Normalization).
enum class Normalization
{
  None,
  WeightSum,
  UnitVariance
};

/// Strength of the anisotropy: the same everywhere, or growing with the length of the vector.
enum class StrengthMode
{
  Constant,
  Magnitude
};

/// Kensler's interpolants.
enum class Fade
{
  Cubic,
  Quintic,
  Wide
};

/// The lattice window: a product over the axes, or a function of the distance (Kensler).
enum class Falloff
{
  Separable,
  Radial
};

/// Where the surflets stand (Kensler).
enum class Lattice
{
  Square,
  Jittered,
  Simplicial
};

/// Directions of the gradients: uniform on the circle or sphere, or Perlin's twelve.
enum class GradientSet
{
  Uniform,
  Perlin
};

struct NoiseParameters
{
  /// Side of a lattice cell in world units, > 0.
  double FeatureSize = 1.0;
  /// Half-length of a streak in cells, [1, 20]; without LatticeWindow.
  double StreakLength = 6.0;
  /**
   * Trace of the metric, [2, 16]. WeightSum needs 4 or less (supplementary, section 1.3). From about 4 on
   * a flow along an axis leaves gaps between the rows of the lattice.
   */
  double EigenvalueSum = 3.2;
  /**
   * Rice's own model: a window over the axes of the lattice, and streaks as long as Quality and
   * MinimumEigenvalue say. Without it only the metric bounds a surflet, alike in every direction.
   */
  bool LatticeWindow = false;
  /// With LatticeWindow, 0 to 8: surflets reach Quality + 1 cells (ibid., section 2).
  int Quality = 4;
  /// With LatticeWindow: eigenvalue along the flow at Quality 0, (0, 1]; divided by Quality + 1 (ibid.).
  double MinimumEigenvalue = 0.5;
  /// Off: no fade by the metric's distance. With Strength 0 that is Kensler's isotropic noise.
  bool AnisotropicWeight = true;
  /// Off: gradients are projected on the plain offset, without the metric (Rice, Fig. 2).
  bool MetricInProjection = true;

  /// 0: isotropic metric, 1: fully anisotropic.
  double Strength = 1.0;
  steerable::StrengthMode StrengthMode = steerable::StrengthMode::Constant;
  /// Length of a vector that reaches the full strength, > 0 with StrengthMode::Magnitude.
  double ReferenceMagnitude = 1.0;
  /// Vectors no longer than this are stagnant and give 0; 0 switches the mask off.
  double MaskThreshold = 0.0;

  /// Surflets bend with the streamlines; images work their curvature out from their neighbours.
  bool FollowCurvature = true;

  steerable::Normalization Normalization = steerable::Normalization::UnitVariance;
  steerable::Basis Basis = steerable::Basis::Gradient;
  /// How densely streaks lie, (0, 1]; see GetStreakProbability.
  double Density = 0.25;

  /// On: surflets travel along the flow, each on its own clock; off: still noise.
  bool Motion = false;
  /// Position in the loop of motion; only its fraction counts.
  double Phase = 0.0;
  /// How far a surflet travels, in units of its half-length, [-4, 4].
  double Speed = 1.0;

  /// Fractal sum: 1 to 16 terms, each Lacunarity times finer and Gain times weaker.
  int Octaves = 1;
  double Lacunarity = 2.0;
  double Gain = 0.5;
  /// Sum of absolute values instead.
  bool Turbulence = false;

  steerable::Fade Fade = steerable::Fade::Quintic;
  steerable::Falloff Falloff = steerable::Falloff::Separable;
  steerable::Lattice Lattice = steerable::Lattice::Square;
  steerable::GradientSet GradientSet = steerable::GradientSet::Uniform;
  /// Cells per axis after which the noise repeats; 0: never.
  std::array<int, 3> Period = { 0, 0, 0 };
  std::uint32_t Seed = 0;

  /// Throws std::invalid_argument with the name of the first parameter that is out of range.
  void Validate() const;

  /// k, the eigenvalue of the metric along the flow: a streak reaches 1/√k cells to either side.
  double GetAlongEigenvalue() const
  {
    return this->LatticeWindow ? this->MinimumEigenvalue / (this->Quality + 1)
                               : 1.0 / (this->StreakLength * this->StreakLength);
  }

  /**
   * Probability that a corner carries a streak: Density of those that are 3 cells long, and of longer ones
   * fewer, so that they cover the same area. With LatticeWindow Density itself.
   */
  double GetStreakProbability() const
  {
    return this->LatticeWindow ? this->Density
                               : std::min(1.0, 3.0 * this->Density / this->StreakLength);
  }
};
} // namespace steerable

#endif
