// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What cells tell about their points, summed up (private).
 */
#ifndef CellSums_h
#define CellSums_h

#include "vtkDataSet.h"
#include "vtkFloatArray.h"
#include "vtkSMPTools.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace noise
{
/// For PointSums of unit vectors: a millionth, and room for two thousand that are alike.
constexpr double DirectionSteps = 1 << 20;

/// Added to a number below 2^51, leaves no room for parts of 1: rounds to the nearest in one instruction.
constexpr double LeavesWholes = 6755399441055744.0;

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
    Eigen::Vector3i Value;
  };
  using Shares = std::vector<Share>;

  /// `means`: 3 components for each point of the dataset, the room in which it sums.
  PointSums(vtkDataSet* dataset, vtkFloatArray* means, double stepsPerUnit)
    : DataSet(dataset)
    , Means(means->GetPointer(0))
    , Sums(reinterpret_cast<std::int32_t*>(Means))
    , StepsPerUnit(stepsPerUnit)
    , Counts(dataset->GetNumberOfPoints(), 0)
  {
    static_assert(sizeof(float) == sizeof(std::int32_t));
    std::fill_n(this->Sums, 3 * this->Counts.size(), 0);
  }

  /// Appends a share. A value that is not finite is none.
  void Append(Shares& shares, vtkIdType point, const Eigen::Vector3d& value) const
  {
    constexpr double most = INT32_MAX;
    const Eigen::Array3d steps = value.array() * this->StepsPerUnit;
    if (std::isfinite(steps.sum()))
    {
      const Eigen::Array3d whole = (steps.max(-most).min(most) + LeavesWholes) - LeavesWholes;
      shares.push_back({ point, whole.matrix().cast<int>() });
    }
  }

  /**
   * `makeGetShares()` makes, for one of the threads and with room of its own, the function
   * getShares(cell, shares) that appends those of a cell. `lines`: v and -v are the same, so a sum takes
   * them to its own side, which their order decides where they are across one another.
   */
  template <class MakeGetShares>
  void AddCells(bool lines, MakeGetShares&& makeGetShares)
  {
    // So many that threads are worth it, so few that their shares take little memory.
    constexpr vtkIdType chunkSize = 128;
    constexpr vtkIdType chunksPerBatch = 64;
    const vtkIdType cells = this->DataSet->GetNumberOfCells();
    const auto points = static_cast<vtkIdType>(this->Counts.size());
    const vtkIdType threads =
      std::clamp(vtkSMPTools::GetEstimatedNumberOfThreads(), 1, mostThreadsThatAdd);
    std::vector<Shares> chunks(chunksPerBatch);
    for (vtkIdType first = 0; first < cells; first += chunkSize * chunksPerBatch)
    {
      const vtkIdType end = std::min(cells, first + chunkSize * chunksPerBatch);
      const vtkIdType used = (end - first + chunkSize - 1) / chunkSize;
      vtkSMPTools::For(0, used, 1,
        [&](vtkIdType begin, vtkIdType stop)
        {
          auto getShares = makeGetShares();
          for (vtkIdType chunk = begin; chunk < stop; ++chunk)
          {
            chunks[chunk].clear();
            const vtkIdType last = std::min(end, first + (chunk + 1) * chunkSize);
            for (vtkIdType cell = first + chunk * chunkSize; cell < last; ++cell)
            {
              getShares(cell, chunks[chunk]);
            }
          }
        });
      // Each thread reads all shares, in the order of the cells, and adds those of its own points.
      vtkSMPTools::For(0, threads, 1,
        [&](vtkIdType begin, vtkIdType stop)
        {
          const vtkIdType from = points * begin / threads;
          const vtkIdType to = points * stop / threads;
          for (vtkIdType chunk = 0; chunk < used; ++chunk)
          {
            for (const Share& share : chunks[chunk])
            {
              if (share.Point >= from && share.Point < to)
              {
                this->Add(share, lines);
              }
            }
          }
        });
    }
  }

  /// Sums become means.
  void Finish()
  {
    vtkSMPTools::For(0, static_cast<vtkIdType>(this->Counts.size()), 16384,
      [this](vtkIdType begin, vtkIdType end)
      {
        for (vtkIdType point = begin; point < end; ++point)
        {
          const double count = std::max<double>(1.0, this->Counts[point]);
          const double unit = 1.0 / (count * this->StepsPerUnit);
          for (vtkIdType i = 3 * point; i < 3 * point + 3; ++i)
          {
            const std::int32_t sum = this->Sums[i];
            this->Means[i] = static_cast<float>(sum * unit);
          }
        }
      });
  }

private:
  /// Reading what others add costs more than it saves then.
  static constexpr int mostThreadsThatAdd = 8;

  void Add(const Share& share, bool lines)
  {
    Eigen::Map<Eigen::Vector3i> sum(this->Sums + 3 * share.Point);
    std::uint16_t& count = this->Counts[share.Point];
    if (count == UINT16_MAX)
    {
      return; // so many cells tell enough
    }
    const bool turn = lines && sum.cast<double>().dot(share.Value.cast<double>()) < 0.0;
    std::int64_t total[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t value = share.Value[axis];
      total[axis] = sum[axis] + (turn ? -value : value);
      if (std::abs(total[axis]) > INT32_MAX)
      {
        return; // the mean of those before is kept
      }
    }
    std::copy(total, total + 3, sum.data());
    ++count;
  }

  vtkDataSet* DataSet;
  float* Means;
  std::int32_t* Sums;
  double StepsPerUnit;
  std::vector<std::uint16_t> Counts;
};
} // namespace noise

#endif
