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

/// The registers of samples that are evaluated together.
struct Tile
{
  std::size_t Registers = 0;
  /// Where each begins in the block, and how many of its lanes count.
  std::size_t First[TileRegisters];
  std::size_t Count[TileRegisters];
};

/**
 * A group of samples, the same in all lanes. They change almost linearly with two numbers λ in [-1, 1], one
 * within a register, the other from one to the next: a sample is at Place + Σ λ PlaceStep, and so on, up to
 * small rests. Distances s along and t across are from the bent axis of the middle.
 *
 * Such a sample sees a corner at v - Σ λ PlaceStep, along u = U + Σ λ UStep, with the bend + Σ λ BendStep,
 * each up to its rest. Its s is therefore s + Σ λ sStep up to AlongRest, with sStep = v UStep - AlongStep,
 * and across U, which only takes away, its t is t - Σ λ (PlaceStep + s UStep + s²/2 BendStep + s sStep
 * Bend) up to GetRest(s, Σ |sStep|).
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

  V BendLength;
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
    this->BendLength = hn::Sqrt(Dot(this->Bend, this->Bend));
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
    const V kappa = hn::Add(this->BendLength, change);
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

  /// What t can be off; `steps`: Σ |sStep|, or more.
  STAGE_INLINE V GetRest(V distance, V steps) const
  {
    const V both = hn::Add(steps, this->AlongRest);
    const V constant =
      hn::MulAdd(both, hn::MulAdd(this->HalfKappa, both, this->TurnRest), this->PlaceRest);
    const V linear = hn::MulAdd(steps, this->ChangeRest, this->Linear);
    return hn::MulAdd(hn::MulAdd(this->HalfBendRest, distance, linear), distance, constant);
  }

private:
  static STAGE_INLINE V Length(const V (&v)[N]) { return hn::Sqrt(Dot(v, v)); }
};

/**
 * The registers of a tile, in arrays over registers: each changes almost linearly from its first sample to
 * its last, from Place - PlaceStep to Place + PlaceStep, and so on, up to the rests.
 */
template <int N>
struct Lines
{
  static constexpr std::size_t Room = TileRegisters > Lanes ? TileRegisters : Lanes;
  /// The first sample's; places are counted from there.
  HWY_ALIGN std::uint32_t Cell[N][Room];
  HWY_ALIGN float Place[N][Room];
  HWY_ALIGN float PlaceStep[N][Room];
  HWY_ALIGN float U[N][Room];
  HWY_ALIGN float UStep[N][Room];
  HWY_ALIGN float Bend[N][Room];
  HWY_ALIGN float BendStep[N][Room];
  HWY_ALIGN float PlaceRest[Room];
  HWY_ALIGN float DirectionRest[Room];
  HWY_ALIGN float BendRest[Room];
};

/// Middle and half of the way from `first` to `last`; adds the squares of what `values` are off it.
template <class Walk>
STAGE_INLINE V AddRest(const Walk& walk,
  V rest2, V values, float first, float last, float& middle, float& step)
{
  middle = 0.5f * (first + last);
  step = 0.5f * (last - first);
  const V linear = hn::MulAdd(walk.LaneStep, Const(last - first), Const(first));
  const V rest = hn::Sub(values, linear);
  return hn::MulAdd(rest, rest, rest2);
}

/// The tile's registers as lines, and the largest surflet of their samples.
template <int N, class Walk>
HWY_NOINLINE void SetLines(const Walk& walk, const Tile& tile, Lines<N>& lines, Extent& extent)
{
  const std::size_t registers = tile.Registers;
  V along = Load(walk.Along + tile.First[0]);
  V across = walk.GetLeastAcross(tile.First[0]);
  float before[N] = {};
  for (std::size_t r = 0; r < registers; ++r)
  {
    const std::size_t first = tile.First[r];
    const std::size_t last = first + Lanes - 1;
    along = hn::Min(along, Load(walk.Along + first));
    across = hn::Min(across, walk.GetLeastAcross(first));
    // u and -u are the same axis: all on one side of the first, and that on the side of the line before.
    float side = 0.0f;
    float lastSide = 0.0f;
    for (int axis = 0; axis < N; ++axis)
    {
      const float* u = walk.Block.U[axis];
      side += u[first] * before[axis];
      lastSide += u[last] * u[first];
    }
    side = std::copysign(1.0f, side);
    V cosine = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      const float* u = walk.Block.U[axis];
      before[axis] = side * u[first];
      cosine = hn::MulAdd(Load(u + first), Const(before[axis]), cosine);
    }
    const V sign = hn::And(cosine, hn::BitCast(DF(), hn::Set(DU(), 0x80000000u)));
    const float lastSign = side * std::copysign(1.0f, lastSide);
    V place2 = hn::Zero(DF());
    V direction2 = hn::Zero(DF());
    V bend2 = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      const float* u = walk.Block.U[axis];
      direction2 = AddRest(walk, direction2, hn::Xor(Load(u + first), sign), before[axis],
        lastSign * u[last], lines.U[axis][r], lines.UStep[axis][r]);
      if (walk.Setup.Curved)
      {
        const float* bend = walk.Block.ClampedBend[axis];
        bend2 = AddRest(walk, bend2, Load(bend + first), bend[first], bend[last],
          lines.Bend[axis][r], lines.BendStep[axis][r]);
      }
      const std::uint32_t* cell = walk.Block.Cell[axis];
      const float* fraction = walk.Block.Fraction[axis];
      lines.Cell[axis][r] = cell[first];
      lines.Place[axis][r] = fraction[first];
      lines.PlaceStep[axis][r] = 0.0f;
      if (!Walk::Aligned || axis == 0)
      {
        const VU cells = hn::Sub(hn::LoadU(DU(), cell + first), hn::Set(DU(), cell[first]));
        const V places =
          hn::Add(hn::ConvertTo(DF(), hn::BitCast(DI(), cells)), Load(fraction + first));
        const auto lastCells = static_cast<std::int32_t>(cell[last] - cell[first]);
        place2 = AddRest(walk, place2, places, fraction[first],
          static_cast<float>(lastCells) + fraction[last], lines.Place[axis][r],
          lines.PlaceStep[axis][r]);
      }
    }
    // At first the squares.
    lines.PlaceRest[r] = GreatestLane(place2);
    lines.DirectionRest[r] = GreatestLane(direction2);
    lines.BendRest[r] = walk.Setup.Curved ? GreatestLane(bend2) : 0.0f;
  }
  extent.HalfLength = walk.GetLengthSupport() / std::sqrt(LeastLane(along)) + Slack;
  extent.HalfWidth = walk.GetWidthSupport() / std::sqrt(LeastLane(across)) + Slack;
  extent.Travel = walk.GetTravel() / std::sqrt(LeastLane(along));
  extent.Tapers = !walk.IsStreaks();
  for (float* rest : { lines.PlaceRest, lines.DirectionRest, lines.BendRest })
  {
    for (std::size_t r = 0; r < registers; r += Lanes)
    {
      hn::Store(hn::Sqrt(hn::Load(DF(), rest + r)), DF(), rest + r);
    }
  }
}

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

/**
 * Splits vectors of the lines [begin, end), `value(axis, i)` their middles and `steps` what changes
 * within them, into the linear change within a line and from line to line. Returns the most that they,
 * with their own rests, are off that.
 */
template <int N, class Value>
STAGE_INLINE V SplitSpan(std::size_t begin, std::size_t end, Value&& value,
  const float (&steps)[N][Lines<N>::Room], const float* rests, V (&middle)[N],
  V (&change)[2][N])
{
  const V half = Const(0.5f);
  for (int axis = 0; axis < N; ++axis)
  {
    const V first = Const(value(axis, begin));
    const V last = Const(value(axis, end - 1));
    middle[axis] = hn::Mul(half, hn::Add(first, last));
    change[0][axis] = Const(0.5f * (steps[axis][begin] + steps[axis][end - 1]));
    change[1][axis] = hn::Mul(half, hn::Sub(last, first));
  }
  const float lambdaStep = 2.0f / std::max<float>(1.0f, end - begin - 1.0f);
  V most = hn::Zero(DF());
  for (std::size_t i = 0; i < end; i += Lanes)
  {
    const V r = Ramp(static_cast<float>(i) - static_cast<float>(begin));
    const V lambda = hn::MulSub(r, Const(lambdaStep), Const(end - begin > 1 ? 1.0f : 0.0f));
    V rest2 = hn::Zero(DF());
    V step2 = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      HWY_ALIGN float values[Lanes];
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        values[lane] = value(axis, i + lane);
      }
      const V linear = hn::MulAdd(lambda, change[1][axis], middle[axis]);
      const V rest = hn::Sub(hn::Load(DF(), values), linear);
      rest2 = hn::MulAdd(rest, rest, rest2);
      const V step = hn::Sub(hn::Load(DF(), steps[axis] + i), change[0][axis]);
      step2 = hn::MulAdd(step, step, step2);
    }
    const auto used =
      hn::And(hn::Ge(r, hn::Zero(DF())), hn::Lt(r, Const(static_cast<float>(end - begin))));
    const V rest = hn::Add(hn::Load(DF(), rests + i), hn::Add(hn::Sqrt(rest2), hn::Sqrt(step2)));
    most = hn::Max(most, hn::IfThenElseZero(used, rest));
  }
  return hn::MaxOfLanes(DF(), most);
}

/// The registers [begin, end) as a group, whose places count from its first cell, `origin`.
template <int N, class Walk>
STAGE_INLINE Group<N> GetGroup(const Walk& walk, const Lines<N>& lines, const Extent& extent,
  std::size_t begin, std::size_t end, VU (&origin)[N])
{
  Group<N> group;
  for (int axis = 0; axis < N; ++axis)
  {
    origin[axis] = hn::Set(DU(), lines.Cell[axis][begin]);
  }
  group.PlaceRest = SplitSpan<N>(
    begin, end,
    [&](int axis, std::size_t r) HWY_ATTR
    {
      const auto cells = static_cast<std::int32_t>(lines.Cell[axis][r] - lines.Cell[axis][begin]);
      return lines.Place[axis][r] + static_cast<float>(cells);
    },
    lines.PlaceStep, lines.PlaceRest, group.Place, group.PlaceStep);
  group.DirectionRest = SplitSpan<N>(
    begin, end, [&](int axis, std::size_t r) HWY_ATTR { return lines.U[axis][r]; }, lines.UStep,
    lines.DirectionRest, group.U, group.UStep);
  if (walk.Setup.Curved)
  {
    group.BendRest = SplitSpan<N>(
      begin, end, [&](int axis, std::size_t r) HWY_ATTR { return lines.Bend[axis][r]; },
      lines.BendStep, lines.BendRest, group.Bend, group.BendStep);
  }
  else
  {
    group.BendRest = hn::Zero(DF());
    for (int axis = 0; axis < N; ++axis)
    {
      group.Bend[axis] = group.BendStep[0][axis] = group.BendStep[1][axis] = hn::Zero(DF());
    }
  }
  ToDistances(walk, group.PlaceStep[0]);
  ToDistances(walk, group.PlaceStep[1]);
  if (walk.IsOblique())
  {
    group.PlaceRest = hn::Add(group.PlaceRest, group.PlaceRest);
  }
  SetAcrossFlow(group);
  group.SetBounds(extent);
  return group;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
