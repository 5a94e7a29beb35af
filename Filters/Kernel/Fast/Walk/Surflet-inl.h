// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A register of samples and a corner: what the surflet adds to their sums.
#if defined(STEERABLE_FAST_WALK_SURFLET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_SURFLET_INL_H
#undef STEERABLE_FAST_WALK_SURFLET_INL_H
#else
#define STEERABLE_FAST_WALK_SURFLET_INL_H
#endif

#include "Fast/Sums-inl.h"
#include "Fast/Walk/Corners-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Samples of a tile with what surflets need of them: a register.
template <int N>
struct Sample
{
  /// Whole cells from where offsets count, and the fraction.
  V Shift[N];
  V Fraction[N];
  V U[N];
  V Bend[N];
  V Along;
  V Across;
  V Sense;
  V RootAlong;
  /// Of metrics with a second axis: it, u x m, what u lacks on them, and the eigenvalue.
  V M[N];
  V ThirdAxis[N];
  V Rest[2];
  V Second;
  /// 2D: the normal n = (-u_y, u_x), also in two parts, see Walk::AddSurflet; what the fraction has of u
  /// and, in two parts, of n; and κ/2.
  V Normal[2];
  V HighNormal[2];
  V LowNormal[2];
  V AlongFraction;
  V HighAcross;
  V LowAcross;
  V HalfBend;

  STAGE_INLINE Sample(
    const NoiseSetup& setup, const MetricBlock& block, std::size_t i, const VU (&cell)[N])
    : Along(Load((setup.Curved ? block.BentAlong : block.Along) + i))
    , Across(Load((setup.Curved ? block.BentAcross : block.Across) + i))
    , Sense(Load(block.Sense + i))
    , RootAlong(hn::Sqrt(Along))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Shift[axis] = hn::ConvertTo(
        DF(), hn::BitCast(DI(), hn::Sub(hn::LoadU(DU(), block.Cell[axis] + i), cell[axis])));
      this->Fraction[axis] = Load(block.Fraction[axis] + i);
      this->U[axis] = Load(block.U[axis] + i);
      this->Bend[axis] = setup.Curved ? Load(block.ClampedBend[axis] + i) : hn::Zero(DF());
    }
    if (N == 3 && setup.Biaxial)
    {
      this->Second = Load((setup.Curved ? block.BentSecond : block.Second) + i);
      for (int axis = 0; axis < N; ++axis)
      {
        this->M[axis] = Load(block.M[axis] + i);
      }
      for (int axis = 0; axis < N; ++axis)
      {
        const int j = (axis + 1) % N;
        const int k = (axis + 2) % N;
        this->ThirdAxis[axis] = hn::MulSub(this->U[j], this->M[k], hn::Mul(this->U[k], this->M[j]));
      }
      this->Rest[0] = Load(block.URest[0] + i);
      this->Rest[1] = Load(block.URest[1] + i);
    }
    if constexpr (N == 2)
    {
      this->Normal[0] = hn::Neg(this->U[1]);
      this->Normal[1] = this->U[0];
      this->LowNormal[0] = hn::Neg(Load(block.URest[1] + i));
      this->LowNormal[1] = Load(block.URest[0] + i);
      V high[2];
      V low[2];
      for (int axis = 0; axis < 2; ++axis)
      {
        const V normal = this->Normal[axis];
        this->HighNormal[axis] = RoundTo(normal, 16384.0f);
        this->LowNormal[axis] =
          hn::Add(hn::Sub(normal, this->HighNormal[axis]), this->LowNormal[axis]);
        high[axis] = RoundTo(this->Fraction[axis], 65536.0f);
        low[axis] = hn::Sub(this->Fraction[axis], high[axis]);
      }
      this->AlongFraction = Dot(this->U, this->Fraction);
      this->HighAcross = Dot(this->HighNormal, high);
      this->LowAcross = hn::Add(Dot(this->HighNormal, low), Dot(this->LowNormal, this->Fraction));
      this->HalfBend = hn::Mul(Const(0.5f), Dot(this->Normal, this->Bend));
    }
  }
};

/// Distance of a corner on an axis, in cells.
template <int N>
STAGE_INLINE V GetDistance(const Sample<N>& sample, V offset, int axis)
{
  return hn::Sub(hn::Sub(offset, sample.Shift[axis]), sample.Fraction[axis]);
}

/// Window of a corner on all axes but the first.
template <int N, class Walk>
STAGE_INLINE V GetRowWindow(const Walk& walk, const Sample<N>& sample, const V (&offset)[N])
{
  V window = Const(1.0f);
  for (int axis = 1; axis < N; ++axis)
  {
    const V v = GetDistance(sample, offset[axis], axis);
    window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v), walk.InverseReach)));
  }
  return window;
}

/// Sees to what all lanes of the sample have in common, for a register of corners at a time.
template <int N, class Walk>
STAGE_INLINE void SetFromRow(const Walk& walk, const Sample<N>& sample, CornerList<N>& list)
{
  if constexpr (Walk::Aligned)
  {
    for (std::size_t i = 0; i < list.Count; i += Lanes)
    {
      V offset[N];
      LoadAll(list.Offset, i, offset);
      hn::Store(GetRowWindow(walk, sample, offset), DF(), list.RowWindow + i);
      for (int axis = 1; axis < N && N == 3; ++axis)
      {
        hn::Store(GetDistance(sample, offset[axis], axis), DF(), list.FromRow[axis] + i);
      }
    }
  }
}

/// The window of variants.
template <int N, class Walk>
STAGE_INLINE V GetWindow(const Walk& walk, const V (&v)[N])
{
  const Fade fade = walk.Params.Interpolant;
  if (walk.Params.Window == Falloff::Radial)
  {
    return FadeOf(fade, hn::Mul(hn::Sqrt(Dot(v, v)), walk.InverseReach));
  }
  V product = FadeOf(fade, hn::Mul(v[0], walk.InverseReach));
  for (int axis = 1; axis < N; ++axis)
  {
    product = hn::Mul(product, FadeOf(fade, hn::Mul(v[axis], walk.InverseReach)));
  }
  return product;
}

/// A corner as a register of samples sees it.
template <int N>
struct LocalFrame
{
  V Offset[N];
  /// Along the flow, and of variants √k s.
  V S;
  V Sigma;
  /// b t², and q = k s² + b t².
  V Across2;
  V Q;
  /// What the gradient makes of the offset, g G v', and |G v'|².
  V Slope;
  V Slope2;

  STAGE_INLINE LocalFrame() {}
};

/// Moves the surflet of a corner on its way along the flow, and gives s in half-lengths.
template <int N, class Walk>
STAGE_INLINE void Travel(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner, V& s, V& sigma)
{
  if constexpr (Walk::Variant)
  {
    sigma = hn::Mul(sample.RootAlong, s);
    if (walk.Params.Motion)
    {
      sigma = hn::MulAdd(corner.Travel, sample.Sense, sigma);
      s = hn::Div(sigma, sample.RootAlong);
    }
  }
}

/// `Curved`: bends count; `squares`: Slope2 is wanted.
template <bool Curved, bool squares, int N, class Walk>
STAGE_INLINE LocalFrame<N> GetLocalFrame(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner)
{
  LocalFrame<N> frame;
  V offset[N];
  for (int axis = 0; axis < N; ++axis)
  {
    offset[axis] = hn::Sub(corner.Offset[axis], sample.Shift[axis]);
    frame.Offset[axis] = Walk::Aligned && N == 3 && axis > 0 ? corner.FromRow[axis]
                                            : hn::Sub(offset[axis], sample.Fraction[axis]);
  }
  if constexpr (Walk::Variant)
  {
    V index[N];
    std::copy(frame.Offset, frame.Offset + N, index);
    ToPlace(walk, index, frame.Offset);
    for (int axis = 0; axis < N && walk.IsJittered(); ++axis)
    {
      frame.Offset[axis] = hn::Add(frame.Offset[axis], corner.Jitter[axis]);
    }
  }
  V& s = frame.S;
  V ks;
  const V(&g)[N] = corner.Gradient;
  if constexpr (N == 2)
  {
    V t;
    if constexpr (Walk::Variant)
    {
      s = Dot(frame.Offset, sample.U);
      t = Dot(frame.Offset, sample.Normal);
    }
    else
    {
      // n . v of a far corner is a small difference of large products. Of the high parts of n and the
      // fraction products and, up to 256 cells, the difference are exact. Where streamlines bend s² is
      // a part of it, so s is as precise there.
      const V(&high)[2] = sample.HighNormal;
      const V(&low)[2] = sample.LowNormal;
      if constexpr (Curved || !HWY_NATIVE_FMA) // without fused products this much is needed anyway
      {
        s = hn::Add(hn::MulSub(high[1], offset[0], hn::Mul(high[0], offset[1])),
          hn::MulSub(low[1], offset[0], hn::MulAdd(low[0], offset[1], sample.AlongFraction)));
      }
      else
      {
        s = hn::MulAdd(
          sample.U[0], offset[0], hn::MulSub(sample.U[1], offset[1], sample.AlongFraction));
      }
      t = hn::Sub(
        hn::MulAdd(high[0], offset[0], hn::Mul(high[1], offset[1])), sample.HighAcross);
      if constexpr (Curved)
      {
        // Before anything is rounded: of the sag, many cells, little is left.
        t = hn::NegMulAdd(hn::Mul(s, s), sample.HalfBend, t);
      }
      t = hn::Add(t, hn::MulAdd(low[0], offset[0], hn::MulSub(low[1], offset[1], sample.LowAcross)));
    }
    if constexpr (Curved && Walk::Variant)
    {
      t = hn::NegMulAdd(hn::Mul(s, s), sample.HalfBend, t);
    }
    Travel(walk, sample, corner, s, frame.Sigma);
    ks = hn::Mul(sample.Along, s);
    const V bt = hn::Mul(sample.Across, t);
    frame.Across2 = hn::Mul(bt, t);
    frame.Q = hn::MulAdd(ks, s, frame.Across2);
    frame.Slope = hn::MulAdd(ks, Dot(sample.U, g), hn::Mul(bt, Dot(sample.Normal, g)));
    if constexpr (squares)
    {
      frame.Slope2 = hn::MulAdd(ks, ks, hn::Mul(bt, bt));
    }
    if (Walk::Variant && !walk.Params.MetricInProjection)
    {
      frame.Slope = hn::MulAdd(s, Dot(sample.U, g), hn::Mul(t, Dot(sample.Normal, g)));
      frame.Slope2 = hn::MulAdd(s, s, hn::Mul(t, t));
    }
  }
  else
  {
    s = Dot(frame.Offset, sample.U);
    V t[N];
    const V sag = hn::Mul(hn::Mul(Const(0.5f), s), s);
    if (Curved && !Walk::Variant && !walk.Setup.Biaxial)
    {
      // As in the plane: the offset is exact, and of the sag, many cells, little is left.
      // (With axes of its own the parts are small already, and near corners would lose by it.)
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(sag, sample.Bend[i], offset[i]);
        t[i] = hn::Sub(hn::NegMulAdd(s, sample.U[i], t[i]), sample.Fraction[i]);
      }
    }
    else
    {
      for (int i = 0; i < N; ++i)
      {
        t[i] = hn::NegMulAdd(s, sample.U[i], frame.Offset[i]);
        t[i] = Curved ? hn::NegMulAdd(sag, sample.Bend[i], t[i]) : t[i];
      }
    }
    const V unmoved = s;
    Travel(walk, sample, corner, s, frame.Sigma);
    ks = hn::Mul(sample.Along, s);
    if (walk.Setup.Biaxial)
    {
      // On axes of its own each part keeps its precision.
      const V second = hn::NegMulAdd(unmoved, sample.Rest[0], Dot(t, sample.M));
      const V third = hn::NegMulAdd(unmoved, sample.Rest[1], Dot(t, sample.ThirdAxis));
      const V es = hn::Mul(sample.Second, second);
      const V bt = hn::Mul(sample.Across, third);
      frame.Across2 = hn::MulAdd(bt, third, hn::Mul(es, second));
      frame.Slope = hn::MulAdd(ks, Dot(sample.U, g),
        hn::MulAdd(bt, Dot(sample.ThirdAxis, g), hn::Mul(es, Dot(sample.M, g))));
      if constexpr (squares)
      {
        frame.Slope2 = hn::MulAdd(ks, ks, hn::MulAdd(bt, bt, hn::Mul(es, es)));
      }
    }
    else
    {
      frame.Across2 = hn::Mul(sample.Across, Dot(t, t));
      // s is rounded and u has not quite length 1: what t still has of u is large beside it. It does
      // not change t² but g . t.
      const V rest = Dot(t, sample.U);
      frame.Slope = hn::MulAdd(hn::NegMulAdd(sample.Across, rest, ks), Dot(sample.U, g),
        hn::Mul(sample.Across, Dot(t, g)));
      if constexpr (squares)
      {
        frame.Slope2 = hn::MulAdd(ks, ks, hn::Mul(sample.Across, frame.Across2));
      }
    }
    frame.Q = hn::MulAdd(ks, s, frame.Across2);
    if (Walk::Variant && !walk.Params.MetricInProjection)
    {
      frame.Slope = hn::MulAdd(s, Dot(sample.U, g), Dot(t, g));
      frame.Slope2 = hn::MulAdd(s, s, Dot(t, t));
    }
  }
  return frame;
}

/// Profile of the surflet: its weight, and what its slope is multiplied by.
template <int N, class Walk>
STAGE_INLINE V GetWeight(const Walk& walk, const Sample<N>& sample, const Corner<N>& corner,
  LocalFrame<N>& frame, V& amplitude)
{
  V weight;
  if constexpr (Walk::Variant)
  {
    weight = GetWindow(walk, frame.Offset);
    if (walk.Params.Surflet == Basis::Streaks)
    {
      const V across = hn::Sqrt(hn::Max(frame.Across2, hn::Zero(DF())));
      weight = hn::Mul(hn::Mul(weight, sample.Sense),
        hn::Mul(StreakProfile(hn::Neg(frame.Sigma)), FadeOf(walk.Params.Interpolant, across)));
    }
    else if (walk.Params.AnisotropicWeight)
    {
      weight = hn::Mul(weight, FadeOf(walk.Params.Interpolant, frame.Q));
    }
    amplitude = hn::Mul(corner.Amplitude, weight);
    if (walk.Params.Surflet != Basis::Gradient)
    {
      frame.Slope = walk.Params.Surflet == Basis::Value ? corner.Gradient[0] : Const(1.0f);
      frame.Slope2 = Const(1.0f);
    }
  }
  else
  {
    const V away = hn::Mul(hn::Abs(frame.Offset[0]), walk.InverseReach);
    amplitude = weight = hn::Mul(corner.RowWindow, QuinticFades(away, frame.Q));
  }
  return weight;
}

/// Adds the surflet of a corner. Sums that `Normalize` has no use for are left out.
template <bool Curved, Normalization Normalize, int N, class Walk>
STAGE_INLINE void AddSurflet(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner, Sums& sums)
{
  constexpr bool squares = Normalize == Normalization::UnitVariance;
  LocalFrame<N> frame = GetLocalFrame<Curved, squares>(walk, sample, corner);
  V amplitude;
  const V weight = GetWeight(walk, sample, corner, frame, amplitude);
  sums.Noise = hn::MulAdd(amplitude, frame.Slope, sums.Noise);
  if constexpr (Normalize == Normalization::WeightSum)
  {
    sums.Weight = hn::Add(sums.Weight, weight);
  }
  if constexpr (squares)
  {
    sums.Variance = hn::MulAdd(hn::Mul(weight, weight), frame.Slope2, sums.Variance);
  }
}

} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
