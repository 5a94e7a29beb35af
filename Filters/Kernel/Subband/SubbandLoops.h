// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops in which subband noise spends its time, compiled for every SIMD level (private to this
 * folder): fits of bands to a metric, their power, and sums of tiles.
 */
#ifndef SubbandLoops_h
#define SubbandLoops_h

#include "Subband/SubbandTiles.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace steerable
{
constexpr int MaximumScales = 6;

/// Numbers for registers, which read them fastest where they begin at a multiple of their size.
struct alignas(64) AlignedNumbers
{
  std::array<double, 8> Values = {};
};

/// A function of q = 4^c with a value for each of J scales, kept piecewise linear. Entries are
/// found through the leading bits of q, which grow with it, linearly between powers of two.
struct RadialTable
{
  /// Tabulate for c in [first, last], with 2^bits entries for each doubling of q.
  void Fill(
    int first, int last, int bits, const std::function<Eigen::VectorXd(double c)>& function);
  /// Write the J values at q.
  void Interpolate(double q, double* values) const;

  double Smallest = 0.0, Largest = 0.0; ///< q is clamped to these.
  int Bits = 0;
  std::uint64_t First = 0; ///< The leading bits of Smallest.
  int Width = 0;           ///< J
  int Stride = 0;          ///< J, rounded up to 2, 4 or 8, with zeros behind.
  std::vector<AlignedNumbers> Rows;
};

/**
 * The sum over directions theta of factors A_i(theta) R(q(theta)) for K orientations i.
 *
 * q = mean + radius cos 2(theta - phi), with phi the axis of the metric, is even in psi = theta -
 * phi. A_i is the same function for all i, turned by pi i / K, with K harmonics: A_i(theta) = sum_m
 * a_m cos 2m(theta - pi i / K). So the sum is
 *
 *     sum_m cos 2m(pi i / K - phi) a_m sum_psi cos(2m psi) R(q(psi)),
 *
 * and directions may be counted from phi: the four at +-psi and pi/2 +- psi take two values of R.
 */
struct DirectionFit
{
  /// `factor`(theta) is A_0 of N directions in half a circle, times N / (2 pi).
  void Prepare(int orientations, const std::function<double(double theta)>& factor);

  /// Directions between 0 and pi/4.
  struct Octant
  {
    int Count = 0;
    /// The largest ratio of eigenvalues that they are enough for.
    double MostRatio = 0.0;
    /// Of 2 psi, and of pi - 2 psi, by fours: a multiple of four directions.
    std::vector<double> Cosines;
    /// Of each direction K factors.
    std::vector<double> Harmonics;
  };
  std::array<Octant, 3> Octants;
  int Orientations = 0;
  /// K x K: cosines and sines of the harmonics that K orientations tell apart, at each of them.
  std::vector<double> Waves;
};

/// Write the K*J weights for a metric (XX, XY, YY) whose values along directions are q.
void FitBands(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights);

/// The quadratic form tr(gamma^T Q_ang gamma Q_rad).
struct PowerForm
{
  void Prepare(const Eigen::MatrixXd& angular, const Eigen::MatrixXd& radial);

  int Orientations = 0;
  int Scales = 0;
  std::vector<double> Angular;
  /// Of Q_rad, which is tridiagonal; twice what is beside the diagonal.
  std::array<double, MaximumScales> Diagonal = {};
  std::array<double, MaximumScales> Beside = {};
};

double PowerOf(const PowerForm& form, const double* gamma);

/// What SampleSubbands and SumSubbands do.
void SampleTiles(
  const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands);
void SumTiles(const SubbandTiles& tiles, TileLookup lookup, std::size_t count, const double* uv,
  const float* weights, float* noise);
} // namespace steerable

#endif
