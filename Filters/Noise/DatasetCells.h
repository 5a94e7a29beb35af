// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Types and points of a dataset's cells, where it can be without a virtual call for each (private).
 */
#ifndef DatasetCells_h
#define DatasetCells_h

#include "vtkIdList.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <bitset>

class vtkCellArray;
class vtkDataSet;

namespace noise
{
/// Points of a cell.
struct CellIds
{
  const vtkIdType* Begin;
  vtkIdType Count;

  const vtkIdType* begin() const { return this->Begin; }
  const vtkIdType* end() const { return this->Begin + this->Count; }
  vtkIdType size() const { return this->Count; }
  vtkIdType operator[](vtkIdType i) const { return this->Begin[i]; }
};

/**
 * Unstructured grids, and surfaces of one kind of cell, as nearly all are, are read where they lie; others are asked.
 * Threads may ask from the construction on. Cells that a vtkPolyData has marked as deleted are still there, as they are
 * for what draws and writes it.
 */
class DatasetCells
{
public:
  explicit DatasetCells(vtkDataSet* dataset);

  vtkIdType GetNumberOfCells() const { return this->Number; }

  int GetType(vtkIdType cell) const
  {
    return this->Types     ? this->Types[cell]
      : this->Wide.Offsets ? this->GetTypeOfSize(this->Wide, cell)
      : this->Narrow.Offsets ? this->GetTypeOfSize(this->Narrow, cell)
                             : this->AskType(cell);
  }

  int GetDimension(int type) const { return this->Kinds[type].Dimension; }
  /// Quadratic cells and such of higher order.
  bool IsCurved(int type) const { return this->Kinds[type].Curved; }
  /// Whether there are cells of this dimension.
  bool Has(int dimension) const { return this->Dimensions[static_cast<std::size_t>(dimension)]; }

  /// Reads the points of cells; one for each thread. What it gives stays until it is asked again.
  class Reader
  {
  public:
    explicit Reader(const DatasetCells& cells)
      : Cells(&cells)
    {
    }

    CellIds operator()(vtkIdType cell)
    {
      const auto& wide = this->Cells->Wide;
      if (wide.Offsets)
      {
        return { wide.Connectivity + wide.Offsets[cell], wide.GetSize(cell) };
      }
      return this->Ask(cell);
    }

  private:
    CellIds Ask(vtkIdType cell);

    const DatasetCells* Cells;
    vtkSmartPointer<vtkIdList> Room;
  };

  struct Kind
  {
    int Dimension = 0;
    bool Curved = false;
  };

private:
  /// The arrays of a vtkCellArray.
  template <typename Id>
  struct Lists
  {
    const Id* Offsets = nullptr;
    const Id* Connectivity = nullptr;

    vtkIdType GetSize(vtkIdType cell) const { return this->Offsets[cell + 1] - this->Offsets[cell]; }
  };

  void SetCells(vtkCellArray* cells);
  template <typename Id>
  int GetTypeOfSize(const Lists<Id>& lists, vtkIdType cell) const
  {
    const vtkIdType size = lists.GetSize(cell);
    return this->TypesOfSizes[size < 5 ? size : 5];
  }
  int AskType(vtkIdType cell) const;

  vtkDataSet* DataSet;
  vtkIdType Number;
  /// Of each type of cell.
  const Kind* Kinds;
  std::bitset<4> Dimensions;
  const unsigned char* Types = nullptr;
  /// Of a surface: the type of a cell by the number of its points, the last one of all that have more.
  unsigned char TypesOfSizes[6] = {};
  /// One of these, if cells are read where they lie.
  Lists<vtkIdType> Wide;
  Lists<vtkTypeInt32> Narrow;
};
} // namespace noise

#endif
