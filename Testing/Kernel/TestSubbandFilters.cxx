// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandFilters.h"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace steerable;

namespace
{
constexpr double Pi = 3.14159265358979323846;

class EachOrientationCount : public testing::TestWithParam<int>
{
};

// Midpoint rule on [a, b].
template <typename Function>
double Integrate(Function function, double a, double b, int steps = 20000)
{
  double sum = 0.0;
  for (int n = 0; n < steps; ++n)
  {
    sum += function(a + (b - a) * (n + 0.5) / steps);
  }
  return sum * (b - a) / steps;
}
} // namespace

INSTANTIATE_TEST_SUITE_P(Subbands, EachOrientationCount, testing::Values(3, 4, 6, 8));

TEST(SubbandFilters, AngularScaleIsThePapers)
{
  EXPECT_NEAR(std::pow(AngularScale(4), 2), 0.8, 1e-14);
  EXPECT_NEAR(std::pow(AngularScale(6), 2), 0.677249, 5e-7);
  EXPECT_NEAR(std::pow(AngularScale(8), 2), 0.596737, 5e-7);
  for (const int K : { 4, 6, 8 })
  {
    const double factorials = std::exp((K - 1) * std::log(2.0) + std::lgamma(K)) /
      std::sqrt(K * std::exp(std::lgamma(2.0 * K - 1.0)));
    EXPECT_NEAR(AngularScale(K), factorials, 1e-13);
  }
}

TEST_P(EachOrientationCount, AngularFiltersSumToOne)
{
  for (int n = 0; n < 1000; ++n)
  {
    double sum = 0.0;
    for (int i = 0; i < GetParam(); ++i)
    {
      const double theta = 2.0 * Pi * n / 1000;
      const double value = AngularFilter(i, GetParam(), theta);
      EXPECT_GE(value, 0.0);
      EXPECT_NEAR(AngularFilter(i, GetParam(), theta + Pi), value, 1e-14);
      sum += value;
    }
    EXPECT_NEAR(sum, 1.0, 3e-15);
  }
}

TEST(SubbandFilters, RadialFiltersSumToOneWithinThePyramid)
{
  const int J = 5;
  for (int n = 0; n <= 1000; ++n)
  {
    const double y = -(J - 1) * n / 1000.0;
    double sum = 0.0;
    for (int j = 0; j < J; ++j)
    {
      sum += RadialFilter(y + j);
    }
    EXPECT_NEAR(sum, 1.0, 3e-15) << y;
  }
}

TEST(SubbandFilters, ResidualsCompleteThePyramid)
{
  const int J = 3;
  for (int n = 0; n <= 1000; ++n)
  {
    const double y = 3.0 - 9.0 * n / 1000.0;
    double sum = HighResidual(y) + LowResidual(y, J);
    for (int j = 0; j < J; ++j)
    {
      sum += RadialFilter(y + j);
    }
    EXPECT_NEAR(sum, 1.0, 3e-15) << y;
  }
  EXPECT_EQ(HighResidual(1.5), 1.0);
  EXPECT_EQ(LowResidual(-3.5, J), 1.0);
}

TEST(SubbandFilters, RadialFilterIsThePapers)
{
  // H(r) = cos^2(pi/2 log2(2r/pi)) on (pi/4, pi), r in rad per texel.
  for (double r = 0.3; r < 3.6; r += 0.01)
  {
    const double paper =
      r > Pi / 4 && r < Pi ? std::pow(std::cos(Pi / 2 * std::log2(2 * r / Pi)), 2) : 0.0;
    EXPECT_NEAR(RadialFilter(std::log2(r / (Pi / 2))), paper, 1e-14);
  }
}

TEST(SubbandFilters, BandIsAngularTimesRadial)
{
  SubbandParameters p;
  const double k0 = p.CenterFrequency();
  EXPECT_EQ(SubbandFilter(p, 0, 0, 0.0, 0.0), 0.0);
  EXPECT_NEAR(SubbandFilter(p, 0, 0, k0, 0.0), std::pow(AngularScale(8), 2), 1e-14);
  EXPECT_NEAR(SubbandFilter(p, 4, 2, 0.0, k0 / 4), std::pow(AngularScale(8), 2), 1e-14);
  EXPECT_NEAR(SubbandFilter(p, 1, 1, 9.0, 5.0), SubbandFilter(p, 1, 1, -9.0, -5.0), 1e-15);
  EXPECT_EQ(SubbandFilter(p, 0, 2, k0, 0.0), 0.0);
}

TEST(SubbandFilters, RadialOverlapInClosedForm)
{
  EXPECT_NEAR(RadialOverlap(0.0), 0.809651, 5e-7);
  EXPECT_NEAR(RadialOverlap(1.0), 0.064487, 5e-7);
  EXPECT_NEAR(RadialOverlap(-1.0), 0.257948, 5e-7);
  for (double d = -2.25; d <= 2.25; d += 0.125)
  {
    const double quadrature = Integrate([d](double y)
      { return std::exp2(2 * y) * RadialFilter(y) * RadialFilter(y + d); },
      std::max(-1.0, -1.0 - d), std::max(std::max(-1.0, -1.0 - d), std::min(1.0, 1.0 - d)), 100000);
    EXPECT_NEAR(RadialOverlap(d), quadrature, 1e-10) << d;
  }
}

TEST(SubbandFilters, PowerOverlapInClosedForm)
{
  const double norm =
    Integrate([](double y) { return std::exp2(2 * y) * std::pow(RadialFilter(y), 2); }, -1.0, 1.0);
  for (double d = -2.25; d <= 2.25; d += 0.125)
  {
    const double quadrature = Integrate([d](double y)
      { return std::exp2(2 * y) * std::pow(RadialFilter(y) * RadialFilter(y + d), 2); },
      -1.0, 1.0);
    EXPECT_NEAR(PowerOverlap(d), quadrature / norm, 1e-9) << d;
    EXPECT_GE(PowerOverlap(d), 0.0);
  }
}

TEST_P(EachOrientationCount, GramMatricesByQuadrature)
{
  const int K = GetParam(), J = 4;
  const Eigen::MatrixXd angular = AngularGram(K);
  for (int i = 0; i < K; ++i)
  {
    const double quadrature = Integrate([=](double theta)
      { return AngularFilter(0, K, theta) * AngularFilter(i, K, theta); },
      0.0, 2 * Pi, 512);
    EXPECT_NEAR(angular(0, i), quadrature, 1e-13);
    EXPECT_NEAR(angular(i, 0), angular(0, i), 1e-14);
    EXPECT_NEAR(angular(1, (i + 1) % K), angular(0, i), 1e-13) << "circulant";
  }
  const Eigen::MatrixXd radial = RadialGram(J);
  for (int j = 0; j < J; ++j)
  {
    for (int k = 0; k < J; ++k)
    {
      const double quadrature = std::log(2.0) *
        Integrate([=](double y)
          { return std::exp2(2 * y) * RadialFilter(y + j) * RadialFilter(y + k); },
          -J, 1.0, 50000);
      EXPECT_NEAR(radial(j, k), quadrature, 1e-9);
      EXPECT_NEAR(radial(j, k), radial(k, j), 1e-14);
    }
  }
  EXPECT_NEAR(radial(0, 2), 0.0, 1e-15);
}

TEST_P(EachOrientationCount, RingAndBandVariance)
{
  SubbandParameters p;
  p.Orientations = GetParam();
  p.BandCenter = 0.25;
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(p.Orientations, p.Scales);
  weights(0, 0) = 1.0;
  // Of 3: α⁴ = 64/81 and the mean of cos⁸ is 35/128.
  const double band = p.Orientations == 3 ? 0.220386 * (64.0 / 81.0) * (35.0 / 128.0)
    : p.Orientations == 4 ? 0.03182 : p.Orientations == 6 ? 0.01781 : 0.01173;
  EXPECT_NEAR(SubbandVariance(p, weights), band, 0.005 * band);
  for (int j = 0; j < p.Scales; ++j)
  {
    weights.setZero();
    weights.col(j).setOnes();
    EXPECT_NEAR(SubbandVariance(p, weights), 0.220386 * std::pow(4.0, -j), 1e-6);
  }
  weights.setZero();
  weights.col(0).setOnes();
  EXPECT_NEAR(std::sqrt(SubbandVariance(p, weights)), 0.469452, 5e-6);
}

// Squared filters lie outside the span of K rotated copies: the reason for fitting weights.
TEST_P(EachOrientationCount, SquaredFiltersAreNotExactlySteerable)
{
  const int K = GetParam(), samples = 256;
  Eigen::MatrixXd filters(K, samples);
  Eigen::VectorXd midway(samples);
  for (int n = 0; n < samples; ++n)
  {
    const double theta = Pi * n / samples;
    for (int i = 0; i < K; ++i)
    {
      filters(i, n) = AngularFilter(i, K, theta);
    }
    midway(n) = AngularFilter(0, K, theta - Pi / (2 * K));
  }
  const Eigen::VectorXd fit = (filters * filters.transpose()).inverse() * (filters * midway);
  const double error = (filters.transpose() * fit - midway).norm() / midway.norm();
  EXPECT_NEAR(error, K == 3 ? 0.328 : K == 4 ? 0.29 : K == 6 ? 0.16 : 0.09, 0.005);
}

TEST(SubbandFilters, ParametersOutOfRangeThrow)
{
  EXPECT_NO_THROW(SubbandParameters().Validate());
  auto rejects = [](auto change)
  {
    SubbandParameters p;
    change(p);
    EXPECT_THROW(p.Validate(), std::invalid_argument);
  };
  rejects([](SubbandParameters& p) { p.Orientations = 5; });
  rejects([](SubbandParameters& p) { p.Orientations = 0; });
  rejects([](SubbandParameters& p) { p.Scales = 0; });
  rejects([](SubbandParameters& p) { p.Scales = 7; });
  rejects([](SubbandParameters& p) { p.TileSize = 8; });
  rejects([](SubbandParameters& p) { p.TileSize = 4096; });
  rejects([](SubbandParameters& p) { p.BandCenter = 0.0; });
  rejects([](SubbandParameters& p) { p.BandCenter = 0.26; });
  rejects([](SubbandParameters& p) { p.BandCenter = std::numeric_limits<double>::quiet_NaN(); });
  rejects([](SubbandParameters& p) { p.TileSize = 64, p.Scales = 4; });
}
