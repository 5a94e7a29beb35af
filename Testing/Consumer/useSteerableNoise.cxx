// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Noise of a rotating flow on a small image, from C++.
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSteerableNoiseFilter.h"

#include <iostream>

int main()
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(64, 64, 1);
  vtkNew<vtkFloatArray> velocity;
  velocity->SetName("velocity");
  velocity->SetNumberOfComponents(3);
  for (int j = 0; j < 64; ++j)
  {
    for (int i = 0; i < 64; ++i)
    {
      velocity->InsertNextTuple3(31.5 - j, i - 31.5, 0.0);
    }
  }
  image->GetPointData()->SetVectors(velocity);

  vtkNew<vtkSteerableNoiseFilter> noise;
  noise->SetInputData(image);
  noise->SetFeatureSize(4.0);
  noise->Update();
  vtkDataArray* result =
    vtkDataSet::SafeDownCast(noise->GetOutput())->GetPointData()->GetArray("SteerableNoise");
  if (!result || result->GetNumberOfTuples() != 64 * 64)
  {
    std::cerr << "no noise\n";
    return 1;
  }
  double range[2];
  result->GetRange(range);
  std::cout << "noise from " << range[0] << " to " << range[1] << "\n";
  return range[0] < -1.0 && range[1] > 1.0 ? 0 : 1;
}
