// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RenderingTestHelpers.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataSubbandNoise.h"
#include "vtkProperty.h"
#include "vtkSmartPointer.h"
#include "vtkSphereSource.h"
#include "vtkSubbandNoiseMapper.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

using namespace renderingtest;

namespace
{
using Scene = SceneOf<vtkSubbandNoiseMapper>;

/// A wavy sheet whose texture is stretched unevenly, with swirling vectors; points 12 units apart.
vtkSmartPointer<vtkPolyData> MakeSheet(bool texture, const std::array<double, 3>& from = { 3.0, -5.0, 2.0 })
{
  constexpr int side = 20;
  auto sheet = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> vectors;
  vectors->SetName("V");
  vectors->SetNumberOfComponents(3);
  vtkNew<vtkFloatArray> coordinates;
  coordinates->SetName("uv");
  coordinates->SetNumberOfComponents(2);
  vtkNew<vtkCellArray> polys;
  for (int j = 0; j < side; ++j)
  {
    for (int i = 0; i < side; ++i)
    {
      const double x = 12.0 * i;
      const double y = 12.0 * j;
      points->InsertNextPoint(from[0] + x, from[1] + y, from[2] + 0.9 * x + 3.0 * std::sin(0.02 * y));
      coordinates->InsertNextTuple2(x / 228.0 + 0.1 * std::sin(0.02 * y), std::pow(y / 228.0, 1.5));
      vectors->InsertNextTuple3(1.0 + std::sin(0.013 * y), std::cos(0.017 * x), 0.5);
      if (i + 1 < side && j + 1 < side)
      {
        const vtkIdType a = i + side * j;
        polys->InsertNextCell({ a, a + 1, a + side + 1, a + side });
      }
    }
  }
  sheet->SetPoints(points);
  sheet->SetPolys(polys);
  sheet->GetPointData()->AddArray(vectors);
  if (texture)
  {
    sheet->GetPointData()->SetTCoords(coordinates);
  }
  return sheet;
}

using Setting = std::function<void(vtkPolyDataSubbandNoise*)>;

/// Fewer, where a graphics card does not pass all weights of the directions that are asked for.
int FindOrientations(vtkPolyData* sheet, vtkPolyDataSubbandNoise* options)
{
  Scene scene(sheet, 8);
  scene.Mapper->SetOptionsFrom(options);
  scene.Render();
  return scene.Mapper->GetOrientationsInUse();
}

struct Difference
{
  double Largest = 0.0;
  double Rms = 0.0;
  int Count = 0;
};

/// Of the picture's noise at the vertices from the filter's.
Difference Compare(vtkPolyData* sheet, const Setting& set, int interpolation, bool floats)
{
  vtkNew<vtkPolyDataSubbandNoise> filter;
  filter->SetInputData(sheet);
  filter->SetWavelength(30.0);
  filter->AntiAliasOff();
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "None");
  set(filter);
  filter->SetOrientations(FindOrientations(sheet, filter));
  filter->Update();
  vtkDataArray* expected =
    vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetPointData()->GetArray("SubbandNoise");

  Scene scene(sheet);
  scene.Mapper->SetOptionsFrom(filter);
  scene.Mapper->SetInterpolation(interpolation);
  scene.Mapper->SetFloatTiles(floats);
  scene.Actor->GetProperty()->SetRepresentationToPoints();
  scene.Actor->GetProperty()->SetPointSize(1.0);
  // Vertices are a whole number of pixels from the centre: now they are in the middle of theirs.
  const double* center = sheet->GetCenter();
  scene.LookDown(center[0] + 0.5, center[1] + 0.5, Size);
  const auto noise = scene.RenderNoise();
  Difference difference;
  for (vtkIdType i = 0; i < sheet->GetNumberOfPoints(); ++i)
  {
    const double value = noise[scene.PixelOf(sheet->GetPoint(i))];
    if (!std::isnan(value))
    {
      const double off = std::abs(value - expected->GetComponent(i, 0));
      difference.Largest = std::max(difference.Largest, off);
      difference.Rms += off * off;
      ++difference.Count;
    }
  }
  difference.Rms = std::sqrt(difference.Rms / std::max(difference.Count, 1));
  return difference;
}

const std::pair<const char*, Setting> Settings[] = {
  { "defaults", [](vtkPolyDataSubbandNoise*) {} },
  { "steered", [](vtkPolyDataSubbandNoise* f)
    { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V"); } },
  { "Anisotropy 2", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V");
      f->SetAnisotropy(2.0);
    } },
  { "K 4", [](vtkPolyDataSubbandNoise* f) { f->SetOrientations(4); } },
  { "K 3", [](vtkPolyDataSubbandNoise* f) { f->SetOrientations(3); } },
  { "K 6", [](vtkPolyDataSubbandNoise* f) { f->SetOrientations(6); } },
  { "Power Matched", [](vtkPolyDataSubbandNoise* f)
    { f->SetMethod(vtkPolyDataSubbandNoise::POWER_MATCHED); } },
  { "None", [](vtkPolyDataSubbandNoise* f) { f->SetMethod(vtkPolyDataSubbandNoise::NONE); } },
  { "Octaves", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetOctaves(3);
      f->SetPersistence(0.6);
      f->SetSeed(9);
    } },
  { "Turbulence", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetOctaves(2);
      f->SetFunction(vtkPolyDataSubbandNoise::TURBULENCE);
    } },
  { "Phase", [](vtkPolyDataSubbandNoise* f) { f->SetPhase(0.3); } },
  { "Seed", [](vtkPolyDataSubbandNoise* f) { f->SetSeed(-77); } },
  { "TileSize 512", [](vtkPolyDataSubbandNoise* f) { f->SetTileSize(512); } },
  { "TileSize 100", [](vtkPolyDataSubbandNoise* f) { f->SetTileSize(100); } },
  { "Wavelength 50", [](vtkPolyDataSubbandNoise* f) { f->SetWavelength(50.0); } },
  { "BlendSeams", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetOrientations(4);
      f->BlendSeamsOn();
    } },
};
} // namespace

TEST(SubbandNoiseMapper, EqualsTheFilterWithEveryOption)
{
  Messages messages; // the filter's, of a mesh that is too coarse for it
  for (const bool texture : { true, false })
  {
    const auto sheet = MakeSheet(texture);
    for (const auto& setting : Settings)
    {
      const Difference exact = Compare(sheet, setting.second, vtkSubbandNoiseMapper::CUBIC, true);
      EXPECT_GT(exact.Count, 380) << setting.first << texture;
      EXPECT_LE(exact.Largest, 1e-3) << setting.first << texture;
    }
  }
}

TEST(SubbandNoiseMapper, BytesAndBilinearLookupsAreClose)
{
  Messages messages;
  for (const bool texture : { true, false })
  {
    const auto sheet = MakeSheet(texture);
    for (const int k : { 4, 6 })
    {
      const Setting set = [=](vtkPolyDataSubbandNoise* filter) { filter->SetOrientations(k); };
      // Bytes round a band by up to 1/64 of its deviation, in which weights may take differences of bands.
      EXPECT_LE(Compare(sheet, set, vtkSubbandNoiseMapper::CUBIC, false).Rms, 0.015) << k << texture;
      EXPECT_LE(Compare(sheet, set, vtkSubbandNoiseMapper::LINEAR, true).Rms, 0.025) << k << texture;
      EXPECT_LE(Compare(sheet, set, vtkSubbandNoiseMapper::LINEAR, false).Rms, 0.03) << k << texture;
    }
  }
}
