// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Quality 0 without extensions: the corners of the sample's own cell.
#if defined(STEERABLE_FAST_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_CELLS_INL_H
#undef STEERABLE_FAST_CELLS_INL_H
#else
#define STEERABLE_FAST_CELLS_INL_H
#endif

#include "Fast/Metrics-inl.h"
#include "Fast/Profile-inl.h"
#include "Fast/Sums-inl.h"

#include <array>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Where the samples of a register are in the lattice of an octave: cells as the hash takes them,
/// and fractions from their corners.
template <int N>
struct Places
{
  VU Cell[N];
  V Fraction[N];
};

/// Gradients of the lattice rows on both sides of a row of pixels, hashed once and kept while they
/// serve.
template <int N>
class GradientRows
{
public:
  /// Columns [firstColumn, firstColumn + columns).
  GradientRows(const OctaveSetup& octave, GradientSet gradients, std::int64_t firstColumn,
    std::size_t columns)
    : Octave(octave)
    , GradientsOf(gradients)
    , FirstColumn(firstColumn)
    , Stride((columns + Lanes - 1) / Lanes * Lanes + Lanes)
    , Gradients(static_cast<std::size_t>(Slots) * N * Stride)
    , Tags(Slots, { INT64_MIN, INT64_MIN })
  {
  }

  /// Makes the rows of the cell (y, z) ready.
  void MoveTo(std::int64_t y, std::int64_t z)
  {
    for (int slot = 0; slot < Slots; ++slot)
    {
      const std::int64_t row = y + slot % 2;
      const std::int64_t slice = N == 3 ? z + slot / 2 : 0;
      const auto home = static_cast<std::size_t>((row & 1) + 2 * (slice & 1));
      float* gradients = this->Gradients.data() + home * N * this->Stride;
      if (this->Tags[home][0] != row || this->Tags[home][1] != slice)
      {
        this->Tags[home] = { row, slice };
        this->HashRow(row, slice, gradients);
      }
      this->Rows[slot] = gradients;
    }
  }

  /// The row at this offset, 0 or 1, from the cell; each of its N components is GetStride() long.
  const float* GetRow(int oy, int oz) const { return this->Rows[oy + 2 * oz]; }

  std::size_t GetStride() const { return this->Stride; }

private:
  void HashRow(std::int64_t row, std::int64_t slice, float* gradients) const
  {
    const auto& period = this->Octave.Period;
    VU rowHash = hn::Set(DU(),
      steerable::HashOneAxis(WrapToPeriod(row, period[1]), 1) ^
        steerable::HashOneAxis(N == 3 ? WrapToPeriod(slice, period[2]) : 0, 2) ^ this->Octave.Seed);
    HWY_ALIGN std::uint32_t column[Lanes];
    for (std::size_t i = 0; i < this->Stride; i += Lanes)
    {
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        column[lane] =
          WrapToPeriod(this->FirstColumn + static_cast<std::int64_t>(i + lane), period[0]);
      }
      V g[N];
      const VU hash = HashJoinAxes(hn::Xor(HashOneAxis(hn::Load(DU(), column), 0), rowHash));
      if (this->GradientsOf == GradientSet::Perlin)
      {
        PerlinGradient<N>(hash, g);
      }
      else
      {
        UniformGradient(hash, g);
      }
      for (int axis = 0; axis < N; ++axis)
      {
        hn::StoreU(g[axis], DF(), gradients + axis * this->Stride + i);
      }
    }
  }

  OctaveSetup Octave;
  GradientSet GradientsOf;
  std::int64_t FirstColumn;
  static constexpr int Slots = 1 << (N - 1);
  std::size_t Stride;
  std::vector<float> Gradients;
  std::vector<std::array<std::int64_t, 2>> Tags;
  std::array<const float*, Slots> Rows;
};

/// Corners of neighbouring pixels: gradients come from rows, permuted to the lanes.
template <int N>
class RowCorners
{
public:
  HWY_INLINE explicit RowCorners(const GradientRows<N>& rows)
    : Stride(rows.GetStride())
    , Lane(hn::Zero(DU()))
  {
    for (int slot = 0; slot < Slots; ++slot)
    {
      this->Rows[slot] = rows.GetRow(slot % 2, slot / 2);
    }
  }

  /// The lanes' cells; those along x are counted from the first column of the rows.
  HWY_INLINE void SetCells(const VU (&cells)[N])
  {
    const std::uint32_t first = hn::GetLane(cells[0]);
    this->First = first;
    this->Lane = hn::Sub(cells[0], hn::Set(DU(), first));
  }
  HWY_INLINE void SelectRow(int oy, int oz) { this->Row = this->Rows[oy + 2 * oz] + this->First; }
  /// g . v of the corner at this offset in the row.
  HWY_INLINE V GetSlope(int ox, const V (&v)[N]) const
  {
    V g[N];
    const auto lane = hn::IndicesFromVec(DF(), this->Lane);
    for (int axis = 0; axis < N; ++axis)
    {
      g[axis] = hn::TableLookupLanes(Load(this->Row + axis * this->Stride + ox), lane);
    }
    return Dot(g, v);
  }

private:
  static constexpr int Slots = 1 << (N - 1);
  // Copies, which the compiler can keep in registers.
  const float* Rows[Slots];
  std::size_t Stride;
  const float* Row = nullptr;
  std::size_t First = 0;
  VU Lane;
};

/// Corners of the cells of samples anywhere: hashed lane by lane.
template <int N>
class LaneCorners
{
public:
  HWY_INLINE LaneCorners(const OctaveSetup& octave, GradientSet gradients)
    : Octave(octave)
    , Gradients(gradients)
    , Row(hn::Zero(DU()))
  {
  }

  HWY_INLINE void SetCells(const VU (&cells)[N])
  {
    for (int axis = 0; axis < N; ++axis)
    {
      VU next = hn::Add(cells[axis], hn::Set(DU(), 1u));
      if (this->Octave.Period[axis] > 0)
      {
        next = WrapIndex(next, this->Octave.Period[axis]);
      }
      this->Hash[axis][0] = HashOneAxis(cells[axis], axis);
      this->Hash[axis][1] = HashOneAxis(next, axis);
    }
    for (VU& hash : this->Hash[0])
    {
      hash = hn::Xor(hash, hn::Set(DU(), this->Octave.Seed));
    }
  }
  HWY_INLINE void SelectRow(int oy, int oz)
  {
    this->Row = N == 3 ? hn::Xor(this->Hash[1][oy], this->Hash[N - 1][oz]) : this->Hash[1][oy];
  }
  HWY_INLINE V GetSlope(int ox, const V (&v)[N]) const
  {
    const VU hash = HashJoinAxes(hn::Xor(this->Hash[0][ox], this->Row));
    if (this->Gradients == GradientSet::Perlin)
    {
      V g[N];
      PerlinGradient<N>(hash, g);
      return Dot(g, v);
    }
    return UniformSlope(hash, v);
  }

private:
  const OctaveSetup& Octave;
  GradientSet Gradients;
  /// Of the corners below and above.
  VU Hash[N][2];
  VU Row;
};

/// Window of the corner below a fraction in [0, 1]; that of the one above is 1 less it (Kensler:
/// s(t) = 1 - s(1 - t)).
HWY_INLINE V CellWindow(Fade fade, V fraction)
{
  return fade == Fade::Cubic ? FadeOf(fade, fraction) : PlainQuinticFade(fraction);
}

/**
 * Quality 0, straight, unnormalised: the 2^N corners of the cell, with the metric as a matrix.
 * `near` is the window of the corner below on each axis; that of the one above is 1 less it.
 * `Weighted`: faded by the metric.
 */
template <int N, bool Weighted, class Corners>
STAGE_INLINE V SumOverCell(
  const V (&u)[N], V along, V across, const V (&f)[N], const V (&near)[N], Corners& corners)
{
  // G = b I + (k - b) u uT
  const V c = hn::Sub(along, across);
  V G[N][N];
  for (int i = 0; i < N; ++i)
  {
    const V cu = hn::Mul(c, u[i]);
    for (int j = i; j < N; ++j)
    {
      G[i][j] = i == j ? hn::MulAdd(cu, u[j], across) : hn::Mul(cu, u[j]);
      G[j][i] = G[i][j];
    }
  }
  // G v and q = v G v at the first corner. A step along an axis adds a column of G to the one, and
  // the sum of that component before and after to the other.
  V Gv[N];
  for (int i = 0; i < N; ++i)
  {
    Gv[i] = hn::Neg(Dot(G[i], f));
  }
  V q = hn::Neg(Dot(f, Gv));
  const auto step = [&G](int axis, V(&at)[N], V& distance) HWY_ATTR
  {
    distance = hn::Add(distance, at[axis]);
    for (int i = 0; i < N; ++i)
    {
      at[i] = hn::Add(at[i], G[i][axis]);
    }
    distance = hn::Add(distance, at[axis]);
  };
  // s(1 - t) = 1 - s(t): the sum over two neighbours is far + near (lower - upper).
  const auto addRow = [&](int oy, int oz) HWY_ATTR
  {
    corners.SelectRow(oy, oz);
    V at[N];
    V distance = q;
    std::copy(Gv, Gv + N, at);
    if constexpr (!Weighted)
    {
      const V lower = corners.GetSlope(0, at);
      step(0, at, distance);
      const V upper = corners.GetSlope(1, at);
      return hn::MulAdd(near[0], hn::Sub(lower, upper), upper);
    }
    const V fade = PlainQuinticFade(distance);
    const V slope = corners.GetSlope(0, at);
    step(0, at, distance);
    const V upper = hn::Mul(PlainQuinticFade(distance), corners.GetSlope(1, at));
    return hn::MulAdd(near[0], hn::MulSub(fade, slope, upper), upper);
  };
  const auto addSlice = [&](int oz) HWY_ATTR
  {
    const V lower = addRow(0, oz);
    step(1, Gv, q);
    const V upper = addRow(1, oz);
    return hn::MulAdd(near[1], hn::Sub(lower, upper), upper);
  };
  if constexpr (N == 2)
  {
    return addSlice(0);
  }
  else
  {
    V next[N];
    V nextQ = q;
    std::copy(Gv, Gv + N, next);
    step(2, next, nextQ);
    const V lower = addSlice(0);
    std::copy(next, next + N, Gv);
    q = nextQ;
    const V upper = addSlice(1);
    return hn::MulAdd(near[2], hn::Sub(lower, upper), upper);
  }
}

/// Where the metric is I: the sum over the corners of the cell, which no ball of radius 1 goes
/// beyond.
template <int N, bool Squares, class Corners>
STAGE_INLINE Sums SumOverBalls(const V (&f)[N], Corners& corners)
{
  const V one = Const(1.0f);
  // From the sample to the corners below and above, and its square.
  V v[N][2];
  V v2[N][2];
  for (int axis = 0; axis < N; ++axis)
  {
    v[axis][0] = hn::Neg(f[axis]);
    v[axis][1] = hn::Sub(one, f[axis]);
    v2[axis][0] = hn::Mul(v[axis][0], v[axis][0]);
    v2[axis][1] = hn::Mul(v[axis][1], v[axis][1]);
  }
  Sums sums;
  for (int row = 0; row < 1 << (N - 1); ++row)
  {
    const int oy = row % 2;
    const int oz = row / 2;
    corners.SelectRow(oy, oz);
    for (int ox = 0; ox < 2; ++ox)
    {
      V at[N] = { v[0][ox], v[1][oy] };
      V q = hn::Add(v2[0][ox], v2[1][oy]);
      if constexpr (N == 3)
      {
        at[2] = v[2][oz];
        q = hn::Add(q, v2[2][oz]);
      }
      const V weight = QuinticFade(q);
      sums.Noise = hn::MulAdd(weight, corners.GetSlope(ox, at), sums.Noise);
      sums.Weight = hn::Add(sums.Weight, weight);
      if constexpr (Squares)
      {
        sums.Variance = hn::MulAdd(hn::Mul(weight, weight), q, sums.Variance);
      }
    }
  }
  return sums;
}

/**
 * The same for Quality 0 without extensions; `getPlaces` also gives the windows of the lower
 * corners. `direct`: where the noise goes if all is uniform, see NoiseSetup; else null.
 */
template <int N, class Corners, class GetPlaces>
STAGE_INLINE void AddCells(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, float* direct, Corners& corners, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  const EigenvalueRange range = VectorEigenvalues(setup.Parameters, N);
  const V strength = Const(static_cast<float>(setup.Parameters.Strength));
  const V along = AtStrength(range.Along, strength);
  const V across = AtStrength(range.Across, strength);
  const bool weighted = setup.Parameters.AnisotropicWeight;
  const bool squares = setup.Parameters.Normalization == Normalization::UnitVariance;
  const bool metric = weighted || setup.Parameters.MetricInProjection;
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    Places<N> places;
    V near[N];
    getPlaces(i, places, near);
    corners.SetCells(places.Cell);
    V u[N];
    for (int axis = 0; axis < N; ++axis)
    {
      u[axis] = Load(block.U[axis] + i);
    }
    const V one = Const(1.0f);
    const V k = !metric ? one : direct ? along : Load(block.Along + i);
    const V b = !metric ? one : direct ? across : Load(block.Across + i);
    const V noise = setup.Ball
      ? Normalized(setup, N,
          squares ? SumOverBalls<N, true>(places.Fraction, corners)
                  : SumOverBalls<N, false>(places.Fraction, corners))
      : weighted
      ? SumOverCell<N, true>(u, k, b, places.Fraction, near, corners)
      : SumOverCell<N, false>(u, k, b, places.Fraction, near, corners);
    if (!direct)
    {
      AddOctave(setup, octave, block, i, noise);
    }
    else if (i + Lanes <= count)
    {
      hn::StoreU(noise, DF(), direct + i);
    }
    else
    {
      hn::Store(noise, DF(), block.Noise);
      std::copy_n(block.Noise, count - i, direct + i);
    }
  }
  visited += count << N;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
