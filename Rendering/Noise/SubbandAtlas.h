// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The tiles of subband noise in one image of four components, for a texture (private).
 *
 * Scale j has 2^-j times the texels of the filter's tiles along each side, 8 to a wave at the
 * centre of a band, and all scales together 4/3 of the finest one's. Texels are such that bilinear
 * lookups are closest to the noise, 4 % off. These tiles have a border of one texel, which repeats
 * the other side. Cubic lookups read the filter's own tiles.
 */
#ifndef SubbandAtlas_h
#define SubbandAtlas_h

#include "SubbandShader.h"

#include "vtkType.h"

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace noise
{
class SubbandAtlas
{
public:
  /// What images are asked for. `firstPlane`: of the planar projections' tiles, 0 or, beside a
  /// texture's, 1.
  void Update(const SubbandVariant& variant, std::uint32_t seed, int firstPlane);

  /// Another number for other images.
  int GetVersion() const { return this->Version; }

  int GetWidth() const { return this->Width; }
  int GetHeight() const { return this->Height; }
  vtkIdType GetBytes() const;

  /// 4 components a texel, of the variant's kind.
  struct Image
  {
    std::vector<std::uint8_t> Bytes;
    std::vector<float> Floats;
  };
  /// The four realizations of LoopWeights, each times its weight.
  Image Make(const std::array<double, 4>& weights);

  /// Where the tile of each layer is, as TileAt of the shader wants it: 4 values. It depends on the variant alone.
  const std::vector<float>& GetTiles() const { return this->Tiles; }

  /// Bytes of a band of this scale reach to plus and minus this, four standard deviations.
  static double RangeOf(const SubbandVariant& variant, int scale);

private:
  struct Tile
  {
    int Scale, Group, Plane;
    int Side; // with the border
    int X, Y;
  };
  void Lay();
  /// Size, scale and realization.
  using ScaleKey = std::tuple<int, int, int>;
  ScaleKey GetKey(const Tile& tile, int m) const;
  /// Makes what is missing of the realizations that count.
  void MakeScales(const std::array<double, 4>& weights);

  SubbandVariant Variant;
  std::uint32_t Seed = 0;
  int FirstPlane = 0;
  int Version = 0;

  std::vector<Tile> Layout;
  int Width = 0;
  int Height = 0;
  std::vector<float> Tiles;
  std::vector<double> Key;
  std::map<ScaleKey, std::vector<float>> Made;
  std::vector<double> MadeKey;
};
} // namespace noise

#endif
