// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * One evaluation at one SIMD level, for counting its instructions with callgrind: evaluateOnce
 * LEVEL 2|3 image|points QUALITY KIND. Prints the number of points. KIND plain is the paper's model
 * without normalisation and curvature, paper with both; the defaults have no Quality, and neither
 * have straight, the defaults in a constant flow, and isotropic, the defaults with Strength 0 and
 * without curvature.
 */
#include "BenchmarkFlow.h"
#include "SteerableNoise.h"

#include <hwy/targets.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

using namespace steerable;

int main(int argc, char** argv)
{
  if (argc != 6)
  {
    std::fprintf(stderr, "usage: evaluateOnce LEVEL 2|3 image|points QUALITY plain|paper|defaults|straight|isotropic\n");
    return 2;
  }
  for (std::int64_t target : { HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SCALAR })
  {
    if (std::strcmp(hwy::TargetName(target), argv[1]) == 0)
    {
      hwy::SetSupportedTargetsForTest(target);
    }
  }
  const int dimension = std::atoi(argv[2]);
  NoiseParameters p;
  p.FeatureSize = 16.0;
  const bool straight = std::strcmp(argv[5], "straight") == 0;
  if (std::strcmp(argv[5], "isotropic") == 0)
  {
    p.Strength = 0.0;
    p.FollowCurvature = false;
  }
  else if (!straight && std::strcmp(argv[5], "defaults") != 0)
  {
    p.LatticeWindow = true;
    p.EigenvalueSum = 4.0;
    p.Quality = std::atoi(argv[4]);
  }
  if (std::strcmp(argv[5], "plain") == 0)
  {
    p.FollowCurvature = false;
    p.Normalization = Normalization::None;
  }
  ImageGrid grid;
  grid.Dimensions = dimension == 2 ? std::array<std::int64_t, 3>{ 1024, 256, 1 }
                                   : std::array<std::int64_t, 3>{ 128, 64, 32 };
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
        if (straight)
        {
          vectors.insert(vectors.end(), { 0.8f, 0.5f, dimension == 2 ? 0.0f : 0.3f });
          continue;
        }
        const auto flow = BenchmarkFlow(dimension, i, j, k);
        vectors.insert(vectors.end(), flow.begin(), flow.end());
      }
    }
  }
  const ContiguousReader<float, 3> reader(vectors.data());
  const ContiguousReader<double, 3> places(positions.data());
  Field field;
  field.Vectors = &reader;
  const SteerableNoise noise(p, dimension);
  std::vector<float> result(vectors.size() / 3);
  const EvaluationCounts counts = std::strcmp(argv[3], "image") == 0
    ? noise.EvaluateImage(grid, field, 0, grid.GetNumberOfRows(), result.data())
    : noise.EvaluatePoints(places, field, 0, result.size(), result.data());
  std::printf("points %zu corners %.2f\n", result.size(),
    static_cast<double>(counts.VisitedCorners) / result.size());
}
