// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How tiles are laid on surfaces (private to this module): what all blocks with the same
 * parameterization share, so that noise goes on from one to the next.
 */
#ifndef SubbandLayout_h
#define SubbandLayout_h

#include "Subband/SubbandFilters.h"

namespace noise
{
struct SurfaceSums;

struct SubbandLayout
{
  /// With as many scales as the surfaces need.
  steerable::SubbandParameters Pyramid;
  double Repeats = 1.0;    ///< Of the tile for one repeat of the texture, or for a world unit.
  double FixedScale = 0.0; ///< Of noise that ignores the mapping.
};

/// Wavelengths in world units: what the property says, and the least and the greatest where an
/// array does.
struct WavelengthRange
{
  double Usual = 1.0;
  double Shortest = 1.0;
  double Longest = 1.0;
};

/// Linear interpolation between points wants this many of them in a wavelength.
constexpr double PointsPerWavelength = 8.0;

/// Octaves that texture coordinates may be stretched beyond the tiles' scales at a place.
constexpr double ClampedOctaves = 0.05;

/**
 * Tiles for texture coordinates: the fewest scales, and the fewest repeats, with which all but a
 * little of the surface finds its wavelengths in the pyramid; else the repeats that miss it by
 * least. Only whole repeats keep the texture's seams, so a tile is spread over several repeats of a
 * texture only where that is much too fine. `diagonal`: of the bounds that `sums` were taken with.
 * `anisotropy`: the most that steers.
 */
SubbandLayout LayOnTexture(steerable::SubbandParameters pyramid, const SurfaceSums& sums,
  double diagonal, const WavelengthRange& wavelengths, double anisotropy);

/**
 * Tiles for planar projections, which shorten features up to 4:1 where they fade out and 2:1 where
 * they show. The longest feature takes the coarsest scale.
 */
SubbandLayout LayOnPlanes(
  steerable::SubbandParameters pyramid, const WavelengthRange& wavelengths, double anisotropy);
} // namespace noise

#endif
