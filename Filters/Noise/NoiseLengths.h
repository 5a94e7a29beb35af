// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How long the tuples of VTK's arrays are, over blocks and ranks. Shared with this project's
 * rendering module.
 */
#ifndef NoiseLengths_h
#define NoiseLengths_h

#include "SteerableNoiseFiltersModule.h" // For export macro

#include <limits>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkMultiProcessController;

namespace noise
{
/// An array with 2, 3, 4, 6 or 9 components, and where it belongs.
struct LengthSource
{
  vtkDataArray* Array = nullptr;
  /// Tuples of its hidden points or `Cells` do not count; null: all do.
  vtkDataSet* DataSet = nullptr;
  bool Cells = false;
};

/// Lengths of vectors, Frobenius norms of tensors.
struct LengthRange
{
  /// Of those that count; 0 where there is none.
  double Longest = 0.0;
  /// Longer tuples do not count; infinite: all do.
  double Limit = std::numeric_limits<double>::infinity();
  /// Tuples that were taken for fill values, by the rule of vtkSteerableNoiseFilter.
  double Fills = 0.0;

  /// Tuples far longer than all others, fill values or not: how many, the longest of them and of
  /// the rest.
  double FarCount = 0.0;
  double FarLongest = 0.0;
  double FarRest = 0.0;
  /// Their component of the largest amount.
  double FarValue = 0.0;
};

/**
 * Of these arrays, and of those of the other ranks of `controller`, which may be null.
 * `upperThreshold`: the limit; 0: fill values are found and left out. Longest is found where
 * `longest` asks for it, else maybe.
 */
STEERABLENOISEFILTERS_EXPORT LengthRange FindLengths(const std::vector<LengthSource>& arrays,
  double upperThreshold, vtkMultiProcessController* controller, bool longest = true);
} // namespace noise

#endif
