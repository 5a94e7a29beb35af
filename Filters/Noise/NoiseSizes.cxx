// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseSizes.h"

#include "NoiseBlocks.h"
#include "NoiseGhosts.h"

#include "vtkCommunicator.h"

#include <algorithm>
#include <limits>

namespace noise
{
void CommonSizes::Add(vtkDataSet* dataset, bool cells, int slab, bool exact)
{
  const HiddenSamples hidden(dataset);
  this->Bounds.Add(dataset, hidden);
  this->Spacing.Add(dataset, cells, slab, hidden, exact ? 1000000 : 10000);
}

//------------------------------------------------------------------------------
void CommonSizes::Add(const CommonSizes& other)
{
  this->Bounds.Add(other.Bounds);
  this->Spacing.Add(other.Spacing);
}

//------------------------------------------------------------------------------
void CommonSizes::Reduce(vtkMultiProcessController* controller)
{
  this->Bounds.Reduce(controller);
  noise::Reduce(controller, this->Spacing.Largest, 3, vtkCommunicator::MAX_OP);
  double sums[4] = { this->Spacing.Sum[0], this->Spacing.Sum[1], this->Spacing.Sum[2],
    this->Spacing.Count };
  noise::Reduce(controller, sums, 4, vtkCommunicator::SUM_OP);
  std::copy_n(sums, 3, this->Spacing.Sum);
  this->Spacing.Count = sums[3];
}

//------------------------------------------------------------------------------
double CommonSizes::GetSampleSpacing() const
{
  double spacing[3];
  double smallest = std::numeric_limits<double>::infinity();
  const double longest = this->Bounds.GetLongestSide();
  for (int axis = 0; axis < 3; ++axis)
  {
    const double mean = RoundToThreeDigits(
      this->Spacing.Count > 0.0 ? this->Spacing.Sum[axis] / this->Spacing.Count : 0.0);
    spacing[axis] = std::max(mean, this->Spacing.Largest[axis]);
    if (spacing[axis] > 0.0 && this->Bounds.GetSide(axis) > 1e-4 * longest)
    {
      smallest = std::min(smallest, spacing[axis]);
    }
  }
  const double most = std::max(0.25 * this->Bounds.GetLargestSize(), 2.0 * smallest);
  double largest = 0.0;
  for (const double here : spacing)
  {
    largest = here <= most ? std::max(largest, here) : largest;
  }
  return largest;
}
} // namespace noise
