// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "LengthOctaves.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace steerable
{
namespace
{
constexpr double Gap = 16.0;
/// The root of 3, and a little: a number in one component beside the same in three.
constexpr double Alike = 1.75;
} // namespace

void LengthOctaves::Add(double length)
{
  std::uint64_t bits;
  std::memcpy(&bits, &length, sizeof(bits));
  const std::uint64_t exponent = bits >> 52;
  if (!(length > 0.0) || exponent >= this->Octaves.size())
  {
    return;
  }
  Octave& octave = this->Octaves[exponent];
  octave.Least = octave.Count > 0.0 ? std::min(octave.Least, length) : length;
  octave.Longest = std::max(octave.Longest, length);
  octave.Count += 1.0;
}

LengthOctaves& LengthOctaves::operator+=(const LengthOctaves& more)
{
  for (std::size_t i = 0; i < this->Octaves.size(); ++i)
  {
    Octave& octave = this->Octaves[i];
    const Octave& other = more.Octaves[i];
    if (other.Count > 0.0)
    {
      octave.Least = octave.Count > 0.0 ? std::min(octave.Least, other.Least) : other.Least;
      octave.Longest = std::max(octave.Longest, other.Longest);
      octave.Count += other.Count;
    }
  }
  return *this;
}

double LengthOctaves::GetLongest(double limit) const
{
  double longest = 0.0;
  for (const Octave& octave : this->Octaves)
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
  for (auto octave = this->Octaves.rbegin(); octave != this->Octaves.rend(); ++octave)
  {
    if (!(octave->Count > 0.0))
    {
      continue;
    }
    if (group.Count > 0.0 && least >= LeastFillLength && least >= Gap * octave->Longest)
    {
      group.Fill = group.Longest <= Alike * least;
      if (!group.Fill)
      {
        return found.Count > 0.0
          ? found
          : FarAbove{ group.Count, group.Longest, octave->Longest, false };
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
} // namespace steerable
