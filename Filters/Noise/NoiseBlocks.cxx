// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseBlocks.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkFieldData.h"
#include "vtkMultiProcessController.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace noise
{
void CopyBlocks(vtkDataObject* input, vtkDataObject* output,
  const std::function<void(vtkDataObject* copy, vtkDataObject* source)>& fill)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (!composite)
  {
    fill(output, input);
    return;
  }
  auto* inputs = vtkCompositeDataSet::SafeDownCast(input);
  composite->CopyStructure(inputs);
  composite->GetFieldData()->PassData(inputs->GetFieldData());
  auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(inputs->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    vtkDataObject* leaf = iterator->GetCurrentDataObject();
    auto copy = vtkSmartPointer<vtkDataObject>::Take(leaf->NewInstance());
    fill(copy, leaf);
    composite->SetDataSet(iterator, copy); // filled: an AMR asks for its dimensions
  }
}

//------------------------------------------------------------------------------
void VisitBlocks(vtkDataObject* data, const std::function<void(vtkDataObject*)>& visit)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(data);
  if (!composite)
  {
    visit(data);
    return;
  }
  auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    visit(iterator->GetCurrentDataObject());
  }
}

//------------------------------------------------------------------------------
void Reduce(
  vtkMultiProcessController* controller, double* values, std::size_t count, int operation)
{
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    const std::vector<double> here(values, values + count);
    controller->AllReduce(here.data(), values, static_cast<vtkIdType>(count), operation);
  }
}

//------------------------------------------------------------------------------
double RoundToThreeDigits(double value)
{
  if (!(value > 0.0))
  {
    return value;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return std::round(value / unit) * unit;
}
} // namespace noise
