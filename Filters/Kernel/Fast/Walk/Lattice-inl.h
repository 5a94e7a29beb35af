// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Indices of the lattice and its places: oblique steps, jitter, periods and the hash.
#if defined(STEERABLE_FAST_WALK_LATTICE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_LATTICE_INL_H
#undef STEERABLE_FAST_WALK_LATTICE_INL_H
#else
#define STEERABLE_FAST_WALK_LATTICE_INL_H
#endif

#include "Fast/Profile-inl.h"
#include "Fast/Walk/WalkSetup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// From indices of the lattice to its places.
template <int N, class Walk>
STAGE_INLINE void ToPlace(const Walk& walk, const V (&index)[N], V (&place)[N])
{
  for (int i = 0; i < N; ++i)
  {
    place[i] = index[i];
    if (walk.IsOblique())
    {
      place[i] = hn::Mul(index[0], Const(walk.Setup.LatticeSteps[i][0]));
      for (int j = 1; j < N; ++j)
      {
        place[i] = hn::MulAdd(index[j], Const(walk.Setup.LatticeSteps[i][j]), place[i]);
      }
    }
  }
}

/// The same of a vector, in place; the steps of the lattice have length 1 at most.
template <int N, class Walk>
STAGE_INLINE void ToDistances(const Walk& walk, V (&place)[N])
{
  V index[N];
  std::copy(place, place + N, index);
  ToPlace(walk, index, place);
}

/// Adds to the bits of corners what their indices on one axis give, counted from `origin`.
template <int N, class Walk>
STAGE_INLINE VU HashAxis(
  const Walk& walk, const VU (&origin)[N], int axis, VI corner, VU hash)
{
  VU index = hn::Add(origin[axis], hn::BitCast(DU(), corner));
  if (walk.Octave.Period[axis] > 0)
  {
    index = WrapIndex(index, walk.Octave.Period[axis]);
  }
  return hn::Xor(hash, HashOneAxis(index, axis));
}

/// Bits of the corners at these indices from `origin`.
template <int N, class Walk>
STAGE_INLINE VU HashCorners(const Walk& walk, const VU (&origin)[N], const VI (&corner)[N])
{
  VU hash = hn::Set(DU(), walk.Octave.Seed);
  for (int axis = 0; axis < N; ++axis)
  {
    hash = HashAxis(walk, origin, axis, corner[axis], hash);
  }
  return HashJoinAxes(hash);
}

template <class Walk>
STAGE_INLINE V GetJitter(const Walk& walk, VU hash, int axis)
{
  return hn::Sub(HashToUnit(HashStream(hash, 3 + axis)), Const(walk.Setup.JitterDown));
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
