// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Evaluations shared by the kernel's tests: random samples, whole images, and the reference.
#ifndef KernelTestHelpers_h
#define KernelTestHelpers_h

#include "MetricTensor.h"
#include "SimdLevels.h"
#include "SteerableNoise.h"
#include "SteerableNoiseReference.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace steerable
{
namespace testing
{
/// Rice's own model as he has it: the window over the lattice's axes, a trace of 4, and Quality.
inline NoiseParameters PaperModel(int quality = 4)
{
  NoiseParameters parameters;
  parameters.LatticeWindow = true;
  parameters.EigenvalueSum = 4.0;
  parameters.Quality = quality;
  return parameters;
}

/// Samples at random places with random vectors, normals, tensors and curvatures.
struct RandomSamples
{
  std::vector<double> Positions;
  std::vector<float> Vectors;
  std::vector<float> Normals;
  std::vector<float> Tensors;
  std::vector<float> Curvature;
  std::size_t Count;

  RandomSamples(std::size_t count, double extent, double curvature, unsigned seed = 1)
    : Positions(3 * count)
    , Vectors(3 * count)
    , Normals(3 * count)
    , Tensors(6 * count)
    , Curvature(3 * count)
    , Count(count)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-extent, extent);
    std::normal_distribution<float> normal;
    for (double& x : this->Positions)
    {
      x = place(random);
    }
    for (auto* array : { &this->Vectors, &this->Normals, &this->Tensors })
    {
      for (float& x : *array)
      {
        x = normal(random);
      }
    }
    for (float& x : this->Curvature)
    {
      x = static_cast<float>(curvature) * normal(random);
    }
  }

  template <int N>
  Vector<N> Get(const std::vector<float>& array, std::size_t i) const
  {
    return Eigen::Map<const Eigen::Vector3f>(array.data() + 3 * i).cast<double>().eval().head<N>();
  }
  template <int N>
  Vector<N> GetPosition(std::size_t i) const
  {
    return Eigen::Map<const Eigen::Vector3d>(this->Positions.data() + 3 * i).head<N>();
  }
};

enum class Steering
{
  Vectors,
  Normals,
  Tensors
};

template <int N>
AxialMetric<N> ReferenceMetric(
  const NoiseParameters& parameters, const RandomSamples& samples, std::size_t i, Steering steering)
{
  if (steering == Steering::Tensors)
  {
    const float* t = samples.Tensors.data() + 6 * i;
    Matrix<3> full;
    full << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    return MetricFromTensor<N>(parameters, full.topLeftCorner<N, N>(), full.norm());
  }
  if constexpr (N == 3)
  {
    if (steering == Steering::Normals)
    {
      return MetricFromSurfaceVector(
        parameters, samples.Get<3>(samples.Vectors, i), samples.Get<3>(samples.Normals, i));
    }
  }
  // In 2D a vector keeps its length where it leaves the plane.
  return MetricFromVector<N>(parameters, samples.Get<N>(samples.Vectors, i),
    samples.Get<3>(samples.Vectors, i).norm());
}

/// Noise of all samples through the fast path.
template <int N>
std::vector<float> FastNoise(const NoiseParameters& parameters, const RandomSamples& samples,
  Steering steering, EvaluationCounts* counts = nullptr)
{
  const ContiguousReader<double, 3> positions(samples.Positions.data());
  const ContiguousReader<float, 3> vectors(samples.Vectors.data());
  const ContiguousReader<float, 3> normals(samples.Normals.data());
  const ContiguousReader<float, 6> tensors(samples.Tensors.data());
  const ContiguousReader<float, 3> curvature(samples.Curvature.data());
  Field field;
  field.Vectors = steering == Steering::Tensors ? nullptr : &vectors;
  field.Tensors = steering == Steering::Tensors ? &tensors : nullptr;
  field.Normals = steering == Steering::Normals ? &normals : nullptr;
  field.Curvature = parameters.FollowCurvature ? &curvature : nullptr;
  std::vector<float> noise(samples.Count);
  const EvaluationCounts found =
    SteerableNoise(parameters, N).EvaluatePoints(positions, field, 0, samples.Count, noise.data());
  if (counts)
  {
    *counts = found;
  }
  return noise;
}

/// The same through the reference.
template <int N>
std::vector<double> SlowNoise(
  const NoiseParameters& parameters, const RandomSamples& samples, Steering steering)
{
  std::vector<double> noise(samples.Count);
  for (std::size_t i = 0; i < samples.Count; ++i)
  {
    const Vector<N> curvature = parameters.FollowCurvature ? samples.Get<N>(samples.Curvature, i)
                                                           : Vector<N>(Vector<N>::Zero());
    noise[i] = SteerableNoiseReference<N>(parameters, samples.GetPosition<N>(i),
      ReferenceMetric<N>(parameters, samples, i, steering), curvature);
  }
  return noise;
}

/// Largest |a - b|; a NaN stays.
template <typename A, typename B>
double LargestDifference(const std::vector<A>& a, const std::vector<B>& b)
{
  double largest = a.size() == b.size() ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
  {
    const double difference = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    largest = difference <= largest ? largest : difference;
  }
  return largest;
}

template <int N>
double LargestDifference(
  const NoiseParameters& parameters, const RandomSamples& samples, Steering steering)
{
  return LargestDifference(
    FastNoise<N>(parameters, samples, steering), SlowNoise<N>(parameters, samples, steering));
}

/// Noise of an image whose vectors are a function of the world place of a sample.
using VectorFunction = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

inline std::vector<float> SampleVectors(const ImageGrid& grid, const VectorFunction& function)
{
  std::vector<float> vectors;
  for (std::int64_t k = 0; k < grid.Dimensions[2]; ++k)
  {
    for (std::int64_t j = 0; j < grid.Dimensions[1]; ++j)
    {
      for (std::int64_t i = 0; i < grid.Dimensions[0]; ++i)
      {
        const Eigen::Vector3d place(grid.Origin[0] + (grid.FirstIndex[0] + i) * grid.Spacing[0],
          grid.Origin[1] + (grid.FirstIndex[1] + j) * grid.Spacing[1],
          grid.Origin[2] + (grid.FirstIndex[2] + k) * grid.Spacing[2]);
        const Eigen::Vector3d v = function(place);
        vectors.insert(vectors.end(), { float(v[0]), float(v[1]), float(v[2]) });
      }
    }
  }
  return vectors;
}

inline std::vector<float> ImageNoise(const NoiseParameters& parameters, int dimension,
  const ImageGrid& grid, const std::vector<float>& vectors, EvaluationCounts* counts = nullptr)
{
  const ContiguousReader<float, 3> reader(vectors.data());
  Field field;
  field.Vectors = &reader;
  std::vector<float> noise(vectors.size() / 3);
  const EvaluationCounts found =
    SteerableNoise(parameters, dimension)
      .EvaluateImage(grid, field, 0, grid.GetNumberOfRows(), noise.data());
  if (counts)
  {
    *counts = found;
  }
  return noise;
}
} // namespace testing
} // namespace steerable

#endif
