// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseLengths.h"

#include "LengthOctaves.h"
#include "NoiseArrays.h"
#include "NoiseBlocks.h"
#include "NoiseGhosts.h"
#include "NoiseThreads.h"

#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkMultiProcessController.h"
#include "vtkSMPThreadLocal.h"

#include <algorithm>
#include <cmath>

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
    int found = 0;
    for (vtkIdType i = 0; i < size; ++i)
    {
      found += std::abs(from[i]) >= least;
    }
    if (found > 0)
    {
      return true;
    }
  }
  return false;
}

/// Whether an array has a number so large that LengthOctaves can find a vector in it; quick.
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

HiddenSamples HiddenOf(const LengthSource& source)
{
  return source.DataSet ? HiddenSamples(source.DataSet) : HiddenSamples();
}

/// Adds the lengths of the tuples that are at most `limit` long.
void AddLengths(steerable::LengthOctaves& octaves, const LengthSource& source, double limit)
{
  vtkDataArray* array = source.Array;
  const HiddenSamples hiddenSamples = HiddenOf(source);
  const std::vector<unsigned char>& hidden = hiddenSamples.Get(source.Cells);
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

/// All ranks take part.
void ReduceOctaves(steerable::LengthOctaves& octaves, vtkMultiProcessController* controller)
{
  if (!controller || controller->GetNumberOfProcesses() < 2)
  {
    return;
  }
  constexpr double none = std::numeric_limits<double>::infinity();
  std::vector<double> counts;
  std::vector<double> ends; // shortest ones, then negated longest ones
  for (const auto& octave : octaves.Octaves)
  {
    counts.push_back(octave.Count);
    ends.push_back(octave.Count > 0.0 ? octave.Least : none);
    ends.push_back(-octave.Longest);
  }
  Reduce(controller, counts.data(), counts.size(), vtkCommunicator::SUM_OP);
  Reduce(controller, ends.data(), ends.size(), vtkCommunicator::MIN_OP);
  for (std::size_t i = 0; i < octaves.Octaves.size(); ++i)
  {
    octaves.Octaves[i] = { counts[i], ends[2 * i], -ends[2 * i + 1] };
  }
}

/// All ranks take part.
bool AreAnyFar(const std::vector<LengthSource>& arrays, vtkMultiProcessController* controller)
{
  double any = std::any_of(arrays.begin(), arrays.end(),
    [](const LengthSource& source) { return MayHoldFarAbove(source.Array); });
  Reduce(controller, &any, 1, vtkCommunicator::MAX_OP);
  return any != 0.0;
}

/// Largest component, by its amount, of the tuples longer than `rest`; all ranks take part.
double FindFarValue(const std::vector<LengthSource>& arrays, double rest,
  vtkMultiProcessController* controller)
{
  double ends[2] = { 0.0, 0.0 }; // up and down
  for (const LengthSource& source : arrays)
  {
    const HiddenSamples hiddenSamples = HiddenOf(source);
    const std::vector<unsigned char>& hidden = hiddenSamples.Get(source.Cells);
    for (vtkIdType i = 0; i < source.Array->GetNumberOfTuples(); ++i)
    {
      double length;
      ReadLengths(source.Array, static_cast<std::size_t>(i), 1, &length);
      if (length > rest && std::isfinite(length) && (hidden.empty() || !hidden[i]))
      {
        const double value = GetLargestComponent(source.Array, i);
        ends[0] = std::max(ends[0], value);
        ends[1] = std::max(ends[1], -value);
      }
    }
  }
  Reduce(controller, ends, 2, vtkCommunicator::MAX_OP);
  return ends[0] >= ends[1] ? ends[0] : -ends[1];
}
} // namespace

//------------------------------------------------------------------------------
LengthRange FindLengths(const std::vector<LengthSource>& arrays, double upperThreshold,
  vtkMultiProcessController* controller, bool longest)
{
  LengthRange range;
  range.Limit = upperThreshold > 0.0 ? upperThreshold : range.Limit;
  if (!longest && (upperThreshold > 0.0 || !AreAnyFar(arrays, controller)))
  {
    return range; // nobody asks
  }
  steerable::LengthOctaves octaves;
  for (const LengthSource& source : arrays)
  {
    AddLengths(octaves, source, range.Limit);
  }
  ReduceOctaves(octaves, controller);
  if (upperThreshold <= 0.0)
  {
    const steerable::FarAbove farAbove = octaves.FindFarAbove();
    range.FarCount = farAbove.Count;
    range.FarLongest = farAbove.Longest;
    range.FarRest = farAbove.Rest;
    if (farAbove.Fill)
    {
      range.Limit = farAbove.Rest;
      range.Fills = farAbove.Count;
    }
    range.FarValue = farAbove.Count > 0.0 ? FindFarValue(arrays, farAbove.Rest, controller) : 0.0;
  }
  range.Longest = octaves.GetLongest(range.Limit);
  return range;
}
} // namespace noise
