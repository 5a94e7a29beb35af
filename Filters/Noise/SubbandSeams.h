// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Places at which noise that is looked up at texture coordinates jumps or turns back, and how far
 * points are from them (private to this module).
 */
#ifndef SubbandSeams_h
#define SubbandSeams_h

#include <Eigen/Core>

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

  void Add(const SubbandSeams& other);

  /// The places, in no order to rely on before Build().
  const std::vector<Eigen::Vector3d>& GetPlaces() const { return this->Places; }

  /// Adds those of all ranks; they do this together.
  void Gather(vtkMultiProcessController* controller);

  /// Sorts what was added, for GetDistance.
  void Build();

  /**
   * Straight distance from the nearest point of a seam, world units, infinite where that is farther
   * than `reach`. It does not depend on the order of seams. Safe to call from threads.
   */
  double GetDistance(const Eigen::Vector3d& place, double reach) const;

private:
  using Iterator = std::vector<Eigen::Vector3d>::iterator;
  using ConstIterator = std::vector<Eigen::Vector3d>::const_iterator;

  static void Split(Iterator begin, Iterator end, int axis);
  static void Search(ConstIterator begin, ConstIterator end, int axis,
    const Eigen::Vector3d& place, double& squared);

  // A k-d tree once built: the middle of a range divides the rest along an axis, the next ones the
  // halves.
  std::vector<Eigen::Vector3d> Places;
};
} // namespace noise

#endif
