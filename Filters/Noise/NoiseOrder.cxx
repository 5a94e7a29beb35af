// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseOrder.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace noise
{
namespace
{
// Fewer are in the nearest caches anyway.
constexpr std::size_t FewestPoints = 4096;
// Successive points that are looked at.
constexpr std::size_t MostSteps = 16384;
// Distances of neighbours that badly ordered points are apart, at least: rows of a grid, layers of tetrahedra and
// blocks of a partition are not.
constexpr double LongStep = 8.0;
// Of each axis: 63 bits for three.
constexpr int CurveBits = 21;

/// The mean distance of successive places, of an even choice of them.
double GetMeanStep(const steerable::TupleReader<double>& places, std::size_t count)
{
  const std::size_t stride = count / MostSteps + 1;
  double sum = 0.0;
  double steps = 0.0;
  for (std::size_t i = 0; i + 1 < count; i += stride)
  {
    double scratch[6];
    const double* pair = places.Read(i, 2, scratch);
    double squared = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      squared += (pair[3 + axis] - pair[axis]) * (pair[3 + axis] - pair[axis]);
    }
    const double step = std::sqrt(squared); // a tenth of the time of std::hypot
    if (std::isfinite(step))
    {
      sum += step;
      steps += 1.0;
    }
  }
  return steps > 0.0 ? sum / steps : 0.0;
}

/// The lowest bits of a number with two zeros after each.
std::uint64_t Spread(std::uint64_t bits)
{
  bits &= 0x1fffff;
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}
} // namespace

//------------------------------------------------------------------------------
std::vector<std::uint32_t> FindOrder(const steerable::TupleReader<double>& places, std::size_t count,
  const double (&bounds)[6], int dimension)
{
  if (count < FewestPoints || count > std::numeric_limits<std::uint32_t>::max())
  {
    return {};
  }
  const double sides[3] = { bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] };
  const double spacing =
    std::hypot(sides[0], sides[1], sides[2]) / std::pow(static_cast<double>(count), 1.0 / dimension);
  if (!(GetMeanStep(places, count) > LongStep * spacing))
  {
    return {};
  }
  const double longest = *std::max_element(sides, sides + 3);
  const double last = std::ldexp(1.0, CurveBits) - 1.0;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> curve(count);
  std::vector<std::uint32_t> order(count);
  const auto all = static_cast<vtkIdType>(count);
  vtkSMPTools::For(0, all, 4096,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        double scratch[3];
        const double* place = places.Read(static_cast<std::size_t>(i), 1, scratch);
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double step = (place[axis] - bounds[2 * axis]) / longest * last;
          // NaN becomes 0.
          key |= Spread(static_cast<std::uint64_t>(step > 0.0 ? std::min(step, last) : 0.0)) << axis;
        }
        curve[i] = { key, static_cast<std::uint32_t>(i) };
      }
    });
  vtkSMPTools::Sort(curve.begin(), curve.end());
  std::transform(curve.begin(), curve.end(), order.begin(), [](const auto& entry) { return entry.second; });
  return order;
}

//------------------------------------------------------------------------------
steerable::EvaluationCounts EvaluateInOrder(const steerable::SteerableNoise& kernel,
  const steerable::TupleReader<double>& positions, const steerable::Field& field,
  const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, float* noise)
{
  const std::uint32_t* part = order.data() + begin;
  const auto reorder = [part](const auto*& reader, int components, auto& reordered)
  {
    if (reader)
    {
      reader = &reordered.emplace(*reader, components, part);
    }
  };
  steerable::Field inOrder = field;
  std::optional<ReorderedReader<float>> vectors, tensors, shapes, normals, curvature;
  std::optional<ReorderedReader<double>> metrics;
  reorder(inOrder.Vectors, 3, vectors);
  reorder(inOrder.Tensors, 6, tensors);
  reorder(inOrder.Metrics, 6, metrics);
  reorder(inOrder.Shapes, 3, shapes);
  reorder(inOrder.Normals, 3, normals);
  reorder(inOrder.Curvature, 3, curvature);
  std::vector<float> values(end - begin);
  const steerable::EvaluationCounts counts = kernel.EvaluatePoints(
    ReorderedReader<double>(positions, 3, part), inOrder, 0, end - begin, values.data());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    noise[part[i]] = values[i];
  }
  return counts;
}
} // namespace noise
