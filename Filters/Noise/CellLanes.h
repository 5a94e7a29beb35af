// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Cells of one kind side by side, which processors work out several at once (private).
 */
#ifndef CellLanes_h
#define CellLanes_h

#include "DatasetCells.h"

#include "vtkCellType.h"

#include <Eigen/Core>

namespace noise
{
/// A number for each of as many cells as go into a register everywhere.
constexpr int LaneCount = 2;
using Lanes = Eigen::Array<double, LaneCount, 1>;

/// A vector for each of them.
struct LaneVector
{
  Lanes X, Y, Z;

  LaneVector operator+(const LaneVector& v) const { return { X + v.X, Y + v.Y, Z + v.Z }; }
  LaneVector operator-(const LaneVector& v) const { return { X - v.X, Y - v.Y, Z - v.Z }; }
  LaneVector operator*(const Lanes& s) const { return { X * s, Y * s, Z * s }; }
  LaneVector operator*(double s) const { return { X * s, Y * s, Z * s }; }
  Lanes Dot(const LaneVector& v) const { return X * v.X + Y * v.Y + Z * v.Z; }
  LaneVector Cross(const LaneVector& v) const
  {
    return { Y * v.Z - Z * v.Y, Z * v.X - X * v.Z, X * v.Y - Y * v.X };
  }
};

/// Vectors at the corners of some cells.
struct CornerVectors
{
  static constexpr int MostCells = 16;
  static constexpr int MostCorners = 8;

  alignas(16) double Values[MostCorners][3][MostCells] = {};

  void Set(int corner, int cell, const Eigen::Vector3d& vector)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Values[corner][axis][cell] = vector[axis];
    }
  }
  Eigen::Vector3d Get(int corner, int cell) const
  {
    const auto value = [&](int axis) { return this->Values[corner][axis][cell]; };
    return { value(0), value(1), value(2) };
  }

  /// Those of the cells from this one on.
  void SetLanes(int corner, int cell, const LaneVector& vectors)
  {
    Lanes::Map(this->Values[corner][0] + cell) = vectors.X;
    Lanes::Map(this->Values[corner][1] + cell) = vectors.Y;
    Lanes::Map(this->Values[corner][2] + cell) = vectors.Z;
  }
  LaneVector GetLanes(int corner, int cell) const
  {
    const auto lanes = [&](int axis) -> Lanes
    { return Lanes::Map(this->Values[corner][axis] + cell); };
    return { lanes(0), lanes(1), lanes(2) };
  }
};

/// Up to CornerVectors::MostCells simplices, quadrangles or hexahedra of one type.
struct CellBlock
{
  int Type = VTK_EMPTY_CELL;
  int Dimension = 0;
  int Corners = 0;
  int Count = 0;
  vtkIdType Cells[CornerVectors::MostCells];
  vtkIdType Points[CornerVectors::MostCells][CornerVectors::MostCorners];
  CornerVectors Places;

  /// Whether cells of this type go into blocks.
  static bool Takes(int type, int dimension, vtkIdType corners)
  {
    return (dimension == 2 && corners == 3) || (dimension == 3 && corners == 4) ||
      ((type == VTK_QUAD || type == VTK_PIXEL) && corners == 4) ||
      ((type == VTK_HEXAHEDRON || type == VTK_VOXEL) && corners == 8);
  }

  bool HasRoomFor(int type, vtkIdType corners) const
  {
    return this->Count == 0 ||
      (this->Count < CornerVectors::MostCells && type == this->Type && corners == this->Corners);
  }

  CellIds GetIds(int cell) const { return { this->Points[cell], this->Corners }; }

  /// Returns its index.
  template <class PlaceOf>
  int Add(vtkIdType cell, int type, int dimension, const CellIds& ids, PlaceOf&& placeOf)
  {
    this->Type = type;
    this->Dimension = dimension;
    this->Corners = static_cast<int>(ids.size());
    const int index = this->Count++;
    this->Cells[index] = cell;
    for (int i = 0; i < this->Corners; ++i)
    {
      this->Points[index][i] = ids[i];
      this->Places.Set(i, index, placeOf(ids[i]));
    }
    return index;
  }

  /**
   * Differences of the vectors at corners, of the cells from this one on: from one corner of a simplex to the others;
   * of a quadrangle and a hexahedron the means of the sides along each axis, which with parallel sides is what fits
   * them best.
   */
  void GetAxes(const CornerVectors& vectors, int cell, LaneVector* axes) const
  {
    const auto from = [&](int first, int last)
    { return vectors.GetLanes(last, cell) - vectors.GetLanes(first, cell); };
    // The corners of pixels and voxels are in the order of an image, those of others go round.
    const bool image = this->Type == VTK_PIXEL || this->Type == VTK_VOXEL;
    if (this->Corners == this->Dimension + 1)
    {
      for (int i = 0; i < this->Dimension; ++i)
      {
        axes[i] = from(0, i + 1);
      }
    }
    else if (this->Dimension == 2)
    {
      const LaneVector diagonals[2] = { from(0, 2 + image), from(3 - image, 1) };
      axes[0] = (diagonals[0] + diagonals[1]) * 0.5;
      axes[1] = (diagonals[0] - diagonals[1]) * 0.5;
    }
    else
    {
      const LaneVector diagonals[4] = { from(0, 6 + image), from(1, 7 - image), from(3 - image, 5),
        from(2 + image, 4) };
      const LaneVector even = diagonals[0] - diagonals[3];
      const LaneVector odd = diagonals[2] - diagonals[1];
      axes[0] = (even + odd) * 0.25;
      axes[1] = (even - odd) * 0.25;
      axes[2] = (diagonals[0] + diagonals[1] + (diagonals[2] + diagonals[3])) * 0.25;
    }
  }
};

/**
 * Goes through every `step`th of the cells from `begin` on of which isThere(cell, type), in their order. With
 * `inBlocks` those that a block takes are added to `block`, with add(index, ids), and worked on by work() when there
 * is no room for more; others go to other(cell, type, ids).
 */
template <class PlaceOf, class IsThere, class Add, class Work, class Other>
void VisitCells(const DatasetCells& cells, DatasetCells::Reader& read, vtkIdType begin, vtkIdType end,
  vtkIdType step, bool inBlocks, CellBlock& block, PlaceOf&& placeOf, IsThere&& isThere, Add&& add,
  Work&& work, Other&& other)
{
  const auto empty = [&]
  {
    work();
    block.Count = 0;
  };
  for (vtkIdType cell = begin; cell < end; cell += step)
  {
    const int type = cells.GetType(cell);
    if (!isThere(cell, type))
    {
      continue;
    }
    const int dimension = cells.GetDimension(type);
    const CellIds ids = read(cell);
    const bool taken = inBlocks && CellBlock::Takes(type, dimension, ids.size());
    if (!taken || !block.HasRoomFor(type, ids.size()))
    {
      empty();
    }
    if (taken)
    {
      add(block.Add(cell, type, dimension, ids, placeOf), ids);
    }
    else
    {
      other(cell, type, ids);
    }
  }
  empty();
}
} // namespace noise

#endif
