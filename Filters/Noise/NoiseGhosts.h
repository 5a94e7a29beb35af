// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which points and cells are there for the noise (private). Duplicates of another piece are; what is
 * blanked is not, nor are coarse cells of an AMR that finer ones cover: their values and places are left
 * over, and must not show in what is seen.
 */
#ifndef NoiseGhosts_h
#define NoiseGhosts_h

#include "vtkType.h"

#include <vector>

class vtkDataSet;
class vtkDataSetAttributes;
class vtkUnsignedCharArray;

namespace noise
{
/// vtkGhostType with a value for each of `count` tuples; null if there is none.
vtkUnsignedCharArray* GetGhosts(vtkDataSetAttributes* attributes, vtkIdType count);

class HiddenSamples
{
public:
  /// Nothing is hidden.
  HiddenSamples() = default;
  /**
   * A cell is hidden by its own flag (HIDDENCELL, REFINEDCELL) or by a hidden point, as VTK has it; a
   * point by its own (HIDDENPOINT), or because all of its cells are hidden.
   */
  explicit HiddenSamples(vtkDataSet* dataset);

  bool HasPoint(vtkIdType point) const { return !this->Points.empty() && this->Points[point]; }
  bool HasCell(vtkIdType cell) const { return !this->Cells.empty() && this->Cells[cell]; }
  /// One value for each point or cell, not 0: hidden; empty where nothing is.
  const std::vector<unsigned char>& Get(bool cells) const
  {
    return cells ? this->Cells : this->Points;
  }

private:
  std::vector<unsigned char> Points;
  std::vector<unsigned char> Cells;
};
} // namespace noise

#endif
