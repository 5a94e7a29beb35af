// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseGhosts.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>

namespace noise
{
namespace
{
constexpr unsigned char HiddenPoint = vtkDataSetAttributes::HIDDENPOINT;
constexpr unsigned char HiddenCell =
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

/// Values with one of these flags; empty if there are none.
std::vector<unsigned char> Select(vtkUnsignedCharArray* ghosts, unsigned char flags)
{
  std::vector<unsigned char> selected;
  if (ghosts)
  {
    const unsigned char* begin = ghosts->GetPointer(0);
    const unsigned char* end = begin + ghosts->GetNumberOfValues();
    if (std::any_of(begin, end, [&](unsigned char ghost) { return (ghost & flags) != 0; }))
    {
      selected.resize(end - begin);
      std::transform(
        begin, end, selected.begin(), [&](unsigned char ghost) { return ghost & flags ? 1 : 0; });
    }
  }
  return selected;
}
} // namespace

vtkUnsignedCharArray* GetGhosts(vtkDataSetAttributes* attributes, vtkIdType count)
{
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(
    attributes->GetArray(vtkDataSetAttributes::GhostArrayName()));
  return ghosts && ghosts->GetNumberOfComponents() == 1 && ghosts->GetNumberOfTuples() == count
    ? ghosts
    : nullptr;
}

HiddenSamples::HiddenSamples(vtkDataSet* dataset)
{
  const vtkIdType points = dataset->GetNumberOfPoints();
  const vtkIdType cells = dataset->GetNumberOfCells();
  this->Points = Select(GetGhosts(dataset->GetPointData(), points), HiddenPoint);
  this->Cells = Select(GetGhosts(dataset->GetCellData(), cells), HiddenCell);
  if (this->Points.empty() && this->Cells.empty())
  {
    return;
  }
  const bool byPoints = !this->Points.empty();
  this->Points.resize(points);
  this->Cells.resize(cells);
  std::vector<unsigned char> seen(points, 0);
  std::vector<unsigned char> used(points, 0);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    dataset->GetCellPoints(cell, ids);
    if (byPoints &&
      std::any_of(
        ids->begin(), ids->end(), [&](vtkIdType point) { return this->Points[point] != 0; }))
    {
      this->Cells[cell] = 1;
    }
    for (const vtkIdType point : *ids)
    {
      used[point] = 1;
      seen[point] |= this->Cells[cell] ? 0 : 1;
    }
  }
  for (vtkIdType point = 0; point < points; ++point)
  {
    this->Points[point] |= used[point] && !seen[point] ? 1 : 0;
  }
}
} // namespace noise
