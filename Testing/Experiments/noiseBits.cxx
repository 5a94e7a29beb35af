// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * A checksum of the kernel's noise for many options, on images and points in 2D and 3D, at one SIMD
 * level: noiseBits LEVEL [FILE]. A change that is not to change results prints the same lines
 * before and after. FILE gets the values themselves, to see how far they are apart.
 */
#include "KernelTestHelpers.h"

#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

using namespace steerable;
using namespace steerable::testing;

namespace
{
using Case = std::pair<std::string, NoiseParameters>;

std::vector<Case> AllCases()
{
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, NoiseParameters model, auto&& change)
  {
    change(model);
    cases.emplace_back(name, model);
  };
  for (const bool paper : { false, true })
  {
    const NoiseParameters model = paper ? PaperModel() : NoiseParameters();
    const std::string prefix = paper ? "paper " : "";
    using P = NoiseParameters;
    add(prefix + "defaults", model, [](P&) {});
    add(prefix + "straight", model, [](P& p) { p.FollowCurvature = false; });
    add(prefix + "raw", model, [](P& p) { p.Normalization = Normalization::None; });
    add(prefix + "weight sum", model, [](P& p) { p.Normalization = Normalization::WeightSum; });
    add(prefix + "long", model, [](P& p) { p.StreakLength = 15.0; p.Quality = 8; });
    add(prefix + "short", model, [](P& p) { p.StreakLength = 1.0; p.Quality = 0; });
    add(prefix + "thin", model, [](P& p) { p.EigenvalueSum = 12.0; });
    add(prefix + "strength", model, [](P& p) { p.Strength = 0.4; });
    add(prefix + "isotropic", model, [](P& p) { p.Strength = 0.0; });
    add(prefix + "magnitude", model,
      [](P& p) { p.StrengthMode = StrengthMode::Magnitude; p.MaskThreshold = 0.2; });
    add(prefix + "value", model, [](P& p) { p.Basis = Basis::Value; });
    add(prefix + "streaks", model, [](P& p) { p.Basis = Basis::Streaks; });
    add(prefix + "motion", model, [](P& p) { p.Motion = true; p.Phase = 0.3; });
    add(prefix + "octaves", model, [](P& p) { p.Octaves = 3; p.Turbulence = true; });
    add(prefix + "cubic", model, [](P& p) { p.Fade = Fade::Cubic; });
    add(prefix + "wide", model, [](P& p) { p.Fade = Fade::Wide; });
    add(prefix + "radial", model, [](P& p) { p.Falloff = Falloff::Radial; });
    add(prefix + "jittered", model, [](P& p) { p.Lattice = Lattice::Jittered; });
    add(prefix + "simplicial", model, [](P& p) { p.Lattice = Lattice::Simplicial; });
    add(prefix + "perlin", model, [](P& p) { p.GradientSet = GradientSet::Perlin; });
    add(prefix + "unprojected", model, [](P& p) { p.MetricInProjection = false; });
    add(prefix + "period", model, [](P& p) { p.Period = { 5, 3, 4 }; });
  }
  add("unweighted", PaperModel(), [](NoiseParameters& p) { p.AnisotropicWeight = false; });
  add("cell", PaperModel(0),
    [](NoiseParameters& p) { p.FollowCurvature = false; p.Normalization = Normalization::None; });
  return cases;
}

std::FILE* Values = nullptr;

/// FNV-1a of the bits.
std::uint64_t Checksum(const std::vector<float>& noise)
{
  if (Values)
  {
    std::fwrite(noise.data(), sizeof(float), noise.size(), Values);
  }
  std::uint64_t sum = 14695981039346656037u;
  for (float value : noise)
  {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    sum = (sum ^ bits) * 1099511628211u;
  }
  return sum;
}

Eigen::Vector3d Swirl(const Eigen::Vector3d& p)
{
  // With a stagnation line, a jump, and lengths that change.
  return { std::cos(0.3 * p[1] + 0.2 * p[2]), p[0] > 12.0 ? -1.0 : std::sin(0.25 * p[0]),
    0.5 * std::sin(0.3 * (p[0] + p[1])) };
}

template <int N>
void Print(const Case& named)
{
  NoiseParameters p = named.second;
  const char* name = named.first.c_str();
  // Points along curves, which share lists, then others anywhere.
  RandomSamples samples(1300, 40.0, 0.15, 5);
  for (std::size_t i = 0; i < 900; ++i)
  {
    const double t = 0.07 * static_cast<double>(i);
    const double place[3] = { t, 3.0 * std::sin(0.4 * t), 0.5 * t };
    const Eigen::Vector3d u = Swirl(Eigen::Vector3d(place[0], place[1], place[2]));
    for (int axis = 0; axis < 3; ++axis)
    {
      samples.Positions[3 * i + axis] = place[axis];
      samples.Vectors[3 * i + axis] = static_cast<float>(u[axis]);
    }
  }
  const auto print = [&](const char* what, const std::vector<float>& noise)
  { std::printf("%dD %-12s %-20s %016llx\n", N, what, name,
      static_cast<unsigned long long>(Checksum(noise))); };
  EvaluationCounts counts;
  print("points", FastNoise<N>(p, samples, Steering::Vectors, &counts));
  print("tensors", FastNoise<N>(p, samples, Steering::Tensors));
  if (N == 3)
  {
    print("surface", FastNoise<N>(p, samples, Steering::Normals));
  }
  p.FeatureSize = 1.3;
  ImageGrid grid;
  grid.Origin = { -3.1, 1.7, 100.0 };
  grid.Spacing = { 0.11, 0.13, 0.12 };
  grid.Dimensions = N == 2 ? std::array<std::int64_t, 3>{ 203, 43, 1 }
                           : std::array<std::int64_t, 3>{ 71, 19, 5 };
  print("image", ImageNoise(p, N, grid, SampleVectors(grid, Swirl)));
  grid.Spacing = { 1.9, 0.7, 2.1 };
  grid.CurvatureStride = 2;
  print("coarse image", ImageNoise(p, N, grid, SampleVectors(grid, Swirl)));
}
} // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    std::fprintf(stderr, "usage: noiseBits LEVEL [FILE]\n");
    return 2;
  }
  Values = argc > 2 ? std::fopen(argv[2], "wb") : nullptr;
  for (std::int64_t target : SimdLevels())
  {
    if (std::strcmp(hwy::TargetName(target), argv[1]) == 0)
    {
      hwy::SetSupportedTargetsForTest(target);
      for (const Case& named : AllCases())
      {
        Print<2>(named);
        Print<3>(named);
      }
      return Values && std::fclose(Values) != 0;
    }
  }
  std::fprintf(stderr, "This machine or this build lacks the level %s.\n", argv[1]);
  return 2;
}
