// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseLengths.h"

#include "NoiseArrays.h"
#include "NoiseThreads.h"

#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMultiProcessController.h"
#include "vtkSMPThreadLocal.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noise
{
namespace
{
template <typename T>
bool AnyFrom(const T* values, vtkIdType count, T least)
{
  // Whole chunks without a branch, which the compiler turns into SIMD.
  constexpr vtkIdType chunkSize = 4096;
  for (vtkIdType first = 0; first < count; first += chunkSize)
  {
    const T* from = values + first;
    const vtkIdType size = std::min(chunkSize, count - first);
    bool any = false;
    for (vtkIdType i = 0; i < size; ++i)
    {
      any |= std::abs(from[i]) >= least;
    }
    if (any)
    {
      return true;
    }
  }
  return false;
}
} // namespace

bool MayHoldFarAbove(vtkDataArray* array)
{
  constexpr double least = steerable::LeastFillLength / 3.0; // 9 components of a tensor together
  if (auto* floats = vtkFloatArray::FastDownCast(array))
  {
    return AnyFrom(floats->GetPointer(0), floats->GetNumberOfValues(), static_cast<float>(least));
  }
  if (auto* doubles = vtkDoubleArray::FastDownCast(array))
  {
    return AnyFrom(doubles->GetPointer(0), doubles->GetNumberOfValues(), least);
  }
  return true;
}

void AddLengths(steerable::LengthOctaves& octaves, vtkDataArray* array,
  const std::vector<unsigned char>& hidden, double limit)
{
  constexpr vtkIdType chunkSize = 4096;
  vtkSMPThreadLocal<steerable::LengthOctaves> local;
  WithThreads(
    [&]
    {
      vtkSMPTools::For(0, array->GetNumberOfTuples(), 16 * chunkSize,
        [&](vtkIdType begin, vtkIdType end)
        {
          steerable::LengthOctaves& here = local.Local();
          std::vector<double> lengths(chunkSize);
          for (vtkIdType first = begin; first < end; first += chunkSize)
          {
            const vtkIdType count = std::min(chunkSize, end - first);
            ReadLengths(array, static_cast<std::size_t>(first), static_cast<std::size_t>(count),
              lengths.data());
            for (vtkIdType i = 0; i < count; ++i)
            {
              const double length = lengths[i];
              if (length <= limit && (hidden.empty() || !hidden[first + i]))
              {
                here.Add(length);
              }
            }
          }
        });
      // In here: each backend has thread-local values of its own, and the sequential one none of these.
      for (const steerable::LengthOctaves& here : local)
      {
        octaves += here;
      }
    });
}

void Reduce(steerable::LengthOctaves& octaves, vtkMultiProcessController* controller)
{
  constexpr auto count = static_cast<vtkIdType>(std::tuple_size<decltype(octaves.Octaves)>::value);
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> counts;
  std::vector<double> ends; // shortest ones, then negated longest ones
  for (const auto& octave : octaves.Octaves)
  {
    counts.push_back(octave.Count);
    ends.push_back(octave.Count > 0.0 ? octave.Least : none);
    ends.push_back(-octave.Longest);
  }
  std::vector<double> sums(counts.size());
  std::vector<double> least(ends.size());
  controller->AllReduce(counts.data(), sums.data(), count, vtkCommunicator::SUM_OP);
  controller->AllReduce(ends.data(), least.data(), 2 * count, vtkCommunicator::MIN_OP);
  for (std::size_t i = 0; i < octaves.Octaves.size(); ++i)
  {
    octaves.Octaves[i] = { sums[i], least[2 * i], -least[2 * i + 1] };
  }
}
} // namespace noise
