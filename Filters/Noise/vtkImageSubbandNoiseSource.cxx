// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageSubbandNoiseSource.h"

#include "SubbandNames.h"
#include "SubbandTiles.h"

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
  const int allowed = noise::AllowedOrientations(orientations);
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
    this->OutputType == FLOAT ? VTK_FLOAT : VTK_UNSIGNED_CHAR, this->Orientations * this->Scales);
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
    const steerable::SubbandTiles tiles = steerable::MakeSubbandTiles(parameters);
    vtkSmartPointer<vtkDataArray> array;
    if (this->OutputType == FLOAT)
    {
      array = CopyTexels<vtkFloatArray>(
        tiles.Values, extent, parameters.TileSize, parameters.Components());
    }
    else
    {
      const steerable::QuantizedSubbandTiles bytes = steerable::Quantize(tiles);
      array = CopyTexels<vtkUnsignedCharArray>(
        bytes.Values, extent, parameters.TileSize, parameters.Components());
      auto ranges = vtkSmartPointer<vtkFloatArray>::New();
      ranges->SetName("SubbandRanges");
      ranges->SetNumberOfTuples(parameters.Components());
      std::copy(bytes.Range.begin(), bytes.Range.end(), ranges->GetPointer(0));
      output->GetFieldData()->AddArray(ranges);
    }
    noise::NameSubbands(array, parameters.Orientations, parameters.Scales);
    output->GetPointData()->SetScalars(array);
  }
  catch (const std::exception& error)
  {
    output->Initialize();
    vtkErrorMacro(<< error.what()); // and no return of 0, to which the executive adds a page of its own
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
  os << indent << "OutputType: " << this->OutputType << "\n";
}
