// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// How a tile sees corners, and which of its registers they reach.
#if defined(STEERABLE_FAST_WALK_VIEW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_VIEW_INL_H
#undef STEERABLE_FAST_WALK_VIEW_INL_H
#else
#define STEERABLE_FAST_WALK_VIEW_INL_H
#endif

#include "Fast/Walk/Corners-inl.h"
#include "Fast/Walk/Reach-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Registers that share a list, as a group; what a corner needs of it to find out which it reaches.
template <int N>
struct Span
{
  std::size_t Begin;
  std::size_t End;
  /// Middles of the registers on the rulers, and what no register goes beyond on either side of its
  /// own.
  float Lambda[TileRegisters];
  float Mu[TileRegisters];
  float HalfLambda = 0.0f;
  float HalfMu = 0.0f;
  /// Across the flow, in the group's frame.
  V Bend[AxesAcross<N>];
  V PlaceStep[2][AxesAcross<N>];
  V UStep[2][AxesAcross<N>];
  V BendStep[2][AxesAcross<N>];
  const Group<N>& Whole;
  const Extent& Size;

  STAGE_INLINE Span(const Tile& tile, const SpanCorners& corners, std::size_t begin,
    std::size_t end, const Group<N>& group, const Extent& extent)
    : Begin(begin)
    , End(end)
    , Whole(group)
    , Size(extent)
  {
    group.Across.Take(group.Bend, this->Bend);
    for (int k = 0; k < 2; ++k)
    {
      group.Across.Take(group.PlaceStep[k], this->PlaceStep[k]);
      group.Across.Take(group.UStep[k], this->UStep[k]);
      group.Across.Take(group.BendStep[k], this->BendStep[k]);
    }
    for (std::size_t r = begin; r < end; ++r)
    {
      const float columns = 0.5f * (tile.Columns[r] - 1.0f);
      const float rows = 0.5f * (tile.Rows[r] - 1.0f);
      this->Lambda[r] = corners.Lambda.At(tile.Column[r] + columns);
      this->Mu[r] = corners.Mu.At(tile.Row[r] + rows);
      this->HalfLambda = std::max(this->HalfLambda, columns * corners.Lambda.Step);
      this->HalfMu = std::max(this->HalfMu, rows * corners.Mu.Step);
    }
  }
};

/// How a span sees corners: across the flow, in its frame, they are at T - λ Step[0] - μ Step[1],
/// in reach if within Width.
template <int N>
struct View
{
  V T[AxesAcross<N>];
  V Step[2][AxesAcross<N>];
  V Width;

  STAGE_INLINE View() {}
};

/**
 * Whether T of a view comes within its width of 0 at some λ and μ no farther than these from given
 * ones. In space exactly for λ, and for μ by the length of its step.
 */
template <int N>
class NearTest
{
public:
  STAGE_INLINE NearTest(const View<N>& view, V width, float halfLambda, float halfMu)
    : Seen(view)
    , HalfLambda(Const(halfLambda))
  {
    if constexpr (N == 2)
    {
      this->Limit = hn::MulAdd(hn::Abs(view.Step[0][0]), this->HalfLambda,
        hn::MulAdd(hn::Abs(view.Step[1][0]), Const(halfMu), width));
    }
    else
    {
      width = hn::MulAdd(hn::Sqrt(Dot(view.Step[1], view.Step[1])), Const(halfMu), width);
      this->Limit = hn::IfThenElse(hn::Lt(width, hn::Zero(DF())), Const(-1.0f),
        hn::MulAdd(width, width, Const(1e-5f)));
      const V step2 = hn::Add(Dot(view.Step[0], view.Step[0]), Const(1e-20f));
      this->InverseStep2 = hn::Div(Const(1.0f), step2);
    }
  }

  STAGE_INLINE hn::Mask<DF> IsNear(float lambda, float mu) const
  {
    V t[AxesAcross<N>];
    for (int axis = 0; axis < AxesAcross<N>; ++axis)
    {
      t[axis] = hn::NegMulAdd(Const(lambda), this->Seen.Step[0][axis],
        hn::NegMulAdd(Const(mu), this->Seen.Step[1][axis], this->Seen.T[axis]));
    }
    if constexpr (N == 2)
    {
      return hn::Le(hn::Abs(t[0]), this->Limit);
    }
    else
    {
      V nearest = hn::Mul(Dot(t, this->Seen.Step[0]), this->InverseStep2);
      nearest = hn::Max(hn::Min(nearest, this->HalfLambda), hn::Neg(this->HalfLambda));
      for (int axis = 0; axis < AxesAcross<N>; ++axis)
      {
        t[axis] = hn::NegMulAdd(nearest, this->Seen.Step[0][axis], t[axis]);
      }
      return hn::Le(Dot(t, t), this->Limit);
    }
  }

private:
  const View<N>& Seen;
  V HalfLambda;
  V Limit;
  V InverseStep2;
};

/// How a span sees corners at these indices, displaced by `jitter` and, at most, by as much as
/// `loose`.
template <int N, class Walk>
STAGE_INLINE View<N> GetView(const Walk& walk, const Span<N>& span, const V (&corner)[N],
  const V (&jitter)[N], float loose)
{
  const Group<N>& group = span.Whole;
  View<N> view;
  V v[N];
  for (int axis = 0; axis < N; ++axis)
  {
    v[axis] = hn::Sub(corner[axis], group.Place[axis]);
  }
  if constexpr (Walk::Variant)
  {
    V index[N];
    std::copy(v, v + N, index);
    ToPlace(walk, index, v);
    for (int axis = 0; axis < N && walk.IsJittered(); ++axis)
    {
      v[axis] = hn::Add(v[axis], jitter[axis]);
    }
  }
  const V s = Dot(v, group.U);
  group.Across.Take(v, view.T);
  const V sag = hn::Mul(hn::Mul(s, s), Const(0.5f));
  V steps = hn::Zero(DF());
  for (int k = 0; k < 2; ++k)
  {
    const V sStep = hn::Sub(Dot(v, group.UStep[k]), group.AlongStep[k]);
    steps = hn::Add(steps, hn::Abs(sStep));
    for (int axis = 0; axis < AxesAcross<N>; ++axis)
    {
      view.Step[k][axis] = hn::MulAdd(s, span.UStep[k][axis], span.PlaceStep[k][axis]);
      if (walk.Setup.Curved)
      {
        view.Step[k][axis] = hn::MulAdd(sag, span.BendStep[k][axis], view.Step[k][axis]);
        view.Step[k][axis] = hn::MulAdd(hn::Mul(s, sStep), span.Bend[axis], view.Step[k][axis]);
      }
    }
  }
  for (int axis = 0; axis < AxesAcross<N> && walk.Setup.Curved; ++axis)
  {
    view.T[axis] = hn::NegMulAdd(sag, span.Bend[axis], view.T[axis]);
  }
  const V distance = hn::Abs(s);
  const V shortest = hn::Sub(
    distance, hn::Add(hn::Add(steps, group.AlongRest), Const(span.Size.Travel + loose)));
  view.Width = hn::Add(group.GetRest(hn::Add(distance, Const(loose)), steps),
    GetTaper(shortest, Const(1.0f / span.Size.HalfLength), Const(span.Size.HalfWidth),
      span.Size.Tapers));
  return view;
}

/// For each register of the span bits of the corners on the list that reach its samples.
template <int N, class Walk>
STAGE_INLINE void SetReaching(const Walk& walk, const Span<N>& span, const CornerList<N>& list,
  ListBits (&reaching)[TileRegisters])
{
  const bool all = !walk.Params.AnisotropicWeight;
  std::fill_n(reaching[0], TileRegisters * ListWords, 0);
  for (std::size_t i = 0; i < list.Count; i += Lanes)
  {
    const auto listed = hn::FirstN(DF(), list.Count - i);
    V offset[N];
    V jitter[N];
    LoadAll(list.Offset, i, offset);
    LoadAll(list.Jitter, i, jitter);
    const View<N> view = GetView(walk, span, offset, jitter, 0.0f);
    const NearTest<N> test(view, view.Width, span.HalfLambda, span.HalfMu);
    for (std::size_t r = span.Begin; r < span.End; ++r)
    {
      const auto near = test.IsNear(span.Lambda[r], span.Mu[r]);
      reaching[r][i / 64] |= ToBits(all ? listed : hn::And(listed, near)) << (i % 64);
    }
  }
}

/// Takes corners off the list that reach no sample of the span, from where that was done before on.
template <int N, class Walk>
HWY_NOINLINE void Sift(
  const Walk& walk, const Span<N>& span, const Reach<N>& reach, CornerList<N>& list)
{
  if (!walk.Params.AnisotropicWeight)
  {
    return;
  }
  // Jitter is not known yet.
  const V looseness = GetLooseness(walk, reach);
  V middle[N];
  std::fill_n(middle, N, Const(walk.Setup.JitterMiddle));
  std::size_t kept = list.Sifted;
  for (std::size_t i = list.Sifted; i < list.Count; i += Lanes)
  {
    V offset[N];
    for (int axis = 0; axis < N; ++axis)
    {
      offset[axis] = hn::ConvertTo(DF(), hn::LoadU(DI(), list.Index[axis] + i));
    }
    const View<N> view = GetView(walk, span, offset, middle, walk.Setup.JitterRadius);
    const NearTest<N> test(view, hn::Add(view.Width, looseness), 1.0f, 1.0f);
    const auto listed = hn::FirstN(DF(), list.Count - i);
    std::uint64_t bits = ToBits(hn::And(listed, test.IsNear(0.0f, 0.0f)));
    for (; bits != 0; bits &= bits - 1, ++kept)
    {
      const std::size_t from = i + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
      for (auto& index : list.Index)
      {
        index[kept] = index[from];
      }
    }
  }
  list.Count = list.Sifted = kept;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
