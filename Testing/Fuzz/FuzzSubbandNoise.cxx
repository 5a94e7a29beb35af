// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// libFuzzer target: any surface, arrays and properties give a value or an error, never a crash.
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataSubbandNoise.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace
{
/// Reads the input byte by byte; zeros after its end.
class Bytes
{
public:
  Bytes(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Size(size)
  {
  }
  int Next(int bound)
  {
    const int byte = this->Position < this->Size ? this->Data[this->Position++] : 0;
    return byte % bound;
  }
  // Zeros, which end every input, give a plain number.
  double Value()
  {
    switch (this->Next(16))
    {
      case 15:
        return std::numeric_limits<double>::quiet_NaN();
      case 14:
        return std::numeric_limits<double>::infinity();
      case 13:
        return std::ldexp(this->Next(256) - 128, 8 * (this->Next(256) - 128));
      default:
        return (this->Next(256) - 128) / 16.0;
    }
  }

private:
  const std::uint8_t* Data;
  std::size_t Size;
  std::size_t Position = 0;
};

vtkSmartPointer<vtkDoubleArray> MakeArray(
  Bytes& bytes, const char* name, int components, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    array->SetValue(i, bytes.Value());
  }
  return array;
}

vtkSmartPointer<vtkPolyData> MakeSurface(Bytes& bytes)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  const vtkIdType count = bytes.Next(40);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double x = bytes.Value(), y = bytes.Value(), z = bytes.Value();
    points->InsertNextPoint(x, y, z);
  }
  mesh->SetPoints(points);
  const auto cells = [&](int most)
  {
    auto list = vtkSmartPointer<vtkCellArray>::New();
    for (int n = count > 0 ? bytes.Next(most) : 0; n > 0; --n)
    {
      const int corners = bytes.Next(8);
      list->InsertNextCell(corners);
      for (int c = 0; c < corners; ++c)
      {
        list->InsertCellPoint(bytes.Next(static_cast<int>(count)));
      }
    }
    return list;
  };
  mesh->SetVerts(cells(3));
  mesh->SetLines(cells(3));
  mesh->SetPolys(cells(30));
  mesh->SetStrips(cells(6));

  // Arrays of any length: too short is an error or ignored.
  const auto length = [&](vtkIdType right) { return bytes.Next(8) ? right : bytes.Next(20); };
  const int components = bytes.Next(4);
  if (components > 0)
  {
    mesh->GetPointData()->SetTCoords(MakeArray(bytes, "uv", components, length(count)));
  }
  if (bytes.Next(3) == 0)
  {
    mesh->GetPointData()->SetNormals(MakeArray(bytes, "n", 3, count));
  }
  mesh->GetPointData()->AddArray(MakeArray(bytes, "p", 1 + bytes.Next(4), length(count)));
  const vtkIdType cellCount = mesh->GetNumberOfCells();
  mesh->GetCellData()->AddArray(MakeArray(bytes, "c", 1 + bytes.Next(4), length(cellCount)));
  if (bytes.Next(3) == 0)
  {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    for (vtkIdType i = 0; i < cellCount; ++i)
    {
      ghosts->InsertNextValue(static_cast<unsigned char>(bytes.Next(256)));
    }
    mesh->GetCellData()->AddArray(ghosts);
  }
  return mesh;
}
} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  vtkObject::GlobalWarningDisplayOff();
  Bytes bytes(data, size);
  // One for all inputs: making its tiles takes longer than all the rest.
  static vtkPolyDataSubbandNoise* filter = vtkPolyDataSubbandNoise::New();
  filter->SetTileSize(64);
  filter->SetOrientations(bytes.Next(10));
  filter->SetMethod(bytes.Next(4));
  filter->SetParameterization(bytes.Next(3));
  filter->SetOctaves(bytes.Next(4));
  filter->SetPersistence(bytes.Value());
  filter->SetFunction(bytes.Next(2));
  filter->SetAntiAlias(bytes.Next(2));
  filter->SetWrapSeams(bytes.Next(2));
  filter->SetWavelength(bytes.Next(2) ? bytes.Value() : 0.0);
  filter->SetAnisotropy(bytes.Value());
  filter->SetPhase(bytes.Next(4) ? 0.0 : 0.25 * bytes.Next(4));
  filter->SetSeed(bytes.Next(2));
  filter->SetOutputWeights(bytes.Next(2));
  filter->SetOutputDistortion(bytes.Next(2));
  const char* names[] = { "None", "p", "c", "uv", "" };
  filter->SetInputArrayToProcess(0, 0, 0, bytes.Next(2), names[bytes.Next(5)]);
  auto surface = MakeSurface(bytes);
  filter->SetBlendSeams(bytes.Next(2));
  if (bytes.Next(4) == 0)
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    blocks->SetBlock(0, surface);
    blocks->SetBlock(2, MakeSurface(bytes));
    filter->SetInputData(blocks);
  }
  else
  {
    filter->SetInputData(surface);
  }
  filter->Update();
  if (auto* output = vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0)))
  {
    vtkDataArray* noise = output->GetPointData()->GetArray("SubbandNoise");
    for (vtkIdType i = 0; noise && i < noise->GetNumberOfTuples(); ++i)
    {
      if (!std::isfinite(noise->GetComponent(i, 0)))
      {
        std::abort();
      }
    }
  }
  filter->SetInputData(nullptr);
  return 0;
}
