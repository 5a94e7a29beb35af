// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Points in any order.
#if defined(STEERABLE_FAST_POINTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_POINTS_INL_H
#undef STEERABLE_FAST_POINTS_INL_H
#else
#define STEERABLE_FAST_POINTS_INL_H
#endif

#include "Fast/Cells-inl.h"
#include "Fast/Curvature-inl.h"
#include "Fast/Walk/Walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// Cells and fractions of samples from `at` on: floor and difference in double, the rest in float.
/// `Plain`: on the square lattice, without periods and without rounding of cells.
template <int N, bool Plain>
HWY_NOINLINE void LocatePoints(const NoiseSetup& setup, const OctaveSetup& octave,
  const double* positions, std::size_t at, std::size_t count, MetricBlock& block)
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN double tail[3 * half] = {};
  const bool oblique = !Plain && setup.Parameters.Lattice == Lattice::Simplicial;
  const VD scale = hn::Set(DD(), octave.CellsPerUnit);
  // Adding this leaves the integer, modulo 2^32, in the low bits.
  const VD toInteger = hn::Set(DD(), 6755399441055744.0);
  const VD rounding = hn::Set(DD(), setup.CellRounding);
  for (std::size_t i = 0; i < count; i += half)
  {
    const double* from = GetTuples(positions + 3 * i, count - i, tail);
    VD p[3];
    hn::LoadInterleaved3(DD(), from, p[0], p[1], p[2]);
    for (int axis = 0; axis < N; ++axis)
    {
      p[axis] = hn::Mul(p[axis], scale);
    }
    if (oblique)
    {
      const VD q[3] = { p[0], p[1], p[2] };
      for (int axis = 0; axis < N; ++axis)
      {
        p[axis] = hn::Mul(q[0], hn::Set(DD(), setup.LatticeIndices[axis][0]));
        for (int j = 1; j < N; ++j)
        {
          p[axis] = hn::MulAdd(q[j], hn::Set(DD(), setup.LatticeIndices[axis][j]), p[axis]);
        }
      }
    }
    for (int axis = 0; axis < N; ++axis)
    {
      // A place that is not finite is cell 0: it must not spoil its neighbours' walk.
      p[axis] = hn::IfThenElseZero(hn::Lt(hn::Abs(p[axis]), hn::Set(DD(), FarthestCell)), p[axis]);
      VD cell = hn::Floor(Plain ? p[axis] : hn::Add(p[axis], rounding));
      hn::StoreU(hn::DemoteTo(DFH(), hn::Sub(p[axis], cell)), DFH(), block.Fraction[axis] + at + i);
      if (!Plain && octave.Period[axis] > 0)
      {
        const VD period = hn::Set(DD(), static_cast<double>(octave.Period[axis]));
        cell = hn::NegMulAdd(hn::Floor(hn::Div(cell, period)), period, cell);
      }
      const hn::Rebind<std::uint64_t, DD> d64;
      const hn::Rebind<std::uint32_t, DD> d32;
      hn::StoreU(hn::TruncateTo(d32, hn::BitCast(d64, hn::Add(cell, toInteger))), d32,
        block.Cell[axis] + at + i);
    }
  }
  for (int axis = 0; axis < N; ++axis)
  {
    const std::size_t end = at + count;
    std::fill_n(block.Cell[axis] + end, Lanes, block.Cell[axis][end - 1]);
    std::fill_n(block.Fraction[axis] + end, Lanes, block.Fraction[axis][end - 1]);
  }
}

/// One tile of an octave.
template <class Walk>
STAGE_INLINE void AddTile(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  Walk& walk, const Tile& tile, std::uint64_t& visited)
{
  visited += walk.Evaluate(tile);
  for (std::size_t r = 0; r < tile.Registers; ++r)
  {
    AddOctave(setup, octave, block, tile.First[r], walk.GetNoise(r));
  }
}

/// One octave of the samples at the beginning of a block, whose places are known.
template <int N, WalkKind Kind>
HWY_NOINLINE void WalkPoints(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited)
{
  Walk<N, Kind> walk(setup, octave, block);
  Tile tile(TileRegisters, Lanes);
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    const std::size_t r = tile.Registers++;
    tile.SetRegister(r, i, 0, r, std::min(Lanes, count - i), 1);
    if (tile.Registers == TileRegisters || i + Lanes >= count)
    {
      AddTile(setup, octave, block, walk, tile, visited);
      tile.Registers = 0;
    }
  }
}

/// Calls `plain`, `windowed` or `variant`, as these parameters need it.
template <class Function>
Function* ChooseWalk(
  const NoiseSetup& setup, Function* plain, Function* windowed, Function* variant)
{
  return setup.Variant ? variant : setup.Parameters.LatticeWindow ? windowed : plain;
}

/// Adds one octave to samples at these positions.
template <int N>
void AddPoints(const NoiseSetup& setup, const OctaveSetup& octave, const double* positions,
  std::size_t count, float* direct, MetricBlock& block, std::uint64_t& visited)
{
  const auto& period = octave.Period;
  const bool plain = setup.SingleCell && period[0] == 0 && period[1] == 0 && period[2] == 0;
  const auto locate = plain ? &LocatePoints<N, true> : &LocatePoints<N, false>;
  locate(setup, octave, positions, 0, count, block);
  if (setup.SingleCell)
  {
    LaneCorners<N> corners(octave, setup.Parameters.GradientSet);
    AddCells<N>(setup, octave, block, count, direct, corners, visited,
      [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
      {
        for (int axis = 0; axis < N; ++axis)
        {
          places.Cell[axis] = hn::LoadU(DU(), block.Cell[axis] + i);
          places.Fraction[axis] = Load(block.Fraction[axis] + i);
          near[axis] = CellWindow(setup.Parameters.Fade, places.Fraction[axis]);
        }
      });
    return;
  }
  if (setup.Curved)
  {
    BendMetrics<N>(setup, octave, 0, count, block);
  }
  const auto walk = ChooseWalk(setup, &WalkPoints<N, WalkKind::Plain>,
    &WalkPoints<N, WalkKind::Windowed>, &WalkPoints<N, WalkKind::Variant>);
  walk(setup, octave, block, count, visited);
}

/// Masks, counts and hands out the noise of samples [at, at + count) of a block.
void Finish(const NoiseSetup& setup, MetricBlock& block, std::size_t at, std::size_t count,
  float* noise, EvaluationCounts& counts)
{
  float* const from = block.Noise + at;
  float* const there = block.Directed + at;
  const auto threshold = static_cast<float>(setup.Parameters.MaskThreshold);
  V senses = hn::Zero(DF());
  HWY_ALIGN float sense[Lanes];
  if (threshold > 0.0f)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      if (block.Length[at + i] <= threshold)
      {
        from[i] = 0.0f;
        ++counts.Stagnant;
        there[i] = 1.0f; // counted once, as stagnant
      }
    }
  }
  std::size_t i = 0;
  for (; i + Lanes <= count; i += Lanes)
  {
    senses = hn::Add(senses, Load(there + i));
    hn::StoreU(Load(from + i), DF(), noise + i);
  }
  hn::Store(senses, DF(), sense);
  float directed = 0.0f;
  for (float lane : sense)
  {
    directed += lane;
  }
  for (; i < count; ++i)
  {
    directed += there[i];
    noise[i] = from[i];
  }
  counts.Degenerate += setup.Isotropic ? 0 : count - static_cast<std::size_t>(directed);
}

template <int N>
EvaluationCounts EvaluatePoints(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  EvaluationCounts counts;
  const std::unique_ptr<MetricBlock> block(
    new MetricBlock); // not zeroed: what is read is written before
  for (std::size_t first = begin; first < end; first += BlockSize)
  {
    const std::size_t count = std::min(BlockSize, end - first);
    if (setup.Curved)
    {
      CopyCurvature<N>(setup, field.Curvature->Read(first, count, block->Tuples), count, *block);
    }
    const bool uniform = Metrics<N>(setup, field, first, 0, count, *block, counts.Bounded);
    if (setup.Octaves.size() > 1)
    {
      std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
    }
    const double* place = positions.Read(first, count, block->Positions);
    for (const OctaveSetup& octave : setup.Octaves)
    {
      AddPoints<N>(setup, octave, place, count, uniform ? noise + first : nullptr, *block,
        counts.VisitedCorners);
    }
    if (!uniform)
    {
      Finish(setup, *block, 0, count, noise + first, counts);
    }
  }
  return counts;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
