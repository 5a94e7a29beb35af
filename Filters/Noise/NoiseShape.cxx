// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseShape.h"

#include "DatasetCells.h"
#include "NoiseBlocks.h"

#include "vtkCommunicator.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"

#include <algorithm>
#include <limits>

namespace noise
{
namespace
{
/// Cells along each axis of what a structured dataset is a piece of; false for the others.
bool GetCells(vtkDataSet* dataset, const int* wholeExtent, int cells[3])
{
  int dimensions[3];
  if (!GetDimensions(dataset, dimensions))
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    cells[axis] = dimensions[axis] - 1;
    if (wholeExtent) // which sources may leave empty
    {
      cells[axis] = std::max(cells[axis], wholeExtent[2 * axis + 1] - wholeExtent[2 * axis]);
    }
  }
  return true;
}

/// The axis along which it is one cell thick, -1 if it is none, or if there are several such axes.
int GetSlabAxis(vtkDataSet* dataset, const int* wholeExtent)
{
  int cells[3];
  int dimensions[3];
  if (!GetCells(dataset, wholeExtent, cells) || !GetDimensions(dataset, dimensions) ||
    std::count(cells, cells + 3, 1) != 1)
  {
    return -1;
  }
  const auto axis = static_cast<int>(std::find(cells, cells + 3, 1) - cells);
  // Where it is flat its cells are surfaces anyway.
  return dimensions[axis] == 2 && *std::min_element(dimensions, dimensions + 3) > 1 ? axis : -1;
}
} // namespace

bool GetDimensions(vtkDataSet* dataset, int dimensions[3])
{
  if (auto* image = vtkImageData::SafeDownCast(dataset))
  {
    image->GetDimensions(dimensions);
    return true;
  }
  if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(dataset))
  {
    rectilinear->GetDimensions(dimensions);
    return true;
  }
  if (auto* structured = vtkStructuredGrid::SafeDownCast(dataset))
  {
    structured->GetDimensions(dimensions);
    return true;
  }
  return false;
}

CommonShape::CommonShape()
{
  std::fill_n(this->Facts, Directions, 0.0);
  std::fill(this->Facts + Directions, this->Facts + Count, -std::numeric_limits<double>::infinity());
}

void CommonShape::Add(vtkDataSet* dataset, bool cells, const int* wholeExtent)
{
  if (dataset->GetNumberOfPoints() == 0)
  {
    return;
  }
  const auto state = [this](int fact, double value)
  { this->Facts[fact] = std::max(this->Facts[fact], value); };
  int extents[3];
  const bool structured = GetCells(dataset, wholeExtent, extents);
  const bool thick = structured && *std::min_element(extents, extents + 3) > 1;
  if (auto* image = vtkImageData::SafeDownCast(dataset))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      state(ThickX + axis, cells ? extents[axis] > 1 : extents[axis] > 0);
    }
    const double* direction = image->GetDirectionMatrix()->GetData();
    for (int i = 0; i < 9; ++i)
    {
      state(Directions + i, direction[i]);
      state(OppositeDirections + i, -direction[i]);
    }
    state(Volume, thick);
    return;
  }
  state(NotImage, 1.0);
  state(Volume, structured ? thick : DatasetCells(dataset).Has(3));
}

void CommonShape::Reduce(vtkMultiProcessController* controller)
{
  noise::Reduce(controller, this->Facts, Count, vtkCommunicator::MAX_OP);
}

bool CommonShape::IsFlat() const
{
  const auto alike = [this](int i)
  { return this->Facts[Directions + i] == -this->Facts[OppositeDirections + i]; };
  bool flat = this->Facts[NotImage] == 0.0 &&
    *std::min_element(this->Facts + ThickX, this->Facts + ThickZ + 1) == 0.0;
  for (int i = 0; i < 9; ++i)
  {
    flat = flat && alike(i);
  }
  return flat;
}

Shape CommonShape::Get(vtkDataSet* dataset, bool cells, const int* wholeExtent) const
{
  Shape shape;
  const bool volume = this->Facts[Volume] != 0.0;
  int extents[3];
  if (!vtkImageData::SafeDownCast(dataset) || !GetCells(dataset, wholeExtent, extents))
  {
    shape.Slab = volume ? -1 : GetSlabAxis(dataset, wholeExtent);
    return shape;
  }
  shape.IsGrid = true;
  if (this->IsFlat())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      shape.Thick[axis] = this->Facts[ThickX + axis] != 0.0;
    }
    return shape;
  }
  // In space. Layers of points are surfaces, and so is one of cells where there are no others.
  const bool onlyImages = this->Facts[NotImage] == 0.0;
  shape.Slab = volume || (onlyImages && !cells) ? -1 : GetSlabAxis(dataset, wholeExtent);
  shape.IsGrid = *std::min_element(extents, extents + 3) > 0 && shape.Slab < 0;
  return shape;
}
} // namespace noise
