// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What tests of mappers share: messages, and a scene whose picture or noise is read back.
#ifndef RenderingTestHelpers_h
#define RenderingTestHelpers_h

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace renderingtest
{
constexpr int Size = 256;
/// Counts what VTK complains about.
class ErrorCounter : public vtkOutputWindow
{
public:
  static ErrorCounter* New();
  vtkTypeMacro(ErrorCounter, vtkOutputWindow);
  void DisplayErrorText(const char* text) override { this->Add(text); }
  void DisplayWarningText(const char* text) override { this->Add(text); }
  void DisplayGenericWarningText(const char* text) override { this->Add(text); }
  std::string Text;

private:
  void Add(const char* text) { this->Text += text; }
};
inline vtkStandardNewMacro(ErrorCounter);

/// Collects messages while it lives.
class Messages
{
public:
  Messages() { vtkOutputWindow::SetInstance(this->Window); }
  ~Messages() { vtkOutputWindow::SetInstance(nullptr); }
  const std::string& Get() const { return this->Window->Text; }

private:
  vtkNew<ErrorCounter> Window;
};

/// A scene that looks along -z, so that a pixel is one unit wide.
template <class MapperType>
class SceneOf
{
public:
  explicit SceneOf(vtkDataObject* data, int width = Size)
  {
    this->Mapper->SetInputDataObject(data);
    this->Mapper->ScalarVisibilityOff();
    this->Actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(this->Actor);
    this->Renderer->SetBackground(1.0, 1.0, 1.0);
    this->Window->SetOffScreenRendering(1);
    this->Window->SetMultiSamples(0);
    this->Window->SetSize(width, width);
    this->Window->AddRenderer(this->Renderer);
  }

  void LookDown(double x, double y, double unitsHigh)
  {
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetFocalPoint(x, y, 0.0);
    camera->SetPosition(x, y, 1000.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
    camera->SetParallelScale(0.5 * unitsHigh);
    this->Renderer->ResetCameraClippingRange();
  }

  /// RGB of all pixels, rows from below.
  std::vector<unsigned char> Render()
  {
    this->Window->Render();
    const int* size = this->Window->GetSize();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }

  /// Noise of all pixels, NaN where there is none (or the background).
  std::vector<double> RenderNoise()
  {
    this->Mapper->OutputValueOn();
    const auto pixels = this->Render();
    std::vector<double> noise(pixels.size() / 3);
    for (std::size_t i = 0; i < noise.size(); ++i)
    {
      const int value = (pixels[3 * i] << 16) + (pixels[3 * i + 1] << 8) + pixels[3 * i + 2];
      noise[i] = value == 0 || value == 0xFFFFFF ? std::numeric_limits<double>::quiet_NaN()
                                                 : value / 16777215.0 * 16.0 - 8.0;
    }
    return noise;
  }

  /// Index of the pixel that a place in the scene falls into.
  std::size_t PixelOf(const double place[3])
  {
    this->Renderer->SetWorldPoint(place[0], place[1], place[2], 1.0);
    this->Renderer->WorldToDisplay();
    const double* display = this->Renderer->GetDisplayPoint();
    return static_cast<std::size_t>(std::floor(display[1] + 1e-6)) * this->Window->GetSize()[0] +
      static_cast<std::size_t>(std::floor(display[0] + 1e-6));
  }

  vtkNew<MapperType> Mapper;
  vtkNew<vtkActor> Actor;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
};
} // namespace renderingtest

#endif
