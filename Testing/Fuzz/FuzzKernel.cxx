// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Any parameters on any samples: std::invalid_argument, or finite noise.
#include "FuzzBytes.h"
#include "SteerableNoise.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <vector>

using namespace steerable;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  FuzzBytes bytes(data, size);
  NoiseParameters p;
  p.FeatureSize = bytes.TakeNumber();
  p.StreakLength = bytes.TakeBool() ? 6.0 : bytes.TakeNumber();
  p.MinimumEigenvalue = bytes.TakeBool() ? 0.5 : bytes.TakeNumber();
  p.EigenvalueSum = bytes.TakeBool() ? 3.2 : bytes.TakeNumber();
  p.LatticeWindow = bytes.TakeBelow(4) != 0;
  p.AnisotropicWeight = bytes.TakeBelow(4) != 0;
  // Without the weight all corners in the window count, at Quality 8 up to 250 000 for a sample.
  p.Quality = bytes.TakeBelow(p.AnisotropicWeight ? 10 : 2);
  p.Strength = bytes.TakeBool() ? 1.0 : bytes.TakeNumber();
  p.StrengthMode = static_cast<StrengthMode>(bytes.TakeBelow(2));
  p.ReferenceMagnitude = bytes.TakeNumber();
  p.MaskThreshold = bytes.TakeBool() ? 0.0 : bytes.TakeNumber();
  p.FollowCurvature = bytes.TakeBool();
  p.Normalization = static_cast<Normalization>(bytes.TakeBelow(3));
  p.Basis = static_cast<Basis>(bytes.TakeBelow(3));
  p.Density = bytes.TakeBool() ? 0.25 : bytes.TakeNumber();
  p.Motion = bytes.TakeBool();
  p.Phase = bytes.TakeNumber();
  p.Speed = bytes.TakeNumber();
  p.Octaves = 1 + bytes.TakeBelow(3);
  p.Lacunarity = bytes.TakeBool() ? 2.0 : bytes.TakeNumber();
  p.Gain = bytes.TakeBool() ? 0.5 : bytes.TakeNumber();
  p.Turbulence = bytes.TakeBool();
  p.Fade = static_cast<Fade>(bytes.TakeBelow(3));
  p.Falloff = static_cast<Falloff>(bytes.TakeBelow(2));
  p.Lattice = static_cast<Lattice>(bytes.TakeBelow(3));
  p.GradientSet = static_cast<GradientSet>(bytes.TakeBelow(2));
  for (int& cells : p.Period)
  {
    cells = bytes.TakeBool() ? 0 : bytes.Take<std::int16_t>();
  }
  p.Seed = bytes.Take<std::uint32_t>();

  const int dimension = 2 + bytes.TakeBelow(2);
  ImageGrid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.Dimensions[axis] = axis < dimension ? 1 + bytes.TakeBelow(axis == 0 ? 20 : 4) : 1;
    grid.Origin[axis] = bytes.TakeNumber();
    grid.Spacing[axis] = bytes.TakeNumber();
    grid.FirstIndex[axis] = bytes.Take<std::int32_t>();
  }
  const std::size_t count = grid.GetNumberOfRows() * grid.Dimensions[0];
  std::vector<double> positions(3 * count);
  std::vector<float> vectors(3 * count);
  std::vector<float> normals(3 * count);
  std::vector<float> tensors(6 * count);
  std::vector<float> curvature(3 * count);
  for (double& x : positions)
  {
    x = bytes.TakeNumber();
  }
  for (auto* array : { &vectors, &normals, &tensors, &curvature })
  {
    for (float& x : *array)
    {
      x = static_cast<float>(bytes.TakeNumber());
    }
  }
  const ContiguousReader<double, 3> places(positions.data());
  const ContiguousReader<float, 3> vectorReader(vectors.data());
  const ContiguousReader<float, 3> normalReader(normals.data());
  const ContiguousReader<float, 6> tensorReader(tensors.data());
  const ContiguousReader<float, 3> curvatureReader(curvature.data());
  Field field;
  const bool byTensors = bytes.TakeBool();
  field.Vectors = byTensors ? nullptr : &vectorReader;
  field.Tensors = byTensors ? &tensorReader : nullptr;

  std::vector<float> noise(count);
  const auto expectFinite = [&](const char* what)
  {
    for (float value : noise)
    {
      if (!std::isfinite(value))
      {
        std::fprintf(stderr, "%s is not finite\n", what);
        std::abort();
      }
    }
  };
  try
  {
    const SteerableNoise kernel(p, dimension);
    kernel.EvaluateImage(grid, field, 0, grid.GetNumberOfRows(), noise.data());
    expectFinite("noise of an image");
    field.Curvature = bytes.TakeBool() ? &curvatureReader : nullptr;
    field.Normals = dimension == 3 && !byTensors && bytes.TakeBool() ? &normalReader : nullptr;
    kernel.EvaluatePoints(places, field, 0, count, noise.data());
    expectFinite("noise of points");
  }
  catch (const std::invalid_argument&)
  {
  }
  return 0;
}
