// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Vectors and tensors of a host as the floats that the kernel takes, the same from every host.
 */
#ifndef TupleFloats_h
#define TupleFloats_h

#include <algorithm>
#include <cmath>
#include <limits>

namespace steerable
{
/// Floats square to at most 1e38: what is longer or shorter keeps its direction.
constexpr double LongestTuple = 1e18;

/// Writes `count` components as floats; those that are not finite become NaN.
inline void ToFloats(const double* values, int count, float* out)
{
  double largest = 0.0;
  for (int c = 0; c < count; ++c)
  {
    largest = std::max(largest, std::abs(values[c]));
  }
  double scale = 1.0;
  if (std::isfinite(largest) && largest > LongestTuple)
  {
    scale = LongestTuple / largest;
  }
  else if (largest > 0.0 && largest < 1.0 / LongestTuple)
  {
    scale = 1.0 / (LongestTuple * largest);
  }
  for (int c = 0; c < count; ++c)
  {
    // Beyond the range of a float only what is not finite is left.
    const double value = values[c] * scale;
    out[c] =
      std::isfinite(value) ? static_cast<float>(value) : std::numeric_limits<float>::quiet_NaN();
  }
}

/// √sum, `sum` being made of the squares of these values: finite, if they are too large to be squared.
inline double LengthFromSquares(double sum, const double* values, int count)
{
  const bool tooLarge = std::isinf(sum) &&
    std::none_of(values, values + count, [](double value) { return std::isinf(value); });
  return tooLarge ? std::numeric_limits<double>::max() : std::sqrt(sum);
}
} // namespace steerable

#endif
