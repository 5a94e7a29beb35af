// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The filters of subband noise: how the frequency plane is cut into oriented bands.
 *
 * Source: Goldberg, Zwicker, Durand, "Anisotropic Noise" (SIGGRAPH 2008), section 2, after the
 * steerable pyramid of Portilla and Simoncelli, each filter squared.
 *
 * A band has an orientation i in [0, K) and a scale j in [0, J); larger j is coarser. Its filter is
 *
 *     D_ij(r, theta) = G_i(theta) h(log2(r / r0) + j),
 *
 * with r0 the centre of scale 0. Radii are counted in octaves: y = log2(r / r0) + j is zero at the
 * centre of scale j. The paper's H(2^j r) is the case r0 = pi/2 rad per texel.
 *
 * An area element of the plane is r dr dtheta = r0^2 4^-j ln2 4^y dy dtheta, which is where the
 * factor 4^y of the integrals below comes from.
 */
#ifndef SubbandFilters_h
#define SubbandFilters_h

#include <Eigen/Core>

#include <cstdint>

namespace steerable
{

/**
 * The pyramid of bands that tiles and weights share.
 *
 * Frequencies k are in cycles per repeat of the texture; scale j is centred at k0 2^-j with
 * k0 = TileSize * BandCenter.
 */
struct SubbandParameters
{
  /// Orientations K: 3, 4, 6 or 8. They follow a distortion of 1.5:1, 2:1, 3:1 and 4:1
  /// respectively.
  int Orientations = 8;

  /// Scales J, one octave apart: 1 to 6.
  int Scales = 4;

  /// Texels N along one repeat: 16 to 2048.
  int TileSize = 256;

  /// k0/N, cycles per texel at the centre of the finest scale: (0, 1/4]. 1/8 suits Catmull-Rom
  /// lookups (1.2 % error), 1/16 bilinear ones (1.9 %).
  double BandCenter = 0.125;

  /// Chooses the noise. The same seed gives the same tiles, to rounding, on every platform.
  std::uint32_t Seed = 0;

  /// Chooses one of several independent tiles of the same seed (animation, triplanar mapping).
  std::uint32_t Realization = 0;

  /// Bands of a texel, K J. Band (i, j) is component j K + i.
  int Components() const { return this->Orientations * this->Scales; }

  /// The most scales, up to 6, that leave the coarsest 2 cycles per repeat; 1 where there are none.
  int MostScales() const;

  /// k0, in cycles per repeat.
  double CenterFrequency() const { return this->TileSize * this->BandCenter; }

  /**
   * Throw std::invalid_argument if a member is out of its range or if the coarsest scale has fewer
   * than 2 cycles per repeat. From 8 cycles on the repetition is hard to see.
   */
  void Validate() const;
};

/// alpha_K = 2^(K-1) (K-1)! / sqrt(K [2(K-1)]!), which makes the K angular filters sum to one.
double AngularScale(int orientations);

/**
 * G_i(theta) = alpha_K^2 cos^(2(K-1))(theta - pi i/K), theta in radians. The even power makes it the
 * same at theta and theta + pi, so a filtered real texture is real.
 */
double AngularFilter(int orientation, int orientations, double theta);

/// h(y) = cos^2(pi y/2) for |y| < 1, else 0; y in octaves from the band's centre. h(y) + h(y-1) = 1.
double RadialFilter(double octaves);

/// What the finer side of the pyramid leaves: 1 - h(y) for y > 0, y in octaves from scale 0.
double HighResidual(double octaves);

/// What the coarser side leaves: 1 - h(y + J-1) below the coarsest scale, y as above.
double LowResidual(double octaves, int scales);

/// D_ij at the frequency (kx, ky), in cycles per repeat. Zero at zero frequency.
double SubbandFilter(
  const SubbandParameters& parameters, int orientation, int scale, double kx, double ky);

/**
 * What all bands leave at the frequency (kx, ky), in cycles per repeat, on the finer side of the
 * pyramid or (`low`) on the coarser one, to which zero frequency belongs.
 */
double ResidualFilter(const SubbandParameters& parameters, bool low, double kx, double ky);

/**
 * Phi(d) = integral of 4^y h(y) h(y + d) dy, in closed form: the overlap of two radial profiles
 * d octaves apart. Zero for |d| >= 2.
 */
double RadialOverlap(double octaves);

/**
 * Psi(d) = integral of 4^y h^2(y) h^2(y + d) dy / integral of 4^y h^2(y) dy: the mean power of a
 * shifted profile, seen through the power of a band.
 */
double PowerOverlap(double octaves);

/// Q_ang, K x K: integrals of G_i G_i' over the circle.
Eigen::MatrixXd AngularGram(int orientations);

/**
 * Q_rad, J x J, tridiagonal: integrals of h_j h_j' r dr, in units of r0^2. The Gram matrix of all
 * bands is the Kronecker product of the two.
 */
Eigen::MatrixXd RadialGram(int scales);

/**
 * J x J, tridiagonal: integrals of h_j h_j' r^3 dr, in units of r0^4. Where RadialGram weighs power, this weighs squared
 * gradients.
 */
Eigen::MatrixXd RadialSlopeGram(int scales);

/**
 * Variance of the noise with the K x J weights gamma: BandCenter^2 tr(gamma^T Q_ang gamma Q_rad).
 * One ring (all weights of scale j one, the others zero) has 3.52617 BandCenter^2 4^-j.
 */
double SubbandVariance(const SubbandParameters& parameters, const Eigen::MatrixXd& weights);

} // namespace steerable

#endif
