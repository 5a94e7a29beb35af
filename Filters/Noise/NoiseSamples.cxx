// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseSamples.h"

#include "CellSums.h"
#include "DatasetCells.h"
#include "MetricTensor.h"
#include "NoiseCells.h"
#include "NoiseCopies.h"
#include "NoiseCurvature.h"
#include "NoiseOrder.h"
#include "NoiseThreads.h"
#include "PointPlaces.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSMPThreadLocal.h"
#include "vtkSMPTools.h"
#include "vtkStaticPointLocator.h"
#include "vtkUnsignedCharArray.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace noise
{
namespace
{
/// Unit normal of the plane through points (a strip's first three, a curved cell's corners), 0 if there is none.
Eigen::Vector3d GetNormal(const PointPlaces& places, int cellType, const CellIds& ids)
{
  const auto corners = [&]() -> vtkIdType
  {
    switch (cellType)
    {
      case VTK_TRIANGLE_STRIP:
      case VTK_QUADRATIC_TRIANGLE:
      case VTK_BIQUADRATIC_TRIANGLE:
      case VTK_LAGRANGE_TRIANGLE:
      case VTK_BEZIER_TRIANGLE:
        return 3;
      case VTK_QUADRATIC_QUAD:
      case VTK_BIQUADRATIC_QUAD:
      case VTK_QUADRATIC_LINEAR_QUAD:
      case VTK_LAGRANGE_QUADRILATERAL:
      case VTK_BEZIER_QUADRILATERAL:
        return 4;
      case VTK_QUADRATIC_POLYGON: // its corners, then the middles of its sides
        return ids.size() / 2;
      default:
        return ids.size();
    }
  };
  const vtkIdType count = std::min(corners(), ids.size());
  // Newell's sum over the edges; a pixel's points are in the order of an image.
  const auto getId = [&](vtkIdType i)
  { return ids[cellType == VTK_PIXEL && i >= 2 ? 5 - i : i]; };
  Eigen::Vector3d origin;
  Eigen::Vector3d before;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const Eigen::Vector3d place = places(getId(i));
    if (i == 0)
    {
      origin = before = place;
    }
    const Eigen::Vector3d edge = place - origin;
    normal += (before - origin).cross(edge);
    before = place;
  }
  const double length = normal.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(normal / length)
                                               : Eigen::Vector3d::Zero();
}

bool IsGhostCell(vtkUnsignedCharArray* ghosts, vtkIdType cell)
{
  return ghosts &&
    (ghosts->GetValue(cell) &
      vtkDataSetAttributes::DUPLICATECELL);
}
} // namespace

Samples::Samples(
  vtkDataSet* dataset, vtkDataArray* array, bool cells, const Shape& shape, int magnification,
  const Plane& plane, double limit, SampleFields* kept)
  : DataSet(dataset)
  , Array(array)
  , Cells(cells)
  , InPlane(plane)
  , TakenAs(shape)
  , Hidden(dataset)
  , Fields(kept ? kept : &this->Own)
{
  // Before anything looks at neighbours; where nothing steers nothing is too long.
  this->SetLeftOut(array ? limit : std::numeric_limits<double>::infinity());
  const auto setSteering = [&](bool flat)
  {
    if (!array)
    {
      this->Field.Isotropic = true;
      return;
    }
    const bool vectors = IsVector(array->GetNumberOfComponents());
    this->Steering = vectors ? MakeVectorReader(array, this->InAxes, flat, plane)
                             : MakeTensorReader(array, this->InAxes, flat, plane);
    if (!this->LeftOut.empty())
    {
      this->Steering = LeaveOut(std::move(this->Steering), vectors ? 3 : 6, this->LeftOut);
    }
    (vectors ? this->Field.Vectors : this->Field.Tensors) = this->Steering.get();
  };
  if (shape.IsGrid)
  {
    this->SetGrid(vtkImageData::SafeDownCast(dataset));
    this->Grid.CurvatureStride = magnification;
  }
  else
  {
    this->SetPoints();
  }
  setSteering(this->Dimension == 2);
}

Samples::~Samples() = default;

vtkIdType Samples::GetNumberOfSamples() const
{
  return this->Cells ? this->DataSet->GetNumberOfCells() : this->DataSet->GetNumberOfPoints();
}

std::size_t Samples::GetNumberOfParts() const
{
  return this->TakenAs.IsGrid ? this->Grid.GetNumberOfRows()
                      : static_cast<std::size_t>(this->GetNumberOfSamples());
}

void Samples::SetGrid(vtkImageData* image)
{
  int extent[6];
  image->GetExtent(extent);
  const double* spacing = image->GetSpacing();
  const double* origin = image->GetOrigin();
  const double* direction = image->GetDirectionMatrix()->GetData();

  // The axes of the image, those with extent first; the others keep their cyclic order.
  int order[3] = { 0, 1, 2 };
  const bool(&thick)[3] = this->TakenAs.Thick;
  if (!thick[0] && !thick[1] && thick[2])
  {
    order[0] = 2;
    order[1] = 0;
    order[2] = 1;
  }
  else
  {
    std::stable_partition(order, order + 3, [&](int axis) { return thick[axis]; });
  }
  this->Dimension = thick[0] && thick[1] && thick[2] ? 3 : 2;

  const double half = this->Cells ? 0.5 : 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int axis = order[i];
    const int points = extent[2 * axis + 1] - extent[2 * axis] + 1;
    for (int world = 0; world < 3; ++world)
    {
      this->InAxes[i][world] = direction[3 * world + axis];
    }
    // Along its own axes an image is a grid wherever it was turned to.
    double start = 0.0;
    for (int world = 0; world < 3; ++world)
    {
      start += this->InAxes[i][world] * origin[world];
    }
    if (!std::isfinite(start) || !std::isfinite(spacing[axis]))
    {
      throw std::invalid_argument("The image's origin, spacing or direction is not finite.");
    }
    this->Grid.Origin[i] = start + half * spacing[axis];
    this->Grid.Spacing[i] = spacing[axis];
    this->Grid.FirstIndex[i] = extent[2 * axis];
    this->Grid.Dimensions[i] = this->Cells ? std::max(points - 1, 1) : points;
  }
}

void Samples::SetLeftOut(double limit)
{
  this->LeftOut = this->Hidden.Get(this->Cells);
  if (!std::isfinite(limit))
  {
    return;
  }
  const vtkIdType count = this->Array->GetNumberOfTuples();
  this->LeftOut.resize(static_cast<std::size_t>(count));
  bool any = false;
  constexpr vtkIdType chunkSize = 4096;
  std::vector<double> lengths(chunkSize);
  for (vtkIdType first = 0; first < count; first += chunkSize)
  {
    const vtkIdType size = std::min(chunkSize, count - first);
    ReadLengths(this->Array, static_cast<std::size_t>(first), static_cast<std::size_t>(size),
      lengths.data());
    for (vtkIdType i = 0; i < size; ++i)
    {
      unsigned char& why = this->LeftOut[static_cast<std::size_t>(first + i)];
      why = why ? IsHidden : lengths[i] > limit ? IsTooLong : 0;
      any = any || why;
    }
  }
  if (!any)
  {
    this->LeftOut.clear();
  }
}

void Samples::SetPoints()
{
  if (this->Cells)
  {
    vtkNew<vtkDoubleArray> centers;
    WithThreads([&] { ComputeCellCenters(this->DataSet, centers); });
    this->CellCenters = centers;
    this->Positions = MakePositionReader(centers);
  }
  else if (auto* pointSet = vtkPointSet::SafeDownCast(this->DataSet))
  {
    this->Positions = MakePositionReader(pointSet->GetPoints()->GetData());
  }
  else
  {
    this->Positions = MakePositionReader(this->DataSet);
  }
  if (this->Array && IsVector(this->Array->GetNumberOfComponents()) && !this->Fields->AreNormalsKnown)
  {
    WithThreads(
      [&]
      {
        this->Fields->Normals =
          this->TakenAs.Slab >= 0 ? this->ComputeSlabNormals() : this->ComputeNormals();
      });
    this->Fields->AreNormalsKnown = true;
  }
  if (this->Fields->Normals)
  {
    this->NormalReader = MakeVectorReader(this->Fields->Normals, WorldAxes, false);
    this->Field.Normals = this->NormalReader.get();
  }
}

vtkSmartPointer<vtkFloatArray> Samples::ComputeNormals()
{
  const DatasetCells cells(this->DataSet);
  if (!cells.Has(2))
  {
    return nullptr;
  }
  const PointPlaces places(this->DataSet);
  if (!this->Cells)
  {
    this->GetCopies(); // before the array: it takes memory for a while
  }
  auto normals = NewOutputArray("Normals", 3, this->GetNumberOfSamples());
  // The dataset's own normals where it has them; their sense does not matter.
  vtkDataSetAttributes* attributes = this->Cells
    ? static_cast<vtkDataSetAttributes*>(this->DataSet->GetCellData())
    : this->DataSet->GetPointData();
  vtkDataArray* own = attributes->GetNormals();
  const auto isSurface = [&](vtkIdType cell, int type)
  { return cells.GetDimension(type) == 2 && (this->Cells || !this->Hidden.HasCell(cell)); };

  // A polygon's sides bend, but VTK takes it for flat inside.
  const auto isCurved = [&](int type)
  { return cells.IsCurved(type) && type != VTK_QUADRATIC_POLYGON; };
  vtkSMPThreadLocal<std::shared_ptr<CurvedCell>> curvedCells;
  const auto getCurved = [&](vtkIdType cell) -> CurvedCell*
  {
    if (!isCurved(cells.GetType(cell)))
    {
      return nullptr;
    }
    std::shared_ptr<CurvedCell>& curved = curvedCells.Local();
    curved = curved ? curved : std::make_shared<CurvedCell>();
    return curved->Set(this->DataSet, cell) ? curved.get() : nullptr;
  };

  if (this->Cells)
  {
    vtkSMPTools::For(0, this->DataSet->GetNumberOfCells(), 1024,
      [&](vtkIdType begin, vtkIdType end)
      {
        DatasetCells::Reader read(cells);
        for (vtkIdType cell = begin; cell < end; ++cell)
        {
          Eigen::Vector3d normal = Eigen::Vector3d::Zero();
          if (isSurface(cell, cells.GetType(cell)))
          {
            if (CurvedCell* curved = getCurved(cell))
            {
              normal = curved->GetNormalAtCenter();
            }
            if (normal.isZero(0.0))
            {
              normal = GetNormal(places, cells.GetType(cell), read(cell));
            }
          }
          if (own && !normal.isZero(0.0))
          {
            own->GetTuple(cell, normal.data());
          }
          normals->SetTuple(cell, normal.data());
        }
      });
    return normals;
  }

  PointSums sums(this->DataSet, normals, DirectionSteps);
  // Neighbours that face the other way count all the same: the metric has no sides.
  sums.Sum(true,
    [&]
    {
      return [&, read = DatasetCells::Reader(cells), block = CellBlock(), steps = CornerVectors(),
               hasNormal = std::array<bool, CornerVectors::MostCells>()](
               vtkIdType begin, vtkIdType end, PointSums::Shares& shares) mutable
      {
        const auto appendBlock = [&]
        {
          for (int cell = 0; cell < block.Count; cell += LaneCount)
          {
            LaneVector axes[3];
            block.GetAxes(block.Places, cell, axes);
            const LaneVector normal = axes[0].Cross(axes[1]);
            const Lanes length = normal.Dot(normal).sqrt();
            steps.SetLanes(0, cell, sums.ToSteps(normal * length.inverse()));
            for (int lane = 0; lane < LaneCount; ++lane)
            {
              hasNormal[cell + lane] = length[lane] > 0.0 && std::isfinite(length[lane]);
            }
          }
          for (int cell = 0; cell < block.Count; ++cell)
          {
            if (hasNormal[cell])
            {
              sums.AppendCorners(shares, block, cell, steps, true);
            }
          }
        };
        const auto appendCell = [&](vtkIdType cell, int type, const CellIds& ids)
        {
          const Eigen::Vector3d flat = GetNormal(places, type, ids);
          CurvedCell* curved = getCurved(cell);
          for (vtkIdType i = 0; i < ids.size(); ++i)
          {
            Eigen::Vector3d normal = curved ? curved->GetNormal(static_cast<int>(i)) : flat;
            normal = normal.isZero(0.0) ? flat : normal;
            if (!normal.isZero(0.0))
            {
              sums.Append(shares, ids[i], normal);
            }
          }
        };
        VisitCells(
          cells, read, begin, end, 1, true, block, places, isSurface, [](int, const CellIds&) {},
          appendBlock, appendCell);
      };
    });
  for (vtkIdType point = 0; own && point < normals->GetNumberOfTuples(); ++point)
  {
    const Eigen::Map<const Eigen::Vector3f> normal(normals->GetPointer(3 * point));
    if (!normal.isZero(0.0f)) // on a surface
    {
      double tuple[3];
      own->GetTuple(point, tuple);
      normals->SetTuple(point, tuple);
    }
  }
  this->GetCopies().Share(normals, DirectionSteps, true, CreaseCosine);
  // A point of a volume is not on a surface.
  DatasetCells::Reader read(cells);
  for (vtkIdType cell = 0; cells.Has(3) && cell < cells.GetNumberOfCells(); ++cell)
  {
    if (cells.GetDimension(cells.GetType(cell)) == 3 && !this->Hidden.HasCell(cell))
    {
      for (const vtkIdType point : read(cell))
      {
        normals->SetTuple3(point, 0.0, 0.0, 0.0);
      }
    }
  }
  return normals;
}

vtkSmartPointer<vtkFloatArray> Samples::ComputeSlabNormals() const
{
  int dims[3];
  GetDimensions(this->DataSet, dims);
  const int slab = this->TakenAs.Slab;
  const int u = (slab + 1) % 3;
  const int v = (slab + 2) % 3;
  const vtkIdType stride[3] = { 1, dims[0], static_cast<vtkIdType>(dims[0]) * dims[1] };
  const vtkIdType pointCount = this->DataSet->GetNumberOfPoints();
  auto normals = NewOutputArray("Normals", 3, this->GetNumberOfSamples());

  // Through the slab, from one point to its partner on the other side.
  const auto through = [&](vtkIdType point, double normal[3])
  {
    const vtkIdType near = (point / stride[slab]) % 2 == 0 ? point : point - stride[slab];
    double a[3];
    double b[3];
    this->DataSet->GetPoint(near, a);
    this->DataSet->GetPoint(near + stride[slab], b);
    vtkMath::Subtract(b, a, normal);
  };
  double normal[3];
  if (!this->Cells)
  {
    for (vtkIdType point = 0; point < pointCount; ++point)
    {
      through(point, normal);
      normals->SetTuple(point, normal);
    }
    return normals;
  }
  vtkIdType cell = 0;
  for (int k = 0; k < dims[2] - 1; ++k)
  {
    for (int j = 0; j < dims[1] - 1; ++j)
    {
      for (int i = 0; i < dims[0] - 1; ++i, ++cell)
      {
        double sum[3] = { 0.0, 0.0, 0.0 };
        const vtkIdType corner = i * stride[0] + j * stride[1] + k * stride[2];
        for (const vtkIdType offset : { vtkIdType(0), stride[u], stride[v], stride[u] + stride[v] })
        {
          through(corner + offset, normal);
          vtkMath::Add(sum, normal, sum);
        }
        normals->SetTuple(cell, sum);
      }
    }
  }
  return normals;
}

bool Samples::DoCellsMeet(int axis, vtkIdType cell) const
{
  int dims[3];
  GetDimensions(this->DataSet, dims);
  const vtkIdType strides[3] = { 1, dims[0], static_cast<vtkIdType>(dims[0]) * dims[1] };
  vtkIdType corner = 0;
  for (int i = 0; i < 3; ++i)
  {
    const vtkIdType cells = std::max(dims[i] - 1, 1);
    corner += cell % cells * strides[i];
    cell /= cells;
  }
  // The side of the first cell is that of the last one.
  const int other[2] = { (axis + 1) % 3, (axis + 2) % 3 };
  for (int n = 0; n < 4; ++n)
  {
    const bool along[2] = { (n & 1) != 0, (n & 2) != 0 };
    vtkIdType first = corner;
    for (int i = 0; i < 2; ++i)
    {
      first += along[i] && dims[other[i]] > 1 ? strides[other[i]] : 0;
    }
    Eigen::Vector3d places[2];
    this->DataSet->GetPoint(first, places[0].data());
    this->DataSet->GetPoint(first + (dims[axis] - 1) * strides[axis], places[1].data());
    if (!AreSamePlaces(places[0], places[1]))
    {
      return false;
    }
  }
  return true;
}

void Samples::TakeTensorsAsMetrics(double factor)
{
  if (this->Field.Tensors)
  {
    this->Metrics = MakeMetricReader(
      this->Array, this->InAxes, this->Dimension == 2, this->InPlane, factor);
    if (!this->LeftOut.empty())
    {
      this->Metrics = LeaveOut(std::move(this->Metrics), 6, this->LeftOut);
    }
    this->Field.Tensors = nullptr;
    this->Field.Metrics = this->Metrics.get();
  }
}

void Samples::SetShapes(const ShapeArrays& arrays)
{
  this->Shapes = MakeShapeReader(arrays);
  this->Field.Shapes = this->Shapes.get();
}

void Samples::ComputeCurvature(double featureSize)
{
  const vtkIdType count = this->GetNumberOfSamples();
  if (this->TakenAs.IsGrid || count == 0 || !this->Field.Vectors || this->DataSet->GetNumberOfCells() == 0)
  {
    return;
  }
  // The power of two below, so that most changes of the size leave the curvature as it is.
  const double size = std::ldexp(1.0, std::ilogb(featureSize));
  if (this->Fields->CurvatureSize != size)
  {
    this->Fields->Curvature = this->FindCurvature(size);
    this->Fields->CurvatureSize = size;
  }
  this->CurvatureReader = MakeVectorReader(this->Fields->Curvature, WorldAxes, false);
  this->Field.Curvature = this->CurvatureReader.get();
}

const CoincidentPoints& Samples::GetCopies()
{
  if (!this->Copies)
  {
    this->Copies.reset(new CoincidentPoints(this->DataSet, this->Hidden));
  }
  return *this->Copies;
}

vtkSmartPointer<vtkFloatArray> Samples::FindCurvature(double featureSize)
{
  int dimensions[3];
  if (!GetDimensions(this->DataSet, dimensions))
  {
    return ComputeStreamlineCurvature(
      this->DataSet, *this->Field.Vectors, this->Cells, this->Hidden, this->GetCopies(), featureSize);
  }
  for (int& samples : dimensions)
  {
    samples = this->Cells ? std::max(samples - 1, 1) : samples;
  }
  std::function<bool(int, vtkIdType)> cellsMeet;
  if (this->Cells)
  {
    cellsMeet = [this](int axis, vtkIdType cell) { return this->DoCellsMeet(axis, cell); };
  }
  return ComputeStreamlineCurvature(
    dimensions, *this->Positions, *this->Field.Vectors, this->LeftOut, cellsMeet);
}

void Samples::FindOrder()
{
  if (this->TakenAs.IsGrid || this->Fields->IsOrderKnown)
  {
    return;
  }
  double bounds[6];
  this->DataSet->GetBounds(bounds);
  this->Fields->Order = noise::FindOrder(*this->Positions,
    static_cast<std::size_t>(this->GetNumberOfSamples()), bounds, this->Fields->Normals ? 2 : 3);
  this->Fields->IsOrderKnown = true;
}

steerable::EvaluationCounts Samples::Evaluate(
  const steerable::SteerableNoise& kernel, std::size_t begin, std::size_t end, float* noise) const
{
  if (this->TakenAs.IsGrid)
  {
    return kernel.EvaluateImage(this->Grid, this->Field, begin, end, noise);
  }
  return this->Fields->Order.empty()
    ? kernel.EvaluatePoints(*this->Positions, this->Field, begin, end, noise)
    : EvaluateInOrder(kernel, *this->Positions, this->Field, this->Fields->Order, begin, end, noise);
}

namespace
{
/// Metric of a tuple, XX YY ZZ XY YZ XZ: floats are a tensor with a direction, doubles the metric itself.
template <int N>
steerable::AxialMetric<N> MetricOf(const steerable::NoiseParameters& parameters, const float* tuple)
{
  const steerable::Matrix<N> tensor = steerable::TensorOf<N>(tuple);
  return steerable::MetricFromTensor<N>(parameters, tensor, steerable::NormOf<N>(tensor, tuple));
}

template <int N>
steerable::AxialMetric<N> MetricOf(const steerable::NoiseParameters& parameters, const double* tuple)
{
  const steerable::Matrix<N> tensor = steerable::TensorOf<N>(tuple);
  return steerable::MetricFromMetric<N>(parameters, tensor, steerable::NormOf<N>(tensor, tuple));
}
} // namespace

void Samples::EvaluateMetrics(const steerable::NoiseParameters& common, vtkIdType begin,
  vtkIdType end, double* metrics) const
{
  using namespace steerable;
  const auto count = static_cast<std::size_t>(end - begin);
  std::vector<float> scratch(6 * count);
  std::vector<float> normalScratch(3 * count);
  std::vector<double> metricScratch(this->Metrics ? 6 * count : 0);
  const double* own =
    this->Metrics ? this->Metrics->Read(begin, count, metricScratch.data()) : nullptr;
  const float* steering =
    this->Steering ? this->Steering->Read(begin, count, scratch.data()) : nullptr;
  const float* normals =
    this->NormalReader ? this->NormalReader->Read(begin, count, normalScratch.data()) : nullptr;
  std::vector<float> shapeScratch(this->Shapes ? 3 * count : 0);
  const float* shapes =
    this->Shapes ? this->Shapes->Read(begin, count, shapeScratch.data()) : nullptr;
  for (std::size_t i = 0; i < count; ++i)
  {
    const NoiseParameters parameters = shapes ? WithShape(common, shapes + 3 * i) : common;
    Matrix<3> metric = Matrix<3>::Zero();
    const auto set = [&](const auto& axial)
    {
      const auto part = axial.ToMatrix();
      metric.topLeftCorner(part.rows(), part.cols()) = part;
    };
    const auto setFrom = [&](const auto* tuple)
    {
      this->Dimension == 2 ? set(MetricOf<2>(parameters, tuple))
                           : set(MetricOf<3>(parameters, tuple));
    };
    if (this->Field.Isotropic)
    {
      metric.diagonal().head(this->Dimension).setOnes();
    }
    else if (own)
    {
      setFrom(own + 6 * i);
    }
    else if (this->Field.Tensors)
    {
      setFrom(steering + 6 * i);
    }
    else
    {
      const Vector<3> vector = Eigen::Map<const Eigen::Vector3f>(steering + 3 * i).cast<double>();
      if (this->Dimension == 2)
      {
        set(MetricFromVector<2>(
          parameters, vector.head<2>(), WholeLength(vector.head<2>().norm(), vector[2])));
      }
      else if (normals)
      {
        const Vector<3> normal = Eigen::Map<const Eigen::Vector3f>(normals + 3 * i).cast<double>();
        set(MetricFromSurfaceVector(parameters, vector, normal));
      }
      else
      {
        set(MetricFromVector<3>(parameters, vector));
      }
    }
    // Back from the axes of the noise to the world's.
    Matrix<3> axes;
    for (int row = 0; row < 3; ++row)
    {
      for (int column = 0; column < 3; ++column)
      {
        axes(row, column) = this->InAxes[row][column];
      }
    }
    metric = axes.transpose() * metric * axes;
    const double components[6] = { metric(0, 0), metric(1, 1), metric(2, 2), metric(0, 1),
      metric(1, 2), metric(0, 2) };
    std::copy(components, components + 6, metrics + 6 * (begin + i));
  }
}

namespace
{
using Places = std::vector<Eigen::Vector3d>;

/// The root of their number; that of squares and cubes, which most cells are, without taking it.
double SamplesOnSide(std::size_t count, int dimension)
{
  return count == std::size_t(1) << dimension
    ? 2.0
    : std::pow(static_cast<double>(count), 1.0 / dimension);
}

/// Spacing along each axis of samples that fill a cell of this dimension; `whole`: of the cell's sides.
Eigen::Array3d SpacingOf(const Eigen::Vector3d* places, std::size_t count, int dimension, bool whole)
{
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i)
  {
    mean += places[i];
  }
  mean /= static_cast<double>(count);
  Eigen::Array3d variance = Eigen::Array3d::Zero();
  for (std::size_t i = 0; i < count; ++i)
  {
    variance += (places[i] - mean).array().square();
  }
  variance /= static_cast<double>(count);
  if (count == static_cast<std::size_t>(dimension) + 1)
  {
    // Half a square or a sixth of a cube counts as the whole.
    return (variance * ((dimension + 1.0) * (dimension + 1.0) / dimension)).sqrt();
  }
  // p intervals of h on a side: variance h^2 p (p + 2) / 12.
  const double intervals = SamplesOnSide(count, dimension) - 1.0;
  const Eigen::Array3d spacing =
    (variance * (12.0 / (intervals * (intervals + 2.0)))).sqrt();
  return whole ? Eigen::Array3d(spacing * intervals) : spacing;
}

/// The same of the cells of a block from this one on.
LaneVector SpacingOf(const CellBlock& block, int cell)
{
  const auto count = static_cast<double>(block.Corners);
  LaneVector mean = block.Places.GetLanes(0, cell);
  for (int corner = 1; corner < block.Corners; ++corner)
  {
    mean = mean + block.Places.GetLanes(corner, cell);
  }
  mean = mean * (1.0 / count);
  LaneVector squares = { Lanes::Zero(), Lanes::Zero(), Lanes::Zero() };
  for (int corner = 0; corner < block.Corners; ++corner)
  {
    const LaneVector from = block.Places.GetLanes(corner, cell) - mean;
    squares = squares + LaneVector{ from.X.square(), from.Y.square(), from.Z.square() };
  }
  // A simplex counts as the whole; else there are two samples on each side.
  const int dimension = block.Dimension;
  const double factor =
    block.Corners == dimension + 1 ? (dimension + 1.0) * (dimension + 1.0) / dimension : 4.0;
  squares = squares * (factor / count);
  return { squares.X.sqrt(), squares.Y.sqrt(), squares.Z.sqrt() };
}

/// Root mean square along each axis of the edges of a polygon, as of a square with such edges.
Eigen::Array3d SpacingOfEdges(const Places& corners)
{
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    sum += (corners[(i + 1) % corners.size()] - corners[i]).array().square();
  }
  return (2.0 * sum / static_cast<double>(corners.size())).sqrt();
}

/// Distances of points from the nearest other ones.
class NearestPoints
{
public:
  explicit NearestPoints(vtkDataSet* dataset)
    : Places(dataset)
  {
    Eigen::AlignedBox3d box;
    for (vtkIdType point = 0; point < dataset->GetNumberOfPoints(); ++point)
    {
      const Eigen::Vector3d place = this->Places(point);
      if (place.allFinite())
      {
        box.extend(place);
        this->Points.push_back(point);
      }
    }
    // Halves, since a difference of huge numbers has no room.
    this->Origin = box.min() / 2.0;
    this->Unit = this->Points.empty() ? 0.0 : (box.max() / 2.0 - this->Origin).maxCoeff();
    if (!(this->Unit > 0.0))
    {
      this->Points.clear();
      return;
    }
    // The locator sorts places into bins by arithmetic that has no bounds: it gets none that is NaN or infinite,
    // and coordinates from 0 to 1 whatever the dataset's are.
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    for (const vtkIdType point : this->Points)
    {
      places->InsertNextPoint(this->Normalize(this->Places(point)).data());
    }
    this->Normalized->SetPoints(places);
    this->Locator->SetDataSet(this->Normalized);
    this->Locator->BuildLocator();
  }

  /// 0 if there is none.
  double GetDistance(vtkIdType point)
  {
    const Eigen::Vector3d place = this->Places(point);
    if (!place.allFinite() || this->Points.empty())
    {
      return 0.0;
    }
    this->Locator->FindClosestNPoints(8, this->Normalize(place).data(), this->Near);
    for (const vtkIdType other : *this->Near)
    {
      const double distance = (this->Places(this->Points[other]) - place).norm();
      if (std::isfinite(distance) && distance > 0.0)
      {
        return distance;
      }
    }
    return 0.0;
  }

private:
  Eigen::Vector3d Normalize(const Eigen::Vector3d& place) const
  {
    return (place / 2.0 - this->Origin) / this->Unit;
  }

  PointPlaces Places;
  /// Those that have a place.
  std::vector<vtkIdType> Points;
  Eigen::Vector3d Origin;
  double Unit = 0.0;
  vtkNew<vtkPolyData> Normalized;
  vtkNew<vtkStaticPointLocator> Locator;
  vtkNew<vtkIdList> Near;
};
} // namespace

void SampleSpacing::Add(
  vtkDataSet* dataset, bool centers, int slab, const HiddenSamples& hidden, vtkIdType cellsAtMost)
{
  if (auto* image = vtkImageData::SafeDownCast(dataset))
  {
    int dims[3];
    image->GetDimensions(dims);
    const double* direction = image->GetDirectionMatrix()->GetData();
    for (int axis = 0; axis < 3; ++axis)
    {
      double squares = 0.0;
      for (int i = 0; i < 3; ++i)
      {
        const double step = direction[3 * axis + i] * image->GetSpacing()[i];
        squares += dims[i] > 1 ? step * step : 0.0;
      }
      // Squares of tiny or huge spacings have no room.
      const double own = dims[axis] > 1 ? std::abs(image->GetSpacing()[axis]) : 0.0;
      const bool turned = std::abs(direction[4 * axis]) != 1.0;
      this->Largest[axis] = std::max(this->Largest[axis], turned ? std::sqrt(squares) : own);
    }
    return;
  }
  const vtkIdType cells = dataset->GetNumberOfCells();
  const vtkIdType points = dataset->GetNumberOfPoints();
  std::optional<NearestPoints> nearest;
  const auto addNearest = [&](vtkIdType point)
  {
    if (!nearest)
    {
      nearest.emplace(dataset);
    }
    const double distance = nearest->GetDistance(point);
    if (distance > 0.0)
    {
      this->Add(Eigen::Array3d::Constant(distance));
    }
  };
  // Distances of the nearest are looked for at fewer places: each takes a search.
  constexpr vtkIdType searchesAtMost = 10000;
  if (cells == 0)
  {
    for (vtkIdType point = 0; point < points; point += 1 + points / searchesAtMost)
    {
      if (!hidden.HasPoint(point))
      {
        addNearest(point);
      }
    }
    return;
  }
  const DatasetCells allCells(dataset);
  const PointPlaces placeOf(dataset);
  // A slab's own thickness says nothing about the distance of its samples: one side of it does.
  int dims[3] = { 1, 1, 1 };
  GetDimensions(dataset, dims);
  const vtkIdType strides[3] = { 1, dims[0], static_cast<vtkIdType>(dims[0]) * dims[1] };
  vtkUnsignedCharArray* ghosts = dataset->GetCellGhostArray();

  // Parts are summed one after the other, so that threads do not show.
  struct Part
  {
    SampleSpacing Spacing;
    std::vector<vtkIdType> Vertices;
  };
  const auto isThere = [&](vtkIdType id, int) { return !hidden.HasCell(id) && !IsGhostCell(ghosts, id); };
  const auto addCell = [&](int type, const CellIds& ids, Places& places, Part& part)
  {
    const int dimension = slab >= 0 ? 2 : allCells.GetDimension(type);
    if (dimension == 0)
    {
      part.Vertices.insert(part.Vertices.end(), ids.begin(), ids.end());
      return;
    }
    places.clear();
    for (const vtkIdType point : ids)
    {
      if (slab < 0 || point / strides[slab] % dims[slab] == 0)
      {
        places.push_back(placeOf(point));
      }
    }
    if (places.size() < static_cast<std::size_t>(dimension) + 1)
    {
      return;
    }
    const std::size_t size = type == VTK_TRIANGLE_STRIP ? 3 : type == VTK_POLY_LINE ? 2 : 0;
    if (size > 0 && !centers)
    {
      for (std::size_t first = 0; first + size <= places.size(); ++first)
      {
        part.Spacing.Add(SpacingOf(places.data() + first, size, dimension, false));
      }
    }
    else if (type == VTK_POLYGON && places.size() > 4 && !centers)
    {
      part.Spacing.Add(SpacingOfEdges(places));
    }
    else
    {
      part.Spacing.Add(SpacingOf(places.data(), places.size(), dimension, centers));
    }
  };
  constexpr vtkIdType cellsPerPart = 4096;
  const vtkIdType step = 1 + cells / cellsAtMost;
  const vtkIdType partSize = cellsPerPart * step;
  std::vector<Part> parts(static_cast<std::size_t>((cells + partSize - 1) / partSize));
  WithThreads(
    [&]
    {
      vtkSMPTools::For(0, static_cast<vtkIdType>(parts.size()), 1,
        [&](vtkIdType begin, vtkIdType end)
        {
          DatasetCells::Reader read(allCells);
          Places places;
          CellBlock block;
          CornerVectors spacings;
          for (vtkIdType i = begin; i < end; ++i)
          {
            Part& part = parts[static_cast<std::size_t>(i)];
            VisitCells(
              allCells, read, i * partSize, std::min(cells, (i + 1) * partSize), step, slab < 0, block,
              placeOf, isThere, [](int, const CellIds&) {},
              [&]
              {
                for (int cell = 0; cell < block.Count; cell += LaneCount)
                {
                  spacings.SetLanes(0, cell, SpacingOf(block, cell));
                }
                for (int cell = 0; cell < block.Count; ++cell)
                {
                  part.Spacing.Add(spacings.Get(0, cell).array());
                }
              },
              [&](vtkIdType, int type, const CellIds& ids) { addCell(type, ids, places, part); });
          }
        });
    });
  vtkIdType searches = 0;
  for (const Part& part : parts)
  {
    this->Add(part.Spacing);
    for (const vtkIdType point : part.Vertices)
    {
      searches += 1;
      if (searches <= searchesAtMost)
      {
        addNearest(point);
      }
    }
  }
}

void SampleSpacing::Add(const Eigen::Array3d& distances)
{
  if (distances.allFinite())
  {
    Eigen::Map<Eigen::Array3d>(this->Sum) += distances;
    this->Count += 1.0;
  }
}

void SampleSpacing::Add(const SampleSpacing& other)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Largest[axis] = std::max(this->Largest[axis], other.Largest[axis]);
    this->Sum[axis] += other.Sum[axis];
  }
  this->Count += other.Count;
}
} // namespace noise
