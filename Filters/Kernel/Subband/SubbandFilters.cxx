// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandFilters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace steerable
{
namespace
{

constexpr double Pi = 3.14159265358979323846;
constexpr double Ln2 = 0.693147180559945309417;
constexpr double Ln4 = 2.0 * Ln2;

// Integral of 4^y cos(omega y + phase) from a to b.
double IntegrateCosine(double omega, double phase, double a, double b)
{
  auto antiderivative = [&](double y)
  {
    const double angle = omega * y + phase;
    return std::exp(Ln4 * y) * (Ln4 * std::cos(angle) + omega * std::sin(angle)) /
      (Ln4 * Ln4 + omega * omega);
  };
  return antiderivative(b) - antiderivative(a);
}

// Integral of 4^y p(y) p(y + shift), where p(y) = sum_m c_m cos(m pi y) on |y| < 1, else zero. A
// product of two cosines is half a sum of two.
template <int Terms>
double Overlap(const double (&c)[Terms], double shift)
{
  const double a = std::max(-1.0, -1.0 - shift);
  const double b = std::min(1.0, 1.0 - shift);
  if (a >= b)
  {
    return 0.0;
  }
  double sum = 0.0;
  for (int m = 0; m < Terms; ++m)
  {
    for (int n = 0; n < Terms; ++n)
    {
      const double phase = n * Pi * shift;
      sum += 0.5 * c[m] * c[n] *
        (IntegrateCosine((m + n) * Pi, phase, a, b) + IntegrateCosine((m - n) * Pi, -phase, a, b));
    }
  }
  return sum;
}

// cos^2(x) and cos^4(x) as cosines of multiples of 2x.
constexpr double Profile[] = { 1.0 / 2, 1.0 / 2 };
constexpr double ProfileSquared[] = { 3.0 / 8, 1.0 / 2, 1.0 / 8 };

void Require(bool condition, const std::string& message)
{
  if (!condition)
  {
    throw std::invalid_argument(message);
  }
}

} // namespace

void SubbandParameters::Validate() const
{
  Require(this->Orientations == 3 || this->Orientations == 4 || this->Orientations == 6 ||
      this->Orientations == 8,
    "Subband noise: Orientations must be 3, 4, 6 or 8.");
  Require(this->Scales >= 1 && this->Scales <= 6, "Subband noise: Scales must be 1 to 6.");
  Require(this->TileSize >= 16 && this->TileSize <= 2048,
    "Subband noise: TileSize must be 16 to 2048 texels.");
  Require(this->BandCenter > 0.0 && this->BandCenter <= 0.25,
    "Subband noise: BandCenter must be above 0 and at most 0.25 cycles per texel.");
  Require(std::ldexp(this->CenterFrequency(), 1 - this->Scales) >= 2.0,
    "Subband noise: the coarsest scale has fewer than 2 cycles per repeat; use fewer Scales, a "
    "larger TileSize or a larger BandCenter.");
}

int SubbandParameters::MostScales() const
{
  const double octaves = std::log2(this->CenterFrequency() / 2.0);
  return std::clamp(static_cast<int>(std::floor(octaves + 1e-9)) + 1, 1, 6);
}

double AngularScale(int orientations)
{
  // The factorials cancel: alpha^2 = (1/K) 2/1 4/3 6/5 ... (2K-2)/(2K-3).
  double square = 1.0 / orientations;
  for (int m = 1; m < orientations; ++m)
  {
    square *= 2.0 * m / (2.0 * m - 1.0);
  }
  return std::sqrt(square);
}

double AngularFilter(int orientation, int orientations, double theta)
{
  const double amplitude = AngularScale(orientations) *
    std::pow(std::cos(theta - Pi * orientation / orientations), orientations - 1);
  return amplitude * amplitude;
}

double RadialFilter(double octaves)
{
  if (std::abs(octaves) >= 1.0)
  {
    return 0.0;
  }
  const double c = std::cos(0.5 * Pi * octaves);
  return c * c;
}

double HighResidual(double octaves)
{
  return octaves > 0.0 ? 1.0 - RadialFilter(octaves) : 0.0;
}

double LowResidual(double octaves, int scales)
{
  const double y = octaves + scales - 1;
  return y < 0.0 ? 1.0 - RadialFilter(y) : 0.0;
}

double SubbandFilter(
  const SubbandParameters& parameters, int orientation, int scale, double kx, double ky)
{
  const double k = std::hypot(kx, ky);
  if (k == 0.0)
  {
    return 0.0;
  }
  const double radial = RadialFilter(std::log2(k / parameters.CenterFrequency()) + scale);
  return radial == 0.0
    ? 0.0
    : radial * AngularFilter(orientation, parameters.Orientations, std::atan2(ky, kx));
}

double ResidualFilter(const SubbandParameters& parameters, bool low, double kx, double ky)
{
  const double k = std::hypot(kx, ky);
  if (k == 0.0)
  {
    return low ? 1.0 : 0.0;
  }
  const double octaves = std::log2(k / parameters.CenterFrequency());
  return low ? LowResidual(octaves, parameters.Scales) : HighResidual(octaves);
}

double RadialOverlap(double octaves)
{
  return Overlap(Profile, octaves);
}

double PowerOverlap(double octaves)
{
  // Rounding can leave a value a little below zero at the ends of the support.
  return std::max(0.0, Overlap(ProfileSquared, octaves)) / Overlap(Profile, 0.0);
}

Eigen::MatrixXd AngularGram(int orientations)
{
  // The trapezoidal rule is exact here: G_i G_i' has no harmonic above 4(K-1) <= 28.
  constexpr int samples = 64;
  Eigen::MatrixXd filters(orientations, samples);
  for (int n = 0; n < samples; ++n)
  {
    for (int i = 0; i < orientations; ++i)
    {
      filters(i, n) = AngularFilter(i, orientations, 2.0 * Pi * n / samples);
    }
  }
  return filters * filters.transpose() * (2.0 * Pi / samples);
}

Eigen::MatrixXd RadialGram(int scales)
{
  Eigen::MatrixXd gram(scales, scales);
  for (int j = 0; j < scales; ++j)
  {
    for (int k = 0; k < scales; ++k)
    {
      gram(j, k) = Ln2 * std::pow(4.0, -j) * RadialOverlap(k - j);
    }
  }
  return gram;
}

Eigen::MatrixXd RadialSlopeGram(int scales)
{
  constexpr int perOctave = 64;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(scales, scales);
  for (int step = 0; step < (scales + 1) * perOctave; ++step)
  {
    const double y = 1.0 - (step + 0.5) / perOctave;
    const double area = Ln2 * std::pow(16.0, y) / perOctave;
    for (int j = 0; j < scales; ++j)
    {
      for (int k = 0; k < scales; ++k)
      {
        gram(j, k) += area * RadialFilter(y + j) * RadialFilter(y + k);
      }
    }
  }
  return gram;
}

double SubbandVariance(const SubbandParameters& parameters, const Eigen::MatrixXd& weights)
{
  const Eigen::MatrixXd angular = AngularGram(parameters.Orientations) * weights;
  const Eigen::MatrixXd radial = weights * RadialGram(parameters.Scales);
  return parameters.BandCenter * parameters.BandCenter * angular.cwiseProduct(radial).sum();
}

} // namespace steerable
