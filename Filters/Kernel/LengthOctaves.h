// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How long vectors are: the longest, and whether some of them are numbers that stand for missing
 * values.
 */
#ifndef LengthOctaves_h
#define LengthOctaves_h

#include <array>

namespace steerable
{
/// Fill values start here and stand out: flow is continuous, and so are its lengths.
constexpr double LeastFillLength = 99.0;

/// Vectors that are far longer than all others.
struct FarAbove
{
  /// How many; 0: there are none.
  double Count = 0.0;
  /// Length of the longest of them, and of the longest of the others.
  double Longest = 0.0;
  double Rest = 0.0;
  /// They are as alike as one number in one, two or three components: fill values.
  bool Fill = false;
};

/// Counts and ranges of lengths in octaves (factors of 2); they combine by sum, minimum and maximum.
class LengthOctaves
{
public:
  /// Lengths of 0, and those that are not finite, do not count.
  void Add(double length);
  LengthOctaves& operator+=(const LengthOctaves& more);

  /// The longest that are no longer than `limit`: infinite, or the Rest of FindFarAbove.
  double GetLongest(double limit) const;

  /**
   * Vectors of at least LeastFillLength that are 16 times as long as any other one. Where these are
   * fill values, and others stand out from what is left, all of them together.
   */
  FarAbove FindFarAbove() const;

  struct Octave
  {
    double Count = 0.0;
    double Least = 0.0;
    double Longest = 0.0;
  };
  /// One for each exponent of a double, for hosts that combine them themselves.
  std::array<Octave, 2047> Octaves;
};
} // namespace steerable

#endif
