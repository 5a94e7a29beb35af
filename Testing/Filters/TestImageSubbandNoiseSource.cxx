// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// vtkImageSubbandNoiseSource: layout, variance, pieces, bytes, options and bad ones.
#include "FilterTestHelpers.h"

#include "vtkFieldData.h"
#include "vtkImageSubbandNoiseSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

using namespace filtertest;

namespace
{
vtkDataArray* Subbands(vtkImageSubbandNoiseSource* source)
{
  source->Update();
  return source->GetOutput()->GetPointData()->GetScalars();
}
} // namespace

TEST(ImageSubbandNoiseSource, Defaults)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  EXPECT_EQ(source->GetOrientations(), 8);
  EXPECT_EQ(source->GetScales(), 4);
  EXPECT_EQ(source->GetTileSize(), 256);
  EXPECT_EQ(source->GetBandCenter(), 0.125);
  EXPECT_EQ(source->GetSeed(), 0);
  EXPECT_EQ(source->GetOutputType(), vtkImageSubbandNoiseSource::FLOAT);

  auto messages = Listen(source);
  vtkDataArray* array = Subbands(source);
  ASSERT_NE(array, nullptr);
  EXPECT_EQ(messages->Errors + messages->Warnings, 0) << messages->Text;
  EXPECT_STREQ(array->GetName(), "Subbands");
  EXPECT_EQ(array->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(array->GetNumberOfComponents(), 32);
  EXPECT_EQ(array->GetNumberOfTuples(), 256 * 256);
  EXPECT_STREQ(array->GetComponentName(0), "o0s0");
  EXPECT_STREQ(array->GetComponentName(9), "o1s1");
  EXPECT_STREQ(array->GetComponentName(31), "o7s3");
  double bounds[6];
  source->GetOutput()->GetBounds(bounds);
  EXPECT_EQ(bounds[0], 0.0);
  EXPECT_EQ(bounds[1], 255.0 / 256.0);
}

TEST(ImageSubbandNoiseSource, RingsHaveTheKnownVariance)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  source->SetOrientations(6);
  source->SetScales(3);
  source->SetTileSize(128);
  source->SetBandCenter(0.0625);
  source->SetSeed(7);
  vtkDataArray* array = Subbands(source);
  ASSERT_EQ(array->GetNumberOfComponents(), 18);
  for (int scale = 0; scale < 3; ++scale)
  {
    double squares = 0.0;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      double ring = 0.0;
      for (int o = 0; o < 6; ++o)
      {
        ring += array->GetComponent(i, 6 * scale + o);
      }
      squares += ring * ring;
    }
    const double variance = squares / array->GetNumberOfTuples();
    const double expected = 3.52617 * 0.0625 * 0.0625 * std::pow(4.0, -scale);
    EXPECT_NEAR(variance, expected, 0.1 * expected) << scale;
  }
}

TEST(ImageSubbandNoiseSource, BytesHoldTheFloats)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  source->SetOrientations(4);
  source->SetScales(1);
  vtkNew<vtkFloatArray> floats;
  floats->DeepCopy(Subbands(source));
  source->SetOutputType(vtkImageSubbandNoiseSource::UNSIGNED_CHAR);
  vtkDataArray* bytes = Subbands(source);
  ASSERT_EQ(bytes->GetDataType(), VTK_UNSIGNED_CHAR);
  // The memory of the paper: four bands of 256 x 256.
  EXPECT_EQ(bytes->GetNumberOfValues(), 262144);
  vtkDataArray* ranges = source->GetOutput()->GetFieldData()->GetArray("SubbandRanges");
  ASSERT_NE(ranges, nullptr);
  double error = 0.0;
  double power = 0.0;
  for (vtkIdType i = 0; i < bytes->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < 4; ++c)
    {
      const double value = (bytes->GetComponent(i, c) / 127.5 - 1.0) * ranges->GetComponent(c, 0);
      error += std::pow(value - floats->GetComponent(i, c), 2);
      power += std::pow(floats->GetComponent(i, c), 2);
    }
  }
  EXPECT_GE(10.0 * std::log10(power / error), 40.0);
}

TEST(ImageSubbandNoiseSource, SeedsDifferAndRepeat)
{
  std::vector<std::vector<float>> values;
  for (const int seed : { 0, 1, 0, -5 })
  {
    vtkNew<vtkImageSubbandNoiseSource> source;
    source->SetTileSize(64);
    source->SetScales(2);
    source->SetSeed(seed);
    source->Update();
    values.push_back(Values(source->GetOutput(), "Subbands"));
  }
  EXPECT_EQ(values[0], values[2]);
  EXPECT_NE(values[0], values[1]);
  EXPECT_NE(values[0], values[3]);
}

TEST(ImageSubbandNoiseSource, PiecesAreTheWhole)
{
  vtkNew<vtkImageSubbandNoiseSource> whole;
  whole->SetTileSize(64);
  whole->SetScales(2);
  vtkDataArray* all = Subbands(whole);
  vtkNew<vtkImageSubbandNoiseSource> part;
  part->SetTileSize(64);
  part->SetScales(2);
  const int extent[6] = { 10, 29, 40, 63, 0, 0 };
  part->UpdateExtent(extent);
  vtkDataArray* some = part->GetOutput()->GetPointData()->GetScalars();
  ASSERT_EQ(some->GetNumberOfTuples(), 20 * 24);
  for (int y = extent[2]; y <= extent[3]; ++y)
  {
    for (int x = extent[0]; x <= extent[1]; ++x)
    {
      int ijk[3] = { x, y, 0 };
      const vtkIdType point = part->GetOutput()->ComputePointId(ijk);
      ASSERT_EQ(some->GetComponent(point, 5), all->GetComponent(y * 64 + x, 5));
    }
  }
}

TEST(ImageSubbandNoiseSource, ResidualsCompleteTheBandsToWhiteNoise)
{
  for (const int type : { vtkImageSubbandNoiseSource::FLOAT, vtkImageSubbandNoiseSource::UNSIGNED_CHAR })
  {
    vtkNew<vtkImageSubbandNoiseSource> source;
    source->SetTileSize(64);
    source->SetScales(2);
    source->SetOrientations(3);
    source->SetOutputType(type);
    source->ResidualsOn();
    source->Update();
    vtkImageData* image = source->GetOutput();
    vtkDataArray* array = image->GetPointData()->GetScalars();
    ASSERT_EQ(array->GetNumberOfComponents(), 8);
    EXPECT_STREQ(array->GetComponentName(5), "o2s1");
    EXPECT_STREQ(array->GetComponentName(6), "high");
    EXPECT_STREQ(array->GetComponentName(7), "low");
    vtkDataArray* ranges = image->GetFieldData()->GetArray("SubbandRanges");
    // White noise: variance one, and no correlation from texel to texel.
    std::vector<double> sums;
    for (vtkIdType i = 0; i < 64 * 64; ++i)
    {
      double sum = 0.0;
      for (int c = 0; c < 8; ++c)
      {
        const double value = array->GetComponent(i, c);
        sum += ranges ? (value / 127.5 - 1.0) * ranges->GetComponent(c, 0) : value;
      }
      sums.push_back(sum);
    }
    double variance = 0.0;
    double neighbours = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      variance += sums[i] * sums[i] / 4096.0;
      neighbours += sums[i] * sums[i % 64 == 63 ? i - 63 : i + 1] / 4096.0;
    }
    EXPECT_NEAR(variance, 1.0, ranges ? 0.01 : 1e-5);
    EXPECT_NEAR(neighbours, 0.0, ranges ? 0.01 : 1e-5);
  }
}

TEST(ImageSubbandNoiseSource, OrientationsThatAreNotOfferedAreTold)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  auto messages = Listen(source);
  source->SetOrientations(3);
  EXPECT_EQ(source->GetOrientations(), 3);
  EXPECT_EQ(messages->Warnings, 0);
  source->SetOrientations(5);
  EXPECT_EQ(messages->Warnings, 1);
  EXPECT_NE(messages->Text.find("3, 4, 6 or 8, not 5: 4"), std::string::npos) << messages->Text;
}

TEST(ImageSubbandNoiseSource, SettersClamp)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  auto messages = Listen(source); // Orientations that are not offered are told of
  for (const auto& [given, kept] : { std::pair{ -3, 4 }, { 5, 4 }, { 7, 6 }, { 100, 8 } })
  {
    source->SetOrientations(given);
    EXPECT_EQ(source->GetOrientations(), kept);
  }
  source->SetScales(9);
  EXPECT_EQ(source->GetScales(), 6);
  source->SetTileSize(1);
  EXPECT_EQ(source->GetTileSize(), 16);
  source->SetBandCenter(2.0);
  EXPECT_EQ(source->GetBandCenter(), 0.25);
  source->SetOutputType(9);
  EXPECT_EQ(source->GetOutputType(), vtkImageSubbandNoiseSource::UNSIGNED_CHAR);
  std::ostringstream text;
  source->Print(text);
  EXPECT_NE(text.str().find("BandCenter: 0.25"), std::string::npos);
}

TEST(ImageSubbandNoiseSource, TooManyScalesAreAnError)
{
  vtkNew<vtkImageSubbandNoiseSource> source;
  auto messages = Listen(source);
  auto pipeline = Listen(source->GetExecutive());
  source->SetTileSize(32);
  source->SetScales(6);
  source->Update();
  EXPECT_EQ(messages->Errors, 1);
  EXPECT_NE(messages->Text.find("fewer Scales"), std::string::npos) << messages->Text;
}
