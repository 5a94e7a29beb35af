// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "DatasetCells.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace noise
{
namespace
{
/// VTK's answers for each type, asked once.
const DatasetCells::Kind* GetKinds()
{
  static const auto kinds = []
  {
    std::array<DatasetCells::Kind, VTK_NUMBER_OF_CELL_TYPES> all;
    for (int i = 0; i < VTK_NUMBER_OF_CELL_TYPES; ++i)
    {
      if (vtkSmartPointer<vtkCell> known = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(i)))
      {
        all[static_cast<std::size_t>(i)] = { known->GetCellDimension(), !known->IsLinear() };
      }
    }
    return all;
  }();
  return kinds.data();
}

/// Sets both, or none.
template <typename Lists, typename Id>
void SetLists(vtkCellArray* cells, Lists& lists, const Id*)
{
  using Array = vtkAOSDataArrayTemplate<Id>;
  auto* offsets = Array::FastDownCast(cells->GetOffsetsArray());
  auto* connectivity = Array::FastDownCast(cells->GetConnectivityArray());
  if (offsets && connectivity)
  {
    lists.Offsets = offsets->GetPointer(0);
    lists.Connectivity = connectivity->GetPointer(0);
  }
}
} // namespace

DatasetCells::DatasetCells(vtkDataSet* dataset)
  : DataSet(dataset)
  , Number(dataset->GetNumberOfCells())
  , Kinds(GetKinds())
{
  if (this->Number == 0)
  {
    return;
  }
  std::array<bool, VTK_NUMBER_OF_CELL_TYPES> present = {};
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(dataset))
  {
    this->Types = grid->GetCellTypesArray()->GetPointer(0);
    this->SetCells(grid->GetCells());
    // Cells of one type, as in most grids, are compared with their neighbours, which takes the least.
    present.at(this->Types[0]) = true;
    if (std::memcmp(this->Types, this->Types + 1, static_cast<std::size_t>(this->Number - 1)) != 0)
    {
      std::for_each(this->Types, this->Types + this->Number, [&](std::size_t type) { present.at(type) = true; });
    }
  }
  else if (auto* surface = vtkPolyData::SafeDownCast(dataset))
  {
    struct Part
    {
      vtkCellArray* Cells;
      unsigned char TypesOfSizes[6];
    };
    constexpr unsigned char strip = VTK_TRIANGLE_STRIP;
    const Part parts[] = {
      { surface->GetVerts(),
        { VTK_POLY_VERTEX, VTK_VERTEX, VTK_POLY_VERTEX, VTK_POLY_VERTEX, VTK_POLY_VERTEX, VTK_POLY_VERTEX } },
      { surface->GetLines(), { VTK_POLY_LINE, VTK_POLY_LINE, VTK_LINE, VTK_POLY_LINE, VTK_POLY_LINE, VTK_POLY_LINE } },
      { surface->GetPolys(), { VTK_POLYGON, VTK_POLYGON, VTK_POLYGON, VTK_TRIANGLE, VTK_QUAD, VTK_POLYGON } },
      { surface->GetStrips(), { strip, strip, strip, strip, strip, strip } }
    };
    for (const Part& part : parts)
    {
      if (part.Cells->GetNumberOfCells() > 0)
      {
        for (const unsigned char type : part.TypesOfSizes)
        {
          present[type] = true;
        }
        if (part.Cells->GetNumberOfCells() == this->Number)
        {
          std::copy_n(part.TypesOfSizes, 6, this->TypesOfSizes);
          this->SetCells(part.Cells);
        }
      }
    }
  }
  else
  {
    for (vtkIdType id = 0; id < this->Number; ++id)
    {
      present.at(static_cast<std::size_t>(dataset->GetCellType(id))) = true;
    }
  }
  for (int type = 0; type < VTK_NUMBER_OF_CELL_TYPES; ++type)
  {
    if (present[static_cast<std::size_t>(type)])
    {
      this->Dimensions.set(static_cast<std::size_t>(this->GetDimension(type)));
    }
  }
  if (!this->Wide.Offsets && !this->Narrow.Offsets)
  {
    // VTK makes what it needs for these when it is first called.
    vtkNew<vtkIdList> ids;
    dataset->GetCellPoints(0, ids);
    dataset->GetCellType(0);
  }
}

void DatasetCells::SetCells(vtkCellArray* cells)
{
  SetLists(cells, this->Wide, this->Wide.Offsets);
  SetLists(cells, this->Narrow, this->Narrow.Offsets);
}

int DatasetCells::AskType(vtkIdType cell) const
{
  return this->DataSet->GetCellType(cell);
}

CellIds DatasetCells::Reader::Ask(vtkIdType cell)
{
  if (!this->Room)
  {
    this->Room = vtkSmartPointer<vtkIdList>::New();
  }
  const auto& narrow = this->Cells->Narrow;
  if (narrow.Offsets)
  {
    this->Room->SetNumberOfIds(narrow.GetSize(cell));
    std::copy_n(narrow.Connectivity + narrow.Offsets[cell], narrow.GetSize(cell), this->Room->begin());
  }
  else
  {
    this->Cells->DataSet->GetCellPoints(cell, this->Room);
  }
  return { this->Room->GetPointer(0), this->Room->GetNumberOfIds() };
}
} // namespace noise
