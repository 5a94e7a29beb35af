// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of the fast path, compiled once for each SIMD level (private to SteerableNoise.cxx, which
 * includes this inside Highway's per-target pass; hence no include guard of the usual kind).
 *
 * A register holds one number of several samples. Every lane follows the same arithmetic whatever
 * its neighbours are: corners that only another lane needs add exactly 0.
 */
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

/// The nearest multiple of 2^(-23) `size`, a power of two: sums of products of few digits are exact.
HWY_INLINE V RoundTo(V v, float size)
{
  const V shift = Const(1.5f * size);
  return hn::Sub(hn::Add(v, shift), shift);
}

/// Bounds of loops over corners, whatever the number is.
HWY_INLINE int ToCorner(float place)
{
  return static_cast<int>(std::min(1000.0f, std::max(-1000.0f, place)));
}

HWY_INLINE float LeastLane(V v)
{
  return hn::GetLane(hn::MinOfLanes(DF(), v));
}

HWY_INLINE float GreatestLane(V v)
{
  return hn::GetLane(hn::MaxOfLanes(DF(), v));
}

#include "SteerableNoiseSurflet-inl.h"

// What is called for every register is inlined; instrumented builds take too long over that.
#undef WALK_INLINE
#ifdef STEERABLENOISE_INSTRUMENTED
#define WALK_INLINE inline
#else
#define WALK_INLINE HWY_INLINE
#endif

struct Sums
{
  // Written out, since the compiler's own constructor would not be of this SIMD level.
  WALK_INLINE Sums()
    : Noise(hn::Zero(DF()))
    , Weight(hn::Zero(DF()))
    , Variance(hn::Zero(DF()))
  {
  }
  V Noise;
  V Weight;
  V Variance;
};

/// Variance of what a surflet is multiplied by: a gradient's component, a value, or whether there is one.
inline float VarianceShare(const NoiseParameters& p, int dimension)
{
  switch (p.Surflet)
  {
    case Basis::Value:
      return 1.0f / 3.0f;
    case Basis::Streaks:
      return static_cast<float>(p.GetStreakProbability());
    case Basis::Gradient:
    default:
      return static_cast<float>(GradientVariance(p.Gradients, dimension));
  }
}

WALK_INLINE V Normalized(const NoiseSetup& setup, int dimension, const Sums& sums)
{
  switch (setup.Parameters.Normalize)
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

/// Where the samples of a register are in the lattice of an octave: cells as the hash takes them, and
/// fractions from their corners.
template <int N>
struct Places
{
  VU Cell[N];
  V Fraction[N];
};

#include "SteerableNoiseCells-inl.h"
#include "SteerableNoiseWalk-inl.h"

/// An eigenvalue at full strength, at these strengths.
HWY_INLINE V AtStrength(double eigenvalue, V strength)
{
  return hn::MulAdd(strength, Const(static_cast<float>(eigenvalue) - 1.0f), Const(1.0f));
}

/// Puts the noise of an octave into the block, or adds it to that of the octaves before.
WALK_INLINE void AddOctave(
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

/// As steerable::ApplyCurvature: eigenvalues and bend of samples [at, at + count) in one octave.
template <int N>
HWY_NOINLINE void BendMetrics(const NoiseSetup& setup, const OctaveSetup& octave, std::size_t at,
  std::size_t count, MetricBlock& block)
{
  for (std::size_t i = at; i < at + count; i += Lanes)
  {
    const V one = Const(1.0f);
    const V scale = hn::Mul(Load(block.Sense + i), Const(octave.CellSize));
    V bend[N];
    V u[N];
    for (int axis = 0; axis < N; ++axis)
    {
      bend[axis] = hn::Mul(Load(block.Bend[axis] + i), scale);
      u[axis] = Load(block.U[axis] + i);
    }
    const V parallel = Dot(bend, u);
    for (int axis = 0; axis < N; ++axis)
    {
      bend[axis] = hn::NegMulAdd(parallel, u[axis], bend[axis]);
    }
    const V length2 = Dot(bend, bend);
    const V clamp = hn::Div(one, hn::Sqrt(hn::Max(length2, one)));
    for (int axis = 0; axis < N; ++axis)
    {
      hn::StoreU(hn::Mul(bend[axis], clamp), DF(), block.ClampedBend[axis] + i);
    }
    const V squared = hn::Min(length2, one);
    const V keeps = hn::Sub(one, squared); // CurvatureKeeps
    const auto keep = [&](const float* eigenvalue) HWY_ATTR
    { return hn::MulAdd(keeps, hn::Sub(Load(eigenvalue + i), one), one); };
    hn::StoreU(hn::Max(Load(block.Along + i), squared), DF(), block.BentAlong + i);
    hn::StoreU(keep(block.Across), DF(), block.BentAcross + i);
    if (setup.Biaxial)
    {
      hn::StoreU(keep(block.Second), DF(), block.BentSecond + i);
    }
  }
}

/// One tile of an octave; its registers are set.
template <class Walk>
WALK_INLINE void AddTile(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  Walk& walk, std::size_t registers, std::uint64_t& visited)
{
  visited += walk.Evaluate(registers);
  for (std::size_t r = 0; r < registers; ++r)
  {
    AddOctave(setup, octave, block, walk.GetFirst(r), walk.GetNoise(r));
  }
}

/// One octave of the samples at the beginning of a block, whose places are known.
template <int N, bool Variant>
HWY_NOINLINE void WalkPoints(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited)
{
  Walk<N, Variant, false> walk(setup, octave, block);
  std::size_t registers = 0;
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    walk.SetRegister(registers++, i, std::min(Lanes, count - i));
    if (registers == TileRegisters || i + Lanes >= count)
    {
      AddTile(setup, octave, block, walk, registers, visited);
      registers = 0;
    }
  }
}

/// One octave of a patch of an image, whose places are known.
template <int N, bool Variant>
HWY_NOINLINE void WalkPatch(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t rows, std::size_t columns, std::uint64_t& visited)
{
  Walk<N, Variant, !Variant> walk(setup, octave, block);
  for (std::size_t i = 0; i < columns; i += Lanes)
  {
    for (std::size_t r = 0; r < rows; ++r)
    {
      walk.SetRegister(r, r * PatchStride + i, std::min(Lanes, columns - i));
    }
    AddTile(setup, octave, block, walk, rows, visited);
  }
}

/**
 * The same for Quality 0 without extensions; `getPlaces` also gives the windows of the lower corners.
 * `direct`: where the noise goes if all is uniform, see NoiseSetup; else null.
 */
template <int N, class Corners, class GetPlaces>
WALK_INLINE void AddCells(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, float* direct, Corners& corners, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  const EigenvalueRange range = VectorEigenvalues(setup.Parameters, N);
  const V strength = Const(static_cast<float>(setup.Parameters.Strength));
  const V along = AtStrength(range.Along, strength);
  const V across = AtStrength(range.Across, strength);
  const bool weighted = setup.Parameters.AnisotropicWeight;
  const bool metric = weighted || setup.Parameters.MetricInProjection;
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    Places<N> places;
    V near[N];
    getPlaces(i, places, near);
    corners.SetCells(places.Cell);
    V u[N];
    for (int axis = 0; axis < N; ++axis)
    {
      u[axis] = Load(block.U[axis] + i);
    }
    const V one = Const(1.0f);
    const V k = !metric ? one : direct ? along : Load(block.Along + i);
    const V b = !metric ? one : direct ? across : Load(block.Across + i);
    const V noise = weighted
      ? SumOverCell<N, true>(u, k, b, places.Fraction, near, corners)
      : SumOverCell<N, false>(u, k, b, places.Fraction, near, corners);
    if (!direct)
    {
      AddOctave(setup, octave, block, i, noise);
    }
    else if (i + Lanes <= count)
    {
      hn::StoreU(noise, DF(), direct + i);
    }
    else
    {
      hn::Store(noise, DF(), block.Noise);
      std::copy_n(block.Noise, count - i, direct + i);
    }
  }
  visited += count << N;
}

#include "SteerableNoiseMetrics-inl.h"

/// Masks, counts and hands out the noise of samples [at, at + count) of a block.
void Finish(const NoiseSetup& setup, MetricBlock& block, std::size_t at, std::size_t count,
  float* noise, EvaluationCounts& counts)
{
  float* const from = block.Noise + at;
  float* const there = block.Sense + at;
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

/// Cells and fractions of samples from `at` on: floor and difference in double, the rest in float. `Plain`: on
/// the square lattice, without periods and without rounding of cells.
template <int N, bool Plain>
HWY_NOINLINE void LocatePoints(const NoiseSetup& setup, const OctaveSetup& octave,
  const double* positions, std::size_t at, std::size_t count, MetricBlock& block)
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN double tail[3 * half] = {};
  const bool oblique = !Plain && setup.Parameters.Grid == Lattice::Simplicial;
  const VD scale = hn::Set(DD(), octave.CellsPerUnit);
  // Adding this leaves the integer, modulo 2^32, in the low bits.
  const VD toInteger = hn::Set(DD(), 6755399441055744.0);
  const VD rounding = hn::Set(DD(), setup.CellRounding);
  for (std::size_t i = 0; i < count; i += half)
  {
    const double* from = positions + 3 * i;
    if (i + half > count)
    {
      std::copy(from, positions + 3 * count, tail);
      from = tail;
    }
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
    LaneCorners<N> corners(octave, setup.Parameters.Gradients);
    AddCells<N>(setup, octave, block, count, direct, corners, visited,
      [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
      {
        for (int axis = 0; axis < N; ++axis)
        {
          places.Cell[axis] = hn::LoadU(DU(), block.Cell[axis] + i);
          places.Fraction[axis] = Load(block.Fraction[axis] + i);
          near[axis] = CellWindow(setup.Parameters.Interpolant, places.Fraction[axis]);
        }
      });
    return;
  }
  if (setup.Curved)
  {
    BendMetrics<N>(setup, octave, 0, count, block);
  }
  if (setup.Variant)
  {
    WalkPoints<N, true>(setup, octave, block, count, visited);
  }
  else
  {
    WalkPoints<N, false>(setup, octave, block, count, visited);
  }
}

// ---- images -------------------------------------------------------------------------------------

/**
 * Place of sample `index` of a grid axis, in cells of an octave; 0 where a double no longer tells one
 * cell from the next.
 */
inline double CellPlace(const ImageGrid& grid, int axis, std::int64_t index, double cellsPerUnit)
{
  const double place =
    (grid.Origin[axis] + static_cast<double>(grid.FirstIndex[axis] + index) * grid.Spacing[axis]) *
    cellsPerUnit;
  return std::abs(place) < FarthestCell ? place : 0.0;
}

/// One octave of an image: places along x, and the gradient rows if they serve.
template <int N>
struct ImageOctave
{
  std::vector<std::uint32_t> Column; // wrapped cell, or its distance from the first of the rows
  std::vector<float> Fraction;
  std::vector<float> Window; // of the corner below
  std::unique_ptr<GradientRows<N>> Rows;

  ImageOctave(const NoiseSetup& setup, const OctaveSetup& octave, const ImageGrid& grid)
    : Column(grid.Dimensions[0] + Lanes)
    , Fraction(grid.Dimensions[0] + Lanes)
    , Window(grid.Dimensions[0] + Lanes)
  {
    const std::int64_t samples = grid.Dimensions[0];
    std::vector<std::int64_t> cells(samples);
    for (std::int64_t i = 0; i < samples; ++i)
    {
      const double place = CellPlace(grid, 0, i, octave.CellsPerUnit);
      const double cell = std::floor(place + setup.CellRounding);
      cells[i] = static_cast<std::int64_t>(cell);
      this->Fraction[i] = static_cast<float>(place - cell);
    }
    // Lanes pick gradients out of one register, so neighbours must be within one cell.
    const double step = grid.Spacing[0] * octave.CellsPerUnit;
    const bool serve = setup.SingleCell && step >= 0.0 && step <= 1.0;
    const std::int64_t firstColumn = cells.front();
    for (std::int64_t i = 0; i < samples; ++i)
    {
      this->Column[i] = serve ? static_cast<std::uint32_t>(cells[i] - firstColumn)
                              : WrapToPeriod(cells[i], octave.Period[0]);
    }
    for (std::size_t i = samples; i < this->Column.size(); ++i)
    {
      this->Column[i] = this->Column[samples - 1];
      this->Fraction[i] = this->Fraction[samples - 1];
    }
    for (std::size_t i = 0; i + Lanes <= this->Window.size(); i += Lanes)
    {
      hn::StoreU(CellWindow(setup.Parameters.Interpolant, Load(this->Fraction.data() + i)), DF(),
        this->Window.data() + i);
    }
    if (serve)
    {
      const auto columns = static_cast<std::size_t>(cells.back() - firstColumn + 2);
      this->Rows = std::make_unique<GradientRows<N>>(
        octave, setup.Parameters.Gradients, firstColumn, columns);
    }
  }
};

/// A curvature per world unit in cells of the first octave, no larger than floats can square.
inline float InCells(double curvature, const NoiseSetup& setup)
{
  const double inCells = curvature * setup.Parameters.FeatureSize;
  return static_cast<float>(std::min(1e15, std::max(-1e15, inCells)));
}

/// Samples of an image that go through the stages together: rows of one slice, the first from this on.
struct Patch
{
  std::int64_t First[3];
  std::size_t Columns;
  std::size_t Rows;

  /// Where a row begins in the block.
  static std::size_t At(std::size_t row) { return row * PatchStride; }
};

/// Bend of a patch, without the parts of it that BendMetrics removes.
template <int N>
void PatchCurvature(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  const std::vector<float>& scaleX, const Patch& patch, MetricBlock& block)
{
  const auto& size = grid.Dimensions;
  const std::int64_t stride = grid.CurvatureStride;
  const auto columns = static_cast<std::int64_t>(patch.Columns);
  const auto rows = static_cast<std::int64_t>(patch.Rows);
  const std::int64_t i0 = patch.First[0];
  // The rows with `stride` samples to either side; beyond the ends the last one again.
  const std::int64_t left = std::min(stride, i0);
  const std::int64_t right = std::min(stride, size[0] - i0 - columns);
  const auto readRow =
    [&](std::int64_t slot, std::int64_t j, std::int64_t k, std::int64_t before, std::int64_t after)
  {
    float* to[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      to[axis] = block.DirectionRows[slot][axis] + stride - before;
    }
    const auto first = static_cast<std::size_t>((k * size[1] + j) * size[0] + i0 - before);
    Directions<N>(setup, field, first, static_cast<std::size_t>(columns + before + after), block,
      { to[0], to[1], to[2] });
  };
  const auto getRow = [&](std::int64_t slot, std::int64_t shift)
  {
    const auto& row = block.DirectionRows[slot];
    return std::array<const float*, 3>{ row[0] + stride + shift, row[1] + stride + shift,
      row[2] + stride + shift };
  };

  for (std::int64_t r = 0; r < rows; ++r)
  {
    const std::size_t at = Patch::At(r);
    readRow(r, patch.First[1] + r, patch.First[2], left, right);
    for (int axis = 0; axis < 3; ++axis)
    {
      float* const row = block.DirectionRows[r][axis] + stride;
      std::fill(row - stride, row - left, row[-left]);
      std::fill(row + columns + right, row + columns + stride, row[columns + right - 1]);
      std::fill_n(block.Bend[axis] + at, patch.Columns + Lanes, 0.0f);
    }
    if (size[0] > 1)
    {
      AddDerivative<N>(block, at, patch.Columns, 0, getRow(r, 0), getRow(r, -stride),
        getRow(r, stride), scaleX.data() + i0, true);
    }
  }
  for (int axis = 1; axis < N; ++axis)
  {
    // Slot of the row at these indices: that of the patch, or `spare` with the row read into it.
    const auto find = [&](std::int64_t j, std::int64_t k, std::int64_t spare)
    {
      if (k == patch.First[2] && j >= patch.First[1] && j < patch.First[1] + rows)
      {
        return j - patch.First[1];
      }
      readRow(spare, j, k, 0, 0);
      return spare;
    };
    for (std::int64_t r = 0; r < rows; ++r)
    {
      std::int64_t low[3] = { 0, patch.First[1] + r, patch.First[2] };
      std::int64_t high[3] = { 0, patch.First[1] + r, patch.First[2] };
      low[axis] = std::max<std::int64_t>(low[axis] - stride, 0);
      high[axis] = std::min(high[axis] + stride, size[axis] - 1);
      const std::int64_t span = high[axis] - low[axis];
      if (span > 0)
      {
        const std::int64_t before = find(low[1], low[2], rows);
        const std::int64_t after = find(high[1], high[2], rows + 1);
        const float scale = InCells(1.0 / (static_cast<double>(span) * grid.Spacing[axis]), setup);
        AddDerivative<N>(block, Patch::At(r), patch.Columns, axis, getRow(r, 0), getRow(before, 0),
          getRow(after, 0), &scale, false);
      }
    }
  }
}

/// Cells and fractions of a patch in an octave.
template <int N>
void LocatePatch(const NoiseSetup& setup, const ImageGrid& grid, const OctaveSetup& octave,
  const ImageOctave<N>& image, const Patch& patch, MetricBlock& block)
{
  const auto place = [&](int axis, std::size_t index, double cellsPerUnit)
  {
    return CellPlace(
      grid, axis, patch.First[axis] + static_cast<std::int64_t>(index), cellsPerUnit);
  };
  for (std::size_t r = 0; r < patch.Rows; ++r)
  {
    const std::size_t at = Patch::At(r);
    const std::size_t row[3] = { 0, r, 0 };
    if (setup.Parameters.Grid == Lattice::Simplicial)
    {
      for (std::size_t i = 0; i < patch.Columns; ++i)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          block.Positions[3 * i + axis] = place(axis, axis == 0 ? i : row[axis], 1.0);
        }
      }
      LocatePoints<N, false>(setup, octave, block.Positions, at, patch.Columns, block);
      continue;
    }
    const std::size_t room = patch.Columns + Lanes;
    std::copy_n(image.Column.data() + patch.First[0], room, block.Cell[0] + at);
    std::copy_n(image.Fraction.data() + patch.First[0], room, block.Fraction[0] + at);
    for (int axis = 1; axis < N; ++axis)
    {
      const double y = place(axis, row[axis], octave.CellsPerUnit);
      const double cell = std::floor(y + setup.CellRounding);
      std::fill_n(block.Cell[axis] + at, room,
        WrapToPeriod(static_cast<std::int64_t>(cell), octave.Period[axis]));
      std::fill_n(block.Fraction[axis] + at, room, static_cast<float>(y - cell));
    }
  }
}

/// One octave of a row of an image at Quality 0 without extensions.
template <int N>
void AddRowOfCells(const NoiseSetup& setup, const ImageGrid& grid, const OctaveSetup& octave,
  ImageOctave<N>& image, const Patch& patch, float* direct, MetricBlock& block,
  std::uint64_t& visited)
{
  std::int64_t cell[3] = { 0, 0, 0 };
  V fraction[N];
  V window[N];
  for (int axis = 1; axis < N; ++axis)
  {
    const double place = CellPlace(grid, axis, patch.First[axis], octave.CellsPerUnit);
    const double floored = std::floor(place);
    cell[axis] = static_cast<std::int64_t>(floored);
    fraction[axis] = Const(static_cast<float>(place - floored));
    window[axis] = CellWindow(setup.Parameters.Interpolant, fraction[axis]);
  }
  const auto getPlaces = [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
  {
    const std::size_t column = patch.First[0] + i;
    places.Cell[0] = hn::LoadU(DU(), image.Column.data() + column);
    places.Fraction[0] = Load(image.Fraction.data() + column);
    near[0] = Load(image.Window.data() + column);
    for (int axis = 1; axis < N; ++axis)
    {
      places.Cell[axis] = hn::Set(DU(), WrapToPeriod(cell[axis], octave.Period[axis]));
      places.Fraction[axis] = fraction[axis];
      near[axis] = window[axis];
    }
  };
  if (image.Rows)
  {
    image.Rows->MoveTo(cell[1], cell[2]);
    RowCorners<N> corners(*image.Rows);
    AddCells<N>(setup, octave, block, patch.Columns, direct, corners, visited, getPlaces);
  }
  else
  {
    LaneCorners<N> corners(octave, setup.Parameters.Gradients);
    AddCells<N>(setup, octave, block, patch.Columns, direct, corners, visited, getPlaces);
  }
}

template <int N>
EvaluationCounts EvaluateImage(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  EvaluationCounts counts;
  const std::int64_t nx = grid.Dimensions[0];
  const std::int64_t ny = grid.Dimensions[1];
  if (nx == 0 || rowBegin >= rowEnd)
  {
    return counts;
  }
  const std::unique_ptr<MetricBlock> block(
    new MetricBlock); // not zeroed: what is read is written before
  std::vector<ImageOctave<N>> octaves;
  for (const OctaveSetup& octave : setup.Octaves)
  {
    octaves.emplace_back(setup, octave, grid);
  }
  // One-sided differences at the ends of a row.
  std::vector<float> scaleX;
  if (setup.Curved)
  {
    scaleX.assign(nx + Lanes, 0.0f);
    const std::int64_t stride = grid.CurvatureStride;
    for (std::int64_t i = 0; i < nx && nx > 1; ++i)
    {
      const std::int64_t span =
        std::min(i + stride, nx - 1) - std::max<std::int64_t>(i - stride, 0);
      scaleX[i] = InCells(1.0 / (static_cast<double>(span) * grid.Spacing[0]), setup);
    }
  }

  const std::int64_t mostRows = setup.SingleCell ? 1 : TileRegisters;
  const std::int64_t mostColumns = setup.SingleCell ? CellsColumns : PatchColumns;
  Patch patch;
  for (std::size_t row = rowBegin; row < rowEnd; row += patch.Rows)
  {
    patch.First[1] = static_cast<std::int64_t>(row) % ny;
    patch.First[2] = static_cast<std::int64_t>(row) / ny;
    patch.Rows =
      std::min(rowEnd - row, static_cast<std::size_t>(std::min(mostRows, ny - patch.First[1])));
    for (std::int64_t& i0 = patch.First[0] = 0; i0 < nx; i0 += mostColumns)
    {
      patch.Columns = static_cast<std::size_t>(std::min(mostColumns, nx - i0));
      if (setup.Curved)
      {
        PatchCurvature<N>(setup, grid, field, scaleX, patch, *block);
      }
      const auto firstOf = [&](std::size_t r) { return (row + r) * nx + i0; };
      bool uniform = true;
      for (std::size_t r = 0; r < patch.Rows; ++r)
      {
        const std::size_t at = Patch::At(r);
        const bool all =
          Metrics<N>(setup, field, firstOf(r), at, patch.Columns, *block, counts.Bounded);
        uniform = all && uniform;
        if (setup.Octaves.size() > 1)
        {
          std::fill_n(block->Noise + at, patch.Columns + Lanes, 0.0f);
        }
      }
      float* const direct = uniform ? noise + firstOf(0) : nullptr;
      for (std::size_t o = 0; o < octaves.size(); ++o)
      {
        const OctaveSetup& octave = setup.Octaves[o];
        if (setup.SingleCell)
        {
          AddRowOfCells<N>(
            setup, grid, octave, octaves[o], patch, direct, *block, counts.VisitedCorners);
          continue;
        }
        LocatePatch<N>(setup, grid, octave, octaves[o], patch, *block);
        for (std::size_t r = 0; r < patch.Rows && setup.Curved; ++r)
        {
          BendMetrics<N>(setup, octave, Patch::At(r), patch.Columns, *block);
        }
        const auto walk = setup.Variant ? &WalkPatch<N, true> : &WalkPatch<N, false>;
        walk(setup, octave, *block, patch.Rows, patch.Columns, counts.VisitedCorners);
      }
      for (std::size_t r = 0; r < patch.Rows && !uniform; ++r)
      {
        Finish(setup, *block, Patch::At(r), patch.Columns, noise + firstOf(r), counts);
      }
    }
  }
  return counts;
}

// ---- points -------------------------------------------------------------------------------------

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

EvaluationCounts EvaluateImage2(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<2>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluateImage3(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  return EvaluateImage<3>(setup, grid, field, rowBegin, rowEnd, noise);
}

EvaluationCounts EvaluatePoints2(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<2>(setup, positions, field, begin, end, noise);
}

EvaluationCounts EvaluatePoints3(const NoiseSetup& setup, const TupleReader<double>& positions,
  const Field& field, std::size_t begin, std::size_t end, float* noise)
{
  return EvaluatePoints<3>(setup, positions, field, begin, end, noise);
}
} // namespace HWY_NAMESPACE
} // namespace steerable
