// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Subband noise of a fragment (Goldberg, Zwicker, Durand 2008, sections 4 and 5): the sum of bands, looked up in tiles at
// texture coordinates, times the weights of the vertices, times what the footprint of the pixel lets through.
//
// A layer is four bands of neighbouring directions at one scale. Tiles lie in one texture. The mapper defines before this
// text as its options ask NOISE_BYTES (tiles hold 0 to 1, 0.5 is 0) and NOISE_CUBIC (16 texels with Catmull-Rom weights, as
// the filter has it; else bilinear). After it come the functions that add up the layers of each set of tiles.
//
// A layer costs one bilinear lookup (16 texels with NOISE_CUBIC), antialiasing two exponentials of four values for each
// set of tiles and 15 operations a layer.

uniform sampler2D noiseTiles;
uniform int noiseTaps; // 4: what a compiler does not know it does not unroll, which takes seconds for many layers

/// The four bands of a layer at a place in the tile, in [0, 1). `tile`: where texel (0, 0) is in the texture, and the
/// size of the tile; in texels with NOISE_CUBIC, in textures without.
vec4 TileAt(vec4 tile, vec2 place)
{
#ifdef NOISE_CUBIC
  ivec2 size = ivec2(tile.zw);
  vec2 texel = place * tile.zw;
  vec2 t = fract(texel);
  ivec2 corner = ivec2(texel - t) - 1 + size;
  // Catmull-Rom.
  vec2 w[4] = vec2[4](((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
    ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t);
  vec4 bands = vec4(0.0);
  for (int y = 0; y < noiseTaps; ++y)
  {
    vec4 row = vec4(0.0);
    for (int x = 0; x < noiseTaps; ++x)
    {
      row += w[x].x * texelFetch(noiseTiles, ivec2(tile.xy) + (corner + ivec2(x, y)) % size, 0);
    }
    bands += w[y].y * row;
  }
#else
  vec4 bands = textureLod(noiseTiles, tile.xy + place * tile.zw, 0.0);
#endif
#ifdef NOISE_BYTES
  bands -= 0.5;
#endif
  return bands;
}

/// J J^T as XX, XY, YY of how a place in tiles changes from pixel to pixel.
vec3 FootprintOf(vec2 dx, vec2 dy)
{
  return vec3(dx.x * dx.x + dy.x * dy.x, dx.x * dx.y + dy.x * dy.y, dx.y * dx.y + dy.y * dy.y);
}

/// What a Gaussian pixel with a deviation of 1 leaves at the centre of bands, where exp(-q / 4) = t.
vec4 FadeOf(vec4 t)
{
  return t * t;
}
