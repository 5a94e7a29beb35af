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
/// Fill values start at 99 and stand out: flow is continuous, and so are its lengths.
constexpr double LeastFill = 99.0;
constexpr double Gap = 16.0;
/// The root of 3, and a little: a number in one component beside the same in three.
constexpr double Alike = 1.75;

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
  constexpr double least = LeastFill / 3.0; // 9 components of a tensor together
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

void LengthOctaves::Add(Octaves& octaves, double length)
{
  Octave& octave = octaves[static_cast<std::size_t>(std::ilogb(length) - Lowest)];
  octave.Least = octave.Count > 0.0 ? std::min(octave.Least, length) : length;
  octave.Longest = std::max(octave.Longest, length);
  octave.Count += 1.0;
}

void LengthOctaves::Add(Octaves& octaves, const Octaves& more)
{
  for (std::size_t i = 0; i < octaves.size(); ++i)
  {
    if (more[i].Count > 0.0)
    {
      octaves[i].Least =
        octaves[i].Count > 0.0 ? std::min(octaves[i].Least, more[i].Least) : more[i].Least;
      octaves[i].Longest = std::max(octaves[i].Longest, more[i].Longest);
      octaves[i].Count += more[i].Count;
    }
  }
}

void LengthOctaves::Add(
  vtkDataArray* array, const std::vector<unsigned char>& hidden, double limit)
{
  constexpr vtkIdType chunkSize = 4096;
  vtkSMPThreadLocal<Octaves> octaves;
  WithThreads(
    [&]
    {
      vtkSMPTools::For(0, array->GetNumberOfTuples(), 16 * chunkSize,
        [&](vtkIdType begin, vtkIdType end)
        {
          Octaves& here = octaves.Local();
          std::vector<double> lengths(chunkSize);
          for (vtkIdType first = begin; first < end; first += chunkSize)
          {
            const vtkIdType count = std::min(chunkSize, end - first);
            ReadLengths(array, static_cast<std::size_t>(first), static_cast<std::size_t>(count),
              lengths.data());
            for (vtkIdType i = 0; i < count; ++i)
            {
              const double length = lengths[i];
              if (length > 0.0 && length <= limit && std::isfinite(length) &&
                (hidden.empty() || !hidden[first + i]))
              {
                Add(here, length);
              }
            }
          }
        });
      // In here: each backend has thread-local values of its own, and the sequential one none of these.
      for (const Octaves& here : octaves)
      {
        Add(this->All, here);
      }
    });
}

void LengthOctaves::Reduce(vtkMultiProcessController* controller)
{
  constexpr auto count = static_cast<vtkIdType>(std::tuple_size<Octaves>::value);
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> counts;
  std::vector<double> ends; // shortest ones, then negated longest ones
  for (const Octave& octave : this->All)
  {
    counts.push_back(octave.Count);
    ends.push_back(octave.Count > 0.0 ? octave.Least : none);
    ends.push_back(-octave.Longest);
  }
  std::vector<double> sums(counts.size());
  std::vector<double> least(ends.size());
  controller->AllReduce(counts.data(), sums.data(), count, vtkCommunicator::SUM_OP);
  controller->AllReduce(ends.data(), least.data(), 2 * count, vtkCommunicator::MIN_OP);
  for (std::size_t i = 0; i < this->All.size(); ++i)
  {
    this->All[i] = { sums[i], least[2 * i], -least[2 * i + 1] };
  }
}

double LengthOctaves::GetLongest(double limit) const
{
  double longest = 0.0;
  for (const Octave& octave : this->All)
  {
    longest = octave.Count > 0.0 && octave.Longest <= limit ? octave.Longest : longest;
  }
  return longest;
}

FarAbove LengthOctaves::FindFarAbove() const
{
  FarAbove found;
  // From the longest down: those since the last gap, and all before them, which are fill values.
  FarAbove group;
  double fills = 0.0;
  double least = 0.0;
  for (auto octave = this->All.rbegin(); octave != this->All.rend(); ++octave)
  {
    if (!(octave->Count > 0.0))
    {
      continue;
    }
    if (group.Count > 0.0 && least >= LeastFill && least >= Gap * octave->Longest)
    {
      group.Fill = group.Longest <= Alike * least;
      if (!group.Fill)
      {
        return found.Count > 0.0 ? found : FarAbove{ group.Count, group.Longest, octave->Longest, false };
      }
      fills += group.Count;
      found = { fills, found.Count > 0.0 ? found.Longest : group.Longest, octave->Longest, true };
      group = {};
    }
    group.Longest = group.Count > 0.0 ? group.Longest : octave->Longest;
    group.Count += octave->Count;
    least = octave->Least;
  }
  return found;
}
} // namespace noise
