// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceFields.h"

#include "CellSums.h"
#include "DatasetCells.h"
#include "NoiseArrays.h"
#include "NoiseGhosts.h"
#include "NoiseSamples.h"
#include "NoiseThreads.h"
#include "PointPlaces.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace noise
{
namespace
{
constexpr float NaN = std::numeric_limits<float>::quiet_NaN();

/// The array as floats of 3 or 6 components, divided by the longest; what is not finite or longer than `limit` becomes NaN.
void SetSteering(SurfaceFields& fields, vtkDataArray* array, double limit)
{
  const bool vectors = IsVector(array->GetNumberOfComponents());
  const int components = vectors ? 3 : 6;
  const auto reader = vectors ? MakeVectorReader(array, WorldAxes, false)
                              : MakeTensorReader(array, WorldAxes, false);
  const vtkIdType count = array->GetNumberOfTuples();
  fields.Steering = NewOutputArray("Steering", components, count);
  float* steering = fields.Steering->GetPointer(0);
  double longest = 0.0;
  constexpr vtkIdType chunk = 4096;
  std::vector<double> lengths(static_cast<std::size_t>(count));
  for (vtkIdType first = 0; first < count; first += chunk)
  {
    const auto begin = static_cast<std::size_t>(first);
    const auto size = static_cast<std::size_t>(std::min(chunk, count - first));
    float* out = steering + components * begin;
    const float* read = reader->Read(begin, size, out);
    if (read != out)
    {
      std::copy(read, read + components * size, out);
    }
    ReadLengths(fields.Steering, begin, size, lengths.data() + begin);
  }
  // Lengths of floats, of which the longest that counts may be a little longer than it was.
  const auto counts = [atMost = 1.000001 * limit](double length)
  { return std::isfinite(length) && length <= atMost; };
  for (const double length : lengths)
  {
    longest = counts(length) ? std::max(longest, length) : longest;
  }
  fields.Longest = longest > 0.0 ? longest : 1.0;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    float* tuple = steering + components * i;
    for (int c = 0; c < components; ++c)
    {
      tuple[c] =
        counts(lengths[i]) ? static_cast<float>(tuple[c] / fields.Longest) : NaN;
    }
  }
}

/// Means over the cells of each point, NaN where none of them is finite and seen.
vtkSmartPointer<vtkFloatArray> CellsToPoints(vtkPolyData* surface, vtkFloatArray* cells)
{
  const int components = cells->GetNumberOfComponents();
  const vtkIdType count = surface->GetNumberOfPoints();
  auto points = NewOutputArray("Steering", components, count);
  const HiddenSamples hidden(surface);
  const auto counts = [&](vtkIdType cell)
  { return !std::isnan(cells->GetValue(components * cell)) && !hidden.HasCell(cell); };
  const DatasetCells polygons(surface);
  for (int part = 0; part < components; part += 3)
  {
    auto means = NewOutputArray("Means", 3, count);
    PointSums sums(surface, means, DirectionSteps);
    sums.Sum(false,
      [&]
      {
        return [&, read = DatasetCells::Reader(polygons)](
                 vtkIdType begin, vtkIdType end, PointSums::Shares& shares) mutable
        {
          for (vtkIdType cell = begin; cell < end; ++cell)
          {
            if (counts(cell))
            {
              const float* tuple = cells->GetPointer(components * cell) + part;
              sums.Append(shares, read(cell), Eigen::Vector3d(tuple[0], tuple[1], tuple[2]));
            }
          }
        };
      });
    for (vtkIdType point = 0; point < count; ++point)
    {
      std::copy_n(means->GetPointer(3 * point), 3, points->GetPointer(components * point) + part);
    }
  }
  std::vector<bool> reached(static_cast<std::size_t>(count), false);
  DatasetCells::Reader read(polygons);
  for (vtkIdType cell = 0; cell < polygons.GetNumberOfCells(); ++cell)
  {
    if (counts(cell))
    {
      for (const vtkIdType point : read(cell))
      {
        reached[static_cast<std::size_t>(point)] = true;
      }
    }
  }
  for (vtkIdType point = 0; point < count; ++point)
  {
    if (!reached[static_cast<std::size_t>(point)])
    {
      std::fill_n(points->GetPointer(components * point), components, NaN);
    }
  }
  return points;
}

double GetLargestCell(vtkPolyData* surface)
{
  const PointPlaces places(surface);
  double largest = 0.0;
  for (vtkCellArray* cells : { surface->GetLines(), surface->GetPolys(), surface->GetStrips() })
  {
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      cells->GetCellAtId(cell, ids);
      Eigen::AlignedBox3d box;
      for (const vtkIdType id : *ids)
      {
        box.extend(places(id));
      }
      largest = std::max(largest, ids->GetNumberOfIds() > 0 ? box.diagonal().squaredNorm() : 0.0);
    }
  }
  return std::sqrt(largest);
}

/// NaN would not survive a shader.
void MarkNotFinite(vtkFloatArray* array)
{
  float* values = array->GetPointer(0);
  std::replace_if(
    values, values + array->GetNumberOfValues(), [](float value) { return std::isnan(value); },
    SurfaceFields::NotFinite);
}
} // namespace

SurfaceFields ComputeSurfaceFields(
  vtkPolyData* surface, vtkDataArray* array, bool cells, bool perCell, double limit)
{
  SurfaceFields fields;
  const int components = array->GetNumberOfComponents();
  if (!IsVector(components) && !IsTensor(components))
  {
    return fields;
  }
  SetSteering(fields, array, limit);
  if (cells && !perCell)
  {
    fields.Steering = CellsToPoints(surface, fields.Steering);
  }
  if (IsVector(components))
  {
    Samples samples(surface, fields.Steering, cells && perCell, Shape(), 1);
    // Curvatures are summed in steps of a millionth of this cell's: fine enough for streaks of any size.
    double bounds[6];
    surface->GetBounds(bounds);
    const double diagonal =
      std::hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]);
    if (std::isfinite(diagonal) && diagonal > 0.0)
    {
      WithThreads([&] { samples.ComputeCurvature(0.01 * diagonal); });
    }
    fields.Normals = samples.GetNormals();
    for (vtkIdType i = 0; fields.Normals && i < fields.Normals->GetNumberOfTuples(); ++i)
    {
      Eigen::Map<Eigen::Vector3f> normal(fields.Normals->GetPointer(3 * i));
      normal = normal.allFinite() ? normal.normalized().eval() : Eigen::Vector3f::Zero().eval();
    }
    fields.Curvature = samples.GetCurvature();
    fields.LargestCell = GetLargestCell(surface);
  }
  MarkNotFinite(fields.Steering);
  return fields;
}
} // namespace noise
