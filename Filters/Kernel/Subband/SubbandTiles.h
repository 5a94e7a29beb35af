// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Tiles of subband noise: made once in the frequency domain, then looked up at every point.
 *
 * Source: Goldberg, Zwicker, Durand, "Anisotropic Noise" (SIGGRAPH 2008), section 2. All bands are
 * cut from one spectrum with modulus one and random phases, so that the variance of every sum of
 * bands is known exactly, and so that scales add up to isotropic noise without a dip between them.
 *
 * A tile has N x N texels and repeats; texel (x, y) lies at u = x/N, v = y/N.
 */
#ifndef SubbandTiles_h
#define SubbandTiles_h

#include "Subband/SubbandFilters.h"

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace steerable
{

/**
 * All bands of a pyramid as one periodic image.
 *
 * Values holds N*N texels, x fastest, of K*J floats, orientation fastest: all bands of a texel are
 * contiguous because every lookup needs all of them. Amplitudes are those of white noise with unit
 * variance seen through the filters; SubbandWeights takes them into account. Tiles of a user's own
 * image may have the K + 1 residuals of WriteImageSubbands after the bands.
 */
struct SubbandTiles
{
  SubbandParameters Parameters;
  std::vector<float> Values;
  int Residuals = 0; ///< 0, or K + 1.

  /// Floats of a texel.
  int Components() const { return this->Parameters.Components() + this->Residuals; }

  /// The bands of texel (x, y), 0 <= x, y < N.
  const float* Texel(int x, int y) const
  {
    const std::size_t texel = static_cast<std::size_t>(y) * this->Parameters.TileSize + x;
    return this->Values.data() + texel * this->Components();
  }
};

/// The most floats that a texel has: 8 orientations at 6 scales, with residuals.
constexpr int MostSubbandComponents = 8 * 6 + 8 + 1;

/// Tiles in 8 bits, same layout. Band c of a texel is (value / 127.5 - 1) * Range[c].
struct QuantizedSubbandTiles
{
  SubbandParameters Parameters;
  std::vector<std::uint8_t> Values;
  std::vector<float> Range; ///< Four standard deviations of each band.
};

/// How tiles are interpolated. CatmullRom reads 4 x 4 texels, Bilinear 2 x 2.
enum class TileLookup
{
  Bilinear,
  CatmullRom
};

/**
 * F at the frequency (kx, ky), cycles per repeat: modulus one, phase from the project's hash, and
 * F(-k) the conjugate of F(k). It does not depend on the tile's size, so a larger tile with the same
 * k0 is the same noise sampled more finely.
 */
std::complex<double> NoiseSpectrum(
  int kx, int ky, std::uint32_t seed, std::uint32_t realization = 0);

/**
 * The noise of this spectrum after the filter `response`(kx, ky): size*size values, x fastest,
 * scaled so that response 1 gives white noise with unit variance. An even response gives real
 * values, up to rounding.
 */
std::vector<std::complex<double>> SynthesizeNoise(int size, std::uint32_t seed,
  std::uint32_t realization, const std::function<double(int kx, int ky)>& response);

/// Make all bands. Throws std::invalid_argument for parameters out of range.
SubbandTiles MakeSubbandTiles(const SubbandParameters& parameters);

/// What the texels of a tile are: values of the noise, or such that bilinear lookups are closest to
/// it everywhere, by least squares.
enum class TexelKind
{
  Values,
  Bilinear
};

/**
 * One scale of the same tiles with another number of texels: size*size texels of K floats,
 * orientation fastest, of the same noise. Throws std::invalid_argument for parameters out of range,
 * and where `size` is less than two texels for the scale's shortest wave.
 */
std::vector<float> MakeScaleTiles(const SubbandParameters& parameters, int scale, int size,
  TexelKind kind = TexelKind::Values);

/**
 * What the bands leave of the spectrum: N*N texels of two floats, what is finer than the finest
 * band in its corner of the plane, and what is coarser than the coarsest, with the mean. The sum of
 * all bands and these two is white noise of variance one. Throws std::invalid_argument for
 * parameters out of range.
 */
std::vector<float> MakeResidualTiles(const SubbandParameters& parameters);

/// A real image as frequencies: bin (x, y) is Values[y * Width + x], zero frequency first.
struct ImageSpectrum
{
  int Width = 0;
  int Height = 0;
  std::vector<std::complex<double>> Values;
};

/// The frequencies of width*height values, x fastest. Throws std::invalid_argument if their number
/// differs.
ImageSpectrum TransformImage(const std::vector<double>& values, int width, int height);

/// Components of a decomposed image: K*J bands as in tiles, K oriented high residuals and the low
/// one, in this order.
int ImageComponents(const SubbandParameters& parameters);

/**
 * Write two components of an image, `first` and the one after it, if there is one, to width*height
 * texels of ImageComponents floats. They are the image, taken as periodic, seen through the filters
 * of the pyramid with k0 = BandCenter cycles per pixel; TileSize must be the shorter side. The sum
 * of all components is the image. The high residual is cut by orientation too, so that factors
 * along directions filter all of an image (paper, section 4).
 */
void WriteImageSubbands(const ImageSpectrum& spectrum, const SubbandParameters& parameters,
  int first, float* values);

/// `components` values a texel in 8 bits, as Quantize has it; `range` gets four standard deviations
/// of each.
std::vector<std::uint8_t> QuantizeValues(
  const std::vector<float>& values, std::size_t components, std::vector<float>& range);

/// Tiles in 8 bits at +-4 standard deviations: about 40 dB, one byte per band and texel.
QuantizedSubbandTiles Quantize(const SubbandTiles& tiles);

/**
 * sum_m w_m tiles_m / sqrt(sum_m w_m^2): keeps the variance, and tiles being Gaussian also the
 * histogram, where the tiles are independent realizations. Throws std::invalid_argument if there are
 * no tiles, the lists differ in length, the tiles in shape, or all weights are zero.
 */
SubbandTiles BlendTiles(
  const std::vector<const SubbandTiles*>& tiles, const std::vector<double>& weights);

/**
 * Weights of four independent tiles that animate noise in a loop as `phase` runs over [0, 1):
 * (cos p, sin p, cos 2p, sin 2p) / sqrt(2), p = 2 pi phase. The second harmonic is needed: with the
 * first alone the second half of the loop is the negative of the first.
 */
std::array<double, 4> LoopWeights(double phase);

/// The realization that LoopWeights' term `m` weighs, of the tiles of one of several independent planes.
constexpr int LoopRealization(int plane, int m)
{
  return 4 * plane + m;
}

/**
 * A shift of the texture coordinates, in [0, 1)^2, different for each index. An octave of noise is
 * the same tiles and weights at twice the texture coordinates, plus a shift of its own: without
 * shifts octaves correlate (0.159 from one to the next).
 */
std::array<double, 2> TileOffset(std::uint32_t index, std::uint32_t seed);

/// Write the components of a texel at (u, v), in repeats, to `bands`. Coordinates wrap; those that
/// are not finite give NaN.
void SampleSubbands(const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands);

/**
 * The noise at `count` points: noise[p] = sum_c weights[p*C + c] band_c(uv[2p], uv[2p + 1]), c < C
 * = tiles.Components(). Coordinates are in repeats and wrap; those that are not finite give NaN.
 */
void SumSubbands(const SubbandTiles& tiles, TileLookup lookup, std::size_t count, const double* uv,
  const float* weights, float* noise);

} // namespace steerable

#endif
