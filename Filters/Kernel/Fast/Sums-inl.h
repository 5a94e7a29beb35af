// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What surflets add up to, and what becomes of the sums.
#if defined(STEERABLE_FAST_SUMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_SUMS_INL_H
#undef STEERABLE_FAST_SUMS_INL_H
#else
#define STEERABLE_FAST_SUMS_INL_H
#endif

#include "Fast/Registers-inl.h"
#include "Fast/Stages.h"
#include "Surflet.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
struct Sums
{
  // Written out, since the compiler's own constructor would not be of this SIMD level.
  STAGE_INLINE Sums()
    : Noise(hn::Zero(DF()))
    , Weight(hn::Zero(DF()))
    , Variance(hn::Zero(DF()))
  {
  }
  V Noise;
  V Weight;
  V Variance;
};

/// Variance of what a surflet is multiplied by: a gradient's component, a value, or whether there
/// is one.
inline float VarianceShare(const NoiseParameters& p, int dimension)
{
  switch (p.Basis)
  {
    case Basis::Value:
      return 1.0f / 3.0f;
    case Basis::Streaks:
      return static_cast<float>(p.GetStreakProbability());
    case Basis::Gradient:
    default:
      return static_cast<float>(GradientVariance(p.GradientSet, dimension));
  }
}

STAGE_INLINE V Normalized(const NoiseSetup& setup, int dimension, const Sums& sums)
{
  switch (setup.Parameters.Normalization)
  {
    case Normalization::WeightSum:
      return hn::IfThenElseZero(
        hn::Gt(sums.Weight, Const(0.0f)), hn::Div(sums.Noise, hn::Max(sums.Weight, Const(1e-30f))));
    case Normalization::UnitVariance:
    {
      const V share = Const(VarianceShare(setup.Parameters, dimension));
      return hn::Div(sums.Noise, hn::Sqrt(hn::MulAdd(share, sums.Variance, Const(VarianceFloor))));
    }
    case Normalization::None:
    default:
      return sums.Noise;
  }
}

/// Puts the noise of an octave into the block, or adds it to that of the octaves before.
STAGE_INLINE void AddOctave(
  const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block, std::size_t i, V noise)
{
  if (setup.Parameters.Turbulence)
  {
    noise = hn::Abs(noise);
  }
  if (setup.Octaves.size() > 1)
  {
    noise = hn::MulAdd(noise, Const(octave.Amplitude * setup.OctaveScale), Load(block.Noise + i));
  }
  hn::StoreU(noise, DF(), block.Noise + i);
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
