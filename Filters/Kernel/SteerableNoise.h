// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Steerable noise over arrays: the fast path.
 *
 * It gives what SteerableNoiseReference gives, to float precision, with SIMD chosen at run time. It
 * walks the rows of the lattice that meet the ellipsoid of the metric, not the box around it, so that
 * long streaks cost little more than short ones. Documentation/performance.md explains the stages.
 *
 * The value at a sample depends on its place, its vector (with curvature: its neighbours') and the
 * parameters only, so any split of the samples over threads, pieces and calls gives the same bits.
 */
#ifndef SteerableNoise_h
#define SteerableNoise_h

#include "NoiseParameters.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace steerable
{
/**
 * Where the kernel gets tuples from. The host converts whatever it has, block by block, or hands out
 * a pointer into its own memory.
 */
template <typename T>
class TupleReader
{
public:
  virtual ~TupleReader() = default;
  /// `count` tuples from tuple `first` on; `scratch` has room for them and may be returned.
  virtual const T* Read(std::size_t first, std::size_t count, T* scratch) const = 0;
};

/// Tuples that lie in memory as the kernel wants them.
template <typename T, int Components>
class ContiguousReader : public TupleReader<T>
{
public:
  explicit ContiguousReader(const T* tuples)
    : Tuples(tuples)
  {
  }
  const T* Read(std::size_t first, std::size_t, T*) const override
  {
    return this->Tuples + first * Components;
  }

private:
  const T* Tuples;
};

/// What steers the noise: vectors, tensors, metrics or nothing, one of them.
struct Field
{
  /// Nothing steers: isotropic noise, and no sample counts as one without a direction.
  bool Isotropic = false;
  /// 3 components; in 2D the third counts for the length alone, which masks and Strength go by.
  const TupleReader<float>* Vectors = nullptr;
  /// 6 components, XX YY ZZ XY YZ XZ; in 2D those with a Z count for the norm alone.
  const TupleReader<float>* Tensors = nullptr;
  /// 6 components as Tensors, the metric itself in 1 / cells²: see MetricFromMetric.
  const TupleReader<double>* Metrics = nullptr;
  /// 3 components, StreakLength, Strength and EigenvalueSum of each sample; null: those of the
  /// parameters.
  const TupleReader<float>* Shapes = nullptr;
  /// 3 components, surface normals of any length: asks for the metric of surfaces, 3D only.
  const TupleReader<float>* Normals = nullptr;
  /// 3 components, (u . grad) u in 1 / world units; for points only, images find it themselves.
  const TupleReader<float>* Curvature = nullptr;
};

/// A regular grid of samples; a 2D one has Dimensions[2] = 1.
struct ImageGrid
{
  /// World place of the sample with index 0 0 0.
  std::array<double, 3> Origin = { 0.0, 0.0, 0.0 };
  std::array<double, 3> Spacing = { 1.0, 1.0, 1.0 };
  /// Index of the first sample of this piece: places come from indices, so pieces agree to the bit.
  std::array<std::int64_t, 3> FirstIndex = { 0, 0, 0 };
  std::array<std::int64_t, 3> Dimensions = { 1, 1, 1 };
  /**
   * Samples to either side that curvature is differenced over, 1 to MaximumStride: of a field that was
   * interpolated to a finer grid, as many as lie between two of its own samples.
   */
  int CurvatureStride = 1;
  static constexpr int MaximumStride = 16;
  /// Rows that go through the stages together: parts of an image cost least in multiples of these.
  static constexpr std::size_t RowsTogether = 8;
  /// The least multiple of these that is more than so many rows.
  static constexpr std::size_t RowsBeyond(std::size_t rows)
  {
    return (rows / RowsTogether + 1) * RowsTogether;
  }

  std::size_t GetNumberOfRows() const
  {
    return static_cast<std::size_t>(this->Dimensions[1] * this->Dimensions[2]);
  }
};

struct EvaluationCounts
{
  /// Samples without a direction (zero, NaN, infinite, isotropic): they got the isotropic metric.
  std::uint64_t Degenerate = 0;
  /// Samples at or below MaskThreshold: they got 0.
  std::uint64_t Stagnant = 0;
  /// Metrics of the user's own whose eigenvalues were bounded.
  std::uint64_t Bounded = 0;
  /// Corners that were evaluated, over all samples and octaves.
  std::uint64_t VisitedCorners = 0;

  EvaluationCounts& operator+=(const EvaluationCounts& other)
  {
    this->Degenerate += other.Degenerate;
    this->Stagnant += other.Stagnant;
    this->Bounded += other.Bounded;
    this->VisitedCorners += other.VisitedCorners;
    return *this;
  }
};

class SteerableNoise
{
public:
  /// `dimension` is 2 or 3. Throws std::invalid_argument for anything out of range.
  SteerableNoise(const NoiseParameters& parameters, int dimension);

  /**
   * Noise of the rows [rowBegin, rowEnd) of a grid, row j of slice k being j + k Dimensions[1]; both
   * arrays hold the whole grid. Safe to call from several threads for different rows.
   */
  EvaluationCounts EvaluateImage(const ImageGrid& grid, const Field& field, std::size_t rowBegin,
    std::size_t rowEnd, float* noise) const;

  /// Noise of the points [begin, end) at 3-component positions in world units.
  EvaluationCounts EvaluatePoints(const TupleReader<double>& positions, const Field& field,
    std::size_t begin, std::size_t end, float* noise) const;

private:
  NoiseParameters Parameters;
  int Dimension;
};
} // namespace steerable

#endif
