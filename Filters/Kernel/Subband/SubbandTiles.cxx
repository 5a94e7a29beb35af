// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandTiles.h"

#include "LatticeHash.h"
#include "Subband/SubbandLoops.h"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace steerable
{
namespace
{

constexpr double Pi = 3.14159265358979323846;
using Complex = std::complex<double>;

// The frequency of bin `index`: 0, 1, ..., then the negative ones.
int SignedFrequency(int index, int size)
{
  return 2 * index < size ? index : index - size;
}

// In place, width*height values, x fastest; `transform`(to, from, count) is that of a line.
template <typename Transform>
void TransformLines(
  std::vector<Complex>& values, int width, int height, const Transform& transform)
{
  std::vector<Complex> line(height), transformed(std::max(width, height));
  for (int y = 0; y < height; ++y)
  {
    Complex* row = values.data() + static_cast<std::size_t>(y) * width;
    // Bands leave most rows empty, and the transform of zero is zero.
    if (std::all_of(row, row + width, [](const Complex& value) { return value == 0.0; }))
    {
      continue;
    }
    transform(transformed.data(), row, width);
    std::copy_n(transformed.begin(), width, row);
  }
  for (int x = 0; x < width; ++x)
  {
    for (int y = 0; y < height; ++y)
    {
      line[y] = values[static_cast<std::size_t>(y) * width + x];
    }
    transform(transformed.data(), line.data(), height);
    for (int y = 0; y < height; ++y)
    {
      values[static_cast<std::size_t>(y) * width + x] = transformed[y];
    }
  }
}

// Divides by the number of values.
void InverseTransform(std::vector<Complex>& values, int width, int height)
{
  Eigen::FFT<double> fft;
  TransformLines(values, width, height,
    [&fft](Complex* to, const Complex* from, int count) { fft.inv(to, from, count); });
}

// What component c of a decomposed image keeps of a frequency, in cycles per shorter side.
double ImageFilter(const SubbandParameters& parameters, int c, double kx, double ky)
{
  const int orientations = parameters.Orientations;
  const int scale = c / orientations;
  if (scale < parameters.Scales)
  {
    return SubbandFilter(parameters, c % orientations, scale, kx, ky);
  }
  const bool low = scale > parameters.Scales;
  const double residual = ResidualFilter(parameters, low, kx, ky);
  return low || residual == 0.0
    ? residual
    : residual * AngularFilter(c % orientations, orientations, std::atan2(ky, kx));
}

} // namespace

Complex NoiseSpectrum(int kx, int ky, std::uint32_t seed, std::uint32_t realization)
{
  if (kx == 0 && ky == 0)
  {
    return 1.0;
  }
  // Hash one of k and -k; the other is its conjugate, so that the noise is real.
  const bool mirrored = ky < 0 || (ky == 0 && kx < 0);
  const int sign = mirrored ? -1 : 1;
  const std::uint32_t bits = HashCorner(static_cast<std::uint32_t>(sign * kx),
    static_cast<std::uint32_t>(sign * ky), realization, seed);
  return std::polar(1.0, sign * 2.0 * Pi * HashToUnit(bits));
}

std::vector<Complex> SynthesizeNoise(int size, std::uint32_t seed, std::uint32_t realization,
  const std::function<double(int kx, int ky)>& response)
{
  std::vector<Complex> values(static_cast<std::size_t>(size) * size);
  std::size_t bin = 0;
  for (int y = 0; y < size; ++y)
  {
    for (int x = 0; x < size; ++x, ++bin)
    {
      const int kx = SignedFrequency(x, size);
      const int ky = SignedFrequency(y, size);
      const double gain = response(kx, ky);
      if (gain != 0.0)
      {
        Complex phase = NoiseSpectrum(kx, ky, seed, realization);
        // At the Nyquist frequency k and -k differ by the sign of one component only: make both real.
        if (2 * kx == -size || 2 * ky == -size)
        {
          const Complex shared = NoiseSpectrum(std::abs(kx), std::abs(ky), seed, realization);
          phase = shared.real() < 0.0 ? -1.0 : 1.0;
        }
        values[bin] = gain * size * phase;
      }
    }
  }
  InverseTransform(values, size, size);
  return values;
}

SubbandTiles MakeSubbandTiles(const SubbandParameters& parameters)
{
  parameters.Validate();
  const int components = parameters.Components();

  SubbandTiles tiles;
  tiles.Parameters = parameters;
  tiles.Values.resize(
    static_cast<std::size_t>(parameters.TileSize) * parameters.TileSize * components);
  for (int j = 0; j < parameters.Scales; ++j)
  {
    for (int i = 0; i < parameters.Orientations; ++i)
    {
      const std::vector<Complex> band =
        SynthesizeNoise(parameters.TileSize, parameters.Seed, parameters.Realization,
          [&](int kx, int ky) { return SubbandFilter(parameters, i, j, kx, ky); });
      float* value = tiles.Values.data() + j * parameters.Orientations + i;
      for (std::size_t texel = 0; texel < band.size(); ++texel)
      {
        value[texel * components] = static_cast<float>(band[texel].real());
      }
    }
  }
  return tiles;
}

std::vector<float> MakeScaleTiles(
  const SubbandParameters& parameters, int scale, int size, TexelKind kind)
{
  parameters.Validate();
  // A band ends an octave above its centre.
  if (scale < 0 || scale >= parameters.Scales ||
    size < 4.0 * std::ldexp(parameters.CenterFrequency(), -scale))
  {
    throw std::invalid_argument("Subband noise: the tile is too small for the scale.");
  }
  const int components = parameters.Orientations;
  // Each frequency keeps its amplitude; white noise of unit variance shares it among more of them.
  const double amplitude = static_cast<double>(size) / parameters.TileSize;
  // The projection of a wave with f cycles per texel on sums of hats.
  const auto gain = [=](int k)
  {
    const double f = static_cast<double>(k) / size;
    const double sinc = k == 0 ? 1.0 : std::sin(Pi * f) / (Pi * f);
    return kind == TexelKind::Values ? 1.0 : 3.0 * sinc * sinc / (2.0 + std::cos(2.0 * Pi * f));
  };
  std::vector<float> values(static_cast<std::size_t>(size) * size * components);
  for (int i = 0; i < components; ++i)
  {
    const std::vector<Complex> band = SynthesizeNoise(size, parameters.Seed, parameters.Realization,
      [&](int kx, int ky)
      { return amplitude * gain(kx) * gain(ky) * SubbandFilter(parameters, i, scale, kx, ky); });
    for (std::size_t texel = 0; texel < band.size(); ++texel)
    {
      values[texel * components + i] = static_cast<float>(band[texel].real());
    }
  }
  return values;
}

std::vector<float> MakeResidualTiles(const SubbandParameters& parameters)
{
  parameters.Validate();
  std::vector<float> values(
    2 * static_cast<std::size_t>(parameters.TileSize) * parameters.TileSize);
  for (const bool low : { false, true })
  {
    const std::vector<Complex> residual = SynthesizeNoise(parameters.TileSize, parameters.Seed,
      parameters.Realization,
      [&](int kx, int ky) { return ResidualFilter(parameters, low, kx, ky); });
    for (std::size_t texel = 0; texel < residual.size(); ++texel)
    {
      values[2 * texel + low] = static_cast<float>(residual[texel].real());
    }
  }
  return values;
}

ImageSpectrum TransformImage(const std::vector<double>& values, int width, int height)
{
  if (values.size() != static_cast<std::size_t>(width) * height)
  {
    throw std::invalid_argument("Subband noise: an image needs width times height values.");
  }
  ImageSpectrum spectrum{ width, height, { values.begin(), values.end() } };
  Eigen::FFT<double> fft;
  TransformLines(spectrum.Values, width, height,
    [&fft](Complex* to, const Complex* from, int count) { fft.fwd(to, from, count); });
  return spectrum;
}

int ImageComponents(const SubbandParameters& parameters)
{
  return parameters.Components() + parameters.Orientations + 1;
}

void WriteImageSubbands(const ImageSpectrum& spectrum, const SubbandParameters& parameters,
  int first, float* values)
{
  const int width = spectrum.Width, height = spectrum.Height;
  const int components = ImageComponents(parameters);
  const bool second = first + 1 < components;
  // Cycles per side to cycles per shorter side.
  const double toX = static_cast<double>(parameters.TileSize) / width;
  const double toY = static_cast<double>(parameters.TileSize) / height;
  // Both are real, so one transform has them as real and imaginary part.
  std::vector<Complex> filtered(spectrum.Values.size());
  std::size_t bin = 0;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x, ++bin)
    {
      const int kx = SignedFrequency(x, width), ky = SignedFrequency(y, height);
      // At the Nyquist frequency k and -k are the same bin: the mean of both keeps images real.
      const bool nyquist = 2 * kx == -width || 2 * ky == -height;
      const int oppositeX = 2 * kx == -width ? kx : -kx;
      const int oppositeY = 2 * ky == -height ? ky : -ky;
      const auto gain = [&](int c)
      {
        const double here = ImageFilter(parameters, c, kx * toX, ky * toY);
        return nyquist
          ? 0.5 * (here + ImageFilter(parameters, c, oppositeX * toX, oppositeY * toY))
          : here;
      };
      filtered[bin] =
        spectrum.Values[bin] * Complex(gain(first), second ? gain(first + 1) : 0.0);
    }
  }
  InverseTransform(filtered, width, height);
  for (std::size_t pixel = 0; pixel < filtered.size(); ++pixel)
  {
    float* texel = values + pixel * components;
    texel[first] = static_cast<float>(filtered[pixel].real());
    if (second)
    {
      texel[first + 1] = static_cast<float>(filtered[pixel].imag());
    }
  }
}

std::vector<std::uint8_t> QuantizeValues(
  const std::vector<float>& values, std::size_t components, std::vector<float>& range)
{
  const std::size_t texels = values.size() / components;
  std::vector<std::uint8_t> bytes(values.size());
  range.resize(components);
  for (std::size_t c = 0; c < components; ++c)
  {
    double power = 0.0;
    for (std::size_t texel = 0; texel < texels; ++texel)
    {
      const double value = values[texel * components + c];
      power += value * value;
    }
    const double most = 4.0 * std::sqrt(power / static_cast<double>(texels));
    range[c] = static_cast<float>(most);
    for (std::size_t texel = 0; texel < texels; ++texel)
    {
      const double level = 127.5 * (values[texel * components + c] / most + 1.0);
      bytes[texel * components + c] =
        static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
    }
  }
  return bytes;
}

QuantizedSubbandTiles Quantize(const SubbandTiles& tiles)
{
  QuantizedSubbandTiles quantized;
  quantized.Parameters = tiles.Parameters;
  quantized.Values = QuantizeValues(
    tiles.Values, static_cast<std::size_t>(tiles.Parameters.Components()), quantized.Range);
  return quantized;
}

SubbandTiles BlendTiles(
  const std::vector<const SubbandTiles*>& tiles, const std::vector<double>& weights)
{
  if (tiles.empty() || tiles.size() != weights.size())
  {
    throw std::invalid_argument("Subband noise: blending needs one weight for each tile.");
  }
  double power = 0.0;
  for (std::size_t m = 0; m < tiles.size(); ++m)
  {
    power += weights[m] * weights[m];
    if (tiles[m]->Values.size() != tiles[0]->Values.size() ||
      tiles[m]->Parameters.Components() != tiles[0]->Parameters.Components())
    {
      throw std::invalid_argument("Subband noise: tiles to blend must have the same shape.");
    }
  }
  if (!(power > 0.0))
  {
    throw std::invalid_argument("Subband noise: one blending weight at least must not be zero.");
  }

  SubbandTiles blend;
  blend.Parameters = tiles[0]->Parameters;
  blend.Values.assign(tiles[0]->Values.size(), 0.0f);
  for (std::size_t m = 0; m < tiles.size(); ++m)
  {
    const float weight = static_cast<float>(weights[m] / std::sqrt(power));
    const float* value = tiles[m]->Values.data();
    for (std::size_t n = 0; n < blend.Values.size(); ++n)
    {
      blend.Values[n] += weight * value[n];
    }
  }
  return blend;
}

std::array<double, 4> LoopWeights(double phase)
{
  const double angle = 2.0 * Pi * phase;
  const double scale = std::sqrt(0.5);
  return { scale * std::cos(angle), scale * std::sin(angle), scale * std::cos(2.0 * angle),
    scale * std::sin(2.0 * angle) };
}

std::array<double, 2> TileOffset(std::uint32_t index, std::uint32_t seed)
{
  return { HashToUnit(HashCorner(index, 0, 0, seed)), HashToUnit(HashCorner(index, 1, 0, seed)) };
}

void SampleSubbands(const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands)
{
  SampleTiles(tiles, lookup, u, v, bands);
}

void SumSubbands(const SubbandTiles& tiles, TileLookup lookup, std::size_t count, const double* uv,
  const float* weights, float* noise)
{
  SumTiles(tiles, lookup, count, uv, weights, noise);
}

} // namespace steerable
