// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandLoops.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Highway includes this file once more for every SIMD level and picks one at run time. Loops are
// plain: their lengths are constants, and compilers make registers of them.
#define HWY_DISABLED_TARGETS \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Subband/SubbandLoops.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
//--- Fits ---------------------------------------------------------------------
constexpr int MostDirections = 16;

// Rows of a table for `Count` values of q, and how far each is on the way to the next row.
template <int Count>
inline void Locate(const RadialTable& table, const double* q, std::uint64_t* row, double* fraction)
{
  constexpr std::uint64_t one = std::uint64_t{ 0x3ff } << 52;
  constexpr std::uint64_t mantissa = (std::uint64_t{ 1 } << 52) - 1;
  for (int n = 0; n < Count; ++n)
  {
    // In this order NaN, from an overflow, becomes the smallest.
    const double atLeast = table.Smallest < q[n] ? q[n] : table.Smallest;
    const std::uint64_t bits = BitsOf(table.Largest < atLeast ? table.Largest : atLeast);
    row[n] = (bits >> (52 - table.Bits)) - table.First;
    fraction[n] = FromBits(((bits << table.Bits) & mantissa) | one) - 1.0;
  }
}

template <int Stride>
inline void Interpolate(
  const RadialTable& table, std::uint64_t entry, double fraction, double* values)
{
  const double* row = table.Rows.data() + entry * Stride;
  for (int j = 0; j < Stride; ++j)
  {
    values[j] = row[j] + fraction * (row[j + Stride] - row[j]);
  }
}

// sum_psi a_m cos(2m psi) R(q), for all m of a parity; R of four directions are joined already.
template <int K, int First, int Harmonics, int Stride>
inline void SumHarmonics(const DirectionFit::Octant& octant, const double* joined, double* sums)
{
  double sum[Harmonics * Stride] = {};
  for (int n = 0; n < octant.Count; ++n)
  {
    const double* factor = octant.Harmonics.data() + n * K + First;
    for (int m = 0; m < Harmonics; ++m)
    {
      for (int j = 0; j < Stride; ++j)
      {
        sum[m * Stride + j] += factor[m] * joined[n * Stride + j];
      }
    }
  }
  for (int n = 0; n < Harmonics * Stride; ++n)
  {
    sums[n] = sum[n];
  }
}

template <int K, int Stride>
inline void Fit(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights)
{
  const double mean = 0.5 * (metric[0] + metric[2]);
  const double deviator[2] = { 0.5 * (metric[0] - metric[2]), metric[1] };
  const double radius = std::sqrt(deviator[0] * deviator[0] + deviator[1] * deviator[1]);

  const DirectionFit::Octant* octant = fit.Octants.data();
  while (!(mean + radius <= octant->MostRatio * (mean - radius)) &&
    octant != &fit.Octants.back())
  {
    ++octant;
  }
  double even[MostDirections * Stride];
  double odd[MostDirections * Stride];
  for (int first = 0; first < octant->Count; first += 4)
  {
    double q[8], fraction[8];
    std::uint64_t row[8];
    for (int n = 0; n < 4; ++n)
    {
      q[n] = mean + radius * octant->Cosines[first + n];
      q[n + 4] = mean - radius * octant->Cosines[first + n];
    }
    Locate<8>(table, q, row, fraction);
    for (int n = 0; n < 4; ++n)
    {
      double close[Stride], across[Stride];
      Interpolate<Stride>(table, row[n], fraction[n], close);
      Interpolate<Stride>(table, row[n + 4], fraction[n + 4], across);
      for (int j = 0; j < Stride; ++j)
      {
        even[(first + n) * Stride + j] = close[j] + across[j];
        odd[(first + n) * Stride + j] = close[j] - across[j];
      }
    }
  }
  constexpr int evens = (K + 1) / 2;
  double sums[K * Stride];
  SumHarmonics<K, 0, evens, Stride>(*octant, even, sums);
  SumHarmonics<K, evens, K - evens, Stride>(*octant, odd, sums + evens * Stride);
  const auto harmonic = [&](int m) { return sums + (m % 2 * evens + m / 2) * Stride; };

  // cos 2m phi and sin 2m phi.
  double c[K], s[K];
  c[0] = 1.0;
  s[0] = 0.0;
  const double turn[2] = { radius > 0.0 ? deviator[0] / radius : 1.0,
    radius > 0.0 ? deviator[1] / radius : 0.0 };
  for (int m = 1; m < K; ++m)
  {
    c[m] = c[m - 1] * turn[0] - s[m - 1] * turn[1];
    s[m] = s[m - 1] * turn[0] + c[m - 1] * turn[1];
  }
  // At K orientations the harmonics m and K - m are one.
  double waves[K * Stride];
  for (int j = 0; j < Stride; ++j)
  {
    waves[j] = harmonic(0)[j];
  }
  for (int m = 1; 2 * m < K; ++m)
  {
    for (int j = 0; j < Stride; ++j)
    {
      const double a = harmonic(m)[j], b = harmonic(K - m)[j];
      waves[m * Stride + j] = a * c[m] + b * c[K - m];
      waves[(K - m) * Stride + j] = a * s[m] - b * s[K - m];
    }
  }
  if (K % 2 == 0)
  {
    for (int j = 0; j < Stride; ++j)
    {
      waves[K / 2 * Stride + j] = harmonic(K / 2)[j] * c[K / 2];
    }
  }
  for (int j = 0; j < table.Width; ++j)
  {
    double sum[K] = {};
    for (int m = 0; m < K; ++m)
    {
      for (int i = 0; i < K; ++i)
      {
        sum[i] += fit.Waves[m * K + i] * waves[m * Stride + j];
      }
    }
    for (int i = 0; i < K; ++i)
    {
      weights[j * K + i] = sum[i];
    }
  }
}

template <int K>
inline void FitScales(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights)
{
  switch (table.Stride)
  {
    case 2:
      return Fit<K, 2>(fit, table, metric, weights);
    case 4:
      return Fit<K, 4>(fit, table, metric, weights);
    default:
      return Fit<K, 6>(fit, table, metric, weights);
  }
}

void FitBandsHere(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights)
{
  switch (fit.Orientations)
  {
    case 3:
      return FitScales<3>(fit, table, metric, weights);
    case 4:
      return FitScales<4>(fit, table, metric, weights);
    case 6:
      return FitScales<6>(fit, table, metric, weights);
    default:
      return FitScales<8>(fit, table, metric, weights);
  }
}

//--- Power --------------------------------------------------------------------
template <int K>
inline double Power(const PowerForm& form, const double* gamma)
{
  double power[K] = {};
  for (int j = 0; j < form.Scales; ++j)
  {
    const double* own = gamma + j * K;
    const double* next = j + 1 < form.Scales ? own + K : own;
    double filtered[K] = {};
    for (int m = 0; m < K; ++m)
    {
      for (int i = 0; i < K; ++i)
      {
        filtered[i] += form.Angular[m * K + i] * own[m];
      }
    }
    for (int i = 0; i < K; ++i)
    {
      power[i] += filtered[i] * (form.Diagonal[j] * own[i] + form.Beside[j] * next[i]);
    }
  }
  double sum = 0.0;
  for (int i = 0; i < K; ++i)
  {
    sum += power[i];
  }
  return sum;
}

double PowerOfHere(const PowerForm& form, const double* gamma)
{
  switch (form.Orientations)
  {
    case 3:
      return Power<3>(form, gamma);
    case 4:
      return Power<4>(form, gamma);
    case 6:
      return Power<6>(form, gamma);
    default:
      return Power<8>(form, gamma);
  }
}

//--- Sums of tiles ------------------------------------------------------------
// Two texels per axis, or four, with their weights.
struct AxisTaps
{
  int Count;
  int Texel[4];
  float Weight[4];
};

inline AxisTaps LocateTaps(TileLookup lookup, double coordinate, int size)
{
  const double position = (coordinate - std::floor(coordinate)) * size;
  // A coordinate that is not finite gives NaN, not a read outside the tile.
  const double cell = position >= 0.0 ? std::floor(position) : 0.0;
  const float t = static_cast<float>(position - cell);

  AxisTaps taps;
  int first = static_cast<int>(cell);
  if (lookup == TileLookup::Bilinear)
  {
    taps.Count = 2;
    taps.Weight[0] = 1.0f - t;
    taps.Weight[1] = t;
  }
  else
  {
    taps.Count = 4;
    taps.Weight[0] = 0.5f * t * (t * (2.0f - t) - 1.0f);
    taps.Weight[1] = 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f);
    taps.Weight[2] = 0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f);
    taps.Weight[3] = 0.5f * t * t * (t - 1.0f);
    --first;
  }
  for (int n = 0; n < taps.Count; ++n)
  {
    const int texel = first + n;
    taps.Texel[n] = texel < 0 ? texel + size : texel < size ? texel : texel - size;
  }
  return taps;
}

// The texels around a point, with their weights.
struct Neighborhood
{
  int Count = 0;
  const float* Texel[16];
  float Weight[16];
};

inline Neighborhood Gather(const SubbandTiles& tiles, TileLookup lookup, double u, double v)
{
  const AxisTaps x = LocateTaps(lookup, u, tiles.Parameters.TileSize);
  const AxisTaps y = LocateTaps(lookup, v, tiles.Parameters.TileSize);
  Neighborhood points;
  for (int b = 0; b < y.Count; ++b)
  {
    for (int a = 0; a < x.Count; ++a)
    {
      points.Texel[points.Count] = tiles.Texel(x.Texel[a], y.Texel[b]);
      points.Weight[points.Count] = x.Weight[a] * y.Weight[b];
      ++points.Count;
    }
  }
  return points;
}

// Interpolate Width bands from `first` on. Width is known to the compiler, which keeps the sums in
// vector registers: this is where the time of subband noise goes.
template <int Width>
inline void InterpolateBands(const Neighborhood& points, int first, float* bands)
{
  float sum[Width] = {};
  for (int n = 0; n < points.Count; ++n)
  {
    const float* texel = points.Texel[n] + first;
    const float weight = points.Weight[n];
    for (int c = 0; c < Width; ++c)
    {
      sum[c] += weight * texel[c];
    }
  }
  for (int c = 0; c < Width; ++c)
  {
    bands[c] = sum[c];
  }
}

inline void InterpolateAll(const Neighborhood& points, int components, float* bands)
{
  int c = 0;
  for (; c + 16 <= components; c += 16)
  {
    InterpolateBands<16>(points, c, bands + c);
  }
  for (; c + 4 <= components; c += 4)
  {
    InterpolateBands<4>(points, c, bands + c);
  }
  for (; c + 2 <= components; c += 2)
  {
    InterpolateBands<2>(points, c, bands + c);
  }
  if (c < components)
  {
    InterpolateBands<1>(points, c, bands + c);
  }
}

// In interleaved partial sums, which the compiler may compute side by side.
inline float Dot(const float* a, const float* b, int count)
{
  float partial[8] = {};
  int c = 0;
  for (; c + 8 <= count; c += 8)
  {
    for (int lane = 0; lane < 8; ++lane)
    {
      partial[lane] += a[c + lane] * b[c + lane];
    }
  }
  for (; c < count; ++c)
  {
    partial[0] += a[c] * b[c];
  }
  return ((partial[0] + partial[1]) + (partial[2] + partial[3])) +
    ((partial[4] + partial[5]) + (partial[6] + partial[7]));
}

void SampleTilesHere(
  const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands)
{
  InterpolateAll(Gather(tiles, lookup, u, v), tiles.Components(), bands);
}

void SumTilesHere(const SubbandTiles& tiles, TileLookup lookup, std::size_t count,
  const double* uv, const float* weights, float* noise)
{
  const int components = tiles.Components();
  float bands[MostSubbandComponents];
  for (std::size_t p = 0; p < count; ++p)
  {
    InterpolateAll(Gather(tiles, lookup, uv[2 * p], uv[2 * p + 1]), components, bands);
    noise[p] = Dot(bands, weights + p * components, components);
  }
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace steerable
{
HWY_EXPORT(FitBandsHere);
HWY_EXPORT(PowerOfHere);
HWY_EXPORT(SampleTilesHere);
HWY_EXPORT(SumTilesHere);

namespace
{
constexpr double Pi = 3.14159265358979323846;
} // namespace

void RadialTable::Fill(
  int first, int last, int bits, const std::function<Eigen::VectorXd(double c)>& function)
{
  const auto leading = [=](double q) { return BitsOf(q) >> (52 - bits); };
  this->Smallest = std::ldexp(1.0, 2 * first);
  this->Largest = std::ldexp(1.0, 2 * last);
  this->Bits = bits;
  this->First = leading(this->Smallest);
  // One more than the last, to interpolate towards.
  const std::uint64_t end = leading(this->Largest) + 2;
  this->Rows.clear();
  for (std::uint64_t entry = this->First; entry < end; ++entry)
  {
    const double q = FromBits(entry << (52 - bits));
    const Eigen::VectorXd row = function(0.5 * std::log2(q));
    this->Width = static_cast<int>(row.size());
    this->Stride = (this->Width + 1) / 2 * 2;
    this->Rows.insert(this->Rows.end(), row.data(), row.data() + row.size());
    this->Rows.resize(this->Rows.size() + this->Stride - this->Width, 0.0);
  }
}

void RadialTable::Interpolate(double q, double* values) const
{
  std::uint64_t row;
  double fraction;
  HWY_NAMESPACE::Locate<1>(*this, &q, &row, &fraction);
  const double* here = this->Rows.data() + row * this->Stride;
  for (int j = 0; j < this->Width; ++j)
  {
    values[j] = here[j] + fraction * (here[j + this->Stride] - here[j]);
  }
}

void DirectionFit::Prepare(
  int orientations, const std::function<double(double theta)>& factor)
{
  const int K = orientations;
  this->Orientations = K;
  // a_m, exactly: the product has no harmonic above 2(K - 1) = 14.
  constexpr int samples = 64;
  std::vector<double> amplitudes(K, 0.0);
  for (int n = 0; n < samples; ++n)
  {
    const double theta = Pi * n / samples;
    for (int m = 0; m < K; ++m)
    {
      amplitudes[m] += (m == 0 ? 1.0 : 2.0) / samples * factor(theta) * std::cos(2 * m * theta);
    }
  }
  // By quadrature their error is below 3e-6 of the largest weight up to these ratios, the last up
  // to 8:1.
  const std::array<std::pair<int, double>, 3> choices = { std::pair{ 4, 1.69 }, { 8, 6.25 },
    { 16, 64.0 } };
  for (std::size_t choice = 0; choice < choices.size(); ++choice)
  {
    Octant& octant = this->Octants[choice];
    octant.Count = choices[choice].first;
    octant.MostRatio = choices[choice].second;
    for (int n = 0; n < octant.Count; ++n)
    {
      const double psi = Pi * (n + 0.5) / (4 * octant.Count);
      octant.Cosines.push_back(std::cos(2.0 * psi));
      for (const int parity : { 0, 1 })
      {
        for (int m = parity; m < K; m += 2)
        {
          // 2 pi / N, at psi and -psi.
          octant.Harmonics.push_back(
            Pi / octant.Count * amplitudes[m] * std::cos(2.0 * m * psi));
        }
      }
    }
  }
  this->Waves.resize(K * K);
  for (int i = 0; i < K; ++i)
  {
    for (int m = 0; 2 * m <= K; ++m)
    {
      this->Waves[m * K + i] = std::cos(2.0 * Pi * m * i / K);
      if (m > 0 && 2 * m < K)
      {
        this->Waves[(K - m) * K + i] = std::sin(2.0 * Pi * m * i / K);
      }
    }
  }
}

void FitBands(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights)
{
  HWY_DYNAMIC_DISPATCH(FitBandsHere)(fit, table, metric, weights);
}

void PowerForm::Prepare(const Eigen::MatrixXd& angular, const Eigen::MatrixXd& radial)
{
  this->Orientations = static_cast<int>(angular.rows());
  this->Scales = static_cast<int>(radial.rows());
  this->Angular.assign(angular.data(), angular.data() + angular.size());
  for (int j = 0; j < this->Scales; ++j)
  {
    this->Diagonal[j] = radial(j, j);
    this->Beside[j] = j + 1 < this->Scales ? 2.0 * radial(j, j + 1) : 0.0;
  }
}

double PowerOf(const PowerForm& form, const double* gamma)
{
  return HWY_DYNAMIC_DISPATCH(PowerOfHere)(form, gamma);
}

void SampleTiles(
  const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands)
{
  HWY_DYNAMIC_DISPATCH(SampleTilesHere)(tiles, lookup, u, v, bands);
}

void SumTiles(const SubbandTiles& tiles, TileLookup lookup, std::size_t count, const double* uv,
  const float* weights, float* noise)
{
  HWY_DYNAMIC_DISPATCH(SumTilesHere)(tiles, lookup, count, uv, weights, noise);
}
} // namespace steerable
#endif
