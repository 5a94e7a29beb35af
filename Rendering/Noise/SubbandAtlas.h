// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The tiles of subband noise in one image of four components, for a texture (private).
 *
 * Bilinear lookups want 16 texels to a wave at the centre of a band for an error of 2 %. So scale j has
 * 2^(1-j) times the texels of the filter's tiles along each side, and all scales together 4/3 of the finest one's. Cubic lookups
 * read the filter's own tiles. Tiles for bilinear lookups have a border of one texel, which repeats the other side.
 */
#ifndef SubbandAtlas_h
#define SubbandAtlas_h

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace noise
{
struct SubbandVariant;

class SubbandAtlas
{
public:
  /// Makes the image if another one is asked for; returns whether it is another one. `firstPlane`: of the planar
  /// projections' tiles, 0 or, beside a texture's, 1.
  bool Update(const SubbandVariant& variant, std::uint32_t seed, double phase, int firstPlane);

  int GetWidth() const { return this->Width; }
  int GetHeight() const { return this->Height; }
  /// Of the variant's kind: 4 components a texel.
  const std::vector<std::uint8_t>& GetBytes() const { return this->Bytes; }
  const std::vector<float>& GetFloats() const { return this->Floats; }
  /// Where the tile of each layer is, as TileAt of the shader wants it: 4 values. It depends on the variant alone.
  const std::vector<float>& GetTiles() const { return this->Tiles; }

  /// Bytes of a band of this scale reach to plus and minus this, four standard deviations.
  static double RangeOf(const SubbandVariant& variant, int scale);

private:
  struct Tile
  {
    int Scales, Scale, Group, Plane;
    int Side; // with the border
    int X, Y;
  };
  void Lay(const SubbandVariant& variant, int firstPlane);
  const std::vector<float>& GetScale(
    const SubbandVariant& variant, std::uint32_t seed, const Tile& tile, int size, int realization);

  std::vector<Tile> Layout;
  int Width = 0;
  int Height = 0;
  std::vector<float> Floats;
  std::vector<std::uint8_t> Bytes;
  std::vector<float> Tiles;
  std::vector<double> Key;
  /// By scales of the pyramid, scale and realization.
  std::map<std::tuple<int, int, int>, std::vector<float>> Made;
  std::vector<double> MadeKey;
};
} // namespace noise

#endif
