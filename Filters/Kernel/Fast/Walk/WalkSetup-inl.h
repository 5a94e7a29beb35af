// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the stages of a walk read: one octave of the samples of a block.
#if defined(STEERABLE_FAST_WALK_SETUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_WALK_SETUP_INL_H
#undef STEERABLE_FAST_WALK_SETUP_INL_H
#else
#define STEERABLE_FAST_WALK_SETUP_INL_H
#endif

#include "Fast/Registers-inl.h"
#include "Fast/Stages.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Which loops: those of the defaults, the same under the lattice's window, or all that NoiseSetup
/// calls variants.
enum class WalkKind
{
  Plain,
  Windowed,
  Variant
};

template <int N, WalkKind Kind>
struct WalkSetup
{
  static constexpr bool Variant = Kind == WalkKind::Variant;
  static constexpr bool Windowed = Kind == WalkKind::Windowed;

  const NoiseSetup& Setup;
  const NoiseParameters& Params;
  const OctaveSetup& Octave;
  const MetricBlock& Block;
  /// Eigenvalues of this octave.
  const float* Along;
  const float* Across;
  const float* Second;
  V InverseReach;

  STAGE_INLINE WalkSetup(
    const NoiseSetup& setup, const OctaveSetup& octave, const MetricBlock& block)
    : Setup(setup)
    , Params(setup.Parameters)
    , Octave(octave)
    , Block(block)
    , Along(setup.Curved ? block.BentAlong : block.Along)
    , Across(setup.Curved ? block.BentAcross : block.Across)
    , Second(setup.Curved ? block.BentSecond : block.Second)
    // Without a window the fade is taken at 0.
    , InverseReach(Const(Params.LatticeWindow ? 1.0f / (Params.Quality + 1) : 0.0f))
  {
  }

  STAGE_INLINE bool IsOblique() const
  {
    return Variant && this->Params.Lattice == Lattice::Simplicial;
  }
  STAGE_INLINE bool IsJittered() const { return Variant && this->Setup.JitterRadius > 0.0f; }
  STAGE_INLINE bool IsStreaks() const { return Variant && this->Params.Basis == Basis::Streaks; }

  STAGE_INLINE V GetLeastAcross(std::size_t i) const
  {
    const V across = Load(this->Across + i);
    return this->Setup.Biaxial ? hn::Min(across, Load(this->Second + i)) : across;
  }

  /// Half-length in units of that of the metric's ellipsoid, and half-width.
  STAGE_INLINE float GetLengthSupport() const
  {
    return this->IsStreaks() ? 1.0f : std::sqrt(this->Setup.Support);
  }
  STAGE_INLINE float GetWidthSupport() const
  {
    return this->IsStreaks() ? this->Setup.Support : std::sqrt(this->Setup.Support);
  }

  /// How far surflets travel to either side, in half-lengths.
  STAGE_INLINE float GetTravel() const
  {
    return Variant && this->Params.Motion ? 0.5f * std::abs(static_cast<float>(this->Params.Speed))
                                          : 0.0f;
  }
};

/// A little more than needed: every sample must see all its own corners, whatever rounding does.
constexpr float Slack = 1e-3f;
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
