// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The fast path: equal to the reference at every SIMD level, to the bit however it is split.
#include "KernelTestHelpers.h"

#include <Eigen/Eigenvalues>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

using namespace steerable;
using namespace steerable::testing;

namespace
{
/// Absolute, for noise of unit variance as for the raw sum.
constexpr double Bound = 2e-6;
/// Bends of images are differences of neighbours: a few more roundings, at the weakest samples.
constexpr double CurvedImageBound = 2.5e-6;
/// On bent surfaces levels without fused products round a little more.
constexpr double BentSurfaceBound = 2.2e-6;

/**
 * Variants reach farther, fall off faster or leave places with hardly a surflet, whose noise is divided
 * by no more than the root of 1e-3: rounding shows more than with the defaults.
 */
constexpr double VariantBound = 4e-6;
constexpr double LooseBound = 7e-6;
/// The sag of a bent streak grows with the square of its length, to 200 cells at 20, and so does its rounding.
constexpr double LongBound = 1.2e-5;
/// Variants without the window reach 2.5 times as far as at Quality 2.
constexpr double FreeVariantFactor = 2.0;

const char* NameOf(Steering steering)
{
  return steering == Steering::Vectors ? "vectors"
    : steering == Steering::Normals    ? "normals"
                                       : "tensors";
}

/// Largest differences by family, printed when the tests are over.
class DifferenceTable : public ::testing::Environment
{
public:
  static std::map<std::string, double>& Get()
  {
    static std::map<std::string, double> table;
    return table;
  }
  static void Add(const std::string& family, double difference)
  {
    double& largest = Get()[family];
    largest = difference <= largest ? largest : difference;
  }
  void TearDown() override
  {
    for (const auto& [family, largest] : Get())
    {
      std::printf("fast - reference %8.1e  %s\n", largest, family.c_str());
    }
  }
};
[[maybe_unused]] const auto* const Table = ::testing::AddGlobalTestEnvironment(new DifferenceTable);

/// Compares every SIMD level with the reference, which is evaluated once.
template <int N>
void ExpectReference(const std::string& family, const NoiseParameters& parameters,
  const RandomSamples& samples, Steering steering, double bound = Bound)
{
  const std::vector<double> slow = SlowNoise<N>(parameters, samples, steering);
  std::vector<float> best;
  for (std::int64_t target : SimdLevels())
  {
    const SimdLevel level(target);
    const std::vector<float> fast = FastNoise<N>(parameters, samples, steering);
    const double difference = LargestDifference(fast, slow);
    EXPECT_LE(difference, bound) << family << ": " << N << "D, " << NameOf(steering) << ", "
                                 << hwy::TargetName(target);
    DifferenceTable::Add(family, difference);
    best = best.empty() ? fast : best;
    EXPECT_LE(LargestDifference(fast, best), bound) << family << ", " << hwy::TargetName(target);
  }
}

/// All ways to steer, straight and bent. `model` names the parameters; `slow`: fewer combinations.
template <int N>
void ExpectReferenceOfModel(const std::string& model, NoiseParameters parameters, int count,
  bool slow, unsigned seed, double bound)
{
  const bool unit = parameters.Normalization == Normalization::UnitVariance;
  for (Steering steering : { Steering::Vectors, Steering::Tensors, Steering::Normals })
  {
    for (double curvature : { 0.0, 0.15, 0.6 })
    {
      if ((steering == Steering::Normals && N == 2) || (slow && curvature == 0.6))
      {
        continue;
      }
      parameters.FollowCurvature = curvature > 0.0;
      const std::string family = std::to_string(N) + "D " +
        (unit                                                  ? "UnitVariance "
            : parameters.Normalization == Normalization::None ? "None "
                                                          : "WeightSum ") +
        model + " " + NameOf(steering) + (curvature > 0.0 ? " curved" : "");
      const bool bentSurface = unit && steering == Steering::Normals && parameters.FollowCurvature;
      ExpectReference<N>(family, parameters, RandomSamples(count, 1000.0, curvature, seed), steering,
        bentSurface ? std::max(bound, BentSurfaceBound) : bound);
    }
  }
}

/// Rice's own model.
template <int N>
void ExpectReferenceAtAllQualities(Normalization normalization, double bound = Bound)
{
  for (int quality : { 0, 1, 2, 4, 8 })
  {
    NoiseParameters parameters = PaperModel(quality);
    parameters.Normalization = normalization;
    const bool unit = normalization == Normalization::UnitVariance;
    // The reference visits the whole box: 9000 corners in 3D at Quality 8.
    const int count = unit ? 2000 : N == 3 && quality == 8 ? 200 : 1000;
    ExpectReferenceOfModel<N>("Quality " + std::to_string(quality), parameters, count,
      !unit || (N == 3 && quality == 8), 1 + quality, bound);
  }
}

/// Without the window; the default length is held to the same bound.
template <int N>
void ExpectReferenceAtAllLengths(Normalization normalization, double bound = Bound)
{
  for (int length : { 1, 3, 6, 10, 20 })
  {
    NoiseParameters parameters;
    parameters.StreakLength = length;
    parameters.Normalization = normalization;
    const int count = N == 2 ? 2000 : length <= 6 ? 500 : length <= 10 ? 100 : 30;
    ExpectReferenceOfModel<N>("StreakLength " + std::to_string(length), parameters, count,
      normalization != Normalization::UnitVariance || N == 3, 1 + length,
      length <= 6 ? bound : std::max(bound, LongBound));
  }
}

/// A change of the defaults, and what it may cost in precision.
struct Variant
{
  const char* Name;
  std::function<void(NoiseParameters&)> Change;
  double Bound = VariantBound;
};

const std::vector<Variant>& Variants()
{
  using P = NoiseParameters;
  static const std::vector<Variant> variants = {
    { "Basis Value", [](P& p) { p.Basis = Basis::Value; } },
    { "Basis Streaks", [](P& p) { p.Basis = Basis::Streaks; } },
    { "Basis Streaks, Density 0.05",
      [](P& p)
      {
        p.Basis = Basis::Streaks;
        p.Density = 0.05;
        p.Normalization = Normalization::None;
      } },
    { "Basis Streaks, Density 1",
      [](P& p)
      {
        p.Basis = Basis::Streaks;
        p.Density = 1.0;
      } },
    { "Fade Cubic", [](P& p) { p.Fade = Fade::Cubic; } },
    { "Fade Wide", [](P& p) { p.Fade = Fade::Wide; } },
    { "Falloff Radial", [](P& p) { p.Falloff = Falloff::Radial; } },
    { "Lattice Jittered", [](P& p) { p.Lattice = Lattice::Jittered; } },
    { "Lattice Simplicial", [](P& p) { p.Lattice = Lattice::Simplicial; } },
    { "GradientSet Perlin", [](P& p) { p.GradientSet = GradientSet::Perlin; } },
    { "Motion, Phase 0.3",
      [](P& p)
      {
        p.Motion = true;
        p.Phase = 0.3;
      },
      LooseBound },
    { "Motion, Phase -1.7, Speed -2",
      [](P& p)
      {
        p.Motion = true;
        p.Phase = -1.7;
        p.Speed = -2.0;
      },
      LooseBound },
    { "Motion, Phase 0.95, Speed 4",
      [](P& p)
      {
        p.Motion = true;
        p.Phase = 0.95;
        p.Speed = 4.0;
      },
      LooseBound },
    { "Octaves 4", [](P& p) { p.Octaves = 4; } },
    { "Octaves 3, Lacunarity 2.7, Gain 0.9",
      [](P& p)
      {
        p.Octaves = 3;
        p.Lacunarity = 2.7;
        p.Gain = 0.9;
      } },
    { "Turbulence, Octaves 3",
      [](P& p)
      {
        p.Octaves = 3;
        p.Turbulence = true;
      } },
    { "Period",
      [](P& p) {
        p.Period = { 5, 7, 3 };
      } },
    { "Period of 1 cell",
      [](P& p) {
        p.Period = { 1, 1, 1 };
      } },
    { "Period, Octaves 3",
      [](P& p)
      {
        p.Period = { 4, 0, 9 };
        p.Octaves = 3;
        p.Lacunarity = 3.0;
      } },
    { "Strength 0", [](P& p) { p.Strength = 0.0; } },
    { "Strength 0.4", [](P& p) { p.Strength = 0.4; } },
    { "Strength by Magnitude",
      [](P& p)
      {
        p.StrengthMode = StrengthMode::Magnitude;
        p.ReferenceMagnitude = 2.0;
      } },
    { "EigenvalueSum 2", [](P& p) { p.EigenvalueSum = 2.0; } },
    { "EigenvalueSum 8", [](P& p) { p.EigenvalueSum = 8.0; }, LooseBound },
    { "EigenvalueSum 16", [](P& p) { p.EigenvalueSum = 16.0; }, LooseBound },
    { "MinimumEigenvalue 0.02",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.MinimumEigenvalue = 0.02;
      },
      LooseBound },
    { "MinimumEigenvalue 1",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.MinimumEigenvalue = 1.0;
      } },
    { "StreakLength 1, None",
      [](P& p)
      {
        p.LatticeWindow = false;
        p.StreakLength = 1.0;
        p.Normalization = Normalization::None;
      } },
    { "AnisotropicWeight off",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.AnisotropicWeight = false;
      } },
    { "AnisotropicWeight off, None",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.AnisotropicWeight = false;
        p.Normalization = Normalization::None;
        p.Quality = 0;
      } },
    { "MetricInProjection off", [](P& p) { p.MetricInProjection = false; } },
    { "MetricInProjection off, Motion, Jittered",
      [](P& p)
      {
        p.MetricInProjection = false;
        p.Motion = true;
        p.Phase = 0.3;
        p.Lattice = Lattice::Jittered;
      } },
    { "AnisotropicWeight and MetricInProjection off, Perlin, None",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.AnisotropicWeight = false;
        p.MetricInProjection = false;
        p.Normalization = Normalization::None;
        p.Quality = 0;
        p.GradientSet = GradientSet::Perlin;
      } },
    { "AnisotropicWeight off, Cubic, Octaves 2, Period",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.AnisotropicWeight = false;
        p.Normalization = Normalization::None;
        p.Quality = 0;
        p.Fade = Fade::Cubic;
        p.Octaves = 2;
        p.Period = { 4, 5, 3 };
      } },
    { "Seed 12345", [](P& p) { p.Seed = 12345; } },
    { "Seed 2^32 - 1, Octaves 3",
      [](P& p)
      {
        p.Seed = 0xFFFFFFFFu;
        p.Octaves = 3;
      } },
    { "FeatureSize 37.5", [](P& p) { p.FeatureSize = 37.5; } },
    { "FeatureSize 0.3", [](P& p) { p.FeatureSize = 0.3; } },
    // Several at once.
    { "Wide, Jittered, Motion",
      [](P& p)
      {
        p.Fade = Fade::Wide;
        p.Lattice = Lattice::Jittered;
        p.Motion = true;
        p.Phase = 0.4;
      } },
    { "Streaks, Motion, Jittered",
      [](P& p)
      {
        p.Basis = Basis::Streaks;
        p.Lattice = Lattice::Jittered;
        p.Motion = true;
        p.Phase = 0.77;
        p.Speed = -1.5;
      },
      LooseBound },
    { "Value, Simplicial, Radial, Turbulence, Octaves 2",
      [](P& p)
      {
        p.Basis = Basis::Value;
        p.Lattice = Lattice::Simplicial;
        p.Falloff = Falloff::Radial;
        p.Turbulence = true;
        p.Octaves = 2;
      } },
    { "Perlin, Cubic, Period, Motion",
      [](P& p)
      {
        p.GradientSet = GradientSet::Perlin;
        p.Fade = Fade::Cubic;
        p.Period = { 3, 6, 5 };
        p.Motion = true;
        p.Phase = 0.1;
      } },
    { "Streaks, Simplicial, no window",
      [](P& p)
      {
        p.Basis = Basis::Streaks;
        p.Lattice = Lattice::Simplicial;
        p.LatticeWindow = false;
        p.StreakLength = 2.0;
      } },
    { "Wide, Motion, no window",
      [](P& p)
      {
        p.Fade = Fade::Wide;
        p.LatticeWindow = false;
        p.Motion = true;
        p.Phase = 0.6;
        p.StreakLength = 2.0;
      } },
    { "no AnisotropicWeight, Radial, Jittered, Perlin",
      [](P& p)
      {
        p.LatticeWindow = true;
        p.AnisotropicWeight = false;
        p.Falloff = Falloff::Radial;
        p.Lattice = Lattice::Jittered;
        p.GradientSet = GradientSet::Perlin;
      } },
    { "Jittered, Period, Wide, Radial, Value",
      [](P& p)
      {
        p.Lattice = Lattice::Jittered;
        p.Period = { 4, 4, 4 };
        p.Fade = Fade::Wide;
        p.Falloff = Falloff::Radial;
        p.Basis = Basis::Value;
      } },
    { "Simplicial, Motion, Strength by Magnitude, Cubic",
      [](P& p)
      {
        p.Lattice = Lattice::Simplicial;
        p.Motion = true;
        p.Phase = 0.5;
        p.StrengthMode = StrengthMode::Magnitude;
        p.Fade = Fade::Cubic;
      } },
  };
  return variants;
}

template <int N>
void ExpectReferenceOfVariants()
{
  for (const Variant& variant : Variants())
  {
    for (Steering steering : { Steering::Vectors, Steering::Tensors, Steering::Normals })
    {
      for (double curvature : { 0.0, 0.3 })
      {
        // A part of the combinations, each option in at least one of them.
        const bool plain = steering == Steering::Vectors;
        if ((N == 2 && steering == Steering::Normals) || (!plain && curvature == 0.0))
        {
          continue;
        }
        for (NoiseParameters parameters : { NoiseParameters(), PaperModel(2) })
        {
          parameters.FollowCurvature = curvature > 0.0;
          const bool paper = parameters.LatticeWindow;
          variant.Change(parameters);
          const double perWorldUnit = curvature / parameters.FeatureSize;
          // Without the window the reference's box is five times as large in space.
          ExpectReference<N>(
            std::to_string(N) + "D variant " + variant.Name + (paper ? ", paper's model" : ""),
            parameters, RandomSamples(N == 2 ? 400 : paper ? 80 : 20, 50.0, perWorldUnit, 5),
            steering, paper ? variant.Bound : FreeVariantFactor * variant.Bound);
        }
      }
    }
  }
}

// ---- images ---------------------------------------------------------------------------------------

/// A flow with vortices, so that its curvature changes from place to place.
Eigen::Vector3d Swirl(const Eigen::Vector3d& p)
{
  return { std::sin(0.31 * p[1]) + 0.4 * std::cos(0.23 * p[2]) + 0.2,
    std::cos(0.27 * p[0]) - 0.3 * std::sin(0.19 * p[1]), 0.5 * std::sin(0.21 * p[0] + 0.3 * p[1]) };
}

ImageGrid SmallGrid(int dimension)
{
  ImageGrid grid;
  grid.Origin = { -3.2, 1.7, 0.4 };
  grid.Spacing = { 0.5, 0.75, 0.6 };
  grid.Dimensions = { dimension == 2 ? 61 : 19, dimension == 2 ? 23 : 9, dimension == 2 ? 1 : 7 };
  return grid;
}

/**
 * An image through the reference. Curvature (û . grad) û comes from central differences of unit
 * vectors, one-sided at the border, neighbours turned to the side of the sample's own vector.
 */
template <int N>
std::vector<double> SlowImage(
  const NoiseParameters& parameters, const ImageGrid& grid, const std::vector<float>& vectors)
{
  const auto whole = [&](const std::array<std::int64_t, 3>& index)
  {
    const std::int64_t flat =
      (index[2] * grid.Dimensions[1] + index[1]) * grid.Dimensions[0] + index[0];
    return Vector<3>(Eigen::Map<const Eigen::Vector3f>(vectors.data() + 3 * flat).cast<double>());
  };
  const auto at = [&](const std::array<std::int64_t, 3>& index)
  { return Vector<N>(whole(index).template head<N>()); };
  std::vector<double> noise;
  std::array<std::int64_t, 3> i;
  for (i[2] = 0; i[2] < grid.Dimensions[2]; ++i[2])
  {
    for (i[1] = 0; i[1] < grid.Dimensions[1]; ++i[1])
    {
      for (i[0] = 0; i[0] < grid.Dimensions[0]; ++i[0])
      {
        Vector<N> place;
        const Vector<N> u = at(i).normalized();
        Vector<N> curvature = Vector<N>::Zero();
        for (int axis = 0; axis < N; ++axis)
        {
          place[axis] = grid.Origin[axis] + (grid.FirstIndex[axis] + i[axis]) * grid.Spacing[axis];
          auto before = i;
          auto after = i;
          before[axis] = std::max<std::int64_t>(i[axis] - 1, 0);
          after[axis] = std::min(i[axis] + 1, grid.Dimensions[axis] - 1);
          if (before[axis] < after[axis] && parameters.FollowCurvature)
          {
            Vector<N> a = at(before).normalized();
            Vector<N> c = at(after).normalized();
            a *= a.dot(u) < 0.0 ? -1.0 : 1.0;
            c *= c.dot(u) < 0.0 ? -1.0 : 1.0;
            const double width = (after[axis] - before[axis]) * grid.Spacing[axis];
            curvature += u[axis] * (c - a) / width;
          }
        }
        noise.push_back(SteerableNoiseReference<N>(
          parameters, place, MetricFromVector<N>(parameters, at(i), whole(i).norm()), curvature));
      }
    }
  }
  return noise;
}

template <int N>
void ExpectReferenceOfImages(const NoiseParameters& parameters, const ImageGrid& grid,
  const VectorFunction& function, const std::string& family, double bound = CurvedImageBound)
{
  const std::vector<float> vectors = SampleVectors(grid, function);
  const std::vector<double> slow = SlowImage<N>(parameters, grid, vectors);
  for (std::int64_t target : SimdLevels())
  {
    const SimdLevel level(target);
    const double difference = LargestDifference(ImageNoise(parameters, N, grid, vectors), slow);
    EXPECT_LE(difference, bound) << family << ", " << hwy::TargetName(target);
    DifferenceTable::Add(family, difference);
  }
}

/// Noise of points in a given split, one call after the other.
template <int N>
std::vector<float> SplitNoise(const NoiseParameters& parameters, const RandomSamples& samples,
  const std::vector<std::size_t>& cuts)
{
  const ContiguousReader<double, 3> positions(samples.Positions.data());
  const ContiguousReader<float, 3> vectors(samples.Vectors.data());
  const ContiguousReader<float, 3> curvature(samples.Curvature.data());
  Field field;
  field.Vectors = &vectors;
  field.Curvature = &curvature;
  const SteerableNoise kernel(parameters, N);
  std::vector<float> noise(samples.Count);
  std::size_t begin = 0;
  for (std::size_t end : cuts)
  {
    kernel.EvaluatePoints(positions, field, begin, end, noise.data());
    begin = end;
  }
  kernel.EvaluatePoints(positions, field, begin, samples.Count, noise.data());
  return noise;
}

/// How many bits patterns differ, and the largest difference on the way.
int CountDifferent(const std::vector<float>& a, const std::vector<float>& b)
{
  int count = 0;
  float largest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    count += a[i] == b[i] ? 0 : 1;
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  if (count > 0)
  {
    std::printf("%d of %zu values differ, by up to %g\n", count, a.size(), largest);
  }
  return count;
}

/// The parameters whose bits are compared: the fast loops and the variants' own.
std::vector<NoiseParameters> ParametersOfSplits()
{
  std::vector<NoiseParameters> all;
  for (const NoiseParameters& model : { NoiseParameters(), PaperModel() })
  {
    all.insert(all.end(), 4, model);
    NoiseParameters* const four = all.data() + all.size() - 4;
    four[1].Motion = true;
    four[1].Phase = 0.3;
    four[1].Lattice = Lattice::Jittered;
    four[2].Octaves = 3;
    four[2].Normalization = Normalization::WeightSum;
    four[3].Basis = Basis::Streaks;
    four[3].Period = { 4, 4, 4 };
  }
  all.push_back(PaperModel(0));
  all.back().FollowCurvature = false;
  all.back().Normalization = Normalization::None;
  all.push_back(PaperModel(8));
  return all;
}

/**
 * The samples [first, last) of an axis of a whole image, evaluated as a piece of its own that has one
 * ghost layer where the whole goes on.
 */
std::vector<float> PieceNoise(const NoiseParameters& parameters, int dimension,
  const ImageGrid& whole, const std::vector<float>& vectors, int axis, std::int64_t first,
  std::int64_t last, ImageGrid& piece)
{
  piece = whole;
  const std::int64_t low = std::max<std::int64_t>(first - 1, 0);
  const std::int64_t high = std::min(last + 1, whole.Dimensions[axis]);
  piece.FirstIndex[axis] += low;
  piece.Dimensions[axis] = high - low;
  std::vector<float> own;
  for (std::int64_t k = 0; k < piece.Dimensions[2]; ++k)
  {
    for (std::int64_t j = 0; j < piece.Dimensions[1]; ++j)
    {
      for (std::int64_t i = 0; i < piece.Dimensions[0]; ++i)
      {
        std::int64_t index[3] = { i, j, k };
        index[axis] += low;
        const std::int64_t flat =
          (index[2] * whole.Dimensions[1] + index[1]) * whole.Dimensions[0] + index[0];
        own.insert(own.end(), vectors.begin() + 3 * flat, vectors.begin() + 3 * flat + 3);
      }
    }
  }
  return ImageNoise(parameters, dimension, piece, own);
}

void ExpectPiecesEqualWhole(const NoiseParameters& parameters, int dimension)
{
  ImageGrid grid;
  grid.Origin = { 0.3, -7.1, 2.0 };
  grid.Spacing = { 0.31, 0.37, 0.41 };
  // Longer than a block of the kernel along x, and no multiple of a register.
  grid.Dimensions = { dimension == 2 ? 301 : 45, 38, dimension == 2 ? 1 : 15 };
  grid.FirstIndex = { -17, 5, 3 };
  const std::vector<float> vectors = SampleVectors(grid, Swirl);
  const std::vector<float> whole = ImageNoise(parameters, dimension, grid, vectors);
  for (int axis = 0; axis < dimension; ++axis)
  {
    std::size_t compared = 0;
    for (int part = 0; part < 7; ++part)
    {
      const std::int64_t first = part * grid.Dimensions[axis] / 7;
      const std::int64_t last = (part + 1) * grid.Dimensions[axis] / 7;
      ImageGrid piece;
      const std::vector<float> noise =
        PieceNoise(parameters, dimension, grid, vectors, axis, first, last, piece);
      for (std::size_t n = 0; n < noise.size(); ++n)
      {
        const auto flat = static_cast<std::int64_t>(n);
        std::int64_t index[3] = { flat % piece.Dimensions[0],
          flat / piece.Dimensions[0] % piece.Dimensions[1],
          flat / (piece.Dimensions[0] * piece.Dimensions[1]) };
        for (int i = 0; i < 3; ++i)
        {
          index[i] += piece.FirstIndex[i] - grid.FirstIndex[i];
        }
        if (index[axis] >= first && index[axis] < last) // no ghost
        {
          ASSERT_EQ(noise[n],
            whole[(index[2] * grid.Dimensions[1] + index[1]) * grid.Dimensions[0] + index[0]])
            << "axis " << axis << ", piece " << part;
          ++compared;
        }
      }
    }
    EXPECT_EQ(compared, whole.size());
  }
}

// ---- corners --------------------------------------------------------------------------------------

struct CornerCounts
{
  double Inside = 0.0;
  double Visited = 0.0;
};

/**
 * Corners per sample: those with q < 1 under the window, counted one by one, and those the kernel
 * visits. Every sample stands 16 times in a row, so that all lanes of a register agree and a count is
 * that of the sample, not of its neighbours.
 */
template <int N>
CornerCounts CountCorners(const NoiseParameters& parameters)
{
  constexpr std::size_t copies = 16;
  constexpr std::size_t places = 4000;
  RandomSamples samples(copies * places, 100.0, 0.0, 21);
  CornerCounts counts;
  for (std::size_t place = 0; place < places; ++place)
  {
    for (std::size_t copy = 1; copy < copies; ++copy)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::size_t from = 3 * copies * place + axis;
        samples.Positions[from + 3 * copy] = samples.Positions[from];
        samples.Vectors[from + 3 * copy] = samples.Vectors[from];
      }
    }
    const std::size_t i = copies * place;
    const Matrix<N> G =
      MetricFromVector<N>(parameters, samples.Get<N>(samples.Vectors, i)).ToMatrix();
    const Vector<N> p = samples.GetPosition<N>(i);
    const bool window = parameters.LatticeWindow;
    const int reach =
      window ? parameters.Quality : static_cast<int>(std::ceil(parameters.StreakLength));
    const int side = 2 * reach + 2;
    const int corners = N == 2 ? side * side : side * side * side;
    for (int corner = 0; corner < corners; ++corner)
    {
      Vector<N> v;
      for (int axis = 0, rest = corner; axis < N; ++axis, rest /= side)
      {
        v[axis] = std::floor(p[axis]) + rest % side - reach - p[axis];
      }
      counts.Inside +=
        v.dot(G * v) < 1.0 && (!window || v.cwiseAbs().maxCoeff() < reach + 1) ? 1.0 : 0.0;
    }
  }
  EvaluationCounts found;
  FastNoise<N>(parameters, samples, Steering::Vectors, &found);
  counts.Visited = static_cast<double>(found.VisitedCorners) / static_cast<double>(samples.Count);
  counts.Inside /= places;
  return counts;
}
} // namespace

TEST(SteerableNoise, EqualsTheReferenceInThePlane)
{
  ExpectReferenceAtAllQualities<2>(Normalization::UnitVariance);
  ExpectReferenceAtAllQualities<2>(Normalization::None);
  ExpectReferenceAtAllLengths<2>(Normalization::UnitVariance);
  ExpectReferenceAtAllLengths<2>(Normalization::None);
}

TEST(SteerableNoise, EqualsTheReferenceInSpace)
{
  ExpectReferenceAtAllQualities<3>(Normalization::UnitVariance);
  ExpectReferenceAtAllQualities<3>(Normalization::None);
  ExpectReferenceAtAllLengths<3>(Normalization::UnitVariance);
  ExpectReferenceAtAllLengths<3>(Normalization::None);
}

TEST(SteerableNoise, EqualsTheReferenceDividedByWeights)
{
  // Weights come down to 1e-8, where q is within 1e-3 of 1: its rounding counts a thousandfold.
  constexpr double bound = 1e-5;
  ExpectReferenceAtAllQualities<2>(Normalization::WeightSum, bound);
  ExpectReferenceAtAllQualities<3>(Normalization::WeightSum, bound);
  ExpectReferenceAtAllLengths<2>(Normalization::WeightSum, bound);
  ExpectReferenceAtAllLengths<3>(Normalization::WeightSum, bound);
}

TEST(SteerableNoise, EqualsTheReferenceForVariantsInThePlane)
{
  ExpectReferenceOfVariants<2>();
}

TEST(SteerableNoise, EqualsTheReferenceForVariantsInSpace)
{
  ExpectReferenceOfVariants<3>();
}

TEST(SteerableNoise, EqualsTheReferenceInFlowsAlongAxes)
{
  // There a row, or a layer, has a single s.
  for (int axis = 0; axis < 3; ++axis)
  {
    for (float tilt : { 0.0f, 1e-7f, 1e-5f, 1e-3f })
    {
      for (double extent : { 1000.0, 1.0 })
      {
        RandomSamples samples(150, extent, 0.1);
        for (std::size_t i = 0; i < samples.Vectors.size(); ++i)
        {
          samples.Vectors[i] = static_cast<int>(i % 3) == axis ? -5.0f : 5.0f * tilt;
          samples.Normals[i] = static_cast<int>(i % 3) == (axis + 1) % 3 ? 1.0f : tilt;
        }
        for (bool curved : { false, true })
        {
          NoiseParameters parameters;
          parameters.FollowCurvature = curved;
          // Loose, as many places have weak surflets alone; a lost one shows as 0.1 or so.
          const auto expect = [&](auto dimension, Steering steering)
          {
            constexpr int N = decltype(dimension)::value;
            ExpectReference<N>(
              std::to_string(N) + "D along an axis", parameters, samples, steering, LooseBound);
          };
          expect(std::integral_constant<int, 3>(), Steering::Vectors);
          expect(std::integral_constant<int, 3>(), Steering::Normals);
          if (axis < 2)
          {
            expect(std::integral_constant<int, 2>(), Steering::Vectors);
          }
        }
      }
    }
  }
}

TEST(SteerableNoise, EqualsTheReferenceFarFromTheOrigin)
{
  // Cells beyond 2^32 wrap, fractions keep their precision: positions are double.
  for (double extent : { 1e6, 1e9, 1e11 })
  {
    for (bool period : { false, true })
    {
      for (NoiseParameters parameters : { NoiseParameters(), PaperModel(1) })
      {
        parameters.FollowCurvature = false;
        if (period)
        {
          parameters.Period = { 1000, 999, 77 };
        }
        const RandomSamples samples(parameters.LatticeWindow ? 500 : 100, extent, 0.0);
        ExpectReference<2>("2D far from the origin", parameters, samples, Steering::Vectors);
        ExpectReference<3>("3D far from the origin", parameters, samples, Steering::Vectors);
      }
    }
  }
}

TEST(SteerableNoise, HasTheLevelsOfTheMachine)
{
  const std::vector<std::int64_t> levels = SimdLevels();
  ASSERT_FALSE(levels.empty());
  std::printf("SIMD levels:");
  for (std::int64_t target : levels)
  {
    std::printf(" %s", hwy::TargetName(target));
  }
  std::printf("\n");
  // With and without fused multiply-add the last bits differ: were they all equal, no level would
  // have been forced.
  if (levels.front() == HWY_AVX3 || levels.front() == HWY_AVX2)
  {
    const NoiseParameters parameters;
    const RandomSamples samples(1000, 10.0, 0.1);
    const std::vector<float> best = FastNoise<3>(parameters, samples, Steering::Vectors);
    const SimdLevel level(levels.back());
    EXPECT_NE(FastNoise<3>(parameters, samples, Steering::Vectors), best);
  }
}

TEST(SteerableNoise, EqualsTheReferenceOnImages)
{
  for (NoiseParameters parameters : { NoiseParameters(), PaperModel(0), PaperModel(4) })
  {
    for (bool curved : { false, true })
    {
      for (Normalization normalization : { Normalization::UnitVariance, Normalization::None })
      {
        parameters.FollowCurvature = curved;
        parameters.Normalization = normalization;
        parameters.FeatureSize = 1.5;
        const std::string family = std::string(" image") + (curved ? ", curved" : "");
        const double bound = curved ? CurvedImageBound : Bound;
        ExpectReferenceOfImages<2>(parameters, SmallGrid(2), Swirl, "2D" + family, bound);
        ExpectReferenceOfImages<3>(parameters, SmallGrid(3), Swirl, "3D" + family, bound);
      }
    }
  }
}

TEST(SteerableNoise, EqualsTheReferenceInTheCellsOfImages)
{
  // What needs the corners of the sample's own cell alone: Rice's Fig. 2 a and b, and Perlin's noise.
  for (const bool metric : { false, true })
  {
    for (const Fade fade : { Fade::Cubic, Fade::Quintic })
    {
      for (const GradientSet gradients : { GradientSet::Uniform, GradientSet::Perlin })
      {
        NoiseParameters parameters = PaperModel(0);
        parameters.FollowCurvature = false;
        parameters.Normalization = Normalization::None;
        parameters.FeatureSize = 1.5;
        parameters.AnisotropicWeight = false;
        parameters.MetricInProjection = metric;
        parameters.Fade = fade;
        parameters.GradientSet = gradients;
        ExpectReferenceOfImages<2>(parameters, SmallGrid(2), Swirl, "2D cells", Bound);
        ExpectReferenceOfImages<3>(parameters, SmallGrid(3), Swirl, "3D cells", Bound);
        // Steps of more than a cell have lanes hashed by themselves.
        parameters.FeatureSize = 0.05;
        ExpectReferenceOfImages<2>(parameters, SmallGrid(2), Swirl, "2D cells, far", Bound);
        EvaluationCounts counts;
        const ImageGrid grid = SmallGrid(3);
        ImageNoise(parameters, 3, grid, SampleVectors(grid, Swirl), &counts);
        EXPECT_EQ(counts.VisitedCorners, 8 * grid.GetNumberOfRows() * grid.Dimensions[0]);
      }
    }
  }
}

TEST(SteerableNoise, EqualsTheReferenceOnUnusualImages)
{
  NoiseParameters parameters = PaperModel(2);
  parameters.FeatureSize = 1.5;
  ImageGrid grid = SmallGrid(2);
  // More than a cell per sample, and backwards: the rows of gradients do not serve.
  grid.Spacing = { 2.0, 1.1, 1.0 };
  ExpectReferenceOfImages<2>(parameters, grid, Swirl, "2D image, coarse");
  grid.Spacing = { -0.4, -0.6, 1.0 };
  ExpectReferenceOfImages<2>(parameters, grid, Swirl, "2D image, negative spacing");
  grid = SmallGrid(3);
  grid.Spacing = { 1.9, 1.1, 1.3 };
  ExpectReferenceOfImages<3>(parameters, grid, Swirl, "3D image, coarse");
  // Several patches beside and above each other.
  grid.Spacing = { 0.1, 0.12, 0.11 };
  grid.Dimensions = { 150, 19, 1 };
  ExpectReferenceOfImages<2>(parameters, grid, Swirl, "2D image, wide");
  grid.Dimensions = { 75, 11, 3 };
  ExpectReferenceOfImages<3>(parameters, grid, Swirl, "3D image, wide");
  // A line of samples has no neighbours across.
  grid = SmallGrid(2);
  grid.Dimensions = { 1, 20, 1 };
  ExpectReferenceOfImages<2>(parameters, grid, Swirl, "2D image, one column");
  grid.Dimensions = { 1, 1, 1 };
  ExpectReferenceOfImages<2>(parameters, grid, Swirl, "2D image, one sample");
  grid.Dimensions = { 7, 1, 1 };
  ExpectReferenceOfImages<3>(parameters, grid, Swirl, "3D image, one row");
  // Neighbours that point the other way are the same line.
  grid = SmallGrid(3);
  const VectorFunction flipped = [](const Eigen::Vector3d& p)
  { return Eigen::Vector3d(std::sin(37.0 * (p[0] + p[1] + p[2])) < 0.0 ? -Swirl(p) : Swirl(p)); };
  ExpectReferenceOfImages<3>(parameters, grid, flipped, "3D image, senses mixed");
  // Variants, octaves and periods walk lane by lane.
  for (std::size_t i = 0; i < Variants().size(); ++i)
  {
    for (NoiseParameters changed : { NoiseParameters(), parameters })
    {
      const bool paper = changed.LatticeWindow;
      Variants()[i].Change(changed);
      changed.FeatureSize = 1.5;
      grid = SmallGrid(2);
      grid.Dimensions = { 21, 9, 1 };
      ExpectReferenceOfImages<2>(changed, grid, Swirl,
        std::string("2D image of ") + Variants()[i].Name,
        (paper ? 1.0 : FreeVariantFactor) * Variants()[i].Bound);
    }
  }
  // Oblique axes in space.
  parameters.Lattice = Lattice::Simplicial;
  grid = SmallGrid(3);
  grid.Dimensions = { 9, 5, 3 };
  ExpectReferenceOfImages<3>(parameters, grid, Swirl, "3D image, simplicial", VariantBound);
}

TEST(SteerableNoise, HasTheSameBitsInAnySplitOfPoints)
{
  const RandomSamples samples(1000, 30.0, 0.2, 3);
  for (const NoiseParameters& parameters : ParametersOfSplits())
  {
    const std::vector<float> whole2 = SplitNoise<2>(parameters, samples, {});
    const std::vector<float> whole3 = SplitNoise<3>(parameters, samples, {});
    std::vector<std::size_t> one(samples.Count);
    for (std::size_t i = 0; i < one.size(); ++i)
    {
      one[i] = i;
    }
    for (const std::vector<std::size_t>& cuts : { std::vector<std::size_t>{ 1, 2, 3, 5, 8, 999 },
           { 7, 263, 264, 520 }, { 256, 512, 768 }, { 500 }, one })
    {
      EXPECT_EQ(SplitNoise<2>(parameters, samples, cuts), whole2);
      EXPECT_EQ(SplitNoise<3>(parameters, samples, cuts), whole3);
    }
  }
}

TEST(SteerableNoise, HasTheSameBitsAloneAndAmongItsNeighbours)
{
  // Points along lines through smooth fields share their corners; alone each lists its own. So no corner
  // that matters may be missing from a shared list, however the field bends, turns and jumps.
  constexpr std::size_t length = 80;
  constexpr std::size_t lines = 40;
  RandomSamples samples(length * lines, 30.0, 0.0, 12);
  std::mt19937 random(77);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (std::size_t line = 0; line < lines; ++line)
  {
    const double step = std::pow(10.0, uniform(random)) * 0.1; // cells between points: 0.01 to 1
    const double turn = uniform(random) * std::pow(10.0, uniform(random)); // radians per cell
    const double tilt = uniform(random);
    const double bend = 0.6 * std::abs(uniform(random));
    const double start = 3.0 * uniform(random);
    const std::size_t jump = line % 5 == 0 ? 37 : length;
    const double rough = line % 4 == 1 ? 0.06 : 0.0;
    Eigen::Vector3d direction(uniform(random), uniform(random), uniform(random));
    direction *= step / direction.norm();
    if (line % 3 == 0)
    {
      direction = Eigen::Vector3d(step, 0.0, 0.0);
    }
    const Eigen::Vector3d origin =
      30.0 * Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    for (std::size_t i = 0; i < length; ++i)
    {
      const double angle = start + turn * step * i + (i < jump ? 0.0 : 2.0);
      const Eigen::Vector3d u(std::cos(angle), std::sin(angle), tilt * std::cos(0.7 * angle));
      const Eigen::Vector3d curvature =
        bend * Eigen::Vector3d(-std::sin(angle), std::cos(angle), tilt * std::sin(angle));
      const std::size_t at = 3 * (line * length + i);
      for (int axis = 0; axis < 3; ++axis)
      {
        samples.Positions[at + axis] = origin[axis] + i * direction[axis];
        // Tensors and reversed flows change sense.
        samples.Vectors[at + axis] = static_cast<float>(i % 11 == 3 ? -u[axis] : u[axis]);
        samples.Curvature[at + axis] =
          static_cast<float>((rough > 0.0 ? rough * uniform(random) : curvature[axis]));
      }
    }
  }
  std::vector<std::size_t> one(samples.Count);
  std::iota(one.begin(), one.end(), 0);
  std::vector<NoiseParameters> all = ParametersOfSplits();
  for (NoiseParameters& parameters : all)
  {
    parameters.FeatureSize = 1.0;
  }
  NoiseParameters other = PaperModel(8);
  other.FeatureSize = 1.0;
  all.push_back(other);
  other.FollowCurvature = false;
  all.push_back(other);
  other.Quality = 3;
  other.FollowCurvature = true;
  other.Motion = true;
  other.Phase = 0.3;
  all.push_back(other);
  other.Basis = Basis::Streaks;
  all.push_back(other);
  other.Motion = false;
  other.Lattice = Lattice::Jittered;
  all.push_back(other);
  other.Basis = Basis::Gradient;
  all.push_back(other);
  other.Lattice = Lattice::Simplicial;
  other.Fade = Fade::Wide;
  all.push_back(other);
  // Long and fast ones, of which much reaches far.
  NoiseParameters far;
  far.FeatureSize = 1.0;
  far.StreakLength = 16.0;
  far.EigenvalueSum = 8.0;
  far.Normalization = Normalization::None;
  all.push_back(far);
  far.Motion = true;
  far.Speed = 4.0;
  all.push_back(far);
  far.Motion = false;
  far.FollowCurvature = false;
  far.Basis = Basis::Value;
  far.Lattice = Lattice::Simplicial;
  all.push_back(far);
  for (std::int64_t target : SimdLevels())
  {
    const SimdLevel level(target);
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      SCOPED_TRACE("parameters " + std::to_string(i) + ", " + hwy::TargetName(target));
      EXPECT_EQ(
        CountDifferent(SplitNoise<2>(all[i], samples, one), SplitNoise<2>(all[i], samples, {})), 0);
      EXPECT_EQ(
        CountDifferent(SplitNoise<3>(all[i], samples, one), SplitNoise<3>(all[i], samples, {})), 0);
    }
  }
}

TEST(SteerableNoise, HasTheSameBitsAloneHoweverFarItsNeighboursAre)
{
  // In a constant flow nothing but the distance keeps samples from sharing a list.
  constexpr std::size_t count = 300;
  RandomSamples samples(count, 30.0, 0.0, 4);
  std::vector<std::size_t> one(count);
  std::iota(one.begin(), one.end(), 0);
  for (const double spacing : { 1.0, 3.3, 8.1, 20.0, 57.0, 150.0, 1e5 })
  {
    for (std::size_t i = 0; i < 3 * count; ++i)
    {
      const Eigen::Vector3d u(0.8, 0.36, 0.48);
      samples.Vectors[i] = static_cast<float>(u[i % 3]);
      samples.Positions[i] = static_cast<double>(i / 3) * spacing * u[i % 3];
      samples.Curvature[i] = 0.0f;
    }
    for (NoiseParameters parameters : { NoiseParameters(), PaperModel(8) })
    {
      parameters.FeatureSize = 1.0;
      EXPECT_EQ(CountDifferent(
                  SplitNoise<2>(parameters, samples, one), SplitNoise<2>(parameters, samples, {})),
        0)
        << spacing;
      EXPECT_EQ(CountDifferent(
                  SplitNoise<3>(parameters, samples, one), SplitNoise<3>(parameters, samples, {})),
        0)
        << spacing;
    }
  }
}

TEST(SteerableNoise, HasTheSameBitsInAnyOrderOfPoints)
{
  // Other neighbours in the register, same value.
  const RandomSamples samples(1000, 30.0, 0.2, 4);
  RandomSamples reversed = samples;
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    const std::size_t from = 3 * (samples.Count - 1 - i);
    std::copy_n(samples.Positions.begin() + from, 3, reversed.Positions.begin() + 3 * i);
    std::copy_n(samples.Vectors.begin() + from, 3, reversed.Vectors.begin() + 3 * i);
    std::copy_n(samples.Curvature.begin() + from, 3, reversed.Curvature.begin() + 3 * i);
  }
  for (const NoiseParameters& parameters : ParametersOfSplits())
  {
    std::vector<float> noise = SplitNoise<3>(parameters, reversed, {});
    std::reverse(noise.begin(), noise.end());
    EXPECT_EQ(noise, SplitNoise<3>(parameters, samples, {}));
  }
}

TEST(SteerableNoise, HasTheSameBitsInAnySplitOfRowsAndOnTwoThreads)
{
  for (int dimension : { 2, 3 })
  {
    ImageGrid grid = SmallGrid(dimension);
    grid.Dimensions = { dimension == 2 ? 300 : 50, 40, dimension == 2 ? 1 : 6 };
    const std::vector<float> vectors = SampleVectors(grid, Swirl);
    const ContiguousReader<float, 3> reader(vectors.data());
    Field field;
    field.Vectors = &reader;
    for (const NoiseParameters& parameters : ParametersOfSplits())
    {
      const std::vector<float> whole = ImageNoise(parameters, dimension, grid, vectors);
      const SteerableNoise kernel(parameters, dimension);
      const std::size_t rows = grid.GetNumberOfRows();
      for (std::size_t step : { std::size_t(1), std::size_t(7), rows - 1 })
      {
        std::vector<float> noise(whole.size());
        for (std::size_t row = 0; row < rows; row += step)
        {
          kernel.EvaluateImage(grid, field, row, std::min(rows, row + step), noise.data());
        }
        EXPECT_EQ(noise, whole) << "rows by " << step;
      }
      std::vector<float> noise(whole.size());
      const auto work = [&](std::size_t parity)
      {
        for (std::size_t row = 5 * parity; row < rows; row += 10)
        {
          kernel.EvaluateImage(grid, field, row, std::min(rows, row + 5), noise.data());
        }
      };
      std::thread first(work, 0);
      std::thread second(work, 1);
      first.join();
      second.join();
      EXPECT_EQ(noise, whole) << "two threads";
    }
  }
}

TEST(SteerableNoise, HasTheSameBitsOnPointsOfTwoThreads)
{
  const RandomSamples samples(5000, 30.0, 0.2, 3);
  const ContiguousReader<double, 3> positions(samples.Positions.data());
  const ContiguousReader<float, 3> vectors(samples.Vectors.data());
  Field field;
  field.Vectors = &vectors;
  const NoiseParameters parameters;
  const SteerableNoise kernel(parameters, 3);
  std::vector<float> whole(samples.Count);
  kernel.EvaluatePoints(positions, field, 0, samples.Count, whole.data());
  std::vector<float> noise(samples.Count);
  std::thread first([&] { kernel.EvaluatePoints(positions, field, 0, 2345, noise.data()); });
  std::thread second(
    [&] { kernel.EvaluatePoints(positions, field, 2345, samples.Count, noise.data()); });
  first.join();
  second.join();
  EXPECT_EQ(noise, whole);
}

TEST(SteerableNoise, HasTheSameBitsInPieces)
{
  for (const NoiseParameters& parameters : ParametersOfSplits())
  {
    ExpectPiecesEqualWhole(parameters, 2);
    ExpectPiecesEqualWhole(parameters, 3);
  }
}

TEST(SteerableNoise, HasTheSameStatisticsFarFromTheOrigin)
{
  const auto deviationAt = [](double origin, NoiseParameters parameters)
  {
    ImageGrid grid;
    grid.Origin = { origin, -origin, 0.0 };
    grid.Spacing = { 0.5, 0.5, 1.0 };
    grid.Dimensions = { 640, 640, 1 };
    parameters.FeatureSize = 2.0;
    const std::vector<float> noise = ImageNoise(parameters, 2, grid,
      SampleVectors(grid, [](const Eigen::Vector3d&) { return Eigen::Vector3d(0.8, 0.6, 0.0); }));
    double sum = 0.0;
    double squares = 0.0;
    for (float value : noise)
    {
      sum += value;
      squares += double(value) * value;
    }
    const auto count = static_cast<double>(noise.size());
    EXPECT_LE(std::abs(sum / count), 0.03);
    return std::sqrt(squares / count - sum / count * sum / count);
  };
  for (const NoiseParameters& model : { NoiseParameters(), PaperModel(0), PaperModel(4) })
  {
    const double here = deviationAt(0.0, model);
    for (double origin : { 5e6, -5e6, 1e9 })
    {
      const double there = deviationAt(origin, model);
      std::printf("standard deviation at 0 and at %.0e: %.4f, %.4f\n", origin, here, there);
      EXPECT_NEAR(there / here, 1.0, 0.02) << origin;
    }
  }
}

TEST(SteerableNoise, VisitsTheCornersOfTheEllipsoidOnly)
{
  // With the window, by Quality: lattice points of its cube that the ellipsoid holds, in the plane and in space.
  const std::map<int, std::array<double, 2>> table = { { 0, { 2.1, 3.1 } }, { 2, { 3.9, 5.5 } },
    { 4, { 5.0, 6.9 } }, { 8, { 6.7, 9.0 } } };
  for (const auto& [quality, expected] : table)
  {
    NoiseParameters parameters = PaperModel(quality);
    parameters.FollowCurvature = false;
    const CornerCounts counts[2] = { CountCorners<2>(parameters), CountCorners<3>(parameters) };
    for (int i = 0; i < 2; ++i)
    {
      std::printf("corners per sample in %dD at Quality %d: %.2f inside, %.2f visited\n", i + 2,
        quality, counts[i].Inside, counts[i].Visited);
      EXPECT_NEAR(counts[i].Inside, expected[i], 0.04 * expected[i]) << quality;
      // The walk's slack of 1e-3 in q and in the extent may add a few, never take one.
      EXPECT_GE(counts[i].Visited, counts[i].Inside);
      EXPECT_LE(counts[i].Visited, 1.01 * counts[i].Inside) << quality;
    }
  }
  // Without the window all of the ellipsoid: its area and its volume, in cells.
  NoiseParameters whole;
  whole.FollowCurvature = false;
  const double k = whole.GetAlongEigenvalue();
  const CornerCounts inPlane = CountCorners<2>(whole);
  const CornerCounts inSpace = CountCorners<3>(whole);
  std::printf("corners per sample with the defaults: %.2f in the plane, %.2f in space\n",
    inPlane.Visited, inSpace.Visited);
  EXPECT_NEAR(inPlane.Inside, Pi / std::sqrt(k * VectorEigenvalues(whole, 2).Across), 0.1);
  EXPECT_NEAR(
    inSpace.Inside, 4.0 / 3.0 * Pi / std::sqrt(k) / VectorEigenvalues(whole, 3).Across, 0.2);
  for (const CornerCounts& counts : { inPlane, inSpace })
  {
    EXPECT_GE(counts.Visited, counts.Inside);
    EXPECT_LE(counts.Visited, 1.01 * counts.Inside);
  }
  // Unnormalised Quality 0 takes the corners of the cell as they are.
  NoiseParameters cell = PaperModel(0);
  cell.FollowCurvature = false;
  cell.Normalization = Normalization::None;
  EXPECT_EQ(CountCorners<2>(cell).Visited, 4.0);
  EXPECT_EQ(CountCorners<3>(cell).Visited, 8.0);
}

TEST(SteerableNoise, GivesFiniteNoiseWithoutADirection)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const float bad[6][3] = { { 0, 0, 0 }, { nan, 1, 1 }, { 1, nan, 0 }, { infinity, 0, 0 },
    { 1, -infinity, 2 }, { -0.0f, 0, -0.0f } };
  for (double curvature : { 0.0, 0.3 })
  {
    for (NoiseParameters parameters : { NoiseParameters(), PaperModel(0), PaperModel(4) })
    {
      parameters.FollowCurvature = curvature > 0.0;
      RandomSamples samples(parameters.LatticeWindow ? 600 : 300, 30.0, curvature, 8);
      const std::vector<float> healthy = FastNoise<3>(parameters, samples, Steering::Vectors);
      const std::size_t directionless = samples.Count / 10;
      for (std::size_t i = 0; i < directionless; ++i)
      {
        std::copy_n(bad[i % 6], 3, samples.Vectors.begin() + 3 * 10 * i);
      }
      EvaluationCounts counts;
      const std::vector<float> noise =
        FastNoise<3>(parameters, samples, Steering::Vectors, &counts);
      EXPECT_EQ(counts.Degenerate, directionless);
      EXPECT_EQ(counts.Stagnant, 0u);
      for (std::size_t i = 0; i < samples.Count; ++i)
      {
        ASSERT_TRUE(std::isfinite(noise[i])) << i;
        if (i % 10 != 0)
        {
          ASSERT_EQ(noise[i], healthy[i]) << "a neighbour changed";
        }
      }
      // The isotropic metric, as the reference has it, bent by nothing.
      ExpectReference<3>("3D without a direction", parameters, samples, Steering::Vectors);
      FastNoise<2>(parameters, samples, Steering::Vectors, &counts);
      EXPECT_EQ(counts.Degenerate, directionless);
      ExpectReference<2>("2D without a direction", parameters, samples, Steering::Vectors);
    }
  }
}

namespace
{
/// Noise of metrics of 6 components at the places of the samples.
template <int N>
std::vector<float> NoiseOfMetrics(const NoiseParameters& parameters, const RandomSamples& samples,
  const std::vector<double>& metrics, EvaluationCounts& counts)
{
  const ContiguousReader<double, 3> positions(samples.Positions.data());
  const ContiguousReader<double, 6> reader(metrics.data());
  Field field;
  field.Metrics = &reader;
  std::vector<float> noise(samples.Count);
  counts =
    SteerableNoise(parameters, N).EvaluatePoints(positions, field, 0, samples.Count, noise.data());
  return noise;
}

template <int N>
void ExpectNoiseOfMetrics(NoiseParameters parameters, double least, double most)
{
  parameters.FollowCurvature = false;
  const RandomSamples samples(N == 2 ? 300 : 60, 30.0, 0.0, 17);
  std::vector<double> metrics;
  std::vector<double> slow;
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    // Eigenvalues anywhere between the bounds on the axes of a random tensor.
    const Matrix<N> random = TensorOf<N>(samples.Tensors.data() + 6 * i);
    Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(random);
    Vector<N> lambda;
    for (int axis = 0; axis < N; ++axis)
    {
      const double share = 0.5 + 0.5 * std::sin(7.0 * i + 2.0 * axis);
      lambda[axis] = std::exp(std::log(least) + share * std::log(most / least));
    }
    const Matrix<N> G =
      solver.eigenvectors() * lambda.asDiagonal() * solver.eigenvectors().transpose();
    Matrix<3> full = Matrix<3>::Zero();
    full.topLeftCorner<N, N>() = G;
    metrics.insert(
      metrics.end(), { full(0, 0), full(1, 1), full(2, 2), full(0, 1), full(1, 2), full(0, 2) });
    slow.push_back(SteerableNoiseReference<N>(
      parameters, samples.GetPosition<N>(i), MetricFromMetric<N>(parameters, G, G.norm())));
  }
  EvaluationCounts counts;
  const std::vector<float> noise = NoiseOfMetrics<N>(parameters, samples, metrics, counts);
  EXPECT_LE(LargestDifference(noise, slow), 5e-6) << N << "D, from " << least << " to " << most;
  EXPECT_EQ(counts.Degenerate + counts.Bounded, 0u);
  EXPECT_GT(*std::max_element(slow.begin(), slow.end()), 0.5) << "something to compare";
}

template <int N>
void ExpectTheSameNoiseOfTheirMetrics(Steering steering)
{
  for (NoiseParameters parameters : { NoiseParameters(), PaperModel(0), PaperModel(4) })
  {
    parameters.FollowCurvature = false;
    parameters.Strength = 0.9;
    const RandomSamples samples(N == 2 ? 2000 : 500, 30.0, 0.0, 19);
    std::vector<double> metrics;
    for (std::size_t i = 0; i < samples.Count; ++i)
    {
      Matrix<3> G = Matrix<3>::Zero();
      G.topLeftCorner<N, N>() =
        ReferenceMetric<N>(parameters, samples, i, steering).ToMatrix();
      metrics.insert(metrics.end(), { G(0, 0), G(1, 1), G(2, 2), G(0, 1), G(1, 2), G(0, 2) });
    }
    const std::vector<float> expected = FastNoise<N>(parameters, samples, steering);
    parameters.Strength = 1.0;
    EvaluationCounts counts;
    const std::vector<float> again = NoiseOfMetrics<N>(parameters, samples, metrics, counts);
    double squares = 0.0;
    for (std::size_t i = 0; i < samples.Count; ++i)
    {
      squares += std::pow(double(again[i]) - expected[i], 2) / samples.Count;
    }
    const std::string what =
      std::to_string(N) + "D" + (parameters.LatticeWindow ? ", window" : "");
    // 2.8e-7 to 3.6e-7 with fused products (AVX2), 4.05e-7 without them (SSE4).
    EXPECT_LE(std::sqrt(squares), 5e-7) << what;
    EXPECT_LE(LargestDifference(again, expected), Bound) << what; // floats on both ways
    EXPECT_EQ(counts.Bounded, 0u);
  }
}
} // namespace

TEST(SteerableNoise, TakesAMetricOfTheUsersOwn)
{
  const NoiseParameters free;
  ExpectNoiseOfMetrics<2>(free, 1.0 / 400.0, 16.0);
  ExpectNoiseOfMetrics<2>(free, 0.3, 3.0);
  ExpectNoiseOfMetrics<3>(free, 0.1, 16.0);
  ExpectNoiseOfMetrics<3>(free, 0.3, 3.0);
  ExpectNoiseOfMetrics<2>(PaperModel(4), 1e-3, 16.0);
  ExpectNoiseOfMetrics<3>(PaperModel(1), 1e-3, 16.0);
  NoiseParameters variant;
  variant.Fade = Fade::Cubic;
  variant.Lattice = Lattice::Jittered;
  variant.Octaves = 2;
  ExpectNoiseOfMetrics<2>(variant, 0.1, 4.0);

  // All in one row with others and alone, what is no metric and what is bounded is counted.
  const RandomSamples samples(5, 30.0, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> metrics = { 0.8, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, nan, 1, 1, 0, 0, 0, //
    1e-9, 1, 1, 0, 0, 0, 1, 1e9, 1, 0, 0, 0 };
  EvaluationCounts counts;
  const std::vector<float> noise = NoiseOfMetrics<3>(free, samples, metrics, counts);
  EXPECT_EQ(counts.Degenerate, 2u);
  EXPECT_EQ(counts.Bounded, 2u);
  EXPECT_TRUE(std::all_of(noise.begin(), noise.end(), [](float x) { return std::isfinite(x); }));
}

TEST(SteerableNoise, ItsMetricGivesTheSameNoiseAgain)
{
  ExpectTheSameNoiseOfTheirMetrics<2>(Steering::Vectors);
  ExpectTheSameNoiseOfTheirMetrics<2>(Steering::Tensors);
  ExpectTheSameNoiseOfTheirMetrics<3>(Steering::Vectors);
  ExpectTheSameNoiseOfTheirMetrics<3>(Steering::Normals);
  ExpectTheSameNoiseOfTheirMetrics<3>(Steering::Tensors);
}

TEST(SteerableNoise, TakesLengthStrengthAndSumOfEverySample)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  NoiseParameters weights;
  weights.Normalization = Normalization::WeightSum;
  NoiseParameters cells = PaperModel(0);
  cells.Normalization = Normalization::None;
  NoiseParameters magnitude;
  magnitude.StrengthMode = StrengthMode::Magnitude;
  magnitude.ReferenceMagnitude = 2.0;
  for (NoiseParameters parameters :
    { NoiseParameters(), PaperModel(3), weights, cells, magnitude })
  {
    parameters.FollowCurvature = false;
    for (const Steering steering : { Steering::Vectors, Steering::Normals, Steering::Tensors })
    {
      RandomSamples samples(120, 30.0, 0.0, 23);
      samples.Normals[3] = samples.Normals[4] = samples.Normals[5] = 0.0f; // off the surface
      std::fill_n(samples.Vectors.begin() + 6, 3, 0.0f);                   // without a direction
      std::vector<float> shapes;
      for (std::size_t i = 0; i < samples.Count; ++i)
      {
        const float a = static_cast<float>(i);
        shapes.insert(shapes.end(),
          { 3.0f + 2.9f * std::sin(a), 0.5f + 0.6f * std::sin(2.0f * a), 4.0f + 3.0f * std::sin(3.0f * a) });
      }
      std::fill_n(shapes.begin() + 30, 3, nan); // those of the parameters
      shapes[33] = 1000.0f;                     // its greatest
      std::vector<double> slow;
      for (std::size_t i = 0; i < samples.Count; ++i)
      {
        NoiseParameters own = parameters;
        const auto take = [&](double& value, float given, double least, double most)
        { value = std::isnan(given) ? value : std::clamp<double>(given, least, most); };
        take(own.StreakLength, shapes[3 * i], 1.0, 20.0);
        take(own.Strength, shapes[3 * i + 1], 0.0, 1.0);
        take(own.EigenvalueSum, shapes[3 * i + 2], 2.0,
          own.Normalization == Normalization::WeightSum ? 4.0 : 16.0);
        slow.push_back(SteerableNoiseReference<3>(
          parameters, samples.GetPosition<3>(i), ReferenceMetric<3>(own, samples, i, steering)));
      }
      const ContiguousReader<double, 3> positions(samples.Positions.data());
      const ContiguousReader<float, 3> vectors(samples.Vectors.data());
      const ContiguousReader<float, 3> normals(samples.Normals.data());
      const ContiguousReader<float, 6> tensors(samples.Tensors.data());
      const ContiguousReader<float, 3> shapeReader(shapes.data());
      Field field;
      field.Vectors = steering == Steering::Tensors ? nullptr : &vectors;
      field.Tensors = steering == Steering::Tensors ? &tensors : nullptr;
      field.Normals = steering == Steering::Normals ? &normals : nullptr;
      field.Shapes = &shapeReader;
      std::vector<float> noise(samples.Count);
      SteerableNoise(parameters, 3)
        .EvaluatePoints(positions, field, 0, samples.Count, noise.data());
      EXPECT_LE(LargestDifference(noise, slow),
        parameters.Normalization == Normalization::WeightSum ? 2e-5 : LooseBound)
        << static_cast<int>(steering) << ", Quality " << parameters.Quality;
    }
  }
}

TEST(SteerableNoise, IsIsotropicWhereNothingSteers)
{
  // Zero vectors are isotropic as well, but count as a lack.
  const auto expect = [](const Variant& variant, NoiseParameters parameters)
  {
    variant.Change(parameters);
    if (parameters.Basis == Basis::Streaks)
    {
      return;
    }
    RandomSamples samples(200, 20.0, 0.2, 13);
    std::fill(samples.Vectors.begin(), samples.Vectors.end(), 0.0f);
    const ContiguousReader<double, 3> positions(samples.Positions.data());
    Field field;
    field.Isotropic = true;
    const SteerableNoise kernel(parameters, 3);
    std::vector<float> noise(samples.Count);
    const EvaluationCounts counts =
      kernel.EvaluatePoints(positions, field, 0, samples.Count, noise.data());
    EXPECT_EQ(counts.Degenerate + counts.Stagnant, 0u) << variant.Name;
    parameters.FollowCurvature = false; // which the vectors would have otherwise
    EXPECT_EQ(noise, FastNoise<3>(parameters, samples, Steering::Vectors)) << variant.Name;
    std::vector<double> slow;
    for (std::size_t i = 0; i < 20; ++i)
    {
      slow.push_back(SteerableNoiseReference<3>(
        parameters, samples.GetPosition<3>(i), AxialMetric<3>()));
    }
    noise.resize(20);
    EXPECT_LE(LargestDifference(noise, slow), variant.Bound) << variant.Name;

    // Images: the same rows from zero vectors.
    const ImageGrid grid = SmallGrid(2);
    const std::vector<float> zero(3 * grid.GetNumberOfRows() * grid.Dimensions[0], 0.0f);
    std::vector<float> image(zero.size() / 3);
    SteerableNoise(parameters, 2)
      .EvaluateImage(grid, field, 0, grid.GetNumberOfRows(), image.data());
    EXPECT_EQ(image, ImageNoise(parameters, 2, grid, zero)) << variant.Name;
  };
  for (const Variant& variant : Variants())
  {
    expect(variant, NoiseParameters());
    expect(variant, PaperModel(0));
  }
  // What goes by the vectors does not count.
  const Variant mask = { "MaskThreshold", [](NoiseParameters& p) { p.MaskThreshold = 1.0; } };
  const RandomSamples samples(50, 20.0, 0.0);
  const ContiguousReader<double, 3> positions(samples.Positions.data());
  Field field;
  field.Isotropic = true;
  std::vector<float> plain(50);
  std::vector<float> masked(50);
  NoiseParameters parameters;
  SteerableNoise(parameters, 3).EvaluatePoints(positions, field, 0, 50, plain.data());
  mask.Change(parameters);
  SteerableNoise(parameters, 3).EvaluatePoints(positions, field, 0, 50, masked.data());
  EXPECT_EQ(masked, plain);
}

TEST(SteerableNoise, GivesFiniteNoiseForTensorsWithoutADirection)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float bad[4][6] = { { 0, 0, 0, 0, 0, 0 }, { 3, 3, 3, 0, 0, 0 }, { nan, 1, 2, 3, 4, 5 },
    { 1, 2, 3, std::numeric_limits<float>::infinity(), 4, 5 } };
  RandomSamples samples(200, 30.0, 0.3, 8);
  for (int i = 0; i < 20; ++i)
  {
    std::copy_n(bad[i % 4], 6, samples.Tensors.begin() + 6 * 10 * i);
  }
  const NoiseParameters parameters;
  EvaluationCounts counts;
  const std::vector<float> noise = FastNoise<3>(parameters, samples, Steering::Tensors, &counts);
  EXPECT_EQ(counts.Degenerate, 20u);
  EXPECT_TRUE(std::all_of(noise.begin(), noise.end(), [](float x) { return std::isfinite(x); }));
  ExpectReference<3>("3D without a direction", parameters, samples, Steering::Tensors);
}

TEST(SteerableNoise, GivesFiniteNoiseWithoutADirectionOnImages)
{
  ImageGrid grid = SmallGrid(2);
  std::vector<float> vectors = SampleVectors(grid, Swirl);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::size_t bad[4] = { 0, 60, 61 * 11 + 30, 61 * 23 - 1 }; // corners and the inside
  for (std::size_t i = 0; i < 4; ++i)
  {
    vectors[3 * bad[i]] = i % 2 ? nan : 0.0f;
    vectors[3 * bad[i] + 1] = 0.0f;
  }
  EvaluationCounts counts;
  const std::vector<float> noise = ImageNoise(NoiseParameters(), 2, grid, vectors, &counts);
  EXPECT_EQ(counts.Degenerate, 4u);
  EXPECT_TRUE(std::all_of(noise.begin(), noise.end(), [](float x) { return std::isfinite(x); }));
}

TEST(SteerableNoise, NeighboursWithoutADirectionChangeNoBits)
{
  NoiseParameters parameters = PaperModel(0);
  parameters.FollowCurvature = false;
  parameters.Normalization = Normalization::None;
  RandomSamples samples(600, 30.0, 0.0, 4);
  for (std::size_t i = 0; i < samples.Count; i += 7)
  {
    const float length = i % 2 ? 0.0f : std::numeric_limits<float>::infinity();
    std::fill_n(samples.Vectors.begin() + 3 * i, 3, length);
  }
  std::vector<std::size_t> cuts(samples.Count - 1);
  std::iota(cuts.begin(), cuts.end(), 1);
  EXPECT_EQ(CountDifferent(
              SplitNoise<2>(parameters, samples, {}), SplitNoise<2>(parameters, samples, cuts)),
    0);
  EXPECT_EQ(CountDifferent(
              SplitNoise<3>(parameters, samples, {}), SplitNoise<3>(parameters, samples, cuts)),
    0);
}

TEST(SteerableNoise, TakesVectorsOfAnyLength)
{
  NoiseParameters parameters;
  RandomSamples samples(300, 30.0, 0.1, 8);
  const std::vector<float> noise = FastNoise<3>(parameters, samples, Steering::Vectors);
  for (float scale : { 1e-38f, 1e-30f, 1e-15f, 1e15f, 1e30f, 5e37f })
  {
    RandomSamples scaled = samples;
    for (float& x : scaled.Vectors)
    {
      x *= scale;
    }
    EvaluationCounts counts;
    const std::vector<float> same = FastNoise<3>(parameters, scaled, Steering::Vectors, &counts);
    EXPECT_EQ(counts.Degenerate, 0u) << scale;
    EXPECT_LE(LargestDifference(same, noise), scale < 1e-37f ? 1e-4 : 1e-5) << scale;
  }
  // Nor does it show in images, whose curvature comes from the vectors, or on surfaces.
  const ImageGrid grid = SmallGrid(2);
  const std::vector<float> vectors = SampleVectors(grid, Swirl);
  const std::vector<float> image = ImageNoise(parameters, 2, grid, vectors);
  const std::vector<float> surface = FastNoise<3>(parameters, samples, Steering::Normals);
  for (float scale : { 1e-30f, 1e-14f, 1e-13f, 1e13f, 5e14f, 1e30f })
  {
    std::vector<float> scaled = vectors;
    RandomSamples scaledSamples = samples;
    for (auto* array : { &scaled, &scaledSamples.Vectors })
    {
      for (float& x : *array)
      {
        x *= scale;
      }
    }
    EXPECT_LE(LargestDifference(ImageNoise(parameters, 2, grid, scaled), image), 1e-5) << scale;
    EXPECT_LE(
      LargestDifference(FastNoise<3>(parameters, scaledSamples, Steering::Normals), surface), 1e-5)
      << scale;
  }
  // Denormal numbers have few bits left, so compare with a vector that has as few.
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      samples.Vectors[3 * i + axis] = std::round(10.0f * samples.Vectors[3 * i + axis]) + 0.5f;
    }
  }
  RandomSamples denormal = samples;
  for (float& x : denormal.Vectors)
  {
    x *= 2.0f * std::numeric_limits<float>::denorm_min();
  }
  EvaluationCounts counts;
  EXPECT_LE(LargestDifference(FastNoise<3>(parameters, denormal, Steering::Vectors, &counts),
              FastNoise<3>(parameters, samples, Steering::Vectors)),
    1e-5);
  EXPECT_EQ(counts.Degenerate, 0u);
}

TEST(SteerableNoise, TakesAnyCurvature)
{
  NoiseParameters parameters;
  RandomSamples samples(300, 30.0, 0.1, 8);
  const float bad[5] = { std::numeric_limits<float>::quiet_NaN(),
    std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 1e30f,
    1e-42f };
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    samples.Curvature[3 * i + i % 3] = bad[i % 5];
  }
  for (float value : FastNoise<3>(parameters, samples, Steering::Vectors))
  {
    ASSERT_TRUE(std::isfinite(value));
  }
  // Beyond the clamp but not beyond sense: isotropic, as the reference.
  samples = RandomSamples(300, 30.0, 1e6, 8);
  ExpectReference<3>("3D curvature beyond 1", parameters, samples, Steering::Vectors);
}

TEST(SteerableNoise, TakesPlacesThatAreNotFinite)
{
  for (bool variant : { false, true })
  {
    NoiseParameters parameters;
    parameters.Motion = variant;
    RandomSamples samples(300, 30.0, 0.1, 8);
    const std::vector<float> healthy = FastNoise<3>(parameters, samples, Steering::Vectors);
    const double bad[3] = { std::numeric_limits<double>::quiet_NaN(),
      std::numeric_limits<double>::infinity(), -1e300 };
    for (int i = 0; i < 30; ++i)
    {
      samples.Positions[30 * i + i % 2] = bad[i % 3];
    }
    const std::vector<float> noise = FastNoise<3>(parameters, samples, Steering::Vectors);
    for (std::size_t i = 0; i < samples.Count; ++i)
    {
      if (i % 10 == 0)
      {
        EXPECT_TRUE(std::isfinite(noise[i])) << i;
      }
      else
      {
        EXPECT_EQ(noise[i], healthy[i]) << "a neighbour changed, " << i;
      }
    }
  }
}

TEST(SteerableNoise, MasksStagnantFlow)
{
  NoiseParameters parameters;
  parameters.FollowCurvature = false;
  for (std::int64_t target : SimdLevels())
  {
    const SimdLevel level(target);
    RandomSamples samples(777, 30.0, 0.0, 8);
    samples.Vectors[0] = samples.Vectors[1] = samples.Vectors[2] = 0.0f;
    samples.Vectors[3] = std::numeric_limits<float>::quiet_NaN();
    parameters.MaskThreshold = 0.0;
    const std::vector<float> noise = FastNoise<3>(parameters, samples, Steering::Vectors);
    parameters.MaskThreshold = 1.2;
    EvaluationCounts counts;
    const std::vector<float> masked = FastNoise<3>(parameters, samples, Steering::Vectors, &counts);
    std::size_t stagnant = 0;
    for (std::size_t i = 0; i < samples.Count; ++i)
    {
      // What has no length moves nowhere.
      const double length = samples.Get<3>(samples.Vectors, i).norm();
      const bool expected = !(length > 1.2);
      stagnant += expected;
      ASSERT_EQ(masked[i], expected ? 0.0f : noise[i]) << i;
    }
    EXPECT_EQ(counts.Stagnant, stagnant);
    EXPECT_EQ(counts.Degenerate, 0u) << "counted once, as stagnant";
    EXPECT_GT(stagnant, 50u);
  }
}

TEST(SteerableNoise, LooksAtThePlaneOnlyInThePlane)
{
  const NoiseParameters parameters;
  RandomSamples samples(300, 30.0, 0.2, 8);
  const std::vector<float> noise = FastNoise<2>(parameters, samples, Steering::Vectors);
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    samples.Vectors[3 * i + 2] = std::numeric_limits<float>::quiet_NaN();
    samples.Positions[3 * i + 2] = 1e300;
    samples.Curvature[3 * i + 2] = 1e20f;
  }
  EXPECT_EQ(FastNoise<2>(parameters, samples, Steering::Vectors), noise);
}

TEST(SteerableNoise, InAPlaneTheLengthIsThatOfTheWholeVector)
{
  NoiseParameters parameters;
  parameters.FollowCurvature = false;
  parameters.MaskThreshold = 2.0;
  for (std::int64_t target : SimdLevels())
  {
    const SimdLevel level(target);
    RandomSamples samples(300, 30.0, 0.0, 8);
    // In the plane alone; out of it, longer than the threshold; on it, with a direction that is rounding.
    for (std::size_t i = 0; i < samples.Count; ++i)
    {
      const float vectors[3][3] = { { 1.0f, 0.5f, 0.0f }, { 1.0f, 0.5f, 3.0f }, { 1e-6f, 0.0f, 3.0f } };
      const float tensors[3][6] = { { 1.0f, 0.2f, 0.0f, 0.1f, 0.0f, 0.0f },
        { 1.0f, 0.2f, 0.0f, 0.1f, 1.5f, 0.0f }, { 1.0f, 1.0f, 3.0f, 0.0f, 0.0f, 0.0f } };
      std::copy_n(vectors[i % 3], 3, samples.Vectors.data() + 3 * i);
      std::copy_n(tensors[i % 3], 6, samples.Tensors.data() + 6 * i);
    }
    for (const Steering steering : { Steering::Vectors, Steering::Tensors })
    {
      EvaluationCounts counts;
      const std::vector<float> noise = FastNoise<2>(parameters, samples, steering, &counts);
      EXPECT_EQ(counts.Stagnant, 100u);
      EXPECT_EQ(counts.Degenerate, 100u);
      for (std::size_t i = 0; i < samples.Count; ++i)
      {
        EXPECT_EQ(noise[i] == 0.0f, i % 3 == 0) << i;
      }
    }
  }
}

TEST(SteerableNoise, DoesNotKnowTheSenseOfTheVector)
{
  NoiseParameters parameters;
  RandomSamples samples(300, 30.0, 0.2, 8);
  const std::vector<float> noise = FastNoise<3>(parameters, samples, Steering::Vectors);
  for (float& x : samples.Vectors)
  {
    x = -x;
  }
  EXPECT_LE(LargestDifference(FastNoise<3>(parameters, samples, Steering::Vectors), noise), 1e-6);
}

TEST(SteerableNoise, RefusesWhatItCannotDo)
{
  EXPECT_THROW(SteerableNoise(NoiseParameters(), 1), std::invalid_argument);
  EXPECT_THROW(SteerableNoise(NoiseParameters(), 4), std::invalid_argument);
  NoiseParameters wrong;
  wrong.Quality = 9;
  EXPECT_THROW(SteerableNoise(wrong, 2), std::invalid_argument);
  const float values[6] = { 1, 2, 3, 4, 5, 6 };
  const double place[3] = { 0, 0, 0 };
  const ContiguousReader<float, 3> vectors(values);
  const ContiguousReader<float, 6> tensors(values);
  const ContiguousReader<double, 3> positions(place);
  float noise = 0.0f;
  const SteerableNoise plane(NoiseParameters(), 2);
  const SteerableNoise space(NoiseParameters(), 3);
  Field field;
  EXPECT_THROW(plane.EvaluatePoints(positions, field, 0, 1, &noise), std::invalid_argument);
  NoiseParameters streaks;
  streaks.Basis = Basis::Streaks;
  field.Isotropic = true;
  EXPECT_THROW(SteerableNoise(streaks, 2).EvaluatePoints(positions, field, 0, 1, &noise),
    std::invalid_argument);
  field.Vectors = &vectors;
  EXPECT_THROW(plane.EvaluatePoints(positions, field, 0, 1, &noise), std::invalid_argument);
  field.Isotropic = false;
  const double metric[6] = { 1, 1, 1, 0, 0, 0 };
  const ContiguousReader<double, 6> metrics(metric);
  field.Metrics = &metrics;
  EXPECT_THROW(plane.EvaluatePoints(positions, field, 0, 1, &noise), std::invalid_argument);
  field.Metrics = nullptr;
  field.Tensors = &tensors;
  EXPECT_THROW(plane.EvaluatePoints(positions, field, 0, 1, &noise), std::invalid_argument);
  field.Tensors = nullptr;
  field.Normals = &vectors;
  EXPECT_THROW(plane.EvaluatePoints(positions, field, 0, 1, &noise), std::invalid_argument);
  EXPECT_THROW(space.EvaluateImage(ImageGrid(), field, 0, 1, &noise), std::invalid_argument);
  field.Normals = nullptr;
  EXPECT_NO_THROW(space.EvaluateImage(ImageGrid(), field, 0, 1, &noise));
  EXPECT_NO_THROW(space.EvaluatePoints(positions, field, 0, 0, nullptr)) << "nothing to do";
}

TEST(SteerableNoise, ValidatesItsParameters)
{
  using P = NoiseParameters;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  struct Case
  {
    const char* Name;
    std::function<void(P&)> Change;
  };
  const std::vector<Case> refused = {
    { "FeatureSize", [](P& p) { p.FeatureSize = 0.0; } },
    { "FeatureSize", [](P& p) { p.FeatureSize = -1.0; } },
    { "FeatureSize", [=](P& p) { p.FeatureSize = nan; } },
    { "FeatureSize", [=](P& p) { p.FeatureSize = infinity; } },
    { "StreakLength", [](P& p) { p.StreakLength = 0.99; } },
    { "StreakLength", [](P& p) { p.StreakLength = 20.5; } },
    { "StreakLength", [=](P& p) { p.StreakLength = nan; } },
    { "Quality", [](P& p) { p.Quality = -1; } },
    { "Quality", [](P& p) { p.Quality = 9; } },
    { "MinimumEigenvalue", [](P& p) { p.MinimumEigenvalue = 0.0; } },
    { "MinimumEigenvalue", [](P& p) { p.MinimumEigenvalue = 1.5; } },
    { "MinimumEigenvalue", [=](P& p) { p.MinimumEigenvalue = nan; } },
    { "EigenvalueSum", [](P& p) { p.EigenvalueSum = 1.9; } },
    { "EigenvalueSum", [](P& p) { p.EigenvalueSum = 17.0; } },
    { "EigenvalueSum", [=](P& p) { p.EigenvalueSum = nan; } },
    { "EigenvalueSum",
      [](P& p)
      {
        p.EigenvalueSum = 6.0;
        p.Normalization = Normalization::WeightSum;
      } },
    { "Strength", [](P& p) { p.Strength = -0.1; } },
    { "Strength", [](P& p) { p.Strength = 1.1; } },
    { "Strength", [=](P& p) { p.Strength = nan; } },
    { "ReferenceMagnitude",
      [](P& p)
      {
        p.StrengthMode = StrengthMode::Magnitude;
        p.ReferenceMagnitude = 0.0;
      } },
    { "ReferenceMagnitude",
      [=](P& p)
      {
        p.StrengthMode = StrengthMode::Magnitude;
        p.ReferenceMagnitude = nan;
      } },
    { "MaskThreshold", [](P& p) { p.MaskThreshold = -1.0; } },
    { "MaskThreshold", [=](P& p) { p.MaskThreshold = nan; } },
    { "Density", [](P& p) { p.Density = 0.0; } },
    { "Density", [](P& p) { p.Density = 1.01; } },
    { "Phase", [=](P& p) { p.Phase = nan; } },
    { "Phase", [=](P& p) { p.Phase = infinity; } },
    { "Speed", [](P& p) { p.Speed = 4.1; } },
    { "Speed", [](P& p) { p.Speed = -5.0; } },
    { "Speed", [=](P& p) { p.Speed = nan; } },
    { "Octaves", [](P& p) { p.Octaves = 0; } },
    { "Octaves", [](P& p) { p.Octaves = 17; } },
    { "Lacunarity", [](P& p) { p.Lacunarity = 0.5; } },
    { "Lacunarity", [](P& p) { p.Lacunarity = 9.0; } },
    { "Gain", [](P& p) { p.Gain = -0.1; } },
    { "Gain", [](P& p) { p.Gain = 1.1; } },
    { "Period", [](P& p) { p.Period[0] = -1; } },
    { "Period", [](P& p) { p.Period[2] = -5; } },
    { "Period",
      [](P& p)
      {
        p.Period[1] = 4;
        p.Lattice = Lattice::Simplicial;
      } },
    { "Period", // 2^10 cells, times 8^15 in the last octave: more than an index holds
      [](P& p)
      {
        p.Period[0] = 1024;
        p.Octaves = 16;
        p.Lacunarity = 8.0;
      } },
    { "LatticeWindow", // surflets without any bound
      [](P& p)
      {
        p.LatticeWindow = false;
        p.AnisotropicWeight = false;
      } },
    { "Lacunarity",
      [](P& p)
      {
        p.Period[1] = 4;
        p.Octaves = 2;
        p.Lacunarity = 2.5;
      } },
  };
  for (const Case& wrong : refused)
  {
    P parameters;
    wrong.Change(parameters);
    try
    {
      parameters.Validate();
      ADD_FAILURE() << wrong.Name << " was accepted";
    }
    catch (const std::invalid_argument& error)
    {
      EXPECT_NE(std::string(error.what()).find(wrong.Name), std::string::npos) << error.what();
    }
    EXPECT_THROW(SteerableNoise(parameters, 2), std::invalid_argument);
  }
  EXPECT_NO_THROW(P().Validate());
  // The ends of the ranges belong to them.
  const std::vector<std::function<void(P&)>> accepted = { [](P& p) { p.Quality = 0; },
    [](P& p) { p.StreakLength = 1.0; }, [](P& p) { p.StreakLength = 20.0; },
    [](P& p) { p.Quality = 8; }, [](P& p) { p.MinimumEigenvalue = 1.0; },
    [](P& p) { p.EigenvalueSum = 2.0; }, [](P& p) { p.EigenvalueSum = 16.0; },
    [](P& p) { p.Strength = 0.0; }, [](P& p) { p.Density = 1.0; }, [](P& p) { p.Speed = -4.0; },
    [](P& p) { p.Phase = -123.0; }, [](P& p) { p.Octaves = 16; }, [](P& p) { p.Gain = 0.0; },
    [](P& p) { p.Lacunarity = 1.0; },
    [](P& p) {
      p.Period = { 1, 1, 1 };
    },
    [](P& p) { p.Normalization = Normalization::WeightSum; } };
  for (const auto& change : accepted)
  {
    P parameters;
    change(parameters);
    EXPECT_NO_THROW(parameters.Validate());
  }
}
