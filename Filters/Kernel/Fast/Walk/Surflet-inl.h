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
/// What surflets take into account: bends, which sums are wanted, and in space a second axis.
template <bool IsCurved, Normalization Sum, bool IsBiaxial>
struct SurfletKind
{
  static constexpr bool Curved = IsCurved;
  static constexpr Normalization Normalize = Sum;
  static constexpr bool Squares = Sum == Normalization::UnitVariance;
  static constexpr bool Biaxial = IsBiaxial;
};

/// A register of samples with what surflets need of them.
template <int N>
struct Sample
{
  /// Whole cells from where offsets count, and the fraction.
  V Shift[N];
  V Fraction[N];
  V U[N];
  V HalfBend[N];
  V Along;
  V Across;
  V Directed;
  V RootAlong;
  /// What the fraction has of u.
  V AlongFraction;
  /// Of metrics with a second axis: it, u x m, what u lacks on them, and the eigenvalue.
  V M[N];
  V ThirdAxis[N];
  V Rest[2];
  V Second;
  /// 2D: the normal n = (-u_y, u_x), also in two parts, see GetAlongAndAcross; what the fraction
  /// has of n in two parts; and κ/2.
  V Normal[2];
  V HighNormal[2];
  V LowNormal[2];
  V HighAcross;
  V LowAcross;
  V HalfKappa;

  STAGE_INLINE Sample(
    const NoiseSetup& setup, const MetricBlock& block, std::size_t i, const VU (&cell)[N])
    : Along(Load((setup.Curved ? block.BentAlong : block.Along) + i))
    , Across(Load((setup.Curved ? block.BentAcross : block.Across) + i))
    , Directed(Load(block.Directed + i))
    , RootAlong(hn::Sqrt(Along))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Shift[axis] = hn::ConvertTo(
        DF(), hn::BitCast(DI(), hn::Sub(hn::LoadU(DU(), block.Cell[axis] + i), cell[axis])));
      this->Fraction[axis] = Load(block.Fraction[axis] + i);
      this->U[axis] = Load(block.U[axis] + i);
      this->HalfBend[axis] = setup.Curved
        ? hn::Mul(Const(0.5f), Load(block.ClampedBend[axis] + i))
        : hn::Zero(DF());
    }
    this->AlongFraction = Dot(this->U, this->Fraction);
    if constexpr (N == 3)
    {
      if (setup.Biaxial)
      {
        this->Second = Load((setup.Curved ? block.BentSecond : block.Second) + i);
        for (int axis = 0; axis < N; ++axis)
        {
          this->M[axis] = Load(block.M[axis] + i);
        }
        Cross(this->U, this->M, this->ThirdAxis);
        this->Rest[0] = Load(block.URest[0] + i);
        this->Rest[1] = Load(block.URest[1] + i);
      }
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
      this->HighAcross = Dot(this->HighNormal, high);
      this->LowAcross = hn::Add(Dot(this->HighNormal, low), Dot(this->LowNormal, this->Fraction));
      this->HalfKappa = Dot(this->Normal, this->HalfBend);
    }
  }
};

/// The window over the axes of the lattice; plain ones are quintic and separable.
template <int N, class Walk>
STAGE_INLINE V GetWindow(const Walk& walk, const V (&v)[N])
{
  if constexpr (!Walk::Variant)
  {
    V window = QuinticFade(hn::Mul(hn::Abs(v[0]), walk.InverseReach));
    for (int axis = 1; axis < N; ++axis)
    {
      window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v[axis]), walk.InverseReach)));
    }
    return window;
  }
  const Fade fade = walk.Params.Fade;
  if (walk.Params.Falloff == Falloff::Radial)
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

/**
 * What surflets add up to. Those of variants, of metrics with a second axis, and in space of the
 * paper's model add noise and
 * variance one by one. Others leave to the end what does not differ from corner to corner, see
 * GetSums: with the weight w they add w s g and w t g, in space w (k s) g and w (t g), and for the
 * variance the squares.
 */
template <int N>
struct SurfletSums
{
  static constexpr int Across = N == 2 ? 2 : 1;
  V Noise;
  V Weight;
  V Variance;
  V AlongFlow[N];
  V AcrossFlow[Across];
  V AcrossVariance;

  /// Between lists sums wait here: a copy of registers in an array would keep them out of
  /// registers.
  struct Stored
  {
    HWY_ALIGN float Values[4 + N + Across][Lanes];
  };

  STAGE_INLINE SurfletSums()
    : Noise(hn::Zero(DF()))
    , Weight(hn::Zero(DF()))
    , Variance(hn::Zero(DF()))
    , AcrossVariance(hn::Zero(DF()))
  {
    for (V& sum : this->AlongFlow)
    {
      sum = hn::Zero(DF());
    }
    for (V& sum : this->AcrossFlow)
    {
      sum = hn::Zero(DF());
    }
  }
  STAGE_INLINE explicit SurfletSums(const Stored& from)
    : Noise(hn::Load(DF(), from.Values[0]))
    , Weight(hn::Load(DF(), from.Values[1]))
    , Variance(hn::Load(DF(), from.Values[2]))
    , AcrossVariance(hn::Load(DF(), from.Values[3]))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->AlongFlow[axis] = hn::Load(DF(), from.Values[4 + axis]);
    }
    for (int axis = 0; axis < Across; ++axis)
    {
      this->AcrossFlow[axis] = hn::Load(DF(), from.Values[4 + N + axis]);
    }
  }
  STAGE_INLINE void Store(Stored& to) const
  {
    hn::Store(this->Noise, DF(), to.Values[0]);
    hn::Store(this->Weight, DF(), to.Values[1]);
    hn::Store(this->Variance, DF(), to.Values[2]);
    hn::Store(this->AcrossVariance, DF(), to.Values[3]);
    for (int axis = 0; axis < N; ++axis)
    {
      hn::Store(this->AlongFlow[axis], DF(), to.Values[4 + axis]);
    }
    for (int axis = 0; axis < Across; ++axis)
    {
      hn::Store(this->AcrossFlow[axis], DF(), to.Values[4 + N + axis]);
    }
  }
};

/// Noise, weight and variance of the samples from `i` on.
template <int N, class Walk>
STAGE_INLINE Sums GetSums(const Walk& walk, std::size_t i, const SurfletSums<N>& from)
{
  Sums sums;
  sums.Noise = from.Noise;
  sums.Weight = from.Weight;
  sums.Variance = from.Variance;
  if (Walk::Variant || walk.Setup.Biaxial || (N == 3 && Walk::Windowed))
  {
    return sums;
  }
  const V across = Load(walk.Across + i);
  V u[N];
  for (int axis = 0; axis < N; ++axis)
  {
    u[axis] = Load(walk.Block.U[axis] + i);
  }
  const V alongNoise = Dot(u, from.AlongFlow);
  const V across2 = hn::Mul(across, across);
  if constexpr (N == 2)
  {
    const V along = Load(walk.Along + i);
    const V acrossNoise =
      hn::MulSub(u[0], from.AcrossFlow[1], hn::Mul(u[1], from.AcrossFlow[0]));
    sums.Noise = hn::MulAdd(along, alongNoise, hn::Mul(across, acrossNoise));
    sums.Variance = hn::MulAdd(
      hn::Mul(along, along), from.Variance, hn::Mul(across2, from.AcrossVariance));
  }
  else
  {
    sums.Noise = hn::MulAdd(across, from.AcrossFlow[0], alongNoise);
    sums.Variance = hn::MulAdd(across2, from.AcrossVariance, from.Variance);
  }
  return sums;
}

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
      sigma = hn::MulAdd(corner.Travel, sample.Directed, sigma);
      s = hn::Div(sigma, sample.RootAlong);
    }
  }
}

/// Offset of a corner from the samples, in cells.
template <int N>
STAGE_INLINE void GetOffset(const Sample<N>& sample, const Corner<N>& corner, V (&v)[N])
{
  for (int axis = 0; axis < N; ++axis)
  {
    v[axis] = hn::Sub(hn::Sub(corner.Offset[axis], sample.Shift[axis]), sample.Fraction[axis]);
  }
}

/// Of a plain surflet in the plane: how far the corner is along the flow, and across it.
template <bool Curved>
STAGE_INLINE void GetAlongAndAcross(
  const Sample<2>& sample, const Corner<2>& corner, V& s, V& s2, V& t)
{
  // n . v of a far corner is a small difference of large products. Of the high parts of n and the
  // fraction products and, up to 256 cells, sums are exact. Where streamlines bend s² is
  // a part of it, so s is as precise there.
  const V offset[2] = { hn::Sub(corner.Offset[0], sample.Shift[0]),
    hn::Sub(corner.Offset[1], sample.Shift[1]) };
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
  s2 = hn::Mul(s, s);
  t = hn::MulAdd(high[0], offset[0], hn::MulSub(high[1], offset[1], sample.HighAcross));
  if constexpr (Curved)
  {
    // Before anything is rounded: of the sag, many cells, little is left.
    t = hn::NegMulAdd(s2, sample.HalfKappa, t);
  }
  t = hn::Add(t, hn::MulAdd(low[0], offset[0], hn::MulSub(low[1], offset[1], sample.LowAcross)));
}

/// Weight of a plain surflet; `rest`: 1 - q.
template <int N, class Walk>
STAGE_INLINE V GetPlainWeight(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner, V rest)
{
  V weight = QuinticFadeOfRest(rest);
  if constexpr (Walk::Windowed)
  {
    V v[N];
    GetOffset(sample, corner, v);
    weight = hn::Mul(weight, GetWindow(walk, v));
  }
  return weight;
}

/// Adds a plain surflet in the plane.
template <class Kind, class Walk>
STAGE_INLINE void AddPlainSurflet(
  const Walk& walk, const Sample<2>& sample, const Corner<2>& corner, SurfletSums<2>& sums)
{
  V s;
  V s2;
  V t;
  GetAlongAndAcross<Kind::Curved>(sample, corner, s, s2, t);
  const V rest =
    hn::NegMulAdd(sample.Along, s2, hn::NegMulAdd(sample.Across, hn::Mul(t, t), Const(1.0f)));
  const V weight = GetPlainWeight(walk, sample, corner, rest);
  const V along = hn::Mul(weight, s);
  const V across = hn::Mul(weight, t);
  for (int axis = 0; axis < 2; ++axis)
  {
    sums.AlongFlow[axis] = hn::MulAdd(along, corner.Gradient[axis], sums.AlongFlow[axis]);
    sums.AcrossFlow[axis] = hn::MulAdd(across, corner.Gradient[axis], sums.AcrossFlow[axis]);
  }
  if constexpr (Kind::Squares)
  {
    sums.Variance = hn::MulAdd(along, along, sums.Variance);
    sums.AcrossVariance = hn::MulAdd(across, across, sums.AcrossVariance);
  }
  if constexpr (Kind::Normalize == Normalization::WeightSum)
  {
    sums.Weight = hn::Add(sums.Weight, weight);
  }
}

/// Adds a plain surflet in space.
template <class Kind, class Walk>
STAGE_INLINE void AddPlainSurflet(
  const Walk& walk, const Sample<3>& sample, const Corner<3>& corner, SurfletSums<3>& sums)
{
  const V(&g)[3] = corner.Gradient;
  V offset[3];
  for (int i = 0; i < 3; ++i)
  {
    offset[i] = hn::Sub(corner.Offset[i], sample.Shift[i]);
  }
  V t[3];
  V weight;
  if constexpr (Walk::Windowed && !Kind::Biaxial)
  {
    // Many corners under a window have small weights, which need each of these roundings.
    V v[3];
    GetOffset(sample, corner, v);
    const V s = Dot(v, sample.U);
    const V s2 = hn::Mul(s, s);
    for (int i = 0; i < 3; ++i)
    {
      t[i] = Kind::Curved
        ? hn::Sub(hn::NegMulAdd(s, sample.U[i],
                    hn::NegMulAdd(s2, sample.HalfBend[i], offset[i])),
            sample.Fraction[i])
        : hn::NegMulAdd(s, sample.U[i], v[i]);
    }
    const V ks = hn::Mul(sample.Along, s);
    const V across2 = hn::Mul(sample.Across, Dot(t, t));
    const V rest = Dot(t, sample.U);
    const V slope = hn::MulAdd(hn::NegMulAdd(sample.Across, rest, ks), Dot(sample.U, g),
      hn::Mul(sample.Across, Dot(t, g)));
    V window = Const(1.0f);
    for (int i = 1; i < 3; ++i)
    {
      window = hn::Mul(window, QuinticFade(hn::Mul(hn::Abs(v[i]), walk.InverseReach)));
    }
    weight = hn::Mul(window,
      QuinticFades(hn::Mul(hn::Abs(v[0]), walk.InverseReach), hn::MulAdd(ks, s, across2)));
    sums.Noise = hn::MulAdd(weight, slope, sums.Noise);
    if constexpr (Kind::Squares)
    {
      const V slope2 = hn::MulAdd(ks, ks, hn::Mul(sample.Across, across2));
      sums.Variance = hn::MulAdd(hn::Mul(weight, weight), slope2, sums.Variance);
    }
  }
  else if constexpr (Kind::Biaxial)
  {
    // On axes of its own each part keeps its precision.
    V v[3];
    GetOffset(sample, corner, v);
    const V s = Dot(v, sample.U);
    const V s2 = hn::Mul(s, s);
    for (int i = 0; i < 3; ++i)
    {
      t[i] = hn::NegMulAdd(s, sample.U[i], v[i]);
      t[i] = Kind::Curved ? hn::NegMulAdd(s2, sample.HalfBend[i], t[i]) : t[i];
    }
    const V second = hn::NegMulAdd(s, sample.Rest[0], Dot(t, sample.M));
    const V third = hn::NegMulAdd(s, sample.Rest[1], Dot(t, sample.ThirdAxis));
    const V ks = hn::Mul(sample.Along, s);
    const V es = hn::Mul(sample.Second, second);
    const V bt = hn::Mul(sample.Across, third);
    weight = GetPlainWeight(walk, sample, corner,
      hn::NegMulAdd(ks, s, hn::NegMulAdd(bt, third, hn::NegMulAdd(es, second, Const(1.0f)))));
    const V slope = hn::MulAdd(ks, Dot(sample.U, g),
      hn::MulAdd(bt, Dot(sample.ThirdAxis, g), hn::Mul(es, Dot(sample.M, g))));
    sums.Noise = hn::MulAdd(weight, slope, sums.Noise);
    if constexpr (Kind::Squares)
    {
      const V slope2 = hn::MulAdd(ks, ks, hn::MulAdd(bt, bt, hn::Mul(es, es)));
      sums.Variance = hn::MulAdd(hn::Mul(weight, weight), slope2, sums.Variance);
    }
  }
  else
  {
    V s;
    V s2;
    if constexpr (Kind::Curved)
    {
      // As in the plane: the offset is exact, and of the sag, many cells, little is left.
      s = hn::MulAdd(sample.U[2], offset[2],
        hn::MulAdd(
          sample.U[1], offset[1], hn::MulSub(sample.U[0], offset[0], sample.AlongFraction)));
      s2 = hn::Mul(s, s);
      for (int i = 0; i < 3; ++i)
      {
        t[i] = hn::NegMulAdd(s2, sample.HalfBend[i], offset[i]);
        t[i] = hn::Sub(hn::NegMulAdd(s, sample.U[i], t[i]), sample.Fraction[i]);
      }
    }
    else
    {
      V v[3];
      GetOffset(sample, corner, v);
      s = Dot(v, sample.U);
      s2 = hn::Mul(s, s);
      for (int i = 0; i < 3; ++i)
      {
        t[i] = hn::NegMulAdd(s, sample.U[i], v[i]);
      }
    }
    const V t2 = Dot(t, t);
    weight = GetPlainWeight(walk, sample, corner,
      hn::NegMulAdd(sample.Along, s2, hn::NegMulAdd(sample.Across, t2, Const(1.0f))));
    // s is rounded and u has not quite length 1: what t still has of u is large beside it. It does
    // not change t² but g . t.
    const V rest = Dot(t, sample.U);
    const V slope = hn::NegMulAdd(sample.Across, rest, hn::Mul(sample.Along, s));
    const V along = hn::Mul(weight, slope);
    for (int i = 0; i < 3; ++i)
    {
      sums.AlongFlow[i] = hn::MulAdd(along, g[i], sums.AlongFlow[i]);
    }
    sums.AcrossFlow[0] = hn::MulAdd(weight, Dot(t, g), sums.AcrossFlow[0]);
    if constexpr (Kind::Squares)
    {
      sums.Variance = hn::MulAdd(along, along, sums.Variance);
      sums.AcrossVariance = hn::MulAdd(hn::Mul(weight, weight), t2, sums.AcrossVariance);
    }
  }
  if constexpr (Kind::Normalize == Normalization::WeightSum)
  {
    sums.Weight = hn::Add(sums.Weight, weight);
  }
}

/// A corner as a register of samples sees it, of variants.
template <int N>
struct LocalFrame
{
  V Offset[N];
  /// √k s.
  V Sigma;
  /// b t², and q = k s² + b t².
  V Across2;
  V Q;
  /// What the gradient makes of the offset, g G v', and |G v'|².
  V Slope;
  V Slope2;

  STAGE_INLINE LocalFrame() {}
};

template <int N, class Walk>
STAGE_INLINE LocalFrame<N> GetLocalFrame(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner)
{
  const V(&g)[N] = corner.Gradient;
  LocalFrame<N> frame;
  V index[N];
  GetOffset(sample, corner, index);
  ToPlace(walk, index, frame.Offset);
  for (int axis = 0; axis < N && walk.IsJittered(); ++axis)
  {
    frame.Offset[axis] = hn::Add(frame.Offset[axis], corner.Jitter[axis]);
  }
  V s = Dot(frame.Offset, sample.U);
  const V unmoved = s;
  const V s2 = hn::Mul(s, s);
  if constexpr (N == 2)
  {
    const V t = hn::NegMulAdd(s2, sample.HalfKappa, Dot(frame.Offset, sample.Normal));
    Travel(walk, sample, corner, s, frame.Sigma);
    const V ks = hn::Mul(sample.Along, s);
    const V bt = hn::Mul(sample.Across, t);
    frame.Across2 = hn::Mul(bt, t);
    frame.Q = hn::MulAdd(ks, s, frame.Across2);
    frame.Slope = hn::MulAdd(ks, Dot(sample.U, g), hn::Mul(bt, Dot(sample.Normal, g)));
    frame.Slope2 = hn::MulAdd(ks, ks, hn::Mul(bt, bt));
    if (!walk.Params.MetricInProjection)
    {
      frame.Slope = hn::MulAdd(s, Dot(sample.U, g), hn::Mul(t, Dot(sample.Normal, g)));
      frame.Slope2 = hn::MulAdd(s, s, hn::Mul(t, t));
    }
  }
  else
  {
    V t[N];
    for (int i = 0; i < N; ++i)
    {
      t[i] = hn::NegMulAdd(s, sample.U[i], frame.Offset[i]);
      t[i] = hn::NegMulAdd(s2, sample.HalfBend[i], t[i]);
    }
    Travel(walk, sample, corner, s, frame.Sigma);
    const V ks = hn::Mul(sample.Along, s);
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
      frame.Slope2 = hn::MulAdd(ks, ks, hn::MulAdd(bt, bt, hn::Mul(es, es)));
    }
    else
    {
      frame.Across2 = hn::Mul(sample.Across, Dot(t, t));
      // As for plain ones.
      const V rest = Dot(t, sample.U);
      frame.Slope = hn::MulAdd(hn::NegMulAdd(sample.Across, rest, ks), Dot(sample.U, g),
        hn::Mul(sample.Across, Dot(t, g)));
      frame.Slope2 = hn::MulAdd(ks, ks, hn::Mul(sample.Across, frame.Across2));
    }
    frame.Q = hn::MulAdd(ks, s, frame.Across2);
    if (!walk.Params.MetricInProjection)
    {
      frame.Slope = hn::MulAdd(s, Dot(sample.U, g), Dot(t, g));
      frame.Slope2 = hn::MulAdd(s, s, Dot(t, t));
    }
  }
  return frame;
}

/// Profile of a variant's surflet.
template <int N, class Walk>
STAGE_INLINE V GetWeight(const Walk& walk, const Sample<N>& sample, const LocalFrame<N>& frame)
{
  const V window = GetWindow(walk, frame.Offset);
  if (walk.Params.Basis == Basis::Streaks)
  {
    const V across = hn::Sqrt(hn::Max(frame.Across2, hn::Zero(DF())));
    return hn::Mul(hn::Mul(window, sample.Directed),
      hn::Mul(StreakProfile(hn::Neg(frame.Sigma)), FadeOf(walk.Params.Fade, across)));
  }
  return walk.Params.AnisotropicWeight
    ? hn::Mul(window, FadeOf(walk.Params.Fade, frame.Q))
    : window;
}

/// Adds a surflet of a variant.
template <class Kind, int N, class Walk>
STAGE_INLINE void AddVariantSurflet(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner, SurfletSums<N>& sums)
{
  LocalFrame<N> frame = GetLocalFrame(walk, sample, corner);
  const V weight = GetWeight(walk, sample, frame);
  if (walk.Params.Basis != Basis::Gradient)
  {
    frame.Slope = walk.Params.Basis == Basis::Value ? corner.Gradient[0] : Const(1.0f);
    frame.Slope2 = Const(1.0f);
  }
  sums.Noise = hn::MulAdd(hn::Mul(corner.Amplitude, weight), frame.Slope, sums.Noise);
  if constexpr (Kind::Normalize == Normalization::WeightSum)
  {
    sums.Weight = hn::Add(sums.Weight, weight);
  }
  if constexpr (Kind::Squares)
  {
    sums.Variance = hn::MulAdd(hn::Mul(weight, weight), frame.Slope2, sums.Variance);
  }
}

/// Adds the surflet of a corner to the sums of a register of samples.
template <class Kind, int N, class Walk>
STAGE_INLINE void AddSurflet(
  const Walk& walk, const Sample<N>& sample, const Corner<N>& corner, SurfletSums<N>& sums)
{
  if constexpr (Walk::Variant)
  {
    AddVariantSurflet<Kind>(walk, sample, corner, sums);
  }
  else
  {
    AddPlainSurflet<Kind>(walk, sample, corner, sums);
  }
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
