// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Registers of samples as one bilinear model, and what they are off it.
#if defined(STEERABLE_FAST_WALK_TILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_TILE_INL_H
#undef STEERABLE_FAST_WALK_TILE_INL_H
#else
#define STEERABLE_FAST_WALK_TILE_INL_H
#endif

#include "Fast/Walk/Lattice-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// The surflet of a tile: half axes, where its fade ends, and how far it travels to either side.
struct Extent
{
  float HalfLength;
  float HalfWidth;
  float Travel;
  /// A streak has the same width everywhere.
  bool Tapers;
};

constexpr std::size_t TileRegisters =
  std::min<std::size_t>(32, std::max<std::size_t>(8, TileSamples / Lanes));

/**
 * The registers of samples that are evaluated together. A register is a rectangle of samples: in
 * images of LaneRows rows, of points all in a row. Columns and rows count within the tile.
 */
struct Tile
{
  std::size_t Registers = 0;
  /// Registers come column by column, this many in each.
  std::size_t PerColumn;
  /// Columns of a register, and where its lanes are.
  std::size_t LaneColumns;
  HWY_ALIGN float LaneColumn[Lanes];
  HWY_ALIGN float LaneRow[Lanes];
  /// Where each begins in the block, where its first sample is, and how many of its columns and
  /// rows count; lanes behind those repeat the last one.
  std::size_t First[TileRegisters];
  float Column[TileRegisters];
  float Row[TileRegisters];
  float Columns[TileRegisters];
  float Rows[TileRegisters];

  Tile(std::size_t perColumn, std::size_t laneColumns)
    : PerColumn(perColumn)
    , LaneColumns(laneColumns)
  {
    for (std::size_t lane = 0; lane < Lanes; ++lane)
    {
      this->LaneColumn[lane] = static_cast<float>(lane % laneColumns);
      this->LaneRow[lane] = static_cast<float>(lane / laneColumns);
    }
  }

  void SetRegister(std::size_t r, std::size_t first, std::size_t column, std::size_t row,
    std::size_t columns, std::size_t rows)
  {
    this->First[r] = first;
    this->Column[r] = static_cast<float>(column);
    this->Row[r] = static_cast<float>(row);
    this->Columns[r] = static_cast<float>(columns);
    this->Rows[r] = static_cast<float>(rows);
  }
  std::size_t GetCount(std::size_t r) const
  {
    return static_cast<std::size_t>(static_cast<int>(this->Columns[r] * this->Rows[r]));
  }
};

/// Where columns, or rows, are from -1 at the first to 1 at the last.
struct Ruler
{
  float Step;
  float First;

  Ruler(float first, float last)
    : Step(last > first ? 2.0f / (last - first) : 0.0f)
    , First(last > first ? -1.0f - first * this->Step : 0.0f)
  {
  }
  float At(float index) const { return this->First + index * this->Step; }
  /// Of the lanes of a register; those from `count` on repeat the one before.
  STAGE_INLINE V At(const float* lanes, float count, float first) const
  {
    const V inside = hn::Min(hn::Load(DF(), lanes), Const(count - 1.0f));
    return hn::MulAdd(inside, Const(this->Step), Const(this->At(first)));
  }
};

/// Axes across the flow.
template <int N>
constexpr int AxesAcross = N - 1;

/**
 * Axes across the flow on which a surflet is round: its wider one has length 1, along the narrower
 * one distances count more. Round ones take any. In lanes alike or of their own.
 */
template <int N>
struct Frame
{
  V Axis[AxesAcross<N>][N];
  /// Of each axis: 1 / its length². Only metrics with a second axis have other than 1.
  V Unstretched[AxesAcross<N>];
  /// The longest axis.
  V Stretch;

  /// What a vector has across the flow.
  STAGE_INLINE void Take(const V (&v)[N], V (&across)[AxesAcross<N>]) const
  {
    for (int i = 0; i < AxesAcross<N>; ++i)
    {
      across[i] = Dot(v, this->Axis[i]);
    }
  }

  /// The most that something with this gradient changes by within 1 across the flow.
  STAGE_INLINE V GetChange(const V (&gradient)[N]) const
  {
    V change2 = hn::Zero(DF());
    for (int i = 0; i < AxesAcross<N>; ++i)
    {
      const V change = hn::Mul(Dot(gradient, this->Axis[i]), this->Unstretched[i]);
      change2 = hn::MulAdd(change, change, change2);
    }
    return hn::Sqrt(change2);
  }
};

/// Round, around these directions.
template <int N>
STAGE_INLINE Frame<N> GetRoundFrame(const V (&u)[N])
{
  Frame<N> frame;
  frame.Stretch = Const(1.0f);
  std::fill_n(frame.Unstretched, AxesAcross<N>, Const(1.0f));
  if constexpr (N == 2)
  {
    frame.Axis[0][0] = hn::Neg(u[1]);
    frame.Axis[0][1] = u[0];
  }
  else
  {
    AnyAcross(u, frame.Axis[0]);
    Cross(u, frame.Axis[0], frame.Axis[1]);
  }
  return frame;
}

/// With a second axis across these directions, of these eigenvalues.
STAGE_INLINE Frame<3> GetFrame(const V (&u)[3], const V (&m)[3], V second, V across)
{
  Frame<3> frame;
  Cross(u, m, frame.Axis[1]);
  const V inverse = hn::Div(Const(1.0f), hn::Min(second, across));
  const V squares[2] = { hn::Mul(second, inverse), hn::Mul(across, inverse) };
  const V lengths[2] = { hn::Sqrt(squares[0]), hn::Sqrt(squares[1]) };
  for (int axis = 0; axis < 3; ++axis)
  {
    frame.Axis[0][axis] = hn::Mul(m[axis], lengths[0]);
    frame.Axis[1][axis] = hn::Mul(frame.Axis[1][axis], lengths[1]);
  }
  for (int i = 0; i < 2; ++i)
  {
    frame.Unstretched[i] = hn::Div(Const(1.0f), squares[i]);
  }
  frame.Stretch = hn::Max(lengths[0], lengths[1]);
  return frame;
}

/// That of the samples from `first` on, with these directions.
template <int N, class Walk>
STAGE_INLINE Frame<N> GetFrameApart(const Walk& walk, std::size_t first, const V (&u)[N])
{
  if constexpr (N == 3)
  {
    if (walk.Setup.Biaxial)
    {
      const auto& axes = walk.Block.M;
      const V m[3] = { Load(axes[0] + first), Load(axes[1] + first), Load(axes[2] + first) };
      return GetFrame(u, m, Load(walk.Second + first), Load(walk.Across + first));
    }
  }
  return GetRoundFrame(u);
}

/**
 * A group of samples, the same in all lanes. They change almost linearly with two numbers λ in [-1,
 * 1], one within a register, the other from one to the next: a sample is at Place + Σ λ PlaceStep,
 * and so on, up to small rests. Distances s along and t across are from the bent axis of the
 * middle.
 *
 * Such a sample sees a corner at v - Σ λ PlaceStep, along u = U + Σ λ UStep, with the bend + Σ λ
 * BendStep, each up to its rest. Its s is therefore s + Σ λ sStep up to AlongRest, with sStep = v
 * UStep - AlongStep, and across U, which only takes away, its t is t - Σ λ (PlaceStep + s UStep +
 * s²/2 BendStep + s sStep Bend) up to GetRest(s, Σ |sStep|).
 */
template <int N>
struct Group
{
  V Place[N];
  V U[N];
  V Bend[N];
  V PlaceStep[2][N]; // as distances, not in indices of the lattice
  V UStep[2][N];
  V BendStep[2][N];
  V PlaceRest;
  V DirectionRest;
  V BendRest;
  Frame<N> Across;
  /// What surflets are wider for frames that differ from this one, see SetFrame.
  V FrameRest;

  V AlongStep[2];
  /// Sums over the steps: of their lengths, and the largest v UStep.
  V Places;
  V Turn;
  V Change;
  V MostTurn;
  V AlongRest;
  /// What GetRest is made of.
  V TurnRest;
  V ChangeRest;
  V HalfKappa;
  V Linear;
  V HalfBendRest;

  STAGE_INLINE Group() {}

  /// What follows from the numbers before.
  STAGE_INLINE void SetBounds(const Extent& extent)
  {
    const V half = Const(0.5f);
    this->Places = this->Turn = this->Change = hn::Zero(DF());
    V bendTurn = hn::Zero(DF());
    for (int k = 0; k < 2; ++k)
    {
      this->AlongStep[k] = Dot(this->PlaceStep[k], this->U);
      this->Places = hn::Add(this->Places, Length(this->PlaceStep[k]));
      this->Turn = hn::Add(this->Turn, Length(this->UStep[k]));
      this->Change = hn::Add(this->Change, Length(this->BendStep[k]));
      bendTurn = hn::Add(bendTurn, hn::Abs(Dot(this->Bend, this->UStep[k])));
    }
    // A corner in reach is at most this far from the sample, along it and, unbent, across it.
    const float mostAlong = extent.HalfLength + extent.Travel;
    const V mostSag = Const(0.5f * mostAlong * mostAlong);
    const V turn = hn::Add(this->Turn, this->DirectionRest);
    const V change = hn::Add(this->Change, this->BendRest);
    const V kappa = hn::Add(Length(this->Bend), change);
    const V places = hn::Add(this->Places, this->PlaceRest);
    const V mostAcross = hn::MulAdd(mostSag, kappa, Const(extent.HalfWidth));
    this->MostTurn = hn::MulAdd(mostSag, bendTurn,
      hn::Mul(this->Turn,
        hn::MulAdd(turn, Const(mostAlong),
          hn::MulAdd(mostSag, change, hn::Add(places, Const(extent.HalfWidth))))));
    const V rest = hn::Add(this->PlaceRest,
      hn::MulAdd(places, this->Turn,
        hn::Mul(this->DirectionRest, hn::Add(places, hn::Add(mostAcross, Const(mostAlong))))));
    this->AlongRest = rest;
    this->TurnRest = turn;
    this->ChangeRest = change;
    this->HalfKappa = hn::Mul(half, kappa);
    this->Linear = hn::MulAdd(kappa, rest, this->DirectionRest);
    this->HalfBendRest = hn::Mul(half, this->BendRest);
  }

  /// What t can be off in the frame; `steps`: Σ |sStep|, or more.
  STAGE_INLINE V GetRest(V distance, V steps) const
  {
    const V both = hn::Add(steps, this->AlongRest);
    const V constant =
      hn::MulAdd(both, hn::MulAdd(this->HalfKappa, both, this->TurnRest), this->PlaceRest);
    const V linear = hn::MulAdd(steps, this->ChangeRest, this->Linear);
    const V rest = hn::MulAdd(hn::MulAdd(this->HalfBendRest, distance, linear), distance, constant);
    return hn::MulAdd(this->Across.Stretch, rest, this->FrameRest);
  }

private:
  static STAGE_INLINE V Length(const V (&v)[N]) { return hn::Sqrt(Dot(v, v)); }
};

/// By how much of their width surflets with other axes may widen that of a group in a common frame.
constexpr float LargestFrameRest = 0.5f;

/// Leaves of v what is across u; returns the rest.
template <int N>
STAGE_INLINE V TakeAlong(V (&v)[N], const V (&u)[N])
{
  const V along = Dot(v, u);
  for (int axis = 0; axis < N; ++axis)
  {
    v[axis] = hn::NegMulAdd(along, u[axis], v[axis]);
  }
  return hn::Abs(along);
}

/// The middle of unit vectors is shorter than 1, and bends and changes are not quite across it.
template <int N>
STAGE_INLINE void SetAcrossFlow(Group<N>& group)
{
  const V norm = hn::Sqrt(Dot(group.U, group.U));
  const V inverse = Inverse(norm);
  for (V& component : group.U)
  {
    component = hn::Mul(component, inverse);
  }
  group.DirectionRest = hn::Add(group.DirectionRest, hn::Abs(hn::Sub(Const(1.0f), norm)));
  group.BendRest = hn::Add(group.BendRest, TakeAlong(group.Bend, group.U));
  for (int k = 0; k < 2; ++k)
  {
    group.DirectionRest = hn::Add(group.DirectionRest, TakeAlong(group.UStep[k], group.U));
    group.BendRest = hn::Add(group.BendRest, TakeAlong(group.BendStep[k], group.U));
  }
}

/// The samples at the corners of a span of registers, and those of the whole span on its rulers.
struct SpanCorners
{
  /// In the block: first and last column of the first row, the same of the last row, and one in the
  /// middle.
  std::size_t At[4];
  std::size_t Middle;
  Ruler Lambda;
  Ruler Mu;

  STAGE_INLINE SpanCorners(const Tile& tile, std::size_t begin, std::size_t end)
    : Lambda(tile.Column[begin], tile.Column[end - 1] + tile.Columns[end - 1] - 1.0f)
    , Mu(tile.Row[begin], tile.Row[end - 1] + tile.Rows[end - 1] - 1.0f)
  {
    const bool columns = end - begin > tile.PerColumn;
    const std::size_t right = columns ? end - tile.PerColumn : begin;
    const std::size_t below = columns ? begin + tile.PerColumn - 1 : end - 1;
    const auto columnsOf = [&tile](std::size_t r) { return static_cast<int>(tile.Columns[r]) - 1; };
    const auto rowsOf = [&tile](std::size_t r)
    { return (static_cast<int>(tile.Rows[r]) - 1) * static_cast<int>(tile.LaneColumns); };
    this->At[0] = tile.First[begin];
    this->At[1] = tile.First[right] + columnsOf(right);
    this->At[2] = tile.First[below] + rowsOf(below);
    this->At[3] = tile.First[end - 1] + rowsOf(end - 1) + columnsOf(end - 1);
    this->Middle = tile.First[(begin + end) / 2];
  }
};

/// A vector that changes linearly over a span: as it is at the corners, `at(axis, corner)`.
template <int N, class At>
STAGE_INLINE void SetPlane(At&& at, V (&middle)[N], V (&step)[2][N])
{
  for (int axis = 0; axis < N; ++axis)
  {
    const float a = at(axis, 0);
    const float b = at(axis, 1);
    const float c = at(axis, 2);
    const float d = at(axis, 3);
    middle[axis] = Const(0.25f * ((a + b) + (c + d)));
    step[0][axis] = Const(0.25f * ((b - a) + (d - c)));
    step[1][axis] = Const(0.25f * ((c - a) + (d - b)));
  }
}

/// The square of what values are off the plane.
template <int N>
STAGE_INLINE V GetRest2(
  const V (&values)[N], const V (&middle)[N], const V (&step)[2][N], V lambda, V mu)
{
  V rest2 = hn::Zero(DF());
  for (int axis = 0; axis < N; ++axis)
  {
    const V rest = hn::Sub(values[axis],
      hn::MulAdd(lambda, step[0][axis], hn::MulAdd(mu, step[1][axis], middle[axis])));
    rest2 = hn::MulAdd(rest, rest, rest2);
  }
  return rest2;
}

/**
 * The registers [begin, end) as a group, whose places count from its first cell, `origin`, and the
 * largest surflet of their samples. FinishGroup sets the rest.
 */
template <int N, class Walk>
STAGE_INLINE void FitGroup(const Walk& walk, const Tile& tile, const SpanCorners& corners,
  std::size_t begin, std::size_t end, VU (&origin)[N], Group<N>& group, Extent& extent)
{
  const MetricBlock& block = walk.Block;
  std::uint32_t first[N];
  // u and -u are the same axis: all on the side of the middle one.
  V side[N];
  float sides[4] = {};
  for (int axis = 0; axis < N; ++axis)
  {
    first[axis] = block.Cell[axis][corners.At[0]];
    origin[axis] = hn::Set(DU(), first[axis]);
    const float middle = block.U[axis][corners.Middle];
    side[axis] = Const(middle);
    for (int corner = 0; corner < 4; ++corner)
    {
      sides[corner] += middle * block.U[axis][corners.At[corner]];
    }
    group.Bend[axis] = group.BendStep[0][axis] = group.BendStep[1][axis] = hn::Zero(DF());
  }
  SetPlane<N>(
    [&](int axis, int corner)
    {
      const std::size_t i = corners.At[corner];
      return static_cast<float>(static_cast<std::int32_t>(block.Cell[axis][i] - first[axis])) +
        block.Fraction[axis][i];
    },
    group.Place, group.PlaceStep);
  SetPlane<N>(
    [&](int axis, int corner)
    { return std::copysign(1.0f, sides[corner]) * block.U[axis][corners.At[corner]]; },
    group.U, group.UStep);
  if (walk.Setup.Curved)
  {
    SetPlane<N>([&](int axis, int corner)
      { return block.ClampedBend[axis][corners.At[corner]]; }, group.Bend, group.BendStep);
  }

  const V signBit = hn::BitCast(DF(), hn::Set(DU(), 0x80000000u));
  V placeRest2 = hn::Zero(DF());
  V directionRest2 = hn::Zero(DF());
  V bendRest2 = hn::Zero(DF());
  V along = Load(walk.Along + tile.First[begin]);
  V across = walk.GetLeastAcross(tile.First[begin]);
  for (std::size_t r = begin; r < end; ++r)
  {
    const std::size_t i = tile.First[r];
    const V lambda = corners.Lambda.At(tile.LaneColumn, tile.Columns[r], tile.Column[r]);
    const V mu = corners.Mu.At(tile.LaneRow, tile.Rows[r], tile.Row[r]);
    V values[N];
    for (int axis = 0; axis < N; ++axis)
    {
      const VU cells = hn::Sub(hn::LoadU(DU(), block.Cell[axis] + i), origin[axis]);
      values[axis] =
        hn::Add(hn::ConvertTo(DF(), hn::BitCast(DI(), cells)), Load(block.Fraction[axis] + i));
    }
    placeRest2 = hn::Max(placeRest2, GetRest2(values, group.Place, group.PlaceStep, lambda, mu));
    for (int axis = 0; axis < N; ++axis)
    {
      values[axis] = Load(block.U[axis] + i);
    }
    const V sign = hn::And(Dot(values, side), signBit);
    for (V& component : values)
    {
      component = hn::Xor(component, sign);
    }
    directionRest2 = hn::Max(directionRest2, GetRest2(values, group.U, group.UStep, lambda, mu));
    if (walk.Setup.Curved)
    {
      for (int axis = 0; axis < N; ++axis)
      {
        values[axis] = Load(block.ClampedBend[axis] + i);
      }
      bendRest2 = hn::Max(bendRest2, GetRest2(values, group.Bend, group.BendStep, lambda, mu));
    }
    along = hn::Min(along, Load(walk.Along + i));
    across = hn::Min(across, walk.GetLeastAcross(i));
  }
  group.PlaceRest = hn::Sqrt(hn::MaxOfLanes(DF(), placeRest2));
  group.DirectionRest = hn::Sqrt(hn::MaxOfLanes(DF(), directionRest2));
  group.BendRest = hn::Sqrt(hn::MaxOfLanes(DF(), bendRest2));
  const float rootAlong = std::sqrt(LeastLane(along));
  extent.HalfLength = walk.GetLengthSupport() / rootAlong + Slack;
  extent.HalfWidth = walk.GetWidthSupport() / std::sqrt(LeastLane(across)) + Slack;
  extent.Travel = walk.GetTravel() / rootAlong;
  extent.Tapers = !walk.IsStreaks();
}

/**
 * The frame of a group: with a second axis that of the middle sample, m, and e = u x m. Let those
 * of samples, m_i, differ from m by δ at most. What a sample's t has on its own axes, α m_i + β
 * e_i, has on those of the group also α (m_i . e) and β (e_i . m). Both products are δ at most,
 * however far u turns, so that in the frame a surflet is wider by δ r W at most, r the stretch and
 * W the half-width.
 */
template <int N, class Walk>
STAGE_INLINE void SetFrame(const Walk& walk, const Tile& tile, const SpanCorners& corners,
  std::size_t begin, std::size_t end, const Extent& extent, Group<N>& group)
{
  group.FrameRest = hn::Zero(DF());
  if constexpr (N == 3)
  {
    if (walk.Setup.Biaxial)
    {
      const auto& axes = walk.Block.M;
      V m[3];
      for (int axis = 0; axis < N; ++axis)
      {
        m[axis] = Const(axes[axis][corners.Middle]);
      }
      TakeAlong(m, group.U);
      const V inverse = Inverse(hn::Sqrt(Dot(m, m)));
      for (V& component : m)
      {
        component = hn::Mul(component, inverse);
      }
      V least = Const(1.0f);
      V second = Load(walk.Second + tile.First[begin]);
      V across = Load(walk.Across + tile.First[begin]);
      for (std::size_t r = begin; r < end; ++r)
      {
        const std::size_t i = tile.First[r];
        const V own[3] = { Load(axes[0] + i), Load(axes[1] + i), Load(axes[2] + i) };
        // m and -m are the same axis.
        least = hn::Min(least, hn::Abs(Dot(own, m)));
        second = hn::Min(second, Load(walk.Second + i));
        across = hn::Min(across, Load(walk.Across + i));
      }
      // |m_i - m|² = 2 - 2 m_i . m
      const V rest = hn::Sqrt(hn::Max(hn::Zero(DF()),
        hn::MulAdd(hn::MinOfLanes(DF(), least), Const(-2.0f), Const(2.0f + Slack * Slack))));
      group.Across = GetFrame(
        group.U, m, hn::MinOfLanes(DF(), second), hn::MinOfLanes(DF(), across));
      const V wider = hn::Mul(rest, group.Across.Stretch);
      // Axes that differ too much are as good as none.
      if (hn::GetLane(wider) < LargestFrameRest)
      {
        group.FrameRest = hn::Mul(wider, Const(extent.HalfWidth));
        return;
      }
    }
  }
  group.Across = GetRoundFrame(group.U);
}

/// What follows from the numbers that FitGroup finds.
template <int N, class Walk>
STAGE_INLINE void FinishGroup(const Walk& walk, const Tile& tile, const SpanCorners& corners,
  std::size_t begin, std::size_t end, const Extent& extent, Group<N>& group)
{
  ToDistances(walk, group.PlaceStep[0]);
  ToDistances(walk, group.PlaceStep[1]);
  if (walk.IsOblique())
  {
    group.PlaceRest = hn::Add(group.PlaceRest, group.PlaceRest);
  }
  SetAcrossFlow(group);
  SetFrame(walk, tile, corners, begin, end, extent, group);
  group.SetBounds(extent);
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
