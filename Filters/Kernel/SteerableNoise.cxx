// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SteerableNoise.h"

#include "LatticeHash.h"
#include "MetricTensor.h"
#include "Fast/Stages.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

// Highway includes this file once more for every SIMD level and picks one at run time.
#include "SimdTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "SteerableNoise.cxx"
#include <hwy/foreach_target.h>

#include "Fast/Images-inl.h"
#include "Fast/Points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
EvaluationCounts EvaluateImage2(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<2>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluateImage3(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<3>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluatePoints2(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<2>(setup, positions, field, begin, end, noise);
}

EvaluationCounts EvaluatePoints3(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<3>(setup, positions, field, begin, end, noise);
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace steerable
{
HWY_EXPORT(EvaluateImage2);
HWY_EXPORT(EvaluateImage3);
HWY_EXPORT(EvaluatePoints2);
HWY_EXPORT(EvaluatePoints3);

namespace
{
NoiseSetup MakeSetup(NoiseParameters p, int dimension, const Field& field, bool curved)
{
  if ((field.Vectors != nullptr) + (field.Tensors != nullptr) + (field.Metrics != nullptr) +
      field.Isotropic !=
    1)
  {
    throw std::invalid_argument(
      "The noise needs vectors, tensors, metrics or nothing to steer it, one of them.");
  }
  if (field.Isotropic && p.Basis == Basis::Streaks)
  {
    throw std::invalid_argument("Streaks need a direction: take another Basis, or vectors.");
  }
  if (field.Normals && (dimension != 3 || !field.Vectors))
  {
    throw std::invalid_argument("Normals need vectors in 3D.");
  }

  NoiseSetup setup;
  setup.Isotropic = field.Isotropic;
  // Not where nothing steers noise of any Strength: that has the bits of vectors of 0, which walk.
  const bool weak = p.Strength == 0.0;
  if (field.Isotropic)
  {
    // What goes by the vectors, of which there are none.
    p.Strength = 0.0;
    p.StrengthMode = StrengthMode::Constant;
    p.MaskThreshold = 0.0;
    curved = false;
  }
  setup.Parameters = p;
  double amplitude = 1.0;
  double frequency = 1.0;
  double power = 0.0;
  for (int i = 0; i < p.Octaves; ++i)
  {
    OctaveSetup octave;
    octave.CellsPerUnit = frequency / p.FeatureSize;
    octave.CellSize = static_cast<float>(1.0 / frequency);
    octave.Amplitude = static_cast<float>(amplitude);
    octave.Seed = HashOfSeed(p.Seed + i);
    for (int axis = 0; axis < 3; ++axis)
    {
      octave.Period[axis] = p.Period[axis] * std::llround(frequency);
    }
    setup.Octaves.push_back(octave);
    power += amplitude * amplitude;
    amplitude *= p.Gain;
    frequency *= p.Lacunarity;
  }
  setup.OctaveScale = static_cast<float>(1.0 / std::sqrt(power));

  setup.Support = static_cast<float>(FadeSupport(p.Fade));
  setup.WindowReach =
    p.LatticeWindow ? setup.Support * (p.Quality + 1) : std::numeric_limits<float>::infinity();
  const bool gradients = p.Basis == Basis::Gradient && p.Falloff == Falloff::Separable &&
    p.Lattice == Lattice::Square && !p.Motion;
  const bool plain = gradients && p.Fade == Fade::Quintic &&
    p.GradientSet == GradientSet::Uniform && p.AnisotropicWeight && p.MetricInProjection;
  setup.Variant = !plain;
  // Perlin's own noise, also with a metric in the projection.
  const bool unweighted = gradients && p.Fade != Fade::Wide && !p.AnisotropicWeight;
  setup.Biaxial = dimension == 3 && (field.Tensors || field.Metrics || field.Normals);
  setup.Curved = curved;
  const bool shaped = field.Shapes && !field.Isotropic;
  setup.Ball =
    plain && !curved && !p.LatticeWindow && weak && !shaped && !field.Metrics;
  setup.SingleCell = setup.Ball ||
    (p.Quality == 0 && (plain || unweighted) && p.LatticeWindow && !setup.Biaxial && !curved &&
      p.Normalization == Normalization::None);
  setup.Uniform = setup.SingleCell && !setup.Biaxial && !shaped &&
    p.StrengthMode == StrengthMode::Constant &&
    !(p.MaskThreshold > 0.0) && p.Octaves == 1 && !p.Turbulence;
  setup.CellRounding = setup.SingleCell ? 0.0 : 0.5;
  const bool jittered = p.Lattice == Lattice::Jittered;
  const bool streaks = p.Basis == Basis::Streaks && !jittered;
  setup.JitterDown = streaks ? 0.5f : 0.0f;
  setup.JitterUp = jittered ? 1.0f : setup.JitterDown;
  setup.JitterMiddle = 0.5f * (setup.JitterUp - setup.JitterDown);
  setup.JitterRadius =
    0.5f * (setup.JitterUp + setup.JitterDown) * std::sqrt(static_cast<float>(dimension));
  const Matrix<3> steps3 = LatticeSteps<3>(p.Lattice);
  const Matrix<2> steps2 = LatticeSteps<2>(p.Lattice);
  Matrix<3> steps = Matrix<3>::Identity();
  if (dimension == 2)
  {
    steps.topLeftCorner<2, 2>() = steps2;
  }
  else
  {
    steps = steps3;
  }
  const Matrix<3> indices = steps.inverse();
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      setup.LatticeSteps[i][j] = static_cast<float>(steps(i, j));
      setup.LatticeIndices[i][j] = indices(i, j);
    }
  }
  return setup;
}
} // namespace

SteerableNoise::SteerableNoise(const NoiseParameters& parameters, int dimension)
  : Parameters(parameters)
  , Dimension(dimension)
{
  parameters.Validate();
  if (dimension != 2 && dimension != 3)
  {
    throw std::invalid_argument("The noise has 2 or 3 dimensions.");
  }
}

EvaluationCounts SteerableNoise::EvaluateImage(const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise) const
{
  if (field.Normals || field.Curvature)
  {
    throw std::invalid_argument("An image takes neither normals nor curvature.");
  }
  if (grid.CurvatureStride < 1 || grid.CurvatureStride > ImageGrid::MaximumStride)
  {
    throw std::invalid_argument("CurvatureStride must be from 1 to 16.");
  }
  const NoiseSetup setup =
    MakeSetup(this->Parameters, this->Dimension, field, this->Parameters.FollowCurvature);
  return this->Dimension == 2
    ? HWY_DYNAMIC_DISPATCH(EvaluateImage2)(setup, grid, field, rowBegin, rowEnd, noise)
    : HWY_DYNAMIC_DISPATCH(EvaluateImage3)(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts SteerableNoise::EvaluatePoints(const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise) const
{
  const NoiseSetup setup = MakeSetup(this->Parameters, this->Dimension, field,
    this->Parameters.FollowCurvature && field.Curvature != nullptr);
  return this->Dimension == 2
    ? HWY_DYNAMIC_DISPATCH(EvaluatePoints2)(setup, positions, field, begin, end, noise)
    : HWY_DYNAMIC_DISPATCH(EvaluatePoints3)(setup, positions, field, begin, end, noise);
}
} // namespace steerable
#endif
