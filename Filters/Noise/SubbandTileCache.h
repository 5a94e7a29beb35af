// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Tiles that points are looked up in, kept while what they are made from stands (private to this
 * module).
 */
#ifndef SubbandTileCache_h
#define SubbandTileCache_h

#include "Subband/SubbandTiles.h"

#include "vtkType.h"

#include <array>
#include <map>
#include <vector>

class vtkImageData;

namespace noise
{
/// Tiles of noise for one layout.
class SubbandTileCache
{
public:
  /**
   * One blend of tiles for each plane, at this phase of the loop. Planes are counted from `first`,
   * always the same one of a cache: others are independent noise. Throws std::invalid_argument for
   * parameters out of range.
   */
  const std::vector<steerable::SubbandTiles>& Update(
    const steerable::SubbandParameters& pyramid, double phase, int planes, int first = 0);

private:
  void MakeRealizations(
    const steerable::SubbandParameters& pyramid, const std::vector<int>& needed);

  std::array<double, 5> Key = {}; // of the pyramid
  double Phase = -1.0;
  std::map<int, steerable::SubbandTiles> Realizations;
  std::vector<steerable::SubbandTiles> Planes;
};

/// The tiles that an image of bands holds, made by vtkImageSubbandDecomposition or
/// vtkImageSubbandNoiseSource.
class SubbandImageTiles
{
public:
  /// Read anew only for another image or a changed one. Throws std::invalid_argument where it has
  /// no bands.
  const steerable::SubbandTiles& Update(vtkImageData* image);

private:
  const vtkImageData* Image = nullptr; // only compared
  vtkMTimeType Time = 0;
  steerable::SubbandTiles Tiles;
};
} // namespace noise

#endif
