// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Registers of samples or of corners and what every stage does with them. This file and the others
 * of the fast path are compiled once for each SIMD level: SteerableNoise.cxx includes them inside
 * Highway's per-target pass, hence the guards that let each in once per pass.
 *
 * A register holds one number of several samples. Every lane follows the same arithmetic whatever
 * its neighbours are: corners that only another lane needs add exactly 0.
 */
#if defined(STEERABLE_FAST_REGISTERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_REGISTERS_INL_H
#undef STEERABLE_FAST_REGISTERS_INL_H
#else
#define STEERABLE_FAST_REGISTERS_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

#undef STAGE_INLINE
// What is called for every register is inlined; instrumented builds take too long over that.
#ifdef STEERABLENOISE_INSTRUMENTED
#define STAGE_INLINE inline
#else
#define STAGE_INLINE HWY_INLINE
#endif

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::ScalableTag<std::int32_t>;
using DU = hn::ScalableTag<std::uint32_t>;
using DD = hn::ScalableTag<double>;
using DFH = hn::Rebind<float, DD>;
using V = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using VD = hn::Vec<DD>;

constexpr std::size_t Lanes = hn::MaxLanes(DF());

HWY_INLINE V Const(float value)
{
  return hn::Set(DF(), value);
}

HWY_INLINE V Load(const float* p)
{
  return hn::LoadU(DF(), p);
}

template <int N>
HWY_INLINE V Dot(const V (&a)[N], const V (&b)[N])
{
  V sum = hn::Mul(a[0], b[0]);
  for (int i = 1; i < N; ++i)
  {
    sum = hn::MulAdd(a[i], b[i], sum);
  }
  return sum;
}

HWY_INLINE void Cross(const V (&a)[3], const V (&b)[3], V (&cross)[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int j = (axis + 1) % 3;
    const int k = (axis + 2) % 3;
    cross[axis] = hn::MulSub(a[j], b[k], hn::Mul(a[k], b[j]));
  }
}

/// A unit vector across u, which has length 1: along u x x or u x y.
HWY_INLINE void AnyAcross(const V (&u)[3], V (&across)[3])
{
  const V zero = hn::Zero(DF());
  const auto byX = hn::Lt(hn::Abs(u[0]), hn::Set(DF(), 0.7f));
  across[0] = hn::IfThenElse(byX, zero, hn::Neg(u[2]));
  across[1] = hn::IfThenElseZero(byX, u[2]);
  across[2] = hn::IfThenElse(byX, hn::Neg(u[1]), u[0]);
  const V length = hn::Sqrt(Dot(across, across));
  for (V& component : across)
  {
    component = hn::Div(component, length);
  }
}

/// The nearest multiple of 2^(-23) `size`, a power of two: sums of products of few digits are
/// exact.
HWY_INLINE V RoundTo(V v, float size)
{
  const V shift = Const(1.5f * size);
  return hn::Sub(hn::Add(v, shift), shift);
}

/// Bounds of loops over corners, whatever the number is.
constexpr float FarthestCorner = 1000.0f;
HWY_INLINE int ToCorner(float place)
{
  return static_cast<int>(std::min(FarthestCorner, std::max(-FarthestCorner, place)));
}

HWY_INLINE float LeastLane(V v)
{
  return hn::GetLane(hn::MinOfLanes(DF(), v));
}

HWY_INLINE float GreatestLane(V v)
{
  return hn::GetLane(hn::MaxOfLanes(DF(), v));
}

/// first, first + 1, ... (Highway 1.0 makes them lane by lane).
HWY_INLINE VI RampInt(int first)
{
  HWY_ALIGN static constexpr std::int32_t steps[16] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,
    13, 14, 15 };
  static_assert(Lanes <= 16);
  return hn::Add(hn::Set(DI(), first), hn::Load(DI(), steps));
}

HWY_INLINE V Ramp(float first)
{
  return hn::Add(Const(first), hn::ConvertTo(DF(), RampInt(0)));
}

/// 1 / v, or that of something small.
HWY_INLINE V Inverse(V v)
{
  return hn::Div(Const(1.0f), hn::CopySign(hn::Max(hn::Abs(v), Const(1e-6f)), v));
}

/// The next tuples of three; where fewer are `left` than `tail` has room for, a copy with room.
template <typename T, std::size_t Room>
HWY_INLINE const T* GetTuples(const T* from, std::size_t left, T (&tail)[Room])
{
  if (3 * left >= Room)
  {
    return from;
  }
  std::copy(from, from + 3 * left, tail);
  return tail;
}

template <std::size_t Axes, std::size_t Room>
HWY_INLINE void LoadAll(
  const float (&arrays)[Axes][Room], std::size_t i, V (&values)[Axes])
{
  for (std::size_t axis = 0; axis < Axes; ++axis)
  {
    values[axis] = hn::Load(DF(), arrays[axis] + i);
  }
}

template <std::size_t Axes, std::size_t Room>
HWY_INLINE void StoreAll(
  const V (&values)[Axes], float (&arrays)[Axes][Room], std::size_t i)
{
  for (std::size_t axis = 0; axis < Axes; ++axis)
  {
    hn::Store(values[axis], DF(), arrays[axis] + i);
  }
}

/// Bit i is that of lane i.
HWY_INLINE std::uint64_t ToBits(hn::Mask<DF> mask)
{
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(DF(), mask, bytes);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < (Lanes + 7) / 8; ++i)
  {
    bits |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  }
  return bits;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
