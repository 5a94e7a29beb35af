// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandLoops.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

// Highway includes this file once more for every SIMD level and picks one at run time.
#include "SimdTargets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Subband/SubbandLoops.cxx"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

// Count numbers in registers, as wide ones as they fill.
template <typename T, int Count>
struct Row
{
  using Tag = hn::CappedTag<T, (Count & -Count)>;
  static constexpr int Step = static_cast<int>(hn::MaxLanes(Tag()));
  static constexpr int Parts = Count / Step;

  HWY_INLINE void SetZero()
  {
    for (int p = 0; p < Parts; ++p)
    {
      this->Part[p] = hn::Zero(Tag());
    }
  }
  HWY_INLINE void AddProduct(T factor, const T* values)
  {
    const auto broadcast = hn::Set(Tag(), factor);
    for (int p = 0; p < Parts; ++p)
    {
      this->Part[p] = hn::MulAdd(broadcast, hn::LoadU(Tag(), values + p * Step), this->Part[p]);
    }
  }
  HWY_INLINE void AddProduct(T factor, const Row& values)
  {
    const auto broadcast = hn::Set(Tag(), factor);
    for (int p = 0; p < Parts; ++p)
    {
      this->Part[p] = hn::MulAdd(broadcast, values.Part[p], this->Part[p]);
    }
  }
  HWY_INLINE void Store(T* values) const
  {
    for (int p = 0; p < Parts; ++p)
    {
      hn::StoreU(this->Part[p], Tag(), values + p * Step);
    }
  }
  HWY_INLINE T Dot(const T* values) const
  {
    auto sum = hn::Mul(this->Part[0], hn::LoadU(Tag(), values));
    for (int p = 1; p < Parts; ++p)
    {
      sum = hn::MulAdd(this->Part[p], hn::LoadU(Tag(), values + p * Step), sum);
    }
    return hn::GetLane(hn::SumOfLanes(Tag(), sum));
  }

  hn::Vec<Tag> Part[Parts];
};

//--- Fits ---------------------------------------------------------------------
// Entries of a table for q at eight directions, and how far each is on the way to the next one.
HWY_INLINE void Locate(const RadialTable& table, double mean, double radius, const double* cosines,
  std::uint64_t* entry, double* fraction)
{
  const hn::CappedTag<double, 8> d;
  const hn::RebindToUnsigned<decltype(d)> bits;
  const auto mantissa = hn::Set(bits, (std::uint64_t{ 1 } << 52) - 1);
  const auto one = hn::Set(d, 1.0);
  const auto smallest = hn::Set(d, table.Smallest);
  for (std::size_t n = 0; n < 8; n += hn::MaxLanes(d))
  {
    const auto q = hn::MulAdd(hn::Set(d, radius), hn::LoadU(d, cosines + n), hn::Set(d, mean));
    // In this way NaN, from an overflow, becomes the smallest.
    const auto inside =
      hn::Min(hn::IfThenElse(hn::Gt(q, smallest), q, smallest), hn::Set(d, table.Largest));
    const auto found = hn::BitCast(bits, inside);
    hn::StoreU(hn::Sub(hn::ShiftRightSame(found, 52 - table.Bits), hn::Set(bits, table.First)),
      bits, entry + n);
    const auto rest = hn::And(hn::ShiftLeftSame(found, table.Bits), mantissa);
    hn::StoreU(hn::Sub(hn::BitCast(d, hn::Or(rest, hn::BitCast(bits, one))), one), d, fraction + n);
  }
}

template <int Stride>
HWY_INLINE Row<double, Stride> Interpolate(
  const RadialTable& table, std::uint64_t entry, double fraction)
{
  using R = Row<double, Stride>;
  const typename R::Tag d;
  const double* here = table.Rows.data()->Values.data() + entry * Stride;
  const auto share = hn::Set(d, fraction);
  R values;
  for (int p = 0; p < R::Parts; ++p)
  {
    const auto from = hn::LoadU(d, here + p * R::Step);
    const auto to = hn::LoadU(d, here + Stride + p * R::Step);
    values.Part[p] = hn::MulAdd(share, hn::Sub(to, from), from);
  }
  return values;
}

template <int K, int Stride>
HWY_INLINE void Fit(
  const DirectionFit& fit, const RadialTable& table, const double metric[3], double* weights)
{
  using R = Row<double, Stride>;
  const double mean = 0.5 * (metric[0] + metric[2]);
  const double deviator[2] = { 0.5 * (metric[0] - metric[2]), metric[1] };
  const double radius = std::sqrt(deviator[0] * deviator[0] + deviator[1] * deviator[1]);

  const DirectionFit::Octant* octant = fit.Octants.data();
  while (!(mean + radius <= octant->MostRatio * (mean - radius)) && octant != &fit.Octants.back())
  {
    ++octant;
  }
  // Of each harmonic a_m sum_psi cos(2m psi) R(q).
  R sums[K];
  for (int m = 0; m < K; ++m)
  {
    sums[m].SetZero();
  }
  const double* factor = octant->Harmonics.data();
  for (int first = 0; first < octant->Count; first += 4)
  {
    double fraction[8];
    std::uint64_t entry[8];
    Locate(table, mean, radius, octant->Cosines.data() + 2 * first, entry, fraction);
    for (int n = 0; n < 4; ++n, factor += K)
    {
      const R own = Interpolate<Stride>(table, entry[n], fraction[n]);
      const R across = Interpolate<Stride>(table, entry[n + 4], fraction[n + 4]);
      R even, odd;
      for (int p = 0; p < R::Parts; ++p)
      {
        even.Part[p] = hn::Add(own.Part[p], across.Part[p]);
        odd.Part[p] = hn::Sub(own.Part[p], across.Part[p]);
      }
      for (int m = 0; m < K; ++m)
      {
        sums[m].AddProduct(factor[m], m % 2 == 0 ? even : odd);
      }
    }
  }

  // cos 2m phi and sin 2m phi.
  double c[K], s[K];
  c[1] = radius > 0.0 ? deviator[0] / radius : 1.0;
  s[1] = radius > 0.0 ? deviator[1] / radius : 0.0;
  for (int m = 2; m < K; ++m)
  {
    const int half = m / 2, rest = m - half;
    c[m] = c[half] * c[rest] - s[half] * s[rest];
    s[m] = s[half] * c[rest] + c[half] * s[rest];
  }
  // At K orientations the harmonics m and K - m are one.
  double waves[K * Stride];
  sums[0].Store(waves);
  for (int m = 1; 2 * m <= K; ++m)
  {
    R cosine, sine;
    cosine.SetZero();
    cosine.AddProduct(c[m], sums[m]);
    if (2 * m < K)
    {
      sine.SetZero();
      sine.AddProduct(s[m], sums[m]);
      cosine.AddProduct(c[K - m], sums[K - m]);
      sine.AddProduct(-s[K - m], sums[K - m]);
      sine.Store(waves + (K - m) * Stride);
    }
    cosine.Store(waves + m * Stride);
  }
  for (int j = 0; j < table.Width; ++j)
  {
    Row<double, K> sum;
    sum.SetZero();
    for (int m = 0; m < K; ++m)
    {
      sum.AddProduct(waves[m * Stride + j], fit.Waves.data() + m * K);
    }
    sum.Store(weights + j * K);
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
      return Fit<K, 8>(fit, table, metric, weights);
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
HWY_INLINE double Power(const PowerForm& form, const double* gamma)
{
  using R = Row<double, K>;
  const typename R::Tag d;
  R power;
  power.SetZero();
  for (int j = 0; j < form.Scales; ++j)
  {
    const double* own = gamma + j * K;
    const double* next = j + 1 < form.Scales ? own + K : own;
    R filtered, joined;
    filtered.SetZero();
    for (int m = 0; m < K; ++m)
    {
      filtered.AddProduct(own[m], form.Angular.data() + m * K);
    }
    joined.SetZero();
    joined.AddProduct(form.Diagonal[j], own);
    joined.AddProduct(form.Beside[j], next);
    for (int p = 0; p < R::Parts; ++p)
    {
      power.Part[p] = hn::MulAdd(filtered.Part[p], joined.Part[p], power.Part[p]);
    }
  }
  auto sum = power.Part[0];
  for (int p = 1; p < R::Parts; ++p)
  {
    sum = hn::Add(sum, power.Part[p]);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
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
// Taps texels along an axis, two or four, with their weights.
template <int Taps>
struct AxisTaps
{
  int Texel[Taps];
  float Weight[Taps];
};

template <int Taps>
HWY_INLINE AxisTaps<Taps> LocateTaps(double coordinate, int size)
{
  const double position = (coordinate - std::floor(coordinate)) * size;
  // A coordinate that is not finite gives NaN, not a read outside the tile.
  const double cell = position >= 0.0 ? std::floor(position) : 0.0;
  const float t = static_cast<float>(position - cell);

  AxisTaps<Taps> taps;
  int first = static_cast<int>(cell);
  if (Taps == 2)
  {
    taps.Weight[0] = 1.0f - t;
    taps.Weight[1] = t;
  }
  else
  {
    taps.Weight[0] = 0.5f * t * (t * (2.0f - t) - 1.0f);
    taps.Weight[1] = 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f);
    taps.Weight[Taps - 2] = 0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f);
    taps.Weight[Taps - 1] = 0.5f * t * t * (t - 1.0f);
    --first;
  }
  for (int n = 0; n < Taps; ++n)
  {
    const int texel = first + n;
    taps.Texel[n] = texel < 0 ? texel + size : texel < size ? texel : texel - size;
  }
  return taps;
}

// The texels around a point, with their weights.
template <int Taps>
struct Neighborhood
{
  const float* Texel[Taps * Taps];
  float Weight[Taps * Taps];
};

template <int Taps>
HWY_INLINE Neighborhood<Taps> Gather(const SubbandTiles& tiles, double u, double v)
{
  const AxisTaps<Taps> x = LocateTaps<Taps>(u, tiles.Parameters.TileSize);
  const AxisTaps<Taps> y = LocateTaps<Taps>(v, tiles.Parameters.TileSize);
  const int components = tiles.Components();
  Neighborhood<Taps> points;
  for (int b = 0; b < Taps; ++b)
  {
    const float* row = tiles.Texel(0, y.Texel[b]);
    for (int a = 0; a < Taps; ++a)
    {
      points.Texel[b * Taps + a] = row + x.Texel[a] * components;
      points.Weight[b * Taps + a] = x.Weight[a] * y.Weight[b];
    }
  }
  return points;
}

// Interpolates Width bands from `first` on, as often as they fit before `last`, and hands each to
// `take`(first, bands): this is where the time of subband noise goes.
template <int Width, int Taps, typename Take>
HWY_INLINE void InterpolateBands(
  const Neighborhood<Taps>& points, int& first, int last, const Take& take)
{
  for (; first + Width <= last; first += Width)
  {
    Row<float, Width> bands;
    bands.SetZero();
    for (int n = 0; n < Taps * Taps; ++n)
    {
      bands.AddProduct(points.Weight[n], points.Texel[n] + first);
    }
    take(first, bands);
  }
}

template <int Taps, typename Take>
HWY_INLINE void InterpolateAll(
  const Neighborhood<Taps>& points, int components, const Take& take)
{
  int first = 0;
  InterpolateBands<32>(points, first, components, take);
  InterpolateBands<8>(points, first, components, take);
  InterpolateBands<4>(points, first, components, take);
  InterpolateBands<2>(points, first, components, take);
  InterpolateBands<1>(points, first, components, take);
}

template <int Taps>
HWY_INLINE void Sample(const SubbandTiles& tiles, double u, double v, float* bands)
{
  InterpolateAll(Gather<Taps>(tiles, u, v), tiles.Components(),
    [=](int first, const auto& some) HWY_ATTR { some.Store(bands + first); });
}

void SampleTilesHere(
  const SubbandTiles& tiles, TileLookup lookup, double u, double v, float* bands)
{
  lookup == TileLookup::Bilinear ? Sample<2>(tiles, u, v, bands) : Sample<4>(tiles, u, v, bands);
}

template <int Taps>
HWY_INLINE void Sum(const SubbandTiles& tiles, std::size_t count, const double* uv,
  const float* weights, float* noise)
{
  const int components = tiles.Components();
  for (std::size_t p = 0; p < count; ++p)
  {
    const float* own = weights + p * components;
    float sum = 0.0f;
    InterpolateAll(Gather<Taps>(tiles, uv[2 * p], uv[2 * p + 1]), components,
      [&](int first, const auto& bands) HWY_ATTR { sum += bands.Dot(own + first); });
    noise[p] = sum;
  }
}

void SumTilesHere(const SubbandTiles& tiles, TileLookup lookup, std::size_t count,
  const double* uv, const float* weights, float* noise)
{
  lookup == TileLookup::Bilinear ? Sum<2>(tiles, count, uv, weights, noise)
                                 : Sum<4>(tiles, count, uv, weights, noise);
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

std::uint64_t BitsOf(double q)
{
  std::uint64_t bits;
  std::memcpy(&bits, &q, sizeof bits);
  return bits;
}

double FromBits(std::uint64_t bits)
{
  double q;
  std::memcpy(&q, &bits, sizeof q);
  return q;
}
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
  std::vector<double> values;
  for (std::uint64_t entry = this->First; entry < end; ++entry)
  {
    const double q = FromBits(entry << (52 - bits));
    const Eigen::VectorXd row = function(0.5 * std::log2(q));
    this->Width = static_cast<int>(row.size());
    this->Stride = this->Width > 4 ? 8 : this->Width > 2 ? 4 : 2;
    values.insert(values.end(), row.data(), row.data() + row.size());
    values.resize((entry - this->First + 1) * this->Stride, 0.0);
  }
  this->Rows.assign((values.size() + 7) / 8, AlignedNumbers());
  std::copy(values.begin(), values.end(), this->Rows.data()->Values.data());
}

void RadialTable::Interpolate(double q, double* values) const
{
  const double inside =
    std::min(this->Largest, q > this->Smallest ? q : this->Smallest); // of NaN too
  const std::uint64_t bits = BitsOf(inside);
  const std::uint64_t entry = bits >> (52 - this->Bits);
  const double from = FromBits(entry << (52 - this->Bits));
  const double to = FromBits((entry + 1) << (52 - this->Bits));
  const double fraction = (inside - from) / (to - from);
  const double* row = this->Rows.data()->Values.data() + (entry - this->First) * this->Stride;
  for (int j = 0; j < this->Width; ++j)
  {
    values[j] = row[j] + fraction * (row[j + this->Stride] - row[j]);
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
  // By quadrature their error is below 3e-6 of the largest weight up to these ratios; that of the
  // last, which takes all others too, is 7e-5 at 8:1.
  const std::array<std::pair<int, double>, 3> choices = { std::pair{ 4, 1.69 }, { 8, 6.25 },
    { 16, 25.0 } };
  for (std::size_t choice = 0; choice < choices.size(); ++choice)
  {
    Octant& octant = this->Octants[choice];
    octant.Count = choices[choice].first;
    octant.MostRatio = choices[choice].second;
    octant.Cosines.resize(2 * octant.Count);
    for (int n = 0; n < octant.Count; ++n)
    {
      const double psi = Pi * (n + 0.5) / (4 * octant.Count);
      octant.Cosines[n / 4 * 8 + n % 4] = std::cos(2.0 * psi);
      octant.Cosines[n / 4 * 8 + n % 4 + 4] = -std::cos(2.0 * psi);
      for (int m = 0; m < K; ++m)
      {
        // 2 pi / N, at psi and -psi.
        octant.Harmonics.push_back(Pi / octant.Count * amplitudes[m] * std::cos(2.0 * m * psi));
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
