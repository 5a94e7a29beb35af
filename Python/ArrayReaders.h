// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * NumPy arrays as the kernel's tuple readers: read where they lie, whatever their strides.
 */
#ifndef ArrayReaders_h
#define ArrayReaders_h

#include "SteerableNoise.h"
#include "TupleFloats.h"

#include <nanobind/ndarray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

/// One component, axes z, y, x; of points (1, 1, n).
using Component = nanobind::ndarray<nanobind::ro, nanobind::ndim<3>, nanobind::device::cpu>;
/// 2 (the third is 0) or 3 components of one shape and one type, float or double.
using Components = std::vector<Component>;

/// Tuples of 3, x fastest.
class ArrayTuples
{
public:
  explicit ArrayTuples(const Components& components)
    : AreFloats(components[0].dtype() == nanobind::dtype<float>())
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      this->Shape[axis] = components[0].shape(axis);
    }
    for (std::size_t c = 0; c < std::min<std::size_t>(components.size(), 3); ++c)
    {
      this->Data[c] = components[c].data();
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        this->Stride[c][axis] = components[c].stride(axis);
      }
    }
  }

  std::size_t GetNumberOfTuples() const { return this->Shape[0] * this->Shape[1] * this->Shape[2]; }

  /// Visits the tuples [first, first + count) as visit(index, const double (&tuple)[3]).
  template <typename Visit>
  void ForEach(std::size_t first, std::size_t count, Visit&& visit) const
  {
    this->AreFloats ? this->ForEachOf<float>(first, count, visit)
                    : this->ForEachOf<double>(first, count, visit);
  }

  /// Whether any component of the rows [begin, end) is at least so large; NaN is not.
  bool AnyFrom(std::size_t begin, std::size_t end, double least) const
  {
    return this->AreFloats ? this->AnyFromOf(begin, end, static_cast<float>(least))
                           : this->AnyFromOf(begin, end, least);
  }

  std::size_t GetNumberOfRows() const { return this->Shape[0] * this->Shape[1]; }

  /// The tuples where they lie, if they are floats as the kernel takes them; else null.
  const float* GetFloats() const
  {
    const auto* first = static_cast<const float*>(this->Data[0]);
    const auto nx = static_cast<std::int64_t>(this->Shape[2]);
    const auto ny = static_cast<std::int64_t>(this->Shape[1]);
    const std::int64_t wanted[3] = { 3 * nx * ny, 3 * nx, 3 };
    bool together = this->AreFloats;
    for (std::size_t c = 0; c < 3; ++c)
    {
      together = together && static_cast<const float*>(this->Data[c]) == first + c;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        together = together && (this->Shape[axis] == 1 || this->Stride[c][axis] == wanted[axis]);
      }
    }
    return together ? first : nullptr;
  }

private:
  template <typename T>
  const T* GetRow(int c, std::size_t row) const
  {
    return static_cast<const T*>(this->Data[c]) +
      static_cast<std::int64_t>(row / this->Shape[1]) * this->Stride[c][0] +
      static_cast<std::int64_t>(row % this->Shape[1]) * this->Stride[c][1];
  }

  /// How many components lie side by side, with nothing else along a row; 0 if they do not.
  template <typename T>
  std::int64_t CountTogether() const
  {
    std::int64_t count = 1;
    const auto* first = static_cast<const T*>(this->Data[0]);
    while (count < 3 && this->Data[count] == first + count)
    {
      ++count;
    }
    bool together = count == 3 || this->Data[count] == &Zero;
    for (std::int64_t c = 0; c < count; ++c)
    {
      together = together && this->Stride[c][2] == count && this->Stride[c][1] == this->Stride[0][1] &&
        this->Stride[c][0] == this->Stride[0][0];
    }
    return together ? count : 0;
  }

  template <typename T>
  bool AnyFromOf(std::size_t begin, std::size_t end, T least) const
  {
    bool any = false;
    const auto nx = static_cast<std::int64_t>(this->Shape[2]);
    // Without a branch, which the compiler turns into SIMD.
    const auto look = [&](const T* values, std::int64_t size, std::int64_t step)
    {
      for (std::int64_t i = 0; i < size; ++i)
      {
        any |= std::abs(values[i * step]) >= least;
      }
    };
    const std::int64_t together = this->CountTogether<T>();
    for (std::size_t row = begin; row < end && !any; ++row)
    {
      if (together > 0)
      {
        look(this->GetRow<T>(0, row), together * nx, 1);
      }
      for (int c = 0; c < 3 && together == 0; ++c)
      {
        const std::int64_t step = this->Stride[c][2];
        look(this->GetRow<T>(c, row), step ? nx : 1, step);
      }
    }
    return any;
  }

  template <typename T, typename Visit>
  void ForEachOf(std::size_t first, std::size_t count, Visit& visit) const
  {
    const std::size_t nx = this->Shape[2];
    while (count > 0)
    {
      // As much of a row as is wanted.
      const std::size_t x = first % nx;
      const std::size_t size = std::min(count, nx - x);
      const T* from[3];
      for (int c = 0; c < 3; ++c)
      {
        from[c] =
          this->GetRow<T>(c, first / nx) + static_cast<std::int64_t>(x) * this->Stride[c][2];
      }
      const std::int64_t step[3] = { this->Stride[0][2], this->Stride[1][2], this->Stride[2][2] };
      for (std::size_t i = 0; i < size; ++i)
      {
        const auto at = static_cast<std::int64_t>(i);
        const double tuple[3] = { static_cast<double>(from[0][at * step[0]]),
          static_cast<double>(from[1][at * step[1]]), static_cast<double>(from[2][at * step[2]]) };
        visit(first + i, tuple);
      }
      first += size;
      count -= size;
    }
  }

  static constexpr double Zero = 0.0; // as a float too

  bool AreFloats;
  /// What is not there is 0 everywhere.
  const void* Data[3] = { &Zero, &Zero, &Zero };
  std::size_t Shape[3] = {};
  std::int64_t Stride[3][3] = {};
};

/// Length of a vector, of the largest number if it is too long to be squared.
inline double LengthOf(const double (&v)[3])
{
  return steerable::LengthFromSquares(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], v, 3);
}

/// Vectors as floats; those longer than `limit` are NaN, so that they count for nothing.
class VectorReader : public steerable::TupleReader<float>
{
public:
  explicit VectorReader(
    const ArrayTuples& tuples, double limit = std::numeric_limits<double>::infinity())
    : Tuples(tuples)
    , Limit(limit)
  {
  }

  const float* Read(std::size_t first, std::size_t count, float* scratch) const override
  {
    const bool limited = std::isfinite(this->Limit);
    // Short vectors and long ones are scaled; hardly any data have them.
    bool plain = !limited;
    if (plain)
    {
      this->Tuples.ForEach(first, count,
        [&](std::size_t i, const double (&vector)[3])
        {
          const double sum = std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]);
          // Without a branch, as nearly all data pass.
          plain &= (sum == 0.0) |
            ((sum < steerable::LongestTuple) & (sum > 4.0 / steerable::LongestTuple));
          for (int c = 0; c < 3; ++c)
          {
            scratch[3 * (i - first) + c] = static_cast<float>(vector[c]);
          }
        });
    }
    if (!plain)
    {
      this->Tuples.ForEach(first, count,
        [&](std::size_t i, const double (&vector)[3])
        {
          float* to = scratch + 3 * (i - first);
          if (limited && LengthOf(vector) > this->Limit)
          {
            std::fill_n(to, 3, std::numeric_limits<float>::quiet_NaN());
          }
          else
          {
            steerable::ToFloats(vector, 3, to);
          }
        });
    }
    return scratch;
  }

private:
  const ArrayTuples& Tuples;
  double Limit;
};

/// The same, or the array itself where it has what the kernel takes; `tuples` have to outlive it.
inline std::unique_ptr<steerable::TupleReader<float>> MakeVectorReader(
  const ArrayTuples& tuples, double limit = std::numeric_limits<double>::infinity())
{
  if (const float* floats = tuples.GetFloats(); floats && !std::isfinite(limit))
  {
    return std::make_unique<steerable::ContiguousReader<float, 3>>(floats);
  }
  return std::make_unique<VectorReader>(tuples, limit);
}

class PlaceReader : public steerable::TupleReader<double>
{
public:
  explicit PlaceReader(const ArrayTuples& tuples)
    : Tuples(tuples)
  {
  }
  const double* Read(std::size_t first, std::size_t count, double* scratch) const override
  {
    this->Tuples.ForEach(first, count,
      [&](std::size_t i, const double (&place)[3])
      { std::copy_n(place, 3, scratch + 3 * (i - first)); });
    return scratch;
  }

private:
  const ArrayTuples& Tuples;
};

#endif
