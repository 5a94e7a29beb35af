// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// vtkSteerableNoiseFilter on every type of dataset and composite, and on what is wrong with them.
#include "DatasetCells.h"
#include "FilterTestHelpers.h"
#include "NoiseCells.h"
#include "NoiseGhosts.h"
#include "NoiseThreads.h"
#include "SurfaceFields.h"

#include "vtkAMRBox.h"
#include "vtkAppendFilter.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataSetTriangleFilter.h"
#include "vtkExecutive.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkImageDataToPointSet.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNonOverlappingAMR.h"
#include "vtkOverlappingAMR.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPlaneSource.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSphereSource.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkStringArray.h"
#include "vtkStructuredData.h"
#include "vtkStructuredGrid.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkTrivialProducer.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkWeakPointer.h"
#include "vtkVersion.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <limits>
#include <map>
#include <thread>
#include <utility>

using namespace filtertest;

namespace
{
struct Result
{
  vtkSmartPointer<vtkDataObject> Output;
  int Errors;
  int Warnings;
  std::string Text;
};

Result Apply(
  vtkDataObject* input, const std::function<void(vtkSteerableNoiseFilter*)>& configure = {})
{
  vtkNew<vtkSteerableNoiseFilter> filter;
  auto messages = Listen(filter);
  auto pipeline = Listen(filter->GetExecutive());
  filter->SetInputDataObject(input);
  if (configure)
  {
    configure(filter);
  }
  filter->Update();
  return { filter->GetOutputDataObject(0), messages->Errors + pipeline->Errors, messages->Warnings,
    messages->Text };
}

/// The same box of 9 x 7 x 6 points as different dataset types.
vtkSmartPointer<vtkImageData> Box(bool cells)
{
  return MakeImage(9, 7, 6, 1.0, cells);
}

template <typename FilterT>
vtkSmartPointer<vtkDataSet> Through(vtkDataSet* input)
{
  vtkNew<FilterT> filter;
  filter->SetInputData(input);
  filter->Update();
  return vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
}

vtkSmartPointer<vtkRectilinearGrid> Rectilinear(bool cells)
{
  auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
  const int dims[3] = { 9, 7, 6 };
  grid->SetDimensions(dims);
  vtkSmartPointer<vtkDoubleArray> coordinates[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    coordinates[axis] = vtkSmartPointer<vtkDoubleArray>::New();
    for (int i = 0; i < dims[axis]; ++i)
    {
      coordinates[axis]->InsertNextValue(i);
    }
  }
  grid->SetXCoordinates(coordinates[0]);
  grid->SetYCoordinates(coordinates[1]);
  grid->SetZCoordinates(coordinates[2]);
  AddFlow(grid, cells);
  return grid;
}

vtkSmartPointer<vtkExplicitStructuredGrid> Explicit(bool cells)
{
  vtkSmartPointer<vtkDataSet> box = Through<vtkAppendFilter>(Box(cells)); // hexahedra
  auto* unstructured = vtkUnstructuredGrid::SafeDownCast(box);
  auto grid = vtkSmartPointer<vtkExplicitStructuredGrid>::New();
  grid->SetDimensions(9, 7, 6);
  grid->SetPoints(unstructured->GetPoints());
  grid->SetCells(unstructured->GetCells());
  grid->ComputeFacesConnectivityFlagsArray();
  AddFlow(grid, cells);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> Polyhedra()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 16; ++i)
  {
    points->InsertNextPoint((i / 4) * 2.0, (i & 1) * 2.0, ((i >> 1) & 1) * 2.0);
  }
  grid->SetPoints(points);
  for (vtkIdType base = 0; base < 12; base += 4)
  {
    const vtkIdType b = base;
    const vtkIdType faces[] = { 4, b, b + 1, b + 3, b + 2, 4, b + 4, b + 5, b + 7, b + 6, 4, b,
      b + 1, b + 5, b + 4, 4, b + 2, b + 3, b + 7, b + 6, 4, b, b + 2, b + 6, b + 4, 4, b + 1,
      b + 3, b + 7, b + 5 };
    grid->InsertNextCell(VTK_POLYHEDRON, 6, faces);
  }
  AddFlow(grid);
  return grid;
}

/// One cell of all the points, with the flow at them.
vtkSmartPointer<vtkUnstructuredGrid> Cells(int type, const std::vector<double>& coordinates)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  std::vector<vtkIdType> ids;
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
  {
    ids.push_back(points->InsertNextPoint(coordinates.data() + i));
  }
  grid->SetPoints(points);
  if (!ids.empty())
  {
    grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
  }
  AddFlow(grid);
  return grid;
}

double LargestDifference(const std::vector<float>& a, const std::vector<float>& b)
{
  double largest = a.size() == b.size() && !a.empty() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
  {
    largest = std::max(largest, std::abs(double(a[i]) - b[i]));
  }
  return largest;
}
} // namespace

TEST(SteerableNoiseDataSets, TheSamePlaceHasTheSameValueInEveryType)
{
  const auto still = [](vtkSteerableNoiseFilter* filter)
  {
    filter->SetFeatureSize(3.0);
    filter->FollowCurvatureOff();
  };
  for (const bool cells : { false, true })
  {
    const std::vector<float> expected = Values(Apply(Box(cells), still).Output);
    ASSERT_TRUE(AllFinite(expected));
    const auto compare = [&](vtkDataSet* dataset, const char* what)
    {
      const Result result = Apply(dataset, still);
      EXPECT_EQ(result.Errors, 0) << what << result.Text;
      EXPECT_TRUE(result.Output->IsA(dataset->GetClassName())) << what;
      // The image takes another path through the kernel: the last bits may differ.
      EXPECT_LT(LargestDifference(Values(result.Output), expected), 5e-6) << what;
    };
    compare(Rectilinear(cells), "rectilinear");
    compare(Through<vtkImageDataToPointSet>(Box(cells)), "curvilinear");
    compare(Through<vtkAppendFilter>(Box(cells)), "hexahedra or voxels");
    compare(Explicit(cells), "explicit structured");
    if (!cells)
    {
      compare(Through<vtkDataSetTriangleFilter>(Box(false)), "tetrahedra");
    }
  }
}

TEST(SteerableNoiseDataSets, CurvatureAgreesWithTheImages)
{
  // Central differences on the image, vtkGradientFilter on the others: the same inside, where both
  // are of second order.
  auto image = MakeImage(24, 22, 20);
  const auto configure = [](vtkSteerableNoiseFilter* filter) { filter->SetFeatureSize(4.0); };
  const std::vector<float> expected = Values(Apply(image, configure).Output);
  const std::vector<float> result =
    Values(Apply(Through<vtkImageDataToPointSet>(image), configure).Output);
  ASSERT_EQ(result.size(), expected.size());
  double largest = 0.0;
  for (int k = 1; k < 19; ++k)
  {
    for (int j = 1; j < 21; ++j)
    {
      for (int i = 1; i < 23; ++i)
      {
        const int id = (k * 22 + j) * 24 + i;
        largest = std::max(largest, std::abs(double(result[id]) - expected[id]));
      }
    }
  }
  EXPECT_LT(largest, 1e-3);
}

TEST(SteerableNoiseDataSets, PolyhedraAndMixedCells)
{
  EXPECT_TRUE(AllFinite(Values(Apply(Polyhedra()).Output)));
  // A volume with a surface and a line beside it, all cell types in one grid.
  vtkNew<vtkUnstructuredGrid> mixed;
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 16; ++i)
  {
    points->InsertNextPoint(i & 1, (i >> 1) & 1, ((i >> 2) & 1) + 5 * (i >> 3));
  }
  mixed->SetPoints(points);
  const vtkIdType voxel[8] = { 0, 1, 2, 3, 4, 5, 6, 7 };
  const vtkIdType quad[4] = { 8, 9, 11, 10 };
  const vtkIdType line[2] = { 12, 13 };
  const vtkIdType vertex[1] = { 14 };
  mixed->InsertNextCell(VTK_VOXEL, 8, voxel);
  mixed->InsertNextCell(VTK_QUAD, 4, quad);
  mixed->InsertNextCell(VTK_LINE, 2, line);
  mixed->InsertNextCell(VTK_VERTEX, 1, vertex);
  AddFlow(mixed);
  AddFlow(mixed, true, "cellFlow");
  for (const char* name : { "velocity", "cellFlow" })
  {
    const Result result = Apply(mixed,
      [&](vtkSteerableNoiseFilter* filter)
      {
        filter->SetInputArrayToProcess(
          0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, name);
        filter->OutputMetricOn();
      });
    EXPECT_TRUE(AllFinite(Values(result.Output))) << name;
    // The quad's points have the metric of a surface: 0.5 along the normal, z; the voxel's have not.
    auto* dataset = vtkDataSet::SafeDownCast(result.Output);
    vtkDataArray* metric = dataset->GetPointData()->GetArray("Metric");
    if (metric)
    {
      EXPECT_NEAR(metric->GetComponent(8, 2), 0.5, 1e-5);
      EXPECT_GT(metric->GetComponent(0, 2), 0.6);
    }
  }
}

/// Their gradient is that of the simplices that VTK divides them into.
TEST(SteerableNoiseDataSets, StripsAndPointSetsBendLikeTheirSimplices)
{
  const std::vector<double> zigzag = { 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0 };
  auto strip = Cells(VTK_TRIANGLE_STRIP, zigzag);
  auto triangles = Cells(VTK_TRIANGLE_STRIP, zigzag);
  triangles->Reset();
  for (vtkIdType i = 0; i < 4; ++i)
  {
    const vtkIdType ids[] = { i, i + 1, i + 2 };
    triangles->InsertNextCell(VTK_TRIANGLE, 3, ids);
  }
  const std::vector<double> corners = { 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2 };
  const std::function<void(vtkSteerableNoiseFilter*)> configure =
    [](vtkSteerableNoiseFilter* filter) { filter->SetFeatureSize(1.0); };
  const std::function<void(vtkSteerableNoiseFilter*)> straight = [](vtkSteerableNoiseFilter* filter)
  {
    filter->SetFeatureSize(1.0);
    filter->FollowCurvatureOff();
  };
  const std::vector<float> bent = Values(Apply(strip, configure).Output);
  EXPECT_LE(LargestDifference(bent, Values(Apply(triangles, configure).Output)), 1e-6);
  EXPECT_GT(LargestDifference(bent, Values(Apply(strip, straight).Output)), 1e-3);
  EXPECT_LE(LargestDifference(Values(Apply(Cells(VTK_CONVEX_POINT_SET, corners), configure).Output),
              Values(Apply(Cells(VTK_TETRA, corners), configure).Output)),
    1e-6);
}

/// Cells with parallel sides have one gradient, whatever it is made from and in which order their corners are.
TEST(SteerableNoiseDataSets, CellsWithParallelSidesBendAlike)
{
  const std::function<void(vtkSteerableNoiseFilter*)> configure =
    [](vtkSteerableNoiseFilter* filter) { filter->SetFeatureSize(1.0); };
  // Corners of a sheared box, in the order of an image.
  std::vector<Eigen::Vector3d> box;
  for (int i = 0; i < 8; ++i)
  {
    box.push_back(Eigen::Vector3d(2.0, 0.1, 0.2) * (i & 1) +
      Eigen::Vector3d(0.3, 1.5, 0.0) * (i >> 1 & 1) + Eigen::Vector3d(0.0, 0.4, 1.0) * (i >> 2));
  }
  const auto noiseOf = [&](int type, const std::vector<int>& corners)
  {
    std::vector<double> places;
    for (const int corner : corners)
    {
      places.insert(places.end(), box[corner].begin(), box[corner].end());
    }
    const std::vector<float> values = Values(Apply(Cells(type, places), configure).Output);
    std::map<int, float> byCorner;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      byCorner[corners[i]] = values.at(i);
    }
    return byCorner;
  };
  struct Shape
  {
    int Type;
    std::vector<int> Corners;
  };
  // The last of each is fitted, as cells of any shape are.
  const std::vector<Shape> alike[] = {
    { { VTK_VOXEL, { 0, 1, 2, 3, 4, 5, 6, 7 } }, { VTK_HEXAHEDRON, { 0, 1, 3, 2, 4, 5, 7, 6 } },
      { VTK_CONVEX_POINT_SET, { 0, 1, 2, 3, 4, 5, 6, 7 } } },
    { { VTK_PIXEL, { 0, 1, 2, 3 } }, { VTK_QUAD, { 0, 1, 3, 2 } }, { VTK_POLYGON, { 0, 1, 3, 2 } } }
  };
  for (const auto& shapes : alike)
  {
    const auto expected = noiseOf(shapes.back().Type, shapes.back().Corners);
    for (const Shape& shape : shapes)
    {
      for (const auto& [corner, noise] : noiseOf(shape.Type, shape.Corners))
      {
        EXPECT_NEAR(noise, expected.at(corner), 2e-6) << "type " << shape.Type << ", corner " << corner;
      }
    }
  }
}

TEST(SteerableNoiseDataSets, APhaseBeginsWhenAllButTheOneBeforeAreDone)
{
  constexpr vtkIdType phases = 300;
  const auto jobsOf = [](vtkIdType phase) { return phase * 7 % 5; }; // some have none
  std::vector<std::atomic<vtkIdType>> done(phases);
  std::atomic<int> tooEarly{ 0 };
  noise::WithThreads(
    [&]
    {
      noise::RunInPhases(phases, jobsOf,
        [&]
        {
          return [&](vtkIdType phase, vtkIdType job)
          {
            for (vtkIdType before = 0; before < phase - 1; ++before)
            {
              tooEarly += done[before] < jobsOf(before);
            }
            if (job % 2 == 0)
            {
              std::this_thread::sleep_for(std::chrono::microseconds(100));
            }
            ++done[phase];
          };
        });
    });
  EXPECT_EQ(tooEarly, 0);
  for (vtkIdType phase = 0; phase < phases; ++phase)
  {
    EXPECT_EQ(done[phase], jobsOf(phase));
  }
}

TEST(SteerableNoiseDataSets, CellsAreReadAsVtkGivesThem)
{
  const auto expectSame = [](vtkDataSet* dataset)
  {
    const noise::DatasetCells cells(dataset);
    noise::DatasetCells::Reader read(cells);
    vtkNew<vtkIdList> expected;
    vtkNew<vtkGenericCell> cell;
    ASSERT_EQ(cells.GetNumberOfCells(), dataset->GetNumberOfCells());
    ASSERT_GT(cells.GetNumberOfCells(), 0);
    for (vtkIdType id = 0; id < cells.GetNumberOfCells(); ++id)
    {
      const int type = cells.GetType(id);
      EXPECT_EQ(type, dataset->GetCellType(id));
      dataset->GetCell(id, cell);
      EXPECT_EQ(cells.GetDimension(type), cell->GetCellDimension());
      EXPECT_TRUE(cells.Has(cells.GetDimension(type)));
      EXPECT_EQ(cells.IsCurved(type), !cell->IsLinear());
      const noise::CellIds ids = read(id);
      dataset->GetCellPoints(id, expected);
      EXPECT_EQ(std::vector<vtkIdType>(ids.begin(), ids.end()),
        std::vector<vtkIdType>(expected->begin(), expected->end()));
    }
  };
  const auto makeCells = [](const std::vector<vtkIdType>& sizes, bool wide)
  {
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    wide ? cells->Use64BitStorage() : cells->Use32BitStorage();
    vtkIdType first = 0;
    for (const vtkIdType size : sizes)
    {
      cells->InsertNextCell(static_cast<int>(size));
      for (vtkIdType i = 0; i < size; ++i)
      {
        cells->InsertCellPoint((first + 2 * i) % 12);
      }
      ++first;
    }
    return cells;
  };
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 12; ++i)
  {
    points->InsertNextPoint(i % 4, i / 4, 0.1 * i * i);
  }
  for (const bool wide : { true, false })
  {
    // Verts, lines, polygons and strips, alone and together.
    for (int kinds = 1; kinds < 16; ++kinds)
    {
      vtkNew<vtkPolyData> surface;
      surface->SetPoints(points);
      surface->SetVerts(makeCells(kinds & 1 ? std::vector<vtkIdType>{ 1, 3, 1 } : std::vector<vtkIdType>{}, wide));
      surface->SetLines(makeCells(kinds & 2 ? std::vector<vtkIdType>{ 2, 5, 2 } : std::vector<vtkIdType>{}, wide));
      surface->SetPolys(makeCells(kinds & 4 ? std::vector<vtkIdType>{ 3, 6, 4, 5 } : std::vector<vtkIdType>{}, wide));
      surface->SetStrips(makeCells(kinds & 8 ? std::vector<vtkIdType>{ 5, 3, 4 } : std::vector<vtkIdType>{}, wide));
      expectSame(surface);
    }
    vtkNew<vtkUnstructuredGrid> grid;
    grid->SetPoints(points);
    vtkNew<vtkUnsignedCharArray> types;
    for (const int type : { VTK_QUADRATIC_TRIANGLE, VTK_TETRA, VTK_PIXEL, VTK_WEDGE })
    {
      types->InsertNextValue(static_cast<unsigned char>(type));
    }
    grid->SetCells(types, makeCells({ 6, 4, 4, 6 }, wide));
    expectSame(grid);
  }
  expectSame(Box(false));
}

TEST(SteerableNoiseDataSets, SurfacesTakeTheMetricOfTheirTangentPlane)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(24);
  sphere->SetPhiResolution(24);
  sphere->SetRadius(5.0);
  sphere->Update();
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(sphere->GetOutput());
  surface->GetPointData()->Initialize(); // without normals: they are computed
  AddFlow(surface);
  const Result result = Apply(surface, [](vtkSteerableNoiseFilter* f) { f->OutputMetricOn(); });
  EXPECT_EQ(result.Errors, 0);
  auto* output = vtkDataSet::SafeDownCast(result.Output);
  EXPECT_TRUE(AllFinite(Values(output)));
  vtkDataArray* metric = output->GetPointData()->GetArray("Metric");
  for (vtkIdType i = 2; i < output->GetNumberOfPoints(); ++i) // 0 and 1 are the poles
  {
    double p[3];
    double m[6];
    output->GetPoint(i, p);
    metric->GetTuple(i, m);
    const double n[3] = { p[0] / 5.0, p[1] / 5.0, p[2] / 5.0 };
    const double along = m[0] * n[0] * n[0] + m[1] * n[1] * n[1] + m[2] * n[2] * n[2] +
      2.0 * (m[3] * n[0] * n[1] + m[4] * n[1] * n[2] + m[5] * n[0] * n[2]);
    EXPECT_NEAR(along, 0.5, 0.05) << "the normal is the second axis";
  }
  EXPECT_EQ(surface->GetPointData()->GetNumberOfArrays(), 1) << "the input was written";
}

TEST(SteerableNoiseDataSets, TheHubOfAFanHasTheNormalOfItsTriangles)
{
  // More triangles than a sum has room for.
  constexpr int spokes = 3000;
  const Eigen::Vector3d normal(0.6, 0.0, 0.8);
  const Eigen::Vector3d side(0.8, 0.0, -0.6);
  vtkNew<vtkUnstructuredGrid> fan;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->InsertNextPoint(0.0, 0.0, 0.0);
  for (int i = 0; i < spokes; ++i)
  {
    const double angle = 2.0 * vtkMath::Pi() * i / spokes;
    const Eigen::Vector3d p = std::cos(angle) * side + std::sin(angle) * Eigen::Vector3d::UnitY();
    points->InsertNextPoint(p.data());
  }
  fan->SetPoints(points);
  for (vtkIdType i = 0; i < spokes; ++i)
  {
    const vtkIdType ids[] = { 0, 1 + i, 1 + (i + 1) % spokes };
    fan->InsertNextCell(VTK_TRIANGLE, 3, ids);
  }
  AddFlow(fan);
  const Result result = Apply(fan.Get(), [](vtkSteerableNoiseFilter* f) { f->OutputMetricOn(); });
  EXPECT_EQ(result.Errors, 0);
  double m[6];
  vtkDataSet::SafeDownCast(result.Output)->GetPointData()->GetArray("Metric")->GetTuple(0, m);
  Eigen::Matrix3d metric;
  metric << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
  EXPECT_LT((metric * normal - 0.5 * normal).norm(), 1e-4);
}

TEST(SteerableNoiseDataSets, FlatSlabsOneCellThickAreSurfaces)
{
  for (const bool cells : { false, true })
  {
    auto image = MakeImage(20, 2, 18, 1.0, cells);
    vtkSmartPointer<vtkDataSet> slab = Through<vtkImageDataToPointSet>(image);
    const Result result = Apply(slab,
      [](vtkSteerableNoiseFilter* f)
      {
        f->SetFeatureSize(4.0);
        f->OutputMetricOn();
      });
    EXPECT_EQ(result.Errors, 0) << result.Text;
    auto* output = vtkDataSet::SafeDownCast(result.Output);
    vtkDataSetAttributes* attributes =
      cells ? static_cast<vtkDataSetAttributes*>(output->GetCellData()) : output->GetPointData();
    ASSERT_NE(attributes->GetArray("Metric"), nullptr);
    for (vtkIdType i = 0; i < attributes->GetNumberOfTuples(); i += 7)
    {
      EXPECT_NEAR(attributes->GetArray("Metric")->GetComponent(i, 1), 0.5, 1e-5);
    }
    // As an image, cells one thick are a flat image.
    EXPECT_TRUE(AllFinite(Values(Apply(image).Output)));
  }
}

namespace
{
/// A part of a structured dataset, with its places and arrays.
vtkSmartPointer<vtkDataSet> Part(vtkDataSet* whole, const int (&extent)[6])
{
  auto part = vtkSmartPointer<vtkDataSet>::Take(whole->NewInstance());
  part->ShallowCopy(whole);
  if (auto* image = vtkImageData::SafeDownCast(part))
  {
    image->Crop(extent);
  }
  else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(part))
  {
    rectilinear->Crop(extent);
  }
  else
  {
    vtkStructuredGrid::SafeDownCast(part)->Crop(extent);
  }
  return part;
}

void Straight(vtkSteerableNoiseFilter* filter)
{
  filter->SetFeatureSize(3.0);
  filter->FollowCurvatureOff();
}
} // namespace

TEST(SteerableNoiseDataSets, ABlockOneCellThickContinuesItsNeighbours)
{
  // 8 x 6 x 5 cells, the layers at the upper ends of each axis as blocks of their own.
  for (const bool cells : { false, true })
  {
    const vtkSmartPointer<vtkDataSet> wholes[] = { Box(cells), Rectilinear(cells),
      Through<vtkImageDataToPointSet>(Box(cells)) };
    for (const auto& whole : wholes)
    {
      const std::vector<float> expected = Values(Apply(whole, Straight).Output);
      for (int axis = 0; axis < 3; ++axis)
      {
        int lower[6] = { 0, 8, 0, 6, 0, 5 };
        int upper[6] = { 0, 8, 0, 6, 0, 5 };
        lower[2 * axis + 1] -= 1;
        upper[2 * axis] = lower[2 * axis + 1];
        vtkNew<vtkMultiBlockDataSet> blocks;
        blocks->SetBlock(0, Part(whole, upper));
        blocks->SetBlock(1, Part(whole, lower));
        const auto output = Apply(blocks, Straight).Output;
        const std::vector<float> noise =
          Values(vtkMultiBlockDataSet::SafeDownCast(output)->GetBlock(0));
        // The same samples of the whole.
        const int more = cells ? 0 : 1;
        std::vector<float> same;
        for (int k = upper[4]; k < upper[5] + more; ++k)
        {
          for (int j = upper[2]; j < upper[3] + more; ++j)
          {
            for (int i = upper[0]; i < upper[1] + more; ++i)
            {
              same.push_back(expected[(k * (6 + more) + j) * (8 + more) + i]);
            }
          }
        }
        EXPECT_LT(LargestDifference(noise, same), 5e-6)
          << whole->GetClassName() << (cells ? " cells " : " points ") << axis;
      }
    }
  }
}

TEST(SteerableNoiseDataSets, APieceOneCellThickIsAPieceOfItsWhole)
{
  // Of a source in pieces: the extent of the whole decides.
  for (const auto& whole : { vtkSmartPointer<vtkDataSet>(Rectilinear(false)),
         Through<vtkImageDataToPointSet>(Box(false)) })
  {
    const std::vector<float> expected = Values(Apply(whole, Straight).Output);
    vtkNew<vtkTrivialProducer> source;
    source->SetOutput(Part(whole, { 0, 8, 0, 6, 4, 5 }));
    source->SetWholeExtent(0, 8, 0, 6, 0, 5);
    vtkNew<vtkSteerableNoiseFilter> filter;
    filter->SetInputConnection(source->GetOutputPort());
    Straight(filter);
    filter->UpdateInformation();
    const int part[6] = { 0, 8, 0, 6, 4, 5 };
    filter->UpdateExtent(part);
    EXPECT_LT(LargestDifference(Values(filter->GetOutputDataObject(0)),
                std::vector<float>(expected.end() - 2 * 63, expected.end())),
      5e-6)
      << whole->GetClassName();
  }
}

TEST(SteerableNoiseDataSets, FlatImagesOfACompositeHaveOneKindOfNoise)
{
  // A column one cell wide is flat along another axis, but not next to the rest of its image.
  const auto flat = MakeImage(12, 9, 1, 1.0, true);
  vtkNew<vtkMultiBlockDataSet> columns;
  columns->SetBlock(0, Part(flat, { 0, 10, 0, 8, 0, 0 }));
  columns->SetBlock(1, Part(flat, { 10, 11, 0, 8, 0, 0 }));
  const std::vector<float> expected = Values(Apply(flat, Straight).Output);
  std::vector<float> column;
  for (std::size_t row = 0; row < 8; ++row)
  {
    column.push_back(expected[11 * row + 10]);
  }
  const auto block = [](vtkDataObject* output, unsigned int index)
  { return Values(vtkMultiBlockDataSet::SafeDownCast(output)->GetBlock(index)); };
  EXPECT_LT(LargestDifference(block(Apply(columns, Straight).Output, 1), column), 5e-6);

  // Next to other surfaces, or another plane, an image is a surface in space.
  const auto image = MakeImage(12, 9, 1);
  const vtkSmartPointer<vtkDataSet> grid = Through<vtkImageDataToPointSet>(image);
  const std::vector<float> surface = Values(Apply(grid, Straight).Output);
  vtkNew<vtkImageData> across;
  across->SetDimensions(12, 1, 9);
  AddFlow(across);
  for (vtkDataSet* other : { grid.Get(), static_cast<vtkDataSet*>(across.Get()) })
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetBlock(0, image);
    blocks->SetBlock(1, other);
    EXPECT_LT(LargestDifference(block(Apply(blocks, Straight).Output, 0), surface), 5e-6) << other->GetClassName();
  }
  // Two in the same plane are as one, in the plane.
  vtkNew<vtkMultiBlockDataSet> two;
  two->SetBlock(0, image);
  two->SetBlock(1, image);
  EXPECT_EQ(block(Apply(two, Straight).Output, 0), Values(Apply(image, Straight).Output));
}

TEST(SteerableNoiseDataSets, ImagesInCompositesAreMagnified)
{
  const auto fine = [](vtkSteerableNoiseFilter* filter)
  {
    filter->SetFeatureSize(3.0);
    filter->SetMagnification(3);
  };
  for (const bool cells : { false, true })
  {
    const vtkSmartPointer<vtkDataSet> images[] = { MakeImage(12, 9, 1, 1.0, cells), Box(cells) };
    for (const auto& image : images)
    {
      vtkNew<vtkPartitionedDataSet> parts;
      parts->SetPartition(0, image);
      vtkNew<vtkPartitionedDataSetCollection> collection;
      collection->SetPartitionedDataSet(0, parts);
      const Result result = Apply(collection, fine);
      auto* output = vtkPartitionedDataSetCollection::SafeDownCast(result.Output);
      EXPECT_EQ(Values(output->GetPartition(0, 0)), Values(Apply(image, fine).Output));
      EXPECT_EQ(result.Errors + result.Warnings, 0) << result.Text;
    }
  }
  // Others pass beside them.
  vtkNew<vtkMultiBlockDataSet> mixed;
  mixed->SetBlock(0, Box(false));
  mixed->SetBlock(1, Rectilinear(false));
  const Result result = Apply(mixed, fine);
  auto* output = vtkMultiBlockDataSet::SafeDownCast(result.Output);
  EXPECT_EQ(Values(output->GetBlock(0)).size(), std::size_t(25 * 19 * 16));
  EXPECT_EQ(Values(output->GetBlock(1)).size(), std::size_t(9 * 7 * 6));

  // All of them together have to fit.
  vtkNew<vtkMultiBlockDataSet> large;
  for (unsigned int i = 0; i < 4; ++i)
  {
    auto image = Box(false);
    image->SetDimensions(30000, 30000, 1000); // never filled
    large->SetBlock(i, image);
  }
  const Result refused = Apply(large, [](auto* filter) { filter->SetMagnification(16); });
  EXPECT_GE(refused.Errors, 1);
  EXPECT_NE(refused.Text.find("Lower Magnification"), std::string::npos) << refused.Text;
}

TEST(SteerableNoiseDataSets, MagnificationNamesTheImagesOfAnAMR)
{
  vtkNew<vtkNonOverlappingAMR> amr;
  const int blocks[1] = { 2 };
  amr->Initialize(1, blocks);
  for (unsigned int i = 0; i < 2; ++i)
  {
    vtkNew<vtkUniformGrid> grid;
    grid->SetDimensions(5, 5, 5);
    grid->SetOrigin(4.0 * i, 0.0, 0.0);
    AddFlow(grid, true);
    amr->SetDataSet(0, i, grid);
  }
  const auto configure = [](int magnification)
  {
    return [=](vtkSteerableNoiseFilter* filter)
    {
      filter->SetFeatureSize(4.0);
      filter->SetMagnification(magnification);
    };
  };
  const Result plain = Apply(amr, configure(1));
  const Result fine = Apply(amr, configure(4));
  EXPECT_EQ(plain.Warnings, 0) << plain.Text;
  EXPECT_EQ(fine.Warnings, 1);
  EXPECT_NE(fine.Text.find("leaves the 2 images of an AMR"), std::string::npos) << fine.Text;
  for (unsigned int i = 0; i < 2; ++i)
  {
    EXPECT_EQ(Values(vtkNonOverlappingAMR::SafeDownCast(fine.Output)->GetDataSet(0, i)),
      Values(vtkNonOverlappingAMR::SafeDownCast(plain.Output)->GetDataSet(0, i)));
  }
}

TEST(SteerableNoiseDataSets, HiddenCellsDoNotChangeMagnifiedOnes)
{
  std::vector<float> noise[2];
  for (const double left : { 1.0, 50.0 })
  {
    auto image = MakeImage(13, 9, 1, 1.0, true);
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    for (int cell = 0; cell < 96; ++cell)
    {
      const bool hidden = cell % 12 < 5;
      ghosts->InsertNextValue(hidden ? vtkDataSetAttributes::REFINEDCELL : 0);
      if (hidden)
      {
        image->GetCellData()->GetVectors()->SetTuple3(cell, -left, left, 0.0);
      }
    }
    image->GetCellData()->AddArray(ghosts);
    const Result result = Apply(image,
      [](vtkSteerableNoiseFilter* filter)
      {
        filter->SetFeatureSize(4.0);
        filter->SetMagnification(3);
      });
    const std::vector<float> all = Values(result.Output);
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      if (i % 36 >= 15)
      {
        noise[left > 1.0].push_back(all[i]);
      }
    }
  }
  EXPECT_EQ(noise[0].size(), std::size_t(21 * 24));
  EXPECT_EQ(noise[0], noise[1]);
}

TEST(SteerableNoiseDataSets, PatchesOneCellThickInAnAMRAreNotFlat)
{
  vtkNew<vtkNonOverlappingAMR> amr;
  const int blocks[2] = { 1, 3 };
  amr->Initialize(2, blocks);
  vtkNew<vtkUniformGrid> coarse;
  coarse->SetDimensions(5, 5, 5);
  coarse->SetSpacing(2.0, 2.0, 2.0);
  AddFlow(coarse, true);
  amr->SetDataSet(0, 0, coarse);
  const auto fine = MakeImage(9, 9, 9, 1.0, true);
  const std::vector<float> expected = Values(Apply(fine, Straight).Output);
  for (unsigned int axis = 0; axis < 3; ++axis)
  {
    vtkNew<vtkUniformGrid> patch;
    int extent[6] = { 0, 8, 0, 8, 0, 8 };
    extent[2 * axis + 1] = 1;
    patch->SetExtent(extent);
    AddFlow(patch, true);
    amr->SetDataSet(1, axis, patch);
  }
  const Result result = Apply(amr, Straight);
  auto* output = vtkNonOverlappingAMR::SafeDownCast(result.Output);
  for (unsigned int axis = 0; axis < 3; ++axis)
  {
    const std::vector<float> noise = Values(output->GetDataSet(1, axis));
    std::vector<float> same;
    for (int cell = 0; cell < 512; ++cell)
    {
      const int index[3] = { cell % 8, cell / 8 % 8, cell / 64 };
      if (index[axis] == 0)
      {
        same.push_back(expected[static_cast<std::size_t>(cell)]);
      }
    }
    EXPECT_LT(LargestDifference(noise, same), 5e-6) << axis;
  }
}

TEST(SteerableNoiseDataSets, AMRKeepsItsStructure)
{
  const std::vector<unsigned int> blocks = { 1, 2 };
  vtkNew<vtkOverlappingAMR> amr;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  amr->Initialize(blocks);
#else // VTK 9.6 has deprecated this one, earlier versions have no other.
  amr->Initialize(2, std::vector<int>(blocks.begin(), blocks.end()).data());
#endif
  const double origin[3] = { 0, 0, 0 };
  amr->SetOrigin(origin);
  int dimensions[3] = { 9, 9, 9 };
  amr->SetGridDescription(vtkStructuredData::GetDataDescription(dimensions));
  std::vector<vtkSmartPointer<vtkUniformGrid>> grids;
  for (unsigned int level = 0; level < 2; ++level)
  {
    const double h = level == 0 ? 1.0 : 0.5;
    const double spacing[3] = { h, h, h };
    amr->SetSpacing(level, spacing);
    for (unsigned int block = 0; block < blocks[level]; ++block)
    {
      auto grid = vtkSmartPointer<vtkUniformGrid>::New();
      grid->SetOrigin(block * 4.0, 0, 0);
      grid->SetSpacing(spacing);
      grid->SetDimensions(dimensions);
      AddFlow(grid, true);
      amr->SetAMRBox(level, block, vtkAMRBox(grid->GetOrigin(), dimensions, spacing, origin));
      amr->SetDataSet(level, block, grid);
      grids.push_back(grid);
    }
  }
  const Result result = Apply(amr);
  EXPECT_EQ(result.Errors, 0) << result.Text;
  auto* output = vtkOverlappingAMR::SafeDownCast(result.Output);
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfLevels(), 2u);
  std::size_t found = 0;
  auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(output->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem(), ++found)
  {
    const std::vector<float> values =
      Values(vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject()));
    EXPECT_EQ(values.size(), 512u);
    EXPECT_TRUE(AllFinite(values));
  }
  EXPECT_EQ(found, grids.size());
  EXPECT_EQ(grids.front()->GetCellData()->GetArray("SteerableNoise"), nullptr);
}

TEST(SteerableNoiseDataSets, CompositesWithPartialArrays)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  auto onPoints = MakeImage(8, 8, 8);
  auto onCells = MakeImage(8, 8, 8, 1.0, true);
  onCells->SetOrigin(7, 0, 0);
  vtkNew<vtkImageData> without;
  without->SetDimensions(4, 4, 4);
  auto oneComponent = vtkSmartPointer<vtkImageData>::New();
  oneComponent->SetDimensions(4, 4, 4);
  AddFlow(oneComponent, false, "velocity", 1);
  auto twoComponents = vtkSmartPointer<vtkImageData>::New();
  twoComponents->SetDimensions(4, 4, 1);
  AddFlow(twoComponents, false, "velocity", 2);
  vtkNew<vtkPolyData> empty;
  vtkNew<vtkMultiBlockDataSet> nested;
  nested->SetBlock(0, twoComponents);
  nested->SetBlock(1, nullptr);
  blocks->SetBlock(0, onPoints);
  blocks->SetBlock(1, onCells);
  blocks->SetBlock(2, without);
  blocks->SetBlock(3, nullptr);
  blocks->SetBlock(4, oneComponent);
  blocks->SetBlock(5, empty);
  blocks->SetBlock(6, nested);
  blocks->GetMetaData(1u)->Set(vtkCompositeDataSet::NAME(), "cells");
  const Result result = Apply(blocks,
    [](vtkSteerableNoiseFilter* filter) {
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "velocity");
    });
  EXPECT_EQ(result.Errors, 0) << result.Text;
  EXPECT_EQ(result.Warnings, 1) << result.Text;
  EXPECT_NE(result.Text.find("2 block(s)"), std::string::npos) << result.Text;
  EXPECT_NE(result.Text.find("1 component"), std::string::npos)
    << "the reason is named: " << result.Text;
  auto* output = vtkMultiBlockDataSet::SafeDownCast(result.Output);
  ASSERT_NE(output, nullptr);
  ASSERT_EQ(output->GetNumberOfBlocks(), 7u);
  EXPECT_EQ(Values(output->GetBlock(0)).size(), 512u);
  EXPECT_EQ(Values(output->GetBlock(1)).size(), 343u) << "an array on the other association serves";
  EXPECT_TRUE(Values(output->GetBlock(2)).empty());
  EXPECT_EQ(output->GetBlock(3), nullptr);
  EXPECT_TRUE(Values(output->GetBlock(4)).empty());
  EXPECT_NE(output->GetBlock(5), nullptr);
  auto* inner = vtkMultiBlockDataSet::SafeDownCast(output->GetBlock(6));
  ASSERT_NE(inner, nullptr);
  EXPECT_EQ(Values(inner->GetBlock(0)).size(), 16u);
  EXPECT_STREQ(output->GetMetaData(1u)->Get(vtkCompositeDataSet::NAME()), "cells");
}

TEST(SteerableNoiseDataSets, OneFeatureSizeForAllBlocks)
{
  vtkNew<vtkPartitionedDataSetCollection> collection;
  vtkNew<vtkPartitionedDataSet> partitions;
  auto left = MakeImage(60, 50, 1);
  auto right = MakeImage(60, 50, 1);
  right->SetOrigin(500, 0, 0);
  AddFlow(right);
  partitions->SetPartition(0, left);
  partitions->SetPartition(1, right);
  collection->SetPartitionedDataSet(0, partitions);
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetInputDataObject(collection);
  filter->Update();
  // 5.61, and the next power of the fourth root of 2.
  EXPECT_NEAR(filter->GetResolvedFeatureSize(), std::exp2(2.5), 1e-9);
  auto* output = vtkPartitionedDataSetCollection::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  EXPECT_EQ(Values(output->GetPartition(0, 1)).size(), 3000u);
}

TEST(SteerableNoiseDataSets, SamplesTooFarApartAreNamedWithNumbersAndRemedy)
{
  const Result coarse =
    Apply(MakeImage(20, 20, 1), [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(2.0); });
  EXPECT_EQ(coarse.Warnings, 1);
  EXPECT_NE(coarse.Text.find("1 apart"), std::string::npos) << coarse.Text;
  EXPECT_NE(coarse.Text.find("FeatureSize to at least 4"), std::string::npos) << coarse.Text;
  const Result fine =
    Apply(MakeImage(20, 20, 1), [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(4.0); });
  EXPECT_EQ(fine.Warnings, 0) << fine.Text;
}

/// Values that are left over where data are blanked do not show in what is seen.
TEST(SteerableNoiseDataSets, HiddenSamplesDoNotChangeVisibleOnes)
{
  const auto flag = [](vtkDataSet* dataset, bool cells, unsigned char ghost)
  {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    const vtkIdType count = cells ? dataset->GetNumberOfCells() : dataset->GetNumberOfPoints();
    for (vtkIdType i = 0; i < count; ++i)
    {
      double bounds[6];
      double p[3];
      cells ? dataset->GetCellBounds(i, bounds) : dataset->GetPoint(i, p);
      ghosts->InsertNextValue((cells ? bounds[0] : p[0]) < 5.0 ? ghost : 0);
    }
    (cells ? static_cast<vtkDataSetAttributes*>(dataset->GetCellData()) : dataset->GetPointData())
      ->AddArray(ghosts);
  };
  const std::pair<bool, unsigned char> kinds[] = { { false, vtkDataSetAttributes::HIDDENPOINT },
    { true, vtkDataSetAttributes::HIDDENCELL }, { true, vtkDataSetAttributes::REFINEDCELL } };
  for (const auto& kind : kinds)
  {
    for (const bool cells : { false, true })
    {
      for (const int type : { 0, 1, 2, 3 })
      {
        // The flow left of x = 5 is hidden; what it holds must not matter.
        std::vector<std::vector<float>> noises;
        vtkIdType counts[2];
        std::vector<unsigned char> hidden;
        for (const double left : { 0.0, -9999.0 })
        {
          auto image = MakeImage(12, 10, type == 3 ? 1 : 8, 1.0, cells);
          vtkDataSetAttributes* attributes = cells
            ? static_cast<vtkDataSetAttributes*>(image->GetCellData())
            : image->GetPointData();
          vtkSmartPointer<vtkDataSet> dataset = image;
          if (type == 1)
          {
            dataset = Through<vtkImageDataToPointSet>(image);
          }
          else if (type == 2)
          {
            dataset = Through<vtkAppendFilter>(image);
          }
          attributes = cells ? static_cast<vtkDataSetAttributes*>(dataset->GetCellData())
                             : dataset->GetPointData();
          flag(dataset, kind.first, kind.second);
          const noise::HiddenSamples all(dataset);
          hidden = all.Get(cells);
          for (vtkIdType i = 0; i < attributes->GetNumberOfTuples(); ++i)
          {
            if (hidden[i])
            {
              attributes->GetVectors()->SetTuple3(i, left, left, 0.0);
            }
          }
          vtkNew<vtkSteerableNoiseFilter> filter;
          filter->SetInputData(dataset);
          filter->SetFeatureSize(4.0);
          filter->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE);
          filter->Update();
          counts[left < 0.0] = filter->GetNumberOfDegenerateSamples();
          noises.push_back(Values(filter->GetOutputDataObject(0)));
        }
        ASSERT_EQ(noises[0].size(), hidden.size());
        vtkIdType visible = 0;
        for (std::size_t i = 0; i < hidden.size(); ++i)
        {
          visible += !hidden[i];
          if (!hidden[i])
          {
            ASSERT_EQ(noises[0][i], noises[1][i])
              << "flag " << int(kind.second) << ", cells " << cells << ", type " << type;
          }
        }
        EXPECT_GT(visible, 0);
        EXPECT_LT(visible, static_cast<vtkIdType>(hidden.size()));
        EXPECT_EQ(counts[0], 0);
        EXPECT_EQ(counts[1], 0);
      }
    }
  }
}

/// Hidden points do not stretch the bounds; duplicates of another piece count as neighbours.
TEST(SteerableNoiseDataSets, HiddenPointsDoNotCountForTheAutomaticSize)
{
  auto grid = Through<vtkImageDataToPointSet>(MakeImage(500, 400, 1));
  auto* points = vtkPointSet::SafeDownCast(grid)->GetPoints();
  const auto size = [&]
  {
    vtkNew<vtkSteerableNoiseFilter> filter;
    filter->SetInputData(grid);
    filter->Update();
    return filter->GetResolvedFeatureSize();
  };
  const double before = size();
  points->SetPoint(0, -1e6, 0.0, 0.0);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(grid->GetNumberOfPoints());
  ghosts->Fill(0);
  ghosts->SetValue(0, vtkDataSetAttributes::HIDDENPOINT);
  grid->GetPointData()->AddArray(ghosts);
  grid->Modified();
  points->Modified();
  EXPECT_EQ(size(), before);
}

TEST(SteerableNoiseDataSets, DuplicatesOfAnotherPieceAreNeighbours)
{
  auto image = MakeImage(12, 10, 1);
  const auto noise = [&] {
    return Values(Apply(image, [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(4.0); }).Output);
  };
  const std::vector<float> expected = noise();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i)
  {
    ghosts->SetValue(i, i % 12 < 5 ? vtkDataSetAttributes::DUPLICATEPOINT : 0);
  }
  image->GetPointData()->AddArray(ghosts);
  EXPECT_EQ(noise(), expected);
}

namespace
{
double AutomaticSize(vtkDataObject* input)
{
  vtkNew<vtkSteerableNoiseFilter> filter;
  auto messages = Listen(filter);
  filter->SetInputDataObject(input);
  filter->Update();
  EXPECT_EQ(messages->Errors + messages->Warnings, 0) << messages->Text;
  return filter->GetResolvedFeatureSize();
}

/// 65 x 65 points, 1/64 apart, in cells of so many intervals on a side, or rows of them in one cell.
vtkSmartPointer<vtkUnstructuredGrid> Sheet(int type, int intervals)
{
  constexpr vtkIdType n = 65;
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  for (vtkIdType i = 0; i < n * n; ++i)
  {
    points->InsertNextPoint(i % n / 64.0, i / n / 64.0, 0.0);
  }
  grid->SetPoints(points);
  std::vector<vtkIdType> ids;
  for (vtkIdType y = 0; y + 1 < n; y += intervals)
  {
    ids.clear();
    for (vtkIdType x = 0; x < n; ++x)
    {
      const vtkIdType a = y * n + x;
      if (type == VTK_TRIANGLE_STRIP)
      {
        ids.insert(ids.end(), { a + n, a });
      }
      else if (type == VTK_POLY_LINE)
      {
        ids.push_back(a);
      }
      else if (type == VTK_POLY_VERTEX)
      {
        grid->InsertNextCell(VTK_VERTEX, 1, &a);
      }
      else if (x % intervals == 0 && x + 1 < n)
      {
        // Corners, then edges, then the inside, as Lagrange cells have them.
        const vtkIdType o = intervals;
        const auto at = [&](vtkIdType i, vtkIdType j) { return a + j * n + i; };
        std::vector<vtkIdType> cell = { at(0, 0), at(o, 0), at(o, o), at(0, o) };
        for (vtkIdType i = 1; i < o; ++i)
        {
          cell.push_back(at(i, 0));
        }
        for (vtkIdType i = 1; i < o; ++i)
        {
          cell.push_back(at(o, i));
        }
        for (vtkIdType i = 1; i < o; ++i)
        {
          cell.push_back(at(i, o));
        }
        for (vtkIdType i = 1; i < o; ++i)
        {
          cell.push_back(at(0, i));
        }
        for (vtkIdType i = 0; i < (o - 1) * (o - 1); ++i)
        {
          cell.push_back(at(1 + i % (o - 1), 1 + i / (o - 1)));
        }
        grid->InsertNextCell(type, static_cast<vtkIdType>(cell.size()), cell.data());
      }
    }
    if (!ids.empty())
    {
      grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
    }
  }
  AddFlow(grid);
  return grid;
}
} // namespace

/// The same points, however long the cells are that they are in.
TEST(SteerableNoiseDataSets, SpacingIsTheDistanceOfNeighboursAndNotTheSizeOfCells)
{
  const double expected = 4.0 / 64.0;
  EXPECT_NEAR(AutomaticSize(Sheet(VTK_QUAD, 1)), expected, 1e-6);
  for (const int order : { 2, 4, 8, 16 })
  {
    EXPECT_NEAR(AutomaticSize(Sheet(VTK_LAGRANGE_QUADRILATERAL, order)), expected, 1e-6) << order;
  }
  EXPECT_NEAR(AutomaticSize(Sheet(VTK_TRIANGLE_STRIP, 1)), expected, 1e-6);
  EXPECT_NEAR(AutomaticSize(Sheet(VTK_POLY_LINE, 1)), expected, 1e-6);
  EXPECT_NEAR(AutomaticSize(Sheet(VTK_POLY_VERTEX, 1)), expected, 1e-6);
  auto loose = Sheet(VTK_QUAD, 1);
  loose->SetCells(VTK_QUAD, vtkSmartPointer<vtkCellArray>::New());
  EXPECT_NEAR(AutomaticSize(loose), expected, 1e-6) << "points without cells";
  for (const double unit : { 0x1p-100, 0x1p100 })
  {
    vtkNew<vtkPoints> scaled;
    scaled->SetDataTypeToDouble();
    for (vtkIdType i = 0; i < loose->GetNumberOfPoints(); ++i)
    {
      const double* place = loose->GetPoint(i);
      scaled->InsertNextPoint(unit * place[0], unit * (place[1] - 1.0), unit * place[2]);
    }
    auto other = Sheet(VTK_QUAD, 1);
    other->SetCells(VTK_QUAD, vtkSmartPointer<vtkCellArray>::New());
    other->SetPoints(scaled);
    EXPECT_NEAR(AutomaticSize(other) / unit, expected, 1e-6) << "points without cells";
  }

  // A polygon of 64 corners on a circle of radius 1: they are 0.098 apart.
  std::vector<double> corners;
  for (int i = 0; i < 64; ++i)
  {
    const double angle = 2.0 * vtkMath::Pi() * i / 64;
    corners.insert(corners.end(), { std::cos(angle), std::sin(angle), 0.0 });
  }
  EXPECT_NEAR(AutomaticSize(Cells(VTK_POLYGON, corners)), 0.4, 0.05);

  // Vertices too far apart are named, as any samples are.
  const Result far =
    Apply(Sheet(VTK_POLY_VERTEX, 1), [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(0.01); });
  EXPECT_EQ(far.Warnings, 1);
  EXPECT_NE(far.Text.find("0.0156 apart"), std::string::npos) << far.Text;

  // Samples in the cells are as far apart as the cells.
  auto cells = Sheet(VTK_LAGRANGE_QUADRILATERAL, 4);
  cells->GetPointData()->Initialize();
  AddFlow(cells, true);
  EXPECT_NEAR(AutomaticSize(cells), 0.25, 1e-6);
}

/// What an update keeps for the next one shows in no bit, whatever changes between them.
TEST(SteerableNoiseDataSets, WhatIsKeptIsThatOfTheInput)
{
  const auto noiseOf = [](vtkSteerableNoiseFilter* filter)
  {
    filter->Update();
    std::vector<double> noise;
    const auto append = [&](vtkDataObject* object)
    {
      auto* dataset = vtkDataSet::SafeDownCast(object);
      for (vtkDataSetAttributes* attributes :
        { static_cast<vtkDataSetAttributes*>(dataset->GetPointData()),
          static_cast<vtkDataSetAttributes*>(dataset->GetCellData()) })
      {
        vtkDataArray* array = attributes->GetArray("SteerableNoise");
        for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
        {
          noise.push_back(array->GetComponent(i, 0));
        }
      }
    };
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0)))
    {
      append(blocks->GetBlock(0));
      append(blocks->GetBlock(1));
    }
    else
    {
      append(filter->GetOutputDataObject(0));
    }
    return noise;
  };
  const auto copyOf = [](vtkDataObject* object)
  {
    auto copy = vtkSmartPointer<vtkDataObject>::Take(object->NewInstance());
    copy->DeepCopy(object);
    return copy;
  };

  // A surface, a volume, cells, and both in a composite.
  auto cells = Sheet(VTK_QUAD, 1);
  cells->GetPointData()->Initialize();
  AddFlow(cells, true);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, Sheet(VTK_QUAD, 1));
  blocks->SetBlock(1, Through<vtkAppendFilter>(Box(false)));
  const vtkSmartPointer<vtkDataObject> inputs[] = { Sheet(VTK_QUAD, 1), Through<vtkAppendFilter>(Box(false)), cells,
    blocks.Get() };
  for (const auto& input : inputs)
  {
    vtkNew<vtkSteerableNoiseFilter> filter;
    filter->SetInputDataObject(input);
    const auto expectAsFresh = [&](const char* what)
    {
      vtkNew<vtkSteerableNoiseFilter> fresh;
      fresh->KeepFieldsOff();
      fresh->SetInputDataObject(copyOf(filter->GetInputDataObject(0, 0)));
      fresh->SetSeed(filter->GetSeed());
      fresh->SetFeatureSize(filter->GetFeatureSize());
      fresh->SetFollowCurvature(filter->GetFollowCurvature());
      fresh->SetMaskUpperThreshold(filter->GetMaskUpperThreshold());
      const auto noise = noiseOf(filter);
      EXPECT_GT(noise.size(), 300u) << what;
      EXPECT_EQ(noise, noiseOf(fresh)) << input->GetClassName() << ": " << what;
    };
    expectAsFresh("first");
    filter->SetSeed(3);
    expectAsFresh("seed");
    filter->SetFeatureSize(0.3);
    expectAsFresh("size");
    filter->FollowCurvatureOff();
    expectAsFresh("straight");
    filter->FollowCurvatureOn();
    filter->SetFeatureSize(1.7);
    expectAsFresh("larger size");
    filter->SetMaskUpperThreshold(1.1);
    expectAsFresh("limit");
    filter->SetMaskUpperThreshold(0.0);
    filter->SetFeatureSize(0.0);

    // In place.
    auto* leaf = vtkPointSet::SafeDownCast(
      input.Get() == blocks.Get() ? blocks->GetBlock(0) : input.Get());
    for (vtkIdType i = 0; i < leaf->GetNumberOfPoints(); ++i)
    {
      const double* place = leaf->GetPoint(i);
      leaf->GetPoints()->SetPoint(i, place[0], place[1], place[2] + std::sin(place[0]));
    }
    leaf->GetPoints()->Modified();
    input->Modified(); // a composite does not see it
    expectAsFresh("places");
    vtkDataArray* array = input.Get() == cells.Get() ? leaf->GetCellData()->GetVectors() : leaf->GetPointData()->GetVectors();
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      array->SetComponent(i, 1, std::cos(0.3 * i));
    }
    array->Modified();
    input->Modified();
    expectAsFresh("vectors");

    // Without a new modification time nothing tells of a change: so much is kept, and can be dropped.
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      array->SetComponent(i, 1, std::cos(0.2 * i));
    }
    filter->Modified();
    const auto kept = noiseOf(filter);
    filter->KeepFieldsOff();
    filter->Modified();
    EXPECT_NE(noiseOf(filter), kept) << input->GetClassName();
  }

  // The input may go.
  vtkNew<vtkSteerableNoiseFilter> filter;
  vtkWeakPointer<vtkDataObject> gone;
  {
    auto first = Sheet(VTK_QUAD, 1);
    gone = first;
    filter->SetInputDataObject(first);
    filter->Update();
  }
  filter->SetInputDataObject(Sheet(VTK_TRIANGLE_STRIP, 1));
  filter->Update();
  EXPECT_EQ(gone, nullptr);
}

/// Points that jump about are evaluated along a curve, from 4096 on: nothing of it shows.
TEST(SteerableNoiseDataSets, OrderOfPointsDoesNotShow)
{
  const auto sheet = []
  {
    vtkNew<vtkPlaneSource> plane;
    plane->SetResolution(79, 79);
    plane->SetPoint1(20.0, 0.0, 0.0);
    plane->SetPoint2(0.0, 20.0, 0.0);
    plane->Update();
    auto* points = plane->GetOutput()->GetPoints();
    for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
    {
      const double* place = points->GetPoint(i);
      points->SetPoint(i, place[0], place[1], std::sin(0.4 * place[0]));
    }
    plane->GetOutput()->GetPointData()->Initialize();
    vtkNew<vtkAppendFilter> append;
    append->SetInputData(plane->GetOutput());
    append->Update();
    return vtkSmartPointer<vtkUnstructuredGrid>(append->GetOutput());
  };
  const auto box = []
  {
    return vtkSmartPointer<vtkUnstructuredGrid>(
      vtkUnstructuredGrid::SafeDownCast(Through<vtkAppendFilter>(MakeImage(26, 26, 26, 1.0, false))));
  };
  for (const auto& mesh : { sheet(), box() })
  {
    const vtkIdType count = mesh->GetNumberOfPoints();
    AddFlow(mesh);
    vtkNew<vtkDoubleArray> tensors;
    tensors->SetName("tensors");
    tensors->SetNumberOfComponents(6);
    vtkNew<vtkFloatArray> strength;
    strength->SetName("strength");
    for (vtkIdType i = 0; i < count; ++i)
    {
      double place[3], v[3];
      mesh->GetPoint(i, place);
      Flow(place, v);
      const double tensor[6] = { 3.0 + v[0], 2.0 + v[1], 1.0, v[2], 0.3, 0.2 * v[0] };
      tensors->InsertNextTuple(tensor);
      strength->InsertNextValue(static_cast<float>(0.5 + 0.3 * v[2]));
    }
    mesh->GetPointData()->AddArray(tensors);
    mesh->GetPointData()->AddArray(strength);

    // 7919 is prime to both numbers of points.
    const auto place = [&](vtkIdType i) { return (7919 * i) % count; };
    vtkNew<vtkUnstructuredGrid> shuffled;
    shuffled->DeepCopy(mesh);
    for (vtkIdType i = 0; i < count; ++i)
    {
      shuffled->GetPoints()->SetPoint(place(i), mesh->GetPoint(i));
      for (const char* name : { "velocity", "tensors", "strength" })
      {
        shuffled->GetPointData()->GetArray(name)->SetTuple(
          place(i), mesh->GetPointData()->GetArray(name)->GetTuple(i));
      }
    }
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
    {
      mesh->GetCellPoints(cell, ids);
      for (vtkIdType n = 0; n < ids->GetNumberOfIds(); ++n)
      {
        ids->SetId(n, place(ids->GetId(n)));
      }
      cells->InsertNextCell(ids);
    }
    shuffled->SetCells(mesh->GetCellType(0), cells);

    using Configure = std::function<void(vtkSteerableNoiseFilter*)>;
    const auto choose = [](int which, const char* name)
    {
      return [=](vtkSteerableNoiseFilter* filter)
      { filter->SetInputArrayToProcess(which, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name); };
    };
    const Configure configures[] = { choose(0, "velocity"), choose(0, "tensors"),
      [&](vtkSteerableNoiseFilter* filter)
      {
        choose(0, "velocity")(filter);
        choose(vtkSteerableNoiseFilter::STRENGTH_ARRAY, "strength")(filter);
      },
      [](vtkSteerableNoiseFilter* filter) { filter->SetDirection(vtkSteerableNoiseFilter::DIRECTION_NONE); } };
    for (const Configure& configure : configures)
    {
      vtkNew<vtkSteerableNoiseFilter> filter;
      filter->SetInputData(shuffled);
      configure(filter);
      for (const int seed : { 0, 3 }) // found, and kept
      {
        filter->SetSeed(seed);
        filter->Update();
        const std::vector<float> expected = Values(Apply(mesh,
          [&](vtkSteerableNoiseFilter* other)
          {
            configure(other);
            other->SetSeed(seed);
          }).Output);
        const std::vector<float> noise = Values(filter->GetOutputDataObject(0));
        ASSERT_EQ(noise.size(), static_cast<std::size_t>(count));
        for (vtkIdType i = 0; i < count; ++i)
        {
          ASSERT_EQ(noise[place(i)], expected[i]) << i << " of " << count << " seed " << seed;
        }
      }
    }
  }
}

/// Degrees beside metres, and thin domains: the size is a share of what a picture shows.
TEST(SteerableNoiseDataSets, AutomaticSizeFitsIntoThePicture)
{
  for (const double depth : { 0.0, 0.01, 10.0, 2000.0, 1e5 })
  {
    vtkNew<vtkRectilinearGrid> ocean;
    const int layers = depth > 0.0 ? 4 : 1;
    ocean->SetDimensions(181, 91, layers);
    vtkNew<vtkDoubleArray> x[3];
    for (int i = 0; i <= 180; ++i)
    {
      x[0]->InsertNextValue(2.0 * i);
    }
    for (int i = 0; i <= 90; ++i)
    {
      x[1]->InsertNextValue(2.0 * i - 90.0);
    }
    for (int i = 0; i < layers; ++i)
    {
      x[2]->InsertNextValue(-depth * i / std::max(layers - 1, 1));
    }
    ocean->SetXCoordinates(x[0]);
    ocean->SetYCoordinates(x[1]);
    ocean->SetZCoordinates(x[2]);
    AddFlow(ocean);
    const double size = AutomaticSize(ocean);
    EXPECT_GE(size, 7.9) << "4 samples carry it; depth " << depth;
    EXPECT_LE(size, 50.0) << "depth " << depth;
    // Where it is too small the advice is what the automatic size would be, or less.
    const Result fine =
      Apply(ocean, [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(4.0); });
    EXPECT_EQ(fine.Warnings, 1) << depth;
    const std::string words = "at least ";
    const std::size_t at = fine.Text.find(words);
    ASSERT_NE(at, std::string::npos) << fine.Text;
    EXPECT_LE(std::stod(fine.Text.substr(at + words.size())), 1.001 * size) << fine.Text;
  }
}

/// Sizes stay the same while data change a little.
TEST(SteerableNoiseDataSets, TheMapperIsOfferedTheSameAutomaticSize)
{
  // What a renderer asks with bounds alone, and with the distance of samples where they are coarse.
  for (const double height : { 1.0, 30.0, 1e5 })
  {
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(0.0, 0.0, 0.0);
    plane->SetPoint1(40.0, 0.0, 0.0);
    plane->SetPoint2(0.0, height, 0.0);
    plane->SetResolution(500, 500);
    plane->Update();
    AddFlow(plane->GetOutput());
    double bounds[6];
    plane->GetOutput()->GetBounds(bounds);
    const double size = noise::GetAutomaticFeatureSize(bounds);
    const double ofFilter = AutomaticSize(plane->GetOutput());
    EXPECT_GE(ofFilter, size) << height;
    if (height < 1e5)
    {
      EXPECT_EQ(ofFilter, size) << height;
    }
    EXPECT_LE(size, 1.2 * 0.125 * std::min(40.0, height)) << height;
  }
  const double none[6] = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };
  EXPECT_EQ(noise::GetAutomaticFeatureSize(none), 1.0);
  const double cube[6] = { 0.0, 64.0, 0.0, 64.0, 0.0, 64.0 };
  EXPECT_EQ(noise::GetAutomaticFeatureSize(cube, 2.0), 8.0);
}

TEST(SteerableNoiseDataSets, AutomaticSizesAreOnALadder)
{
  const auto size = [](double width)
  {
    auto image = MakeImage(400, 300, 1);
    image->SetSpacing(width / 399.0, width / 399.0, 1.0);
    return AutomaticSize(image);
  };
  EXPECT_EQ(size(3.395), size(3.41)) << "0.0424 and 0.0426 of a hundredth of the diagonal";
  double before = size(1.0);
  int steps = 0;
  for (int i = 1; i <= 60; ++i)
  {
    const double here = size(1.0 + 0.05 * i); // up to 4
    if (here != before)
    {
      EXPECT_NEAR(here / before, std::pow(2.0, 0.25), 1e-12);
      ++steps;
    }
    before = here;
    EXPECT_NEAR(std::log2(here / (0.01 * std::hypot(1.0, 299.0 / 399.0) * (1.0 + 0.05 * i))), 0.0,
      0.1251);
  }
  EXPECT_EQ(steps, 8);
}

namespace
{
/// The same cells with points of their own; `origin`: the point that each was.
vtkSmartPointer<vtkUnstructuredGrid> Split(vtkDataSet* dataset, std::vector<vtkIdType>& origin)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  grid->SetPoints(points);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < dataset->GetNumberOfCells(); ++cell)
  {
    dataset->GetCellPoints(cell, ids);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      origin.push_back(ids->GetId(i));
      ids->SetId(i, points->InsertNextPoint(dataset->GetPoint(ids->GetId(i))));
    }
    grid->InsertNextCell(dataset->GetCellType(cell), ids);
  }
  return grid;
}
} // namespace

/// Discontinuous Galerkin exports, STL and glTF store points once for each cell.
TEST(SteerableNoiseDataSets, PointsOfEachCellAreOnePoint)
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(30);
  sphere->SetPhiResolution(20);
  sphere->SetRadius(5.0);
  sphere->Update();
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(sphere->GetOutput()->GetPoints());
  surface->SetPolys(sphere->GetOutput()->GetPolys());
  const vtkSmartPointer<vtkDataSet> whole[] = { vtkSmartPointer<vtkDataSet>(surface.Get()),
    Through<vtkDataSetTriangleFilter>(Box(false)), Through<vtkAppendFilter>(Box(false)) };
  for (const auto& dataset : whole)
  {
    for (const bool cells : { false, true })
    {
      dataset->GetPointData()->Initialize();
      dataset->GetCellData()->Initialize();
      AddFlow(dataset, cells);
      std::vector<vtkIdType> origin;
      auto split = Split(dataset, origin);
      AddFlow(split, cells);
      const auto configure = [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(2.0); };
      const std::vector<float> expected = Values(Apply(dataset, configure).Output);
      const std::vector<float> noise = Values(Apply(split, configure).Output);
      ASSERT_FALSE(noise.empty());
      for (std::size_t i = 0; i < noise.size(); ++i)
      {
        ASSERT_NEAR(noise[i], expected[cells ? i : origin[i]], 2e-3)
          << dataset->GetClassName() << ", cells " << cells;
      }
    }
  }
}

/// The first and the last layer of an O-grid are one: streaks bend there as everywhere.
TEST(SteerableNoiseDataSets, SeamsOfClosedGridsDoNotShow)
{
  for (const bool cylinder : { false, true })
  {
    constexpr int around = 49;
    constexpr int layers = 20;
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(around, layers, 1);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkDoubleArray> flow;
    flow->SetName("velocity");
    flow->SetNumberOfComponents(3);
    for (int k = 0; k < layers; ++k)
    {
      for (int i = 0; i < around; ++i)
      {
        const double angle = 2.0 * vtkMath::Pi() * i / (around - 1);
        const double r = cylinder ? 3.0 : 2.0 + 0.2 * k;
        points->InsertNextPoint(
          r * std::cos(angle), r * std::sin(angle), cylinder ? 0.2 * k : 0.0);
        flow->InsertNextTuple3(-std::sin(angle), std::cos(angle), cylinder ? 0.3 : 0.0);
      }
    }
    grid->SetPoints(points);
    grid->GetPointData()->SetVectors(flow);
    const std::vector<float> noise =
      Values(Apply(grid, [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(1.0); }).Output);
    double squares = 0.0;
    for (int k = 0; k < layers; ++k)
    {
      squares += std::pow(noise[k * around] - noise[k * around + around - 1], 2.0) / layers;
    }
    EXPECT_LT(std::sqrt(squares), 1e-4) << (cylinder ? "cylinder" : "O-grid");
    std::printf("seam of a closed grid: rms %g\n", std::sqrt(squares));
  }
}

TEST(SteerableNoiseDataSets, CellsGoOnAroundAClosedGrid)
{
  // The same rings of cells, cut open at two places; flow that bends more and more along the way around.
  constexpr int around = 48;
  constexpr int layers = 12;
  const auto run = [&](int cut)
  {
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(around + 1, layers + 1, 1);
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (int k = 0; k <= layers; ++k)
    {
      for (int i = 0; i <= around; ++i)
      {
        const double angle = 2.0 * vtkMath::Pi() * (i + cut) / around;
        const double r = 2.0 + 0.2 * k;
        points->InsertNextPoint(r * std::cos(angle), r * std::sin(angle), 0.0);
      }
    }
    grid->SetPoints(points);
    vtkNew<vtkDoubleArray> flow;
    flow->SetName("velocity");
    flow->SetNumberOfComponents(3);
    for (int cell = 0; cell < around * layers; ++cell)
    {
      const double angle = 2.0 * vtkMath::Pi() * (cell % around + cut + 0.5) / around;
      const double turned = angle + 0.5 * std::sin(angle);
      flow->InsertNextTuple3(-std::sin(turned), std::cos(turned), 0.0);
    }
    grid->GetCellData()->SetVectors(flow);
    return Values(Apply(grid, [](vtkSteerableNoiseFilter* f) { f->SetFeatureSize(1.2); }).Output);
  };
  const std::vector<float> whole = run(0);
  const std::vector<float> turned = run(around / 2);
  double squares = 0.0;
  for (int cell = 0; cell < around * layers; ++cell)
  {
    const int same = cell / around * around + (cell + around / 2) % around;
    squares += std::pow(whole[same] - turned[cell], 2.0) / (around * layers);
  }
  std::printf("cells of a closed grid, cut elsewhere: rms %g\n", std::sqrt(squares));
  EXPECT_LT(std::sqrt(squares), 1e-4);
}

/// The same two components in the x-y, x-z and y-z planes: those of vectors with a third that is 0.
TEST(SteerableNoiseDataSets, TwoComponentsLieInThePlaneOfTheData)
{
  const int sizes[3][3] = { { 14, 12, 1 }, { 14, 1, 12 }, { 1, 14, 12 } };
  for (const auto& size : sizes)
  {
    for (const bool structured : { true, false })
    {
      auto image = MakeImage(size[0], size[1], size[2]);
      vtkSmartPointer<vtkDataSet> grid = structured ? Through<vtkImageDataToPointSet>(image)
                                                    : Through<vtkAppendFilter>(image);
      const int a = size[0] > 1 ? 0 : 1;
      const int b = size[2] > 1 ? 2 : 1;
      vtkNew<vtkDoubleArray> two;
      two->SetName("two");
      two->SetNumberOfComponents(2);
      vtkDataArray* three = grid->GetPointData()->GetVectors();
      for (vtkIdType i = 0; i < three->GetNumberOfTuples(); ++i)
      {
        three->SetComponent(i, 3 - a - b, 0.0);
        two->InsertNextTuple2(three->GetComponent(i, a), three->GetComponent(i, b));
      }
      grid->GetPointData()->AddArray(two);
      const auto noise = [&](const char* name)
      {
        return Values(Apply(grid,
          [&](vtkSteerableNoiseFilter* f)
          {
            f->SetFeatureSize(4.0);
            f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name);
          }).Output);
      };
      EXPECT_LT(LargestDifference(noise("two"), noise(three->GetName())), 1e-5)
        << a << b << " structured " << structured;
    }
  }
}

TEST(SteerableNoiseDataSets, VectorsThatLeaveThePlaneHaveOneLength)
{
  // In the plane 1 everywhere, out of it 0 to 3: flat images, in every plane, mask and grow as surfaces do.
  const double along = 1.0 / 36.0;
  for (const int flat : { 0, 1, 2 })
  {
    int dims[3] = { 9, 9, 9 };
    dims[flat] = 1;
    const auto image = MakeImage(dims[0], dims[1], dims[2]);
    const vtkIdType count = image->GetNumberOfPoints();
    vtkDataArray* vectors = image->GetPointData()->GetVectors();
    for (vtkIdType i = 0; i < count; ++i)
    {
      double v[3] = { 0.0, 0.0, 0.0 };
      v[(flat + 1) % 3] = 0.6;
      v[(flat + 2) % 3] = 0.8;
      v[flat] = 3.0 * static_cast<double>(i) / static_cast<double>(count - 1);
      vectors->SetTuple(i, v);
    }
    for (const bool surface : { false, true })
    {
      vtkSmartPointer<vtkDataSet> dataset = image;
      if (surface)
      {
        dataset = Through<vtkAppendFilter>(image);
      }
      vtkIdType stagnant = 0;
      const auto output = Apply(dataset,
        [&](vtkSteerableNoiseFilter* filter)
        {
          filter->SetFeatureSize(4.0);
          filter->FollowCurvatureOff();
          filter->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE);
          filter->SetMaskThreshold(2.0);
          filter->OutputMetricOn();
          filter->Update();
          stagnant = filter->GetNumberOfStagnantSamples();
        }).Output;
      const std::vector<float> noise = Values(output);
      vtkDataArray* metrics =
        vtkDataSet::SafeDownCast(output)->GetPointData()->GetArray("Metric");
      vtkIdType expected = 0;
      for (vtkIdType i = 0; i < count; ++i)
      {
        const double length = std::hypot(1.0, vectors->GetComponent(i, flat));
        expected += length <= 2.0;
        EXPECT_EQ(noise[i] == 0.0f, length <= 2.0) << flat << surface << " " << length;
        double m[6];
        metrics->GetTuple(i, m);
        Eigen::Matrix3d metric;
        metric << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
        Eigen::Vector3d u = Eigen::Vector3d::Zero();
        u[(flat + 1) % 3] = 0.6;
        u[(flat + 2) % 3] = 0.8;
        // The longest, of which the reference is one, has the whole strength.
        const double strength = length / std::sqrt(10.0);
        EXPECT_NEAR(u.dot(metric * u), 1.0 + strength * (along - 1.0), 1e-5) << flat << surface;
      }
      EXPECT_EQ(stagnant, expected);
      EXPECT_GT(expected, 10);
    }
  }
}

TEST(SteerableNoiseDataSets, FillValuesAreLeftOut)
{
  // A flow with a disc of missing values: what is outside is as if they were NaN.
  const auto disc = [](vtkDataSet* dataset, vtkIdType i)
  {
    double p[3];
    dataset->GetPoint(i, p);
    return std::hypot(p[0] - 20.0, p[1] - 20.0) < 9.0;
  };
  const auto fill = [&](vtkDataSet* dataset, double u, double v)
  {
    vtkIdType count = 0;
    vtkDataArray* vectors = dataset->GetPointData()->GetVectors();
    for (vtkIdType i = 0; i < dataset->GetNumberOfPoints(); ++i)
    {
      if (disc(dataset, i))
      {
        vectors->SetTuple3(i, u, v, 0.0);
        ++count;
      }
    }
    return count;
  };
  for (const bool unstructured : { false, true })
  {
    const auto make = [&]() -> vtkSmartPointer<vtkDataSet>
    {
      auto image = MakeImage(41, 41, 1);
      vtkSmartPointer<vtkDataSet> grid = Through<vtkAppendFilter>(image);
      return unstructured ? grid : vtkSmartPointer<vtkDataSet>(image);
    };
    const auto configure = [](vtkSteerableNoiseFilter* filter)
    {
      filter->SetFeatureSize(5.0);
      filter->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE);
    };
    const auto missing = make();
    const vtkIdType count = fill(missing, std::nan(""), std::nan(""));
    ASSERT_GT(count, 100);
    const std::vector<float> expected = Values(Apply(missing, configure).Output);
    const double values[][2] = { { -30000, -30000 }, { 1e20, 1e20 }, { 9.96921e36, 0.5 }, { -9999, 0 },
      { 99, 99 } };
    for (const auto& value : values)
    {
      const auto input = make();
      fill(input, value[0], value[1]);
      vtkIdType found = 0;
      const Result result = Apply(input,
        [&](vtkSteerableNoiseFilter* filter)
        {
          configure(filter);
          filter->Update();
          found = filter->GetNumberOfOverlongSamples();
          EXPECT_EQ(filter->GetNumberOfDegenerateSamples(), 0);
        });
      EXPECT_EQ(found, count) << value[0];
      EXPECT_EQ(result.Warnings, 1) << value[0];
      std::ostringstream name;
      name << count << " samples hold " << value[0] << ",";
      EXPECT_NE(result.Text.find(name.str()), std::string::npos) << result.Text;
      const std::vector<float> noise = Values(result.Output);
      for (std::size_t i = 0; i < noise.size(); ++i)
      {
        ASSERT_EQ(noise[i], disc(input, static_cast<vtkIdType>(i)) ? 0.0f : expected[i]) << value[0];
      }
    }
  }
  // Interpolated ones go with them, and a block of nothing else does not change the rule.
  auto image = MakeImage(41, 41, 1);
  fill(image, -30000, -30000);
  auto land = MakeImage(9, 9, 1);
  land->SetOrigin(12.0, 12.0, 0.0);
  land->GetPointData()->GetVectors()->Fill(-30000);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, land);
  blocks->SetBlock(1, image);
  for (vtkDataObject* input : { static_cast<vtkDataObject*>(image.Get()),
         static_cast<vtkDataObject*>(blocks.Get()) })
  {
    vtkNew<vtkSteerableNoiseFilter> filter;
    auto messages = Listen(filter);
    filter->SetInputDataObject(input);
    filter->SetFeatureSize(5.0);
    filter->SetStrengthMode(vtkSteerableNoiseFilter::MAGNITUDE);
    filter->SetMagnification(input == image.Get() ? 4 : 1);
    filter->OutputMetricOn();
    filter->Update();
    EXPECT_NE(messages->Text.find("hold -30000"), std::string::npos) << messages->Text;
    auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    if (!output)
    {
      output = vtkDataSet::SafeDownCast(
        vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetBlock(1));
      EXPECT_GT(filter->GetNumberOfOverlongSamples(), 81);
    }
    // In the open the strength is that of flow of at most 3.
    vtkDataArray* metrics = output->GetPointData()->GetArray("Metric");
    double m[6];
    metrics->GetTuple(0, m);
    EXPECT_GT(m[0] + m[1], 2.4);
    vtkDataArray* vectors = output->GetPointData()->GetVectors();
    const std::vector<float> noise = Values(output);
    for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
    {
      double v[3];
      vectors->GetTuple(i, v);
      if (vtkMath::Norm(v) > 4.0)
      {
        ASSERT_EQ(noise[static_cast<std::size_t>(i)], 0.0f) << vtkMath::Norm(v);
      }
    }
  }
}

TEST(SteerableNoiseDataSets, WhatStandsOutIsNotAlwaysAFillValue)
{
  struct Case
  {
    const char* Name;
    std::function<double(int)> Length; // of sample i of 1600
    double Upper;
    vtkIdType LeftOut;
    const char* Says;
  };
  const auto last = [](double value)
  { return [value](int i) { return i >= 1590 ? value : 1.0 + 0.001 * i; }; };
  const Case cases[] = { { "98", last(98.0), 0.0, 0, nullptr },
    { "16 times", last(16.2 * 2.589), 0.0, 0, nullptr },
    { "99", last(99.0), 0.0, 10, "10 samples hold 99," },
    { "by hand", last(98.0), 50.0, 10, nullptr },
    { "none by hand", last(1e20), 1e300, 0, nullptr },
    { "two of them", [](int i) { return i < 5 ? 1e20 : i < 12 ? -9999.0 : 2.0; }, 0.0, 12, "hold 1e+20" },
    { "a decade a hundred samples", [](int i) { return std::pow(10.0, i / 100.0 - 8.0); }, 0.0, 0,
      nullptr },
    { "a jet beside rounding", [](int i) { return i < 800 ? 1e-14 * i : 0.5 * i; }, 0.0, 0,
      "800 vectors are far longer" },
    { "smeared", [](int i) { return i > 1590 ? 3000.0 * (i - 1590) : 2.0; }, 0.0, 0,
      "set MaskUpperThreshold 4." } };
  for (const Case& c : cases)
  {
    auto image = MakeImage(40, 40, 1);
    vtkDataArray* vectors = image->GetPointData()->GetVectors();
    for (int i = 0; i < 1600; ++i)
    {
      vectors->SetTuple3(i, c.Length(i), 0.0, 0.0);
    }
    vtkIdType leftOut = -1;
    const Result result = Apply(image,
      [&](vtkSteerableNoiseFilter* filter)
      {
        filter->SetFeatureSize(5.0);
        filter->SetMaskUpperThreshold(c.Upper);
        filter->SetMaskThreshold(1e-30); // some are 0
        filter->Update();
        leftOut = filter->GetNumberOfOverlongSamples();
      });
    EXPECT_EQ(leftOut, c.LeftOut) << c.Name;
    EXPECT_EQ(result.Warnings, c.Says ? 1 : 0) << c.Name << result.Text;
    EXPECT_NE(result.Text.find(c.Says ? c.Says : ""), std::string::npos) << c.Name << result.Text;
    const std::vector<float> noise = Values(result.Output);
    EXPECT_GE(std::count(noise.begin(), noise.end(), 0.0f), c.LeftOut) << c.Name;
  }
}

TEST(SteerableNoiseDataSets, CurvedCellsHaveANormalAtEachPoint)
{
  // A saddle of degree 2, which all of these cells hold exactly.
  const auto place = [](double r, double s)
  { return Eigen::Vector3d(r, s, 0.9 * r * r + 0.4 * r * s - 0.7 * s * s); };
  const auto normal = [](double r, double s)
  { return Eigen::Vector3d(-1.8 * r - 0.4 * s, -0.4 * r + 1.4 * s, 1.0).normalized(); };
  const std::pair<int, int> types[] = { { VTK_QUADRATIC_TRIANGLE, 6 },
    { VTK_BIQUADRATIC_TRIANGLE, 7 }, { VTK_QUADRATIC_QUAD, 8 }, { VTK_BIQUADRATIC_QUAD, 9 },
    { VTK_LAGRANGE_TRIANGLE, 6 }, { VTK_LAGRANGE_TRIANGLE, 10 }, { VTK_LAGRANGE_QUADRILATERAL, 9 },
    { VTK_LAGRANGE_QUADRILATERAL, 25 } };
  for (const auto& [type, count] : types)
  {
    // Where its points are, as VTK has it.
    const auto any = Cells(type, std::vector<double>(3 * static_cast<std::size_t>(count), 1.0));
    vtkCell* kind = any->GetCell(0);
    const double* parameters = kind->GetParametricCoords();
    std::vector<double> coordinates;
    for (int i = 0; i < count; ++i)
    {
      const Eigen::Vector3d p = place(parameters[3 * i], parameters[3 * i + 1]);
      coordinates.insert(coordinates.end(), p.data(), p.data() + 3);
    }
    double center[3];
    kind->GetParametricCenter(center);
    const auto grid = Cells(type, coordinates);
    for (const bool cells : { false, true })
    {
      if (cells)
      {
        grid->GetPointData()->Initialize();
        AddFlow(grid, true);
      }
      const Result result = Apply(grid,
        [](vtkSteerableNoiseFilter* filter)
        {
          filter->SetFeatureSize(2.0);
          filter->FollowCurvatureOff();
          filter->OutputMetricOn();
        });
      auto* output = vtkDataSet::SafeDownCast(result.Output);
      vtkDataArray* metrics =
        cells ? output->GetCellData()->GetArray("Metric") : output->GetPointData()->GetArray("Metric");
      ASSERT_NE(metrics, nullptr);
      for (vtkIdType i = 0; i < metrics->GetNumberOfTuples(); ++i)
      {
        double m[6];
        metrics->GetTuple(i, m);
        Eigen::Matrix3d metric;
        metric << m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2];
        // 0.5 lies along the normal, 1/36 along the flow, and the rest of 3.2 across.
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(metric);
        EXPECT_NEAR(axes.eigenvalues()[1], 0.5, 1e-5);
        const Eigen::Vector3d expected = cells ? normal(center[0], center[1])
                                               : normal(parameters[3 * i], parameters[3 * i + 1]);
        const double off = axes.eigenvectors().col(1).cross(expected).norm();
        EXPECT_LT(off, 2e-4) << "type " << type << " of " << count << (cells ? " cell" : " point")
                             << i;
      }
    }
  }
}

TEST(SteerableNoiseDataSets, ACreaseKeepsItsNormals)
{
  // The faces of a cube, and each of them alone.
  vtkNew<vtkUnstructuredGrid> cube;
  vtkNew<vtkPoints> points;
  cube->SetPoints(points);
  const auto configure = [](vtkSteerableNoiseFilter* f)
  {
    f->SetFeatureSize(1.0);
    f->FollowCurvatureOff();
  };
  std::vector<float> expected;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double side : { 0.0, 2.0 })
    {
      std::vector<double> corners;
      for (const auto& corner : { std::pair(0.0, 0.0), { 2.0, 0.0 }, { 2.0, 2.0 }, { 0.0, 2.0 } })
      {
        double p[3];
        p[axis] = side;
        p[(axis + 1) % 3] = corner.first;
        p[(axis + 2) % 3] = corner.second;
        corners.insert(corners.end(), p, p + 3);
      }
      std::vector<vtkIdType> ids;
      for (std::size_t i = 0; i < 4; ++i)
      {
        ids.push_back(points->InsertNextPoint(corners.data() + 3 * i));
      }
      cube->InsertNextCell(VTK_QUAD, 4, ids.data());
      const std::vector<float> face = Values(Apply(Cells(VTK_QUAD, corners), configure).Output);
      expected.insert(expected.end(), face.begin(), face.end());
    }
  }
  AddFlow(cube);
  EXPECT_LT(LargestDifference(Values(Apply(cube, configure).Output), expected), 1e-5);
}

TEST(SteerableNoiseDataSets, NormalsTextureCoordinatesAndColoursAreNeverTaken)
{
  vtkNew<vtkSphereSource> sphere; // has Normals and nothing else
  sphere->Update();
  const Result alone = Apply(sphere->GetOutput());
  EXPECT_EQ(alone.Errors > 0, true) << "normals were taken for a flow";
  vtkNew<vtkPolyData> colored;
  colored->ShallowCopy(sphere->GetOutput());
  vtkNew<vtkUnsignedCharArray> rgb;
  rgb->SetName("rgb");
  rgb->SetNumberOfComponents(3);
  rgb->SetNumberOfTuples(colored->GetNumberOfPoints());
  rgb->Fill(7);
  colored->GetPointData()->AddArray(rgb);
  EXPECT_GT(Apply(colored).Errors, 0);
  for (const char* name : { "Normals", "rgb" })
  {
    const Result chosen = Apply(colored,
      [&](vtkSteerableNoiseFilter* filter)
      { filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name); });
    EXPECT_GT(chosen.Errors, 0) << name;
    EXPECT_NE(chosen.Text.find(name), std::string::npos) << chosen.Text;
  }
}

// ---- bad input ------------------------------------------------------------------------------------

namespace
{
enum Expected
{
  Fine,    // finite noise, no error
  Warned,  // finite noise and one warning
  Failed,  // a clear error
  PassedOn // no error, no noise, input kept
};

struct Case
{
  std::string Name;
  std::function<vtkSmartPointer<vtkDataObject>()> Make;
  std::function<void(vtkSteerableNoiseFilter*)> Configure;
  Expected Outcome;
};

void PrintTo(const Case& c, std::ostream* os)
{
  *os << c.Name;
}

vtkSmartPointer<vtkImageData> WithArray(int components, const char* name = "velocity")
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(12, 10, 8);
  AddFlow(image, false, name, components);
  return image;
}

using F = vtkSteerableNoiseFilter*;
using Data = vtkSmartPointer<vtkDataObject>;
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinite = std::numeric_limits<double>::infinity();

Data Image()
{
  return MakeImage(12, 10, 8);
}

std::function<void(F)> Named(const char* name)
{
  return [name](F f) {
    f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, name);
  };
}

/// Collects cases: add(name, input, outcome, properties).
auto AddTo(std::vector<Case>& cases)
{
  return [&cases](const std::string& name, std::function<Data()> make, Expected outcome,
           std::function<void(F)> configure = {})
  { cases.push_back({ name, std::move(make), std::move(configure), outcome }); };
}

/// Each property out of its range is clamped, and the noise stays finite.
void AddClampedProperties(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  const std::pair<const char*, std::function<void(F)>> clamped[] = {
    { "StreakLengthZero", [](F f) { f->SetStreakLength(0.0); } },
    { "StreakLengthHuge", [](F f) { f->SetStreakLength(1e9); } },
    { "QualityNegative", [](F f) { f->SetQuality(-3); } },
    { "QualityHuge", [](F f) { f->SetQuality(1000); } },
    { "MinimumEigenvalueZero", [](F f) { f->SetMinimumEigenvalue(0.0); } },
    { "MinimumEigenvalueHuge", [](F f) { f->SetMinimumEigenvalue(9.0); } },
    { "EigenvalueSumSmall", [](F f) { f->SetEigenvalueSum(0.0); } },
    { "EigenvalueSumHuge", [](F f) { f->SetEigenvalueSum(1e9); } },
    { "StrengthNegative", [](F f) { f->SetStrength(-1.0); } },
    { "StrengthHuge", [](F f) { f->SetStrength(7.0); } },
    { "StrengthModeWild", [](F f) { f->SetStrengthMode(99); } },
    { "ReferenceMagnitudeNegative",
      [](F f)
      {
        f->SetStrengthMode(1);
        f->SetReferenceMagnitude(-2.0);
      } },
    { "NormalizationWild", [](F f) { f->SetNormalization(-5); } },
    { "BasisWild", [](F f) { f->SetBasis(99); } },
    { "DensityZero",
      [](F f)
      {
        f->SetBasis(2);
        f->SetDensity(0.0);
      } },
    { "PhaseHuge", [](F f) { f->SetPhase(1e18); } },
    { "PhaseNegative", [](F f) { f->SetPhase(-12.3); } },
    { "PhaseNaN", [](F f) { f->SetPhase(NotANumber); } },
    { "TimePeriodNaN", [](F f) { f->SetTimePeriod(NotANumber); } },
    { "SpeedHuge",
      [](F f)
      {
        f->SetPhase(0.3);
        f->SetSpeed(1e9);
      } },
    { "TimePeriodNegative", [](F f) { f->SetTimePeriod(-1.0); } },
    { "OctavesZero", [](F f) { f->SetOctaves(0); } },
    { "LacunarityZero", [](F f) { f->SetLacunarity(0.0); } },
    { "GainHuge", [](F f) { f->SetGain(100.0); } },
    { "FadeWild", [](F f) { f->SetFade(12); } },
    { "FalloffWild", [](F f) { f->SetFalloff(-1); } },
    { "LatticeWild", [](F f) { f->SetLattice(77); } },
    { "GradientSetWild", [](F f) { f->SetGradientSet(77); } },
    { "MagnificationZero", [](F f) { f->SetMagnification(0); } },
    { "MaskThresholdNegative", [](F f) { f->SetMaskThreshold(-1.0); } },
    { "SeedNegative", [](F f) { f->SetSeed(-2147483647); } },
    { "PeriodOne", [](F f) { f->SetPeriod(1, 1, 1); } },
    { "FeatureSizeLargerThanTheData", [](F f) { f->SetFeatureSize(1e12); } },
  };
  for (const auto& entry : clamped)
  {
    add(entry.first, Image, Fine, entry.second);
  }
}

/// What no clamp can mend: NaN passes one, and some values contradict each other.
void AddRefusedProperties(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  add("FeatureSizeNegative", Image, Failed, [](F f) { f->SetFeatureSize(-1.0); });
  add("FeatureSizeTiny", Image, Warned, [](F f) { f->SetFeatureSize(1e-9); });
  add("OctavesHuge", Image, Warned, [](F f) { f->SetOctaves(1000); });
  // NaN passes a clamp.
  const std::pair<const char*, void (vtkSteerableNoiseFilter::*)(double)> numbers[] = {
    { "FeatureSizeNaN", &vtkSteerableNoiseFilter::SetFeatureSize },
    { "StreakLengthNaN", &vtkSteerableNoiseFilter::SetStreakLength },
    { "MinimumEigenvalueNaN", &vtkSteerableNoiseFilter::SetMinimumEigenvalue },
    { "EigenvalueSumNaN", &vtkSteerableNoiseFilter::SetEigenvalueSum },
    { "StrengthNaN", &vtkSteerableNoiseFilter::SetStrength },
    { "ReferenceMagnitudeNaN", &vtkSteerableNoiseFilter::SetReferenceMagnitude },
    { "DensityNaN", &vtkSteerableNoiseFilter::SetDensity },
    { "SpeedNaN", &vtkSteerableNoiseFilter::SetSpeed },
    { "LacunarityNaN", &vtkSteerableNoiseFilter::SetLacunarity },
    { "GainNaN", &vtkSteerableNoiseFilter::SetGain },
    { "MaskThresholdNaN", &vtkSteerableNoiseFilter::SetMaskThreshold },
  };
  for (const auto& entry : numbers)
  {
    add(entry.first, Image, Failed,
      [=](F f)
      {
        f->SetStrengthMode(1);
        (f->*entry.second)(NotANumber);
      });
  }
  add("PeriodNegative", Image, Failed, [](F f) { f->SetPeriod(-3, 0, 0); });
  add("PeriodHuge", Image, Failed, [](F f) { f->SetPeriod(2147483647, 2147483647, 2147483647); });
  add("PeriodSimplicial", Image, Failed,
    [](F f)
    {
      f->SetPeriod(3, 0, 0);
      f->SetLattice(2);
    });
  add("PeriodFractionalLacunarity", Image, Failed,
    [](F f)
    {
      f->SetPeriod(3, 0, 0);
      f->SetOctaves(2);
      f->SetLacunarity(2.5);
    });
  add("WeightSumWithLargeTrace", Image, Failed,
    [](F f)
    {
      f->SetNormalization(1);
      f->SetEigenvalueSum(6.0);
    });
  add("NoResultName", Image, Failed, [](F f) { f->SetResultArrayName(nullptr); });
  add("EmptyResultName", Image, Failed, [](F f) { f->SetResultArrayName(""); });
}

/// Arrays that are missing, or of any number of components.
void AddWrongArrays(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  add("MissingArray", Image, Failed, Named("nothing"));
  for (const int components : { 1, 5, 7, 8, 10 })
  {
    add(
      std::to_string(components) + "Components",
      [=] { return Data(WithArray(components)); }, Failed,
      Named("velocity"));
  }
  for (const int components : { 2, 4, 6, 9 })
  {
    add(
      std::to_string(components) + "Components",
      [=] { return Data(WithArray(components)); }, Fine,
      Named("velocity"));
  }
  add(
    "NoArrays",
    []
    {
      auto bare = vtkSmartPointer<vtkImageData>::New();
      bare->SetDimensions(5, 5, 5);
      return Data(bare);
    },
    Failed);
  add(
    "StringArray",
    []
    {
      auto bare = vtkSmartPointer<vtkImageData>::New();
      bare->SetDimensions(2, 1, 1);
      vtkNew<vtkStringArray> strings;
      strings->SetName("text");
      strings->SetNumberOfComponents(3);
      strings->SetNumberOfTuples(2);
      bare->GetPointData()->AddArray(strings);
      return Data(bare);
    },
    Failed, Named("text"));
}

/// Arrays of zeros, NaN and such; names that are unusual.
void AddStrangeValues(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  const auto filled = [](double value)
  {
    return [value]
    {
      auto data = MakeImage(12, 10, 8);
      data->GetPointData()->GetVectors()->Fill(value);
      return Data(data);
    };
  };
  add("AllZero", filled(0.0), Warned);
  add("AllNaN", filled(NotANumber), Warned);
  add("AllInfinite", filled(Infinite), Warned);
  add("Denormal", filled(1e-42), Fine);
  add("AllZeroByMagnitude", filled(0.0), Warned, [](F f) { f->SetStrengthMode(1); });
  add(
    "NaNTensors",
    [=]
    {
      auto data = WithArray(6);
      data->GetPointData()->GetArray(0)->Fill(NotANumber);
      return Data(data);
    },
    Warned, Named("velocity"));
  add(
    "ArrayNamedWithSpaces", [] { return Data(WithArray(3, "a b, c")); },
    Fine, Named("a b, c"));
  add("ResultNameOfTheInput", Image, Fine, [](F f) { f->SetResultArrayName("SteerableNoise"); });
}

/// More points than memory holds, and arrays that do not fit: refused before anything is allocated.
void AddHugeData(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  for (const int tuples : { 0, 3 })
  {
    add(
      "TwoToThe31PointsWith" + std::to_string(tuples) + "Tuples",
      [=]
      {
        auto huge = vtkSmartPointer<vtkImageData>::New();
        huge->SetDimensions(65536, 32769, 1);
        vtkNew<vtkFloatArray> short3;
        short3->SetName("velocity");
        short3->SetNumberOfComponents(3);
        short3->SetNumberOfTuples(tuples);
        short3->Fill(1.0);
        huge->GetPointData()->SetVectors(short3);
        return Data(huge);
      },
      Failed);
  }
}

/// Nothing to do is no error.
void AddEmptyData(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  add(
    "EmptyImage",
    [] { return Data(vtkSmartPointer<vtkImageData>::New()); }, PassedOn);
  add(
    "EmptyPolyData",
    [] { return Data(vtkSmartPointer<vtkPolyData>::New()); }, PassedOn);
  add(
    "EmptyUnstructured",
    [] { return Data(vtkSmartPointer<vtkUnstructuredGrid>::New()); },
    PassedOn);
  add(
    "EmptyMultiBlock",
    [] { return Data(vtkSmartPointer<vtkMultiBlockDataSet>::New()); },
    PassedOn);
}

/// Grids without thickness, and of extreme places and spacings.
void AddDegenerateGrids(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  const auto sized = [](int nx, int ny, int nz)
  { return [=] { return Data(MakeImage(nx, ny, nz)); }; };
  add("OnePoint", sized(1, 1, 1), Fine);
  add("TwoPoints", sized(2, 1, 1), Fine);
  add("LineAlongY", sized(1, 50, 1), Fine);
  add("LineAlongZ", sized(1, 1, 50), Fine);
  add("TwoByTwoByTwo", sized(2, 2, 2), Fine);
  add(
    "TinySpacing", [] { return Data(MakeImage(12, 10, 8, 1e-200)); },
    Fine);
  add(
    "HugeSpacing", [] { return Data(MakeImage(12, 10, 8, 1e200)); },
    Fine);
  add(
    "HugeOrigin",
    []
    {
      auto data = MakeImage(12, 10, 8);
      data->SetOrigin(1e15, -1e15, 1e15);
      return Data(data);
    },
    Fine);
  add(
    "NaNOrigin",
    [=]
    {
      auto data = MakeImage(12, 10, 8);
      data->SetOrigin(NotANumber, 0, 0);
      return Data(data);
    },
    Failed);
}

/// Cells without size, points that are nowhere, or alone.
void AddDegenerateCells(std::vector<Case>& cases)
{
  const auto add = AddTo(cases);
  add(
    "NaNPoint",
    [=]
    {
      return Data(
        Cells(VTK_TETRA, { 0, 0, 0, 1, 0, 0, 0, 1, 0, NotANumber, 0, 1 }));
    },
    Warned);
  add(
    "InfinitePoint",
    [=]
    {
      return Data(
        Cells(VTK_TETRA, { 0, 0, 0, 1, 0, 0, 0, 1, 0, Infinite, 0, 1 }));
    },
    Warned);
  add(
    "FlatTetrahedron",
    []
    {
      return Data(
        Cells(VTK_TETRA, { 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 }));
    },
    Fine);
  add(
    "DegenerateTriangle",
    [] {
      return Data(Cells(VTK_TRIANGLE, { 0, 0, 0, 1, 0, 0, 2, 0, 0 }));
    },
    Fine);
  add(
    "CoincidentPoints",
    []
    {
      return Data(
        Cells(VTK_TETRA, { 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1 }));
    },
    Fine);
  add(
    "OnlyVertices",
    [] {
      return Data(Cells(VTK_POLY_VERTEX, { 0, 0, 0, 1, 2, 3, 4, 5, 6 }));
    },
    Fine);
  add(
    "OnlyLines",
    [] {
      return Data(Cells(VTK_POLY_LINE, { 0, 0, 0, 1, 2, 3, 4, 5, 6 }));
    },
    Fine);
  add(
    "PointsWithoutCells",
    []
    {
      vtkNew<vtkPoints> points;
      points->InsertNextPoint(1, 2, 3);
      points->InsertNextPoint(2, 2, 3);
      auto data = vtkSmartPointer<vtkPolyData>::New();
      data->SetPoints(points);
      AddFlow(data);
      return Data(data);
    },
    Fine);
  add(
    "VectorAlongTheNormal",
    []
    {
      vtkNew<vtkPlaneSource> plane;
      plane->SetResolution(5, 5);
      plane->Update();
      auto data = vtkSmartPointer<vtkPolyData>::New();
      data->ShallowCopy(plane->GetOutput());
      vtkNew<vtkFloatArray> v;
      v->SetName("v");
      v->SetNumberOfComponents(3);
      for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
      {
        v->InsertNextTuple3(0, 0, 1);
      }
      data->GetPointData()->SetVectors(v);
      return Data(data);
    },
    Warned);
}

std::vector<Case> BadInput()
{
  std::vector<Case> cases;
  for (const auto add : { AddClampedProperties, AddRefusedProperties, AddWrongArrays,
         AddStrangeValues, AddHugeData, AddEmptyData, AddDegenerateGrids, AddDegenerateCells })
  {
    add(cases);
  }
  return cases;
}

class SteerableNoiseBadInput : public testing::TestWithParam<Case>
{
};
} // namespace

TEST_P(SteerableNoiseBadInput, GivesWhatItsCaseSays)
{
  const Case& c = GetParam();
  auto input = c.Make();
  const Result result = Apply(input, c.Configure);
  const std::vector<float> values = Values(result.Output);
  switch (c.Outcome)
  {
    case Fine:
      EXPECT_EQ(result.Errors, 0) << result.Text;
      EXPECT_TRUE(AllFinite(values));
      break;
    case Warned:
      EXPECT_EQ(result.Errors, 0) << result.Text;
      EXPECT_EQ(result.Warnings, 1) << result.Text;
      EXPECT_TRUE(AllFinite(values));
      break;
    case Failed:
      EXPECT_GT(result.Errors, 0);
      EXPECT_GT(result.Text.size(), 20u) << "the error says what to do";
      EXPECT_TRUE(values.empty());
      break;
    case PassedOn:
      EXPECT_EQ(result.Errors, 0) << result.Text;
      EXPECT_TRUE(values.empty());
      EXPECT_TRUE(result.Output->IsA(input->GetClassName()));
      break;
  }
  // Nothing is lost: arrays of the input are still in the output.
  auto* before = vtkDataSet::SafeDownCast(input);
  auto* after = vtkDataSet::SafeDownCast(result.Output);
  if (before && after && c.Outcome != Failed)
  {
    for (int i = 0; i < before->GetPointData()->GetNumberOfArrays(); ++i)
    {
      EXPECT_NE(
        after->GetPointData()->GetAbstractArray(before->GetPointData()->GetArrayName(i)), nullptr);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, SteerableNoiseBadInput, testing::ValuesIn(BadInput()),
  [](const testing::TestParamInfo<Case>& info) { return info.param.Name; });

/// Points in general position: no two at one place, no four in one plane.
std::vector<double> Scatter(std::size_t count)
{
  std::vector<double> coordinates;
  for (std::size_t i = 1; i <= count; ++i)
  {
    for (const double step : { 0.7548776662, 0.5698402910, 0.8191725134 })
    {
      coordinates.push_back(4.0 * std::fmod(step * i, 1.0));
    }
  }
  return coordinates;
}

TEST(SteerableNoiseDataSets, EveryTypeOfCellGetsNoise)
{
  // Higher-order cells of any order have as many points as are given: here the least there are.
  const std::map<int, std::size_t> sizes = { { VTK_LAGRANGE_CURVE, 3 },
    { VTK_LAGRANGE_TRIANGLE, 6 }, { VTK_LAGRANGE_QUADRILATERAL, 9 },
    { VTK_LAGRANGE_TETRAHEDRON, 10 }, { VTK_LAGRANGE_HEXAHEDRON, 27 }, { VTK_LAGRANGE_WEDGE, 18 },
    { VTK_BEZIER_CURVE, 3 }, { VTK_BEZIER_TRIANGLE, 6 }, { VTK_BEZIER_QUADRILATERAL, 9 },
    { VTK_BEZIER_TETRAHEDRON, 10 }, { VTK_BEZIER_HEXAHEDRON, 27 }, { VTK_BEZIER_WEDGE, 18 } };
  const int display = vtkObject::GetGlobalWarningDisplay();
  vtkObject::GlobalWarningDisplayOff(); // vtkGenericCell speaks of types that do not exist
  vtkNew<vtkGenericCell> kind;
  int types = 0;
  for (int type = VTK_VERTEX; type < VTK_NUMBER_OF_CELL_TYPES; ++type)
  {
    kind->SetCellTypeToEmptyCell();
    kind->SetCellType(type);
    if (kind->GetCellType() != type || type == VTK_POLYHEDRON)
    {
      continue;
    }
    const auto size = sizes.find(type);
    const std::size_t count = size != sizes.end() ? size->second
      : kind->GetNumberOfPoints() > 0 ? static_cast<std::size_t>(kind->GetNumberOfPoints())
                                      : 6;
    auto grid = Cells(type, Scatter(count));
    const std::vector<float> points = Values(Apply(grid).Output);
    EXPECT_EQ(points.size(), count) << "cell type " << type;
    EXPECT_TRUE(AllFinite(points)) << "cell type " << type;
    grid->GetPointData()->Initialize();
    AddFlow(grid, true);
    const std::vector<float> cells = Values(Apply(grid).Output);
    EXPECT_EQ(cells.size(), 1u) << "cell type " << type;
    EXPECT_TRUE(AllFinite(cells)) << "cell type " << type;
    ++types;
  }
  vtkObject::SetGlobalWarningDisplay(display);
  EXPECT_GT(types, 30);
}

/// What VTK is asked for the centres of (GetPlainCell says what goes wrong in VTK 9.2).
TEST(SteerableNoiseDataSets, CellsArriveInVTKAsItCanTakeThem)
{
  const auto plain = [](vtkDataSet* dataset)
  {
    vtkNew<vtkIdList> ids;
    const int type = noise::GetPlainCell(dataset, 0, ids);
    return std::make_pair(type, std::vector<vtkIdType>(ids->begin(), ids->end()));
  };
  using Ids = std::vector<vtkIdType>;
  const std::vector<double> zigzag = { 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0 };
  // A strip arrives as the triangle in its middle, at whose centre it is for VTK.
  auto strip = Cells(VTK_TRIANGLE_STRIP, zigzag);
  EXPECT_EQ(plain(strip), std::make_pair(int(VTK_TRIANGLE), Ids({ 2, 3, 4 })));
  vtkNew<vtkDoubleArray> centers;
  noise::ComputeCellCenters(strip, centers);
  EXPECT_NEAR(centers->GetComponent(0, 0), 4.0 / 3.0, 1e-12);
  EXPECT_NEAR(centers->GetComponent(0, 1), 1.0 / 3.0, 1e-12);
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(strip->GetPoints());
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({ 0, 1, 2, 3 });
  surface->SetStrips(strips);
  EXPECT_EQ(plain(surface), std::make_pair(int(VTK_TRIANGLE), Ids({ 1, 2, 3 })));

  const std::vector<double> corners = { 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2 };
  EXPECT_EQ(plain(Cells(VTK_TETRA, corners)), std::make_pair(int(VTK_TETRA), Ids({ 0, 1, 2, 3 })));
  auto hull = Cells(VTK_CONVEX_POINT_SET, corners);
  EXPECT_EQ(plain(hull), std::make_pair(int(VTK_EMPTY_CELL), Ids({ 0, 1, 2, 3 })));
  noise::ComputeCellCenters(hull, centers);
  EXPECT_NEAR(centers->GetComponent(0, 2), 0.5, 1e-12) << "the mean of its points";

  // Coordinates that are none, on a cell that VTK takes anyway.
  for (const double bad : { std::numeric_limits<double>::quiet_NaN(),
         std::numeric_limits<double>::infinity(), 1e60, -1e300 })
  {
    auto triangle = Cells(VTK_TRIANGLE, { 0, 0, 0, 1, 0, 0, 0, bad, 0 });
    EXPECT_EQ(plain(triangle).first, VTK_EMPTY_CELL) << bad;
  }
}

TEST(SteerableNoiseBadInput, TheTableHasSixtyCases)
{
  EXPECT_GE(BadInput().size(), 60u);
}
