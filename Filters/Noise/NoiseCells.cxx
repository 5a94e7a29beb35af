// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseCells.h"

#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkSMPThreadLocalObject.h"
#include "vtkSMPTools.h"

#include <Eigen/Core>

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
