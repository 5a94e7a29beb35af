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

/// Vectors of samples, where it can be without a virtual call for each.
class VectorPlaces
{
public:
  explicit VectorPlaces(const steerable::TupleReader<float>& reader)
    : Reader(reader)
  {
    if (dynamic_cast<const steerable::ContiguousReader<float, 3>*>(&reader))
    {
      this->Floats = reader.Read(0, 0, nullptr);
    }
  }

  Vector3d operator()(vtkIdType sample) const
  {
    float scratch[3];
    const float* vector = this->Floats ? this->Floats + 3 * sample
                                       : this->Reader.Read(static_cast<std::size_t>(sample), 1, scratch);
    return Eigen::Map<const Eigen::Vector3f>(vector).cast<double>();
  }

private:
  const steerable::TupleReader<float>& Reader;
  const float* Floats = nullptr;
};

/// Unit vector, or 0 if there is none.
Vector3d GetDirection(const Vector3d& v)
{
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

/// Gradient of the points [first, first + count) of a cell of this dimension.
Matrix3d GetGradient(
  const CellPoints& cell, std::size_t first, std::size_t count, int dimension)
{
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

/// Cells side by side, with the directions at their corners and the gradients of these.
struct GradientBlock : CellBlock
{
  CornerVectors Directions;
  /// Of some cells: the axes of the direction, each a vector.
  LaneVector Gradients[CornerVectors::MostCells / LaneCount][3];
  /// Not where corners lack a place or a direction, nor where cells are too close to a line or a plane.
  bool HasGradient[CornerVectors::MostCells];

  /**
   * Vectors at corners become those on the side of the first of `sides`, and their gradients are found; `unit`: they
   * become as long as 1. A cell with one of length 0 has no gradient.
   */
  void FindGradients(const CornerVectors& sides, bool unit)
  {
    for (int cell = 0; cell < this->Count; cell += LaneCount)
    {
      for (int corner = 0; corner < this->Corners; ++corner)
      {
        const LaneVector v = this->Directions.GetLanes(corner, cell);
        const Lanes squared = v.Dot(v);
        const Lanes scale = unit ? Lanes(squared.sqrt().inverse()) : Lanes(squared / squared);
        const Lanes cosine = v.Dot(sides.GetLanes(0, cell));
        this->Directions.SetLanes(corner, cell, v * (cosine < 0.0).select(-scale, scale));
      }
      LaneVector along[3];
      LaneVector changes[3];
      this->GetAxes(this->Places, cell, along);
      this->GetAxes(this->Directions, cell, changes);
      this->SetGradients(cell, along, changes);
    }
  }

  /// The change along `u`, of these cells.
  LaneVector Along(const LaneVector& u, int cell) const
  {
    const LaneVector(&gradient)[3] = this->Gradients[cell / LaneCount];
    return { gradient[0].Dot(u), gradient[1].Dot(u), gradient[2].Dot(u) };
  }

private:
  /// The gradient that has these differences along the axes of cells.
  void SetGradients(int cell, const LaneVector (&along)[3], const LaneVector (&changes)[3])
  {
    // As GradientFit: a millionth of the longest is still a distance.
    constexpr double thinnest = 1e-12;
    const auto& [a, b, c] = along;
    const LaneVector normal = a.Cross(b);
    // The gradients of the coordinates that go from 0 to 1 along one axis.
    LaneVector slopes[3];
    Lanes thickness;
    Lanes longest = a.Dot(a).max(b.Dot(b));
    if (this->Dimension == 2)
    {
      const Lanes squared = normal.Dot(normal);
      const Lanes scale = squared.inverse();
      slopes[0] = b.Cross(normal) * scale;
      slopes[1] = normal.Cross(a) * scale;
      thickness = squared;
      longest = longest * longest;
    }
    else
    {
      const Lanes volume = normal.Dot(c);
      const Lanes scale = volume.inverse();
      slopes[0] = b.Cross(c) * scale;
      slopes[1] = c.Cross(a) * scale;
      slopes[2] = normal * scale;
      thickness = volume * volume;
      longest = longest.max(c.Dot(c));
      longest = longest * longest * longest;
    }
    LaneVector(&gradient)[3] = this->Gradients[cell / LaneCount];
    const auto set = [&](LaneVector& row, auto&& of)
    {
      row = slopes[0] * of(changes[0]) + slopes[1] * of(changes[1]);
      row = this->Dimension == 2 ? row : row + slopes[2] * of(changes[2]);
    };
    set(gradient[0], [](const LaneVector& change) { return change.X; });
    set(gradient[1], [](const LaneVector& change) { return change.Y; });
    set(gradient[2], [](const LaneVector& change) { return change.Z; });
    const LaneVector sum = gradient[0] + gradient[1] + gradient[2];
    const Lanes finite = sum.X + sum.Y + sum.Z + thickness;
    for (int lane = 0; lane < LaneCount; ++lane)
    {
      this->HasGradient[cell + lane] =
        thickness[lane] > thinnest * longest[lane] && std::isfinite(finite[lane]);
    }
  }
};

/// What cells tell about the curvature at their points; one for each thread.
class CurvatureShares
{
public:
  CurvatureShares(const DatasetCells& cells, const PointPlaces& placeOf, const VectorPlaces& vectorOf,
    const HiddenSamples& hidden, const PointSums& sums)
    : Cells(cells)
    , Read(cells)
    , PlaceOf(placeOf)
    , VectorOf(vectorOf)
    , Hidden(hidden)
    , Sums(sums)
  {
  }

  void operator()(vtkIdType begin, vtkIdType end, PointSums::Shares& shares)
  {
    VisitCells(
      this->Cells, this->Read, begin, end, 1, true, this->Block, this->PlaceOf,
      [this](vtkIdType cell, int type)
      { return this->Cells.GetDimension(type) > 0 && !this->Hidden.HasCell(cell); },
      [this](int index, const CellIds& ids)
      {
        for (int corner = 0; corner < this->Block.Corners; ++corner)
        {
          this->Block.Directions.Set(corner, index, this->VectorOf(ids[corner]));
        }
      },
      [&] { this->AppendBlock(shares); },
      [&](vtkIdType, int type, const CellIds& ids) { this->AppendCell(ids, type, shares); });
  }

private:
  void AppendBlock(PointSums::Shares& shares)
  {
    GradientBlock& block = this->Block;
    block.FindGradients(block.Directions, true);
    for (int cell = 0; cell < block.Count; cell += LaneCount)
    {
      for (int corner = 0; corner < block.Corners; ++corner)
      {
        const LaneVector u = block.Directions.GetLanes(corner, cell);
        this->Steps.SetLanes(corner, cell, this->Sums.ToSteps(block.Along(u, cell)));
      }
    }
    for (int cell = 0; cell < block.Count; ++cell)
    {
      if (block.HasGradient[cell])
      {
        this->Sums.AppendCorners(shares, block, cell, this->Steps, false);
      }
      else
      {
        this->AppendCell(block.GetIds(cell), block.Type, shares);
      }
    }
  }

  void AppendCell(const CellIds& ids, int type, PointSums::Shares& shares)
  {
    const std::size_t part = GetPartSize(type);
    CellPoints& cell = this->Cell;
    SetPoints(ids, this->PlaceOf, Vector3d::Zero(), part > 0, cell,
      [&](vtkIdType point) { return GetDirection(this->VectorOf(point)); });
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
      const Matrix3d gradient = GetGradient(cell, first, size, this->Cells.GetDimension(type));
      for (std::size_t i = first; i < first + size; ++i)
      {
        this->Sums.Append(shares, cell.Ids[i], gradient * cell.Directions[i]);
      }
    }
  }

  const DatasetCells& Cells;
  DatasetCells::Reader Read;
  const PointPlaces& PlaceOf;
  const VectorPlaces& VectorOf;
  const HiddenSamples& Hidden;
  const PointSums& Sums;
  GradientBlock Block;
  CornerVectors Steps;
  CellPoints Cell;
};

/// Of points, from the cells around them.
vtkSmartPointer<vtkFloatArray> CurvatureOfPoints(
  vtkDataSet* dataset, const steerable::TupleReader<float>& vectors, const HiddenSamples& hidden,
  const CoincidentPoints& copies, double cellSize)
{
  const DatasetCells cells(dataset);
  const PointPlaces places(dataset);
  const VectorPlaces vectorOf(vectors);
  auto curvature = NewOutputArray("Curvature", 3, dataset->GetNumberOfPoints());
  // The noise takes bends up to 1 / cellSize: room for 127 cells of such, and finer than it sees.
  PointSums sums(dataset, curvature, cellSize * (1 << 24));
  sums.Sum(false, [&] { return CurvatureShares(cells, places, vectorOf, hidden, sums); });
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
  const VectorPlaces vectorOf(vectors);
  auto points = NewOutputArray("Directions", 3, dataset->GetNumberOfPoints());
  PointSums sums(dataset, points, DirectionSteps);
  sums.Sum(true,
    [&]
    {
      return [&, read = DatasetCells::Reader(cells)](
               vtkIdType begin, vtkIdType end, PointSums::Shares& shares) mutable
      {
        for (vtkIdType id = begin; id < end; ++id)
        {
          const Vector3d u = GetDirection(vectorOf(id));
          if (!u.isZero(0.0))
          {
            sums.Append(shares, read(id), u);
          }
        }
      };
    });
  copies.Share(points, DirectionSteps, true, 0.0);
  auto curvature = NewOutputArray("Curvature", 3, dataset->GetNumberOfCells());
  const auto directionOf = [&](vtkIdType point) -> Vector3d
  { return Eigen::Map<const Eigen::Vector3f>(points->GetPointer(3 * point)).cast<double>(); };
  vtkSMPTools::For(0, dataset->GetNumberOfCells(), 1024,
    [&](vtkIdType begin, vtkIdType end)
    {
      DatasetCells::Reader read(cells);
      GradientBlock block;
      CornerVectors own;
      CornerVectors results;
      CellPoints corners;
      const auto set = [&](vtkIdType cell, const Vector3d& result)
      { Eigen::Map<Eigen::Vector3f>(curvature->GetPointer(3 * cell)) = result.cast<float>(); };
      const auto setCell = [&](vtkIdType cell, int type, const CellIds& ids)
      {
        const Vector3d u = GetDirection(vectorOf(cell));
        SetPoints(ids, places, u, false, corners, directionOf);
        set(cell, GetGradient(corners, 0, corners.Ids.size(), cells.GetDimension(type)) * u);
      };
      VisitCells(
        cells, read, begin, end, 1, true, block, places,
        [&](vtkIdType cell, int)
        {
          const bool any = !GetDirection(vectorOf(cell)).isZero(0.0);
          if (!any)
          {
            set(cell, Vector3d::Zero());
          }
          return any;
        },
        [&](int index, const CellIds& ids)
        {
          own.Set(0, index, GetDirection(vectorOf(block.Cells[index])));
          for (int corner = 0; corner < block.Corners; ++corner)
          {
            block.Directions.Set(corner, index, directionOf(ids[corner]));
          }
        },
        [&]
        {
          block.FindGradients(own, false);
          for (int cell = 0; cell < block.Count; cell += LaneCount)
          {
            results.SetLanes(0, cell, block.Along(own.GetLanes(0, cell), cell));
          }
          for (int cell = 0; cell < block.Count; ++cell)
          {
            block.HasGradient[cell] ? set(block.Cells[cell], results.Get(0, cell))
                                    : setCell(block.Cells[cell], block.Type, block.GetIds(cell));
          }
        },
        setCell);
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
  const VectorPlaces vectorOf(vectors);
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
        const Vector3d u = GetDirection(vectorOf(i));
        const auto getDifferences = [&](vtkIdType before, vtkIdType after, GradientFit& fit)
        {
          double scratch[3];
          const auto read = [&](vtkIdType sample, Vector3d& place)
          {
            place = Eigen::Map<const Vector3d>(
              positions.Read(static_cast<std::size_t>(sample), 1, scratch));
            // As on images, a neighbour without a direction stands for no change.
            const Vector3d direction = GetDirection(vectorOf(sample));
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
