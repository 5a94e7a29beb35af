// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandLayout.h"

#include "SubbandSurface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noise
{
namespace
{
// How far texture coordinates may be stretched beyond the tiles' scales on average.
constexpr double MeanOctavesOutside = 0.002;
// Missing the tiles' scales by so much on average is worse than seams.
constexpr double FarOctavesOutside = 0.25;

/// The value that half of a histogram's area is below.
double Median(const double* histogram)
{
  double total = 0.0;
  for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
  {
    total += histogram[bin];
  }
  double below = 0.0;
  for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
  {
    below += histogram[bin];
    if (2.0 * below >= total)
    {
      return SurfaceSums::OctavesOf(bin);
    }
  }
  return 0.0;
}
} // namespace

SubbandLayout LayOnTexture(steerable::SubbandParameters pyramid, const SurfaceSums& sums,
  double diagonal, const WavelengthRange& wavelengths, double anisotropy)
{
  // Scale of the wanted noise at a singular value of 2^octaves repeats per diagonal.
  const double center = std::log2(wavelengths.Usual / diagonal * pyramid.CenterFrequency());
  const double shorter = std::log2(wavelengths.Usual / wavelengths.Shortest);
  const double longer = std::log2(wavelengths.Longest / wavelengths.Usual);
  const double steering = 0.5 * std::log2(anisotropy);
  const auto octavesOutside = [&](double repeats, int scales)
  {
    const double shift = center + std::log2(repeats);
    double sum = 0.0;
    double total = 0.0;
    for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
    {
      const double scale = SurfaceSums::OctavesOf(bin) + shift;
      const double below = steering + shorter - scale;
      const double above = scale + steering + longer - (scales - 1);
      total += sums.Smaller()[bin];
      sum += sums.Smaller()[bin] * (below > ClampedOctaves ? below : 0.0);
      sum += sums.Larger()[bin] * (above > ClampedOctaves ? above : 0.0);
    }
    return total > 0.0 ? sum / total : 0.0;
  };

  SubbandLayout layout;
  const int most = pyramid.MostScales();
  double best = std::numeric_limits<double>::infinity();
  const auto tryRepeats = [&](double repeats, int scales)
  {
    const double outside = octavesOutside(repeats, scales);
    if (outside < best)
    {
      best = outside;
      pyramid.Scales = scales;
      layout.Repeats = repeats;
    }
  };
  for (int scales = std::min(2, most); scales <= most && best > MeanOctavesOutside; ++scales)
  {
    for (int step = 0; step <= 160 && best > MeanOctavesOutside; ++step)
    {
      tryRepeats(std::round(std::exp2(step / 8.0)), scales);
    }
  }
  for (int step = 0; step <= 160 && best > FarOctavesOutside; ++step)
  {
    tryRepeats(1.0 / std::round(std::exp2(step / 8.0)), most);
  }
  layout.Pyramid = pyramid;
  const double mean = 0.5 * (Median(sums.Smaller()) + Median(sums.Larger()));
  layout.FixedScale =
    std::clamp(mean + center + std::log2(layout.Repeats), 0.0, pyramid.Scales - 1.0);
  return layout;
}

SubbandLayout LayOnPlanes(
  steerable::SubbandParameters pyramid, const WavelengthRange& wavelengths, double anisotropy)
{
  const double octaves = std::max(2.0, std::log2(anisotropy) + 1.0) +
    std::log2(wavelengths.Longest / wavelengths.Shortest);
  pyramid.Scales = std::min(static_cast<int>(std::ceil(octaves - 1e-9)) + 1, pyramid.MostScales());
  SubbandLayout layout;
  layout.Pyramid = pyramid;
  const double coarsest = std::ldexp(pyramid.CenterFrequency(), 1 - pyramid.Scales);
  layout.Repeats = 1.0 / (coarsest * wavelengths.Longest * std::sqrt(anisotropy));
  layout.FixedScale =
    std::clamp(std::log2(layout.Repeats * wavelengths.Usual * pyramid.CenterFrequency()), 0.0,
      pyramid.Scales - 1.0);
  return layout;
}
} // namespace noise
