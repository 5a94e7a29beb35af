// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How large the data of all blocks and ranks are and how far apart their samples (private): what an
 * automatic FeatureSize, and the warning of samples too far apart, come from.
 */
#ifndef NoiseSizes_h
#define NoiseSizes_h

#include "NoiseBounds.h"
#include "NoiseSamples.h"

class vtkDataSet;
class vtkMultiProcessController;

namespace noise
{
/// All of it combines by minimum or sum.
struct CommonSizes
{
  CommonBounds Bounds;
  SampleSpacing Spacing;

  /**
   * Adds a dataset with samples at its points or `cells`; `slab`: Shape's. `exact`: the spacing
   * decides more than a warning.
   */
  void Add(vtkDataSet* dataset, bool cells, int slab, bool exact);
  void Add(const CommonSizes& other);

  /// All ranks of the controller take part.
  void Reduce(vtkMultiProcessController* controller);

  /**
   * The largest of the distances of neighbours along the axes, of those along which 4 fit into the
   * largest size or that are at most twice the smallest.
   */
  double GetSampleSpacing() const;

  /// The smallest FeatureSize that the samples carry; 0 if they are nowhere.
  double GetSmallestSize() const { return GetSmallestFeatureSize(this->GetSampleSpacing()); }

  /// The automatic one.
  double GetFeatureSize() const { return this->Bounds.GetFeatureSize(this->GetSampleSpacing()); }
};
} // namespace noise

#endif
