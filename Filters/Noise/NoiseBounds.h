// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the data are (private): bounds of all blocks and ranks, and what automatic values take from them.
 */
#ifndef NoiseBounds_h
#define NoiseBounds_h

#include "NoiseArrays.h"

class vtkDataSet;
class vtkMultiProcessController;

namespace noise
{
class HiddenSamples;

/**
 * The nearest power of the fourth root of 2; 0 stays. Sizes that differ a little, between the steps of a series or
 * the places of a slice, become the same, and noise stays where it is.
 */
double SnapSize(double size);

/// The smallest FeatureSize that samples carry which are so far apart.
inline double GetSmallestFeatureSize(double sampleSpacing)
{
  return SnapSize(4.0 * sampleSpacing);
}

class CommonBounds
{
public:
  CommonBounds();

  void Add(const double (&bounds)[6]);
  void Add(const CommonBounds& other);
  /// Bounds of the points that are not hidden.
  void Add(vtkDataSet* dataset, const HiddenSamples& hidden);

  /// All ranks of the controller take part.
  void Reduce(vtkMultiProcessController* controller);

  /// Side along an axis, 0 if there is none.
  double GetSide(int axis) const;
  double GetLongestSide() const;
  double GetDiagonal() const;

  /**
   * The largest size of features of which a picture of the whole shows enough: an eighth of the second longest side.
   * The longest may have another unit (metres of depth beside degrees), and one of less than a ten-thousandth of
   * it is not seen.
   */
  double GetLargestSize() const;

  /// A `share` of the diagonal, no more than GetLargestSize() times 100 `share`, snapped.
  double GetSizeInPicture(double share) const;

  /// Automatic FeatureSize for samples that are so far apart: 1/100 of the diagonal, and no finer than they carry.
  double GetFeatureSize(double sampleSpacing) const;

  /// The coordinate plane that all data lie in; x and y if there is none.
  Plane GetPlane() const;

private:
  double Values[6]; // lower corner, then the negated upper one: all combine by minimum
};
} // namespace noise

#endif
