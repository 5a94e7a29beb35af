// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseCells.h"

#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkSMPThreadLocalObject.h"
#include "vtkSMPTools.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace noise
{
namespace
{
/// VTK's cells square and cube coordinates; past this they overflow.
constexpr double LargestCoordinate = 1e50;

bool IsUsable(vtkDataSet* dataset, vtkIdType point)
{
  double x[3];
  dataset->GetPoint(point, x);
  return std::all_of(x, x + 3, [](double value) { return std::abs(value) <= LargestCoordinate; });
}
} // namespace

int GetPlainCell(vtkDataSet* dataset, vtkIdType cell, vtkIdList* ids)
{
  const int type = dataset->GetCellType(cell);
  dataset->GetCellPoints(cell, ids);
  if (type == VTK_CONVEX_POINT_SET ||
    !std::all_of(
      ids->begin(), ids->end(), [&](vtkIdType point) { return IsUsable(dataset, point); }))
  {
    return VTK_EMPTY_CELL;
  }
  if (type == VTK_TRIANGLE_STRIP)
  {
    const vtkIdType first = (ids->GetNumberOfIds() - 2) / 2;
    if (ids->GetNumberOfIds() < 3)
    {
      return VTK_EMPTY_CELL;
    }
    std::copy_n(ids->begin() + first, 3, ids->begin());
    ids->SetNumberOfIds(3);
    return VTK_TRIANGLE;
  }
  return type;
}

bool CurvedCell::Set(vtkDataSet* dataset, vtkIdType cell)
{
  if (GetPlainCell(dataset, cell, this->Ids) != dataset->GetCellType(cell))
  {
    return false;
  }
  dataset->GetCell(cell, this->Cell);
  this->Weights.resize(static_cast<std::size_t>(std::max<vtkIdType>(this->Cell->GetNumberOfPoints(), 1)));
  return this->Cell->GetParametricCoords() != nullptr;
}

Eigen::Vector3d CurvedCell::GetPlace(const Eigen::Vector3d& parameters)
{
  int part = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  this->Cell->EvaluateLocation(part, parameters.data(), place.data(), this->Weights.data());
  return place;
}

Eigen::Vector3d CurvedCell::GetNormalAt(const Eigen::Vector3d& parameters)
{
  // Interpolations are polynomials, also a step beyond the cell.
  constexpr double step = 1e-4;
  Eigen::Vector3d tangents[2];
  for (int axis = 0; axis < 2; ++axis)
  {
    const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(axis);
    tangents[axis] = this->GetPlace(parameters + offset) - this->GetPlace(parameters - offset);
  }
  const double longest = std::max(tangents[0].squaredNorm(), tangents[1].squaredNorm());
  const Eigen::Vector3d normal = tangents[0].cross(tangents[1]);
  return normal.norm() > 1e-6 * longest ? normal.normalized() : Eigen::Vector3d::Zero().eval();
}

Eigen::Vector3d CurvedCell::GetNormal(int index)
{
  const Eigen::Vector3d parameters(this->Cell->GetParametricCoords() + 3 * index);
  Eigen::Vector3d normal = this->GetNormalAt(parameters);
  if (normal.isZero(0.0))
  {
    // Where a side has become a point, as at a pole: what is near.
    Eigen::Vector3d center;
    this->Cell->GetParametricCenter(center.data());
    normal = this->GetNormalAt(parameters + 0.01 * (center - parameters));
  }
  return normal;
}

Eigen::Vector3d CurvedCell::GetNormalAtCenter()
{
  Eigen::Vector3d center;
  this->Cell->GetParametricCenter(center.data());
  return this->GetNormalAt(center);
}

void ComputeCellCenters(vtkDataSet* dataset, vtkDoubleArray* centers)
{
  const vtkIdType count = dataset->GetNumberOfCells();
  centers->SetNumberOfComponents(3);
  centers->SetNumberOfTuples(count);
  if (count == 0)
  {
    return;
  }
  const auto cellSize = static_cast<std::size_t>(std::max(dataset->GetMaxCellSize(), 1));
  vtkNew<vtkGenericCell> first;
  dataset->GetCell(0, first); // VTK makes what it needs for this when it is first called
  vtkSMPThreadLocalObject<vtkGenericCell> cells;
  vtkSMPThreadLocalObject<vtkIdList> lists;
  vtkSMPTools::For(0, count, 1024,
    [&](vtkIdType begin, vtkIdType end)
    {
      vtkGenericCell* cell = cells.Local();
      vtkIdList* ids = lists.Local();
      std::vector<double> weights(cellSize);
      for (vtkIdType id = begin; id < end; ++id)
      {
        Eigen::Map<Eigen::Vector3d> center(centers->GetPointer(3 * id));
        center.setZero();
        const int type = GetPlainCell(dataset, id, ids);
        if (type != VTK_EMPTY_CELL && type == dataset->GetCellType(id))
        {
          dataset->GetCell(id, cell);
          double parameters[3];
          int part = cell->GetParametricCenter(parameters);
          cell->EvaluateLocation(part, parameters, center.data(), weights.data());
          continue;
        }
        for (const vtkIdType point : *ids)
        {
          Eigen::Vector3d place;
          dataset->GetPoint(point, place.data());
          center += place / static_cast<double>(ids->GetNumberOfIds());
        }
      }
    });
}
} // namespace noise
