// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// vtkSteerableNoiseFilter on any type of dataset, array and property: a message, or finite noise.
#include "FuzzBytes.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSmartPointer.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace
{
vtkSmartPointer<vtkPoints> TakePoints(FuzzBytes& bytes, int count)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(bytes.TakeBool() ? VTK_DOUBLE : VTK_FLOAT);
  for (int i = 0; i < count; ++i)
  {
    const double x = bytes.TakeNumber();
    const double y = bytes.TakeNumber();
    points->InsertNextPoint(x, y, bytes.TakeNumber());
  }
  return points;
}

vtkSmartPointer<vtkDataSet> TakeDataSet(FuzzBytes& bytes)
{
  const int dims[3] = { 1 + bytes.TakeBelow(5), 1 + bytes.TakeBelow(4), 1 + bytes.TakeBelow(3) };
  const int count = dims[0] * dims[1] * dims[2];
  switch (bytes.TakeBelow(5))
  {
    case 0:
    {
      auto image = vtkSmartPointer<vtkImageData>::New();
      image->SetDimensions(dims);
      const double x = bytes.TakeNumber();
      const double y = bytes.TakeNumber();
      image->SetOrigin(x, y, bytes.TakeNumber());
      const double sx = bytes.TakeNumber();
      const double sy = bytes.TakeNumber();
      image->SetSpacing(sx, sy, bytes.TakeNumber());
      return image;
    }
    case 1:
    {
      auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
      grid->SetDimensions(dims);
      vtkSmartPointer<vtkDoubleArray> coordinates[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        coordinates[axis] = vtkSmartPointer<vtkDoubleArray>::New();
        for (int i = 0; i < dims[axis]; ++i)
        {
          coordinates[axis]->InsertNextValue(bytes.TakeNumber());
        }
      }
      grid->SetXCoordinates(coordinates[0]);
      grid->SetYCoordinates(coordinates[1]);
      grid->SetZCoordinates(coordinates[2]);
      return grid;
    }
    case 2:
    {
      auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
      grid->SetDimensions(dims);
      grid->SetPoints(TakePoints(bytes, count));
      return grid;
    }
    case 3:
    {
      auto surface = vtkSmartPointer<vtkPolyData>::New();
      surface->SetPoints(TakePoints(bytes, count));
      surface->AllocateEstimate(8, 4);
      const int types[] = { VTK_VERTEX, VTK_LINE, VTK_TRIANGLE, VTK_QUAD, VTK_POLYGON,
        VTK_TRIANGLE_STRIP, VTK_POLY_LINE, VTK_POLY_VERTEX };
      const int sizes[] = { 1, 2, 3, 4, 5, 6, 4, 3 };
      for (int cell = bytes.TakeBelow(6); cell > 0; --cell)
      {
        const int kind = bytes.TakeBelow(8);
        vtkIdType ids[6];
        for (vtkIdType& id : ids)
        {
          id = bytes.TakeBelow(count);
        }
        surface->InsertNextCell(types[kind], sizes[kind], ids);
      }
      return surface;
    }
    default:
    {
      auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
      grid->SetPoints(TakePoints(bytes, count));
      const int types[] = { VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE, VTK_PYRAMID, VTK_TRIANGLE,
        VTK_QUAD, VTK_LINE, VTK_VERTEX, VTK_VOXEL, VTK_PIXEL, VTK_POLYGON, VTK_TRIANGLE_STRIP,
        VTK_CONVEX_POINT_SET, VTK_QUADRATIC_TRIANGLE, VTK_QUADRATIC_TETRA, VTK_BIQUADRATIC_QUAD,
        VTK_POLYHEDRON };
      const int sizes[] = { 4, 8, 6, 5, 3, 4, 2, 1, 8, 4, 5, 6, 7, 6, 10, 9, 4 };
      for (int cell = bytes.TakeBelow(6); cell > 0; --cell)
      {
        const int kind = bytes.TakeBelow(17);
        vtkIdType ids[10];
        for (vtkIdType& id : ids)
        {
          id = bytes.TakeBelow(count);
        }
        if (types[kind] == VTK_POLYHEDRON)
        {
          const vtkIdType faces[] = { 3, ids[0], ids[1], ids[2], 3, ids[0], ids[1], ids[3], 3,
            ids[0], ids[2], ids[3], 3, ids[1], ids[2], ids[3] };
          grid->InsertNextCell(VTK_POLYHEDRON, 4, ids, 4, faces);
          continue;
        }
        grid->InsertNextCell(types[kind], sizes[kind], ids);
      }
      return grid;
    }
  }
}

void TakeArray(FuzzBytes& bytes, vtkDataSet* dataset)
{
  const bool cells = bytes.TakeBool();
  const int components[] = { 3, 3, 2, 6, 9, 4, 1, 5 };
  vtkSmartPointer<vtkDataArray> array;
  if (bytes.TakeBool())
  {
    array = vtkSmartPointer<vtkFloatArray>::New();
  }
  else
  {
    array = vtkSmartPointer<vtkDoubleArray>::New();
  }
  array->SetName("v");
  array->SetNumberOfComponents(components[bytes.TakeBelow(8)]);
  array->SetNumberOfTuples(cells ? dataset->GetNumberOfCells() : dataset->GetNumberOfPoints());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < array->GetNumberOfComponents(); ++c)
    {
      array->SetComponent(i, c, bytes.TakeNumber());
    }
  }
  vtkDataSetAttributes* attributes =
    cells ? static_cast<vtkDataSetAttributes*>(dataset->GetCellData()) : dataset->GetPointData();
  attributes->AddArray(array);
  if (bytes.TakeBool())
  {
    attributes->SetActiveVectors("v");
  }
}

void ExpectFinite(vtkDataObject* object)
{
  auto* dataset = vtkDataSet::SafeDownCast(object);
  if (!dataset)
  {
    return;
  }
  for (vtkDataArray* noise : { dataset->GetPointData()->GetArray("SteerableNoise"),
         dataset->GetCellData()->GetArray("SteerableNoise") })
  {
    for (vtkIdType i = 0; noise && i < noise->GetNumberOfTuples(); ++i)
    {
      if (!std::isfinite(noise->GetComponent(i, 0)))
      {
        std::fprintf(stderr, "noise is not finite\n");
        std::abort();
      }
    }
  }
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  vtkObject::GlobalWarningDisplayOff();
  FuzzBytes bytes(data, size);
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetFeatureSize(bytes.TakeBool() ? 0.0 : bytes.TakeNumber());
  filter->SetQuality(bytes.TakeBelow(10));
  filter->SetStrengthMode(bytes.TakeBelow(2));
  filter->SetNormalization(bytes.TakeBelow(3));
  filter->SetFollowCurvature(bytes.TakeBool());
  filter->SetBasis(bytes.TakeBelow(3));
  filter->SetPhase(bytes.TakeNumber());
  filter->SetOctaves(bytes.TakeBelow(4));
  filter->SetFade(bytes.TakeBelow(3));
  filter->SetFalloff(bytes.TakeBelow(2));
  filter->SetLattice(bytes.TakeBelow(3));
  filter->SetPeriod(bytes.TakeBelow(4), bytes.TakeBelow(4), bytes.TakeBelow(4));
  filter->SetMagnification(bytes.TakeBelow(4));
  filter->SetMaskThreshold(bytes.TakeNumber());
  filter->SetOutputMetric(bytes.TakeBool());
  filter->SetModel(bytes.TakeBelow(8) == 0);
  filter->SetDirection(bytes.TakeBelow(8) == 0);
  filter->SetTensorUse(bytes.TakeBelow(3));
  filter->SetMetricInProjection(bytes.TakeBelow(4) != 0);
  if (bytes.TakeBool())
  {
    filter->SetInputArrayToProcess(0, 0, 0, bytes.TakeBelow(2), "v");
  }

  vtkSmartPointer<vtkDataSet> first = TakeDataSet(bytes);
  TakeArray(bytes, first);
  if (bytes.TakeBool())
  {
    filter->SetInputData(first);
    filter->Update();
    ExpectFinite(filter->GetOutputDataObject(0));
    return 0;
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  vtkSmartPointer<vtkDataSet> second = TakeDataSet(bytes);
  blocks->SetBlock(0, first);
  blocks->SetBlock(1, nullptr);
  blocks->SetBlock(2, second);
  filter->SetInputDataObject(blocks);
  filter->Update();
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  for (unsigned int i = 0; output && i < output->GetNumberOfBlocks(); ++i)
  {
    ExpectFinite(output->GetBlock(i));
  }
  return 0;
}
