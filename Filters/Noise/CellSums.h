// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What cells tell about their points, summed up (private).
 */
#ifndef CellSums_h
#define CellSums_h

#include "CellLanes.h"
#include "NoiseThreads.h"

#include "vtkDataSet.h"
#include "vtkFloatArray.h"
#include "vtkSMPTools.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace noise
{
/// For PointSums of unit vectors: a millionth, and room for two thousand that are alike.
constexpr double DirectionSteps = 1 << 20;

/// Added to a number below 2^51, leaves no room for parts of 1: rounds to the nearest in one instruction.
constexpr double LeavesWholes = 6755399441055744.0;

/// Those of a number that LeavesWholes was added to: of the nearest whole one.
inline std::int64_t LowestBits(double number)
{
  std::int64_t bits;
  std::memcpy(&bits, &number, sizeof(bits));
  return bits;
}

/**
 * Means over the cells of each point, as far as they go into 2^31 steps together. Sums are exact, so that
 * they do not depend on the order of the cells, which differs between the pieces of a dataset.
 */
class PointSums
{
public:
  /// What a cell adds to one of its points, in steps.
  struct Share
  {
    vtkIdType Point;
    std::int32_t Value[3];
  };

  /// Those of some cells, in their order.
  class Shares
  {
  public:
    void Clear() { this->Count = 0; }
    /// Room for so many more.
    Share* Extend(std::size_t more)
    {
      const std::size_t first = this->Count;
      this->Count += more;
      if (this->Count > this->Room.size())
      {
        this->Room.resize(std::max(this->Count, 2 * this->Room.size()));
      }
      return this->Room.data() + first;
    }
    const Share* begin() const { return this->Room.data(); }
    const Share* end() const { return this->Room.data() + this->Count; }

  private:
    std::vector<Share> Room;
    std::size_t Count = 0;
  };

  /// `means`: 3 components for each point of the dataset, the room in which it sums.
  PointSums(vtkDataSet* dataset, vtkFloatArray* means, double stepsPerUnit)
    : Cells(dataset->GetNumberOfCells())
    , Points(dataset->GetNumberOfPoints())
    , Means(means->GetPointer(0))
    , Sums(reinterpret_cast<std::int32_t*>(Means))
    , StepsPerUnit(stepsPerUnit)
    , Counts(new std::uint16_t[static_cast<std::size_t>(Points)])
  {
    static_assert(sizeof(float) == sizeof(std::int32_t));
  }

  /// Appends a share. A value that is not finite is none.
  void Append(Shares& shares, vtkIdType point, const Eigen::Vector3d& value) const
  {
    if (std::isfinite(value.sum() * this->StepsPerUnit))
    {
      Share* share = shares.Extend(1);
      share->Point = point;
      for (int axis = 0; axis < 3; ++axis)
      {
        share->Value[axis] = GetSteps(this->ToSteps(Lanes::Constant(value[axis]))[0]);
      }
    }
  }

  /// The same share for all.
  void Append(Shares& shares, const CellIds& points, const Eigen::Vector3d& value) const
  {
    for (const vtkIdType point : points)
    {
      this->Append(shares, point, value);
    }
  }

  /// What `values` are in steps, as AppendCorners takes it.
  LaneVector ToSteps(const LaneVector& values) const
  {
    return { this->ToSteps(values.X), this->ToSteps(values.Y), this->ToSteps(values.Z) };
  }

  /// Appends a share of each corner of a cell of a block; `alike`: the first one's.
  void AppendCorners(
    Shares& shares, const CellBlock& block, int cell, const CornerVectors& steps, bool alike) const
  {
    Share* share = shares.Extend(static_cast<std::size_t>(block.Corners));
    for (int corner = 0; corner < block.Corners; ++corner, ++share)
    {
      share->Point = block.Points[cell][corner];
      for (int axis = 0; axis < 3; ++axis)
      {
        share->Value[axis] = GetSteps(steps.Values[alike ? 0 : corner][axis][cell]);
      }
    }
  }

  /**
   * The means. `makeAsk()` makes, for one of the threads and with room of its own, the function
   * ask(begin, end, shares) that appends those of some cells. `lines`: v and -v are the same, so a sum takes
   * them to its own side, which their order decides where they are across one another.
   */
  template <class MakeAsk>
  void Sum(bool lines, MakeAsk&& makeAsk)
  {
    const auto threads =
      std::max<vtkIdType>(vtkSMPTools::GetEstimatedNumberOfThreads(), 1);
    // So many that threads are worth it, so few that their shares take little memory.
    constexpr vtkIdType chunkSize = 128;
    const vtkIdType chunksPerBatch = std::max<vtkIdType>(16, 4 * threads);
    // Threads that add: reading what others add costs more than more of them would save.
    vtkIdType adders = 1;
    while (adders < std::min<vtkIdType>(threads, 8))
    {
      adders *= 2;
    }
    // While the cells of a batch are asked, those of the one before are added and those of a third one wait.
    constexpr vtkIdType batchesAtOnce = 3;
    std::vector<Shares> chunks(static_cast<std::size_t>(batchesAtOnce * chunksPerBatch));
    const auto getShares = [&](vtkIdType batch, vtkIdType chunk) -> Shares&
    { return chunks[static_cast<std::size_t>(batch % batchesAtOnce * chunksPerBatch + chunk)]; };
    const vtkIdType blocks = (this->Points + PointsPerBlock - 1) / PointsPerBlock;
    const vtkIdType batchSize = chunkSize * chunksPerBatch;
    const vtkIdType batches = (this->Cells + batchSize - 1) / batchSize;
    // All points are cleared, batch n is asked in phase 2 n + 1 and added in 2 n + 4, sums become means in the last.
    const vtkIdType last = 2 * batches + 4;
    const auto isAsked = [&](vtkIdType phase) { return phase % 2 == 1 && phase / 2 < batches; };
    const auto isAdded = [&](vtkIdType phase)
    { return phase % 2 == 0 && phase >= 4 && phase < last; };
    RunInPhases(
      last + 1,
      [&](vtkIdType phase)
      {
        return phase == 0 || phase == last ? blocks
          : isAsked(phase)                 ? chunksPerBatch
          : isAdded(phase)                 ? adders
                                           : 0;
      },
      [&]
      {
        return [&, ask = makeAsk()](vtkIdType phase, vtkIdType job) mutable
        {
          if (phase == 0)
          {
            this->Clear(job);
          }
          else if (phase == last)
          {
            this->Finish(job);
          }
          else if (isAsked(phase))
          {
            const vtkIdType batch = phase / 2;
            const vtkIdType begin = batch * batchSize + job * chunkSize;
            Shares& shares = getShares(batch, job);
            shares.Clear();
            if (begin < this->Cells)
            {
              ask(begin, std::min(this->Cells, begin + chunkSize), shares);
            }
          }
          else
          {
            // Each adder reads all shares, in the order of the cells, and adds those of its own points.
            for (vtkIdType chunk = 0; chunk < chunksPerBatch; ++chunk)
            {
              const Shares& shares = getShares(phase / 2 - 2, chunk);
              lines ? this->Add<true>(shares, adders, job) : this->Add<false>(shares, adders, job);
            }
          }
        };
      });
  }

private:
  Lanes ToSteps(const Lanes& values) const
  {
    constexpr double most = INT32_MAX;
    return (values * this->StepsPerUnit).max(-most).min(most) + LeavesWholes;
  }
  static std::int32_t GetSteps(double steps) { return static_cast<std::int32_t>(LowestBits(steps)); }

  /// Of points that are cleared and finished together.
  static constexpr vtkIdType PointsPerBlock = 16384;
  /// The points of an adder: blocks of so many in turn, since those of a batch are often close by.
  static constexpr int BitsOfTurn = 8;

  template <class Visit>
  void ForEach(vtkIdType block, Visit&& visit)
  {
    const vtkIdType end = std::min(this->Points, (block + 1) * PointsPerBlock);
    for (vtkIdType point = block * PointsPerBlock; point < end; ++point)
    {
      visit(point);
    }
  }

  void Clear(vtkIdType block)
  {
    this->ForEach(block,
      [this](vtkIdType point)
      {
        std::fill_n(this->Sums + 3 * point, 3, 0);
        this->Counts[static_cast<std::size_t>(point)] = 0;
      });
  }

  /// Sums become means.
  void Finish(vtkIdType block)
  {
    this->ForEach(block,
      [this](vtkIdType point)
      {
        const double count = std::max<double>(1.0, this->Counts[static_cast<std::size_t>(point)]);
        const double unit = 1.0 / (count * this->StepsPerUnit);
        for (vtkIdType i = 3 * point; i < 3 * point + 3; ++i)
        {
          const std::int32_t sum = this->Sums[i];
          this->Means[i] = static_cast<float>(sum * unit);
        }
      });
  }

  template <bool Lines>
  void Add(const Shares& shares, vtkIdType adders, vtkIdType adder)
  {
    for (const Share& share : shares)
    {
      if (((share.Point >> BitsOfTurn) & (adders - 1)) == adder)
      {
        this->Add<Lines>(share);
      }
    }
  }

  template <bool Lines>
  void Add(const Share& share)
  {
    std::int32_t* sum = this->Sums + 3 * share.Point;
    std::uint16_t& count = this->Counts[static_cast<std::size_t>(share.Point)];
    if (count == UINT16_MAX)
    {
      return; // so many cells tell enough
    }
    const auto product = [&](int axis)
    { return static_cast<double>(sum[axis]) * static_cast<double>(share.Value[axis]); };
    const bool turn = Lines && product(0) + product(1) + product(2) < 0.0;
    std::int64_t totals[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t value = share.Value[axis];
      totals[axis] = sum[axis] + (turn ? -value : value);
    }
    const auto fits = [&](int axis) { return std::abs(totals[axis]) <= INT32_MAX; };
    if (fits(0) && fits(1) && fits(2)) // else the mean of those before is kept
    {
      std::copy(totals, totals + 3, sum);
      ++count;
    }
  }

  vtkIdType Cells;
  vtkIdType Points;
  float* Means;
  std::int32_t* Sums;
  double StepsPerUnit;
  std::unique_ptr<std::uint16_t[]> Counts;
};
} // namespace noise

#endif
