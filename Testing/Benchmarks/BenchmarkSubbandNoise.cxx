// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Subband noise: tiles, weights, sums, and the whole filter. Limits per core at K = 8 and 4 scales:
 * weights 0.5 million points a second, sums of one octave 5 million.
 */
#include "Subband/SubbandTiles.h"
#include "Subband/SubbandWeights.h"

#include "vtkFloatArray.h"
#include "vtkNew.h"
#include "vtkPlaneSource.h"
#include "vtkPolyData.h"
#include "vtkPolyDataSubbandNoise.h"
#include "vtkSMPTools.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

using namespace steerable;

namespace
{
SubbandParameters Pyramid(const benchmark::State& state)
{
  SubbandParameters parameters;
  parameters.Orientations = static_cast<int>(state.range(0));
  parameters.Scales = static_cast<int>(state.range(1));
  return parameters;
}

void PointsPerSecond(benchmark::State& state, double points)
{
  state.counters["points/s"] =
    benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
}
} // namespace

static void Tiles(benchmark::State& state)
{
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(MakeSubbandTiles(Pyramid(state)).Values.data());
  }
}
BENCHMARK(Tiles)->Args({ 4, 1 })->Args({ 8, 4 })->Unit(benchmark::kMillisecond);

static void Weights(benchmark::State& state)
{
  SubbandWeightParameters parameters;
  parameters.Pyramid = Pyramid(state);
  parameters.Method = static_cast<WeightMethod>(state.range(2));
  const SubbandWeights solver(parameters);
  const double unit = std::pow(parameters.Pyramid.CenterFrequency(), -2.0);
  std::vector<Eigen::Matrix2d> metrics;
  for (int n = 0; n < 1024; ++n)
  {
    Eigen::Matrix2d metric;
    metric << 2.0 + n % 7, 0.5 * std::sin(n), 0.5 * std::sin(n), 2.0 + n % 11;
    metrics.push_back(unit * metric);
  }
  double gamma[48];
  for (auto _ : state)
  {
    for (const Eigen::Matrix2d& metric : metrics)
    {
      solver.Compute(metric, gamma);
      benchmark::DoNotOptimize(gamma);
    }
  }
  PointsPerSecond(state, static_cast<double>(metrics.size()));
}
BENCHMARK(Weights)
  ->ArgNames({ "K", "J", "method" })
  ->Args({ 8, 4, 0 })
  ->Args({ 8, 4, 1 })
  ->Args({ 8, 4, 2 })
  ->Args({ 4, 4, 0 });

static void Antialias(benchmark::State& state)
{
  SubbandWeightParameters parameters;
  parameters.Pyramid = Pyramid(state);
  const SubbandWeights solver(parameters);
  const Eigen::Matrix2d footprint =
    1e-2 * std::pow(parameters.Pyramid.CenterFrequency(), -2.0) * Eigen::Matrix2d::Identity();
  double beta[48];
  for (auto _ : state)
  {
    solver.Antialias(footprint, beta);
    benchmark::DoNotOptimize(beta);
  }
  PointsPerSecond(state, 1.0);
}
BENCHMARK(Antialias)->Args({ 8, 4 });

static void Sum(benchmark::State& state)
{
  const SubbandTiles tiles = MakeSubbandTiles(Pyramid(state));
  const int components = tiles.Parameters.Components();
  // Points of a mesh in order: neighbours are near one another in the texture.
  constexpr int side = 256;
  std::vector<double> uv;
  for (int n = 0; n < side * side; ++n)
  {
    uv.push_back(1.7 * (n % side) / side);
    uv.push_back(1.7 * double(n / side) / side);
  }
  const std::vector<float> weights(side * side * components, 0.5f);
  std::vector<float> noise(side * side);
  for (auto _ : state)
  {
    SumSubbands(
      tiles, TileLookup::CatmullRom, noise.size(), uv.data(), weights.data(), noise.data());
    benchmark::DoNotOptimize(noise.data());
  }
  PointsPerSecond(state, static_cast<double>(noise.size()));
}
// Table 10 of Goldberg et al. (2008): what a scale costs.
BENCHMARK(Sum)->ArgNames({ "K", "J" })->ArgsProduct({ { 4, 6, 8 }, { 1, 2, 3, 4, 5 } });

/// The filter on a textured plane of a million points, with tiles already made.
static void Filter(benchmark::State& state)
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetResolution(999, 999);
  plane->Update();
  vtkNew<vtkPolyDataSubbandNoise> filter;
  filter->SetInputData(plane->GetOutput());
  filter->SetWavelength(0.03);
  filter->SetAntiAlias(state.range(1) != 0);
  const vtkSMPTools::Config config(static_cast<int>(state.range(0)), "STDThread", false);
  vtkSMPTools::LocalScope(config,
    [&]
    {
      filter->Update();
      for (auto _ : state)
      {
        filter->Modified();
        filter->Update();
      }
    });
  PointsPerSecond(state, 1e6);
}
BENCHMARK(Filter)
  ->ArgNames({ "threads", "antialias" })
  ->Args({ 1, 0 })
  ->Args({ 1, 1 })
  ->Args({ 2, 1 })
  ->Unit(benchmark::kMillisecond)
  ->UseRealTime();

BENCHMARK_MAIN();
