// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Datasets, message counting and array access shared by the filters' tests.
#ifndef FilterTestHelpers_h
#define FilterTestHelpers_h

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace filtertest
{
/// Counts an object's errors and warnings instead of printing them.
class Messages : public vtkCommand
{
public:
  static Messages* New() { return new Messages; }
  void Execute(vtkObject*, unsigned long event, void* data) override
  {
    (event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings)++;
    this->Text += static_cast<const char*>(data);
  }
  int Errors = 0;
  int Warnings = 0;
  std::string Text;
};

inline vtkSmartPointer<Messages> Listen(vtkObject* object)
{
  auto messages = vtkSmartPointer<Messages>::New();
  object->AddObserver(vtkCommand::ErrorEvent, messages);
  object->AddObserver(vtkCommand::WarningEvent, messages);
  return messages;
}

/// A flow with vortices and no zero at the samples used here.
inline void Flow(const double p[3], double v[3])
{
  v[0] = 1.3 + std::sin(0.31 * p[1] + 0.2 * p[2]);
  v[1] = std::cos(0.27 * p[0]) - 0.3;
  v[2] = 0.6 * std::sin(0.23 * p[0] - 0.19 * p[1] + 0.5);
}

/// Adds the flow as vectors on the points, or on the cells at their centres.
template <typename ArrayT = vtkFloatArray>
vtkSmartPointer<ArrayT> AddFlow(
  vtkDataSet* dataset, bool cells = false, const char* name = "velocity", int components = 3)
{
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  const vtkIdType count = cells ? dataset->GetNumberOfCells() : dataset->GetNumberOfPoints();
  array->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    double p[3];
    if (cells)
    {
      double bounds[6];
      dataset->GetCellBounds(i, bounds);
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] = 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
      }
    }
    else
    {
      dataset->GetPoint(i, p);
    }
    double v[3];
    Flow(p, v);
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, c < 3 ? v[c] : 0.1 * v[c % 3]);
    }
  }
  vtkDataSetAttributes* attributes =
    cells ? static_cast<vtkDataSetAttributes*>(dataset->GetCellData()) : dataset->GetPointData();
  attributes->AddArray(array);
  if (components == 3)
  {
    attributes->SetActiveVectors(name);
  }
  return array;
}

inline vtkSmartPointer<vtkImageData> MakeImage(
  int nx, int ny, int nz, double spacing = 1.0, bool cells = false)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(nx, ny, nz);
  image->SetSpacing(spacing, spacing, spacing);
  AddFlow(image, cells);
  return image;
}

/// Values of the array on points or cells; empty where there is none.
inline std::vector<float> Values(vtkDataObject* data, const char* name = "SteerableNoise")
{
  std::vector<float> values;
  auto* dataset = vtkDataSet::SafeDownCast(data);
  vtkDataArray* array = nullptr;
  if (dataset)
  {
    array = dataset->GetPointData()->GetArray(name);
    array = array ? array : dataset->GetCellData()->GetArray(name);
  }
  for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
  {
    values.push_back(static_cast<float>(array->GetComponent(i, 0)));
  }
  return values;
}

inline bool AllFinite(const std::vector<float>& values)
{
  for (float value : values)
  {
    if (!std::isfinite(value))
    {
      return false;
    }
  }
  return !values.empty();
}

inline double Deviation(const std::vector<float>& values)
{
  double sum = 0.0;
  double squares = 0.0;
  for (float value : values)
  {
    sum += value;
    squares += double(value) * value;
  }
  const double mean = sum / values.size();
  return std::sqrt(squares / values.size() - mean * mean);
}
} // namespace filtertest

#endif
