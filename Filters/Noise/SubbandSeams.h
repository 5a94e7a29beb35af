// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Places at which noise that is looked up at texture coordinates jumps or turns back, and how far points
 * are from them (private to this module).
 */
#ifndef SubbandSeams_h
#define SubbandSeams_h

#include <Eigen/Core>

#include <cstdint>
#include <unordered_map>
#include <vector>

class vtkMultiProcessController;

namespace noise
{
class SubbandSurface;

class SubbandSeams
{
public:
  /// Adds the points of a surface that lie on its seams.
  void Add(const SubbandSurface& surface);

  /// Adds those of all ranks; they do this together.
  void Gather(vtkMultiProcessController* controller);

  /// Prepares GetDistance up to `reach`, world units.
  void SetReach(double reach);

  /**
   * Straight distance from the nearest point of a seam, world units, infinite where that is farther
   * than the reach. It does not depend on the order of seams. Safe to call from threads.
   */
  double GetDistance(const Eigen::Vector3d& place) const;

private:
  Eigen::Vector3d CellOf(const Eigen::Vector3d& place) const;

  std::vector<Eigen::Vector3d> Places;
  double Reach = 0.0;
  std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3d>> Cells; // with sides of the reach
};
} // namespace noise

#endif
