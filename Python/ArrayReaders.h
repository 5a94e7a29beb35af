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
#include <array>
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

/// Tuples of 3 doubles, x fastest.
class ArrayTuples
{
public:
  explicit ArrayTuples(const Components& components)
    : Count(std::min<std::size_t>(components.size(), 3))
    , AreFloats(components[0].dtype() == nanobind::dtype<float>())
  {
    for (std::size_t c = 0; c < this->Count; ++c)
    {
      this->Data[c] = components[c].data();
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        this->Shape[axis] = components[c].shape(axis);
        this->Stride[c][axis] = components[c].stride(axis);
      }
    }
  }

  std::size_t GetNumberOfTuples() const { return this->Shape[0] * this->Shape[1] * this->Shape[2]; }

  void Read(std::size_t first, std::size_t count, double* tuples) const
  {
    this->AreFloats ? this->ReadAs<float>(first, count, tuples) : this->ReadAs<double>(first, count, tuples);
  }

  /// The tuples where they lie, if they are floats as the kernel takes them; else null.
  const float* GetFloats() const
  {
    const auto* first = static_cast<const float*>(this->Data[0]);
    bool together = this->AreFloats && this->Count == 3;
    for (std::size_t c = 0; together && c < 3; ++c)
    {
      const auto nx = static_cast<std::int64_t>(this->Shape[2]);
      const std::int64_t wanted[3] = { 3 * nx * static_cast<std::int64_t>(this->Shape[1]), 3 * nx, 3 };
      together = static_cast<const float*>(this->Data[c]) == first + c;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        together = together && (this->Shape[axis] == 1 || this->Stride[c][axis] == wanted[axis]);
      }
    }
    return together ? first : nullptr;
  }

private:
  template <typename T>
  void ReadAs(std::size_t first, std::size_t count, double* tuples) const
  {
    const std::size_t nx = this->Shape[2];
    const std::size_t ny = this->Shape[1];
    while (count > 0)
    {
      // As much of a row as is wanted.
      const std::size_t x = first % nx;
      const std::size_t size = std::min(count, nx - x);
      for (std::size_t c = 0; c < 3; ++c)
      {
        if (c >= this->Count)
        {
          for (std::size_t i = 0; i < size; ++i)
          {
            tuples[3 * i + c] = 0.0;
          }
          continue;
        }
        const auto& stride = this->Stride[c];
        const T* from = static_cast<const T*>(this->Data[c]) +
          static_cast<std::int64_t>(first / nx / ny) * stride[0] +
          static_cast<std::int64_t>(first / nx % ny) * stride[1];
        for (std::size_t i = 0; i < size; ++i)
        {
          tuples[3 * i + c] = from[static_cast<std::int64_t>(x + i) * stride[2]];
        }
      }
      first += size;
      count -= size;
      tuples += 3 * size;
    }
  }

  std::size_t Count;
  bool AreFloats;
  const void* Data[3] = {};
  std::size_t Shape[3] = {};
  std::array<std::int64_t, 3> Stride[3] = {};
};

/// Length of a vector, of the largest number if it is too long to be squared.
inline double LengthOf(const double* v)
{
  return steerable::LengthFromSquares(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], v, 3);
}

/// Visits the tuples [first, first + count) as visit(index, tuple).
template <typename Visit>
void ForEachTuple(const ArrayTuples& tuples, std::size_t first, std::size_t count, Visit&& visit)
{
  constexpr std::size_t chunk = 512;
  double values[3 * chunk];
  for (const std::size_t end = first + count; first < end; first += chunk)
  {
    const std::size_t size = std::min(chunk, end - first);
    tuples.Read(first, size, values);
    for (std::size_t i = 0; i < size; ++i)
    {
      visit(first + i, values + 3 * i);
    }
  }
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
    ForEachTuple(this->Tuples, first, count,
      [&](std::size_t i, const double* vector)
      {
        float* to = scratch + 3 * (i - first);
        // Short vectors and long ones are scaled; these need not be.
        const double sum = std::abs(vector[0]) + std::abs(vector[1]) + std::abs(vector[2]);
        if (std::isfinite(this->Limit) && LengthOf(vector) > this->Limit)
        {
          std::fill_n(to, 3, std::numeric_limits<float>::quiet_NaN());
        }
        else if (sum < steerable::LongestTuple && sum > 4.0 / steerable::LongestTuple)
        {
          for (int c = 0; c < 3; ++c)
          {
            to[c] = static_cast<float>(vector[c]);
          }
        }
        else
        {
          steerable::ToFloats(vector, 3, to);
        }
      });
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
    this->Tuples.Read(first, count, scratch);
    return scratch;
  }

private:
  const ArrayTuples& Tuples;
};

#endif
