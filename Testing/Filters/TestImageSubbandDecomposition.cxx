// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// vtkImageSubbandDecomposition: layout, sums, waves, the filters of the paper's Fig. 8, bad input.
#include "FilterTestHelpers.h"
#include "Subband/SubbandFilters.h"

#include "vtkFieldData.h"
#include "vtkImageSubbandDecomposition.h"
#include "vtkImageSubbandNoiseSource.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <limits>
#include <sstream>

using namespace filtertest;

namespace
{
constexpr double Pi = 3.14159265358979323846;
using Function = std::function<double(int x, int y)>;

/// width x height points with one float array, flat along `axis`.
template <typename ArrayT = vtkDoubleArray>
vtkSmartPointer<vtkImageData> Picture(
  int width, int height, const Function& function, int axis = 2, int components = 1)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(axis == 0 ? 1 : width, axis == 0 ? width : axis == 1 ? 1 : height,
    axis == 2 ? 1 : height);
  image->SetSpacing(0.5, 0.5, 0.5);
  image->SetOrigin(1.0, 2.0, 3.0);
  vtkNew<ArrayT> array;
  array->SetName("picture");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(width) * height);
  array->Fill(0.0);
  for (int n = 0; n < width * height; ++n)
  {
    array->SetComponent(n, components - 1, function(n % width, n / width));
  }
  image->GetPointData()->SetScalars(array);
  return image;
}

using Filter = vtkImageSubbandDecomposition;
using Configure = std::function<void(Filter*)>;

/// Its output, and how many errors and warnings there were.
struct Result
{
  vtkSmartPointer<vtkImageData> Output;
  int Errors;
  int Warnings;
  std::string Text;
};

Result Apply(vtkImageData* image, const Configure& configure)
{
  vtkNew<Filter> filter;
  auto messages = Listen(filter);
  filter->SetInputData(image);
  if (configure)
  {
    configure(filter);
  }
  filter->Update();
  return { filter->GetOutput(), messages->Errors, messages->Warnings, messages->Text };
}

vtkSmartPointer<vtkImageData> Decompose(vtkImageData* image, const Configure& configure = {})
{
  const Result result = Apply(image, configure);
  EXPECT_EQ(result.Errors + result.Warnings, 0) << result.Text;
  return result.Output;
}

std::string Refusal(vtkImageData* image, const Configure& configure = {})
{
  const Result result = Apply(image, configure);
  EXPECT_EQ(result.Errors, 1) << result.Text;
  EXPECT_EQ(result.Output->GetNumberOfPoints(), 0);
  return result.Text;
}
} // namespace

TEST(ImageSubbandDecomposition, DefaultsAndLayout)
{
  vtkNew<Filter> filter;
  EXPECT_EQ(filter->GetOrientations(), 8);
  EXPECT_EQ(filter->GetScales(), 4);
  EXPECT_EQ(filter->GetBandCenter(), 0.25);
  EXPECT_EQ(filter->GetComponent(), 0);

  auto image = Picture(64, 64, [](int x, int y) { return x % 5 + 0.1 * y; });
  auto output = Decompose(image);
  vtkDataArray* bands = output->GetPointData()->GetScalars();
  ASSERT_NE(bands, nullptr);
  EXPECT_STREQ(bands->GetName(), "Subbands");
  EXPECT_EQ(bands->GetDataType(), VTK_FLOAT);
  ASSERT_EQ(bands->GetNumberOfComponents(), 8 * 4 + 8 + 1);
  EXPECT_STREQ(bands->GetComponentName(9), "o1s1");
  EXPECT_STREQ(bands->GetComponentName(33), "o1high");
  EXPECT_STREQ(bands->GetComponentName(40), "low");
  EXPECT_EQ(output->GetPointData()->GetArray("picture"), nullptr);
  EXPECT_EQ(output->GetFieldData()->GetArray("BandCenter")->GetTuple1(0), 0.25);
  double bounds[6], expected[6];
  output->GetBounds(bounds);
  image->GetBounds(expected);
  EXPECT_TRUE(std::equal(bounds, bounds + 6, expected));
  EXPECT_EQ(image->GetPointData()->GetNumberOfArrays(), 1) << "the input is not written";
}

TEST(ImageSubbandDecomposition, ComponentsSumToTheImage)
{
  const Function function = [](int x, int y)
  { return 0.5 + 0.3 * std::sin(0.7 * x) * std::cos(0.2 * x * y) - 0.01 * y; };
  for (const int axis : { 0, 1, 2 })
  {
    for (const auto& [width, height] : { std::pair{ 64, 64 }, { 30, 47 } })
    {
      // The last of two components is the picture; bytes below are taken as they are.
      auto output = Decompose(Picture(width, height, function, axis, 2),
        [](Filter* filter)
        {
          filter->SetComponent(1);
          filter->SetOrientations(6);
          filter->SetScales(2);
          filter->SetBandCenter(0.2);
        });
      vtkDataArray* bands = output->GetPointData()->GetScalars();
      ASSERT_EQ(bands->GetNumberOfComponents(), 6 * 2 + 6 + 1);
      for (vtkIdType n = 0; n < bands->GetNumberOfTuples(); ++n)
      {
        double sum = 0.0;
        for (int c = 0; c < 19; ++c)
        {
          sum += bands->GetComponent(n, c);
        }
        ASSERT_NEAR(sum, function(n % width, n / width), 1e-6) << axis << ": " << n;
      }
    }
  }
  auto bytes = Decompose(Picture<vtkUnsignedCharArray>(
    64, 64, [](int x, int y) { return (37 * x + 101 * y) % 256; }));
  vtkDataArray* bands = bytes->GetPointData()->GetScalars();
  double sum = 0.0;
  for (int c = 0; c < bands->GetNumberOfComponents(); ++c)
  {
    sum += bands->GetComponent(64 * 3 + 5, c);
  }
  EXPECT_NEAR(sum, (37 * 5 + 101 * 3) % 256, 1e-6 * 256);
}

TEST(ImageSubbandDecomposition, AWaveFallsIntoItsBands)
{
  // 8 cycles over 64 pixels, at the centre of scale 1 along the first direction.
  const int N = 64;
  auto output = Decompose(
    Picture(N, N, [](int x, int) { return 3.0 + std::cos(2.0 * Pi * 8.0 * x / N + 0.3); }));
  vtkDataArray* bands = output->GetPointData()->GetScalars();
  for (int c = 0; c < bands->GetNumberOfComponents(); ++c)
  {
    const double gain = c / 8 == 1 ? steerable::AngularFilter(c % 8, 8, 0.0) : 0.0;
    for (int x = 0; x < N; ++x)
    {
      const double wave = std::cos(2.0 * Pi * 8.0 * x / N + 0.3);
      ASSERT_NEAR(bands->GetComponent(5 * N + x, c), c == 40 ? 3.0 : gain * wave, 1e-6) << c;
    }
  }
}

TEST(ImageSubbandDecomposition, BandsOfANoiseTileAreItsOwn)
{
  // White noise is the sum of the source's components: decomposed again, the same bands.
  vtkNew<vtkImageSubbandNoiseSource> source;
  source->SetTileSize(64);
  source->SetScales(2);
  source->SetOrientations(4);
  source->ResidualsOn();
  source->Update();
  vtkDataArray* tile = source->GetOutput()->GetPointData()->GetScalars();
  auto white = Picture(64, 64,
    [&](int x, int y)
    {
      double sum = 0.0;
      for (int c = 0; c < tile->GetNumberOfComponents(); ++c)
      {
        sum += tile->GetComponent(64 * y + x, c);
      }
      return sum;
    });
  auto output = Decompose(white,
    [](Filter* filter)
    {
      filter->SetScales(2);
      filter->SetOrientations(4);
      filter->SetBandCenter(0.125);
    });
  vtkDataArray* bands = output->GetPointData()->GetScalars();
  for (vtkIdType n = 0; n < 64 * 64; ++n)
  {
    double high = 0.0;
    for (int i = 0; i < 4; ++i)
    {
      high += bands->GetComponent(n, 8 + i);
    }
    for (int c = 0; c < 8; ++c)
    {
      ASSERT_NEAR(bands->GetComponent(n, c), tile->GetComponent(n, c), 2e-6);
    }
    ASSERT_NEAR(high, tile->GetComponent(n, 8), 2e-6);
    ASSERT_NEAR(bands->GetComponent(n, 12), tile->GetComponent(n, 9), 2e-6);
  }
}

// Fig. 8 with what the filter returns: a zone plate, its bands weighted, against a Gaussian filter.
TEST(ImageSubbandDecomposition, WeightedBandsFilterTheZonePlate)
{
  constexpr int N = 256;
  const Function zonePlate = [](int x, int y)
  { return 127.5 + 127.5 * std::cos(Pi * (std::pow(x - 128, 2) + std::pow(y - 128, 2)) / N); };
  auto image = Picture(N, N, zonePlate);
  // The Gaussian of J J^T with J = [[2, 0.7], [0, 1]], by its own sum: it is periodic like the image.
  Eigen::Matrix2d jacobian;
  jacobian << 2.0, 0.7, 0.0, 1.0;
  const Eigen::Matrix2d inverse = (jacobian * jacobian.transpose()).inverse();
  constexpr int reach = 12;
  std::vector<double> kernel;
  double total = 0.0;
  for (int y = -reach; y <= reach; ++y)
  {
    for (int x = -reach; x <= reach; ++x)
    {
      const Eigen::Vector2d p(x, y);
      kernel.push_back(std::exp(-0.5 * p.dot(inverse * p)));
      total += kernel.back();
    }
  }
  // Every fifth pixel is enough of a sample.
  std::vector<int> pixels;
  for (int n = 0; n < N * N; n += 5)
  {
    pixels.push_back(n);
  }
  Eigen::VectorXd reference(pixels.size());
  for (std::size_t p = 0; p < pixels.size(); ++p)
  {
    double sum = 0.0;
    std::size_t k = 0;
    for (int y = -reach; y <= reach; ++y)
    {
      for (int x = -reach; x <= reach; ++x, ++k)
      {
        sum += kernel[k] *
          zonePlate((pixels[p] % N + x + N) % N, (pixels[p] / N + y + N) % N);
      }
    }
    reference(p) = sum / total;
  }
  for (const auto& [K, probed] : { std::pair{ 8, 7.34 }, { 4, 11.76 } })
  {
    auto output = Decompose(image,
      [K = K](Filter* filter)
      {
        filter->SetOrientations(K);
        filter->SetScales(5);
      });
    vtkDataArray* bands = output->GetPointData()->GetScalars();
    // The filter at the centre of each band, the high residual as scale -1.
    Eigen::VectorXd weights(bands->GetNumberOfComponents());
    for (int c = 0; c < K * 6; ++c)
    {
      const int scale = c / K == 5 ? -1 : c / K;
      const double angle = Pi * (c % K) / K;
      const Eigen::Vector2d omega =
        0.5 * Pi * std::exp2(-scale) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      weights(c) = std::exp(-0.5 * (jacobian.transpose() * omega).squaredNorm());
    }
    weights(K * 6) = 1.0;
    double error = 0.0;
    double unfiltered = 0.0;
    for (std::size_t p = 0; p < pixels.size(); ++p)
    {
      double sum = 0.0;
      for (int c = 0; c < bands->GetNumberOfComponents(); ++c)
      {
        sum += weights(c) * bands->GetComponent(pixels[p], c);
      }
      error += std::pow(sum - reference(p), 2) / pixels.size();
      unfiltered +=
        std::pow(zonePlate(pixels[p] % N, pixels[p] / N) - reference(p), 2) / pixels.size();
    }
    RecordProperty("ZonePlateK" + std::to_string(K), std::to_string(error));
    EXPECT_NEAR(error, probed, 0.05 * probed) << K;
    EXPECT_NEAR(unfiltered, 7161.8, 0.05 * 7161.8);
  }
}

TEST(ImageSubbandDecomposition, BadImagesAreRefused)
{
  const Function one = [](int, int) { return 1.0; };
  auto image = Picture(32, 32, one);
  EXPECT_NE(Refusal(image, [](Filter* f) { f->SetComponent(1); }).find("has 1 component(s)"),
    std::string::npos);
  EXPECT_NE(Refusal(image, [](Filter* f) { f->SetScales(5); }).find("Lower Scales to 3"),
    std::string::npos);
  EXPECT_NE(
    Refusal(image,
      [](Filter* f)
      { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "nothing"); })
      .find("There is no scalar array"),
    std::string::npos);
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(),
         -std::numeric_limits<double>::infinity() })
  {
    EXPECT_NE(
      Refusal(Picture(32, 32, [=](int x, int y) { return x == y ? bad : 1.0; })).find("32 of 1024"),
      std::string::npos);
  }
  EXPECT_NE(Refusal(Picture(8, 32, one)).find("8 x 32"), std::string::npos);
  EXPECT_NE(Refusal(Picture(32, 2049, one)).find("16 to 2048"), std::string::npos);
  vtkNew<vtkImageData> solid;
  solid->SetDimensions(20, 20, 3);
  solid->AllocateScalars(VTK_FLOAT, 1);
  EXPECT_NE(Refusal(solid).find("not flat"), std::string::npos);
  // One without points passes.
  vtkNew<vtkImageData> empty;
  vtkNew<Filter> filter;
  auto messages = Listen(filter);
  filter->SetInputData(empty);
  filter->Update();
  EXPECT_EQ(messages->Errors + messages->Warnings, 0) << messages->Text;
}

TEST(ImageSubbandDecomposition, SettersClamp)
{
  vtkNew<Filter> filter;
  auto messages = Listen(filter);
  filter->SetOrientations(5);
  EXPECT_EQ(filter->GetOrientations(), 4);
  EXPECT_EQ(messages->Warnings, 1);
  filter->SetScales(9);
  EXPECT_EQ(filter->GetScales(), 6);
  filter->SetBandCenter(2.0);
  EXPECT_EQ(filter->GetBandCenter(), 0.25);
  filter->SetComponent(-1);
  EXPECT_EQ(filter->GetComponent(), 0);
  std::ostringstream text;
  filter->Print(text);
  EXPECT_NE(text.str().find("BandCenter: 0.25"), std::string::npos);
}
