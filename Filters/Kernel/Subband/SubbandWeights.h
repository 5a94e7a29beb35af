// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From a metric to the weights of subbands: noise that follows the metric, whatever the texture
 * coordinates.
 *
 * Source: Goldberg, Zwicker, Durand, "Anisotropic Noise" (SIGGRAPH 2008), sections 3.1 and 4.2.
 *
 * The metric M of a point (SurfaceMetric.h) is a symmetric positive definite 2x2 matrix in repeats
 * squared: M = lambda^2 T T^T, where T maps the surface to texture coordinates and lambda is the
 * wavelength. The wanted spectrum has its centre where k^T M k = 1, so in the direction
 * e = (cos theta, sin theta) at the scale
 *
 *     c(theta) = log2(e^T M e) / 2 + log2(k0).
 *
 * A target that is separable along each direction projects on the separable bands as
 *
 *     gamma_ij = sum_n A_i(theta_n) R_j(c(theta_n)),    A = (2 pi / N) Q_ang^-1 G,
 *
 * with a radial factor R_j that only depends on the method. The heuristic takes R at the axes of the
 * bands instead of the sum. R is tabulated once.
 */
#ifndef SubbandWeights_h
#define SubbandWeights_h

#include "Subband/SubbandFilters.h"
#include "Subband/SubbandLoops.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace steerable
{
/// How weights are found from the metric.
enum class WeightMethod
{
  /// The closest spectrum to the wanted one (paper, equation 1), in each direction with its mean squared gradient: a fit
  /// between two scales is weaker than one at a scale, which would make noise uneven by up to 1.25 where directions
  /// have different scales.
  LeastSquares,
  PowerMatched, ///< The wanted power in every direction and scale: the best isotropy.
  Heuristic,    ///< The wanted spectrum at the centre of each band: the cheapest.
  None          ///< Ignores the metric: an isotropic ring in the texture, for comparison.
};

struct SubbandWeightParameters
{
  /// The pyramid of the tiles that the weights are for.
  SubbandParameters Pyramid;

  WeightMethod Method = WeightMethod::LeastSquares;

  /// Heuristic weights, and heuristic antialiasing, from three radii of a band instead of one: its
  /// centre and half an octave to both sides. Lowers aliasing where pixels see the surface at a
  /// grazing angle.
  bool RadialTriple = false;

  /// None only: the scale of the ring, [0, Scales - 1], not necessarily an integer.
  double FixedScale = 0.0;

  /// Throw std::invalid_argument if a member is out of its range.
  void Validate() const;
};

/**
 * Turns metrics into weights. Constant after construction: one object serves all threads.
 */
class SubbandWeights
{
public:
  /// Throws std::invalid_argument for parameters out of range. Takes milliseconds.
  explicit SubbandWeights(const SubbandWeightParameters& parameters);

  /**
   * Write the K*J weights gamma of a metric, orientation fastest, scaled so that the noise has
   * variance one on the surface. Eigenvalues outside the pyramid are clamped (ClampMetric). Weights
   * may be negative: clipping them would undo the fit. Returns false, with all weights zero, if the
   * metric is not finite.
   */
  bool Compute(const Eigen::Matrix2d& metric, double* gamma) const;

  /**
   * Write the K*J factors beta in about [0, 1] that filter each band for samples with this
   * footprint; they multiply gamma, and fade the noise where samples cannot carry it. The footprint
   * J J^T, in repeats squared, is that of the Jacobian J from samples (pixels, or the points of a
   * mesh) to texture coordinates; the filter is the Gaussian exp(-(2 pi)^2 k^T J J^T k / 2), with a
   * standard deviation of one sample (paper, equation 4). Least squares for LeastSquares and
   * PowerMatched weights, otherwise the filter at the centre of each band. Returns false, with all
   * factors zero, if the footprint is not finite.
   */
  bool Antialias(const Eigen::Matrix2d& footprint, double* beta) const;

  /// The K factors of the oriented high residual of an image (WriteImageSubbands), likewise.
  bool AntialiasHigh(const Eigen::Matrix2d& footprint, double* beta) const;

  /**
   * Scale weights down to a variance of `most` where theirs is above it. Weights that follow a stretch beyond what
   * K holds are large and nearly cancel: with factors of a filter on top they no longer do, and the filter, which
   * can only take away, would add.
   */
  void LimitVariance(double most, double* weights) const;

  /**
   * Clamp the eigenvalues of a finite metric to what the pyramid holds, [k0^-2, 4^(J-1) k0^-2].
   * Returns whether it changed.
   */
  bool ClampMetric(Eigen::Matrix2d& metric) const;

  const SubbandWeightParameters& GetParameters() const { return this->Parameters; }
  /// Eigenvalues of metrics that the pyramid holds, those of ClampMetric.
  double GetSmallestMetric() const { return this->SmallestMetric; }
  double GetLargestMetric() const { return this->LargestMetric; }

private:
  // gamma and beta alike: the values of a table along each direction, joined to weights of bands.
  void WeighBands(
    const RadialTable& table, const Eigen::Matrix2d& scaledMetric, double* weights) const;
  double GetVariance(const double* gamma) const;

  SubbandWeightParameters Parameters;
  double SmallestMetric = 0.0, LargestMetric = 0.0; // eigenvalues that the pyramid holds
  bool Fits = false;                                // or takes the values at the bands' axes
  DirectionFit Fit;
  std::vector<std::array<double, 3>> Squares; // cos^2, 2 cos sin and sin^2 of the bands' axes
  PowerForm Power;
  RadialTable Target;     // R of the method
  RadialTable Filter;     // R of the antialiasing filter
  RadialTable HighFilter; // the same of the high residual
};

/**
 * The ratio of the singular values of T, 1 or more: how much the texture is stretched. Beyond
 * FollowedStretch weights no longer give isotropic noise. Infinite for a singular metric.
 */
double DistortionRatio(const Eigen::Matrix2d& metric);

/// The stretch that the weights of K orientations follow: 1.5, 2, 3 and 4 for K = 3, 4, 6 and 8.
constexpr double FollowedStretch(int orientations)
{
  return 0.5 * orientations;
}

/**
 * Scales that noise with this metric needs: ceil(c_max) - floor(c_min) + 1, for bands centred at
 * k0 2^-j cycles per repeat. The metric must be positive definite.
 */
int RequiredScales(const Eigen::Matrix2d& metric, double centerFrequency);
} // namespace steerable

#endif
