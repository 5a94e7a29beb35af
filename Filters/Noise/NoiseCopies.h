// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Points at the same place (private): files that store points once for each cell, and seams of closed
 * surfaces, have several for one node, which should get the same noise.
 */
#ifndef NoiseCopies_h
#define NoiseCopies_h

#include "NoiseGhosts.h"

#include "vtkType.h"

#include <cstddef>
#include <vector>

class vtkDataSet;
class vtkFloatArray;

namespace noise
{
/// 40 degrees: facets of a round surface meet below, edges of a body above.
constexpr double CreaseCosine = 0.766;

class CoincidentPoints
{
public:
  /// Places are the same if they agree to a 2^-22nd of the largest coordinate; hidden points have none.
  CoincidentPoints(vtkDataSet* dataset, const HiddenSamples& hidden);

  /**
   * Gives the copies of a point the mean of their values, 3 components, which is summed in whole steps so
   * that its order does not show. `lines`: v and -v are the same, and only copies count as one point that
   * are joined by steps of less than the angle with this cosine; a crease keeps its two normals.
   */
  void Share(vtkFloatArray* values, double stepsPerUnit, bool lines, double leastCosine) const;

  /// All points that have copies.
  const std::vector<vtkIdType>& GetPoints() const { return this->Points; }

private:
  std::vector<vtkIdType> Points;     // group g: Points[Starts[g]..Starts[g + 1]]
  std::vector<std::size_t> Starts;
};
} // namespace noise

#endif
