// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the points of a dataset are, without a virtual call for each (private to this module).
 */
#ifndef PointPlaces_h
#define PointPlaces_h

#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include <Eigen/Core>

namespace noise
{
class PointPlaces
{
public:
  explicit PointPlaces(vtkDataSet* dataset)
    : DataSet(dataset)
  {
    auto* pointSet = vtkPointSet::SafeDownCast(dataset);
    vtkDataArray* array =
      pointSet && pointSet->GetPoints() ? pointSet->GetPoints()->GetData() : nullptr;
    if (auto* floats = vtkFloatArray::SafeDownCast(array))
    {
      this->Floats = floats->GetPointer(0);
    }
    else if (auto* doubles = vtkDoubleArray::SafeDownCast(array))
    {
      this->Doubles = doubles->GetPointer(0);
    }
  }

  Eigen::Vector3d operator()(vtkIdType point) const
  {
    if (this->Floats)
    {
      return Eigen::Map<const Eigen::Vector3f>(this->Floats + 3 * point).cast<double>();
    }
    if (this->Doubles)
    {
      return Eigen::Map<const Eigen::Vector3d>(this->Doubles + 3 * point);
    }
    Eigen::Vector3d place;
    this->DataSet->GetPoint(point, place.data());
    return place;
  }

private:
  vtkDataSet* DataSet;
  const float* Floats = nullptr;
  const double* Doubles = nullptr;
};
} // namespace noise

#endif
