// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseBounds.h"

#include "NoiseBlocks.h"
#include "NoiseGhosts.h"
#include "SurfaceFields.h"

#include "vtkBoundingBox.h"
#include "vtkCommunicator.h"
#include "vtkDataSet.h"
#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace noise
{
double SnapSize(double size)
{
  return size > 0.0 ? std::exp2(std::round(4.0 * std::log2(size)) / 4.0) : 0.0;
}

CommonBounds::CommonBounds()
{
  std::fill_n(this->Values, 6, std::numeric_limits<double>::infinity());
}

void CommonBounds::Add(const double (&bounds)[6])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (bounds[2 * axis] <= bounds[2 * axis + 1] && std::isfinite(bounds[2 * axis]) &&
      std::isfinite(bounds[2 * axis + 1]))
    {
      this->Values[axis] = std::min(this->Values[axis], bounds[2 * axis]);
      this->Values[3 + axis] = std::min(this->Values[3 + axis], -bounds[2 * axis + 1]);
    }
  }
}

void CommonBounds::Add(const CommonBounds& other)
{
  std::transform(this->Values, this->Values + 6, other.Values, this->Values,
    [](double a, double b) { return std::min(a, b); });
}

void CommonBounds::Add(vtkDataSet* dataset, const HiddenSamples& hidden)
{
  if (dataset->GetNumberOfPoints() == 0)
  {
    return;
  }
  double bounds[6];
  dataset->GetBounds(bounds);
  const std::vector<unsigned char>& hiddenPoints = hidden.Get(false);
  if (!hiddenPoints.empty())
  {
    vtkBoundingBox visible;
    for (vtkIdType point = 0; point < dataset->GetNumberOfPoints(); ++point)
    {
      if (!hiddenPoints[point])
      {
        visible.AddPoint(dataset->GetPoint(point));
      }
    }
    visible.IsValid() ? visible.GetBounds(bounds) : vtkMath::UninitializeBounds(bounds);
  }
  this->Add(bounds);
}

void CommonBounds::Reduce(vtkMultiProcessController* controller)
{
  noise::Reduce(controller, this->Values, 6, vtkCommunicator::MIN_OP);
}

double CommonBounds::GetSide(int axis) const
{
  const double side = -this->Values[3 + axis] - this->Values[axis];
  return std::isfinite(side) ? side : 0.0;
}

double CommonBounds::GetLongestSide() const
{
  return std::max({ this->GetSide(0), this->GetSide(1), this->GetSide(2) });
}

double CommonBounds::GetDiagonal() const
{
  const double diagonal = std::hypot(this->GetSide(0), this->GetSide(1), this->GetSide(2));
  return std::isfinite(diagonal) ? diagonal : 0.0;
}

double CommonBounds::GetLargestSize() const
{
  double sides[3] = { this->GetSide(0), this->GetSide(1), this->GetSide(2) };
  std::sort(sides, sides + 3, std::greater<>());
  return 0.125 * (sides[1] > 1e-4 * sides[0] ? sides[1] : sides[0]);
}

double CommonBounds::GetSizeInPicture(double share) const
{
  return SnapSize(std::min(share * this->GetDiagonal(), 100.0 * share * this->GetLargestSize()));
}

double CommonBounds::GetFeatureSize(double sampleSpacing) const
{
  const double size =
    std::max(this->GetSizeInPicture(0.01), GetSmallestFeatureSize(sampleSpacing));
  return size > 0.0 ? size : 1.0;
}

double GetAutomaticFeatureSize(const double (&bounds)[6], double sampleSpacing)
{
  CommonBounds common;
  common.Add(bounds);
  return common.GetFeatureSize(sampleSpacing);
}

Plane CommonBounds::GetPlane() const
{
  const double longest = this->GetLongestSide();
  const auto flat = [&](int axis) { return this->GetSide(axis) <= 1e-6 * longest; };
  if (flat(2) || flat(0) == flat(1))
  {
    return WorldPlane;
  }
  return { flat(0) ? 1 : 0, 2 };
}
} // namespace noise
