// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Corners with what samples need to know of them: gradient, jitter, clock.
#if defined(STEERABLE_FAST_WALK_CORNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_CORNERS_INL_H
#undef STEERABLE_FAST_WALK_CORNERS_INL_H
#else
#define STEERABLE_FAST_WALK_CORNERS_INL_H
#endif

#include "Fast/Walk/Lattice-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Corners of a list, or lattice rows, that go through the stages together: a bit for each.
constexpr std::size_t ListSize = 128;
constexpr std::size_t ListWords = ListSize / 64;
using ListBits = std::uint64_t[ListWords];

/// Corners that may be in reach, and what samples need to know of them.
template <int N>
struct CornerList
{
  std::size_t Count = 0;
  /// How many of them have been sifted.
  std::size_t Sifted = 0;
  /// From the cell that the tile counts from. There is room for a register behind.
  HWY_ALIGN std::int32_t Index[N][ListSize + 16];
  HWY_ALIGN float Offset[N][ListSize];
  HWY_ALIGN float Gradient[N][ListSize];
  /// Of variants: displacement of the corner, (τ - 1/2) Speed, and what the surflet is multiplied
  /// by.
  HWY_ALIGN float Jitter[N][ListSize];
  HWY_ALIGN float Travel[ListSize];
  HWY_ALIGN float Amplitude[ListSize];
};

/// The same of a corner for the lanes of a register.
template <int N>
struct Corner
{
  V Offset[N];
  V Gradient[N];
  V Jitter[N];
  V Travel;
  V Amplitude;

  STAGE_INLINE Corner() {}
  /// One corner of a list for all lanes.
  STAGE_INLINE Corner(const CornerList<N>& list, std::size_t i)
    : Travel(Const(list.Travel[i]))
    , Amplitude(Const(list.Amplitude[i]))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Offset[axis] = Const(list.Offset[axis][i]);
      this->Gradient[axis] = Const(list.Gradient[axis][i]);
      this->Jitter[axis] = Const(list.Jitter[axis][i]);
    }
  }
};

/// Corners at these offsets, with these bits.
template <int N, class Walk>
STAGE_INLINE Corner<N> Describe(const Walk& walk, const V (&offset)[N], VU hash)
{
  Corner<N> corner;
  if (!Walk::Variant ||
    (walk.Params.Basis == Basis::Gradient && walk.Params.GradientSet == GradientSet::Uniform))
  {
    UniformGradient(hash, corner.Gradient);
  }
  else if (walk.Params.Basis == Basis::Gradient)
  {
    PerlinGradient<N>(hash, corner.Gradient);
  }
  else
  {
    // The value.
    std::fill(corner.Gradient, corner.Gradient + N, hn::Mul(HashToSigned(hash), Const(2.0f)));
  }
  for (int axis = 0; axis < N; ++axis)
  {
    corner.Offset[axis] = offset[axis];
    if (walk.IsJittered())
    {
      corner.Jitter[axis] = GetJitter(walk, hash, axis);
    }
  }
  if constexpr (Walk::Variant)
  {
    corner.Amplitude = Const(1.0f);
    if (walk.Params.Motion)
    {
      const V clock = hn::Add(HashToUnit(HashStream(hash, 1)),
        Const(static_cast<float>(walk.Params.Phase - std::floor(walk.Params.Phase))));
      const V tau = hn::Sub(clock, hn::Floor(clock));
      const V centered = hn::Sub(tau, Const(0.5f));
      corner.Travel = hn::Mul(centered, Const(static_cast<float>(walk.Params.Speed)));
      const V wave = CosPi(centered); // sin(π τ)
      corner.Amplitude = hn::Mul(hn::Mul(wave, wave), Const(static_cast<float>(MotionAmplitude)));
    }
    if (walk.Params.Basis == Basis::Streaks)
    {
      const auto on = hn::Lt(HashToUnit(HashStream(hash, 2)),
        Const(static_cast<float>(walk.Params.GetStreakProbability())));
      corner.Amplitude = hn::IfThenElseZero(on, corner.Amplitude);
    }
  }
  return corner;
}

/// Writes a register of corners to the list.
template <int N, class Walk>
STAGE_INLINE void Put(
  const Walk& walk, const Corner<N>& corner, CornerList<N>& list, std::size_t i)
{
  StoreAll(corner.Offset, list.Offset, i);
  StoreAll(corner.Gradient, list.Gradient, i);
  if (walk.IsJittered())
  {
    StoreAll(corner.Jitter, list.Jitter, i);
  }
  if constexpr (Walk::Variant)
  {
    hn::Store(corner.Travel, DF(), list.Travel + i);
    hn::Store(corner.Amplitude, DF(), list.Amplitude + i);
  }
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
