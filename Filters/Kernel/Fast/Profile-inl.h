// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Parts of a surflet, as Surflet.h and LatticeHash.h have them: fades and profiles, hashes,
/// gradients.
#if defined(STEERABLE_FAST_PROFILE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_PROFILE_INL_H
#undef STEERABLE_FAST_PROFILE_INL_H
#else
#define STEERABLE_FAST_PROFILE_INL_H
#endif

#include "Fast/Registers-inl.h"
#include "LatticeHash.h"
#include "NoiseParameters.h"
#include "Surflet.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/**
 * Kensler's quintic for t >= 0, exactly 0 from t = 1 on. With r = 1 - t it is r³ (6t² + 3t + 1),
 * which keeps its relative precision where it is small: normalisation would show what is lost
 * there. Here r and the other factor.
 */
HWY_INLINE V QuinticFactors(V t, V& inner)
{
  t = hn::Min(t, Const(1.0f));
  inner = hn::MulAdd(hn::MulAdd(Const(6.0f), t, Const(3.0f)), t, Const(1.0f));
  return hn::Sub(Const(1.0f), t);
}

HWY_INLINE V QuinticFade(V t)
{
  V inner;
  const V r = QuinticFactors(t, inner);
  return hn::Mul(hn::Mul(hn::Mul(r, r), r), inner);
}

/// The same at 1 - r, of an r that was not rounded as 1 - t would be.
HWY_INLINE V QuinticFadeOfRest(V r)
{
  r = hn::Max(r, hn::Zero(DF()));
  const V t = hn::Sub(Const(1.0f), r);
  const V inner = hn::MulAdd(hn::MulAdd(Const(6.0f), t, Const(3.0f)), t, Const(1.0f));
  return hn::Mul(hn::Mul(hn::Mul(r, r), r), inner);
}

/// Product of two fades.
HWY_INLINE V QuinticFades(V t, V u)
{
  V inner;
  V other;
  const V r = hn::Mul(QuinticFactors(t, inner), QuinticFactors(u, other));
  return hn::Mul(hn::Mul(hn::Mul(r, r), r), hn::Mul(inner, other));
}

/// The same with its absolute precision only, two operations less: enough for a sum that nothing
/// divides.
HWY_INLINE V PlainQuinticFade(V t)
{
  t = hn::Min(t, Const(1.0f));
  const V inner = hn::MulAdd(hn::MulAdd(Const(6.0f), t, Const(-15.0f)), t, Const(10.0f));
  return hn::NegMulAdd(inner, hn::Mul(hn::Mul(t, t), t), Const(1.0f));
}

HWY_INLINE V FadeOf(Fade fade, V t)
{
  t = hn::Abs(t);
  switch (fade)
  {
    case Fade::Cubic:
    {
      t = hn::Min(t, Const(1.0f));
      return hn::NegMulAdd(hn::NegMulAdd(Const(2.0f), t, Const(3.0f)), hn::Mul(t, t), Const(1.0f));
    }
    case Fade::Wide:
    {
      const V s = hn::Max(hn::NegMulAdd(Const(0.25f), hn::Mul(t, t), Const(1.0f)), Const(0.0f));
      const V s2 = hn::Mul(s, s);
      return hn::Mul(hn::MulAdd(Const(4.0f), s, Const(-3.0f)), hn::Mul(s2, s2));
    }
    case Fade::Quintic:
    default:
      return QuinticFade(t);
  }
}

/// sin(πx) and cos(πx) for x in [-1/2, 1/2]: minimax polynomials, errors 4e-9 and 5e-8.
HWY_INLINE V SinPi(V x)
{
  const V y = hn::Mul(x, x);
  V p = hn::MulAdd(Const(0.0772201289f), y, Const(-0.598045174f));
  p = hn::MulAdd(p, y, Const(2.55003138f));
  p = hn::MulAdd(p, y, Const(-5.16770688f));
  p = hn::MulAdd(p, y, Const(3.14159258f));
  return hn::Mul(p, x);
}

HWY_INLINE V CosPi(V x)
{
  const V y = hn::Mul(x, x);
  V p = hn::MulAdd(Const(0.219696798f), y, Const(-1.33188016f));
  p = hn::MulAdd(p, y, Const(4.05841191f));
  p = hn::MulAdd(p, y, Const(-4.93479286f));
  return hn::MulAdd(p, y, Const(0.999999953f));
}

HWY_INLINE VU HashOneAxis(VU coordinate, int axis)
{
  VU h = hn::Mul(coordinate, hn::Set(DU(), HashAxis[axis]));
  h = hn::Xor(h, hn::ShiftRight<HashAxisShift>(h));
  return hn::Mul(h, hn::Set(DU(), HashAxisFinal[axis]));
}

HWY_INLINE VU HashJoinAxes(VU h)
{
  h = hn::Xor(h, hn::ShiftRight<HashJoinShift>(h));
  h = hn::Mul(h, hn::Set(DU(), HashJoin));
  return hn::Xor(h, hn::ShiftRight<HashJoinShift>(h));
}

HWY_INLINE VU HashStream(VU hash, std::uint32_t stream)
{
  return HashJoinAxes(hn::Add(hash, hn::Set(DU(), stream * HashSeed)));
}

HWY_INLINE V HashToUnit(VU hash)
{
  return hn::Mul(
    hn::ConvertTo(DF(), hn::BitCast(DI(), hn::ShiftRight<8>(hash))), Const(1.0f / 16777216.0f));
}

/// The bits as a signed number in steps of 2^-32: [-1/2, 1/2).
HWY_INLINE V HashToSigned(VU hash)
{
  return hn::Mul(hn::ConvertTo(DF(), hn::BitCast(DI(), hash)), Const(1.0f / 4294967296.0f));
}

/// The top bit chooses between a uniform gradient and its negative.
HWY_INLINE V UniformSign(VU hash)
{
  return hn::BitCast(DF(), hn::And(hash, hn::Set(DU(), 0x80000000u)));
}

/// Uniform gradient but for its sign: a direction in the plane, and in 3D what it is multiplied by,
/// and the height.
HWY_INLINE void UniformTurn(VU hash, V& cosine, V& sine)
{
  const V turn = HashToSigned(hn::ShiftLeft<1>(hash));
  cosine = CosPi(turn);
  sine = SinPi(turn);
}

HWY_INLINE void UniformTurn(VU hash, V& cosine, V& sine, V& radius, V& height)
{
  const VU heightBits = hn::And(hn::ShiftLeft<1>(hash), hn::Set(DU(), 0xFFFE0000u));
  height = hn::MulAdd(hn::ConvertTo(DF(), hn::BitCast(DI(), heightBits)),
    Const(1.0f / 2147483648.0f), Const(1.0f / 32768.0f));
  radius = hn::Sqrt(hn::NegMulAdd(height, height, Const(1.0f)));
  const V turn = hn::MulAdd(hn::ConvertTo(DF(), hn::BitCast(DI(), hn::ShiftLeft<16>(hash))),
    Const(1.0f / 4294967296.0f), Const(1.0f / 131072.0f));
  cosine = CosPi(turn);
  sine = SinPi(turn);
}

HWY_INLINE void UniformGradient(VU hash, V (&g)[2])
{
  const V sign = UniformSign(hash);
  UniformTurn(hash, g[0], g[1]);
  g[0] = hn::Xor(g[0], sign);
  g[1] = hn::Xor(g[1], sign);
}

HWY_INLINE void UniformGradient(VU hash, V (&g)[3])
{
  const V sign = UniformSign(hash);
  V radius;
  UniformTurn(hash, g[0], g[1], radius, g[2]);
  radius = hn::Xor(radius, sign);
  g[0] = hn::Mul(radius, g[0]);
  g[1] = hn::Mul(radius, g[1]);
  g[2] = hn::Xor(g[2], sign);
}

/// g . v of a uniform gradient, in fewer operations than the gradient takes.
HWY_INLINE V UniformSlope(VU hash, const V (&v)[2])
{
  V cosine;
  V sine;
  UniformTurn(hash, cosine, sine);
  return hn::Xor(hn::MulAdd(cosine, v[0], hn::Mul(sine, v[1])), UniformSign(hash));
}

HWY_INLINE V UniformSlope(VU hash, const V (&v)[3])
{
  V cosine;
  V sine;
  V radius;
  V height;
  UniformTurn(hash, cosine, sine, radius, height);
  const V inPlane = hn::MulAdd(cosine, v[0], hn::Mul(sine, v[1]));
  return hn::Xor(hn::MulAdd(radius, inPlane, hn::Mul(height, v[2])), UniformSign(hash));
}

template <int N>
HWY_INLINE void PerlinGradient(VU hash, V (&g)[N])
{
  const VU edge = hn::ShiftRight<16>(hn::Mul(hn::ShiftRight<16>(hash), hn::Set(DU(), 12u)));
  const auto signOf = [](VU bit) HWY_ATTR { return hn::BitCast(DF(), hn::ShiftLeft<31>(bit)); };
  const V one = Const(1.0f);
  const V zero = Const(0.0f);
  const V first = hn::Xor(one, signOf(edge));
  const V second = hn::Xor(one, signOf(hn::ShiftRight<1>(edge)));
  const VI signedEdge = hn::BitCast(DI(), edge);
  const auto flatZ = hn::RebindMask(DF(), hn::Lt(signedEdge, hn::Set(DI(), 4)));
  const auto flatX = hn::RebindMask(DF(), hn::Gt(signedEdge, hn::Set(DI(), 7)));
  g[0] = hn::IfThenElse(flatX, zero, first);
  g[1] = hn::IfThenElse(flatZ, second, hn::IfThenElse(flatX, first, zero));
  if constexpr (N == 3)
  {
    g[2] = hn::IfThenElse(flatZ, zero, second);
  }
}

/// A ramp that ends sharply downstream; exactly 0 outside (-1, 1).
HWY_INLINE V StreakProfile(V sigma)
{
  const V ramp = hn::MulAdd(sigma, Const(0.5f), Const(0.5f));
  const V one = Const(1.0f);
  const V perEnd = Const(1.0f / static_cast<float>(StreakEnd));
  const V end = hn::Min(hn::Mul(hn::Sub(one, sigma), perEnd), one);
  return hn::Max(hn::Mul(ramp, hn::Max(end, Const(0.0f))), Const(0.0f));
}

/// Cells come wrapped, so few steps bring an index near them back into [0, period).
inline HWY_NOINLINE VU WrapIndex(VU index, std::int64_t period)
{
  const VI cells = hn::Set(DI(), static_cast<std::int32_t>(period));
  VI i = hn::BitCast(DI(), index);
  for (;;)
  {
    const auto below = hn::Lt(i, hn::Zero(DI()));
    const auto above = hn::Not(hn::Lt(i, cells));
    if (hn::AllFalse(DI(), below) && hn::AllFalse(DI(), above))
    {
      return hn::BitCast(DU(), i);
    }
    i = hn::IfThenElse(below, hn::Add(i, cells), hn::IfThenElse(above, hn::Sub(i, cells), i));
  }
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
