// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Length over width of steered features, by another quadrature than the one that calibrates it.
#include "Subband/SubbandAnisotropy.h"
#include "SubbandSpectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace steerable
{
namespace
{
/// Least, mean and most over directions and wavelengths that the calibration does not look at.
struct Lengths
{
  double Least = 1e9;
  double Mean = 0.0;
  double Most = 0.0;
};

Lengths MeasureLengths(int orientations, WeightMethod method, double steering)
{
  SubbandWeightParameters parameters;
  parameters.Pyramid.Orientations = orientations;
  parameters.Pyramid.Scales = 6;
  parameters.Pyramid.TileSize = 1024;
  parameters.Method = method;
  const SubbandWeights solver(parameters);
  std::vector<double> weights(static_cast<std::size_t>(parameters.Pyramid.Components()));
  Lengths lengths;
  double logarithms = 0.0;
  constexpr int directions = 7;
  constexpr int wavelengths = 3;
  for (int d = 0; d < directions; ++d)
  {
    const double angle = Pi * (d + 0.3) / directions;
    const Eigen::Vector2d t(std::cos(angle), std::sin(angle));
    const Eigen::Matrix2d along = t * t.transpose();
    for (int n = 0; n < wavelengths; ++n)
    {
      const double wavelength =
        std::exp2(2.0 + (n + 0.2) / wavelengths) / parameters.Pyramid.CenterFrequency();
      const Eigen::Matrix2d metric = wavelength * wavelength *
        (steering * along + (Eigen::Matrix2d::Identity() - along) / steering);
      solver.Compute(metric, weights.data());
      const SpectralMoments moments =
        MeasureSpectrum(parameters.Pyramid, weights.data(), Eigen::Matrix2d::Identity());
      const double length = std::sqrt(moments.Anisotropy());
      lengths.Least = std::min(lengths.Least, length);
      lengths.Most = std::max(lengths.Most, length);
      logarithms += std::log(length) / (directions * wavelengths);
      // Features lie along the field.
      if (steering > 1.5)
      {
        EXPECT_GT(std::abs(moments.LongAxis().dot(t)), 0.97);
      }
    }
  }
  lengths.Mean = std::exp(logarithms);
  return lengths;
}
} // namespace

TEST(SubbandAnisotropy, FeaturesAreAsLongAsWanted)
{
  struct Case
  {
    int Orientations;
    double Wanted;
  };
  for (const WeightMethod method :
    { WeightMethod::LeastSquares, WeightMethod::PowerMatched, WeightMethod::Heuristic })
  {
    for (const Case& test : { Case{ 4, 1.5 }, Case{ 4, 2.0 }, Case{ 4, 2.5 }, Case{ 6, 2.0 },
           Case{ 6, 3.0 }, Case{ 6, 3.5 }, Case{ 8, 1.5 }, Case{ 8, 2.0 }, Case{ 8, 3.0 }, Case{ 8, 4.0 } })
    {
      const SubbandAnisotropy scale(test.Orientations, method);
      const double steering = scale.GetSteering(test.Wanted);
      EXPECT_LE(steering, SubbandAnisotropy::MostSteering);
      EXPECT_NEAR(scale.Measure(steering) / test.Wanted, 1.0, 0.01);
      const Lengths lengths = MeasureLengths(test.Orientations, method, steering);
      EXPECT_NEAR(lengths.Mean / test.Wanted, 1.0, 0.1)
        << "K = " << test.Orientations << ", method " << static_cast<int>(method) << ", wanted "
        << test.Wanted;
    }
  }
  // Without the calibration they are not.
  EXPECT_LT(MeasureLengths(8, WeightMethod::LeastSquares, 4.0).Mean, 3.6);
  EXPECT_LT(MeasureLengths(4, WeightMethod::LeastSquares, 4.0).Mean, 2.7);
  // Single directions and wavelengths spread around the mean.
  const Lengths four = MeasureLengths(
    8, WeightMethod::LeastSquares, SubbandAnisotropy(8, WeightMethod::LeastSquares).GetSteering(4.0));
  std::printf("wanted 4, K = 8: %.2f to %.2f, mean %.2f\n", four.Least, four.Most, four.Mean);
  EXPECT_GT(four.Least, 3.4);
  EXPECT_LT(four.Most, 4.7);
}

TEST(SubbandAnisotropy, OrientationsLimitIt)
{
  const SubbandAnisotropy four(4, WeightMethod::LeastSquares);
  const SubbandAnisotropy six(6, WeightMethod::LeastSquares);
  const SubbandAnisotropy eight(8, WeightMethod::LeastSquares);
  EXPECT_NEAR(four.GetMost(), 2.90, 0.02);
  EXPECT_NEAR(six.GetMost(), 3.65, 0.02);
  EXPECT_NEAR(eight.GetMost(), 4.32, 0.02);
  for (const SubbandAnisotropy* scale : { &four, &six, &eight })
  {
    EXPECT_EQ(scale->GetSteering(8.0), SubbandAnisotropy::MostSteering);
    EXPECT_EQ(scale->GetSteering(1.0), 1.0);
    EXPECT_EQ(scale->GetSteering(0.5), 1.0);
    double before = 1.0;
    for (double wanted = 1.05; wanted < scale->GetMost(); wanted += 0.05)
    {
      EXPECT_GE(scale->GetSteering(wanted), before) << wanted;
      before = scale->GetSteering(wanted);
    }
  }
  // Noise that no metric moves takes what it is given.
  EXPECT_EQ(SubbandAnisotropy(8, WeightMethod::None).GetSteering(6.0), 6.0);
  EXPECT_THROW(SubbandAnisotropy(5, WeightMethod::LeastSquares), std::invalid_argument);
}
} // namespace steerable
