// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandSurface.h"

#include "CellSums.h"
#include "NoiseCopies.h"
#include "NoiseGhosts.h"
#include "NoiseThreads.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>

namespace noise
{
namespace
{
using steerable::TextureGradients;
using steerable::TriangleMapping;

// Below this sine of the angle to the normal a vector has no direction in the surface.
constexpr double SmallestTangent = 1e-6;
// As float coordinates hold it.
constexpr double SameTexture = 1e-5;
// Copies of a point beyond this number stay on their own, so that a heap of points takes no time.
constexpr std::size_t MostCopies = 1024;

/// A vector's part in the plane of `normal`; zero where it has no direction.
Eigen::Vector3d TangentDirection(const float* values, const Eigen::Vector3d& normal)
{
  const Eigen::Vector3d vector(values[0], values[1], values[2]);
  const double length = vector.norm();
  if (!(length > 0.0) || !std::isfinite(length))
  {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d unit = vector / length;
  const Eigen::Vector3d tangent = unit - unit.dot(normal) * normal;
  return tangent.norm() > SmallestTangent ? tangent.normalized() : Eigen::Vector3d::Zero();
}

/// Square roots of the eigenvalues of a symmetric matrix.
std::array<double, 2> SingularValues(const Eigen::Matrix2d& square)
{
  const double mean = 0.5 * (square(0, 0) + square(1, 1));
  const double radius = std::hypot(0.5 * (square(0, 0) - square(1, 1)), square(0, 1));
  // The smaller one through the determinant, which keeps its digits.
  const double larger = mean + radius;
  const double smaller = larger > 0.0 ? std::max(0.0, square.determinant()) / larger : 0.0;
  return { std::sqrt(smaller), std::sqrt(larger) };
}

std::uint64_t HashPlace(const Eigen::Vector3d& place)
{
  std::uint64_t hash = 0x9E3779B97F4A7C15u;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double value = place[axis] + 0.0; // -0 becomes 0
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0xBF58476D1CE4E5B9u;
    hash ^= hash >> 31;
  }
  return hash;
}
} // namespace

//------------------------------------------------------------------------------
int SurfaceSums::BinOf(double octaves)
{
  const double bin = std::floor((octaves + 0.5 * Octaves) * BinsPerOctave);
  return static_cast<int>(bin > 0.0 ? std::min(bin, Bins - 1.0) : 0.0);
}

double SurfaceSums::RoundArea(double area, double diagonal)
{
  const double unit = diagonal * diagonal * std::ldexp(1.0, -40);
  return unit > 0.0 ? std::round(area / unit) : 0.0;
}

//------------------------------------------------------------------------------
SubbandSurface::SubbandSurface(
  vtkPolyData* mesh, vtkDataArray* texture, bool wrapSeams, bool projections)
{
  projections = projections || !texture;
  const vtkIdType count = mesh->GetNumberOfPoints();
  this->Points.resize(count);
  for (vtkIdType point = 0; point < count; ++point)
  {
    mesh->GetPoints()->GetPoint(point, this->Points[point].data());
  }
  if (texture)
  {
    this->Texture.resize(count);
    std::vector<double> tuple(texture->GetNumberOfComponents());
    for (vtkIdType point = 0; point < count; ++point)
    {
      texture->GetTuple(point, tuple.data());
      this->Texture[point] = { tuple[0], tuple[1] };
    }
  }
  if (vtkDataArray* normals = projections ? mesh->GetPointData()->GetNormals() : nullptr)
  {
    if (normals->GetNumberOfComponents() == 3 && normals->GetNumberOfTuples() >= count)
    {
      this->Normals.resize(count);
      for (vtkIdType point = 0; point < count; ++point)
      {
        normals->GetTuple(point, this->Normals[point].data());
      }
    }
  }
  this->Triangulate(mesh);
  WithThreads([&] { this->MeasureTriangles(wrapSeams); });
  this->LinkPoints();
  if (texture)
  {
    this->JoinSeams();
  }
  if (projections && this->Normals.empty())
  {
    this->ShareNormals(mesh);
  }
}

//------------------------------------------------------------------------------
void SubbandSurface::ShareNormals(vtkPolyData* mesh)
{
  auto shared = NewOutputArray("Normals", 3, this->GetNumberOfPoints());
  for (vtkIdType point = 0; point < this->GetNumberOfPoints(); ++point)
  {
    Eigen::Vector3d normal;
    this->GetNormal(point, normal); // 0 where there is none
    shared->SetTuple(point, normal.allFinite() ? normal.data() : Eigen::Vector3d::Zero().eval().data());
  }
  const CoincidentPoints copies(mesh, HiddenSamples(mesh));
  WithThreads([&] { copies.Share(shared, DirectionSteps, true, CreaseCosine); });
  // Where there are no copies it stays empty, and normals come from the triangles.
  for (const vtkIdType point : copies.GetPoints())
  {
    this->Normals.resize(this->Points.size(), Eigen::Vector3d::Zero());
    shared->GetTuple(point, this->Normals[point].data());
  }
}

//------------------------------------------------------------------------------
void SubbandSurface::Triangulate(vtkPolyData* mesh)
{
  vtkUnsignedCharArray* ghosts = mesh->GetCellGhostArray();
  const HiddenSamples hidden(mesh);
  const vtkIdType points = mesh->GetNumberOfPoints();
  const auto inside = [points](vtkIdType id) { return id >= 0 && id < points; };
  const auto add = [&](vtkIdType cell, vtkIdType a, vtkIdType b, vtkIdType c)
  {
    const unsigned char ghost =
      ghosts && cell < ghosts->GetNumberOfTuples() ? ghosts->GetValue(cell) : 0;
    if (inside(a) && inside(b) && inside(c) && !hidden.HasCell(cell))
    {
      this->Triangles.push_back({ { a, b, c }, cell, ghost != 0 });
    }
  };

  const auto squaredLength = [&](vtkIdType a, vtkIdType b)
  { return inside(a) && inside(b) ? (this->Points[b] - this->Points[a]).squaredNorm() : 0.0; };

  // Cells are numbered vertices first, then lines, polygons and strips.
  vtkIdType cell = mesh->GetNumberOfVerts() + mesh->GetNumberOfLines();
  vtkIdType size;
  const vtkIdType* ids;
  this->Triangles.reserve(mesh->GetNumberOfPolys());
  auto polygons = vtkSmartPointer<vtkCellArrayIterator>::Take(mesh->GetPolys()->NewIterator());
  auto polygon = vtkSmartPointer<vtkPolygon>::New();
  auto corners = vtkSmartPointer<vtkIdList>::New();
  auto places = vtkSmartPointer<vtkPoints>::New();
  for (polygons->GoToFirstCell(); !polygons->IsDoneWithTraversal(); polygons->GoToNextCell())
  {
    polygons->GetCurrentCell(size, ids);
    if (size == 3)
    {
      add(cell, ids[0], ids[1], ids[2]);
    }
    else if (size == 4)
    {
      // Cut along the shorter diagonal.
      const int first = squaredLength(ids[1], ids[3]) < squaredLength(ids[0], ids[2]) ? 1 : 0;
      add(cell, ids[first], ids[first + 1], ids[first + 2]);
      add(cell, ids[first], ids[first + 2], ids[(first + 3) % 4]);
    }
    else if (size > 4 && std::all_of(ids, ids + size, inside))
    {
      polygon->Initialize(static_cast<int>(size), ids, mesh->GetPoints());
      static_cast<vtkCell*>(polygon)->Triangulate(0, corners, places);
      for (vtkIdType n = 0; n + 2 < corners->GetNumberOfIds(); n += 3)
      {
        add(cell, corners->GetId(n), corners->GetId(n + 1), corners->GetId(n + 2));
      }
    }
    ++cell;
  }
  auto strips = vtkSmartPointer<vtkCellArrayIterator>::Take(mesh->GetStrips()->NewIterator());
  for (strips->GoToFirstCell(); !strips->IsDoneWithTraversal(); strips->GoToNextCell())
  {
    strips->GetCurrentCell(size, ids);
    for (vtkIdType n = 0; n + 2 < size; ++n)
    {
      // Every second triangle of a strip is the other way round.
      const vtkIdType odd = n % 2;
      add(cell, ids[n], ids[n + 1 + odd], ids[n + 2 - odd]);
    }
    ++cell;
  }
}

//------------------------------------------------------------------------------
void SubbandSurface::MeasureTriangles(bool wrapSeams)
{
  const auto count = static_cast<vtkIdType>(this->Triangles.size());
  this->Mappings.resize(this->IsTextured() ? count : 0);
  vtkSMPTools::For(0, count, 4096,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType t = begin; t < end; ++t)
      {
        Triangle& triangle = this->Triangles[t];
        const auto& ids = triangle.Points;
        const std::array<Eigen::Vector3d, 3> corners = { this->Points[ids[0]], this->Points[ids[1]],
          this->Points[ids[2]] };
        const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
        triangle.Area = std::isfinite(area) ? area : 0.0;
        triangle.Spacing = steerable::SpacingForm(corners);
        if (!this->IsTextured())
        {
          continue;
        }
        Mapping& mapping = this->Mappings[t];
        const std::array<Eigen::Vector2d, 3> texture = { this->Texture[ids[0]],
          this->Texture[ids[1]], this->Texture[ids[2]] };
        mapping.Kind = steerable::TriangleGradients(corners, texture, wrapSeams, mapping.Gradients);
        if (!mapping.Gradients.allFinite())
        {
          mapping.Kind = TriangleMapping::Degenerate;
        }
        if (mapping.Kind == TriangleMapping::Degenerate)
        {
          triangle.Area = 0.0;
        }
      }
    });
}

//------------------------------------------------------------------------------
void SubbandSurface::LinkPoints()
{
  this->LinkStart.assign(this->Points.size() + 1, 0);
  for (const Triangle& triangle : this->Triangles)
  {
    for (const vtkIdType point : triangle.Points)
    {
      ++this->LinkStart[point + 1];
    }
  }
  std::partial_sum(this->LinkStart.begin(), this->LinkStart.end(), this->LinkStart.begin());
  this->Links.resize(3 * this->Triangles.size());
  std::vector<vtkIdType> next(this->LinkStart.begin(), this->LinkStart.end() - 1);
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    for (const vtkIdType point : this->Triangles[t].Points)
    {
      this->Links[next[point]++] = static_cast<vtkIdType>(t);
    }
  }
}

//------------------------------------------------------------------------------
void SubbandSurface::JoinSeams()
{
  const vtkIdType count = this->GetNumberOfPoints();
  this->NextCopy.resize(count);
  std::iota(this->NextCopy.begin(), this->NextCopy.end(), 0);

  // Points at the same place lie side by side when sorted by a hash of the place.
  std::vector<std::pair<std::uint64_t, vtkIdType>> order(count);
  WithThreads(
    [&]
    {
      vtkSMPTools::For(0, count, 4096,
        [&](vtkIdType begin, vtkIdType end)
        {
          for (vtkIdType point = begin; point < end; ++point)
          {
            order[point] = { HashPlace(this->Points[point]), point };
          }
        });
      vtkSMPTools::Sort(order.begin(), order.end());
    });
  const auto joins = [this](vtkIdType a, vtkIdType b)
  {
    const Eigen::Vector2d step = this->Texture[b] - this->Texture[a];
    return this->Points[a] == this->Points[b] &&
      steerable::WrapSeam(step).lpNorm<Eigen::Infinity>() < SameTexture;
  };
  std::vector<vtkIdType> firsts; // one of each ring at this place
  for (std::size_t begin = 0, end; begin < order.size(); begin = end)
  {
    for (end = begin + 1; end < order.size() && order[end].first == order[begin].first;)
    {
      ++end;
    }
    if (end - begin == 1)
    {
      continue;
    }
    if (end - begin > MostCopies)
    {
      this->Jumps.push_back(order[begin].second);
      continue;
    }
    firsts.clear();
    for (std::size_t n = begin; n < end; ++n)
    {
      const vtkIdType point = order[n].second;
      const auto ring = std::find_if(
        firsts.begin(), firsts.end(), [&](vtkIdType first) { return joins(first, point); });
      if (ring == firsts.end())
      {
        firsts.push_back(point);
      }
      else
      {
        std::swap(this->NextCopy[*ring], this->NextCopy[point]);
      }
    }
    // Points that no triangle has do not make a seam.
    const auto used = std::count_if(firsts.begin(), firsts.end(),
      [this](vtkIdType first)
      {
        vtkIdType copy = first;
        do
        {
          if (this->LinkStart[copy] < this->LinkStart[copy + 1])
          {
            return true;
          }
          copy = this->NextCopy[copy];
        } while (copy != first);
        return false;
      });
    if (used > 1)
    {
      this->Jumps.push_back(firsts.front());
    }
  }
}

//------------------------------------------------------------------------------
std::vector<vtkIdType> SubbandSurface::FindSeams() const
{
  std::vector<vtkIdType> seams = this->Jumps;
  for (vtkIdType point = 0; point < this->GetNumberOfPoints(); ++point)
  {
    bool regular = false;
    bool flipped = false;
    vtkIdType copy = point;
    do
    {
      for (vtkIdType n = this->LinkStart[copy]; n < this->LinkStart[copy + 1]; ++n)
      {
        const TriangleMapping kind = this->Mappings[this->Links[n]].Kind;
        regular = regular || kind == TriangleMapping::Regular;
        flipped = flipped || kind == TriangleMapping::Flipped;
      }
      copy = this->NextCopy[copy];
    } while (copy != point);
    if (regular && flipped)
    {
      seams.push_back(point);
    }
  }
  return seams;
}

//------------------------------------------------------------------------------
void SubbandSurface::AddTo(SurfaceSums& sums, double diagonal) const
{
  for (std::size_t t = 0; t < this->Triangles.size(); ++t)
  {
    const Triangle& triangle = this->Triangles[t];
    if (triangle.Ghost)
    {
      continue;
    }
    const double area = SurfaceSums::RoundArea(triangle.Area, diagonal);
    sums[SurfaceSums::Triangles] += 1.0;
    sums[SurfaceSums::Area] += area;
    if (!(triangle.Area > 0.0))
    {
      sums[SurfaceSums::Degenerate] += 1.0;
    }
    else if (this->IsTextured())
    {
      const Mapping& mapping = this->Mappings[t];
      if (mapping.Kind == TriangleMapping::Singular)
      {
        sums[SurfaceSums::Singular] += 1.0;
        continue;
      }
      const bool flipped = mapping.Kind == TriangleMapping::Flipped;
      sums[flipped ? SurfaceSums::FlippedArea : SurfaceSums::RegularArea] += area;
      sums[flipped ? SurfaceSums::Flipped : SurfaceSums::Regular] += 1.0;
      const auto values =
        SingularValues(mapping.Gradients.transpose() * mapping.Gradients * (diagonal * diagonal));
      sums.Smaller()[SurfaceSums::BinOf(std::log2(values[0]))] += area;
      sums.Larger()[SurfaceSums::BinOf(std::log2(values[1]))] += area;
    }
  }
}

//------------------------------------------------------------------------------
SubbandSurface::Charts SubbandSurface::FindChartsBelow(double side) const
{
  // Points of one chart lead to the same root.
  std::vector<vtkIdType> parents(this->Points.size());
  std::iota(parents.begin(), parents.end(), 0);
  const auto rootOf = [&](vtkIdType point)
  {
    while (parents[point] != point)
    {
      parents[point] = parents[parents[point]];
      point = parents[point];
    }
    return point;
  };
  for (vtkIdType point = 0; point < this->GetNumberOfPoints(); ++point)
  {
    parents[rootOf(point)] = rootOf(this->NextCopy[point]);
  }
  for (const Triangle& triangle : this->Triangles)
  {
    parents[rootOf(triangle.Points[1])] = rootOf(triangle.Points[0]);
    parents[rootOf(triangle.Points[2])] = rootOf(triangle.Points[0]);
  }
  std::vector<double> areas(this->Points.size(), 0.0); // at the roots
  for (const Triangle& triangle : this->Triangles)
  {
    areas[rootOf(triangle.Points[0])] += triangle.Area;
  }
  const auto isSmall = [&](vtkIdType root)
  { return areas[root] > 0.0 && areas[root] < side * side; };
  Charts charts;
  for (const Triangle& triangle : this->Triangles)
  {
    const double area = triangle.Ghost ? 0.0 : triangle.Area;
    charts.WholeArea += area;
    charts.Area += isSmall(rootOf(triangle.Points[0])) ? area : 0.0;
  }
  for (vtkIdType point = 0; point < this->GetNumberOfPoints(); ++point)
  {
    charts.Count += parents[point] == point && isSmall(point) ? 1.0 : 0.0;
  }
  return charts;
}

//------------------------------------------------------------------------------
bool SubbandSurface::GetNormal(vtkIdType point, Eigen::Vector3d& normal) const
{
  if (!this->Normals.empty())
  {
    normal = this->Normals[point];
    const double length = normal.norm();
    if (std::isfinite(length) && length > 0.0)
    {
      normal /= length;
      return true;
    }
  }
  normal.setZero();
  for (vtkIdType n = this->LinkStart[point]; n < this->LinkStart[point + 1]; ++n)
  {
    const Triangle& triangle = this->Triangles[this->Links[n]];
    if (triangle.Area > 0.0)
    {
      const Eigen::Vector3d& corner = this->Points[triangle.Points[0]];
      normal += (this->Points[triangle.Points[1]] - corner)
                  .cross(this->Points[triangle.Points[2]] - corner);
    }
  }
  const double length = normal.norm();
  if (!std::isfinite(length) || !(length > 0.0))
  {
    return false;
  }
  normal /= length;
  return true;
}

//------------------------------------------------------------------------------
bool SubbandSurface::ComputeTextured(
  vtkIdType point, const SteeringVectors& vectors, double anisotropy, PointMetrics& metrics) const
{
  // First the triangles that are mapped as most are, then any.
  for (const bool all : { false, true })
  {
    double total = 0.0;
    metrics = PointMetrics();
    vtkIdType copy = point;
    do
    {
      for (vtkIdType n = this->LinkStart[copy]; n < this->LinkStart[copy + 1]; ++n)
      {
        const Triangle& triangle = this->Triangles[this->Links[n]];
        const Mapping& mapping = this->Mappings[this->Links[n]];
        if (mapping.Kind == TriangleMapping::Singular || !(triangle.Area > 0.0) ||
          (!all && mapping.Kind == this->Avoided))
        {
          continue;
        }
        const TextureGradients& gradients = mapping.Gradients;
        const Eigen::Matrix2d isotropic = gradients.transpose() * gradients;
        Eigen::Matrix2d steered = isotropic;
        if (vectors.Values)
        {
          const Eigen::Vector3d normal = gradients.col(0).cross(gradients.col(1)).normalized();
          const Eigen::Vector3d direction =
            TangentDirection(vectors.Values + 3 * (vectors.Cells ? triangle.Cell : copy), normal);
          metrics.Directed = metrics.Directed || !direction.isZero();
          steered = steerable::SurfaceMetric(
            gradients, steerable::SteeredFeature(1.0, direction, anisotropy));
        }
        total += triangle.Area;
        metrics.Metric += triangle.Area * steered;
        metrics.Isotropic += triangle.Area * isotropic;
        metrics.Footprint +=
          triangle.Area * (gradients.transpose() * triangle.Spacing * gradients).eval();
      }
      copy = this->NextCopy[copy];
    } while (copy != point);
    if (total > 0.0)
    {
      metrics.Metric /= total;
      metrics.Isotropic /= total;
      metrics.Footprint /= total;
      return metrics.Metric.allFinite() && this->Texture[point].allFinite();
    }
  }
  return false;
}

//------------------------------------------------------------------------------
bool SubbandSurface::ComputeProjected(
  vtkIdType point, const SteeringVectors& vectors, double anisotropy, PointFeatures& features) const
{
  if (!this->GetNormal(point, features.Normal))
  {
    return false;
  }
  features.Feature = Eigen::Matrix3d::Zero();
  features.Spacing.setZero();
  features.Directed = false;
  const auto feature = [&](vtkIdType tuple) -> Eigen::Matrix3d
  {
    const Eigen::Vector3d direction = TangentDirection(vectors.Values + 3 * tuple, features.Normal);
    features.Directed = features.Directed || !direction.isZero();
    return steerable::SteeredFeature(1.0, direction, anisotropy);
  };
  double total = 0.0;
  for (vtkIdType n = this->LinkStart[point]; n < this->LinkStart[point + 1]; ++n)
  {
    const Triangle& triangle = this->Triangles[this->Links[n]];
    if (triangle.Area > 0.0)
    {
      total += triangle.Area;
      features.Spacing += triangle.Area * triangle.Spacing;
      if (vectors.Values && vectors.Cells)
      {
        features.Feature += triangle.Area * feature(triangle.Cell);
      }
    }
  }
  if (!(total > 0.0))
  {
    return false;
  }
  features.Spacing /= total;
  if (!vectors.Values)
  {
    features.Feature.setIdentity();
  }
  else if (vectors.Cells)
  {
    features.Feature /= total;
  }
  else
  {
    features.Feature = feature(point);
  }
  return true;
}
} // namespace noise
