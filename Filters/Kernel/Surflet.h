// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The exchangeable parts of a surflet in double precision, as functions of one number or one hash.
 */
#ifndef Surflet_h
#define Surflet_h

#include "LatticeHash.h"
#include "NoiseParameters.h"

#include <Eigen/Core>

#include <cmath>

namespace steerable
{
template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

constexpr double Pi = 3.14159265358979323846;

/**
 * Added to the variance that UnitVariance divides by, so that places which hardly a surflet reaches fade
 * to 0 instead of showing the edge of one at full contrast.
 */
constexpr float VarianceFloor = 1e-3f;

/// Largest |t| at which an interpolant is not 0: 2 for Kensler's wide one, else 1.
inline double FadeSupport(Fade fade)
{
  return fade == Fade::Wide ? 2.0 : 1.0;
}

/// 1 at 0, falling smoothly to 0 at FadeSupport and beyond (Kensler, "Modifications").
inline double FadeOf(Fade fade, double t)
{
  t = std::abs(t);
  if (!(t < FadeSupport(fade)))
  {
    return 0.0;
  }
  switch (fade)
  {
    case Fade::Cubic:
      return 1.0 - (3.0 - 2.0 * t) * t * t;
    case Fade::Wide:
    {
      const double s = 1.0 - 0.25 * t * t;
      return (4.0 * s - 3.0) * s * s * s * s;
    }
    case Fade::Quintic:
    default:
      return 1.0 - ((6.0 * t - 15.0) * t + 10.0) * t * t * t;
  }
}

/**
 * Unit gradient from 32 random bits, uniform on the circle or sphere. The top bit chooses between g
 * and -g, the rest a direction of the half circle; on the sphere the height is uniform, since zones
 * of equal height have equal area (Archimedes).
 */
template <int N>
Vector<N> UniformGradient(std::uint32_t hash);

template <>
inline Vector<2> UniformGradient<2>(std::uint32_t hash)
{
  const double sign = (hash >> 31) ? -1.0 : 1.0;
  const double angle = Pi * static_cast<std::int32_t>(hash << 1) * (1.0 / 4294967296.0);
  return sign * Vector<2>(std::cos(angle), std::sin(angle));
}

template <>
inline Vector<3> UniformGradient<3>(std::uint32_t hash)
{
  const double sign = (hash >> 31) ? -1.0 : 1.0;
  // 15 bits of height and 16 of angle, both taken at the middle of their step.
  const auto heightBits = static_cast<std::int32_t>((hash << 1) & 0xFFFE0000u);
  const double height = (heightBits + 65536.0) * (1.0 / 2147483648.0);
  const double angle =
    Pi * (static_cast<std::int32_t>(hash << 16) + 32768.0) * (1.0 / 4294967296.0);
  const double radius = std::sqrt(1.0 - height * height);
  return sign * Vector<3>(radius * std::cos(angle), radius * std::sin(angle), height);
}

/// One of the twelve directions to the edges of a cube (Perlin 2002), not normalised; 2D drops z.
template <int N>
Vector<N> PerlinGradient(std::uint32_t hash)
{
  const int edge = static_cast<int>(((hash >> 16) * 12u) >> 16);
  const double first = (edge & 1) ? -1.0 : 1.0;
  const double second = (edge & 2) ? -1.0 : 1.0;
  const Vector<3> direction = edge < 4 ? Vector<3>(first, second, 0.0)
    : edge < 8                         ? Vector<3>(first, 0.0, second)
                                       : Vector<3>(0.0, first, second);
  return direction.head<N>();
}

template <int N>
Vector<N> GradientOf(GradientSet set, std::uint32_t hash)
{
  return set == GradientSet::Perlin ? PerlinGradient<N>(hash) : UniformGradient<N>(hash);
}

/// Variance of one component of a gradient: what the noise's variance is a multiple of.
inline double GradientVariance(GradientSet set, int dimension)
{
  return set == GradientSet::Perlin ? 2.0 / 3.0 : 1.0 / dimension;
}

/// Random value of a corner, uniform on [-1, 1), variance 1/3.
inline double ValueOf(std::uint32_t hash)
{
  return static_cast<std::int32_t>(hash) * (1.0 / 2147483648.0);
}

/// The part of a streak, at its downstream end, over which it falls to 0.
constexpr double StreakEnd = 0.15;

/// √(8/3): what surflets in motion, which come and go as sin²(πτ), are multiplied by to keep their variance.
constexpr double MotionAmplitude = 1.6329931618554521;

/// Profile of a streak along its length, sigma in (-1, 1): a ramp that ends sharply downstream.
inline double StreakProfile(double sigma)
{
  if (!(std::abs(sigma) < 1.0))
  {
    return 0.0;
  }
  return 0.5 * (1.0 + sigma) * std::min(1.0, (1.0 - sigma) / StreakEnd);
}

/**
 * The lattice as a matrix whose columns are its steps: the identity, or for Simplicial the
 * equilateral triangles of Kensler's article and in 3D the body-centred lattice of simplex noise,
 * both with sides of length 1.
 */
template <int N>
Eigen::Matrix<double, N, N> LatticeSteps(Lattice lattice)
{
  Eigen::Matrix<double, N, N> steps = Eigen::Matrix<double, N, N>::Identity();
  if (lattice == Lattice::Simplicial)
  {
    if constexpr (N == 2)
    {
      steps << std::sqrt(3.0) / 2.0, 0.0, -0.5, 1.0;
    }
    else
    {
      // Unskewed simplex lattice: i - (i + j + k) / 6, whose shortest steps have length sqrt(3)/2.
      steps =
        (2.0 / std::sqrt(3.0)) * (steps - Eigen::Matrix<double, N, N>::Constant(1.0 / 6.0)).eval();
    }
  }
  return steps;
}

/// Corner index wrapped to the period of its axis; 0: no period.
inline std::uint32_t WrapToPeriod(std::int64_t index, std::int64_t period)
{
  if (period > 0)
  {
    index %= period;
    index += index < 0 ? period : 0;
  }
  return static_cast<std::uint32_t>(index);
}
} // namespace steerable

#endif
