// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RenderingTestHelpers.h"

#include "MetricTensor.h"
#include "SteerableNoiseReference.h"
#include "SurfaceFields.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkHardwareSelector.h"
#include "vtkImageData.h"
#include "vtkLookupTable.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkSteerableNoiseMapper.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace renderingtest;

namespace
{
/// What 24 bits and a shader's floats keep of noise with unit variance.
constexpr double Tolerance = 2e-3;

class Scene : public SceneOf<vtkSteerableNoiseMapper>
{
public:
  explicit Scene(vtkDataObject* data, int width = Size)
    : SceneOf(data, width)
  {
    this->Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::WORLD);
  }
};

/// A wavy sheet of triangles with swirling vectors, tensors of them, and vectors on cells; 12 units apart. `turns`: how
/// much they turn.
vtkSmartPointer<vtkPolyData> MakeSheet(const std::array<double, 3>& from, double slope, int side = 20, double turns = 1.0)
{
  auto sheet = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("V");
  vectors->SetNumberOfComponents(3);
  vtkNew<vtkDoubleArray> tensors;
  tensors->SetName("T");
  tensors->SetNumberOfComponents(6);
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const double x = 12.0 * i;
      const double y = 12.0 * j;
      points->InsertNextPoint(
        from[0] + x, from[1] + y, from[2] + slope * x + 3.0 * std::sin(0.02 * y));
      const double u = 1.0 + std::sin(0.013 * turns * y + 0.4);
      const double v = std::cos(0.017 * turns * x) - 0.2;
      const double w = slope * u;
      vectors->InsertNextTuple3(2.5 * u, 2.5 * v, 2.5 * w);
      const double t[6] = { u * u + 0.1, v * v + 0.2, w * w, u * v, v * w, u * w };
      tensors->InsertNextTuple(t);
    }
  }
  vtkNew<vtkCellArray> polys;
  vtkNew<vtkDoubleArray> cellVectors;
  cellVectors->SetName("C");
  cellVectors->SetNumberOfComponents(3);
  for (int j = 0; j + 1 < side; ++j)
  {
    for (int i = 0; i + 1 < side; ++i)
    {
      const vtkIdType a = i + side * j;
      polys->InsertNextCell({ a, a + 1, a + side + 1, a + side });
      cellVectors->InsertNextTuple(vectors->GetTuple(a));
    }
  }
  sheet->SetPoints(points);
  sheet->SetPolys(polys);
  sheet->GetPointData()->SetVectors(vectors);
  sheet->GetPointData()->AddArray(tensors);
  sheet->GetCellData()->AddArray(cellVectors);
  return sheet;
}

using Setting = std::function<void(vtkSteerableNoiseFilter*)>;

/// Largest difference of the picture's noise at the vertices from the filter's.
double GetLargestDifference(
  vtkPolyData* sheet, const char* array, const Setting& set, int* compared = nullptr)
{
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetInputData(sheet);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array);
  filter->SetFeatureSize(19.0);
  set(filter);
  filter->Update();
  vtkDataArray* expected = vtkDataSet::SafeDownCast(filter->GetOutput())
                             ->GetPointData()
                             ->GetArray(filter->GetResultArrayName());

  Scene scene(sheet);
  scene.Mapper->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, array);
  EXPECT_TRUE(scene.Mapper->SetOptionsFrom(filter));
  scene.Actor->GetProperty()->SetRepresentationToPoints();
  scene.Actor->GetProperty()->SetPointSize(1.0);
  const double* center = sheet->GetCenter();
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  // Vertices are a whole number of pixels from the centre: now they are in the middle of theirs.
  camera->SetFocalPoint(center[0] + 0.5, center[1] + 0.5, center[2]);
  camera->SetPosition(center[0] + 0.5, center[1] + 0.5, center[2] + 1000.0);
  camera->SetParallelScale(128.0);
  scene.Renderer->ResetCameraClippingRange();
  const auto noise = scene.RenderNoise();
  double largest = 0.0;
  int count = 0;
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    const double value = noise[scene.PixelOf(sheet->GetPoint(i))];
    if (!std::isnan(value))
    {
      largest = std::max(largest, std::abs(value - expected->GetComponent(i, 0)));
      ++count;
    }
  }
  if (compared)
  {
    *compared = count;
  }
  return largest;
}
} // namespace

TEST(SteerableNoiseMapper, EqualsTheFilterWithEveryOption)
{
  const std::pair<const char*, Setting> settings[] = {
    { "defaults", [](vtkSteerableNoiseFilter*) {} },
    { "straight", [](vtkSteerableNoiseFilter* f) { f->FollowCurvatureOff(); } },
    { "StreakLength 3", [](vtkSteerableNoiseFilter* f) { f->SetStreakLength(3.0); } },
    { "StreakLength 12", [](vtkSteerableNoiseFilter* f) { f->SetStreakLength(12.0); } },
    { "EigenvalueSum 5", [](vtkSteerableNoiseFilter* f) { f->SetEigenvalueSum(5.0); } },
    { "Strength 0.5", [](vtkSteerableNoiseFilter* f) { f->SetStrength(0.5); } },
    { "Strength 0", [](vtkSteerableNoiseFilter* f) { f->SetStrength(0.0); } },
    { "Magnitude", [](vtkSteerableNoiseFilter* f)
      { f->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE); } },
    { "Magnitude 3", [](vtkSteerableNoiseFilter* f)
      {
        f->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE);
        f->SetReferenceMagnitude(3.0);
      } },
    { "Phase", [](vtkSteerableNoiseFilter* f) { f->SetPhase(0.3); } },
    { "Animate, Speed -2", [](vtkSteerableNoiseFilter* f)
      {
        f->AnimateOn();
        f->SetSpeed(-2.0);
      } },
    { "Streaks", [](vtkSteerableNoiseFilter* f) { f->SetBasis(vtkSteerableNoiseFilter::STREAKS); } },
    { "FeatureSize 60", [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(60.0); } },
    { "Streaks, straight", [](vtkSteerableNoiseFilter* f)
      {
        f->SetBasis(vtkSteerableNoiseFilter::STREAKS);
        f->FollowCurvatureOff();
      } },
    { "Streaks, Density 1, Phase", [](vtkSteerableNoiseFilter* f)
      {
        f->SetBasis(vtkSteerableNoiseFilter::STREAKS);
        f->SetDensity(1.0);
        f->SetPhase(0.8);
      } },
    { "Octaves", [](vtkSteerableNoiseFilter* f)
      {
        f->SetFeatureSize(60.0);
        f->SetOctaves(3);
        f->SetLacunarity(1.7);
        f->SetGain(0.6);
      } },
    { "Seed", [](vtkSteerableNoiseFilter* f) { f->SetSeed(-77); } },
  };
  const auto sheet = MakeSheet({ 3.0, -5.0, 2.0 }, 0.3);
  for (const auto& setting : settings)
  {
    int compared = 0;
    EXPECT_LE(GetLargestDifference(sheet, "V", setting.second, &compared), Tolerance)
      << setting.first;
    EXPECT_GT(compared, 380) << setting.first;
  }
}

TEST(SteerableNoiseMapper, EqualsTheFilterAnywhere)
{
  const std::array<double, 3> places[] = { { -120.0, -120.0, 0.0 }, { 448000.0, 5.4e6, 310.0 },
    { -7.1e6, -3.3e6, -40.0 } };
  for (const auto& place : places)
  {
    for (const double slope : { 0.0, 0.7 })
    {
      for (const char* array : { "V", "T" })
      {
        int compared = 0;
        EXPECT_LE(GetLargestDifference(
                    MakeSheet(place, slope), array, [](vtkSteerableNoiseFilter*) {}, &compared),
          Tolerance)
          << array << " at " << place[0] << ", slope " << slope;
        EXPECT_GT(compared, 380) << array << " at " << place[0] << ", slope " << slope;
      }
    }
  }
}

TEST(SteerableNoiseMapper, InterpolatesLikeTheReference)
{
  vtkNew<vtkPolyData> triangle;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(2.0, 3.0, 0.0);
  points->InsertNextPoint(250.0, 20.0, 0.0);
  points->InsertNextPoint(90.0, 240.0, 0.0);
  vtkNew<vtkCellArray> polys;
  polys->InsertNextCell({ 0, 1, 2 });
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("V");
  vectors->SetNumberOfComponents(3);
  vectors->InsertNextTuple3(2.0, 0.2, 0.0);
  vectors->InsertNextTuple3(1.0, 1.5, 0.0);
  vectors->InsertNextTuple3(-0.4, 1.0, 0.0);
  triangle->SetPoints(points);
  triangle->SetPolys(polys);
  triangle->GetPointData()->SetVectors(vectors);
  const noise::SurfaceFields fields =
    noise::ComputeSurfaceFields(triangle, vectors, false, false);

  Scene scene(triangle);
  scene.Mapper->SetFeatureSize(17.0);
  scene.LookDown(128.0, 128.0, 256.0);
  const auto noise = scene.RenderNoise();

  steerable::NoiseParameters parameters;
  parameters.FeatureSize = 17.0;
  Eigen::Matrix3d corners;
  for (int i = 0; i < 3; ++i)
  {
    corners.col(i) = Eigen::Vector3d(points->GetPoint(i)[0], points->GetPoint(i)[1], 1.0);
  }
  const Eigen::Matrix3d toBarycentric = corners.inverse();
  const auto interpolate = [](vtkFloatArray* array, const Eigen::Vector3d& shares)
  {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i)
    {
      value += shares[i] * Eigen::Map<const Eigen::Vector3d>(array->GetTuple3(i));
    }
    return value;
  };
  int compared = 0;
  for (int y = 5; y < Size; y += 13)
  {
    for (int x = 5; x < Size; x += 13)
    {
      const Eigen::Vector3d place(x + 0.5, y + 0.5, 0.0);
      const Eigen::Vector3d shares = toBarycentric * Eigen::Vector3d(place[0], place[1], 1.0);
      if (shares.minCoeff() < 0.01)
      {
        continue;
      }
      const auto metric = steerable::MetricFromSurfaceVector(
        parameters, interpolate(fields.Steering, shares), interpolate(fields.Normals, shares));
      const double expected = steerable::SteerableNoiseReference<3>(
        parameters, place, metric, interpolate(fields.Curvature, shares));
      EXPECT_NEAR(noise[static_cast<std::size_t>(y) * Size + x], expected, Tolerance) << x << " " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(SteerableNoiseMapper, CellVectorsAreMeansOrConstant)
{
  // Cells of 9 pixels: the middle of a cell is that of a pixel.
  constexpr int side = 24;
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0, side + 1);
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    sheet->GetPoints()->SetPoint(i, 9.0 * (i % (side + 1)), 9.0 * (i / (side + 1)), 0.0);
  }
  sheet->GetPointData()->Initialize();
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetInputData(sheet);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "C");
  filter->SetFeatureSize(23.0);
  filter->Update();
  vtkDataArray* expected =
    vtkDataSet::SafeDownCast(filter->GetOutput())->GetCellData()->GetArray("SteerableNoise");

  Scene scene(sheet, 9 * side);
  scene.Mapper->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "C");
  scene.Mapper->SetFeatureSize(23.0);
  scene.LookDown(4.5 * side, 4.5 * side, 9.0 * side);
  const auto smooth = scene.RenderNoise();
  scene.Mapper->VectorsPerCellOn();
  const auto constant = scene.RenderNoise();
  double largest = 0.0;
  double smoothSquares = 0.0;
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const std::size_t pixel = static_cast<std::size_t>(9 * j + 4) * (9 * side) + 9 * i + 4;
      const double value = expected->GetComponent(i + side * j, 0);
      ASSERT_FALSE(std::isnan(constant[pixel]));
      largest = std::max(largest, std::abs(constant[pixel] - value));
      smoothSquares += (smooth[pixel] - value) * (smooth[pixel] - value);
    }
  }
  EXPECT_LE(largest, Tolerance);
  // The means are nearly the cell's own vector where the field is smooth.
  const double rms = std::sqrt(smoothSquares) / side;
  EXPECT_GT(rms, Tolerance);
  EXPECT_LT(rms, 0.5); // 1.4 is other noise
}

TEST(SteerableNoiseMapper, EveryVariantOfTheShaderDraws)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.1);
  for (int variant = 0; variant < 128; ++variant)
  {
    Messages messages;
    Scene scene(sheet, 64);
    const bool cells = variant & 1;
    const bool tensors = (variant & 2) && !cells;
    scene.Mapper->SetInputArrayToProcess(0, 0, 0,
      cells ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
      cells ? "C" : tensors ? "T" : "V");
    scene.Mapper->SetVectorsPerCell(cells && (variant & 2));
    scene.Mapper->SetBasis(
      variant & 4 ? vtkSteerableNoiseMapper::STREAKS : vtkSteerableNoiseMapper::GRADIENT);
    scene.Mapper->SetAnimate(variant & 8);
    scene.Mapper->SetOctaves(variant & 16 ? 2 : 1);
    scene.Mapper->SetFeatureSizeMode(
      variant & 32 ? vtkSteerableNoiseMapper::WORLD : vtkSteerableNoiseMapper::PIXELS);
    scene.Mapper->SetFeatureSize(25.0);
    scene.Mapper->SetOutputValue(variant & 64);
    scene.Mapper->SetNoiseColorMode(variant / 4 % 4);
    scene.LookDown(114.0, 114.0, 228.0);
    scene.Renderer->SetBackground(0.0, 0.0, 0.0);
    const auto pixels = scene.Render();
    double sum = 0.0;
    double squares = 0.0;
    for (const unsigned char value : pixels)
    {
      sum += value;
      squares += double(value) * value;
    }
    const double mean = sum / pixels.size();
    EXPECT_GT(std::sqrt(squares / pixels.size() - mean * mean), 5.0) << variant;
    EXPECT_EQ(messages.Get(), "") << variant;
  }
}

/// Where cells are as small as pixels their vertices are enough, and nobody sees it; a large cell far out of the
/// view has all of it drawn by fragments.
TEST(SteerableNoiseMapper, CellsAsSmallAsPixelsAreEvaluatedAtTheirVertices)
{
  const auto fine = MakeSheet({ 3.0, -5.0, 2.0 }, 0.1, 150, 0.1);
  const auto large = MakeSheet({ 0.0, 0.0, 0.0 }, 0.1, 2);
  for (vtkIdType i = 0; i < large->GetNumberOfPoints(); ++i)
  {
    const double* place = large->GetPoint(i);
    large->GetPoints()->SetPoint(i, 1e4 + 1e2 * place[0], 1e2 * place[1], place[2]);
  }
  vtkNew<vtkMultiBlockDataSet> both;
  both->SetBlock(0, fine);
  both->SetBlock(1, large);
  vtkNew<vtkMultiBlockDataSet> alone;
  alone->SetBlock(0, fine);

  // Root mean square of the difference between the two.
  const auto differ = [&](double pixel, double feature, bool parallel, bool edges)
  {
    std::vector<double> noise[2];
    for (vtkMultiBlockDataSet* data : { alone.Get(), both.Get() })
    {
      Messages messages;
      Scene scene(data);
      scene.Mapper->SetFeatureSize(feature);
      scene.Actor->GetProperty()->SetEdgeVisibility(edges);
      scene.LookDown(900.0, 900.0, Size * pixel);
      if (!parallel)
      {
        vtkCamera* camera = scene.Renderer->GetActiveCamera();
        camera->ParallelProjectionOff();
        camera->SetPosition(
          900.0, 900.0, 0.5 * Size * pixel / std::tan(vtkMath::RadiansFromDegrees(15.0)));
        scene.Renderer->ResetCameraClippingRange();
      }
      noise[data == both] = scene.RenderNoise();
      EXPECT_EQ(messages.Get(), "");
    }
    double squares = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < noise[0].size(); ++i)
    {
      if (!std::isnan(noise[0][i]) && !std::isnan(noise[1][i]))
      {
        squares += (noise[0][i] - noise[1][i]) * (noise[0][i] - noise[1][i]);
        count += 1;
      }
    }
    EXPECT_GT(count, Size * Size / 3);
    return std::sqrt(squares / count);
  };
  for (const bool parallel : { true, false })
  {
    for (const bool edges : { false, true })
    {
      const double difference = differ(10.0, 130.0, parallel, edges);
      EXPECT_GT(difference, 0.01) << parallel << edges;
      EXPECT_LT(difference, 0.1) << parallel << edges;
    }
    EXPECT_LT(differ(5.0, 130.0, parallel, false), Tolerance) << "cells of three pixels";
    EXPECT_LT(differ(10.0, 110.0, parallel, false), Tolerance) << "small features";
  }
}

TEST(SteerableNoiseMapper, OptionsThatFragmentsDoNotHaveAreRefused)
{
  const Setting refused[] = {
    [](vtkSteerableNoiseFilter* f) { f->LatticeWindowOn(); },
    [](vtkSteerableNoiseFilter* f) { f->SetBasis(vtkSteerableNoiseFilter::VALUE); },
    [](vtkSteerableNoiseFilter* f) { f->SetNormalization(vtkSteerableNoiseFilter::NONE); },
    [](vtkSteerableNoiseFilter* f) { f->SetFade(vtkSteerableNoiseFilter::WIDE); },
    [](vtkSteerableNoiseFilter* f) { f->SetLattice(vtkSteerableNoiseFilter::JITTERED); },
    [](vtkSteerableNoiseFilter* f) { f->SetGradientSet(vtkSteerableNoiseFilter::PERLIN); },
    [](vtkSteerableNoiseFilter* f) { f->TurbulenceOn(); },
    [](vtkSteerableNoiseFilter* f) { f->SetPeriod(4, 0, 0); },
    [](vtkSteerableNoiseFilter* f) { f->SetOctaves(9); },
  };
  for (const Setting& set : refused)
  {
    Messages messages;
    vtkNew<vtkSteerableNoiseFilter> filter;
    filter->SetStreakLength(4.0);
    set(filter);
    vtkNew<vtkSteerableNoiseMapper> mapper;
    EXPECT_FALSE(mapper->SetOptionsFrom(filter));
    EXPECT_EQ(mapper->GetStreakLength(), 6.0);
    EXPECT_NE(messages.Get().find("Noise of fragments does not have"), std::string::npos);
  }
}

TEST(SteerableNoiseMapper, WhatHasNoDirectionShowsTheSurface)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  vtkDataArray* vectors = sheet->GetPointData()->GetVectors();
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    const double bad = i % 20 < 7 ? std::numeric_limits<double>::quiet_NaN()
      : i % 20 > 13               ? 0.0
                                  : vectors->GetComponent(i, 0);
    for (int c = 0; c < 3 && (i % 20 < 7 || i % 20 > 13); ++c)
    {
      vectors->SetComponent(i, c, bad);
    }
  }
  Scene scene(sheet);
  scene.Actor->GetProperty()->SetColor(0.2, 0.6, 1.0);
  scene.Actor->GetProperty()->LightingOff();
  scene.LookDown(114.0, 114.0, 228.0);
  scene.Mapper->SetFeatureSize(15.0);
  const auto pixels = scene.Render();
  const auto isSurface = [&](int x)
  {
    int count = 0;
    for (int y = 20; y < 230; ++y)
    {
      const unsigned char* rgb = &pixels[3 * (static_cast<std::size_t>(y) * Size + x)];
      count += std::abs(rgb[0] - 51) <= 1 && std::abs(rgb[1] - 153) <= 1 && rgb[2] >= 254;
    }
    return count / 210.0;
  };
  EXPECT_EQ(isSurface(40), 1.0);  // not finite
  EXPECT_EQ(isSurface(82), 1.0);  // a triangle with one such corner
  EXPECT_LT(isSurface(120), 0.3); // noise
  EXPECT_EQ(isSurface(220), 1.0); // zero
  scene.Mapper->UseMaskColorOn();
  scene.Mapper->SetMaskColor(0.2, 0.6, 1.0);
  scene.Actor->GetProperty()->SetColor(1.0, 0.0, 0.0);
  EXPECT_EQ(scene.Render()[3 * (100 * Size + 40)], 51);
}

TEST(SteerableNoiseMapper, ColourModes)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  Scene scene(sheet);
  scene.Actor->GetProperty()->SetColor(0.8, 0.4, 0.2);
  scene.Actor->GetProperty()->LightingOff();
  scene.Renderer->SetBackground(0.0, 0.0, 0.0);
  scene.LookDown(114.0, 114.0, 200.0);
  scene.Mapper->SetFeatureSize(15.0);
  const auto statistics = [&](int mode)
  {
    scene.Mapper->SetNoiseColorMode(mode);
    const auto pixels = scene.Render();
    double mean[3] = { 0.0, 0.0, 0.0 };
    double squares = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
    {
      mean[i % 3] += pixels[i] * 3.0 / pixels.size();
      squares += i % 3 == 0 ? pixels[i] * double(pixels[i]) * 3.0 / pixels.size() : 0.0;
    }
    return std::array<double, 4>{ mean[0], mean[1], mean[2],
      std::sqrt(squares - mean[0] * mean[0]) };
  };
  const auto multiply = statistics(vtkSteerableNoiseMapper::MULTIPLY);
  EXPECT_NEAR(multiply[0] / multiply[2], 4.0, 0.1); // the hue stays
  EXPECT_LT(multiply[0], 200.0);
  EXPECT_GT(multiply[3], 25.0);
  const auto blend = statistics(vtkSteerableNoiseMapper::BLEND);
  EXPECT_NEAR(blend[0], 0.8 * 127.5 + 0.2 * 204.0, 10.0); // 0.8 of grey
  EXPECT_NEAR(blend[0] - blend[2], 0.2 * (204.0 - 51.0), 6.0);
  const auto lightness = statistics(vtkSteerableNoiseMapper::LIGHTNESS);
  EXPECT_NEAR(lightness[0], 204.0, 25.0);
  EXPECT_GT(lightness[0], 1.8 * lightness[1]);
  EXPECT_GT(lightness[3], 15.0);
  const auto opacity = statistics(vtkSteerableNoiseMapper::OPACITY);
  EXPECT_TRUE(scene.Mapper->HasTranslucentPolygonalGeometry());
  EXPECT_NEAR(opacity[0] / 204.0, 0.6, 0.06); // gaps show the black behind
  EXPECT_NEAR(opacity[0] / opacity[2], 4.0, 0.2);
  scene.Mapper->SetNoiseIntensity(0.0);
  EXPECT_NEAR(statistics(vtkSteerableNoiseMapper::MULTIPLY)[3], 0.0, 0.5);
}

TEST(SteerableNoiseMapper, BlocksThatShareTheirPointsKeepTheirOwnVectors)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (int part = 0; part < 3; ++part)
  {
    vtkNew<vtkPolyData> block;
    block->SetPoints(sheet->GetPoints());
    vtkNew<vtkCellArray> polys;
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < sheet->GetNumberOfCells(); ++cell)
    {
      if (cell % 19 / 7 == part)
      {
        sheet->GetCellPoints(cell, ids);
        polys->InsertNextCell(ids);
      }
    }
    block->SetPolys(polys);
    if (part < 2)
    {
      vtkNew<vtkDoubleArray> vectors;
      vectors->SetName("V");
      vectors->SetNumberOfComponents(3);
      for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
      {
        vectors->InsertNextTuple3(part == 0, part == 1, 0.0);
      }
      block->GetPointData()->AddArray(vectors);
    }
    blocks->SetBlock(part, block);
  }
  Messages messages;
  Scene scene(blocks);
  scene.Mapper->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V");
  scene.Mapper->SetFeatureSize(12.0);
  scene.LookDown(114.0, 114.0, 228.0);
  const auto noise = scene.RenderNoise();
  const auto change = [&](int x0, int dx, int dy)
  {
    double sum = 0.0;
    for (int y = 30; y < 220; ++y)
    {
      for (int x = x0; x < x0 + 50; ++x)
      {
        const double step = noise[static_cast<std::size_t>(y + dy) * Size + x + dx] -
          noise[static_cast<std::size_t>(y) * Size + x];
        sum += step * step;
      }
    }
    return std::sqrt(sum);
  };
  EXPECT_GT(change(20, 0, 1), 4.0 * change(20, 1, 0));   // along x
  EXPECT_GT(change(115, 1, 0), 4.0 * change(115, 0, 1)); // along y
  EXPECT_TRUE(std::isnan(noise[100 * Size + 220]));       // a block without the array
  EXPECT_EQ(messages.Get(), "");
}

TEST(SteerableNoiseMapper, NoArrayIsOneWarningAndASurface)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  Messages messages;
  Scene scene(sphere->GetOutput());
  scene.Actor->GetProperty()->SetColor(0.5, 0.5, 0.5);
  scene.Renderer->ResetCamera();
  scene.Render();
  scene.Render();
  const auto first = messages.Get().find("There are no vectors");
  ASSERT_NE(first, std::string::npos);
  EXPECT_EQ(messages.Get().find("There are no vectors", first + 1), std::string::npos);
  EXPECT_LT(scene.Render()[3 * (128 * Size + 128)], 255);
}

TEST(SteerableNoiseMapper, EveryViewportShowsTheSamePicture)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.2);
  Scene alone(sheet, 128);
  alone.Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::PIXELS);
  alone.LookDown(114.0, 114.0, 200.0);
  const auto expected = alone.Render();

  Scene scene(sheet, 256);
  scene.Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::PIXELS);
  scene.LookDown(114.0, 114.0, 200.0);
  scene.Renderer->SetViewport(0.5, 0.5, 1.0, 1.0);
  vtkNew<vtkRenderer> other;
  other->SetViewport(0.0, 0.0, 0.5, 0.5);
  other->AddActor(scene.Actor);
  other->SetActiveCamera(scene.Renderer->GetActiveCamera());
  scene.Window->AddRenderer(other);
  const auto pixels = scene.Render();
  int different = 0;
  for (int y = 0; y < 128; ++y)
  {
    for (int x = 0; x < 128; ++x)
    {
      const int value = expected[3 * (static_cast<std::size_t>(y) * 128 + x)];
      for (const int corner : { 0, 128 })
      {
        different += std::abs(value -
                       pixels[3 * (static_cast<std::size_t>(y + corner) * 256 + x + corner)]) > 2;
      }
    }
  }
  EXPECT_LE(different, 20);
}

TEST(SteerableNoiseMapper, PicksWhatAPlainMapperPicks)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  Scene scene(sheet);
  scene.LookDown(114.0, 114.0, 228.0);
  const auto before = scene.Render();
  vtkNew<vtkHardwareSelector> selector;
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  selector->SetRenderer(scene.Renderer);
  selector->SetArea(128, 128, 129, 129);
  vtkSmartPointer<vtkSelection> selection;
  selection.TakeReference(selector->Select());
  ASSERT_EQ(selection->GetNumberOfNodes(), 1u);
  vtkAbstractArray* ids = selection->GetNode(0)->GetSelectionList();
  ASSERT_EQ(ids->GetNumberOfTuples(), 1);
  EXPECT_EQ(vtkDataArray::SafeDownCast(ids)->GetTuple1(0), 9 + 19 * 9);
  EXPECT_EQ(scene.Render(), before);
}

TEST(SteerableNoiseMapper, OptionsThatAreDrawnUploadNothing)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  Scene scene(sheet);
  scene.Mapper->AnimateOn();
  scene.LookDown(114.0, 114.0, 228.0);
  auto last = scene.Render();
  const vtkMTimeType uploaded = scene.Mapper->GetUploadTime();
  EXPECT_GT(uploaded, 0u);
  for (int frame = 1; frame < 24; ++frame)
  {
    scene.Mapper->SetPhase(frame / 24.0);
    const auto next = scene.Render();
    EXPECT_NE(next, last);
    last = next;
  }
  scene.Mapper->SetSeed(4);
  scene.Mapper->SetOctaves(3);
  scene.Mapper->SetStreakLength(9.0);
  scene.Mapper->SetNoiseIntensity(0.4);
  EXPECT_NE(scene.Render(), last);
  EXPECT_EQ(scene.Mapper->GetUploadTime(), uploaded);
  sheet->GetPointData()->GetVectors()->SetComponent(0, 0, 5.0);
  sheet->GetPointData()->GetVectors()->Modified();
  sheet->Modified();
  scene.Render();
  EXPECT_GT(scene.Mapper->GetUploadTime(), uploaded);
}

TEST(SteerableNoiseMapper, PixelSizesZoomWithoutAJumpAndKeepTheirContrast)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  Scene scene(sheet);
  scene.Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::PIXELS);
  std::vector<double> before;
  double worst = 0.0;
  for (int step = 0; step <= 30; ++step)
  {
    const double zoom = std::pow(4.0, step / 30.0);
    scene.LookDown(114.0, 114.0, 200.0 / zoom);
    const auto noise = scene.RenderNoise();
    double sum = 0.0;
    double squares = 0.0;
    for (const double value : noise)
    {
      sum += value;
      squares += value * value;
    }
    const double mean = sum / noise.size();
    const double deviation = std::sqrt(squares / noise.size() - mean * mean);
    EXPECT_GT(deviation, 0.9) << zoom;
    EXPECT_LT(deviation, 1.1) << zoom;
    // The same places, seen in every step.
    std::vector<double> now;
    for (int j = -20; j <= 20; ++j)
    {
      for (int i = -20; i <= 20; ++i)
      {
        // Between pixels: bilinear.
        const double x = Size / 2.0 - 0.5 + i * zoom * 1.2;
        const double y = Size / 2.0 - 0.5 + j * zoom * 1.2;
        const int x0 = static_cast<int>(x);
        const int y0 = static_cast<int>(y);
        const auto at = [&](int a, int b) { return noise[static_cast<std::size_t>(b) * Size + a]; };
        now.push_back((1 - (x - x0)) * (1 - (y - y0)) * at(x0, y0) +
          (x - x0) * (1 - (y - y0)) * at(x0 + 1, y0) + (1 - (x - x0)) * (y - y0) * at(x0, y0 + 1) +
          (x - x0) * (y - y0) * at(x0 + 1, y0 + 1));
      }
    }
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      worst = std::max(worst, std::abs(now[i] - before[i]));
    }
    before = now;
  }
  // A jump would be a new pattern from one step to the next, up to 6 at the worst of these places.
  EXPECT_LT(worst, 2.0);
}

TEST(SteerableNoiseMapper, PanningMovesThePatternWithTheSurface)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  Scene scene(sheet);
  scene.Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::PIXELS);
  scene.LookDown(100.0, 100.0, 128.0);
  const auto first = scene.RenderNoise();
  scene.LookDown(105.0, 102.0, 128.0); // 10 and 4 pixels
  const auto second = scene.RenderNoise();
  double largest = 0.0;
  for (int y = 10; y < 240; ++y)
  {
    for (int x = 10; x < 240; ++x)
    {
      largest = std::max(largest,
        std::abs(first[static_cast<std::size_t>(y + 4) * Size + x + 10] -
          second[static_cast<std::size_t>(y) * Size + x]));
    }
  }
  EXPECT_LT(largest, 0.01);
}

/// The longest tensor is that of the Frobenius norm, as the filter has it.
TEST(SteerableNoiseMapper, StrengthByMagnitudeOfTensorsEqualsTheFilter)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.1);
  EXPECT_LT(GetLargestDifference(sheet, "T",
              [](vtkSteerableNoiseFilter* filter)
              { filter->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE); }),
    Tolerance);
}

/// Values that stand for missing ones show the surface, and do not set the strength of the others.
TEST(SteerableNoiseMapper, FillValuesShowTheSurface)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  const auto look = [&](double upper)
  {
    Scene scene(sheet);
    scene.Mapper->SetFeatureSize(12.0);
    scene.Mapper->SetStrengthMode(vtkSteerableNoiseMapper::MAGNITUDE);
    scene.Mapper->SetMaskUpperThreshold(upper);
    scene.LookDown(114.0, 114.0, 228.0);
    return scene.RenderNoise();
  };
  const auto whole = look(0.0);
  for (vtkIdType i = 0; i < 5; ++i)
  {
    sheet->GetPointData()->GetVectors()->SetTuple3(i, -30000.0, -30000.0, -30000.0);
  }
  sheet->GetPointData()->GetVectors()->Modified();
  sheet->Modified();
  Messages messages;
  const auto found = look(0.0);
  EXPECT_NE(messages.Get().find("MaskUpperThreshold"), std::string::npos);
  const auto byHand = look(100.0);
  const auto all = look(1e300);
  int missing = 0;
  int different = 0;
  int changed = 0;
  for (int y = 40; y < Size; ++y) // beyond the cells with fill values
  {
    for (int x = 0; x < Size; ++x)
    {
      const std::size_t i = static_cast<std::size_t>(y) * Size + x;
      different += std::abs(found[i] - whole[i]) > 0.01;
      changed += std::abs(all[i] - whole[i]) > 0.1;
    }
  }
  for (int x = 0; x < 40; ++x)
  {
    missing += std::isnan(found[static_cast<std::size_t>(5) * Size + x]);
  }
  EXPECT_EQ(missing, 40);
  EXPECT_LT(different, 200);
  EXPECT_GT(changed, 10000);
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    ASSERT_TRUE(found[i] == byHand[i] || (std::isnan(found[i]) && std::isnan(byHand[i]))) << i;
  }
}

/// The automatic size is the filter's where samples are fine.
TEST(SteerableNoiseMapper, AutomaticWorldSizeIsTheFilters)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  const auto look = [&](double size)
  {
    Scene scene(sheet);
    scene.Mapper->SetFeatureSize(size);
    scene.LookDown(114.0, 114.0, 100.0);
    return scene.RenderNoise();
  };
  double bounds[6];
  sheet->GetBounds(bounds);
  EXPECT_EQ(look(0.0), look(noise::GetAutomaticFeatureSize(bounds)));
}

TEST(SteerableNoiseMapper, MovingMeshesAreDrawnWhereTheyAre)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  const auto look = [](Scene& scene)
  {
    scene.Mapper->SetFeatureSize(12.0);
    scene.LookDown(114.0, 114.0, 228.0);
    return scene.Render();
  };
  Scene scene(sheet);
  const auto first = look(scene);
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    double place[3];
    sheet->GetPoint(i, place);
    sheet->GetPoints()->SetPoint(i, place[0] + 0.1 * place[1], place[1] + 6.0, 0.2 * place[0]);
  }
  sheet->GetPoints()->Modified();
  const auto moved = look(scene);
  EXPECT_NE(moved, first);
  Scene fresh(sheet);
  EXPECT_EQ(moved, look(fresh));
}

/// Two surfaces one behind the other at opacity 0.5: what each shows alone, mixed.
TEST(SteerableNoiseMapper, TranslucentSurfacesShowEachOther)
{
  const auto back = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  const auto front = MakeSheet({ 0.0, 0.0, 50.0 }, 0.0);
  for (vtkIdType i = 0; i < front->GetNumberOfPoints(); ++i)
  {
    front->GetPointData()->GetVectors()->SetTuple3(i, 0.0, 1.0, 0.0);
  }
  const auto alone = [](vtkPolyData* sheet)
  {
    Scene scene(sheet);
    scene.Mapper->SetFeatureSize(12.0);
    scene.Renderer->SetBackground(0.0, 0.0, 0.0);
    scene.LookDown(114.0, 114.0, 200.0);
    return scene.Render();
  };
  const auto behind = alone(back);
  const auto before = alone(front);
  for (const bool peeling : { false, true })
  {
    Scene scene(back);
    scene.Mapper->SetFeatureSize(12.0);
    scene.Renderer->SetBackground(0.0, 0.0, 0.0);
    scene.Actor->GetProperty()->SetOpacity(0.5);
    vtkNew<vtkSteerableNoiseMapper> mapper;
    mapper->SetInputDataObject(front);
    mapper->ScalarVisibilityOff();
    mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::WORLD);
    mapper->SetFeatureSize(12.0);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetOpacity(0.5);
    scene.Renderer->AddActor(actor); // after the one behind it: in order without peeling
    scene.Renderer->SetUseDepthPeeling(peeling);
    scene.Window->SetAlphaBitPlanes(1);
    scene.LookDown(114.0, 114.0, 200.0);
    const auto both = scene.Render();
    // Without peeling VTK weighs layers by depth and opacity: the shares are found by least squares.
    Eigen::MatrixXd layers(both.size(), 2);
    Eigen::VectorXd seen(both.size());
    for (std::size_t i = 0; i < both.size(); ++i)
    {
      layers(i, 0) = before[i];
      layers(i, 1) = behind[i];
      seen(i) = both[i];
    }
    Eigen::Vector2d shares(0.5, 0.25);
    if (!peeling)
    {
      shares = layers.colPivHouseholderQr().solve(seen);
    }
    EXPECT_GT(shares.minCoeff(), 0.2);
    EXPECT_LE((layers * shares - seen).cwiseAbs().maxCoeff(), 3.0)
      << (peeling ? "depth peeling" : "blending");
  }
}

/// Colours come from where a plain surface has them: with intensity 0 the pictures are the same, with more the
/// streaks are in them.
TEST(SteerableNoiseMapper, ColoursAndEdgesAreThoseOfAPlainSurface)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetName("TCoords");
  coordinates->SetNumberOfComponents(2);
  vtkNew<vtkDoubleArray> scalars;
  scalars->SetName("S");
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    coordinates->InsertNextTuple2(i % 20 / 19.0, i / 20 / 19.0);
    scalars->InsertNextValue(i % 3);
  }
  sheet->GetPointData()->SetTCoords(coordinates);
  sheet->GetPointData()->SetScalars(scalars);
  vtkNew<vtkImageData> checks;
  checks->SetDimensions(4, 4, 1);
  checks->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int i = 0; i < 48; ++i)
  {
    static_cast<unsigned char*>(checks->GetScalarPointer())[i] = (i / 3 + i / 12) % 2 ? 250 : 60 * (i % 3);
  }
  vtkNew<vtkTexture> texture;
  texture->SetInputData(checks);
  vtkNew<vtkLookupTable> table;
  table->SetNumberOfTableValues(8);
  table->SetHueRange(0.0, 0.7);
  table->Build();

  using Look = std::function<void(vtkMapper*, vtkActor*)>;
  const std::pair<const char*, Look> looks[] = {
    { "scalars", [&](vtkMapper* mapper, vtkActor*) { mapper->ScalarVisibilityOn(); } },
    { "scalars before mapping",
      [&](vtkMapper* mapper, vtkActor*)
      {
        mapper->ScalarVisibilityOn();
        mapper->InterpolateScalarsBeforeMappingOn();
      } },
    { "texture", [&](vtkMapper*, vtkActor* actor) { actor->SetTexture(texture); } },
    { "edges",
      [&](vtkMapper*, vtkActor* actor)
      {
        actor->GetProperty()->EdgeVisibilityOn();
        actor->GetProperty()->SetEdgeColor(1.0, 0.0, 0.0);
      } },
    { "specular",
      [&](vtkMapper*, vtkActor* actor)
      {
        actor->GetProperty()->SetColor(0.6, 0.5, 0.4);
        actor->GetProperty()->SetSpecular(0.3);
        actor->GetProperty()->SetSpecularPower(3.0);
      } },
  };
  for (const auto& look : looks)
  {
    Messages messages;
    Scene scene(sheet);
    vtkNew<vtkPolyDataMapper> plain;
    plain->SetInputData(sheet);
    plain->ScalarVisibilityOff();
    for (vtkMapper* mapper : { static_cast<vtkMapper*>(plain), static_cast<vtkMapper*>(scene.Mapper) })
    {
      mapper->SetLookupTable(table);
      mapper->SetScalarRange(0.0, 2.0);
      look.second(mapper, scene.Actor);
    }
    scene.LookDown(114.0, 114.0, 200.0);
    scene.Mapper->SetFeatureSize(12.0);
    scene.Actor->SetMapper(plain);
    const auto expected = scene.Render();
    scene.Actor->SetMapper(scene.Mapper);
    scene.Mapper->SetNoiseIntensity(0.0);
    const auto without = scene.Render();
    scene.Mapper->SetNoiseIntensity(0.8);
    const auto with = scene.Render();
    int different = 0;
    int darker = 0;
    int lighter = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
      different += std::abs(expected[i] - without[i]) > 1;
      darker += with[i] + 20 < without[i];
      lighter += with[i] > without[i] + 1;
    }
    EXPECT_EQ(different, 0) << look.first;
    EXPECT_GT(darker, 0.15 * expected.size()) << look.first; // Multiply: streaks darken
    EXPECT_EQ(lighter, 0) << look.first;
    EXPECT_EQ(messages.Get(), "") << look.first;
  }
}

/// A plane to the horizon at 85 degrees: when the camera moves by a tenth of a pixel, its picture changes no more
/// than that of 4 x 4 samples a pixel.
TEST(SteerableNoiseMapper, APlaneAtAGrazingAngleDoesNotAlias)
{
  const auto sheet = MakeSheet({ 0.0, 0.0, 0.0 }, 0.0);
  for (const bool across : { false, true })
  {
    for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
    {
      sheet->GetPointData()->GetVectors()->SetTuple3(i, across, !across, 0.0);
      double place[3];
      sheet->GetPoint(i, place);
      sheet->GetPoints()->SetPoint(i, place[0], place[1], 0.0);
    }
    sheet->GetPoints()->Modified();
    sheet->GetPointData()->GetVectors()->Modified();
    // Noise of the middle of the picture, where the plane is all that is seen, and its change.
    const auto change = [&](int samples)
    {
      Scene scene(sheet, Size * samples);
      scene.Mapper->SetFeatureSizeMode(vtkSteerableNoiseMapper::PIXELS);
      scene.Mapper->SetFeaturePixels(6.0 * samples);
      std::vector<double> last;
      double squares = 0.0;
      for (const double step : { 0.0, 0.1 })
      {
        const double angle = vtkMath::RadiansFromDegrees(85.0);
        vtkCamera* camera = scene.Renderer->GetActiveCamera();
        // 300 away, 30 degrees high: a pixel of the middle is 0.628 units wide.
        const double aside = step * 2.0 * 300.0 * std::tan(vtkMath::RadiansFromDegrees(15.0)) / Size;
        camera->SetFocalPoint(114.0 + aside, 60.0 + aside, 0.0);
        camera->SetPosition(
          114.0 + aside, 60.0 + aside - 300.0 * std::sin(angle), 300.0 * std::cos(angle));
        camera->SetViewUp(0.0, 0.0, 1.0);
        scene.Renderer->ResetCameraClippingRange();
        const auto noise = scene.RenderNoise();
        std::vector<double> now;
        for (int y = 122; y < 134; ++y)
        {
          for (int x = 64; x < 192; ++x)
          {
            double sum = 0.0;
            for (int sample = 0; sample < samples * samples; ++sample)
            {
              sum += noise[static_cast<std::size_t>(y * samples + sample / samples) * Size * samples +
                x * samples + sample % samples];
            }
            now.push_back(sum / (samples * samples));
          }
        }
        for (std::size_t i = 0; i < last.size(); ++i)
        {
          squares += (now[i] - last[i]) * (now[i] - last[i]);
        }
        last = now;
      }
      return std::sqrt(squares / last.size());
    };
    const double supersampled = change(4);
    EXPECT_GT(supersampled, 0.0);
    EXPECT_LE(change(1), 1.05 * supersampled) << (across ? "across" : "along") << " the view";
  }
}
