// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How long vectors are, over blocks and ranks (private): the longest, and whether some of them are numbers that
 * stand for missing values.
 */
#ifndef NoiseLengths_h
#define NoiseLengths_h

#include <array>
#include <cstddef>
#include <vector>

class vtkDataArray;
class vtkMultiProcessController;

namespace noise
{
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

/// Whether an array has a number so large that FindFarAbove can find a vector in it; quick.
bool MayHoldFarAbove(vtkDataArray* array);

/**
 * Counts and ranges of lengths in octaves (factors of 2), which combine by sum, minimum and maximum. Lengths of
 * 0, and those that are not finite, do not count.
 */
class LengthOctaves
{
public:
  /// Adds the tuples that are at most `limit` long and not hidden (one value for each, or empty).
  void Add(vtkDataArray* array, const std::vector<unsigned char>& hidden, double limit);

  /// All ranks take part.
  void Reduce(vtkMultiProcessController* controller);

  /// The longest that are no longer than `limit`: one of those in Add, or the Rest of FindFarAbove.
  double GetLongest(double limit) const;

  /**
   * Vectors of at least 99 that are 16 times as long as any other one. Where these are fill values, and others
   * stand out from what is left, all of them together.
   */
  FarAbove FindFarAbove() const;

private:
  struct Octave
  {
    double Count = 0.0;
    double Least = 0.0;
    double Longest = 0.0;
  };
  static constexpr int Lowest = -1074; // of the smallest number
  using Octaves = std::array<Octave, 2099>;

  static void Add(Octaves& octaves, double length);
  static void Add(Octaves& octaves, const Octaves& more);

  Octaves All;
};
} // namespace noise

#endif
