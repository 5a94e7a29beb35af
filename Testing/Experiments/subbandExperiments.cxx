// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The experiments of Goldberg, Zwicker and Durand, "Anisotropic Noise" (SIGGRAPH 2008), as numbers:
 * figures 3, 6 and 8 and the memory claim, each beside its limit. Returns 1 if one is missed. Table 10,
 * speed, is in Testing/Benchmarks. The pictures are made by subbandPictures.py.
 */
#include "Subband/SubbandFilters.h"
#include "Subband/SubbandTiles.h"
#include "Subband/SubbandWeights.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <vector>

using namespace steerable;

namespace
{
constexpr double Pi = 3.14159265358979323846;
int Missed = 0;

void Report(const char* what, double measured, double low, double high)
{
  const bool met = measured >= low && measured <= high;
  Missed += !met;
  std::printf("  %-52s %10.4g   [%g, %g]%s\n", what, measured, low, high, met ? "" : "   MISSED");
}

/// Figure 3: the bands of a scale sum to isotropic noise.
void SumOfBands()
{
  std::printf("Figure 3: four bands and their sum\n");
  SubbandParameters parameters;
  parameters.Orientations = 4;
  parameters.Scales = 1;
  const SubbandTiles tiles = MakeSubbandTiles(parameters);
  const auto ring = SynthesizeNoise(parameters.TileSize, 0, 0,
    [&](int kx, int ky)
    {
      const double k = std::hypot(kx, ky);
      return k == 0.0 ? 0.0 : RadialFilter(std::log2(k / parameters.CenterFrequency()));
    });
  double worst = 0.0;
  double power = 0.0;
  const int N = parameters.TileSize;
  for (int y = 0; y < N; ++y)
  {
    for (int x = 0; x < N; ++x)
    {
      const float* bands = tiles.Texel(x, y);
      const double sum = double(bands[0]) + bands[1] + bands[2] + bands[3];
      worst = std::max(worst, std::abs(sum - ring[y * N + x].real()));
      power += sum * sum / (N * N);
    }
  }
  Report("largest difference of the sum from the ring (floats)", worst, 0.0, 1e-6);
  const double expected = 3.52617 * parameters.BandCenter * parameters.BandCenter;
  Report("variance over 3.52617 BandCenter^2", power / expected, 0.98, 1.02);
}

/**
 * Figure 6: the unit square of texture on a trapezoid, 2 wide at the bottom, 1 at the top and 1 high.
 * Ratio of the eigenvalues of the noise's structure tensor on the surface, in five strips.
 */
std::vector<double> TrapezoidAnisotropy(
  WeightMethod method, int orientations, double wavelength = 1.0 / 16.0)
{
  SubbandWeightParameters parameters;
  parameters.Pyramid.Orientations = orientations;
  parameters.Pyramid.TileSize = 512;
  parameters.Method = method;
  parameters.FixedScale = std::log2(wavelength * parameters.Pyramid.CenterFrequency());
  const SubbandWeights solver(parameters);
  const int components = parameters.Pyramid.Components();
  constexpr int strips = 5, samples = 20000;
  std::vector<Eigen::Matrix2d> tensors(strips, Eigen::Matrix2d::Zero());
  for (std::uint32_t seed = 0; seed < 6; ++seed)
  {
    parameters.Pyramid.Seed = seed;
    const SubbandTiles tiles = MakeSubbandTiles(parameters.Pyramid);
    const auto noise = [&](double x, double y)
    {
      const double width = 2.0 - y;
      const double uv[2] = { x / width + 0.5, y };
      // T, the gradients of (u, v) along x and y.
      Eigen::Matrix2d t;
      t << 1.0 / width, x / (width * width), 0.0, 1.0;
      const Eigen::Matrix2d metric = wavelength * wavelength * t * t.transpose();
      double gamma[48];
      solver.Compute(metric, gamma);
      float weights[48];
      std::copy(gamma, gamma + components, weights);
      float value;
      SumSubbands(tiles, TileLookup::CatmullRom, 1, uv, weights, &value);
      return double(value);
    };
    const double step = 0.02 * wavelength;
    for (int n = 0; n < samples; ++n)
    {
      const double a = n * 0.7548776662 - std::floor(n * 0.7548776662);
      const double b = n * 0.5698402910 - std::floor(n * 0.5698402910);
      const int strip = n % strips;
      const double y = (strip + b) / strips;
      const double x = (a - 0.5) * (2.0 - y);
      const Eigen::Vector2d gradient(
        noise(x + step, y) - noise(x - step, y), noise(x, y + step) - noise(x, y - step));
      tensors[strip] += gradient * gradient.transpose();
    }
  }
  std::vector<double> ratios;
  for (const Eigen::Matrix2d& tensor : tensors)
  {
    const Eigen::Vector2d values = tensor.selfadjointView<Eigen::Lower>().eigenvalues();
    ratios.push_back(values[1] / values[0]);
  }
  return ratios;
}

void Trapezoid()
{
  std::printf("Figure 6: anisotropy on a trapezoid, five strips from bottom to top\n");
  const auto print = [](const char* name, const std::vector<double>& ratios)
  {
    std::printf("  %-30s", name);
    for (const double ratio : ratios)
    {
      std::printf(" %5.2f", ratio);
    }
    std::printf("\n");
  };
  const auto none = TrapezoidAnisotropy(WeightMethod::None, 8);
  const auto fitted = TrapezoidAnisotropy(WeightMethod::LeastSquares, 8);
  const auto fitted4 = TrapezoidAnisotropy(WeightMethod::LeastSquares, 4);
  const auto heuristic = TrapezoidAnisotropy(WeightMethod::Heuristic, 8);
  const auto power = TrapezoidAnisotropy(WeightMethod::PowerMatched, 8);
  // Half way between two scales bands fit worst.
  const auto between = TrapezoidAnisotropy(WeightMethod::LeastSquares, 8, 1.0 / 22.6);
  print("none", none);
  print("least squares, K=8", fitted);
  print("least squares, between scales", between);
  print("least squares, K=4", fitted4);
  print("heuristic, K=8", heuristic);
  print("power matched, K=8", power);
  Report("none, bottom", none.front(), 3.0, 4.2);
  Report("none, top", none.back(), 1.0, 1.5);
  Report(
    "least squares K=8, worst strip", *std::max_element(fitted.begin(), fitted.end()), 1.0, 1.15);
  Report("least squares K=8 between scales, worst strip",
    *std::max_element(between.begin(), between.end()), 1.0, 1.12);
  Report(
    "heuristic K=8, worst strip", *std::max_element(heuristic.begin(), heuristic.end()), 1.0, 1.75);
}

/// Figure 8: a zone plate filtered by weighted bands, against the Gaussian filter itself.
void ZonePlate()
{
  std::printf("Figure 8: mean squared error of a filtered zone plate\n");
  using Complex = std::complex<double>;
  constexpr int N = 256, J = 5, bins = N * N;
  Eigen::Matrix2d jacobian;
  jacobian << 2.0, 0.7, 0.0, 1.0;
  const Eigen::Matrix2d footprint = jacobian * jacobian.transpose();
  const auto gaussian = [&](double wx, double wy)
  {
    const Eigen::Vector2d w(wx, wy);
    return std::exp(-0.5 * w.dot(footprint * w));
  };

  // Power of the image at each frequency.
  Eigen::FFT<double> fft;
  std::vector<Complex> image(bins), line(N), transformed(N);
  for (int y = 0; y < N; ++y)
  {
    for (int x = 0; x < N; ++x)
    {
      const double squared = std::pow(x - 128.0, 2) + std::pow(y - 128.0, 2);
      line[x] = 127.5 + 127.5 * std::cos(Pi * squared / 256.0);
    }
    fft.fwd(&image[y * N], line.data(), N);
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
  const auto frequency = [&](int bin) { return bin < N / 2 ? bin : bin - N; };
  Eigen::VectorXd power(bins), reference(bins), mip(bins);
  const double widest = std::sqrt(footprint.selfadjointView<Eigen::Lower>().eigenvalues()[1]);
  for (int bin = 0; bin < bins; ++bin)
  {
    const double wx = 2.0 * Pi * frequency(bin % N) / N;
    const double wy = 2.0 * Pi * frequency(bin / N) / N;
    power(bin) = std::norm(image[bin]) / std::pow(N, 4);
    reference(bin) = gaussian(wx, wy);
    mip(bin) = std::exp(-0.5 * widest * widest * (wx * wx + wy * wy));
  }
  const auto error = [&](const Eigen::VectorXd& filter)
  { return (power.array() * (filter - reference).array().square()).sum(); };
  const auto report = [](const char* what, double measured, double expected)
  { Report(what, measured, 0.98 * expected, 1.02 * expected); };
  report("unfiltered", error(Eigen::VectorXd::Ones(bins)), 7161.8);
  report("isotropic mip map", error(mip), 100.2);

  for (const int K : { 8, 4 })
  {
    // Columns: the oriented high residual, J scales, the low residual.
    Eigen::MatrixXd filters(bins, K * (J + 1) + 1);
    for (int bin = 0; bin < bins; ++bin)
    {
      const int kx = frequency(bin % N), ky = frequency(bin / N);
      const double theta = std::atan2(ky, kx);
      // -k may be another bin at the Nyquist frequency; the mean of both keeps images real.
      const double opposite = std::atan2(ky == -N / 2 ? ky : -ky, kx == -N / 2 ? kx : -kx);
      const double y = kx == 0 && ky == 0 ? -100.0 : std::log2(std::hypot(kx, ky) / (N / 4));
      for (int i = 0; i < K; ++i)
      {
        const double angular = 0.5 * (AngularFilter(i, K, theta) + AngularFilter(i, K, opposite));
        filters(bin, i) = angular * HighResidual(y);
        for (int j = 0; j < J; ++j)
        {
          filters(bin, K * (1 + j) + i) = angular * RadialFilter(y + j);
        }
      }
      filters(bin, K * (J + 1)) = LowResidual(y, J);
    }
    const Eigen::VectorXd fit =
      (filters.transpose() * filters).ldlt().solve(filters.transpose() * reference);
    report(K == 8 ? "least squares, K=8" : "least squares, K=4", error(filters * fit),
      K == 8 ? 3.99 : 7.16);

    // The filter at the centre of each band; the high residual's is an octave above scale 0.
    Eigen::VectorXd probes(K * (J + 1) + 1);
    for (int i = 0; i < K; ++i)
    {
      for (int j = -1; j < J; ++j)
      {
        const double w = 0.5 * Pi * std::exp2(-j);
        probes(K * (1 + j) + i) = gaussian(w * std::cos(Pi * i / K), w * std::sin(Pi * i / K));
      }
    }
    probes(K * (J + 1)) = 1.0;
    report(
      K == 8 ? "heuristic, K=8" : "heuristic, K=4", error(filters * probes), K == 8 ? 7.34 : 11.76);
  }
}

/// Four bands in bytes take 256 KB, and are good enough.
void Memory()
{
  std::printf("Memory of four bands in bytes\n");
  SubbandParameters parameters;
  parameters.Orientations = 4;
  parameters.Scales = 1;
  const SubbandTiles tiles = MakeSubbandTiles(parameters);
  const QuantizedSubbandTiles bytes = Quantize(tiles);
  Report("bytes", double(bytes.Values.size()), 262144, 262144);
  double power = 0.0, error = 0.0;
  for (std::size_t n = 0; n < tiles.Values.size(); ++n)
  {
    const double value = (bytes.Values[n] / 127.5 - 1.0) * bytes.Range[n % 4];
    power += std::pow(tiles.Values[n], 2);
    error += std::pow(value - tiles.Values[n], 2);
  }
  Report("signal to noise, dB", 10.0 * std::log10(power / error), 40.0, 60.0);
}
} // namespace

int main()
{
  SumOfBands();
  Trapezoid();
  ZonePlate();
  Memory();
  return Missed ? 1 : 0;
}
