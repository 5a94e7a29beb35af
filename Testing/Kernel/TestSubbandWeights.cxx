// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimdLevels.h"
#include "Subband/SubbandTiles.h"
#include "Subband/SubbandWeights.h"
#include "Subband/SurfaceMetric.h"
#include "SubbandSpectrum.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <unsupported/Eigen/FFT>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

using namespace steerable;

namespace
{
using Weights = std::vector<double>;

SubbandWeightParameters Parameters(WeightMethod method, int orientations = 8, int scales = 4)
{
  SubbandWeightParameters p;
  p.Method = method;
  p.Pyramid.Orientations = orientations;
  p.Pyramid.Scales = scales;
  return p;
}

Weights Gamma(const SubbandWeights& solver, const Eigen::Matrix2d& metric)
{
  Weights weights(solver.GetParameters().Pyramid.Components());
  EXPECT_TRUE(solver.Compute(metric, weights.data()));
  return weights;
}

Weights Beta(const SubbandWeights& solver, const Eigen::Matrix2d& footprint)
{
  Weights weights(solver.GetParameters().Pyramid.Components());
  EXPECT_TRUE(solver.Antialias(footprint, weights.data()));
  return weights;
}

double LargestDifference(const Weights& a, const Weights& b)
{
  double difference = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n)
  {
    difference = std::max(difference, std::abs(a[n] - b[n]));
  }
  return difference;
}

// T of the test set: a stretch by `ratio` in direction m of 16, at one of four sizes. With four
// scales and ratios up to 4 nothing is clamped.
Eigen::Matrix2d TestMapping(const SubbandParameters& pyramid, double ratio, int m, int size)
{
  const double c = std::exp2(1.0 + 0.25 * size) / pyramid.CenterFrequency();
  const Eigen::Vector2d stretch(std::sqrt(ratio), 1.0 / std::sqrt(ratio));
  return c * Rotation(m * Pi / (8 * pyramid.Orientations)) * stretch.asDiagonal() * Rotation(0.9);
}

struct Extremes
{
  double Anisotropy = 0.0, LowestFrequency = 1e30, HighestFrequency = 0.0, VarianceError = 0.0;

  void Add(const SpectralMoments& moments)
  {
    this->Anisotropy = std::max(this->Anisotropy, moments.Anisotropy());
    this->LowestFrequency = std::min(this->LowestFrequency, moments.Frequency);
    this->HighestFrequency = std::max(this->HighestFrequency, moments.Frequency);
    this->VarianceError = std::max(this->VarianceError, std::abs(moments.Variance - 1.0));
  }
};

Extremes MeasureTestSet(
  const SubbandWeightParameters& parameters, const std::vector<double>& ratios)
{
  const SubbandWeights solver(parameters);
  Extremes extremes;
  for (const double ratio : ratios)
  {
    for (int m = 0; m < 8; ++m)
    {
      for (int size = 0; size < 4; ++size)
      {
        const Eigen::Matrix2d mapping = TestMapping(parameters.Pyramid, ratio, m, size);
        const Weights gamma = Gamma(solver, mapping * mapping.transpose());
        extremes.Add(MeasureSpectrum(parameters.Pyramid, gamma.data(), mapping));
      }
    }
  }
  return extremes;
}

std::string Name(WeightMethod method)
{
  const char* names[] = { "LeastSquares", "PowerMatched", "Heuristic", "None" };
  return names[static_cast<int>(method)];
}

// Record a measured figure in the test's XML report, and check it.
void ExpectAtMost(const std::string& name, double value, double limit)
{
  ::testing::Test::RecordProperty(name, std::to_string(value) + " of " + std::to_string(limit));
  EXPECT_LE(value, limit) << name;
}
} // namespace

TEST(SubbandWeights, IsotropyOfTheTestSet)
{
  struct Row
  {
    WeightMethod Method;
    int Orientations;
    double Ratio, Limit;
  };
  for (const Row& row :
    { Row{ WeightMethod::LeastSquares, 4, 2, 1.60 }, Row{ WeightMethod::LeastSquares, 6, 4, 2.2 },
      Row{ WeightMethod::LeastSquares, 8, 2, 1.20 }, Row{ WeightMethod::LeastSquares, 8, 4, 1.65 },
      Row{ WeightMethod::Heuristic, 4, 2, 2.5 }, Row{ WeightMethod::Heuristic, 8, 2, 1.75 },
      Row{ WeightMethod::Heuristic, 8, 4, 2.6 }, Row{ WeightMethod::PowerMatched, 4, 2, 1.40 },
      Row{ WeightMethod::PowerMatched, 8, 2, 1.10 },
      Row{ WeightMethod::PowerMatched, 8, 4, 1.45 } })
  {
    const Extremes found = MeasureTestSet(Parameters(row.Method, row.Orientations), { row.Ratio });
    ExpectAtMost(Name(row.Method) + "K" + std::to_string(row.Orientations) + "a" +
        std::to_string(static_cast<int>(row.Ratio)),
      found.Anisotropy, row.Limit);
  }
}

// The paper's trapezoid, at any wavelength between two scales: a fit without the gain is uneven by 1.25.
TEST(SubbandWeights, WavelengthsBetweenScalesAreEven)
{
  const SubbandWeightParameters parameters = Parameters(WeightMethod::LeastSquares, 8, 5);
  const SubbandWeights solver(parameters);
  double worst = 0.0;
  for (double shift = 0.0; shift < 1.0; shift += 0.125)
  {
    for (double v = 0.1; v < 1.0; v += 0.2)
    {
      for (double u = 0.05; u < 1.0; u += 0.15)
      {
        Eigen::Matrix2d toSurface;
        toSurface << 2.0 - v, 0.5 - u, 0.0, 1.0;
        const Eigen::Matrix2d mapping =
          std::exp2(1.5 + shift) / parameters.Pyramid.CenterFrequency() * toSurface.inverse();
        const Weights gamma = Gamma(solver, mapping * mapping.transpose());
        worst = std::max(
          worst, MeasureSpectrum(parameters.Pyramid, gamma.data(), mapping).Anisotropy());
      }
    }
  }
  ExpectAtMost("BetweenScales", worst, 1.05);
}

TEST(SubbandWeights, WithoutCompensationAnisotropyIsTheSquaredRatio)
{
  for (const double ratio : { 1.0, 2.0, 4.0 })
  {
    SubbandWeightParameters parameters = Parameters(WeightMethod::None);
    parameters.FixedScale = 1.25;
    EXPECT_NEAR(MeasureTestSet(parameters, { ratio }).Anisotropy, ratio * ratio, 1e-9);
  }
}

TEST(SubbandWeights, MeanFrequencyOfTheTestSet)
{
  for (const auto& [method, limit] : { std::pair{ WeightMethod::LeastSquares, 1.25 },
         { WeightMethod::PowerMatched, 1.10 }, { WeightMethod::Heuristic, 1.35 } })
  {
    const Extremes found = MeasureTestSet(Parameters(method), { 1.0, 2.0, 3.0, 4.0 });
    ExpectAtMost("Frequency" + Name(method), found.HighestFrequency / found.LowestFrequency, limit);
    ExpectAtMost("Variance" + Name(method), found.VarianceError, 1e-6);
  }
}

TEST(SubbandWeights, Shear)
{
  const SubbandWeightParameters parameters = Parameters(WeightMethod::LeastSquares);
  Eigen::Matrix2d mapping;
  mapping << 1.0, 1.0, 0.0, 1.0;
  mapping *= 2.0 / parameters.Pyramid.CenterFrequency();
  const Weights gamma = Gamma(SubbandWeights(parameters), mapping * mapping.transpose());
  const SpectralMoments moments = MeasureSpectrum(parameters.Pyramid, gamma.data(), mapping);
  ExpectAtMost("Shear", moments.Anisotropy(), 1.10);
}

TEST(SubbandWeights, FrameOfTheSurfaceDoesNotMatter)
{
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::PowerMatched,
         WeightMethod::Heuristic, WeightMethod::None })
  {
    const SubbandWeights solver(Parameters(method));
    const Eigen::Matrix2d mapping = TestMapping(solver.GetParameters().Pyramid, 3.0, 5, 1);
    const Weights reference = Gamma(solver, mapping * mapping.transpose());
    for (double angle = 0.1; angle < 6.0; angle += 0.7)
    {
      const Eigen::Matrix2d turned = mapping * Rotation(angle);
      EXPECT_LE(LargestDifference(reference, Gamma(solver, turned * turned.transpose())), 1e-10);
    }
  }
}

/// By how much the fit of a ring at the scale c has a weaker mean squared gradient than the ring, as an amplitude: both by
/// quadrature and normal equations of their own.
double GainOfFit(double c, int scales)
{
  constexpr int perOctave = 256;
  const int samples = perOctave * (scales + 1);
  Eigen::MatrixXd profiles(scales, samples);
  Eigen::VectorXd ring(samples), area(samples), slope(samples);
  for (int n = 0; n < samples; ++n)
  {
    const double y = 1.0 - (n + 0.5) / perOctave;
    for (int j = 0; j < scales; ++j)
    {
      profiles(j, n) = RadialFilter(y + j);
    }
    ring(n) = RadialFilter(y + c);
    area(n) = std::exp2(2.0 * y);
    slope(n) = std::exp2(4.0 * y);
  }
  const Eigen::MatrixXd weighted = profiles * area.asDiagonal();
  const Eigen::VectorXd fit =
    profiles.transpose() * (weighted * profiles.transpose()).eval().ldlt().solve(weighted * ring);
  // All of the ring, within the pyramid or not.
  double whole = 0.0;
  for (int n = 0; n < 2 * perOctave; ++n)
  {
    const double y = 1.0 - (n + 0.5) / perOctave;
    whole += std::exp2(4.0 * (y - c)) * std::pow(RadialFilter(y), 2);
  }
  return std::sqrt(whole / fit.cwiseAbs2().dot(slope));
}

// The sums and tables of the implementation against the definition, solved as it stands.
TEST(SubbandWeights, LeastSquaresSolvesTheNormalEquations)
{
  const SubbandWeightParameters parameters = Parameters(WeightMethod::LeastSquares, 6, 3);
  const SubbandParameters& pyramid = parameters.Pyramid;
  const int K = 6, J = 3, directions = 256, perOctave = 64;
  const Eigen::Matrix2d mapping = TestMapping(pyramid, 2.0, 3, 0);
  const Eigen::Matrix2d metric = mapping * mapping.transpose();

  const int samples = directions * perOctave * (J + 1);
  Eigen::MatrixXd bands(K * J, samples);
  Eigen::VectorXd target(samples), area(samples);
  for (int n = 0; n < samples; ++n)
  {
    const double theta = Pi * (n % directions) / directions;
    const double y = 1.0 - (n / directions + 0.5) / perOctave;
    const Eigen::Vector2d e(std::cos(theta), std::sin(theta));
    const Eigen::Vector2d k = e * pyramid.CenterFrequency() * std::exp2(y);
    const double scale = 0.5 * std::log2(e.dot(metric * e)) + std::log2(pyramid.CenterFrequency());
    target(n) = GainOfFit(scale, J) * RadialFilter(0.5 * std::log2(k.dot(metric * k)));
    area(n) = std::exp2(2.0 * y);
    for (int c = 0; c < K * J; ++c)
    {
      bands(c, n) = SubbandFilter(pyramid, c % K, c / K, k[0], k[1]);
    }
  }
  const Eigen::MatrixXd weighted = bands * area.asDiagonal();
  const Eigen::VectorXd solution =
    (weighted * bands.transpose()).eval().ldlt().solve(weighted * target);
  const Eigen::MatrixXd reshaped = Eigen::Map<const Eigen::MatrixXd>(solution.data(), K, J);
  const double scale = 1.0 / std::sqrt(SubbandVariance(pyramid, reshaped));

  const Weights gamma = Gamma(SubbandWeights(parameters), metric);
  for (int c = 0; c < K * J; ++c)
  {
    EXPECT_NEAR(gamma[c], solution(c) * scale, 1e-4 * scale) << c;
  }
}

// The same sum with more directions and the closed form instead of the table.
TEST(SubbandWeights, TablesAreAccurate)
{
  const int K = 8, J = 4, directions = 256;
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::PowerMatched })
  {
    const SubbandWeights solver(Parameters(method));
    const SubbandParameters& pyramid = solver.GetParameters().Pyramid;
    double worst = 0.0;
    for (int m = 0; m < 8; ++m)
    {
      const Eigen::Matrix2d mapping = TestMapping(pyramid, 4.0, m, m % 4);
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(K, J);
      for (int n = 0; n < directions; ++n)
      {
        const double theta = Pi * n / directions;
        const Eigen::Vector2d e(std::cos(theta), std::sin(theta));
        const double c =
          std::log2((mapping.transpose() * e).norm()) + std::log2(pyramid.CenterFrequency());
        const double gain = method == WeightMethod::LeastSquares ? GainOfFit(c, J) : 1.0;
        for (int i = 0; i < K; ++i)
        {
          for (int j = 0; j < J; ++j)
          {
            sum(i, j) += AngularFilter(i, K, theta) *
              (method == WeightMethod::LeastSquares ? gain * std::pow(4.0, -j) * RadialOverlap(c - j)
                                                    : std::sqrt(PowerOverlap(c - j)));
          }
        }
      }
      Eigen::MatrixXd expected = AngularGram(K).inverse() * sum;
      if (method == WeightMethod::LeastSquares)
      {
        expected *= RadialGram(J).inverse();
      }
      expected /= std::sqrt(SubbandVariance(pyramid, expected));
      const Weights gamma = Gamma(solver, mapping * mapping.transpose());
      const Eigen::Map<const Eigen::MatrixXd> found(gamma.data(), K, J);
      worst =
        std::max(worst, (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff());
    }
    ExpectAtMost("Table" + Name(method), worst * 1e6, 20.0);
  }
}

// That sum for pyramids of all sizes, at all SIMD levels.
TEST(SubbandWeights, EveryPyramidAndLevelHasTheSum)
{
  const int directions = 256;
  for (const int K : { 3, 4, 6, 8 })
  {
    for (int J = 1; J <= 6; ++J)
    {
      SubbandWeightParameters parameters = Parameters(WeightMethod::PowerMatched, K, J);
      parameters.Pyramid.TileSize = 512;
      const SubbandWeights solver(parameters);
      const double ratio = std::min(4.0, std::exp2(J - 1.0));
      for (const double angle : { 0.0, 0.3, 1.9 })
      {
        // From the finest scale on.
        const Eigen::Matrix2d mapping = Rotation(angle) *
          Eigen::Vector2d(ratio, 1.0).asDiagonal() / solver.GetParameters().Pyramid.CenterFrequency();
        Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(K, J);
        for (int n = 0; n < directions; ++n)
        {
          const double theta = Pi * n / directions;
          const Eigen::Vector2d e(std::cos(theta), std::sin(theta));
          const double c = std::log2(
            (mapping.transpose() * e).norm() * solver.GetParameters().Pyramid.CenterFrequency());
          for (int i = 0; i < K; ++i)
          {
            for (int j = 0; j < J; ++j)
            {
              sum(i, j) += AngularFilter(i, K, theta) * std::sqrt(PowerOverlap(c - j));
            }
          }
        }
        Eigen::MatrixXd expected = AngularGram(K).inverse() * sum;
        expected /= std::sqrt(SubbandVariance(solver.GetParameters().Pyramid, expected));
        for (const std::int64_t target : steerable::testing::SimdLevels())
        {
          const steerable::testing::SimdLevel level(target);
          const Weights gamma = Gamma(solver, mapping * mapping.transpose());
          const Eigen::Map<const Eigen::MatrixXd> found(gamma.data(), K, J);
          EXPECT_LE((found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), 20e-6)
            << "K " << K << ", J " << J << ", " << hwy::TargetName(target) << ", " << angle;
        }
      }
    }
  }
}

TEST(SubbandWeights, RingOfOneScale)
{
  // An isotropic metric at the centre of a scale needs that scale alone.
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::Heuristic })
  {
    const SubbandWeights solver(Parameters(method));
    const SubbandParameters& pyramid = solver.GetParameters().Pyramid;
    const double lambda = 4.0 / pyramid.CenterFrequency();
    const Weights gamma = Gamma(solver, lambda * lambda * Eigen::Matrix2d::Identity());
    const double expected = 4.0 / (0.469452 * pyramid.BandCenter / 0.25);
    for (int c = 0; c < pyramid.Components(); ++c)
    {
      EXPECT_NEAR(gamma[c], c / 8 == 2 ? expected : 0.0, 1e-4 * expected);
    }
  }
}

TEST(SubbandWeights, OctaveShiftIsExactWithinThePyramid)
{
  // Half the wavelength: weights move one scale finer and halve. Exact as long as the bands of the
  // noise stay clear of the pyramid's ends, which is what solving again for each octave is about.
  const SubbandWeights solver(Parameters(WeightMethod::Heuristic, 8, 5));
  const Eigen::Matrix2d mapping = TestMapping(solver.GetParameters().Pyramid, 2.0, 3, 0) * 2.0;
  const Eigen::Matrix2d metric = mapping * mapping.transpose();
  const Weights base = Gamma(solver, metric), octave = Gamma(solver, metric / 4.0);
  for (int c = 0; c < 32; ++c)
  {
    EXPECT_NEAR(octave[c], 0.5 * base[c + 8], 1e-9);
  }
}

TEST(SubbandWeights, Steering)
{
  for (const auto& [ratio, angleLimit, coherenceLimit] :
    { std::tuple{ 2.0, 0.5, 0.53 }, { 4.0, 2.0, 0.80 } })
  {
    const SubbandWeights solver(Parameters(WeightMethod::LeastSquares));
    const SubbandParameters& pyramid = solver.GetParameters().Pyramid;
    double worstAngle = 0.0, worstCoherence = 1.0;
    for (int n = 0; n < 64; ++n)
    {
      const Eigen::Vector3d t(std::cos(Pi * n / 64), std::sin(Pi * n / 64), 0.0);
      const double wavelength = std::exp2(1.5) / pyramid.CenterFrequency();
      const Eigen::Matrix2d metric = SteeredFeature(wavelength, t, ratio).topLeftCorner<2, 2>();
      const SpectralMoments moments =
        MeasureSpectrum(pyramid, Gamma(solver, metric).data(), Eigen::Matrix2d::Identity());
      const double cosine = std::min(1.0, std::abs(moments.LongAxis().dot(t.head<2>())));
      worstAngle = std::max(worstAngle, std::acos(cosine) * 180.0 / Pi);
      worstCoherence = std::min(worstCoherence, moments.Coherence());
    }
    const std::string name = "Steering" + std::to_string(static_cast<int>(ratio));
    ExpectAtMost(name + "Angle", worstAngle, angleLimit);
    RecordProperty(name + "Coherence", std::to_string(worstCoherence));
    EXPECT_GE(worstCoherence, coherenceLimit);
  }
}

TEST(SubbandWeights, VarianceOnTiles)
{
  for (const int K : { 4, 8 })
  {
    SubbandWeightParameters parameters = Parameters(WeightMethod::LeastSquares, K);
    const SubbandParameters& pyramid = parameters.Pyramid;
    const SubbandTiles tiles = MakeSubbandTiles(pyramid);
    const int components = pyramid.Components(), texels = 256 * 256;
    const Eigen::MatrixXf values =
      Eigen::Map<const Eigen::MatrixXf>(tiles.Values.data(), components, texels);
    const Eigen::MatrixXd covariance = (values * values.transpose()).cast<double>() / texels;
    for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::PowerMatched,
           WeightMethod::Heuristic, WeightMethod::None })
    {
      parameters.Method = method;
      const SubbandWeights solver(parameters);
      double worst = 0.0;
      for (int m = 0; m < 8; ++m)
      {
        for (int size = 0; size < 4; ++size)
        {
          for (const double ratio : { 1.0, 2.0, 4.0 })
          {
            const Eigen::Matrix2d mapping = TestMapping(pyramid, ratio, m, size);
            const Weights gamma = Gamma(solver, mapping * mapping.transpose());
            const Eigen::Map<const Eigen::VectorXd> g(gamma.data(), components);
            worst = std::max(worst, std::abs(g.dot(covariance * g) - 1.0));
          }
        }
      }
      ExpectAtMost("TileVariance" + Name(method) + std::to_string(K), worst, 0.10);
    }
  }
}

TEST(SubbandWeights, ClampKeepsDirectionsAndReportsChange)
{
  const SubbandWeights solver(Parameters(WeightMethod::LeastSquares));
  const double k0 = solver.GetParameters().Pyramid.CenterFrequency();
  const Eigen::Matrix2d axes = Rotation(0.4);
  auto metricOf = [&](double a, double b)
  {
    const Eigen::Vector2d values(a * a / (k0 * k0), b * b / (k0 * k0));
    return Eigen::Matrix2d(axes * values.asDiagonal() * axes.transpose());
  };
  Eigen::Matrix2d metric = metricOf(1.0, 8.0);
  EXPECT_FALSE(solver.ClampMetric(metric));
  metric = metricOf(0.1, 3.0);
  EXPECT_TRUE(solver.ClampMetric(metric));
  EXPECT_LE((metric - metricOf(1.0, 3.0)).norm() * k0 * k0, 1e-12);
  metric = metricOf(2.0, 1000.0);
  EXPECT_TRUE(solver.ClampMetric(metric));
  EXPECT_LE((metric - metricOf(2.0, 8.0)).norm() * k0 * k0, 1e-10);
  metric.setZero();
  EXPECT_TRUE(solver.ClampMetric(metric));
  EXPECT_LE((metric - metricOf(1.0, 1.0)).norm() * k0 * k0, 1e-12);

  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::PowerMatched,
         WeightMethod::Heuristic, WeightMethod::None })
  {
    const SubbandWeights other(Parameters(method));
    for (const double scale : { 0.0, 1e-300, 1e300, 1e308, -1.0 })
    {
      for (const double weight : Gamma(other, scale * metricOf(1.0, 2.0)))
      {
        EXPECT_TRUE(std::isfinite(weight));
      }
    }
    metric.setConstant(std::numeric_limits<double>::quiet_NaN());
    Weights weights(32, 1.0);
    EXPECT_FALSE(other.Compute(metric, weights.data()));
    EXPECT_EQ(weights, Weights(32, 0.0));
    weights.assign(32, 1.0);
    EXPECT_FALSE(other.Antialias(metric, weights.data()));
    EXPECT_EQ(weights, Weights(32, 0.0));
  }
}

TEST(SubbandWeights, DistortionAndRequiredScales)
{
  const double k0 = 32.0;
  Eigen::Matrix2d mapping;
  mapping << 1.0, 1.0, 0.0, 1.0;
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  EXPECT_NEAR(DistortionRatio(mapping * mapping.transpose()), golden * golden, 1e-12);
  EXPECT_TRUE(std::isinf(DistortionRatio(Eigen::Matrix2d::Zero())));
  // Centred between scales, as most surfaces are.
  auto required = [&](double ratio)
  {
    const Eigen::Vector2d values(ratio, 1.0 / ratio);
    return RequiredScales(
      Eigen::Matrix2d(values.asDiagonal()) * std::exp2(2.0 * 0.3) / (k0 * k0), k0);
  };
  EXPECT_EQ(required(1.0), 2);
  EXPECT_EQ(required(2.0), 3);
  EXPECT_EQ(required(4.0), 4);
  EXPECT_EQ(required(8.0), 5);
}

TEST(SubbandWeights, ParametersOutOfRangeThrow)
{
  SubbandWeightParameters parameters;
  EXPECT_NO_THROW(parameters.Validate());
  parameters.FixedScale = 3.5;
  EXPECT_THROW(SubbandWeights solver(parameters), std::invalid_argument);
  parameters.FixedScale = -0.5;
  EXPECT_THROW(parameters.Validate(), std::invalid_argument);
  parameters = SubbandWeightParameters();
  parameters.Pyramid.Orientations = 5;
  EXPECT_THROW(SubbandWeights solver(parameters), std::invalid_argument);
}

TEST(SubbandWeights, AntialiasingKeepsAllOrNothingAtTheEnds)
{
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::Heuristic })
  {
    for (const bool triple : { false, true })
    {
      SubbandWeightParameters parameters = Parameters(method);
      parameters.RadialTriple = triple;
      const SubbandWeights solver(parameters);
      const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
      EXPECT_LE(LargestDifference(Beta(solver, 0.0 * identity), Weights(32, 1.0)), 1e-4);
      EXPECT_LE(LargestDifference(Beta(solver, identity), Weights(32, 0.0)), 1e-3);
      // Footprints of one texel: finer scales fade more.
      const Weights beta = Beta(solver, identity / (256.0 * 256.0));
      for (int j = 0; j < 4; ++j)
      {
        EXPECT_NEAR(beta[8 * j], beta[8 * j + 3], 1e-9);
        const double omega = Pi / 4 * std::pow(2.0, -j);
        EXPECT_NEAR(beta[8 * j], std::exp(-0.5 * omega * omega), 0.08);
        EXPECT_TRUE(j == 0 || beta[8 * j] > beta[8 * (j - 1)]);
      }
      // The high residual of an image fades first.
      Weights high(8);
      EXPECT_TRUE(solver.AntialiasHigh(0.0 * identity, high.data()));
      EXPECT_LE(LargestDifference(high, Weights(8, 1.0)), 1e-4);
      EXPECT_TRUE(solver.AntialiasHigh(identity / (256.0 * 256.0), high.data()));
      EXPECT_LT(high[3], beta[3]);
      EXPECT_GT(high[3], 0.0);
      EXPECT_TRUE(solver.AntialiasHigh(identity, high.data()));
      EXPECT_LE(LargestDifference(high, Weights(8, 0.0)), 1e-3);
      EXPECT_FALSE(solver.AntialiasHigh(
        std::numeric_limits<double>::quiet_NaN() * identity, high.data()));
    }
  }
}

// Directions that are counted from fixed axes hit or miss the thin end of a long footprint.
TEST(SubbandWeights, LongFootprintsFadeAlikeInAllDirections)
{
  const SubbandWeights solver(Parameters(WeightMethod::LeastSquares));
  for (const double length : { 4.0, 16.0, 256.0, 4096.0 })
  {
    std::vector<Eigen::Vector4d> sums;
    for (const double angle : { 0.0, 0.011, 0.3, 1.0, Pi / 2 })
    {
      const Eigen::Matrix2d axes = Rotation(angle);
      const Eigen::Vector2d sizes(length * length, 0.01);
      const Weights beta =
        Beta(solver, axes * sizes.asDiagonal() * axes.transpose() / (256.0 * 256.0));
      sums.push_back(
        Eigen::Map<const Eigen::Matrix<double, 8, 4>>(beta.data()).colwise().sum().transpose());
      EXPECT_LE((sums.back() - sums.front()).cwiseAbs().maxCoeff(), 1e-9) << length << ", " << angle;
    }
  }
}

TEST(SubbandWeights, NothingPassesAFootprintWithoutBounds)
{
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::Heuristic })
  {
    const SubbandWeights solver(Parameters(method));
    for (const double size : { 1e20, 1e160, 1e305 })
    {
      const Eigen::Matrix2d footprint = size * Eigen::Vector2d(1.0, 0.5).asDiagonal();
      EXPECT_LE(LargestDifference(Beta(solver, footprint), Weights(32, 0.0)), 1e-3) << size;
      Weights high(8);
      EXPECT_TRUE(solver.AntialiasHigh(footprint, high.data()));
      EXPECT_LE(LargestDifference(high, Weights(8, 0.0)), 1e-3) << size;
    }
  }
}

TEST(SubbandWeights, HeuristicAntialiasingIsTheFilterAtTheCenters)
{
  SubbandWeightParameters parameters = Parameters(WeightMethod::Heuristic);
  Eigen::Matrix2d jacobian; // texels per pixel
  jacobian << 2.0, 0.7, 0.0, 1.0;
  const Eigen::Matrix2d footprint = jacobian * jacobian.transpose() / (256.0 * 256.0);
  const Weights beta = Beta(SubbandWeights(parameters), footprint);
  Weights high(8);
  SubbandWeights(parameters).AntialiasHigh(footprint, high.data());
  for (int i = 0; i < 8; ++i)
  {
    const double theta = Pi * i / 8;
    const Eigen::Vector2d omega = Pi / 2 * Eigen::Vector2d(std::cos(theta), std::sin(theta));
    EXPECT_NEAR(high[i], std::exp(-0.5 * (jacobian.transpose() * omega).squaredNorm()), 1e-4);
  }
  parameters.RadialTriple = true;
  const Weights triple = Beta(SubbandWeights(parameters), footprint);
  for (int c = 0; c < 32; ++c)
  {
    const double theta = Pi * (c % 8) / 8;
    auto filter = [&](double octaves)
    {
      const double omega = Pi / 4 * std::exp2(octaves - c / 8);
      const Eigen::Vector2d f =
        jacobian.transpose() * Eigen::Vector2d(std::cos(theta), std::sin(theta)) * omega;
      return std::exp(-0.5 * f.squaredNorm());
    };
    EXPECT_NEAR(beta[c], filter(0.0), 1e-4);
    EXPECT_NEAR(triple[c], 0.111 * filter(-0.5) + 0.444 * filter(0.0) + 0.445 * filter(0.5), 1e-3);
  }
}

TEST(SubbandWeights, RadialTripleLowersAliasPower)
{
  // White noise in all bands, seen at a grazing angle of 8:1, K = 8: the share of the power that is
  // left above the pixels' Nyquist frequency, in the mean over directions.
  const int K = 8, J = 5, directions = 128, perOctave = 32;
  double share[2];
  for (const bool triple : { false, true })
  {
    SubbandWeightParameters parameters = Parameters(WeightMethod::Heuristic, K, J);
    parameters.Pyramid.BandCenter = 0.25;
    parameters.RadialTriple = triple;
    const SubbandWeights solver(parameters);
    double above = 0.0, total = 0.0;
    for (int m = 0; m < 8; ++m)
    {
      const Eigen::Vector2d stretch(8.0, 1.0);
      const Eigen::Matrix2d jacobian = Rotation(m * Pi / (8 * K)) * stretch.asDiagonal();
      const Weights beta = Beta(solver, jacobian * jacobian.transpose() / (256.0 * 256.0));
      for (int n = 0; n < directions; ++n)
      {
        const double theta = Pi * n / directions;
        for (int step = 0; step < perOctave * (J + 1); ++step)
        {
          const double y = 1.0 - (step + 0.5) / perOctave, r = Pi / 2 * std::exp2(y);
          double amplitude = 0.0;
          for (int c = 0; c < K * J; ++c)
          {
            const double radial = RadialFilter(y + c / K);
            amplitude += radial > 0.0 ? beta[c] * radial * AngularFilter(c % K, K, theta) : 0.0;
          }
          const Eigen::Vector2d pixel =
            jacobian.transpose() * Eigen::Vector2d(std::cos(theta), std::sin(theta)) * r;
          const double power = amplitude * amplitude * r * r;
          total += power;
          above += pixel.cwiseAbs().maxCoeff() > Pi ? power : 0.0;
        }
      }
    }
    share[triple] = above / total;
    RecordProperty(triple ? "AliasTriple" : "AliasSingle", std::to_string(share[triple]));
  }
  EXPECT_LE(share[0], 0.025);
  EXPECT_LE(share[1], 0.9 * share[0]);
}

// The paper's Fig. 8: a zone plate filtered by weighted bands of the image, against the filter.
TEST(SubbandWeights, FilteredZonePlate)
{
  using Complex = std::complex<double>;
  const int N = 256, J = 5;
  Eigen::Matrix2d jacobian;
  jacobian << 2.0, 0.7, 0.0, 1.0;
  const Eigen::Matrix2d footprint = jacobian * jacobian.transpose();
  auto gaussian = [&](double wx, double wy)
  {
    const Eigen::Vector2d w(wx, wy);
    return std::exp(-0.5 * w.dot(footprint * w));
  };

  std::vector<Complex> image(N * N), line(N), transformed(N);
  Eigen::FFT<double> fft;
  for (int y = 0; y < N; ++y)
  {
    for (int x = 0; x < N; ++x)
    {
      const double squared = std::pow(x - 128.0, 2) + std::pow(y - 128.0, 2);
      line[x] = 127.5 + 127.5 * std::cos(Pi * squared / 256.0);
    }
    fft.fwd(transformed.data(), line.data(), N);
    std::copy(transformed.begin(), transformed.end(), image.begin() + y * N);
  }
  for (int x = 0; x < N; ++x)
  {
    for (int y = 0; y < N; ++y)
    {
      line[y] = image[y * N + x];
    }
    fft.fwd(transformed.data(), line.data(), N);
    for (int y = 0; y < N; ++y)
    {
      image[y * N + x] = transformed[y];
    }
  }

  Eigen::VectorXd reference(N * N), mip(N * N), power(N * N);
  const double widest = std::sqrt(footprint.selfadjointView<Eigen::Lower>().eigenvalues()[1]);
  auto frequency = [&](int bin) { return bin < N / 2 ? bin : bin - N; };
  for (int bin = 0; bin < N * N; ++bin)
  {
    const double wx = 2 * Pi * frequency(bin % N) / N, wy = 2 * Pi * frequency(bin / N) / N;
    reference(bin) = gaussian(wx, wy);
    mip(bin) = std::exp(-0.5 * widest * widest * (wx * wx + wy * wy));
    power(bin) = std::norm(image[bin]) / std::pow(N, 4);
  }
  // Parseval: the mean squared difference of two filtered images.
  auto error = [&](const Eigen::VectorXd& filter)
  { return (power.array() * (filter - reference).array().square()).sum(); };
  EXPECT_NEAR(error(Eigen::VectorXd::Ones(N * N)), 7161.8, 0.02 * 7161.8);
  EXPECT_NEAR(error(mip), 100.2, 2.0);

  for (const auto& [K, leastSquares, heuristic] :
    { std::tuple{ 8, 3.99, 7.34 }, { 4, 7.16, 11.76 } })
  {
    // Rows: the oriented high residual, J scales, the low residual.
    Eigen::MatrixXd filters(K * (J + 1) + 1, N * N);
    for (int bin = 0; bin < N * N; ++bin)
    {
      const int kx = frequency(bin % N), ky = frequency(bin / N);
      // -k may be another bin at the Nyquist frequency; the mean of both keeps images real.
      const double theta = std::atan2(ky, kx);
      const double opposite = std::atan2(ky == -N / 2 ? ky : -ky, kx == -N / 2 ? kx : -kx);
      const double y = kx == 0 && ky == 0 ? -100.0 : std::log2(std::hypot(kx, ky) / (N / 4));
      for (int i = 0; i < K; ++i)
      {
        const double angular = 0.5 * (AngularFilter(i, K, theta) + AngularFilter(i, K, opposite));
        filters(i, bin) = angular * HighResidual(y);
        for (int j = 0; j < J; ++j)
        {
          filters(K * (1 + j) + i, bin) = angular * RadialFilter(y + j);
        }
      }
      filters(K * (J + 1), bin) = LowResidual(y, J);
    }
    const Eigen::VectorXd fit =
      (filters * filters.transpose()).eval().ldlt().solve(filters * reference);
    const double fitted = error(filters.transpose() * fit);

    // The filter at the centre of each band; the high residual counts as scale -1.
    Eigen::VectorXd centers(filters.rows());
    for (int c = 0; c < K * (J + 1); ++c)
    {
      const double r = Pi / 2 * std::exp2(1 - c / K), theta = Pi * (c % K) / K;
      centers(c) = gaussian(r * std::cos(theta), r * std::sin(theta));
    }
    centers(K * (J + 1)) = 1.0;
    // The kernel's own factors are those of the J scales.
    SubbandWeightParameters parameters = Parameters(WeightMethod::Heuristic, K, J);
    parameters.Pyramid.BandCenter = 0.25;
    const Weights beta = Beta(SubbandWeights(parameters), footprint / double(N * N));
    for (int c = 0; c < K * J; ++c)
    {
      EXPECT_NEAR(beta[c], centers(K + c), 1e-4);
      centers(K + c) = beta[c];
    }
    const double probed = error(filters.transpose() * centers);

    const std::string name = "ZonePlateK" + std::to_string(K);
    RecordProperty(name + "LeastSquares", std::to_string(fitted));
    RecordProperty(name + "Heuristic", std::to_string(probed));
    EXPECT_NEAR(fitted, leastSquares, 0.02 * leastSquares);
    EXPECT_NEAR(probed, heuristic, 0.02 * heuristic);

    // And the kernel's least squares factors, which fit the scales on a disk instead of a square.
    parameters.Method = WeightMethod::LeastSquares;
    const Weights factors = Beta(SubbandWeights(parameters), footprint / double(N * N));
    Eigen::VectorXd mixed = fit;
    std::copy(factors.begin(), factors.end(), mixed.data() + K);
    RecordProperty(name + "Kernel", std::to_string(error(filters.transpose() * mixed)));
    EXPECT_NEAR(error(filters.transpose() * mixed), leastSquares, 0.1 * leastSquares);
  }
}

// A sphere mapped by longitude and latitude: real tiles, weights that change from point to point.
TEST(SubbandWeights, LatitudeLongitudeSphere)
{
  SubbandWeightParameters parameters = Parameters(WeightMethod::LeastSquares);
  parameters.Pyramid.TileSize = 512;
  const SubbandTiles tiles = MakeSubbandTiles(parameters.Pyramid);
  const double wavelength = 0.1, step = 0.02 * wavelength;
  // c from 0.03 at the equator to 2.85 at |z| = .99.

  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::None })
  {
    parameters.Method = method;
    parameters.FixedScale = 1.0;
    const SubbandWeights solver(parameters);
    auto noise = [&](const Eigen::Vector3d& point, const std::array<double, 2>& offset)
    {
      const Eigen::Vector3d p = point.normalized();
      const double sine = std::hypot(p[0], p[1]);
      const double uv[2] = { std::atan2(p[1], p[0]) / (2 * Pi) + offset[0],
        std::acos(p[2]) / Pi + offset[1] };
      const Eigen::Vector2d stretch(1.0 / (2 * Pi * sine), 1.0 / Pi);
      const Eigen::Matrix2d metric = (wavelength * stretch).array().square().matrix().asDiagonal();
      const Weights gamma = Gamma(solver, metric);
      const std::vector<float> weights(gamma.begin(), gamma.end());
      float value;
      SumSubbands(tiles, TileLookup::CatmullRom, 1, uv, weights.data(), &value);
      return value;
    };

    const int bands = 8, samples = 1500, offsets = 8;
    double worst = 0.0;
    for (int band = 0; band < bands; ++band)
    {
      Eigen::Matrix2d tensor = Eigen::Matrix2d::Zero();
      double variance = 0.0;
      for (int n = 0; n < samples * offsets; ++n)
      {
        // A lattice of points without pattern: multiples of the golden ratios of the plane.
        const double a = n * 0.7548776662, b = n * 0.5698402910;
        const double z = 0.99 * (band + (b - std::floor(b))) / bands * (n % 2 ? 1.0 : -1.0);
        const double sine = std::sqrt(1.0 - z * z), phi = 2 * Pi * a;
        const Eigen::Vector3d point(sine * std::cos(phi), sine * std::sin(phi), z);
        const Eigen::Vector3d east(-std::sin(phi), std::cos(phi), 0.0);
        const Eigen::Vector3d north = point.cross(east);
        const auto offset = TileOffset(n / samples, 1);
        const Eigen::Vector2d gradient(
          noise(point + step * east, offset) - noise(point - step * east, offset),
          noise(point + step * north, offset) - noise(point - step * north, offset));
        tensor += gradient * gradient.transpose();
        variance += std::pow(noise(point, offset), 2);
      }
      const Eigen::Vector2d values = tensor.selfadjointView<Eigen::Lower>().eigenvalues();
      worst = std::max(worst, values[1] / values[0]);
      if (method == WeightMethod::LeastSquares)
      {
        EXPECT_NEAR(variance / (samples * offsets), 1.0, 0.15) << band;
      }
    }
    RecordProperty("Sphere" + Name(method), std::to_string(worst));
    if (method == WeightMethod::LeastSquares)
    {
      EXPECT_LE(worst, 1.45);
    }
    else
    {
      EXPECT_GE(worst, 3.0) << "the sphere is a test only if it distorts";
    }
  }
}

// Three planar projections, for every normal of a sphere: independent tiles add their spectra.
TEST(SubbandWeights, TriplanarSphere)
{
  for (const WeightMethod method : { WeightMethod::LeastSquares, WeightMethod::None })
  {
    SubbandWeightParameters parameters = Parameters(method);
    parameters.FixedScale = 1.0;
    const SubbandWeights solver(parameters);
    const SubbandParameters& pyramid = parameters.Pyramid;
    const double wavelength = 7.0 / pyramid.CenterFrequency();
    double worst = 0.0, lowest = 1e30, highest = 0.0;
    for (int a = 0; a <= 24; ++a)
    {
      for (int b = 0; b <= 24; ++b)
      {
        const double theta = Pi / 2 * a / 24, phi = Pi / 2 * b / 24;
        const Eigen::Vector3d normal(
          std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        Eigen::Matrix<double, 3, 2> frame;
        frame.col(0) = Eigen::Vector3d(-std::sin(phi), std::cos(phi), 0.0);
        frame.col(1) = normal.cross(frame.col(0));
        const Eigen::Vector3d blend = TriplanarBlend(normal);
        SpectralMoments sum;
        for (int axis = 0; axis < 3; ++axis)
        {
          if (blend[axis] == 0.0)
          {
            continue;
          }
          const TextureGradients gradients = PlanarGradients(normal, axis, 1.0);
          const Eigen::Matrix2d metric = SurfaceMetric(gradients, IsotropicFeature(wavelength));
          const SpectralMoments moments =
            MeasureSpectrum(pyramid, Gamma(solver, metric).data(), gradients.transpose() * frame);
          const double weight = blend[axis] * blend[axis];
          sum.Variance += weight * moments.Variance;
          sum.Frequency += weight * moments.Frequency;
          sum.StructureTensor += weight * moments.StructureTensor;
        }
        EXPECT_NEAR(sum.Variance, 1.0, 1e-6);
        worst = std::max(worst, sum.Anisotropy());
        lowest = std::min(lowest, sum.Frequency);
        highest = std::max(highest, sum.Frequency);
      }
    }
    RecordProperty("Triplanar" + Name(method), std::to_string(worst));
    RecordProperty("TriplanarFrequency" + Name(method), std::to_string(highest / lowest));
    if (method == WeightMethod::LeastSquares)
    {
      EXPECT_LE(worst, 1.35);
      EXPECT_LE(highest / lowest, 1.08 / 0.92);
    }
  }
}
