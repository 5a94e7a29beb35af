// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseCopies.h"

#include "CellSums.h"
#include "PointPlaces.h"

#include "vtkDataSet.h"
#include "vtkFloatArray.h"
#include "vtkSMPTools.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace noise
{
namespace
{
// Copies of a point beyond this number stay on their own, so that a heap of points takes no time.
constexpr std::size_t MostCopies = 256;

using Key = std::pair<std::uint64_t, vtkIdType>;

/// Of the whole numbers nearest to these coordinates; not 0.
std::uint64_t HashOf(const Eigen::Vector3d& place)
{
  std::uint64_t hash = 0x9E3779B97F4A7C15u;
  for (const double value : place)
  {
    hash = (hash ^ static_cast<std::uint64_t>(LowestBits(value + LeavesWholes))) * 0xBF58476D1CE4E5B9u;
    hash ^= hash >> 31;
  }
  return std::max<std::uint64_t>(hash, 1);
}

/// Tells of most hashes that no other one is the same: two bits say whether they were seen once, or again.
class Repeats
{
public:
  explicit Repeats(std::size_t count)
  {
    // Eight pairs or more for each.
    std::size_t words = 1;
    while (words < count / 4)
    {
      words *= 2;
    }
    this->Words.resize(words);
  }

  void See(std::uint64_t hash)
  {
    std::uint64_t& word = this->Words[this->GetWord(hash)];
    const std::uint64_t seen = word >> GetShift(hash) & 1;
    word |= (1 | seen << 1) << GetShift(hash);
  }
  /// What another one of the same size has seen.
  void See(const Repeats& other)
  {
    constexpr std::uint64_t once = 0x5555555555555555u;
    for (std::size_t i = 0; i < this->Words.size(); ++i)
    {
      const std::uint64_t both = this->Words[i] & other.Words[i] & once;
      this->Words[i] |= other.Words[i] | both << 1;
    }
  }
  bool MayBeRepeated(std::uint64_t hash) const
  {
    return (this->Words[this->GetWord(hash)] >> GetShift(hash) & 2) != 0;
  }

private:
  std::size_t GetWord(std::uint64_t hash) const { return hash >> 5 & (this->Words.size() - 1); }
  static int GetShift(std::uint64_t hash) { return 2 * static_cast<int>(hash & 31); }

  std::vector<std::uint64_t> Words;
};
} // namespace

CoincidentPoints::CoincidentPoints(vtkDataSet* dataset, const HiddenSamples& hidden)
{
  const vtkIdType count = dataset->GetNumberOfPoints();
  const PointPlaces places(dataset);
  const auto isThere = [&](vtkIdType point, const Eigen::Vector3d& place)
  { return place.allFinite() && !hidden.HasPoint(point); };
  constexpr vtkIdType chunkSize = 65536;
  const vtkIdType chunks = (count + chunkSize - 1) / chunkSize;
  std::vector<double> largestOf(static_cast<std::size_t>(chunks), 0.0);
  const auto forEachChunk = [&](auto&& visit)
  {
    vtkSMPTools::For(0, chunks, 1,
      [&](vtkIdType begin, vtkIdType end)
      {
        for (vtkIdType chunk = begin; chunk < end; ++chunk)
        {
          visit(chunk, chunk * chunkSize, std::min(count, (chunk + 1) * chunkSize));
        }
      });
  };
  forEachChunk(
    [&](vtkIdType chunk, vtkIdType begin, vtkIdType end)
    {
      double largest = 0.0;
      for (vtkIdType point = begin; point < end; ++point)
      {
        const Eigen::Vector3d place = places(point);
        largest = isThere(point, place) ? std::max(largest, place.cwiseAbs().maxCoeff()) : largest;
      }
      largestOf[static_cast<std::size_t>(chunk)] = largest;
    });
  const double largest = count > 0 ? *std::max_element(largestOf.begin(), largestOf.end()) : 0.0;
  this->Starts.push_back(0);
  if (!(largest > 1e-300) || largest > 1e300)
  {
    return;
  }
  // Most points are alone. What tells nearly all of them is asked twice, and the rest is sorted.
  const double unitsPerLength = std::ldexp(1.0, 22 - std::ilogb(largest));
  std::vector<std::uint64_t> hashes(static_cast<std::size_t>(count), 0); // 0: no place
  forEachChunk(
    [&](vtkIdType, vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType point = begin; point < end; ++point)
      {
        const Eigen::Vector3d place = places(point);
        if (isThere(point, place))
        {
          hashes[static_cast<std::size_t>(point)] = HashOf(place * unitsPerLength);
        }
      }
    });
  // Two, for two threads at once; more would take more memory than what comes after.
  std::vector<Repeats> repeats(2, Repeats(hashes.size()));
  vtkSMPTools::For(0, 2, 1,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType half = begin; half < end; ++half)
      {
        std::for_each(hashes.begin() + count * half / 2, hashes.begin() + count * (half + 1) / 2,
          [&](std::uint64_t hash) { repeats[static_cast<std::size_t>(half)].See(hash); });
      }
    });
  repeats[0].See(repeats[1]);
  repeats.resize(1, Repeats(0));
  forEachChunk(
    [&](vtkIdType, vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType point = begin; point < end; ++point)
      {
        std::uint64_t& hash = hashes[static_cast<std::size_t>(point)];
        hash = repeats[0].MayBeRepeated(hash) ? hash : 0;
      }
    });
  std::vector<Key> order;
  for (vtkIdType point = 0; point < count; ++point)
  {
    if (const std::uint64_t hash = hashes[static_cast<std::size_t>(point)])
    {
      order.emplace_back(hash, point);
    }
  }
  Repeats others(order.size());
  for (const Key& key : order)
  {
    others.See(key.first >> 32);
  }
  order.erase(std::remove_if(order.begin(), order.end(),
                [&](const Key& key) { return !others.MayBeRepeated(key.first >> 32); }),
    order.end());
  vtkSMPTools::Sort(order.begin(), order.end());
  for (std::size_t begin = 0, end; begin < order.size(); begin = end)
  {
    for (end = begin + 1; end < order.size() && order[end].first == order[begin].first;)
    {
      ++end;
    }
    if (end - begin > 1 && end - begin <= MostCopies)
    {
      for (std::size_t n = begin; n < end; ++n)
      {
        this->Points.push_back(order[n].second);
      }
      this->Starts.push_back(this->Points.size());
    }
  }
}

void CoincidentPoints::Share(
  vtkFloatArray* values, double stepsPerUnit, bool lines, double leastCosine) const
{
  const auto groups = static_cast<vtkIdType>(this->Starts.size()) - 1;
  vtkSMPTools::For(0, groups, 256,
    [&](vtkIdType begin, vtkIdType end)
    {
      std::vector<vtkIdType> left;
      std::vector<vtkIdType> joined;
      const auto valueOf = [&](vtkIdType point)
      { return Eigen::Vector3d(Eigen::Map<Eigen::Vector3f>(values->GetPointer(3 * point)).cast<double>()); };
      for (vtkIdType group = begin; group < end; ++group)
      {
        left.assign(this->Points.begin() + static_cast<std::ptrdiff_t>(this->Starts[group]),
          this->Points.begin() + static_cast<std::ptrdiff_t>(this->Starts[group + 1]));
        if (lines)
        {
          // Copies without a direction have nothing to share.
          left.erase(std::remove_if(left.begin(), left.end(),
                       [&](vtkIdType point)
                       {
                         const Eigen::Vector3d v = valueOf(point);
                         return v.isZero(0.0) || !v.allFinite();
                       }),
            left.end());
        }
        while (!left.empty())
        {
          joined.assign(1, left.back());
          left.pop_back();
          for (std::size_t n = 0; n < joined.size(); ++n)
          {
            const Eigen::Vector3d from = valueOf(joined[n]).stableNormalized();
            const auto apart = std::partition(left.begin(), left.end(),
              [&](vtkIdType point)
              {
                return lines &&
                  !(std::abs(from.dot(valueOf(point).stableNormalized())) >= leastCosine);
              });
            joined.insert(joined.end(), apart, left.end());
            left.erase(apart, left.end());
          }
          if (joined.size() < 2)
          {
            continue;
          }
          Eigen::Vector3d sum = Eigen::Vector3d::Zero();
          for (const vtkIdType point : joined)
          {
            Eigen::Vector3d steps = lines ? valueOf(point).stableNormalized() : valueOf(point);
            steps = (steps * stepsPerUnit).array().round().matrix();
            sum += lines && sum.dot(steps) < 0.0 ? Eigen::Vector3d(-steps) : steps;
          }
          const Eigen::Vector3d mean =
            sum / (stepsPerUnit * static_cast<double>(joined.size()));
          for (const vtkIdType point : joined)
          {
            Eigen::Map<Eigen::Vector3f>(values->GetPointer(3 * point)) = mean.cast<float>();
          }
        }
      }
    });
}
} // namespace noise
