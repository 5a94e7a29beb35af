// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandSeams.h"

#include "SubbandSurface.h"

#include "vtkMultiProcessController.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace noise
{
void SubbandSeams::Add(const SubbandSurface& surface)
{
  for (const vtkIdType point : surface.FindSeams())
  {
    if (surface.GetPoint(point).allFinite())
    {
      this->Places.push_back(surface.GetPoint(point));
    }
  }
}

//------------------------------------------------------------------------------
void SubbandSeams::Gather(vtkMultiProcessController* controller)
{
  const int ranks = controller ? controller->GetNumberOfProcesses() : 1;
  if (ranks == 1)
  {
    return;
  }
  const vtkIdType mine = 3 * static_cast<vtkIdType>(this->Places.size());
  std::vector<vtkIdType> lengths(ranks), offsets(ranks, 0);
  controller->AllGather(&mine, lengths.data(), 1);
  for (int rank = 1; rank < ranks; ++rank)
  {
    offsets[rank] = offsets[rank - 1] + lengths[rank - 1];
  }
  std::vector<double> send(mine + 1), all(offsets.back() + lengths.back() + 1);
  for (std::size_t p = 0; p < this->Places.size(); ++p)
  {
    std::copy_n(this->Places[p].data(), 3, send.begin() + 3 * p);
  }
  controller->AllGatherV(send.data(), all.data(), mine, lengths.data(), offsets.data());
  this->Places.clear();
  for (std::size_t n = 0; n + 3 < all.size(); n += 3)
  {
    this->Places.emplace_back(all[n], all[n + 1], all[n + 2]);
  }
}

//------------------------------------------------------------------------------
Eigen::Vector3d SubbandSeams::CellOf(const Eigen::Vector3d& place) const
{
  return (place / this->Reach).array().floor().matrix();
}

//------------------------------------------------------------------------------
void SubbandSeams::SetReach(double reach)
{
  this->Reach = reach;
  this->Cells.clear();
  for (const Eigen::Vector3d& place : this->Places)
  {
    this->Cells[HashPlace(this->CellOf(place))].push_back(place);
  }
}

//------------------------------------------------------------------------------
double SubbandSeams::GetDistance(const Eigen::Vector3d& place) const
{
  double nearest = std::numeric_limits<double>::infinity(); // squared
  const Eigen::Vector3d cell = this->CellOf(place);
  for (int n = 0; n < 27 && !this->Cells.empty(); ++n)
  {
    const Eigen::Vector3d there = cell + Eigen::Vector3d(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
    const auto found = this->Cells.find(HashPlace(there));
    if (found != this->Cells.end())
    {
      for (const Eigen::Vector3d& seam : found->second)
      {
        nearest = std::min(nearest, (seam - place).squaredNorm());
      }
    }
  }
  const double distance = std::sqrt(nearest);
  return distance <= this->Reach ? distance : std::numeric_limits<double>::infinity();
}
} // namespace noise
