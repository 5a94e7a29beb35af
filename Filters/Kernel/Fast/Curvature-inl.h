// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// How streamlines bend: from differences in images or as the host gives it, and what metrics
/// become by it.
#if defined(STEERABLE_FAST_CURVATURE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_CURVATURE_INL_H
#undef STEERABLE_FAST_CURVATURE_INL_H
#else
#define STEERABLE_FAST_CURVATURE_INL_H
#endif

#include "Fast/Metrics-inl.h"

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// A curvature per world unit in cells of the first octave, no larger than floats can square.
inline float InCells(double curvature, const NoiseSetup& setup)
{
  const double inCells = curvature * setup.Parameters.FeatureSize;
  return static_cast<float>(std::min(1e15, std::max(-1e15, inCells)));
}

/// a b - c d of exact products: by Kahan's way, or in double where there are no fused products.
HWY_INLINE V DifferenceOfProducts(V a, V b, V c, V d)
{
#if HWY_NATIVE_FMA
  const V product = hn::Mul(c, d);
  return hn::Add(hn::MulSub(a, b, product), hn::NegMulAdd(c, d, product));
#else
  HWY_ALIGN float values[4][Lanes];
  const V registers[4] = { a, b, c, d };
  for (int i = 0; i < 4; ++i)
  {
    hn::Store(registers[i], DF(), values[i]);
  }
  for (std::size_t lane = 0; lane < Lanes; lane += hn::MaxLanes(DD()))
  {
    const VD product = hn::Mul(ToDouble(values[2] + lane), ToDouble(values[3] + lane));
    const VD difference =
      hn::MulSub(ToDouble(values[0] + lane), ToDouble(values[1] + lane), product);
    hn::Store(hn::DemoteTo(DFH(), difference), DFH(), values[0] + lane);
  }
  return hn::Load(DF(), values[0]);
#endif
}

/// Samples of an image that go through the stages together: rows of one slice, the first from this
/// on.
struct Patch
{
  std::int64_t First[3];
  std::size_t Columns;
  std::size_t Rows;

  /// Where a row begins in the block.
  static std::size_t At(std::size_t row) { return row * PatchStride; }
};

/**
 * Adds u_axis ∂u/∂axis to the bend, the neighbours turned to the side of the middle one; a
 * neighbour without a direction stands for no change. Rows are unit vectors, in 2D vectors and
 * 1/length.
 */
template <int N>
HWY_INLINE void AddDerivative(MetricBlock& block, std::size_t at, std::size_t count, int axis,
  const std::array<const float*, 3>& own, const std::array<const float*, 3>& before,
  const std::array<const float*, 3>& after, const float* scale, bool perLane)
{
  const V signBit = hn::BitCast(DF(), hn::Set(DU(), 0x80000000u));
  for (std::size_t i = 0; i < count; i += Lanes)
  {
    V u[N];
    V a[N];
    V c[N];
    for (int k = 0; k < N; ++k)
    {
      u[k] = Load(own[k] + i);
      a[k] = Load(before[k] + i);
      c[k] = Load(after[k] + i);
    }
    const V signA = hn::And(Dot(u, a), signBit);
    const V signC = hn::And(Dot(u, c), signBit);
    const V perStep = perLane ? Load(scale + i) : Const(*scale);
    V change[N];
    if constexpr (N == 2)
    {
      // Only the part across u counts. Differences of unit vectors would lose it to rounding where
      // samples are close together.
      const V acrossA = hn::Xor(DifferenceOfProducts(u[0], a[1], u[1], a[0]), signA);
      const V acrossC = hn::Xor(DifferenceOfProducts(u[0], c[1], u[1], c[0]), signC);
      const V inverse = Load(own[2] + i);
      const V turn = hn::Mul(
        inverse, hn::MulSub(acrossC, Load(after[2] + i), hn::Mul(acrossA, Load(before[2] + i))));
      u[0] = hn::Mul(u[0], inverse);
      u[1] = hn::Mul(u[1], inverse);
      change[0] = hn::Neg(hn::Mul(turn, u[1]));
      change[1] = hn::Mul(turn, u[0]);
    }
    else
    {
      const auto noneA = hn::Eq(Dot(a, a), hn::Zero(DF()));
      const auto noneC = hn::Eq(Dot(c, c), hn::Zero(DF()));
      for (int k = 0; k < N; ++k)
      {
        change[k] = hn::Sub(hn::IfThenElse(noneC, u[k], hn::Xor(c[k], signC)),
          hn::IfThenElse(noneA, u[k], hn::Xor(a[k], signA)));
      }
    }
    const V factor = hn::Mul(u[axis], perStep);
    for (int k = 0; k < N; ++k)
    {
      float* const bend = block.Bend[k] + at + i;
      hn::StoreU(hn::MulAdd(factor, change[k], Load(bend)), DF(), bend);
    }
  }
}

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

/// Splits tuples of 3 into the bend; what is not finite or beyond sense becomes 0.
template <int N>
HWY_NOINLINE void CopyCurvature(
  const NoiseSetup& setup, const float* tuples, std::size_t count, MetricBlock& block)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    double bend[N];
    double length2 = 0.0;
    for (int axis = 0; axis < N; ++axis)
    {
      bend[axis] = tuples[3 * i + axis] * setup.Parameters.FeatureSize;
      length2 += bend[axis] * bend[axis];
    }
    const bool good = length2 < 1e30;
    for (int axis = 0; axis < N; ++axis)
    {
      block.Bend[axis][i] = good ? static_cast<float>(bend[axis]) : 0.0f;
    }
  }
}

/// As steerable::ApplyCurvature: eigenvalues and bend of samples [at, at + count) in one octave.
template <int N>
HWY_NOINLINE void BendMetrics(const NoiseSetup& setup, const OctaveSetup& octave, std::size_t at,
  std::size_t count, MetricBlock& block)
{
  for (std::size_t i = at; i < at + count; i += Lanes)
  {
    const V one = Const(1.0f);
    const V scale = hn::Mul(Load(block.Directed + i), Const(octave.CellSize));
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
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
