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
#include "vtkPolyDataMapper.h"
#include "vtkTriangle.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkCellData.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>
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
  if (!sheet->GetPointData()->GetTCoords())
  {
    filter->SetOrientations(FindOrientations(sheet, filter));
  }
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

struct NamedSetting
{
  const char* Name;
  Setting Set;
  bool OnPlanes = false; ///< Compared on planar projections too: their programs take seconds to compile.
};

const NamedSetting Settings[] = {
  { "defaults", [](vtkPolyDataSubbandNoise*) {}, true },
  { "steered", [](vtkPolyDataSubbandNoise* f)
    { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V"); }, true },
  { "Anisotropy 2", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V");
      f->SetAnisotropy(2.0);
    } },
  { "K 4", [](vtkPolyDataSubbandNoise* f) { f->SetOrientations(4); }, true },
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
      f->SetOrientations(4);
    }, true },
  { "Turbulence", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetOctaves(2);
      f->SetFunction(vtkPolyDataSubbandNoise::TURBULENCE);
    } },
  { "Phase", [](vtkPolyDataSubbandNoise* f)
    {
      f->SetPhase(0.3);
      f->SetOrientations(3);
    }, true },
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
    for (const NamedSetting& setting : Settings)
    {
      if (texture || setting.OnPlanes)
      {
        const Difference exact = Compare(sheet, setting.Set, vtkSubbandNoiseMapper::CUBIC, true);
        EXPECT_GT(exact.Count, 380) << setting.Name << texture;
        EXPECT_LE(exact.Largest, 1e-3) << setting.Name << texture;
      }
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
      EXPECT_LE(Compare(sheet, set, vtkSubbandNoiseMapper::LINEAR, true).Rms, 0.04) << k << texture;
      EXPECT_LE(Compare(sheet, set, vtkSubbandNoiseMapper::LINEAR, false).Rms, 0.045) << k << texture;
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

TEST(SubbandNoiseMapper, PhaseUploadsNothingOnceItMoves)
{
  Messages messages;
  const auto sheet = MakeSheet(false);
  for (const bool floats : { false, true })
  {
    Scene scene(sheet);
    scene.Mapper->SetOrientations(4);
    scene.Mapper->SetWavelength(30.0);
    scene.Mapper->SetFloatTiles(floats);
    scene.Mapper->SetTileSize(128);
    scene.LookDown(110.0, 110.0, 256.0);
    scene.Render();
    const vtkIdType still = scene.Mapper->GetTileBytes();
    scene.Mapper->SetPhase(0.1);
    scene.Render();
    const vtkMTimeType vertices = scene.Mapper->GetUploadTime();
    const vtkMTimeType tiles = scene.Mapper->GetTileUploadTime();
    EXPECT_EQ(scene.Mapper->GetTileBytes(), 5 * still);
    for (const double phase : { 0.37, 0.8, 0.0 })
    {
      // The graphics card's blend is that of a mapper which uploads it.
      scene.Mapper->SetPhase(phase);
      const auto moved = scene.RenderNoise();
      EXPECT_EQ(scene.Mapper->GetTileUploadTime(), tiles) << phase;
      EXPECT_EQ(scene.Mapper->GetUploadTime(), vertices) << phase;
      Scene other(sheet);
      other.Mapper->ShallowCopy(scene.Mapper);
      other.Mapper->SetInputDataObject(sheet);
      other.LookDown(110.0, 110.0, 256.0);
      const auto expected = other.RenderNoise();
      double squares = 0.0;
      int count = 0;
      for (std::size_t i = 0; i < moved.size(); ++i)
      {
        ASSERT_EQ(std::isnan(moved[i]), std::isnan(expected[i]));
        squares += std::isnan(moved[i]) ? 0.0 : std::pow(moved[i] - expected[i], 2);
        count += !std::isnan(moved[i]);
      }
      EXPECT_GT(count, 10000);
      EXPECT_LE(std::sqrt(squares / count), floats ? 1e-4 : 0.03) << phase;
    }
  }
  EXPECT_EQ(messages.Get(), "");
}

TEST(SubbandNoiseMapper, BytesOfThePaper)
{
  const auto sheet = MakeSheet(true);
  Scene scene(sheet);
  scene.Mapper->SetInterpolation(vtkSubbandNoiseMapper::CUBIC);
  scene.Mapper->SetOrientations(4);
  scene.Mapper->SetTileSize(256);
  scene.Render();
  // Four directions of 256 x 256 texels are 262144 bytes at each scale.
  EXPECT_GT(scene.Mapper->GetTileBytes(), 0);
  EXPECT_EQ(scene.Mapper->GetTileBytes() % 262144, 0);
  EXPECT_LE(scene.Mapper->GetTileBytes(), 6 * 262144);
  scene.Mapper->SetInterpolation(vtkSubbandNoiseMapper::LINEAR);
  scene.Render();
  EXPECT_LE(scene.Mapper->GetTileBytes(), 1.6 * 262144);
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

  // Waves of 5.9 pixels along x, where the sheet is steep, and 0.8 along y: those along x are left, in which the power
  // is 0.02 by the integral over directions of exp(-k^2), k in radians per pixel, so the deviation 0.14. A filter that
  // knows no direction leaves none.
  scene.Actor->SetScale(1.0, 0.1, 1.0);
  scene.Actor->SetPosition(0.0, 100.0, 0.0);
  const double left = deviation(8.0, 256.0, true);
  EXPECT_GT(left, 0.07);
  EXPECT_LT(left, 0.28);
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

  // The same of blocks, which the filter then has none of.
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, sheet);
  scene.Mapper->SetParameterization(vtkPolyDataSubbandNoise::TEXTURE_COORDINATES);
  scene.Mapper->SetInputDataObject(blocks);
  scene.Render();
  const std::string more = messages.Get().substr(text.size());
  EXPECT_NE(more.find("There are no texture coordinates"), std::string::npos) << more;
  EXPECT_EQ(more.find("Structure"), std::string::npos) << more;
  scene.Mapper->SetParameterization(vtkPolyDataSubbandNoise::AUTOMATIC);
  scene.Mapper->SetInputDataObject(sheet);

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

/**
 * Spot as it is, 5856 triangles whose texture is stretched from 0.007 to 1.7: E |grad n| / E |n| on the surface, which
 * for Gaussian noise is its frequency up to a factor, of the most and of the least stretched tenth of the triangles,
 * measured in pictures from six sides.
 */
TEST(SubbandNoiseMapper, SpotHasOneFrequencyAsItIs)
{
  const std::string path = std::string(STEERABLENOISE_SHARED_DATA) + "/spot.vtp";
  if (!std::ifstream(path))
  {
    GTEST_SKIP() << path << " is not there";
  }
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkPolyData* spot = reader->GetOutput();
  const vtkIdType cells = spot->GetNumberOfCells();
  vtkNew<vtkUnsignedCharArray> numbers;
  numbers->SetNumberOfComponents(3);
  std::vector<double> stretch(static_cast<std::size_t>(cells));
  std::vector<std::array<double, 3>> normals(stretch.size());
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const vtkIdType number = cell + 1;
    numbers->InsertNextTuple3(number >> 16, (number >> 8) & 255, number & 255);
    spot->GetCellPoints(cell, ids);
    double places[3][3];
    double texture[3][2];
    for (int corner = 0; corner < 3; ++corner)
    {
      spot->GetPoint(ids->GetId(corner), places[corner]);
      spot->GetPointData()->GetTCoords()->GetTuple(ids->GetId(corner), texture[corner]);
    }
    vtkTriangle::ComputeNormal(places[0], places[1], places[2], normals[cell].data());
    const double inTexture = (texture[1][0] - texture[0][0]) * (texture[2][1] - texture[0][1]) -
      (texture[2][0] - texture[0][0]) * (texture[1][1] - texture[0][1]);
    stretch[cell] =
      std::sqrt(std::abs(inTexture) / (2.0 * vtkTriangle::TriangleArea(places[0], places[1], places[2])));
  }
  std::vector<vtkIdType> order(stretch.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](vtkIdType a, vtkIdType b) { return stretch[a] < stretch[b]; });
  // Of the triangles the least (1) and the most (2) stretched tenth.
  std::vector<int> tenths(stretch.size(), 0);
  for (std::size_t n = 0; n < order.size() / 10; ++n)
  {
    tenths[order[n]] = 1;
    tenths[order[order.size() - 1 - n]] = 2;
  }

  constexpr int width = 1000;
  vtkNew<vtkPolyData> numbered;
  numbered->ShallowCopy(spot);
  numbered->GetCellData()->SetScalars(numbers);
  vtkNew<vtkPolyDataMapper> plain;
  plain->SetInputData(numbered);
  plain->SetColorModeToDirectScalars();
  plain->SetScalarModeToUseCellData();

  const auto ratio = [&](int method)
  {
    Scene scene(spot, width);
    scene.Mapper->SetWavelength(0.1);
    scene.Mapper->SetMethod(method);
    scene.Actor->GetProperty()->LightingOff();
    vtkNew<vtkActor> identities;
    identities->SetMapper(plain);
    identities->GetProperty()->LightingOff();
    scene.Renderer->AddActor(identities);
    double slopes[3] = { 0.0, 0.0, 0.0 };
    double heights[3] = { 0.0, 0.0, 0.0 };
    const double* center = spot->GetCenter();
    vtkCamera* camera = scene.Renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetParallelScale(1.1);
    for (int side = 0; side < 6; ++side)
    {
      const int axis = side / 2;
      double place[3] = { center[0], center[1], center[2] };
      place[axis] += side % 2 == 0 ? 10.0 : -10.0;
      camera->SetFocalPoint(center[0], center[1], center[2]);
      camera->SetPosition(place);
      camera->SetViewUp(0.0, axis == 1 ? 0.0 : 1.0, axis == 1 ? 1.0 : 0.0);
      scene.Renderer->ResetCameraClippingRange();
      scene.Actor->SetVisibility(false);
      identities->SetVisibility(true);
      const auto triangles = scene.Render();
      scene.Actor->SetVisibility(true);
      identities->SetVisibility(false);
      const auto noise = scene.RenderNoise();
      const auto cellOf = [&](std::size_t pixel)
      { return (triangles[3 * pixel] << 16) + (triangles[3 * pixel + 1] << 8) + triangles[3 * pixel + 2] - 1; };
      const double pixelSize = 2.2 / width;
      double up[3];
      camera->GetViewUp(up);
      const double* forward = camera->GetDirectionOfProjection();
      const double right[3] = { forward[1] * up[2] - forward[2] * up[1], forward[2] * up[0] - forward[0] * up[2],
        forward[0] * up[1] - forward[1] * up[0] };
      const auto dot = [](const double* a, const double* b)
      { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
      for (int y = 0; y + 1 < width; ++y)
      {
        for (int x = 0; x + 1 < width; ++x)
        {
          const std::size_t here = static_cast<std::size_t>(y) * width + x;
          const int cell = cellOf(here);
          if (cell < 0 || cell >= cells || tenths[cell] == 0 || cellOf(here + 1) != cell ||
            cellOf(here + width) != cell || std::isnan(noise[here]) || std::isnan(noise[here + 1]) ||
            std::isnan(noise[here + width]))
          {
            continue;
          }
          const double* n = normals[cell].data();
          const double facing = std::abs(dot(n, forward));
          if (facing < 0.3)
          {
            continue;
          }
          // Of a place on the surface along the view, per step across it: the first fundamental form is 1 + h h^T.
          const double hx = -dot(n, right) / dot(n, forward);
          const double hy = -dot(n, up) / dot(n, forward);
          const double gx = (noise[here + 1] - noise[here]) / pixelSize;
          const double gy = (noise[here + width] - noise[here]) / pixelSize;
          const double gh = gx * hx + gy * hy;
          const double slope =
            std::sqrt(std::max(0.0, gx * gx + gy * gy - gh * gh / (1.0 + hx * hx + hy * hy)));
          slopes[tenths[cell]] += slope / facing;
          heights[tenths[cell]] += std::abs(noise[here]) / facing;
        }
      }
    }
    const double least = slopes[1] / heights[1];
    const double most = slopes[2] / heights[2];
    return std::max(least, most) / std::min(least, most);
  };
  Messages messages;
  const double without = ratio(vtkPolyDataSubbandNoise::NONE);
  const double with = ratio(vtkPolyDataSubbandNoise::LEAST_SQUARES);
  const double matched = ratio(vtkPolyDataSubbandNoise::POWER_MATCHED);
  std::cout << "Frequency ratio on the screen: " << without << " without, " << with << " with least squares, "
            << matched << " with power matched weights\n";
  EXPECT_GT(without, 3.0);
  EXPECT_LE(with, 1.35);
  EXPECT_LE(matched, 1.35);
}
