// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which corners a tile, or a sample, can reach: intervals of lattice rows, and of corners on them.
 * They are never too small.
 */
#if defined(STEERABLE_FAST_WALK_REACH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_REACH_INL_H
#undef STEERABLE_FAST_WALK_REACH_INL_H
#else
#define STEERABLE_FAST_WALK_REACH_INL_H
#endif

#include "Fast/Walk/Tile-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// A quadratic in s.
STAGE_INLINE V Quadratic(const V (&coefficients)[3], V s)
{
  return hn::MulAdd(hn::MulAdd(coefficients[2], s, coefficients[1]), s, coefficients[0]);
}

/// Half-width of a surflet at |s| = `distance` and farther; beyond its end so negative that it
/// stays so.
STAGE_INLINE V GetTaper(V distance, V inverseLength, V halfWidth, bool tapers)
{
  const V s = hn::Mul(hn::Max(distance, hn::Zero(DF())), inverseLength);
  const V left = hn::NegMulAdd(s, s, Const(1.0f));
  const V taper = tapers ? hn::Sqrt(hn::Max(left, hn::Zero(DF()))) : Const(1.0f);
  return hn::IfThenElse(hn::Lt(left, hn::Zero(DF())), Const(-1e9f), hn::Mul(halfWidth, taper));
}

/// Where lattice rows are cut: the reach of registers together in all lanes, or that of a sample in
/// each.
template <int N>
struct Reach
{
  V Place[N];
  V U[N];
  Frame<N> Across;
  V Bend[N];
  V BendAcross[AxesAcross<N>];
  V BendLength; // of BendAcross
  V LargestBend; // of any sample, in cells
  V Length;      // what can be ahead or behind included
  V HalfWidth;
  V LargestWidth;
  V InverseLength;
  /// Largest distance of a place from the middle; how far rows are continued for samples ahead on
  /// them.
  V Spread;
  V RowSpread;
  /// What s can be off that of the middle; and t, by Off[0] + Off[1] |s| + Off[2] s².
  V AlongReach;
  V Off[3];
  bool Tapers;

  STAGE_INLINE Reach() {}

  /**
   * All that a group reaches. Of its first step the part on a lattice row, as long as `row`, is
   * either a step like others, or the row is continued by it.
   */
  STAGE_INLINE Reach(const Group<N>& group, const Extent& extent, V row)
    : Across(group.Across)
    , LargestBend(hn::Add(group.HalfKappa, group.HalfKappa))
    , HalfWidth(Const(extent.HalfWidth))
    , InverseLength(Const(1.0f / extent.HalfLength))
    , Spread(hn::Add(group.Places, group.PlaceRest))
    , Tapers(extent.Tapers)
  {
    std::copy(group.Place, group.Place + N, this->Place);
    std::copy(group.U, group.U + N, this->U);
    std::copy(group.Bend, group.Bend + N, this->Bend);
    this->SetBendAcross();
    this->SetAcross(group, extent, row);
    const V continued = this->LargestWidth;
    this->SetAcross(group, extent, hn::Zero(DF()));
    if (hn::GetLane(hn::Sub(this->LargestWidth, continued)) >= 0.0f)
    {
      this->SetAcross(group, extent, row);
    }
  }

  STAGE_INLINE void SetBendAcross()
  {
    this->Across.Take(this->Bend, this->BendAcross);
    this->BendLength = hn::Sqrt(Dot(this->BendAcross, this->BendAcross));
  }

private:
  STAGE_INLINE void SetAcross(const Group<N>& group, const Extent& extent, V row)
  {
    const V half = Const(0.5f);
    this->RowSpread = row;
    // Σ |sStep| at most.
    V along = group.MostTurn;
    V steps0 = hn::Zero(DF());
    V steps1 = hn::Zero(DF());
    for (int k = 0; k < 2; ++k)
    {
      V place[N];
      std::copy(group.PlaceStep[k], group.PlaceStep[k] + N, place);
      place[0] = k == 0 ? hn::Sub(place[0], hn::CopySign(row, place[0])) : place[0];
      const V alongStep = Dot(place, this->U);
      V placeAcross[AxesAcross<N>];
      V turn[AxesAcross<N>];
      this->Across.Take(place, placeAcross);
      this->Across.Take(group.UStep[k], turn);
      for (int axis = 0; axis < AxesAcross<N>; ++axis)
      {
        turn[axis] = hn::NegMulAdd(alongStep, this->BendAcross[axis], turn[axis]);
      }
      along = hn::Add(along, hn::Abs(alongStep));
      steps0 = hn::Add(steps0, hn::Sqrt(Dot(placeAcross, placeAcross)));
      steps1 = hn::Add(steps1, hn::Sqrt(Dot(turn, turn)));
    }
    const V stretch = group.Across.Stretch;
    this->Off[0] = hn::Add(steps0, group.GetRest(hn::Zero(DF()), along));
    this->Off[1] = hn::Add(hn::MulAdd(this->BendLength, group.MostTurn, steps1),
      hn::Mul(stretch, hn::MulAdd(along, group.ChangeRest, group.Linear)));
    this->Off[2] = hn::Mul(stretch, hn::MulAdd(half, group.Change, group.HalfBendRest));
    this->AlongReach = hn::Add(hn::Add(along, group.AlongRest), Const(extent.Travel));
    this->Length = hn::Add(Const(extent.HalfLength), this->AlongReach);
    this->LargestWidth = hn::Add(this->HalfWidth, Quadratic(this->Off, this->Length));
  }
};

/// Reach of the samples from `first` on, each from its own cell.
template <int N, class Walk>
STAGE_INLINE Reach<N> GetReachApart(const Walk& walk, std::size_t first)
{
  Reach<N> reach;
  for (int axis = 0; axis < N; ++axis)
  {
    reach.Place[axis] = Load(walk.Block.Fraction[axis] + first);
    reach.U[axis] = Load(walk.Block.U[axis] + first);
    reach.Bend[axis] =
      walk.Setup.Curved ? Load(walk.Block.ClampedBend[axis] + first) : hn::Zero(DF());
  }
  reach.LargestBend = hn::Sqrt(Dot(reach.Bend, reach.Bend));
  reach.Across = GetFrameApart<N>(walk, first, reach.U);
  reach.SetBendAcross();
  const V one = Const(1.0f);
  const V rootInverse = hn::Div(one, hn::Sqrt(Load(walk.Along + first)));
  const V length = hn::MulAdd(Const(walk.GetLengthSupport()), rootInverse, Const(Slack));
  reach.HalfWidth = hn::Add(
    hn::Div(Const(walk.GetWidthSupport()), hn::Sqrt(walk.GetLeastAcross(first))), Const(Slack));
  reach.LargestWidth = reach.HalfWidth;
  reach.InverseLength = hn::Div(one, length);
  reach.AlongReach = hn::Mul(rootInverse, Const(walk.GetTravel()));
  reach.Length = hn::Add(length, reach.AlongReach);
  reach.Spread = reach.RowSpread = hn::Zero(DF());
  reach.Off[0] = reach.Off[1] = reach.Off[2] = hn::Zero(DF());
  reach.Tapers = !walk.IsStreaks();
  return reach;
}

/// Bounds of loops over corners, whatever the numbers are.
STAGE_INLINE VI ToCorners(V place)
{
  return hn::ConvertTo(
    DI(), hn::Max(hn::Min(place, Const(FarthestCorner)), Const(-FarthestCorner)));
}

/// How an index of the lattice changes with the place.
struct IndexAxis
{
  V Rate; // along the flow
  V InverseRate;
  V Bend;
  V Width;
  V BoxLow;
  V BoxHigh;
};

/// How much farther across, in the frame, a corner can stand before jitter moves it, the change of
/// its sag included.
template <int N, class Walk>
STAGE_INLINE V GetLooseness(const Walk& walk, const Reach<N>& reach)
{
  const V radius = Const(walk.Setup.JitterRadius);
  return hn::Mul(reach.Across.Stretch,
    hn::MulAdd(hn::Mul(radius, reach.LargestBend), hn::Add(reach.Length, radius), radius));
}

template <int N, class Walk>
STAGE_INLINE IndexAxis GetIndexAxis(const Walk& walk, const Reach<N>& reach, int axis)
{
  IndexAxis result;
  V gradient[N];
  float w2 = 0.0f;
  for (int i = 0; i < N; ++i)
  {
    const float w = walk.IsOblique() ? static_cast<float>(walk.Setup.LatticeIndices[axis][i])
                                     : static_cast<float>(i == axis);
    gradient[i] = Const(w);
    w2 += w * w;
  }
  result.Rate = Dot(gradient, reach.U);
  result.Bend = Dot(gradient, reach.Bend);
  // Along the flow no width is left: the slack keeps intervals of s from being empty by rounding.
  result.Width = hn::MulAdd(hn::Add(reach.LargestWidth, GetLooseness(walk, reach)),
    reach.Across.GetChange(gradient), Const(Slack));
  result.InverseRate = Inverse(result.Rate);
  // Window and jitter are boxes of places; oblique indices need √3 times as many to cover them.
  const float more = walk.IsOblique() ? 1.75f : 1.0f;
  const V box =
    hn::MulAdd(reach.Spread, Const(std::sqrt(w2)), Const(walk.Setup.WindowReach * more));
  result.BoxLow = hn::Sub(reach.Place[axis], hn::Add(box, Const(walk.Setup.JitterUp * more)));
  result.BoxHigh = hn::Add(reach.Place[axis], hn::Add(box, Const(walk.Setup.JitterDown * more)));
  return result;
}

/// s²/2 on an interval, times a factor: its least and greatest value.
STAGE_INLINE void GetSag(V factor, V low, V high, V& least, V& greatest)
{
  const V half = hn::Mul(Const(0.5f), factor);
  const V first = hn::Mul(hn::Mul(low, low), half);
  const V last = hn::Mul(hn::Mul(high, high), half);
  const V turn =
    hn::IfThenElse(hn::Lt(hn::Mul(low, high), hn::Zero(DF())), hn::Zero(DF()), first);
  least = hn::Min(hn::Min(first, last), turn);
  greatest = hn::Max(hn::Max(first, last), turn);
}

/// Leaves of [low, high] the s at which the index of that axis can be `index`.
template <int N, class Walk>
STAGE_INLINE void Narrow(const Walk& walk, const Reach<N>& reach, int number,
  const IndexAxis& axis, V index, V& low, V& high)
{
  const V offset = hn::Sub(index, hn::Sub(reach.Place[number], Const(walk.Setup.JitterMiddle)));
  V least = hn::Zero(DF());
  V greatest = hn::Zero(DF());
  for (int round = 0; round < (walk.Setup.Curved ? 2 : 1); ++round)
  {
    if (walk.Setup.Curved)
    {
      GetSag(axis.Bend, low, high, least, greatest);
    }
    const V a = hn::Mul(hn::Sub(hn::Sub(offset, axis.Width), greatest), axis.InverseRate);
    const V b = hn::Mul(hn::Sub(hn::Add(offset, axis.Width), least), axis.InverseRate);
    low = hn::Max(low, hn::Min(a, b));
    high = hn::Min(high, hn::Max(a, b));
  }
}

/// The s at which the index of that axis can be `index`.
template <int N, class Walk>
STAGE_INLINE void GetInterval(const Walk& walk, const Reach<N>& reach, int number,
  const IndexAxis& axis, V index, V& low, V& high)
{
  high = hn::Add(reach.Length, Const(walk.Setup.JitterRadius));
  low = hn::Neg(high);
  if (walk.Params.AnisotropicWeight)
  {
    Narrow(walk, reach, number, axis, index, low, high);
  }
}

/// Indices that the reach has for s in [low, high]; none if that is empty.
template <int N, class Walk>
STAGE_INLINE void GetRange(const Walk& walk, const Reach<N>& reach, int number,
  const IndexAxis& axis, V low, V high, V& first, V& last)
{
  first = axis.BoxLow;
  last = axis.BoxHigh;
  if (walk.Params.AnisotropicWeight)
  {
    V least = hn::Zero(DF());
    V greatest = hn::Zero(DF());
    if (walk.Setup.Curved)
    {
      GetSag(axis.Bend, low, high, least, greatest);
    }
    const V a = hn::Mul(low, axis.Rate);
    const V b = hn::Mul(high, axis.Rate);
    const V place = hn::Sub(reach.Place[number], Const(walk.Setup.JitterMiddle));
    first = hn::Max(first, hn::Add(place, hn::Sub(hn::Add(hn::Min(a, b), least), axis.Width)));
    last = hn::Min(last, hn::Add(place, hn::Add(hn::Add(hn::Max(a, b), greatest), axis.Width)));
  }
  first = hn::Ceil(first);
  last = hn::IfThenElse(hn::Gt(low, high), Const(-1e9f), hn::Floor(last));
}

/**
 * Cuts lattice rows out of a reach, layer by layer. What a layer has of the flow (see Narrow) is
 * cut into sections. In each the parabola is close to a line, so that what the ellipsoid around it
 * leaves of a row is a quadratic's. With W the half-width, L the half-length, and e and a what t
 * and s can be off, |t| <= W √(1 - (|s| - a)²/L²) + e implies, by (x + y)² <= (1 + d) x² + (1 +
 * 1/d) y² with d = e/W and d = a/L,
 *
 *   t² + W (W + e) s² / (L (L + a)) <= (W + e)² + W (W + e) a / L.
 *
 * s and t are linear in x and y, so this is A x² + 2 B x + C <= 0, where B is linear in y and C
 * quadratic.
 */
template <int N, class Walk>
class RowCutter
{
public:
  STAGE_INLINE RowCutter(const Walk& walk, const Reach<N>& reach)
    : Setup(walk)
    , Whole(reach)
    , Looseness(hn::Add(GetLooseness(walk, reach), Const(Slack)))
    , X(walk, reach, 0)
    , Y(walk, reach, 1)
  {
    this->InverseStep = Inverse(this->X.S);
    if (reach.Tapers)
    {
      this->OverLength = hn::Mul(
        hn::Add(reach.AlongReach, Const(walk.Setup.JitterRadius)), reach.InverseLength);
      this->Taper = hn::Mul(reach.InverseLength,
        hn::Div(reach.InverseLength, hn::Add(Const(1.0f), this->OverLength)));
    }
    else
    {
      this->OverLength = this->Taper = hn::Zero(DF());
    }
  }

  /// The rows of layer `z`, in 2D 0, have s in [begin, end].
  STAGE_INLINE void SetLayer(V z, V begin, V end)
  {
    const Walk& walk = this->Setup;
    const Reach<N>& reach = this->Whole;
    V row[N];
    V index[N];
    for (int i = 0; i < N; ++i)
    {
      index[i] = hn::Sub(i == 2 ? z : hn::Zero(DF()), reach.Place[i]);
    }
    ToPlace(walk, index, row);
    for (int i = 0; i < N && walk.IsJittered(); ++i)
    {
      row[i] = hn::Add(row[i], Const(walk.Setup.JitterMiddle));
    }
    // s and the part t across the flow at x = y = 0.
    const V s0 = Dot(row, reach.U);
    V t0[AxesAcross<N>];
    reach.Across.Take(row, t0);
    // Lanes without any reach nothing, whatever these are.
    const auto any = hn::Le(begin, end);
    begin = hn::IfThenElseZero(any, begin);
    V section = hn::IfThenElseZero(any, hn::Sub(end, begin));
    this->Sections = 1;
    if (walk.Setup.Curved)
    {
      // As many as leave the parabola little to be off a line.
      const V sag = hn::Mul(hn::Mul(section, section), reach.BendLength);
      if (!hn::AllTrue(DF(), hn::Lt(sag, Const(3.2f))))
      {
        this->Sections = hn::AllTrue(DF(), hn::Lt(sag, Const(12.8f))) ? 2 : MostSections;
        section = hn::Mul(section, Const(1.0f / static_cast<float>(this->Sections)));
      }
    }
    const V offParabola = hn::Mul(hn::Mul(section, section), Const(1.0f / 16.0f));
    this->Ends[0] = hn::Mul(hn::Sub(begin, s0), this->InverseStep);
    for (int i = 0; i < this->Sections; ++i)
    {
      end = hn::Add(begin, section);
      this->Ends[i + 1] = hn::Mul(hn::Sub(end, s0), this->InverseStep);
      const V farthest =
        hn::Add(hn::Max(hn::Abs(begin), hn::Abs(end)), Const(walk.Setup.JitterRadius));
      V off = hn::Add(Quadratic(reach.Off, farthest), this->Looseness);
      V t[AxesAcross<N>];
      V byX[AxesAcross<N>];
      V byY[AxesAcross<N>];
      for (int axis = 0; axis < AxesAcross<N>; ++axis)
      {
        t[axis] = t0[axis];
        byX[axis] = this->X.T[axis];
        byY[axis] = this->Y.T[axis];
      }
      if (walk.Setup.Curved)
      {
        // s²/2 is between m s - begin end/2 and (end - begin)²/8 less, m the middle.
        off = hn::MulAdd(offParabola, reach.BendLength, off);
        const V middle = hn::Mul(Const(0.5f), hn::Add(begin, end));
        const V chord = hn::MulSub(middle, s0, hn::Mul(Const(0.5f), hn::Mul(begin, end)));
        const V sag = hn::Sub(chord, offParabola);
        const V sagByX = hn::Mul(middle, this->X.S);
        const V sagByY = hn::Mul(middle, this->Y.S);
        for (int axis = 0; axis < AxesAcross<N>; ++axis)
        {
          t[axis] = hn::NegMulAdd(sag, reach.BendAcross[axis], t[axis]);
          byX[axis] = hn::NegMulAdd(sagByX, reach.BendAcross[axis], byX[axis]);
          byY[axis] = hn::NegMulAdd(sagByY, reach.BendAcross[axis], byY[axis]);
        }
      }
      const V width = hn::Add(reach.HalfWidth, off);
      const V both = hn::Mul(reach.HalfWidth, width);
      const V taper = hn::Mul(both, this->Taper);
      const V limit = hn::MulAdd(both, this->OverLength, hn::Mul(width, width));
      const V taperX = hn::Mul(taper, this->X.S);
      const V taperY = hn::Mul(taper, this->Y.S);
      Section& cut = this->Cuts[i];
      cut.A = hn::MulAdd(taperX, this->X.S, Dot(byX, byX));
      cut.B[0] = hn::MulAdd(taperX, s0, Dot(t, byX));
      cut.B[1] = hn::MulAdd(taperX, this->Y.S, Dot(byY, byX));
      cut.C[0] = hn::Sub(hn::MulAdd(hn::Mul(taper, s0), s0, Dot(t, t)), limit);
      const V half = hn::MulAdd(taperY, s0, Dot(t, byY));
      cut.C[1] = hn::Add(half, half);
      cut.C[2] = hn::MulAdd(taperY, this->Y.S, Dot(byY, byY));
      if (!reach.Tapers)
      {
        // A row along a streak that does not taper: what the clamped coefficient adds must not
        // count.
        const V clamped = hn::Max(cut.A, Const(1e-6f));
        cut.C[0] = hn::NegMulAdd(hn::Sub(clamped, cut.A), Const(1e6f), cut.C[0]);
        cut.A = clamped;
      }
      cut.InverseA = hn::Div(Const(1.0f), cut.A);
      cut.C[0] = hn::IfThenElse(any, cut.C[0], Const(1e9f));
      begin = end;
    }
  }

  /// Leaves of [low, high] what is in reach of row `y` of the layer.
  STAGE_INLINE void Cut(V y, V& low, V& high) const
  {
    V least = Const(1e9f);
    V most = Const(-1e9f);
    const V shift = hn::Mul(hn::Mul(y, this->Y.S), this->InverseStep);
    V begin = hn::Sub(this->Ends[0], shift);
    for (int i = 0; i < this->Sections; ++i)
    {
      const Section& cut = this->Cuts[i];
      const V end = hn::Sub(this->Ends[i + 1], shift);
      const V B = hn::MulAdd(cut.B[1], y, cut.B[0]);
      const V discriminant =
        hn::NegMulAdd(cut.A, Quadratic(cut.C, y), hn::Mul(B, B));
      const V root = hn::Sqrt(hn::Max(discriminant, hn::Zero(DF())));
      const V first =
        hn::Max(hn::Min(begin, end), hn::Mul(hn::Neg(hn::Add(B, root)), cut.InverseA));
      const V last = hn::Min(hn::Max(begin, end), hn::Mul(hn::Sub(root, B), cut.InverseA));
      const auto some = hn::And(
        hn::Le(first, hn::Add(last, Const(2e-3f))), hn::Ge(discriminant, hn::Zero(DF())));
      least = hn::IfThenElse(some, hn::Min(least, first), least);
      most = hn::IfThenElse(some, hn::Max(most, last), most);
      begin = end;
    }
    const V slack = hn::Add(this->Whole.RowSpread, Const(Slack));
    low = hn::Max(low, hn::Sub(least, slack));
    high = hn::Min(high, hn::Add(most, slack));
  }

private:
  static constexpr int MostSections = 4;
  /// What s and t change by from one corner to the next on an axis of the lattice.
  struct Step
  {
    V S;
    V T[AxesAcross<N>];

    STAGE_INLINE Step(const Walk& walk, const Reach<N>& reach, int axis)
    {
      V step[N];
      for (int i = 0; i < N; ++i)
      {
        step[i] = Const(walk.Setup.LatticeSteps[i][axis]);
      }
      this->S = Dot(step, reach.U);
      reach.Across.Take(step, this->T);
    }
  };
  struct Section
  {
    V A;
    V InverseA;
    V B[2];
    V C[3];
  };

  const Walk& Setup;
  const Reach<N>& Whole;
  V Looseness;
  const Step X;
  const Step Y;
  V InverseStep;
  /// a / L and 1 / (L (L + a)); 0 of streaks, which do not taper.
  V OverLength;
  V Taper;
  int Sections;
  /// The x at which they begin and end where y is 0.
  V Ends[MostSections + 1];
  Section Cuts[MostSections];
};
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
