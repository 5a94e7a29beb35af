// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Images: patches of some rows.
#if defined(STEERABLE_FAST_IMAGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef STEERABLE_FAST_IMAGES_INL_H
#undef STEERABLE_FAST_IMAGES_INL_H
#else
#define STEERABLE_FAST_IMAGES_INL_H
#endif

#include "Fast/Points-inl.h"

#include <memory>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/**
 * Place of sample `index` of a grid axis, in cells of an octave; 0 where a double no longer tells
 * one cell from the next.
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
      hn::StoreU(CellWindow(setup.Parameters.Fade, Load(this->Fraction.data() + i)), DF(),
        this->Window.data() + i);
    }
    if (serve)
    {
      const auto columns = static_cast<std::size_t>(cells.back() - firstColumn + 2);
      this->Rows = std::make_unique<GradientRows<N>>(
        octave, setup.Parameters.GradientSet, firstColumn, columns);
    }
  }
};

/// Rows of samples in a register of an image.
constexpr std::size_t LaneRows = Lanes >= 4 ? 2 : 1;
constexpr std::size_t LaneColumns = Lanes / LaneRows;

/// Rows of the patch that registers take, whole registers of them.
inline std::size_t RowsOfRegisters(std::size_t rows)
{
  return (rows + LaneRows - 1) / LaneRows * LaneRows;
}

/**
 * Exchanges halves of registers between the two rows of each pair, so that each holds samples of
 * both: the first LaneColumns of either, then the next. Where there is no second row the first
 * stands for it. Twice done, all is as it was.
 */
HWY_NOINLINE void PairRows(float* array, std::size_t rows, std::size_t columns)
{
#if HWY_TARGET != HWY_SCALAR
  if constexpr (LaneRows == 2)
  {
    for (std::size_t r = 0; r < rows; r += 2)
    {
      float* const first = array + r * PatchStride;
      float* const second = first + PatchStride;
      const float* const other = r + 1 < rows ? second : first;
      for (std::size_t i = 0; i < columns; i += Lanes)
      {
        const V a = hn::LoadU(DF(), first + i);
        const V b = hn::LoadU(DF(), other + i);
        hn::StoreU(hn::ConcatLowerLower(DF(), b, a), DF(), first + i);
        hn::StoreU(hn::ConcatUpperUpper(DF(), b, a), DF(), second + i);
      }
    }
  }
#else
  (void)array;
  (void)rows;
  (void)columns;
#endif
}

HWY_INLINE void PairRows(std::uint32_t* array, std::size_t rows, std::size_t columns)
{
  PairRows(reinterpret_cast<float*>(array), rows, columns);
}

/// What walks read of the metrics of a patch.
template <int N>
void PairMetrics(const NoiseSetup& setup, std::size_t rows, std::size_t columns, MetricBlock& block)
{
  for (int axis = 0; axis < N; ++axis)
  {
    PairRows(block.U[axis], rows, columns);
    if (setup.Curved)
    {
      PairRows(block.Bend[axis], rows, columns);
    }
    if (setup.Biaxial)
    {
      PairRows(block.M[axis], rows, columns);
    }
  }
  if (N == 2 || setup.Biaxial)
  {
    PairRows(block.URest[0], rows, columns);
    PairRows(block.URest[1], rows, columns);
  }
  if (setup.Biaxial)
  {
    PairRows(block.Second, rows, columns);
  }
  for (float* array : { block.Along, block.Across, block.Directed })
  {
    PairRows(array, rows, columns);
  }
}

/// One octave of a patch of an image, whose places are known.
template <int N, WalkKind Kind>
HWY_NOINLINE void WalkPatch(const NoiseSetup& setup, const OctaveSetup& octave, MetricBlock& block,
  std::size_t rows, std::size_t columns, std::uint64_t& visited)
{
  Walk<N, Kind> walk(setup, octave, block);
  Tile tile(RowsOfRegisters(rows) / LaneRows, LaneColumns);
  constexpr std::size_t tileColumns = TileRegisters * Lanes / PatchRows;
  static_assert(
    tileColumns % Lanes == 0 || LaneRows == 1, "Tiles begin where PairRows exchanges halves.");
  for (std::size_t i = 0; i < columns; i += tileColumns)
  {
    const std::size_t end = std::min(columns, i + tileColumns);
    if (i == 0 || end < i + tileColumns)
    {
      std::size_t r = 0;
      for (std::size_t column = i; column < end; column += LaneColumns)
      {
        // See PairRows.
        const std::size_t half = column % Lanes / LaneColumns;
        const std::size_t first = column / Lanes * Lanes + half * PatchStride;
        for (std::size_t row = 0; row < rows; row += LaneRows)
        {
          tile.SetRegister(r++, first + row * PatchStride, column - i, row,
            std::min(LaneColumns, end - column), std::min(LaneRows, rows - row));
        }
      }
      tile.Registers = r;
    }
    else
    {
      for (std::size_t r = 0; r < tile.Registers; ++r)
      {
        tile.First[r] += tileColumns;
      }
    }
    AddTile(setup, octave, block, walk, tile, visited);
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
    if (setup.Parameters.Lattice == Lattice::Simplicial)
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
  for (int axis = 0; axis < N; ++axis)
  {
    PairRows(block.Cell[axis], patch.Rows, patch.Columns);
    PairRows(block.Fraction[axis], patch.Rows, patch.Columns);
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
    window[axis] = CellWindow(setup.Parameters.Fade, fraction[axis]);
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
    LaneCorners<N> corners(octave, setup.Parameters.GradientSet);
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

  const std::int64_t mostRows = setup.SingleCell ? 1 : PatchRows;
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
      }
      for (std::size_t r = 0; r < RowsOfRegisters(patch.Rows) && octaves.size() > 1; ++r)
      {
        std::fill_n(block->Noise + Patch::At(r), patch.Columns + Lanes, 0.0f);
      }
      float* const direct = uniform ? noise + firstOf(0) : nullptr;
      if (!setup.SingleCell)
      {
        PairMetrics<N>(setup, patch.Rows, patch.Columns, *block);
      }
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
        for (std::size_t r = 0; r < RowsOfRegisters(patch.Rows) && setup.Curved; ++r)
        {
          BendMetrics<N>(setup, octave, Patch::At(r), patch.Columns, *block);
        }
        const auto walk = ChooseWalk(setup, &WalkPatch<N, WalkKind::Plain>,
          &WalkPatch<N, WalkKind::Windowed>, &WalkPatch<N, WalkKind::Variant>);
        walk(setup, octave, *block, patch.Rows, patch.Columns, counts.VisitedCorners);
      }
      if (!setup.SingleCell)
      {
        PairRows(block->Noise, RowsOfRegisters(patch.Rows), patch.Columns);
        PairRows(block->Directed, RowsOfRegisters(patch.Rows), patch.Columns);
      }
      for (std::size_t r = 0; r < patch.Rows && !uniform; ++r)
      {
        Finish(setup, *block, Patch::At(r), patch.Columns, noise + firstOf(r), counts);
      }
    }
  }
  return counts;
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#endif
