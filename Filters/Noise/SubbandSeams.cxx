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
void SubbandSeams::Add(const SubbandSeams& other)
{
  this->Places.insert(this->Places.end(), other.Places.begin(), other.Places.end());
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
void SubbandSeams::Build()
{
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
  { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); };
  std::sort(this->Places.begin(), this->Places.end(), before);
  this->Places.erase(
    std::unique(this->Places.begin(), this->Places.end()), this->Places.end());
  Split(this->Places.begin(), this->Places.end(), 0);
}

//------------------------------------------------------------------------------
void SubbandSeams::Split(Iterator begin, Iterator end, int axis)
{
  if (end - begin > 1)
  {
    const Iterator middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end,
      [axis](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a[axis] < b[axis]; });
    Split(begin, middle, (axis + 1) % 3);
    Split(middle + 1, end, (axis + 1) % 3);
  }
}

//------------------------------------------------------------------------------
void SubbandSeams::Search(ConstIterator begin, ConstIterator end, int axis,
  const Eigen::Vector3d& place, double& squared)
{
  if (begin == end)
  {
    return;
  }
  const ConstIterator middle = begin + (end - begin) / 2;
  squared = std::min(squared, (*middle - place).squaredNorm());
  const double beyond = place[axis] - (*middle)[axis];
  const int next = (axis + 1) % 3;
  const bool lower = beyond < 0.0;
  lower ? Search(begin, middle, next, place, squared)
        : Search(middle + 1, end, next, place, squared);
  if (beyond * beyond <= squared)
  {
    lower ? Search(middle + 1, end, next, place, squared)
          : Search(begin, middle, next, place, squared);
  }
}

//------------------------------------------------------------------------------
double SubbandSeams::GetDistance(const Eigen::Vector3d& place, double reach) const
{
  double squared = reach * reach;
  Search(this->Places.begin(), this->Places.end(), 0, place, squared);
  return squared < reach * reach ? std::sqrt(squared) : std::numeric_limits<double>::infinity();
}
} // namespace noise
