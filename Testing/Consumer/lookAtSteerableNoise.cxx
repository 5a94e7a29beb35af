// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A picture of a rotating flow on a coarse plane, with the noise worked out for each fragment.
#include "vtkActor.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSteerableNoiseMapper.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <iostream>

int main()
{
  vtkNew<vtkPlaneSource> source;
  source->SetResolution(8, 8);
  source->Update();
  vtkPolyData* plane = source->GetOutput();
  vtkNew<vtkDoubleArray> velocity;
  velocity->SetName("velocity");
  velocity->SetNumberOfComponents(3);
  for (vtkIdType i = 0; i < plane->GetNumberOfPoints(); ++i)
  {
    const double* place = plane->GetPoint(i);
    velocity->InsertNextTuple3(-place[1], place[0], 0.0);
  }
  plane->GetPointData()->SetVectors(velocity);

  vtkNew<vtkSteerableNoiseMapper> mapper;
  mapper->SetInputDataObject(plane);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(200, 200);
  window->AddRenderer(renderer);
  renderer->ResetCamera();
  window->Render();

  // Of the middle, which the plane covers.
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(60, 60, 139, 139, 0, pixels);
  double sum = 0.0;
  double squares = 0.0;
  const vtkIdType count = pixels->GetNumberOfValues();
  for (vtkIdType i = 0; i < count; ++i)
  {
    sum += pixels->GetValue(i);
    squares += pixels->GetValue(i) * pixels->GetValue(i);
  }
  const double deviation = std::sqrt(squares / count - sum / count * (sum / count));
  std::cout << "grey values deviate by " << deviation << "\n";
  return deviation > 20.0 ? 0 : 1;
}
