// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageSubbandDecomposition.h"

#include "NoiseArrays.h"
#include "NoiseErrors.h"
#include "NoiseThreads.h"
#include "Subband/SubbandTiles.h"
#include "SubbandNames.h"

#include "vtkDataObject.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkImageSubbandDecomposition);

namespace
{
constexpr int SmallestSide = 16;
constexpr int LargestSide = 2048;

template <typename... Parts>
void Require(bool condition, const Parts&... parts)
{
  if (!condition)
  {
    std::ostringstream message;
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }
}

/// Numbers of points along the two sides of a flat image.
struct Sides
{
  int Width = 1;
  int Height = 1;
};

Sides GetSides(const int extent[6])
{
  std::vector<int> sides;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int side = extent[2 * axis + 1] - extent[2 * axis] + 1;
    if (side > 1)
    {
      sides.push_back(side);
    }
  }
  Require(sides.size() == 2, "The image is not flat: it has ", extent[1] - extent[0] + 1, " x ",
    extent[3] - extent[2] + 1, " x ", extent[5] - extent[4] + 1,
    " points. Take a slice of it, with Extract Subset.");
  Require(std::min(sides[0], sides[1]) >= SmallestSide &&
      std::max(sides[0], sides[1]) <= LargestSide,
    "The image has ", sides[0], " x ", sides[1], " points. Resample it to ", SmallestSide, " to ",
    LargestSide, " along each side, with Resample To Image.");
  return { sides[0], sides[1] };
}

std::vector<double> ReadImage(vtkDataArray* array, int component, vtkIdType points)
{
  Require(array != nullptr,
    "There is no scalar array on the points of the image. Choose one that exists, or make one of "
    "cells with Cell Data to Point Data.");
  Require(array->GetNumberOfTuples() == points, "Array '", array->GetName() ? array->GetName() : "",
    "' has ", array->GetNumberOfTuples(), " values for ", points, " points.");
  Require(component < array->GetNumberOfComponents(), "Component is ", component, ", but array '",
    array->GetName() ? array->GetName() : "", "' has ", array->GetNumberOfComponents(),
    " component(s), counted from 0.");
  std::vector<double> values(points);
  vtkIdType bad = 0;
  for (vtkIdType point = 0; point < points; ++point)
  {
    values[point] = array->GetComponent(point, component);
    bad += std::isfinite(values[point]) ? 0 : 1;
  }
  Require(bad == 0, bad, " of ", points,
    " values are NaN or infinite, which would spread over the whole image. Replace them first, for "
    "instance with the Calculator.");
  return values;
}
} // namespace

//------------------------------------------------------------------------------
vtkImageSubbandDecomposition::vtkImageSubbandDecomposition()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

//------------------------------------------------------------------------------
vtkImageSubbandDecomposition::~vtkImageSubbandDecomposition() = default;

//------------------------------------------------------------------------------
void vtkImageSubbandDecomposition::SetOrientations(int orientations)
{
  const int allowed = noise::TakeOrientations(this, orientations);
  if (this->Orientations != allowed)
  {
    this->Orientations = allowed;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkImageSubbandDecomposition::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkDataObject::SetPointDataActiveScalarInfo(outputVector->GetInformationObject(0), VTK_FLOAT,
    this->Orientations * (this->Scales + 1) + 1);
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageSubbandDecomposition::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // Each value of a band depends on the whole image.
  using SDDP = vtkStreamingDemandDrivenPipeline;
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  int whole[6];
  inInfo->Get(SDDP::WHOLE_EXTENT(), whole);
  inInfo->Set(SDDP::UPDATE_EXTENT(), whole, 6);
  return 1;
}

//------------------------------------------------------------------------------
int vtkImageSubbandDecomposition::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  auto* input = vtkImageData::GetData(inputVector[0]);
  auto* output = vtkImageData::GetData(outputVector);
  if (input->GetNumberOfPoints() == 0)
  {
    return 1;
  }
  try
  {
    int extent[6], whole[6];
    input->GetExtent(extent);
    inputVector[0]->GetInformationObject(0)->Get(
      vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
    Require(std::equal(extent, extent + 6, whole),
      "Only a piece of the image is here. Gather it first: each value of a band depends on all of it.");
    const Sides sides = GetSides(extent);
    // ParaView hands on an empty name where the input had not run when the filter was made.
    const bool active = noise::GetChosenName(this->GetInputArrayInformation(0)).empty();
    vtkDataArray* array = active ? input->GetPointData()->GetScalars()
                                 : this->GetInputArrayToProcess(0, inputVector);
    const std::vector<double> values =
      ReadImage(array, this->Component, input->GetNumberOfPoints());

    steerable::SubbandParameters pyramid;
    pyramid.Orientations = this->Orientations;
    pyramid.TileSize = std::min(sides.Width, sides.Height);
    pyramid.BandCenter = this->BandCenter;
    Require(this->Scales <= pyramid.MostScales(), "The coarsest of ", this->Scales,
      " scales is too coarse for ", sides.Width, " x ", sides.Height, " points. Lower Scales to ",
      pyramid.MostScales(), ", or raise BandCenter.");
    pyramid.Scales = this->Scales;
    pyramid.Validate();

    const steerable::ImageSpectrum spectrum =
      steerable::TransformImage(values, sides.Width, sides.Height);
    const int components = steerable::ImageComponents(pyramid);
    auto bands = noise::NewOutputArray("Subbands", components, input->GetNumberOfPoints());
    noise::WithThreads(
      [&]
      {
        const int pairs = (components + 1) / 2;
        constexpr int together = 4; // between two looks at progress
        for (int first = 0; first < pairs; first += together)
        {
          this->UpdateProgress(static_cast<double>(first) / pairs);
          if (this->CheckAbort())
          {
            return;
          }
          vtkSMPTools::For(first, std::min(first + together, pairs), 1,
            [&](vtkIdType begin, vtkIdType end)
            {
              for (vtkIdType pair = begin; pair < end; ++pair)
              {
                steerable::WriteImageSubbands(
                  spectrum, pyramid, static_cast<int>(2 * pair), bands->GetPointer(0));
              }
            });
        }
      });
    noise::NameSubbands(bands, pyramid.Orientations, pyramid.Scales);
    noise::NameResiduals(bands, pyramid.Orientations, pyramid.Components());
    output->CopyStructure(input);
    output->GetPointData()->SetScalars(bands);
    noise::AddBandCenter(output, this->BandCenter);
  }
  catch (const std::exception& error)
  {
    return noise::Refuse(this, output, error.what());
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkImageSubbandDecomposition::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Component: " << this->Component << "\n";
  os << indent << "Orientations: " << this->Orientations << "\n";
  os << indent << "Scales: " << this->Scales << "\n";
  os << indent << "BandCenter: " << this->BandCenter << "\n";
}
