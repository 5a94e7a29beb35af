// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Checksums of everything that the two noise filters give and say for many options and inputs, bad ones
 * too: filterBits. A change that is not to change results prints the same lines before and after.
 */
#include "FilterTestHelpers.h"

#include "vtkCellArray.h"
#include "vtkImageSubbandNoiseSource.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataSubbandNoise.h"
#include "vtkSphereSource.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

using namespace filtertest;

namespace
{
/// FNV-1a.
struct Checksum
{
  std::uint64_t Sum = 14695981039346656037u;

  void Add(const std::string& bytes)
  {
    for (const char byte : bytes)
    {
      this->Sum = (this->Sum ^ static_cast<unsigned char>(byte)) * 1099511628211u;
    }
  }
  void Add(vtkFieldData* arrays)
  {
    for (int a = 0; a < arrays->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* array = arrays->GetArray(a);
      this->Add(arrays->GetArrayName(a));
      for (vtkIdType i = 0; array && i < array->GetNumberOfTuples(); ++i)
      {
        for (int c = 0; c < array->GetNumberOfComponents(); ++c)
        {
          const double value = array->GetComponent(i, c);
          this->Add(std::string(reinterpret_cast<const char*>(&value), sizeof value));
        }
      }
    }
  }
  void Add(vtkDataObject* data)
  {
    if (auto* dataset = vtkDataSet::SafeDownCast(data))
    {
      this->Add(dataset->GetPointData());
      this->Add(dataset->GetCellData());
    }
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    {
      for (unsigned int b = 0; b < blocks->GetNumberOfBlocks(); ++b)
      {
        this->Add(blocks->GetBlock(b));
      }
    }
  }
};

/// Messages without where they come from: file, line and address.
std::string Said(const std::string& text)
{
  std::string said;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find("): ", from)) != std::string::npos;)
  {
    const std::size_t end = std::min(text.find("\n\n", at), text.size());
    said += text.substr(at, end - at);
    from = end;
  }
  return said;
}

template <class Filter>
void Print(const std::string& name, vtkDataObject* input, const std::function<void(Filter*)>& change,
  const std::function<void(Filter*)>& later)
{
  vtkNew<Filter> filter;
  auto messages = Listen(filter);
  filter->SetInputDataObject(input);
  change(filter);
  for (const char* run : { "first", "later" })
  {
    messages->Text.clear();
    filter->Update();
    Checksum arrays;
    arrays.Add(filter->GetOutputDataObject(0));
    Checksum words;
    words.Add(Said(messages->Text));
    std::printf("%-46s %s %016llx, %d errors, %d warnings %016llx\n", name.c_str(), run,
      static_cast<unsigned long long>(arrays.Sum), messages->Errors, messages->Warnings,
      static_cast<unsigned long long>(words.Sum));
    later(filter); // which finds what was kept
  }
}

/// A sphere with a seam of its texture, vectors on points and cells, and arrays for properties.
vtkSmartPointer<vtkPolyData> Globe(int resolution, bool texture = true)
{
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(resolution);
  source->SetPhiResolution(resolution);
  source->SetRadius(5.0);
  source->Update();
  vtkSmartPointer<vtkPolyData> globe = source->GetOutput();
  const vtkIdType count = globe->GetNumberOfPoints();
  vtkNew<vtkFloatArray> uv;
  uv->SetName("uv");
  uv->SetNumberOfComponents(2);
  vtkNew<vtkFloatArray> amounts;
  amounts->SetName("amounts");
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double* p = globe->GetPoint(i);
    uv->InsertNextTuple2(
      std::atan2(p[1], p[0]) / 6.283185307179586, std::acos(p[2] / 5.0) / 3.141592653589793);
    amounts->InsertNextValue(static_cast<float>(1.5 + 0.1 * p[0]));
  }
  if (texture)
  {
    globe->GetPointData()->SetTCoords(uv);
  }
  globe->GetPointData()->AddArray(amounts);
  AddFlow(globe);
  AddFlow(globe, true, "cellflow");
  return globe;
}

/// Without any array, and with a triangle that has no area.
vtkSmartPointer<vtkPolyData> FlatMesh()
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  for (const auto& p : { std::pair(0, 0), std::pair(1, 0), std::pair(2, 0), std::pair(0, 3) })
  {
    points->InsertNextPoint(p.first, p.second, 0.0);
  }
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell({ 0, 1, 2 });
  cells->InsertNextCell({ 0, 1, 3 });
  mesh->SetPoints(points);
  mesh->SetPolys(cells);
  return mesh;
}

/// With a fill value, a vector of 0, one that is not a number, and blanked cells.
vtkSmartPointer<vtkImageData> Rough(int nz)
{
  auto image = MakeImage(40, 31, nz);
  vtkDataArray* flow = image->GetPointData()->GetArray("velocity");
  flow->SetComponent(100, 0, 1e30);
  flow->SetTuple3(200, 0.0, 0.0, 0.0);
  flow->SetComponent(300, 1, std::numeric_limits<double>::quiet_NaN());
  image->AllocateCellGhostArray()->SetValue(17, vtkDataSetAttributes::HIDDENCELL);
  return image;
}

void PrintSubbandNoise()
{
  using F = vtkPolyDataSubbandNoise;
  const auto print = [](const std::string& name, vtkDataObject* input, auto&& change)
  {
    Print<F>("subband " + name, input,
      [&](F* f)
      {
        f->SetTileSize(128); // making them takes longest
        change(f);
      },
      [](F* f)
      {
        f->SetPhase(0.3);
        f->SetOctaves(f->GetOctaves() + 1);
      });
  };
  const auto steer = [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "velocity"); };
  auto globe = Globe(60);
  auto bare = Globe(60, false);
  for (const auto& mesh : { globe, bare })
  {
    const std::string which = mesh == globe ? "globe " : "bare globe ";
    print(which + "defaults", mesh, [](F*) {});
    print(which + "steered", mesh, steer);
    print(which + "outputs", mesh,
      [&](F* f) { steer(f); f->SetOutputWeights(true); f->SetOutputDistortion(true); });
    for (const int method : { 1, 2, 3 })
    {
      print(which + "method " + std::to_string(method), mesh,
        [&](F* f) { steer(f); f->SetMethod(method); f->SetRadialTriple(true); });
    }
    print(which + "coarse", mesh, [](F* f) { f->SetWavelength(0.1); });
    print(which + "long", mesh, [](F* f) { f->SetWavelength(40.0); });
    print(which + "turbulence", mesh,
      [](F* f) { f->SetOctaves(6); f->SetFunction(F::TURBULENCE); f->SetPersistence(0.5); });
    print(which + "plain", mesh, [](F* f) { f->SetAntiAlias(false); f->SetOctaves(2); });
    print(which + "not kept", mesh, [&](F* f) { steer(f); f->SetKeepFields(false); });
    print(which + "arrays", mesh,
      [&](F* f)
      {
        steer(f);
        f->SetInputArrayToProcess(2, 0, 0, 0, "amounts");
        f->SetInputArrayToProcess(3, 0, 0, 0, "amounts");
      });
    print(which + "cells, 4, tiles of 100", mesh,
      [](F* f)
      {
        f->SetInputArrayToProcess(0, 0, 0, 1, "cellflow");
        f->SetOrientations(4);
        f->SetAnisotropy(8.0);
        f->SetTileSize(100);
        f->SetSeed(5);
      });
    for (const int kind : { 1, 2 })
    {
      print(which + "parameterization " + std::to_string(kind), mesh,
        [&](F* f) { f->SetParameterization(kind); f->SetWrapSeams(true); });
    }
    print(which + "blended", mesh,
      [&](F* f) { steer(f); f->SetBlendSeams(true); f->SetOutputWeights(true); });
    print(which + "wrong array", mesh, [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "amounts"); });
    print(which + "missing array", mesh, [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "gone"); });
    print(which + "missing wavelengths", mesh,
      [](F* f) { f->SetInputArrayToProcess(2, 0, 0, 0, "gone"); });
    print(which + "not a number", mesh,
      [](F* f) { f->SetWavelength(std::numeric_limits<double>::quiet_NaN()); });
    print(which + "no name", mesh, [](F* f) { f->SetResultArrayName(""); });
    print(which + "weights that are not there", mesh,
      [](F* f) { f->SetInputArrayToProcess(1, 0, 0, 0, "amounts"); });
    print(which + "factors that are not there", mesh,
      [](F* f) { f->SetInputArrayToProcess(4, 0, 0, 0, "amounts"); });
  }

  // Weights of one run as those of the next, and factors.
  vtkNew<F> first;
  first->SetInputData(globe);
  first->SetTileSize(128);
  first->SetOutputWeights(true);
  first->Update();
  auto weighted = vtkSmartPointer<vtkPolyData>::New();
  weighted->ShallowCopy(first->GetOutputDataObject(0));
  vtkNew<vtkFloatArray> factors;
  factors->SetName("factors");
  factors->SetNumberOfComponents(16);
  factors->SetNumberOfTuples(weighted->GetNumberOfPoints());
  for (vtkIdType i = 0; i < factors->GetNumberOfValues(); ++i)
  {
    factors->SetValue(i, 0.01f * static_cast<float>(i % 100));
  }
  weighted->GetPointData()->AddArray(factors);
  print("own weights", weighted,
    [](F* f) { f->SetInputArrayToProcess(1, 0, 0, 0, "SubbandWeights"); });
  print("factors", weighted,
    [](F* f) { f->SetInputArrayToProcess(4, 0, 0, 0, "factors"); f->SetOctaves(2); });

  vtkNew<vtkImageSubbandNoiseSource> bands;
  for (const int method : { 0, 3 })
  {
    print("bands of an image, method " + std::to_string(method), globe,
      [&](F* f)
      {
        f->SetSubbandsConnection(bands->GetOutputPort());
        f->SetMethod(method);
        f->SetOutputWeights(true);
      });
  }
  print("an image without bands", globe, [](F* f) { f->SetSubbandsData(MakeImage(8, 8, 1)); });

  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, globe);
  blocks->SetBlock(1, MakeImage(5, 5, 5));
  blocks->SetBlock(3, bare);
  blocks->SetBlock(4, FlatMesh());
  print("blocks", blocks, [](F*) {});
  print("steered blocks", blocks, steer);
  print("blended blocks", blocks, [](F* f) { f->SetBlendSeams(true); f->SetWavelength(1.0); });
  print("empty", vtkSmartPointer<vtkPolyData>::New(), [](F*) {});
  vtkNew<vtkMultiBlockDataSet> others;
  others->SetBlock(0, MakeImage(5, 5, 5));
  print("other blocks", others, [](F*) {});
}

void PrintSteerableNoise()
{
  using F = vtkSteerableNoiseFilter;
  const auto print = [](const std::string& name, vtkDataObject* input, auto&& change)
  { Print<F>("steerable " + name, input, change, [](F* f) { f->SetPhase(0.3); }); };
  auto globe = Globe(60);
  const std::pair<const char*, vtkSmartPointer<vtkDataSet>> inputs[] = {
    { "globe ", globe }, { "flat image ", Rough(1) }, { "volume ", Rough(9) }
  };
  for (const auto& [which, input] : inputs)
  {
    const auto add = [&, which = std::string(which), input = input](const char* name, auto&& change)
    { print(which + name, input, change); };
    add("defaults", [](F*) {});
    add("octaves", [](F* f) { f->SetOctaves(3); f->SetFeatureSize(3.0); });
    add("paper", [](F* f) { f->SetLatticeWindow(true); f->SetEigenvalueSum(4.0); f->SetQuality(2); });
    add("variants",
      [](F* f)
      {
        f->SetFade(0);
        f->SetFalloff(1);
        f->SetLattice(1);
        f->SetGradientSet(1);
        f->SetNormalization(1);
        f->SetBasis(2);
        f->SetPeriod(7, 8, 9);
      });
    add("Perlin", [](F* f) { f->SetModel(F::MODEL_PERLIN); });
    add("quality", [](F* f) { f->SetQuality(2); });
    add("no direction", [](F* f) { f->SetDirection(1); });
    add("magnitude", [](F* f) { f->SetStrengthMode(F::MAGNITUDE); });
    add("masks", [](F* f) { f->SetMaskThreshold(0.9); f->SetMaskUpperThreshold(2.0); });
    add("all lengths", [](F* f) { f->SetMaskUpperThreshold(1e300); });
    add("blank", [](F* f) { f->SetBlankValue(1); });
    add("hidden", [](F* f) { f->SetBlankValue(2); });
    add("magnified", [](F* f) { f->SetMagnification(2); f->SetOutputMetric(true); });
    add("too fine", [](F* f) { f->SetFeatureSize(0.01); });
    add("too much memory", [](F* f) { f->SetMagnification(64); f->SetFeatureSize(4.0); });
    add("not kept", [](F* f) { f->SetKeepFields(false); f->SetFeatureSize(2.0); });
    add("cells", [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 1, "cellflow"); });
    add("lengths from an array", [](F* f) { f->SetInputArrayToProcess(1, 0, 0, 0, "amounts"); });
    add("wrong array", [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "amounts"); });
    add("missing array", [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "gone"); });
    add("no name", [](F* f) { f->SetResultArrayName(""); });
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, globe);
  blocks->SetBlock(1, Rough(1));
  blocks->SetBlock(3, FlatMesh());
  blocks->SetBlock(4, Rough(9));
  print("blocks", blocks, [](F*) {});
  print("magnified blocks", blocks, [](F* f) { f->SetMagnification(2); f->SetStrengthMode(1); });
  print("blocks on cells", blocks, [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 1, "cellflow"); });
  print("blocks without arrays", blocks, [](F* f) { f->SetInputArrayToProcess(0, 0, 0, 0, "gone"); });
  print("empty", vtkSmartPointer<vtkPolyData>::New(), [](F*) {});
}
} // namespace

int main()
{
  PrintSubbandNoise();
  PrintSteerableNoise();
}
