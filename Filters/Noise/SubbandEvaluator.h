// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Subband noise at the points of a surface (private to this module): tiles, looked up and weighted
 * as SubbandPoints says, summed over bands, planes and octaves.
 */
#ifndef SubbandEvaluator_h
#define SubbandEvaluator_h

#include "SubbandPoints.h"

#include <cstdint>
#include <vector>

namespace noise
{
/// A surface that is evaluated, and what is known of its points from before.
struct SubbandEvaluation
{
  vtkIdType Points = 0;
  /// Null where all points are known.
  const SubbandSurface* Surface = nullptr;
  SteeringVectors Vectors;
  vtkUnsignedCharArray* Ghosts = nullptr;
  bool ArePointsKnown = false;
  /// All chunks, where points are kept; null: they are not.
  std::vector<SubbandChunk>* Kept = nullptr;
};

struct SubbandEvaluator
{
  SubbandPointWeights Weights;
  double Persistence = 0.7;
  bool Turbulence = false;
  std::uint32_t Seed = 0;

  /// Output arrays with a value or tuple for each point; they may be null.
  float* Noise = nullptr;
  float* WeightArray = nullptr; ///< Of the first octave, where there are points: else as it was.
  float* Distortion = nullptr;

  static std::size_t CountChunks(vtkIdType points)
  {
    return static_cast<std::size_t>((points + SubbandChunkSize - 1) / SubbandChunkSize);
  }

  /// Noise of the chunks [begin, end). Tells what happened at points that were not known.
  SubbandPointCounts Evaluate(
    const SubbandEvaluation& surface, std::size_t begin, std::size_t end) const;

private:
  void CopyWeights(const std::vector<SubbandPlanePoints>& planes, vtkIdType first) const;
  void SumOctaves(
    const std::vector<SubbandPlanePoints>& planes, vtkIdType first, vtkIdType count) const;
};
} // namespace noise

#endif
