// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SimdLevels.h"
#include "Subband/SubbandTiles.h"

#include <Eigen/Core>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

using namespace steerable;

namespace
{
constexpr double Pi = 3.14159265358979323846;
using Field = std::vector<std::complex<double>>;

SubbandParameters Pyramid(int orientations, int scales, int size = 256, double center = 0.25)
{
  SubbandParameters p;
  p.Orientations = orientations;
  p.Scales = scales;
  p.TileSize = size;
  p.BandCenter = center;
  p.Seed = 7;
  return p;
}

Field Band(const SubbandParameters& p, int i, int j)
{
  return SynthesizeNoise(p.TileSize, p.Seed, p.Realization,
    [&](int kx, int ky) { return SubbandFilter(p, i, j, kx, ky); });
}

// All orientations of a scale at once, without the angular filters.
Field Ring(const SubbandParameters& p, int j)
{
  return SynthesizeNoise(p.TileSize, p.Seed, p.Realization,
    [&](int kx, int ky)
    {
      return kx == 0 && ky == 0
        ? 0.0
        : RadialFilter(std::log2(std::hypot(kx, ky) / p.CenterFrequency()) + j);
    });
}

double MeanSquare(const Field& field)
{
  double sum = 0.0;
  for (const auto& value : field)
  {
    sum += value.real() * value.real();
  }
  return sum / field.size();
}

// Component c of every texel, or the sum of components [first, last).
Eigen::VectorXd Component(const SubbandTiles& tiles, int first, int last)
{
  const int components = tiles.Parameters.Components();
  Eigen::VectorXd values(tiles.Values.size() / components);
  for (Eigen::Index texel = 0; texel < values.size(); ++texel)
  {
    const float* bands = tiles.Values.data() + texel * components;
    values[texel] = std::accumulate(bands + first, bands + last, 0.0);
  }
  return values;
}

double Correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b)
{
  return a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm());
}
} // namespace

TEST(SubbandTiles, SpectrumIsHermitianWhiteAndUnitModulus)
{
  std::complex<double> sum = 0.0, neighbours = 0.0;
  for (int ky = -40; ky <= 40; ++ky)
  {
    for (int kx = -40; kx <= 40; ++kx)
    {
      const auto value = NoiseSpectrum(kx, ky, 3);
      EXPECT_NEAR(std::abs(value), 1.0, 1e-15);
      EXPECT_NEAR(std::abs(NoiseSpectrum(-kx, -ky, 3) - std::conj(value)), 0.0, 1e-15);
      if (ky > 0)
      {
        sum += value;
        neighbours += value * std::conj(NoiseSpectrum(kx + 1, ky, 3));
      }
    }
  }
  // 3240 independent phases: standard deviation .018.
  EXPECT_LT(std::abs(sum) / 3240, 0.06);
  EXPECT_LT(std::abs(neighbours) / 3240, 0.06);
  EXPECT_NE(NoiseSpectrum(3, 5, 0), NoiseSpectrum(3, 5, 1));
  EXPECT_NE(NoiseSpectrum(3, 5, 0, 0), NoiseSpectrum(3, 5, 0, 1));
}

TEST(SubbandTiles, TransformAgreesWithItsDefinition)
{
  const SubbandParameters p = Pyramid(8, 1, 32);
  const Field band = Band(p, 3, 0);
  for (const auto& [x, y] : { std::pair{ 0, 0 }, { 5, 30 }, { 17, 2 } })
  {
    std::complex<double> sum = 0.0;
    for (int ky = -15; ky <= 15; ++ky)
    {
      for (int kx = -15; kx <= 15; ++kx)
      {
        sum += NoiseSpectrum(kx, ky, p.Seed) * SubbandFilter(p, 3, 0, kx, ky) *
          std::polar(1.0, 2.0 * Pi * (kx * x + ky * y) / 32.0);
      }
    }
    EXPECT_NEAR(std::abs(band[y * 32 + x] - sum / 32.0), 0.0, 1e-12);
  }
}

TEST(SubbandTiles, UnitResponseIsWhiteNoiseOfUnitVariance)
{
  for (const int size : { 64, 63, 96 })
  {
    const Field white = SynthesizeNoise(size, 1, 0, [](int, int) { return 1.0; });
    EXPECT_NEAR(MeanSquare(white), 1.0, 1e-12) << size;
    for (const auto& value : white)
    {
      ASSERT_LE(std::abs(value.imag()), 1e-12);
    }
  }
}

TEST(SubbandTiles, RingVariance)
{
  const SubbandParameters p = Pyramid(4, 4);
  for (int j = 0; j < 4; ++j)
  {
    EXPECT_NEAR(MeanSquare(Ring(p, j)), 0.220386 * std::pow(4.0, -j), 1e-4) << j;
  }
}

TEST(SubbandTiles, BandsAreRealCenteredAndSumToTheRing)
{
  for (const int K : { 4, 6, 8 })
  {
    const SubbandParameters p = Pyramid(K, 1);
    const double variance = K == 4 ? 0.03182 : K == 6 ? 0.01781 : 0.01173;
    Field rest = Ring(p, 0);
    for (int i = 0; i < K; ++i)
    {
      const Field band = Band(p, i, 0);
      double imaginary = 0.0;
      for (std::size_t texel = 0; texel < band.size(); ++texel)
      {
        imaginary = std::max(imaginary, std::abs(band[texel].imag()));
        rest[texel] -= band[texel];
      }
      EXPECT_LE(imaginary, 1e-12);
      const auto sum = std::accumulate(band.begin(), band.end(), std::complex<double>());
      EXPECT_LE(std::abs(sum) / band.size(), 1e-12);
      EXPECT_NEAR(MeanSquare(band), variance, 0.005 * variance) << K << " " << i;
    }
    double difference = 0.0;
    for (const auto& value : rest)
    {
      difference = std::max(difference, std::abs(value));
    }
    EXPECT_LE(difference, 1e-12) << K;
  }
}

TEST(SubbandTiles, EnergyIsConcentratedAroundTheOrientation)
{
  for (const int K : { 4, 6, 8 })
  {
    const SubbandParameters p = Pyramid(K, 1);
    double inside = 0.0, total = 0.0;
    for (int ky = -128; ky < 128; ++ky)
    {
      for (int kx = -128; kx < 128; ++kx)
      {
        const double energy = std::pow(SubbandFilter(p, 1, 0, kx, ky), 2);
        const double angle = std::remainder(std::atan2(ky, kx) - Pi / K, Pi);
        total += energy;
        inside += std::abs(angle) <= Pi / K ? energy : 0.0;
      }
    }
    EXPECT_GE(inside / total, K == 4 ? 0.995 : K == 6 ? 0.98 : 0.96) << K;
  }
}

TEST(SubbandTiles, BandsAndResidualsSumToWhiteNoise)
{
  for (const int K : { 3, 8 })
  {
    const SubbandParameters p = Pyramid(K, 3, 64, 0.125);
    const SubbandTiles tiles = MakeSubbandTiles(p);
    const std::vector<float> residuals = MakeResidualTiles(p);
    const Field white =
      SynthesizeNoise(p.TileSize, p.Seed, p.Realization, [](int, int) { return 1.0; });
    double inside = 0.0;
    double largest = 0.0;
    for (std::size_t texel = 0; texel < white.size(); ++texel)
    {
      const float* bands = tiles.Values.data() + texel * p.Components();
      const double sum = std::accumulate(bands, bands + p.Components(), 0.0);
      inside += sum * sum / white.size();
      largest = std::max(largest,
        std::abs(sum + residuals[2 * texel] + residuals[2 * texel + 1] - white[texel].real()));
    }
    EXPECT_LE(largest, 2e-6) << K;
    EXPECT_NEAR(MeanSquare(white), 1.0, 1e-12);
    std::printf("K = %d: %.1f %% of the power in the bands\n", K, 100.0 * inside);
    EXPECT_LT(inside, 0.12) << "the residuals hold most of it";
  }
}

TEST(SubbandTiles, BandsOfThreeOrientationsAreLookedUp)
{
  // An odd number of components.
  const SubbandParameters p = Pyramid(3, 3, 64, 0.125);
  const SubbandTiles tiles = MakeSubbandTiles(p);
  std::vector<float> bands(9);
  SampleSubbands(tiles, TileLookup::CatmullRom, 5.0 / 64.0, 40.0 / 64.0, bands.data());
  for (int c = 0; c < 9; ++c)
  {
    EXPECT_NEAR(bands[c], tiles.Texel(5, 40)[c], 1e-6) << c;
  }
}

TEST(SubbandTiles, LayoutIsOrientationFastest)
{
  const SubbandParameters p = Pyramid(6, 3, 64, 0.25);
  const SubbandTiles tiles = MakeSubbandTiles(p);
  ASSERT_EQ(tiles.Values.size(), 64u * 64u * 18u);
  const Field band = Band(p, 4, 2);
  for (int y = 0; y < 64; y += 7)
  {
    for (int x = 0; x < 64; x += 5)
    {
      EXPECT_EQ(tiles.Texel(x, y)[2 * 6 + 4], static_cast<float>(band[y * 64 + x].real()));
    }
  }
  SubbandParameters bad = p;
  bad.Orientations = 7;
  EXPECT_THROW(MakeSubbandTiles(bad), std::invalid_argument);
}

TEST(SubbandTiles, SizeOnlyChangesTheSampling)
{
  // The same k0 in half and in twice as many texels: the same noise at the texels they share. The
  // amplitude counts power per bin, so it halves.
  const Field coarse = Ring(Pyramid(4, 1, 64, 0.25), 0);
  const Field fine = Ring(Pyramid(4, 1, 128, 0.125), 0);
  for (int y = 0; y < 64; ++y)
  {
    for (int x = 0; x < 64; ++x)
    {
      EXPECT_NEAR(std::abs(coarse[y * 64 + x] - 2.0 * fine[2 * y * 128 + 2 * x]), 0.0, 1e-12);
    }
  }
}

TEST(SubbandTiles, AScaleHasItsValuesWithAnyNumberOfTexels)
{
  SubbandParameters p = Pyramid(4, 3, 64, 0.125);
  p.Realization = 2;
  const SubbandTiles tiles = MakeSubbandTiles(p);
  for (int j = 0; j < p.Scales; ++j)
  {
    for (const int size : { 32, 64, 128 })
    {
      const std::vector<float> scale = MakeScaleTiles(p, j, size);
      ASSERT_EQ(scale.size(), static_cast<std::size_t>(4 * size * size));
      const int step = size > 64 ? size / 64 : 1;
      const int other = size < 64 ? 64 / size : 1;
      for (int y = 0; y < 32; ++y)
      {
        for (int x = 0; x < 32; ++x)
        {
          for (int i = 0; i < 4; ++i)
          {
            EXPECT_NEAR(scale[4 * (step * y * size + step * x) + i],
              tiles.Texel(other * x, other * y)[4 * j + i], 1e-6);
          }
        }
      }
    }
  }
  EXPECT_THROW(MakeScaleTiles(p, 0, 16), std::invalid_argument);
  EXPECT_THROW(MakeScaleTiles(p, 3, 64), std::invalid_argument);
  EXPECT_THROW(MakeScaleTiles(p, -1, 64), std::invalid_argument);
}

// Texels for bilinear lookups against the noise itself, which four times as many texels have between them.
TEST(SubbandTiles, BilinearTexelsHalveTheErrorOfValues)
{
  const SubbandParameters p = Pyramid(4, 2, 64, 0.125);
  const int finer = 4;
  for (int j = 0; j < p.Scales; ++j)
  {
    const int size = 64 >> j;
    const std::vector<float> wanted = MakeScaleTiles(p, j, finer * size);
    double errors[2] = { 0.0, 0.0 };
    double power = 0.0;
    for (const TexelKind kind : { TexelKind::Values, TexelKind::Bilinear })
    {
      SubbandTiles tiles;
      tiles.Parameters = Pyramid(4, 1, size, 0.125);
      tiles.Values = MakeScaleTiles(p, j, size, kind);
      for (int y = 0; y < finer * size; ++y)
      {
        for (int x = 0; x < finer * size; ++x)
        {
          float bands[4];
          SampleSubbands(tiles, TileLookup::Bilinear, double(x) / (finer * size), double(y) / (finer * size), bands);
          for (int i = 0; i < 4; ++i)
          {
            const double value = wanted[4 * (y * finer * size + x) + i];
            errors[kind == TexelKind::Bilinear] += std::pow(bands[i] - value, 2);
            power += kind == TexelKind::Bilinear ? value * value : 0.0;
          }
        }
      }
    }
    EXPECT_NEAR(std::sqrt(errors[0] / power), 0.068, 0.01);
    EXPECT_LE(std::sqrt(errors[1] / power), 0.04);
  }
}

TEST(SubbandTiles, FourBandsInEightBits)
{
  const SubbandTiles tiles = MakeSubbandTiles(Pyramid(4, 1));
  const QuantizedSubbandTiles quantized = Quantize(tiles);
  EXPECT_EQ(quantized.Values.size(), 262144u);
  double signal = 0.0, noise = 0.0;
  for (std::size_t n = 0; n < tiles.Values.size(); ++n)
  {
    const double value = (quantized.Values[n] / 127.5 - 1.0) * quantized.Range[n % 4];
    signal += tiles.Values[n] * tiles.Values[n];
    noise += std::pow(value - tiles.Values[n], 2);
  }
  const double ratio = 10.0 * std::log10(signal / noise);
  RecordProperty("SNR", std::to_string(ratio));
  EXPECT_GE(ratio, 40.0);
}

TEST(SubbandTiles, LookupsReproduceTexelsAndWrap)
{
  const SubbandTiles tiles = MakeSubbandTiles(Pyramid(6, 1, 64, 0.125));
  float here[48], there[48];
  for (const TileLookup lookup : { TileLookup::Bilinear, TileLookup::CatmullRom })
  {
    for (int n = 0; n < 64; ++n)
    {
      const int x = (n * 37) % 64, y = n;
      SampleSubbands(tiles, lookup, x / 64.0, y / 64.0, here);
      for (int c = 0; c < 6; ++c)
      {
        EXPECT_EQ(here[c], tiles.Texel(x, y)[c]);
      }
      // Coordinates that a double holds exactly on both sides of the seam.
      const double u = n / 64.0 + 13.0 / 4096.0, v = (63 - n) / 64.0 + 51.0 / 4096.0;
      SampleSubbands(tiles, lookup, u, v, here);
      for (const auto& [du, dv] : { std::pair{ 1.0, 0.0 }, { 0.0, -1.0 }, { -7.0, 12.0 } })
      {
        SampleSubbands(tiles, lookup, u + du, v + dv, there);
        for (int c = 0; c < 6; ++c)
        {
          EXPECT_NEAR(here[c], there[c], 1e-12);
        }
      }
    }
    // Continuous across the seam, also where subtracting the repeats rounds up to one.
    SampleSubbands(tiles, lookup, -1e-20, 1.0, here);
    SampleSubbands(tiles, lookup, 0.0, 0.0, there);
    for (int c = 0; c < 6; ++c)
    {
      EXPECT_NEAR(here[c], there[c], 1e-6);
    }
  }
}

TEST(SubbandTiles, LookupAnywhere)
{
  const SubbandTiles tiles = MakeSubbandTiles(Pyramid(4, 1, 16, 0.25));
  float bands[4];
  for (const double huge : { 1e9, -1e17, 1e300 })
  {
    SampleSubbands(tiles, TileLookup::CatmullRom, huge, -huge, bands);
    EXPECT_TRUE(std::isfinite(bands[0])) << huge;
  }
  for (const double bad : { std::nan(""), HUGE_VAL, -HUGE_VAL })
  {
    SampleSubbands(tiles, TileLookup::CatmullRom, 0.5, bad, bands);
    EXPECT_TRUE(std::isnan(bands[0])) << bad;
  }
}

TEST(SubbandTiles, LookupError)
{
  // The same noise sampled four times as finely is the truth between texels.
  const int size = 128, finer = 4;
  // Expected over all phases: the integral of |1 - response of the lookup|^2 over the ring.
  const double expected[3][2] = { { 0.2643, 0.1277 }, { 0.0719, 0.0120 }, { 0.0184, 0.0011 } };
  for (int n = 0; n < 3; ++n)
  {
    const double center = std::ldexp(0.25, -n);
    const SubbandParameters p = Pyramid(4, 1, size, center);
    const SubbandTiles tiles = MakeSubbandTiles(p);
    const Field truth = Ring(Pyramid(4, 1, size * finer, center / finer), 0);
    for (const TileLookup lookup : { TileLookup::Bilinear, TileLookup::CatmullRom })
    {
      double error = 0.0, power = 0.0;
      for (int y = 0; y < size * finer; ++y)
      {
        for (int x = 0; x < size * finer; ++x)
        {
          float bands[4];
          SampleSubbands(tiles, lookup, x / double(size * finer), y / double(size * finer), bands);
          const double value = finer * truth[y * size * finer + x].real();
          error += std::pow(std::accumulate(bands, bands + 4, 0.0) - value, 2);
          power += value * value;
        }
      }
      const bool cubic = lookup == TileLookup::CatmullRom;
      const double relative = std::sqrt(error / power);
      RecordProperty(
        (cubic ? "CatmullRom" : "Bilinear") + std::to_string(4 << n), std::to_string(relative));
      EXPECT_NEAR(relative, expected[n][cubic], 0.0001 + 0.03 * expected[n][cubic]) << n;
    }
  }
}

TEST(SubbandTiles, SumIsTheWeightedSumOfBands)
{
  for (const auto& [K, J] : { std::pair{ 4, 1 }, { 6, 1 }, { 6, 3 }, { 8, 4 } })
  {
    const SubbandTiles tiles = MakeSubbandTiles(Pyramid(K, J, 64, 0.25));
    const int components = K * J, count = 50;
    std::vector<double> uv(2 * count);
    std::vector<float> weights(count * components), noise(count);
    for (std::size_t n = 0; n < uv.size(); ++n)
    {
      uv[n] = 2.0 * std::sin(1.0 + n);
    }
    for (std::size_t n = 0; n < weights.size(); ++n)
    {
      weights[n] = static_cast<float>(std::cos(0.3 + n));
    }
    SumSubbands(tiles, TileLookup::CatmullRom, count, uv.data(), weights.data(), noise.data());
    for (int p = 0; p < count; ++p)
    {
      float bands[48];
      SampleSubbands(tiles, TileLookup::CatmullRom, uv[2 * p], uv[2 * p + 1], bands);
      const double sum =
        std::inner_product(bands, bands + components, weights.data() + p * components, 0.0);
      EXPECT_NEAR(noise[p], sum, 1e-5);
    }
  }
}

// Texels of every number of floats that there is, at all SIMD levels.
TEST(SubbandTiles, EveryNumberOfComponentsIsSummedAtEveryLevel)
{
  const int size = 16;
  for (const int residuals : { 0, 1 })
  {
    for (const int K : { 3, 4, 6, 8 })
    {
      for (int J = 1; J <= 6; ++J)
      {
        SubbandTiles tiles;
        tiles.Parameters.Orientations = K;
        tiles.Parameters.Scales = J;
        tiles.Parameters.TileSize = size;
        tiles.Residuals = residuals * (K + 1);
        const int components = tiles.Components();
        tiles.Values.resize(size * size * components);
        for (std::size_t n = 0; n < tiles.Values.size(); ++n)
        {
          tiles.Values[n] = static_cast<float>(std::sin(1.3 * n));
        }
        const double u = 0.99, v = -0.4;
        const double x = u * size - std::floor(u * size), y = v * size - std::floor(v * size);
        const auto tap = [](int n, double t)
        {
          const double weights[4] = { 0.5 * t * (t * (2.0 - t) - 1.0),
            0.5 * (t * t * (3.0 * t - 5.0) + 2.0), 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0),
            0.5 * t * t * (t - 1.0) };
          return weights[n];
        };
        std::vector<double> expected(components, 0.0);
        std::vector<float> weights(2 * components, 0.0f);
        double sum = 0.0;
        for (int c = 0; c < components; ++c)
        {
          for (int n = 0; n < 16; ++n)
          {
            const int column = static_cast<int>(std::floor(u * size)) - 1 + n % 4;
            const int row = static_cast<int>(std::floor(v * size)) - 1 + n / 4;
            expected[c] += tap(n % 4, x) * tap(n / 4, y) *
              tiles.Texel((column + 2 * size) % size, (row + 2 * size) % size)[c];
          }
          weights[components + c] = 0.5f + 0.01f * static_cast<float>(c);
          sum += weights[components + c] * expected[c];
        }
        for (const std::int64_t target : steerable::testing::SimdLevels())
        {
          const steerable::testing::SimdLevel level(target);
          SCOPED_TRACE(std::to_string(components) + ", " + hwy::TargetName(target));
          std::vector<float> bands(components);
          SampleSubbands(tiles, TileLookup::CatmullRom, u, v, bands.data());
          for (int c = 0; c < components; ++c)
          {
            EXPECT_NEAR(bands[c], expected[c], 1e-6);
          }
          const double uv[4] = { 0.1, 0.2, u, v };
          float noise[2];
          SumSubbands(tiles, TileLookup::CatmullRom, 2, uv, weights.data(), noise);
          EXPECT_EQ(noise[0], 0.0f);
          EXPECT_NEAR(noise[1], sum, 1e-5);
        }
      }
    }
  }
}

TEST(SubbandTiles, BlendKeepsVariance)
{
  SubbandParameters p = Pyramid(4, 1);
  const SubbandTiles a = MakeSubbandTiles(p);
  p.Realization = 1;
  const SubbandTiles b = MakeSubbandTiles(p);
  const double before = Component(a, 0, 4).squaredNorm();
  const double third = Component(a, 0, 4).array().pow(3).mean();
  EXPECT_LT(std::abs(third) / std::pow(before / 65536, 1.5), 0.05) << "tiles are Gaussian";
  for (double t = 0.0; t <= 1.0; t += 0.125)
  {
    const SubbandTiles blend = BlendTiles({ &a, &b }, { 1.0 - t, t });
    EXPECT_NEAR(Component(blend, 0, 4).squaredNorm() / before, 1.0, 0.05) << t;
    for (int c = 0; c < 4; ++c)
    {
      EXPECT_NEAR(
        Component(blend, c, c + 1).squaredNorm() / Component(a, c, c + 1).squaredNorm(), 1.0, 0.05);
    }
  }
  EXPECT_THROW(BlendTiles({}, {}), std::invalid_argument);
  EXPECT_THROW(BlendTiles({ &a, &b }, { 1.0 }), std::invalid_argument);
  EXPECT_THROW(BlendTiles({ &a, &b }, { 0.0, 0.0 }), std::invalid_argument);
  const SubbandTiles other = MakeSubbandTiles(Pyramid(4, 1, 128));
  EXPECT_THROW(BlendTiles({ &a, &other }, { 1.0, 1.0 }), std::invalid_argument);
}

TEST(SubbandTiles, LoopKeepsVarianceAndDoesNotInvert)
{
  SubbandParameters p = Pyramid(4, 1);
  std::vector<SubbandTiles> tiles;
  for (std::uint32_t m = 0; m < 4; ++m)
  {
    p.Realization = m;
    tiles.push_back(MakeSubbandTiles(p));
  }
  auto frame = [&](double phase)
  {
    const auto w = LoopWeights(phase);
    EXPECT_NEAR(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3], 1.0, 1e-14);
    return Component(
      BlendTiles({ &tiles[0], &tiles[1], &tiles[2], &tiles[3] }, { w[0], w[1], w[2], w[3] }), 0, 4);
  };
  const Eigen::VectorXd first = frame(0.0);
  for (double phase = 0.125; phase <= 1.0; phase += 0.125)
  {
    EXPECT_NEAR(frame(phase).squaredNorm() / first.squaredNorm(), 1.0, 0.05) << phase;
  }
  EXPECT_NEAR(Correlation(frame(1.0), first), 1.0, 1e-6);
  EXPECT_NEAR(Correlation(frame(0.5), first), 0.0, 0.05);
}

TEST(SubbandTiles, OctavesNeedAnOffset)
{
  // An octave higher is the same tile looked up twice as often: scale 1 becomes scale 0.
  const SubbandParameters p = Pyramid(4, 2);
  const SubbandTiles tiles = MakeSubbandTiles(p);
  const Eigen::VectorXd octave = Component(tiles, 0, 4), base = Component(tiles, 4, 8);
  EXPECT_NEAR(Correlation(octave, base), 0.159, 0.002);
  for (std::uint32_t index = 1; index < 5; ++index)
  {
    const auto offset = TileOffset(index, p.Seed);
    EXPECT_GE(offset[0], 0.0);
    EXPECT_LT(offset[0], 1.0);
    EXPECT_GE(offset[1], 0.0);
    EXPECT_LT(offset[1], 1.0);
    EXPECT_NE(offset, TileOffset(index - 1, p.Seed));
    Eigen::VectorXd shifted(octave.size());
    for (int y = 0; y < 256; ++y)
    {
      for (int x = 0; x < 256; ++x)
      {
        float bands[8];
        SampleSubbands(
          tiles, TileLookup::Bilinear, x / 256.0 + offset[0], y / 256.0 + offset[1], bands);
        shifted[y * 256 + x] = std::accumulate(bands, bands + 4, 0.0);
      }
    }
    EXPECT_NEAR(Correlation(shifted, base), 0.0, 0.03) << index;
  }
}

namespace
{
/// All components of an image, texel by texel.
std::vector<float> Decompose(
  const std::vector<double>& image, int width, int height, SubbandParameters p)
{
  p.TileSize = std::min(width, height);
  const int components = ImageComponents(p);
  const ImageSpectrum spectrum = TransformImage(image, width, height);
  std::vector<float> values(image.size() * components);
  for (int c = 0; c < components; c += 2)
  {
    WriteImageSubbands(spectrum, p, c, values.data());
  }
  return values;
}
} // namespace

TEST(SubbandTiles, BandsAndResidualsOfAnImageSumToIt)
{
  // Odd and even sides, squares or not; edges that do not match put power at the Nyquist frequency.
  for (const auto& [width, height] : { std::pair{ 64, 64 }, { 48, 33 }, { 21, 50 }, { 17, 17 } })
  {
    for (const int orientations : { 3, 8 })
    {
      std::vector<double> image;
      for (int n = 0; n < width * height; ++n)
      {
        image.push_back(0.4 + 0.01 * (n % width) - 0.5 * (n % 7 == 3) + (n / width % 2 ? 0.2 : 0.0));
      }
      const SubbandParameters p = Pyramid(orientations, 2);
      const auto values = Decompose(image, width, height, p);
      const int components = ImageComponents(p);
      ASSERT_EQ(components, 2 * orientations + orientations + 1);
      for (std::size_t n = 0; n < image.size(); ++n)
      {
        const double sum =
          std::accumulate(&values[n * components], &values[n * components] + components, 0.0);
        ASSERT_NEAR(sum, image[n], 1e-6) << width << " x " << height << ": " << n;
      }
    }
  }
  EXPECT_THROW(TransformImage({ 1.0, 2.0, 3.0 }, 2, 2), std::invalid_argument);
}

TEST(SubbandTiles, AWaveFallsIntoTheBandsOfItsFrequency)
{
  // 72 x 48 pixels: waves of whole periods, each component the wave times the filter there.
  const int width = 72, height = 48;
  const SubbandParameters p = Pyramid(6, 3);
  const int components = ImageComponents(p);
  for (const auto& [kx, ky] :
    { std::pair{ 9, 0 }, { 6, 5 }, { -12, 4 }, { 30, 20 }, { 2, -1 }, { 1, 0 }, { 36, 7 } })
  {
    const double phase = 2 * kx == width ? 0.0 : 0.7; // there a wave has cosines only
    const auto wave = [&, kx = kx, ky = ky](int x, int y)
    { return std::cos(2.0 * Pi * (double(kx) * x / width + double(ky) * y / height) + phase); };
    std::vector<double> image;
    for (int n = 0; n < width * height; ++n)
    {
      image.push_back(wave(n % width, n / width));
    }
    const auto values = Decompose(image, width, height, p);
    // Cycles per pixel, from the formula: D_ij = G_i(theta) h(log2(f / BandCenter) + j).
    const double fx = double(kx) / width, fy = double(ky) / height;
    const double octaves = std::log2(std::hypot(fx, fy) / p.BandCenter);
    double sum = 0.0;
    for (int c = 0; c < components; ++c)
    {
      const int i = c % 6, j = c / 6;
      const double nyquist = 2 * kx == width ? AngularFilter(i, 6, std::atan2(-fy, fx))
                                             : AngularFilter(i, 6, std::atan2(fy, fx));
      const double angular = 0.5 * (AngularFilter(i, 6, std::atan2(fy, fx)) + nyquist);
      const double gain = j < 3 ? angular * RadialFilter(octaves + j)
        : j == 3                ? angular * HighResidual(octaves)
                                : LowResidual(octaves, 3);
      sum += gain;
      for (int n = 0; n < width * height; n += 5)
      {
        ASSERT_NEAR(values[std::size_t(n) * components + c], gain * image[n], 1e-6)
          << kx << " " << ky << ": " << c;
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  }
}
