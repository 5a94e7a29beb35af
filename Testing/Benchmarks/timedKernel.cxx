// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One evaluation with the default look, as a module that besideCommit loads: one for each build of
/// the kernel.
#include "BenchmarkFlow.h"
#include "SteerableNoise.h"

#include <hwy/targets.h>

#include <cmath>
#include <cstring>
#include <ctime>
#include <vector>

using namespace steerable;

/// Seconds of the thread for one evaluation; `points` in the order of the image. 0 if there is no
/// such level.
extern "C" __attribute__((visibility("default"))) double TimeKernel(
  const char* level, int dimension, int points)
{
  hwy::SetSupportedTargetsForTest(0); // as on this machine again
  std::int64_t chosen = 0;
  for (std::int64_t target : hwy::SupportedAndGeneratedTargets())
  {
    chosen = std::strcmp(hwy::TargetName(target), level) == 0 ? target : chosen;
  }
  if (chosen == 0)
  {
    return 0.0;
  }
  hwy::SetSupportedTargetsForTest(chosen);
  ImageGrid grid;
  grid.Dimensions = dimension == 2 ? std::array<std::int64_t, 3>{ 512, 256, 1 }
                                   : std::array<std::int64_t, 3>{ 96, 40, 32 };
  std::vector<float> vectors;
  std::vector<double> positions;
  for (std::int64_t k = 0; k < grid.Dimensions[2]; ++k)
  {
    for (std::int64_t j = 0; j < grid.Dimensions[1]; ++j)
    {
      for (std::int64_t i = 0; i < grid.Dimensions[0]; ++i)
      {
        const double place[3] = { double(i), double(j), double(k) };
        positions.insert(positions.end(), place, place + 3);
        const auto flow = BenchmarkFlow(dimension, i, j, k);
        vectors.insert(vectors.end(), flow.begin(), flow.end());
      }
    }
  }
  NoiseParameters p;
  p.FeatureSize = 16.0;
  const SteerableNoise noise(p, dimension);
  const ContiguousReader<float, 3> reader(vectors.data());
  const ContiguousReader<double, 3> places(positions.data());
  Field field;
  field.Vectors = &reader;
  std::vector<float> result(vectors.size() / 3);
  const auto now = []
  {
    std::timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  double start = 0.0;
  for (int round = 0; round < 3; ++round) // the first warms up
  {
    start = round == 1 ? now() : start;
    points ? noise.EvaluatePoints(places, field, 0, result.size(), result.data())
           : noise.EvaluateImage(grid, field, 0, grid.GetNumberOfRows(), result.data());
  }
  return 0.5 * (now() - start);
}
