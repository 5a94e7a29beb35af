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

TEST(SubbandNoiseMapper, WhatIsDrawnUploadsNoVertices)
{
  const auto sheet = MakeSheet(true);
  Scene scene(sheet);
  scene.LookDown(110.0, 110.0, 256.0);
  scene.Render();
  const vtkMTimeType before = scene.Mapper->GetUploadTime();
  EXPECT_GT(before, 0u);
  auto last = scene.RenderNoise();
  const std::pair<const char*, std::function<void(vtkSubbandNoiseMapper*)>> changes[] = {
    { "Phase", [](vtkSubbandNoiseMapper* m) { m->SetPhase(0.3); } },
    { "Time", [](vtkSubbandNoiseMapper* m)
      {
        m->SetTimePeriod(2.0);
        m->SetTime(0.7);
      } },
    { "Octaves", [](vtkSubbandNoiseMapper* m) { m->SetOctaves(2); } },
    { "Persistence", [](vtkSubbandNoiseMapper* m) { m->SetPersistence(0.2); } },
    { "Function", [](vtkSubbandNoiseMapper* m) { m->SetFunction(vtkPolyDataSubbandNoise::TURBULENCE); } },
    { "Seed", [](vtkSubbandNoiseMapper* m) { m->SetSeed(3); } },
    { "AntiAlias", [](vtkSubbandNoiseMapper* m) { m->AntiAliasOff(); } },
  };
  for (const auto& change : changes)
  {
    change.second(scene.Mapper);
    const auto now = scene.RenderNoise();
    EXPECT_EQ(scene.Mapper->GetUploadTime(), before) << change.first;
    double largest = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      largest = std::isnan(now[i]) ? largest : std::max(largest, std::abs(now[i] - last[i]));
    }
    EXPECT_GT(largest, 0.1) << change.first;
    last = now;
  }
  scene.Mapper->SetWavelength(40.0);
  scene.Render();
  EXPECT_GT(scene.Mapper->GetUploadTime(), before);
}

TEST(SubbandNoiseMapper, BytesOfThePaper)
{
  const auto sheet = MakeSheet(true);
  Scene scene(sheet);
  scene.Mapper->SetInterpolation(vtkSubbandNoiseMapper::CUBIC);
  scene.Mapper->SetOrientations(4);
  scene.Render();
  // Four directions of 256 x 256 texels are 262144 bytes at each scale.
  EXPECT_GT(scene.Mapper->GetTileBytes(), 0);
  EXPECT_EQ(scene.Mapper->GetTileBytes() % 262144, 0);
  EXPECT_LE(scene.Mapper->GetTileBytes(), 6 * 262144);
  scene.Mapper->SetInterpolation(vtkSubbandNoiseMapper::LINEAR);
  scene.Render();
  EXPECT_LE(scene.Mapper->GetTileBytes(), 1.6 * 4 * 262144);
  EXPECT_EQ(scene.Mapper->GetWeightBytes() % (16 * sheet->GetNumberOfPoints()), 0);
}

TEST(SubbandNoiseMapper, BandsFadeByTheFootprintOfThePixel)
{
  const auto sheet = MakeSheet(true, { 0.0, 0.0, 0.0 });
  Scene scene(sheet);
  const auto deviation = [&](double wavelength, double unitsHigh, bool fades)
  {
    scene.Mapper->SetWavelength(wavelength);
    scene.Mapper->SetAntiAlias(fades);
    scene.LookDown(110.0, 110.0, unitsHigh);
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    for (const double value : scene.RenderNoise())
    {
      if (!std::isnan(value))
      {
        sum += value;
        squares += value * value;
        ++count;
      }
    }
    return std::sqrt(squares / count - sum * sum / (count * static_cast<double>(count)));
  };
  EXPECT_NEAR(deviation(20.0, 200.0, true), 1.0, 0.2);
  EXPECT_NEAR(deviation(20.0, 2560.0, false), 1.0, 0.2); // two pixels to a wavelength
  EXPECT_LT(deviation(20.0, 2560.0, true), 0.1);
}

TEST(SubbandNoiseMapper, BlocksOfAllKinds)
{
  const auto textured = MakeSheet(true);
  const auto plain = MakeSheet(false, { 3.0, 300.0, 2.0 });
  // The points of the first one, with other cells.
  vtkNew<vtkPolyData> shared;
  shared->ShallowCopy(textured);
  shared->GetPointData()->SetTCoords(nullptr);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, textured);
  blocks->SetBlock(1, plain);
  blocks->SetBlock(2, shared);
  blocks->SetBlock(3, vtkNew<vtkPolyData>());
  Messages messages;
  Scene scene(blocks);
  scene.Mapper->SetWavelength(30.0);
  scene.Actor->GetProperty()->EdgeVisibilityOn(); // has a geometry shader
  scene.LookDown(110.0, 260.0, 600.0);
  int count = 0;
  for (const double value : scene.RenderNoise())
  {
    count += std::abs(value) > 0.2;
  }
  EXPECT_GT(count, 10000);
  EXPECT_EQ(messages.Get(), "");
}

TEST(SubbandNoiseMapper, BadInputIsToldOnceAndShowsItsOwnColours)
{
  const auto sheet = MakeSheet(false);
  Messages messages;
  Scene scene(sheet);
  scene.LookDown(110.0, 110.0, 256.0);
  scene.Mapper->SetParameterization(vtkPolyDataSubbandNoise::TEXTURE_COORDINATES);
  scene.Mapper->SetNoiseContrast(5.0);
  const auto own = scene.Render();
  scene.Render();
  const std::string text = messages.Get();
  EXPECT_NE(text.find("There are no texture coordinates"), std::string::npos) << text;
  EXPECT_NE(text.find("shows its own colours"), std::string::npos) << text;
  EXPECT_EQ(text.find("There are no", text.find("There are no") + 1), std::string::npos) << text;
  scene.Mapper->SetParameterization(vtkPolyDataSubbandNoise::AUTOMATIC);
  EXPECT_NE(scene.Render(), own);
  scene.Mapper->SetNoiseIntensity(0.0);
  EXPECT_EQ(scene.Render(), own);
  EXPECT_EQ(messages.Get(), text);

  // Points that are not finite, and cells without area.
  sheet->GetPoints()->SetPoint(7, std::nan(""), 0.0, 0.0);
  sheet->GetPoints()->SetPoint(8, 3.0, 1.0, 0.0);
  sheet->GetPoints()->Modified();
  sheet->Modified();
  scene.Mapper->SetNoiseIntensity(1.0);
  scene.Render();
  vtkNew<vtkPolyData> empty;
  scene.Mapper->SetInputDataObject(empty);
  scene.Render();
}

TEST(SubbandNoiseMapper, ColourModesAreThoseOfAllMappers)
{
  const auto sheet = MakeSheet(false);
  Scene scene(sheet);
  scene.LookDown(110.0, 110.0, 256.0);
  scene.Actor->GetProperty()->SetColor(0.7, 0.3, 0.2);
  std::vector<std::vector<unsigned char>> pictures;
  for (int mode = vtkSurfaceNoiseMapper::MULTIPLY; mode <= vtkSurfaceNoiseMapper::OPACITY; ++mode)
  {
    scene.Mapper->SetNoiseColorMode(mode);
    EXPECT_EQ(scene.Mapper->HasTranslucentPolygonalGeometry(), mode == vtkSurfaceNoiseMapper::OPACITY);
    pictures.push_back(scene.Render());
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
    {
      EXPECT_NE(pictures[i], pictures.back());
    }
  }
}

TEST(SubbandNoiseMapper, CopiesHaveAllOptions)
{
  vtkNew<vtkSubbandNoiseMapper> mapper;
  mapper->SetWavelength(3.0);
  mapper->SetOrientations(4);
  mapper->SetPhase(0.25);
  mapper->SetOctaves(3);
  mapper->SetInterpolation(vtkSubbandNoiseMapper::CUBIC);
  mapper->SetNoiseContrast(2.0);
  vtkNew<vtkSubbandNoiseMapper> copy;
  copy->ShallowCopy(mapper);
  EXPECT_EQ(copy->GetWavelength(), 3.0);
  EXPECT_EQ(copy->GetOrientations(), 4);
  EXPECT_EQ(copy->GetPhase(), 0.25);
  EXPECT_EQ(copy->GetOctaves(), 3);
  EXPECT_EQ(copy->GetInterpolation(), vtkSubbandNoiseMapper::CUBIC);
  EXPECT_EQ(copy->GetNoiseContrast(), 2.0);
}
