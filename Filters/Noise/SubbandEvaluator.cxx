// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandEvaluator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace noise
{
namespace
{
// Octaves whose weights are kept; finer ones fade on most meshes, and each takes four bytes a band.
constexpr std::size_t MostKeptOctaves = 4;
} // namespace

//------------------------------------------------------------------------------
SubbandPointCounts SubbandEvaluator::Evaluate(
  const SubbandEvaluation& surface, std::size_t begin, std::size_t end) const
{
  SubbandPointCounts counts;
  SubbandChunk own;
  for (std::size_t c = begin; c < end; ++c)
  {
    SubbandChunk& chunk = surface.Kept ? (*surface.Kept)[c] : own;
    const vtkIdType first = static_cast<vtkIdType>(c) * SubbandChunkSize;
    const vtkIdType last = std::min(first + SubbandChunkSize, surface.Points);
    if (!surface.ArePointsKnown)
    {
      counts += this->Weights.FindPoints(
        *surface.Surface, surface.Vectors, surface.Ghosts, first, last, chunk);
    }
    for (std::size_t which = 0; which < chunk.Planes.size(); ++which)
    {
      this->Weights.Weigh(chunk.Planes[which], which, first);
    }
    this->CopyWeights(chunk.Planes, first);
    if (this->Noise)
    {
      this->SumOctaves(chunk.Planes, first, last - first);
    }
    if (this->Distortion)
    {
      std::copy(chunk.Distortion.begin(), chunk.Distortion.end(), this->Distortion + first);
    }
    for (SubbandPlanePoints& plane : chunk.Planes)
    {
      plane.Weights.resize(std::min(plane.Weights.size(), MostKeptOctaves));
    }
  }
  return counts;
}

//------------------------------------------------------------------------------
void SubbandEvaluator::CopyWeights(
  const std::vector<SubbandPlanePoints>& planes, vtkIdType first) const
{
  const vtkIdType tuple = this->Weights.GetFirstComponent(planes.size());
  for (std::size_t which = 0; this->WeightArray && which < planes.size(); ++which)
  {
    const SubbandPlanePoints& plane = planes[which];
    const int components = this->Weights.Lookups[which].Tiles->Components();
    float* own = this->WeightArray + first * tuple + this->Weights.GetFirstComponent(which);
    for (std::size_t n = 0; n < plane.Points.size(); ++n)
    {
      std::copy_n(
        plane.Weights[0].data() + n * components, components, own + plane.Points[n] * tuple);
    }
  }
}

//------------------------------------------------------------------------------
void SubbandEvaluator::SumOctaves(
  const std::vector<SubbandPlanePoints>& planes, vtkIdType first, vtkIdType count) const
{
  std::vector<double> uv;
  std::vector<float> values;
  std::array<float, SubbandChunkSize> sum{};
  double amplitude = 1.0;
  for (int octave = 0; octave < this->Weights.Octaves; ++octave, amplitude *= this->Persistence)
  {
    const double scale = std::ldexp(1.0, octave);
    // Without a shift octaves would be copies of each other.
    const std::array<double, 2> shift =
      octave == 0 ? std::array<double, 2>{} : steerable::TileOffset(octave, this->Seed);
    std::array<float, SubbandChunkSize> noise{};
    for (std::size_t which = 0; which < planes.size(); ++which)
    {
      const SubbandPlanePoints& plane = planes[which];
      const steerable::SubbandTiles& tiles = *this->Weights.Lookups[which].Tiles;
      const std::vector<float>& weights =
        plane.Weights[std::min<std::size_t>(octave, this->Weights.GetWeightedOctaves() - 1)];
      const std::size_t points = plane.Points.size();
      uv.resize(2 * points);
      values.resize(points);
      for (std::size_t n = 0; n < points; ++n)
      {
        uv[2 * n] = scale * plane.Texture[n][0] + shift[0];
        uv[2 * n + 1] = scale * plane.Texture[n][1] + shift[1];
      }
      steerable::SumSubbands(
        tiles, steerable::TileLookup::CatmullRom, points, uv.data(), weights.data(), values.data());
      for (std::size_t n = 0; n < points; ++n)
      {
        noise[plane.Points[n]] += values[n];
      }
    }
    for (vtkIdType n = 0; n < count; ++n)
    {
      const float value = this->Turbulence ? std::abs(noise[n]) : noise[n];
      sum[n] += static_cast<float>(amplitude) * value;
    }
  }
  std::copy_n(sum.begin(), count, this->Noise + first);
}
} // namespace noise
