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

/// The 16 leading bits of a float: a product with a number of 8 bits is exact.
HWY_INLINE V HighPart(V v)
{
  return hn::And(v, hn::BitCast(DF(), hn::Set(DU(), HighPartMask)));
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

WALK_INLINE V Normalized(const NoiseSetup& setup, const Sums& sums)
{
  switch (setup.Parameters.Normalize)
  {
    case Normalization::WeightSum:
      return hn::IfThenElseZero(
        hn::Gt(sums.Weight, Const(0.0f)), hn::Div(sums.Noise, hn::Max(sums.Weight, Const(1e-30f))));
    case Normalization::UnitVariance:
      return hn::Div(sums.Noise, hn::Sqrt(hn::Add(sums.Variance, Const(1e-3f))));
    case Normalization::None:
    default:
      return sums.Noise;
  }
}

/// The metric of the lanes, in registers.
template <int N>
struct Frame
{
  V U[N];
  /// u in two parts, see Walk::AddSurflet (2D).
  V UHigh[2];
  V ULow[2];
  V M[N];
  V Along;
  V Across;
  V Second;
  V Bend[N];
  /// The bend along the normal n = (-u_y, u_x), all there is of it in 2D.
  V BendAcross;
  V Sense;

  WALK_INLINE Frame() {}
  WALK_INLINE Frame(
    const NoiseSetup& setup, const MetricBlock& block, std::size_t i, float cellSize)
    : Along(Load(block.Along + i))
    , Across(Load(block.Across + i))
    , Second(Across)
    , BendAcross(hn::Zero(DF()))
    , Sense(Load(block.Sense + i))
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->U[axis] = Load(block.U[axis] + i);
      this->M[axis] = hn::Zero(DF());
      this->Bend[axis] = hn::Zero(DF());
    }
    if constexpr (N == 2)
    {
      for (int axis = 0; axis < 2; ++axis)
      {
        this->UHigh[axis] = HighPart(this->U[axis]);
        this->ULow[axis] = Load(block.ULow[axis] + i);
      }
    }
    if (setup.Biaxial)
    {
      this->Second = Load(block.Second + i);
      for (int axis = 0; axis < N; ++axis)
      {
        this->M[axis] = Load(block.M[axis] + i);
      }
    }
    if (setup.Curved)
    {
      this->ApplyCurvature(block, i, cellSize);
    }
  }

  /// As steerable::ApplyCurvature.
  WALK_INLINE void ApplyCurvature(const MetricBlock& block, std::size_t i, float cellSize)
  {
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::Mul(hn::Mul(Load(block.Bend[axis] + i), Const(cellSize)), this->Sense);
    }
    const V parallel = Dot(this->Bend, this->U);
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::NegMulAdd(parallel, this->U[axis], this->Bend[axis]);
    }
    const V one = Const(1.0f);
    const V length2 = Dot(this->Bend, this->Bend);
    const V clamp = hn::Div(one, hn::Sqrt(hn::Max(length2, one)));
    for (int axis = 0; axis < N; ++axis)
    {
      this->Bend[axis] = hn::Mul(this->Bend[axis], clamp);
    }
    if constexpr (N == 2)
    {
      this->BendAcross = hn::MulSub(this->U[0], this->Bend[1], hn::Mul(this->U[1], this->Bend[0]));
    }
    const V squared = hn::Min(length2, one);
    const V keeps = hn::Sub(one, squared); // CurvatureKeeps
    this->Along = hn::Max(this->Along, squared);
    this->Across = hn::MulAdd(keeps, hn::Sub(this->Across, one), one);
    this->Second = hn::MulAdd(keeps, hn::Sub(this->Second, one), one);
  }
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

/// One octave of a block; `getPlaces(i, places)` tells where the register from sample i is.
template <int N, bool Variant, bool Aligned, class GetPlaces>
WALK_INLINE void AddWalk(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  Walk<N, Variant, Aligned> walk(setup, octave);
  for (std::size_t begin = 0; begin < count; begin += TileSamples)
  {
    const std::size_t end = std::min(count, begin + TileSamples);
    for (std::size_t i = begin; i < end; i += Lanes)
    {
      Places<N> places;
      getPlaces(i, places);
      walk.SetRegister((i - begin) / Lanes, block, i, places);
    }
    visited += walk.Evaluate(end - begin);
    for (std::size_t i = begin; i < end; i += Lanes)
    {
      AddOctave(setup, octave, block, i, walk.GetNoise((i - begin) / Lanes));
    }
  }
}

template <int N, bool Aligned, class GetPlaces>
WALK_INLINE void AddWalks(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  if (setup.Variant)
  {
    AddWalk<N, true, Aligned>(setup, octave, block, count, visited, getPlaces);
  }
  else
  {
    AddWalk<N, false, Aligned>(setup, octave, block, count, visited, getPlaces);
  }
}

/**
 * The same for Quality 0 without extensions; `getPlaces` also gives the windows of the lower corners.
 * `uniform`: the metrics have the same strength.
 */
template <int N, class Corners, class GetPlaces>
WALK_INLINE void AddCells(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t count, bool uniform, Corners& corners, std::uint64_t& visited, GetPlaces&& getPlaces)
{
  const EigenvalueRange range = VectorEigenvalues(setup.Parameters, N);
  const V strength = Const(static_cast<float>(setup.Parameters.Strength));
  const V along = AtStrength(range.Along, strength);
  const V across = AtStrength(range.Across, strength);
  const bool alone = setup.Octaves.size() == 1 && !setup.Parameters.Turbulence;
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
    const V k = uniform ? along : Load(block.Along + i);
    const V b = uniform ? across : Load(block.Across + i);
    const V noise = SumOverCell<N>(u, k, b, places.Fraction, near, corners);
    if (alone)
    {
      hn::StoreU(noise, DF(), block.Noise + i);
    }
    else
    {
      AddOctave(setup, octave, block, i, noise);
    }
  }
  visited += count << N;
}

#include "SteerableNoiseMetrics-inl.h"

/// Scales, masks, counts and hands out the noise of a block.
void Finish(const NoiseSetup& setup, MetricBlock& block, std::size_t count, bool uniform,
  float* noise, EvaluationCounts& counts)
{
  if (uniform)
  {
    std::copy(block.Noise, block.Noise + count, noise);
    return;
  }
  const auto threshold = static_cast<float>(setup.Parameters.MaskThreshold);
  V senses = hn::Zero(DF());
  HWY_ALIGN float sense[Lanes];
  if (threshold > 0.0f)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      if (block.Length[i] <= threshold)
      {
        block.Noise[i] = 0.0f;
        ++counts.Stagnant;
        block.Sense[i] = 1.0f; // counted once, as stagnant
      }
    }
  }
  std::size_t i = 0;
  for (; i + Lanes <= count; i += Lanes)
  {
    senses = hn::Add(senses, Load(block.Sense + i));
    hn::StoreU(Load(block.Noise + i), DF(), noise + i);
  }
  hn::Store(senses, DF(), sense);
  float directed = 0.0f;
  for (float lane : sense)
  {
    directed += lane;
  }
  for (; i < count; ++i)
  {
    directed += block.Sense[i];
    noise[i] = block.Noise[i];
  }
  counts.Degenerate += count - static_cast<std::size_t>(directed);
}

/// Cells and fractions of a block of positions: floor and difference in double, the rest in float.
template <int N>
HWY_NOINLINE void LocatePoints(const NoiseSetup& setup, const OctaveSetup& octave,
  const double* positions, std::size_t count, MetricBlock& block)
{
  constexpr std::size_t half = hn::MaxLanes(DD());
  HWY_ALIGN double tail[3 * half] = {};
  const bool oblique = setup.Parameters.Grid == Lattice::Simplicial;
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
      VD cell = hn::Floor(hn::Add(p[axis], rounding));
      hn::StoreU(hn::DemoteTo(DFH(), hn::Sub(p[axis], cell)), DFH(), block.Fraction[axis] + i);
      if (octave.Period[axis] > 0)
      {
        const VD period = hn::Set(DD(), static_cast<double>(octave.Period[axis]));
        cell = hn::NegMulAdd(hn::Floor(hn::Div(cell, period)), period, cell);
      }
      const hn::Rebind<std::uint64_t, DD> d64;
      const hn::Rebind<std::uint32_t, DD> d32;
      hn::StoreU(
        hn::TruncateTo(d32, hn::BitCast(d64, hn::Add(cell, toInteger))), d32, block.Cell[axis] + i);
    }
  }
  for (int axis = 0; axis < N; ++axis)
  {
    std::fill_n(block.Cell[axis] + count, Lanes, block.Cell[axis][count - 1]);
    std::fill_n(block.Fraction[axis] + count, Lanes, block.Fraction[axis][count - 1]);
  }
}

/// Adds one octave to samples at these positions.
template <int N>
void AddPoints(const NoiseSetup& setup, const OctaveSetup& octave, const double* positions,
  std::size_t count, bool uniform, MetricBlock& block, std::uint64_t& visited)
{
  LocatePoints<N>(setup, octave, positions, count, block);
  const auto anywhere = [&](std::size_t i, Places<N>& places) HWY_ATTR
  {
    for (int axis = 0; axis < N; ++axis)
    {
      places.Cell[axis] = hn::LoadU(DU(), block.Cell[axis] + i);
      places.Fraction[axis] = Load(block.Fraction[axis] + i);
    }
  };
  if (setup.SingleCell)
  {
    LaneCorners<N> corners(octave);
    AddCells<N>(setup, octave, block, count, uniform, corners, visited,
      [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
      {
        anywhere(i, places);
        for (int axis = 0; axis < N; ++axis)
        {
          near[axis] = PlainQuinticFade(places.Fraction[axis]);
        }
      });
  }
  else
  {
    AddWalks<N, false>(setup, octave, block, count, visited, anywhere);
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
      hn::StoreU(PlainQuinticFade(Load(this->Fraction.data() + i)), DF(), this->Window.data() + i);
    }
    if (serve)
    {
      const auto columns = static_cast<std::size_t>(cells.back() - firstColumn + 2);
      this->Rows = std::make_unique<GradientRows<N>>(octave, firstColumn, columns);
    }
  }
};

/// A curvature per world unit in cells of the first octave, no larger than floats can square.
inline float InCells(double curvature, const NoiseSetup& setup)
{
  const double inCells = curvature * setup.Parameters.FeatureSize;
  return static_cast<float>(std::min(1e15, std::max(-1e15, inCells)));
}

template <int N>
void ImageCurvature(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  const std::vector<float>& scaleX, std::int64_t i0, std::size_t count, std::int64_t j,
  std::int64_t k, MetricBlock& block)
{
  const std::int64_t nx = grid.Dimensions[0];
  const std::int64_t ny = grid.Dimensions[1];
  const auto flat = [&](std::int64_t i, std::int64_t jj, std::int64_t kk)
  { return static_cast<std::size_t>((kk * ny + jj) * nx + i); };
  // The row itself with `stride` samples to either side; beyond the ends the last one again.
  const std::int64_t stride = grid.CurvatureStride;
  const auto samples = static_cast<std::int64_t>(count);
  const std::int64_t left = std::min(stride, i0);
  const std::int64_t right = std::min(stride, nx - i0 - samples);
  float* own[3];
  float* from[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    own[axis] = block.Neighbor[0][axis] + stride;
    from[axis] = own[axis] - left;
  }
  Directions<N>(setup, field, flat(i0 - left, j, k),
    static_cast<std::size_t>(samples + left + right), block, { from[0], from[1], from[2] });
  for (int axis = 0; axis < N; ++axis)
  {
    std::fill(own[axis] - stride, own[axis] - left, own[axis][-left]);
    std::fill(
      own[axis] + samples + right, own[axis] + samples + stride, own[axis][samples + right - 1]);
    std::copy(own[axis], own[axis] + samples, block.U[axis]);
    std::fill(block.Bend[axis], block.Bend[axis] + count + Lanes, 0.0f);
  }
  if (nx > 1)
  {
    AddDerivative<N>(block, count, 0, { own[0] - stride, own[1] - stride, own[2] - stride },
      { own[0] + stride, own[1] + stride, own[2] + stride }, scaleX.data() + i0, true);
  }
  const std::int64_t place[3] = { i0, j, k };
  for (int axis = 1; axis < N; ++axis)
  {
    const std::int64_t low = std::max<std::int64_t>(place[axis] - stride, 0);
    const std::int64_t high =
      std::min<std::int64_t>(place[axis] + stride, grid.Dimensions[axis] - 1);
    if (low == high)
    {
      continue;
    }
    float* const before[3] = { block.Neighbor[0][0], block.Neighbor[0][1], block.Neighbor[0][2] };
    float* const after[3] = { block.Neighbor[1][0], block.Neighbor[1][1], block.Neighbor[1][2] };
    Directions<N>(
      setup, field, flat(i0, axis == 1 ? low : j, axis == 2 ? low : k), count, block, before);
    Directions<N>(
      setup, field, flat(i0, axis == 1 ? high : j, axis == 2 ? high : k), count, block, after);
    const float scale =
      InCells(1.0 / (static_cast<double>(high - low) * grid.Spacing[axis]), setup);
    AddDerivative<N>(block, count, axis, { before[0], before[1], before[2] },
      { after[0], after[1], after[2] }, &scale, false);
  }
}

template <int N>
EvaluationCounts EvaluateImage(const NoiseSetup& setup, const ImageGrid& grid, const Field& field,
  std::size_t rowBegin, std::size_t rowEnd, float* noise)
{
  EvaluationCounts counts;
  const std::int64_t nx = grid.Dimensions[0];
  if (nx == 0 || rowBegin >= rowEnd)
  {
    return counts;
  }
  auto block = std::make_unique<MetricBlock>();
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

  for (std::size_t row = rowBegin; row < rowEnd; ++row)
  {
    const auto j = static_cast<std::int64_t>(row) % grid.Dimensions[1];
    const auto k = static_cast<std::int64_t>(row) / grid.Dimensions[1];
    for (std::int64_t i0 = 0; i0 < nx; i0 += BlockSize)
    {
      const auto count = static_cast<std::size_t>(std::min<std::int64_t>(BlockSize, nx - i0));
      const std::size_t first = row * nx + i0;
      if (setup.Curved)
      {
        ImageCurvature<N>(setup, grid, field, scaleX, i0, count, j, k, *block);
      }
      const bool uniform = Metrics<N>(setup, field, first, count, *block);
      if (setup.Octaves.size() > 1)
      {
        std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
      }
      for (std::size_t o = 0; o < octaves.size(); ++o)
      {
        const OctaveSetup& octave = setup.Octaves[o];
        ImageOctave<N>& image = octaves[o];
        const double rowPlace[3] = { 0.0, CellPlace(grid, 1, j, octave.CellsPerUnit),
          N == 3 ? CellPlace(grid, 2, k, octave.CellsPerUnit) : 0.0 };
        std::int64_t cell[3];
        V fraction[N];
        for (int axis = 1; axis < N; ++axis)
        {
          const double floored = std::floor(rowPlace[axis] + setup.CellRounding);
          cell[axis] = static_cast<std::int64_t>(floored);
          fraction[axis] = Const(static_cast<float>(rowPlace[axis] - floored));
        }
        cell[2] = N == 3 ? cell[N - 1] : 0;
        const auto alongRow = [&](std::size_t i, Places<N>& places) HWY_ATTR
        {
          places.Cell[0] = hn::LoadU(DU(), image.Column.data() + i0 + i);
          places.Fraction[0] = Load(image.Fraction.data() + i0 + i);
          for (int axis = 1; axis < N; ++axis)
          {
            places.Cell[axis] = hn::Set(DU(), WrapToPeriod(cell[axis], octave.Period[axis]));
            places.Fraction[axis] = fraction[axis];
          }
        };
        V window[N];
        for (int axis = 1; axis < N; ++axis)
        {
          window[axis] = PlainQuinticFade(fraction[axis]);
        }
        const auto withWindow = [&](std::size_t i, Places<N>& places, V(&near)[N]) HWY_ATTR
        {
          alongRow(i, places);
          near[0] = Load(image.Window.data() + i0 + i);
          for (int axis = 1; axis < N; ++axis)
          {
            near[axis] = window[axis];
          }
        };
        if (setup.Parameters.Grid == Lattice::Simplicial)
        {
          for (std::size_t i = 0; i < count; ++i)
          {
            for (int axis = 0; axis < 3; ++axis)
            {
              const std::int64_t index = axis == 0 ? i0 + static_cast<std::int64_t>(i)
                : axis == 1                        ? j
                                                   : k;
              block->Positions[3 * i + axis] = CellPlace(grid, axis, index, 1.0);
            }
          }
          AddPoints<N>(
            setup, octave, block->Positions, count, uniform, *block, counts.VisitedCorners);
        }
        else if (image.Rows)
        {
          image.Rows->MoveTo(cell[1], cell[2]);
          RowCorners<N> corners(*image.Rows);
          AddCells<N>(
            setup, octave, *block, count, uniform, corners, counts.VisitedCorners, withWindow);
        }
        else if (setup.SingleCell)
        {
          LaneCorners<N> corners(octave);
          AddCells<N>(
            setup, octave, *block, count, uniform, corners, counts.VisitedCorners, withWindow);
        }
        else
        {
          AddWalks<N, true>(setup, octave, *block, count, counts.VisitedCorners, alongRow);
        }
      }
      Finish(setup, *block, count, uniform, noise + first, counts);
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
  auto block = std::make_unique<MetricBlock>();
  for (std::size_t first = begin; first < end; first += BlockSize)
  {
    const std::size_t count = std::min(BlockSize, end - first);
    if (setup.Curved)
    {
      CopyCurvature<N>(setup, field.Curvature->Read(first, count, block->Tuples), count, *block);
    }
    const bool uniform = Metrics<N>(setup, field, first, count, *block);
    if (setup.Octaves.size() > 1)
    {
      std::fill(block->Noise, block->Noise + count + Lanes, 0.0f);
    }
    const double* place = positions.Read(first, count, block->Positions);
    for (const OctaveSetup& octave : setup.Octaves)
    {
      AddPoints<N>(setup, octave, place, count, uniform, *block, counts.VisitedCorners);
    }
    Finish(setup, *block, count, uniform, noise + first, counts);
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
