// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The order in which the kernel takes points (private to this module): those of a tile share what
 * they need of the lattice where they lie together, and points of a mesh may come in any order.
 */
#ifndef NoiseOrder_h
#define NoiseOrder_h

#include "SteerableNoise.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace noise
{
/**
 * Indices of places along a Morton curve, where the order they have is much worse than that:
 * successive ones are far apart. Else empty. `bounds` as VTK has them; `dimension` 2: the places lie
 * on surfaces, 3: in a volume. Uses threads.
 */
std::vector<std::uint32_t> FindOrder(const steerable::TupleReader<double>& places,
  std::size_t count, const double (&bounds)[6], int dimension);

/// Tuples in another order: the tuple i is that of `order[i]`.
template <typename T>
class ReorderedReader : public steerable::TupleReader<T>
{
public:
  ReorderedReader(
    const steerable::TupleReader<T>& reader, int components, const std::uint32_t* order)
    : Reader(reader)
    , Components(components)
    , Order(order)
  {
  }

  const T* Read(std::size_t first, std::size_t count, T* scratch) const override
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      T* tuple = scratch + i * this->Components;
      const T* read = this->Reader.Read(this->Order[first + i], 1, tuple);
      for (int c = 0; c < this->Components && read != tuple; ++c)
      {
        tuple[c] = read[c];
      }
    }
    return scratch;
  }

private:
  const steerable::TupleReader<T>& Reader;
  int Components;
  const std::uint32_t* Order;
};

/// EvaluatePoints of the points order[begin] to order[end - 1], with the same values.
steerable::EvaluationCounts EvaluateInOrder(const steerable::SteerableNoise& kernel,
  const steerable::TupleReader<double>& positions, const steerable::Field& field,
  const std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end, float* noise);
} // namespace noise

#endif
