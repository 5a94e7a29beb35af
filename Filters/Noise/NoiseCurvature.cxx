// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseCurvature.h"

#include "CellSums.h"
#include "DatasetCells.h"
#include "NoiseCopies.h"
#include "NoiseThreads.h"
#include "PointPlaces.h"

#include "vtkSMPTools.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace noise
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Points of a cell with the directions there, all on one side, and room for them.
struct CellPoints
{
  std::vector<vtkIdType> Ids;
  std::vector<Vector3d> Places;
  std::vector<Vector3d> Directions;

  void Resize(std::size_t count)
  {
    this->Ids.resize(count);
    this->Places.resize(count);
    this->Directions.resize(count);
  }
};

/// Unit vector, or 0 if there is none.
Vector3d GetDirection(const steerable::TupleReader<float>& vectors, vtkIdType sample)
{
  float scratch[3];
  const float* vector = vectors.Read(static_cast<std::size_t>(sample), 1, scratch);
  const Vector3d v = Eigen::Map<const Eigen::Vector3f>(vector).cast<double>();
  const double length = v.norm();
  return std::isfinite(length) && length > 0.0 ? Vector3d(v * (1.0 / length)) : Vector3d::Zero();
}

/// The matrix J that fits du ≈ J dx best, in directions in which there are dx.
class GradientFit
{
public:
  void Add(const Vector3d& dx, const Vector3d& du)
  {
    this->Squares += dx * dx.transpose();
    this->Products += du * dx.transpose();
  }

  /// `dimension`: the dx are in a space of so many.
  Matrix3d Solve(int dimension)
  {
    // A millionth of the longest is still a dx.
    constexpr double thinnest = 1e-12;
    const double size = this->Squares.trace() / 3.0;
    if (!(size > 0.0) || !std::isfinite(size))
    {
      return Matrix3d::Zero();
    }
    const Matrix3d squares = this->Squares / size;
    const Matrix3d products = this->Products / size;
    if (dimension == 3)
    {
      Matrix3d inverse;
      bool invertible;
      squares.computeInverseWithCheck(inverse, invertible, 1e-6);
      if (invertible)
      {
        return products * inverse;
      }
    }
    if (dimension == 2)
    {
      // The adjugate of what is nearly a plane has its normal in all columns, and its square even more so.
      Matrix3d adjugate;
      for (int axis = 0; axis < 3; ++axis)
      {
        adjugate.col(axis) = squares.col((axis + 1) % 3).cross(squares.col((axis + 2) % 3));
      }
      if (adjugate.trace() > 1e-9)
      {
        int largest;
        adjugate.diagonal().maxCoeff(&largest);
        const Vector3d normal = (adjugate * adjugate.col(largest)).normalized();
        const Matrix3d across = normal * normal.transpose();
        const Matrix3d inPlane = Matrix3d::Identity() - across;
        const Matrix3d inverse = (inPlane * squares * inPlane + across).inverse();
        return products * inPlane * inverse;
      }
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(squares);
    Matrix3d gradient = Matrix3d::Zero();
    for (int axis = 3 - dimension; axis < 3; ++axis)
    {
      const double extent = solver.eigenvalues()[axis];
      if (extent > thinnest)
      {
        const Vector3d direction = solver.eigenvectors().col(axis);
        gradient += products * direction * direction.transpose() / extent;
      }
    }
    return gradient;
  }

private:
  Matrix3d Squares = Matrix3d::Zero();
  Matrix3d Products = Matrix3d::Zero();
};

/// Differences of place and direction between the two ends of a cell along each of its axes.
struct CellAxes
{
  Vector3d Places[3];
  Vector3d Directions[3];
};

/**
 * Of `count` points of a cell of this type from `first` on: from one corner of a simplex to the others; of a quadrangle and a
 * hexahedron the means of the sides along each axis, which with parallel sides is what fits them best. False for others.
 */
bool GetAxes(const CellPoints& cell, std::size_t first, std::size_t count, int type, int dimension,
  CellAxes& axes)
{
  const auto set = [&](auto&& difference)
  {
    difference(cell.Places.data() + first, axes.Places);
    difference(cell.Directions.data() + first, axes.Directions);
    return true;
  };
  if (dimension > 1 && count == static_cast<std::size_t>(dimension) + 1)
  {
    return set(
      [&](const Vector3d* at, Vector3d* axis)
      {
        for (int i = 0; i < dimension; ++i)
        {
          axis[i] = at[i + 1] - at[0];
        }
      });
  }
  // The corners of pixels and voxels are in the order of an image, those of others go round.
  const bool image = type == VTK_PIXEL || type == VTK_VOXEL;
  if ((type == VTK_QUAD || type == VTK_PIXEL) && count == 4)
  {
    return set(
      [&](const Vector3d* at, Vector3d* axis)
      {
        const Vector3d diagonals[2] = { at[2 + image] - at[0], at[1] - at[3 - image] };
        axis[0] = 0.5 * (diagonals[0] + diagonals[1]);
        axis[1] = 0.5 * (diagonals[0] - diagonals[1]);
      });
  }
  if ((type == VTK_HEXAHEDRON || type == VTK_VOXEL) && count == 8)
  {
    return set(
      [&](const Vector3d* at, Vector3d* axis)
      {
        const Vector3d diagonals[4] = { at[6 + image] - at[0], at[7 - image] - at[1],
          at[5] - at[3 - image], at[4] - at[2 + image] };
        const Vector3d even = diagonals[0] - diagonals[3];
        const Vector3d odd = diagonals[2] - diagonals[1];
        axis[0] = 0.25 * (even + odd);
        axis[1] = 0.25 * (even - odd);
        axis[2] = 0.25 * (diagonals[0] + diagonals[1] + diagonals[2] + diagonals[3]);
      });
  }
  return false;
}

/// The gradient that has these differences. False where they are too close to a line or a plane.
bool GetGradientOfAxes(const CellAxes& axes, int dimension, Matrix3d& gradient)
{
  // As GradientFit: a millionth of the longest is still a distance.
  constexpr double thinnest = 1e-12;
  const auto& [a, b, c] = axes.Places;
  const auto& [du, dv, dw] = axes.Directions;
  const Vector3d normal = a.cross(b);
  if (dimension == 2)
  {
    const double squared = normal.squaredNorm();
    const double longest = std::max(a.squaredNorm(), b.squaredNorm());
    if (!(squared > thinnest * longest * longest) || !std::isfinite(squared))
    {
      return false;
    }
    // The gradients of the two coordinates that go from 0 to 1 along one axis.
    gradient = (du * b.cross(normal).transpose() + dv * normal.cross(a).transpose()) / squared;
    return true;
  }
  const double volume = normal.dot(c);
  const double longest = std::max({ a.squaredNorm(), b.squaredNorm(), c.squaredNorm() });
  if (!(volume * volume > thinnest * longest * longest * longest) || !std::isfinite(volume * volume))
  {
    return false;
  }
  gradient = (du * b.cross(c).transpose() + dv * c.cross(a).transpose() + dw * normal.transpose()) / volume;
  return true;
}

/// Gradient of the points [first, first + count) of a cell of this type.
Matrix3d GetGradient(
  const CellPoints& cell, std::size_t first, std::size_t count, int type, int dimension)
{
  CellAxes axes;
  Matrix3d gradient;
  if (GetAxes(cell, first, count, type, dimension, axes) && GetGradientOfAxes(axes, dimension, gradient))
  {
    return gradient;
  }
  Vector3d meanPlace = Vector3d::Zero();
  Vector3d meanDirection = Vector3d::Zero();
  for (std::size_t i = first; i < first + count; ++i)
  {
    meanPlace += cell.Places[i];
    meanDirection += cell.Directions[i];
  }
  meanPlace /= static_cast<double>(count);
  meanDirection /= static_cast<double>(count);
  GradientFit fit;
  for (std::size_t i = first; i < first + count; ++i)
  {
    fit.Add(cell.Places[i] - meanPlace, cell.Directions[i] - meanDirection);
  }
  return fit.Solve(dimension);
}

/// A strip is as many triangles, a line as many segments, as follow one another: their points; else 0.
std::size_t GetPartSize(int cellType)
{
  return cellType == VTK_TRIANGLE_STRIP ? 3 : cellType == VTK_POLY_LINE ? 2 : 0;
}

/**
 * Sets the points of a cell and the directions there, on the side of `side` or, if that is 0, of the
 * first; `getDirection(point)` gives 0 where there is none. Such points are left out, or `keepAll`.
 */
template <class Get>
void SetPoints(const CellIds& ids, const PointPlaces& places, Vector3d side, bool keepAll,
  CellPoints& cell, Get&& getDirection)
{
  const auto size = static_cast<std::size_t>(ids.size());
  cell.Resize(size);
  std::size_t count = 0;
  for (const vtkIdType point : ids)
  {
    Vector3d u = getDirection(point);
    const Vector3d place = places(point);
    // What is no place, or no direction, which are unit vectors, in the fewest steps.
    if (!(u.squaredNorm() > 0.0) || !std::isfinite(place.sum()))
    {
      if (!keepAll)
      {
        continue;
      }
      u.setZero();
    }
    side = side.squaredNorm() > 0.0 ? side : u;
    cell.Ids[count] = point;
    cell.Places[count] = place;
    cell.Directions[count] = u.dot(side) < 0.0 ? Vector3d(-u) : u;
    ++count;
  }
  cell.Resize(count);
}

/// Of points, from the cells around them.
vtkSmartPointer<vtkFloatArray> CurvatureOfPoints(
  vtkDataSet* dataset, const steerable::TupleReader<float>& vectors, const HiddenSamples& hidden,
  const CoincidentPoints& copies, double cellSize)
{
  const DatasetCells cells(dataset);
  const PointPlaces places(dataset);
  auto curvature = NewOutputArray("Curvature", 3, dataset->GetNumberOfPoints());
  // The noise takes bends up to 1 / cellSize: room for 127 cells of such, and finer than it sees.
  PointSums sums(dataset, curvature, cellSize * (1 << 24));
  sums.AddCells(false,
    [&]
    {
      return [&, read = DatasetCells::Reader(cells), cell = CellPoints()](
               vtkIdType id, PointSums::Shares& shares) mutable
      {
        const int type = cells.GetType(id);
        const int dimension = cells.GetDimension(type);
        if (dimension == 0 || hidden.HasCell(id))
        {
          return;
        }
        const std::size_t part = GetPartSize(type);
        SetPoints(read(id), places, Vector3d::Zero(), part > 0, cell,
          [&](vtkIdType point) { return GetDirection(vectors, point); });
        const std::size_t size = part > 0 ? part : std::max<std::size_t>(cell.Ids.size(), 2);
        for (std::size_t first = 0; first + size <= cell.Ids.size(); ++first)
        {
          const auto begin = cell.Directions.begin() + static_cast<std::ptrdiff_t>(first);
          if (part > 0 &&
            std::any_of(begin, begin + static_cast<std::ptrdiff_t>(size),
              [](const Vector3d& u) { return u.isZero(0.0); }))
          {
            continue;
          }
          const Matrix3d gradient = GetGradient(cell, first, size, type, dimension);
          for (std::size_t i = first; i < first + size; ++i)
          {
            sums.Append(shares, cell.Ids[i], gradient * cell.Directions[i]);
          }
        }
      };
    });
  sums.Finish();
  copies.Share(curvature, cellSize * (1 << 24), false, 0.0);
  return curvature;
}

/// Of cells, whose directions go to their points first.
vtkSmartPointer<vtkFloatArray> CurvatureOfCells(
  vtkDataSet* dataset, const steerable::TupleReader<float>& vectors, const HiddenSamples& hidden,
  const CoincidentPoints& copies)
{
  const DatasetCells cells(dataset);
  const PointPlaces places(dataset);
  auto points = NewOutputArray("Directions", 3, dataset->GetNumberOfPoints());
  PointSums sums(dataset, points, DirectionSteps);
  sums.AddCells(true,
    [&]
    {
      return [&, read = DatasetCells::Reader(cells)](vtkIdType id, PointSums::Shares& shares) mutable
      {
        const Vector3d u = GetDirection(vectors, id);
        if (!u.isZero(0.0))
        {
          for (const vtkIdType point : read(id))
          {
            sums.Append(shares, point, u);
          }
        }
      };
    });
  sums.Finish();
  copies.Share(points, DirectionSteps, true, 0.0);
  auto curvature = NewOutputArray("Curvature", 3, dataset->GetNumberOfCells());
  vtkSMPTools::For(0, dataset->GetNumberOfCells(), 1024,
    [&](vtkIdType begin, vtkIdType end)
    {
      DatasetCells::Reader read(cells);
      CellPoints cell;
      for (vtkIdType id = begin; id < end; ++id)
      {
        const Vector3d u = GetDirection(vectors, id);
        Vector3d result = Vector3d::Zero();
        if (!u.isZero(0.0))
        {
          SetPoints(read(id), places, u, false, cell,
            [&](vtkIdType point) -> Vector3d {
              return Eigen::Map<const Eigen::Vector3f>(points->GetPointer(3 * point))
                .cast<double>();
            });
          const int type = cells.GetType(id);
          result = GetGradient(cell, 0, cell.Ids.size(), type, cells.GetDimension(type)) * u;
        }
        Eigen::Map<Eigen::Vector3f>(curvature->GetPointer(3 * id)) = result.cast<float>();
      }
    });
  return curvature;
}
} // namespace

bool AreSamePlaces(const Eigen::Vector3d& a, const Eigen::Vector3d& b)
{
  return (a - b).norm() <= 1e-6 * std::min(a.norm(), b.norm());
}

vtkSmartPointer<vtkFloatArray> ComputeStreamlineCurvature(
  vtkDataSet* dataset, const steerable::TupleReader<float>& vectors, bool cells,
  const HiddenSamples& hidden, const CoincidentPoints& copies, double cellSize)
{
  return cells ? CurvatureOfCells(dataset, vectors, hidden, copies)
               : CurvatureOfPoints(dataset, vectors, hidden, copies, cellSize);
}

vtkSmartPointer<vtkFloatArray> ComputeStreamlineCurvature(const int (&dimensions)[3],
  const steerable::TupleReader<double>& positions, const steerable::TupleReader<float>& vectors,
  const std::vector<unsigned char>& hidden,
  const std::function<bool(int axis, vtkIdType sample)>& cellsMeet)
{
  const auto isThere = [&](vtkIdType sample) { return hidden.empty() || !hidden[sample]; };
  const vtkIdType strides[3] = { 1, dimensions[0],
    static_cast<vtkIdType>(dimensions[0]) * dimensions[1] };
  const vtkIdType count = strides[2] * dimensions[2];
  const auto axes = static_cast<int>(
    std::count_if(dimensions, dimensions + 3, [](int samples) { return samples > 1; }));
  auto curvature = NewOutputArray("Curvature", 3, count);
  const auto meet = [&](vtkIdType first, vtkIdType last)
  {
    double scratch[6];
    const Vector3d a = Eigen::Map<const Vector3d>(
      positions.Read(static_cast<std::size_t>(first), 1, scratch));
    const Vector3d b = Eigen::Map<const Vector3d>(
      positions.Read(static_cast<std::size_t>(last), 1, scratch + 3));
    return AreSamePlaces(a, b);
  };
  vtkSMPTools::For(0, count, 1024,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType i = begin; i < end; ++i)
      {
        const Vector3d u = GetDirection(vectors, i);
        const auto getDifferences = [&](vtkIdType before, vtkIdType after, GradientFit& fit)
        {
          double scratch[3];
          const auto read = [&](vtkIdType sample, Vector3d& place)
          {
            place = Eigen::Map<const Vector3d>(
              positions.Read(static_cast<std::size_t>(sample), 1, scratch));
            // As on images, a neighbour without a direction stands for no change.
            const Vector3d direction = GetDirection(vectors, sample);
            return direction.isZero(0.0)
              ? u
              : Vector3d(direction.dot(u) < 0.0 ? -direction : direction);
          };
          Vector3d low;
          Vector3d high;
          const Vector3d from = read(before, low);
          const Vector3d to = read(after, high);
          const Vector3d dx = high - low;
          if (dx.allFinite())
          {
            fit.Add(dx, to - from);
          }
        };
        GradientFit fit;
        for (int axis = 0; axis < 3 && !u.isZero(0.0); ++axis)
        {
          const vtkIdType index = i / strides[axis] % dimensions[axis];
          const vtkIdType before = index > 0 && isThere(i - strides[axis]) ? i - strides[axis] : i;
          const vtkIdType after =
            index + 1 < dimensions[axis] && isThere(i + strides[axis]) ? i + strides[axis] : i;
          const vtkIdType first = i - index * strides[axis];
          const vtkIdType last = first + (dimensions[axis] - 1) * strides[axis];
          const bool ends = index == 0 || index + 1 == dimensions[axis];
          if (cellsMeet)
          {
            if (ends && dimensions[axis] > 2 && isThere(first) && isThere(last) &&
              cellsMeet(axis, first))
            {
              const vtkIdType back = index == 0 ? last : before;
              getDifferences(back, index == 0 ? after : first, fit);
            }
            else if (before < after)
            {
              getDifferences(before, after, fit);
            }
          }
          else if (ends && dimensions[axis] > 3 && isThere(first) && isThere(last) &&
            isThere(first + strides[axis]) && isThere(last - strides[axis]) && meet(first, last))
          {
            getDifferences(last - strides[axis], first + strides[axis], fit);
          }
          else if (before < after)
          {
            getDifferences(before, after, fit);
          }
        }
        Eigen::Map<Eigen::Vector3f>(curvature->GetPointer(3 * i)) =
          (fit.Solve(axes) * u).cast<float>();
      }
    });
  return curvature;
}
} // namespace noise
