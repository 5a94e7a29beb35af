// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageSubbandNoiseSource.h"

#include "NoiseErrors.h"
#include "Subband/SubbandTiles.h"
#include "SubbandNames.h"

#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <vector>

vtkStandardNewMacro(vtkImageSubbandNoiseSource);

namespace
{
/// The texels of `extent` as points of an array.
template <typename ArrayT, typename Value>
vtkSmartPointer<ArrayT> CopyTexels(
  const std::vector<Value>& tile, const int extent[6], int size, int components)
{
  const vtkIdType width = extent[1] - extent[0] + 1;
  const vtkIdType height = extent[3] - extent[2] + 1;
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetName("Subbands");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(width * height);
  for (vtkIdType y = 0; y < height; ++y)
  {
    const std::size_t texel = static_cast<std::size_t>(y + extent[2]) * size + extent[0];
    std::copy_n(tile.data() + texel * components, width * components,
      array->GetPointer(y * width * components));
  }
  return array;
}

/// Texels of `a` and `b` values one after the other.
std::vector<float> JoinTexels(
  const std::vector<float>& first, int a, const std::vector<float>& second, int b)
{
  std::vector<float> joined;
  joined.reserve(first.size() + second.size());
  auto from = second.begin();
  for (auto texel = first.begin(); texel != first.end(); texel += a, from += b)
  {
    joined.insert(joined.end(), texel, texel + a);
    joined.insert(joined.end(), from, from + b);
  }
  return joined;
}
} // namespace

//------------------------------------------------------------------------------
vtkImageSubbandNoiseSource::vtkImageSubbandNoiseSource()
{
  this->SetNumberOfInputPorts(0);
}

//------------------------------------------------------------------------------
vtkImageSubbandNoiseSource::~vtkImageSubbandNoiseSource() = default;

//------------------------------------------------------------------------------
void vtkImageSubbandNoiseSource::SetOrientations(int orientations)
{
  const int allowed = noise::TakeOrientations(this, orientations);
  if (this->Orientations != allowed)
  {
    this->Orientations = allowed;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkImageSubbandNoiseSource::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  const int last = this->TileSize - 1;
  const int extent[6] = { 0, last, 0, last, 0, 0 };
  const double spacing[3] = { 1.0 / this->TileSize, 1.0 / this->TileSize, 1.0 };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
  outInfo->Set(vtkDataObject::ORIGIN(), origin, 3);
  outInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  vtkDataObject::SetPointDataActiveScalarInfo(outInfo,
    this->OutputType == FLOAT ? VTK_FLOAT : VTK_UNSIGNED_CHAR, this->Orientations * this->Scales + (this->Residuals ? 2 : 0));
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageSubbandNoiseSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  auto* output = vtkImageData::GetData(outInfo);
  int extent[6];
  outInfo->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
  output->SetExtent(extent);
  output->SetSpacing(1.0 / this->TileSize, 1.0 / this->TileSize, 1.0);
  output->SetOrigin(0.0, 0.0, 0.0);
  if (output->GetNumberOfPoints() == 0)
  {
    return 1;
  }

  steerable::SubbandParameters parameters;
  parameters.Orientations = this->Orientations;
  parameters.Scales = this->Scales;
  parameters.TileSize = this->TileSize;
  parameters.BandCenter = this->BandCenter;
  parameters.Seed = static_cast<std::uint32_t>(this->Seed);
  try
  {
    std::vector<float> values = steerable::MakeSubbandTiles(parameters).Values;
    int components = parameters.Components();
    if (this->Residuals)
    {
      values = JoinTexels(values, components, steerable::MakeResidualTiles(parameters), 2);
      components += 2;
    }
    vtkSmartPointer<vtkDataArray> array;
    if (this->OutputType == FLOAT)
    {
      array = CopyTexels<vtkFloatArray>(values, extent, parameters.TileSize, components);
    }
    else
    {
      std::vector<float> found;
      const std::vector<std::uint8_t> bytes =
        steerable::QuantizeValues(values, static_cast<std::size_t>(components), found);
      array = CopyTexels<vtkUnsignedCharArray>(bytes, extent, parameters.TileSize, components);
      auto ranges = vtkSmartPointer<vtkFloatArray>::New();
      ranges->SetName("SubbandRanges");
      ranges->SetNumberOfTuples(components);
      std::copy(found.begin(), found.end(), ranges->GetPointer(0));
      output->GetFieldData()->AddArray(ranges);
    }
    noise::NameSubbands(array, parameters.Orientations, parameters.Scales);
    if (this->Residuals)
    {
      array->SetComponentName(components - 2, "high");
      array->SetComponentName(components - 1, "low");
    }
    output->GetPointData()->SetScalars(array);
    noise::AddBandCenter(output, this->BandCenter);
  }
  catch (const std::exception& error)
  {
    return noise::Refuse(this, output, error.what());
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkImageSubbandNoiseSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Orientations: " << this->Orientations << "\n";
  os << indent << "Scales: " << this->Scales << "\n";
  os << indent << "TileSize: " << this->TileSize << "\n";
  os << indent << "BandCenter: " << this->BandCenter << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Residuals: " << this->Residuals << "\n";
  os << indent << "OutputType: " << this->OutputType << "\n";
}
