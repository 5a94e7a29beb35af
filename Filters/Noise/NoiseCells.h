// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where cells are, whatever their points are (private).
 */
#ifndef NoiseCells_h
#define NoiseCells_h

#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkType.h"

#include <Eigen/Core>

#include <vector>

class vtkDataSet;
class vtkDoubleArray;

namespace noise
{
/**
 * The type and points of a cell as VTK may be asked where it is. VTK 9.2 reads and writes out of bounds
 * when it evaluates strips and convex point sets without a simplex that has a volume, and higher-order cells
 * whose coordinates are not finite or overflow when they are cubed. So a strip arrives as the triangle in its
 * middle, which is where VTK sees its centre; convex point sets, and cells with such coordinates, as
 * VTK_EMPTY_CELL with their points.
 */
int GetPlainCell(vtkDataSet* dataset, vtkIdType cell, vtkIdList* ids);

/**
 * Unit normals of curved surface cells, from the derivatives of VTK's interpolation. One object for each thread.
 */
class CurvedCell
{
public:
  /// Takes a cell of dimension 2; false where VTK cannot be asked about it.
  bool Set(vtkDataSet* dataset, vtkIdType cell);
  /// At its point `index`; 0 if there is none.
  Eigen::Vector3d GetNormal(int index);
  Eigen::Vector3d GetNormalAtCenter();

private:
  Eigen::Vector3d GetNormalAt(const Eigen::Vector3d& parameters);
  Eigen::Vector3d GetPlace(const Eigen::Vector3d& parameters);

  vtkNew<vtkGenericCell> Cell;
  vtkNew<vtkIdList> Ids;
  std::vector<double> Weights;
};

/// Centres of all cells, 3 components: VTK's, or the mean of the points of what GetPlainCell replaced.
void ComputeCellCenters(vtkDataSet* dataset, vtkDoubleArray* centers);
} // namespace noise

#endif
