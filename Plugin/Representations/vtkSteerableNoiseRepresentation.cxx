// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteerableNoiseRepresentation.h"

#include "vtkMapper.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVGeometryFilter.h"
#include "vtkPVView.h"
#include "vtkSteerableNoiseMapper.h"

#include <algorithm>

vtkStandardNewMacro(vtkSteerableNoiseRepresentation);

vtkSteerableNoiseRepresentation::vtkSteerableNoiseRepresentation()
{
  for (vtkMapper** mapper :
    { &this->Mapper, &this->LODMapper, &this->BackfaceMapper, &this->LODBackfaceMapper })
  {
    (*mapper)->Delete();
    *mapper = vtkSteerableNoiseMapper::New();
  }
  this->SetupDefaults();
}

vtkSteerableNoiseRepresentation::~vtkSteerableNoiseRepresentation() = default;

std::array<vtkSteerableNoiseMapper*, 4> vtkSteerableNoiseRepresentation::GetMappers()
{
  return { vtkSteerableNoiseMapper::SafeDownCast(this->Mapper),
    vtkSteerableNoiseMapper::SafeDownCast(this->LODMapper),
    vtkSteerableNoiseMapper::SafeDownCast(this->BackfaceMapper),
    vtkSteerableNoiseMapper::SafeDownCast(this->LODBackfaceMapper) };
}

void vtkSteerableNoiseRepresentation::SelectInputVectors(
  int, int, int, int association, const char* name)
{
  for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetInputArrayToProcess(0, 0, 0, association, name ? name : "");
  }
}

#define STEERABLENOISE_FORWARD(name, type)                                                         \
  void vtkSteerableNoiseRepresentation::Set##name(type value)                                      \
  {                                                                                                \
    for (vtkSteerableNoiseMapper * mapper : this->GetMappers())                                    \
    {                                                                                              \
      mapper->Set##name(value);                                                                    \
    }                                                                                              \
  }

STEERABLENOISE_FORWARD(FeaturePixels, double)
STEERABLENOISE_FORWARD(FeatureSize, double)
STEERABLENOISE_FORWARD(StreakLength, double)
STEERABLENOISE_FORWARD(EigenvalueSum, double)
STEERABLENOISE_FORWARD(Strength, double)
STEERABLENOISE_FORWARD(ReferenceMagnitude, double)
STEERABLENOISE_FORWARD(MaskThreshold, double)
STEERABLENOISE_FORWARD(Density, double)
STEERABLENOISE_FORWARD(Phase, double)
STEERABLENOISE_FORWARD(Speed, double)
STEERABLENOISE_FORWARD(TimePeriod, double)
STEERABLENOISE_FORWARD(Lacunarity, double)
STEERABLENOISE_FORWARD(Gain, double)
STEERABLENOISE_FORWARD(NoiseIntensity, double)
STEERABLENOISE_FORWARD(NoiseContrast, double)
STEERABLENOISE_FORWARD(FeatureSizeMode, int)
STEERABLENOISE_FORWARD(StrengthMode, int)
STEERABLENOISE_FORWARD(Basis, int)
STEERABLENOISE_FORWARD(Octaves, int)
STEERABLENOISE_FORWARD(Seed, int)
STEERABLENOISE_FORWARD(FollowCurvature, bool)
STEERABLENOISE_FORWARD(Animate, bool)
STEERABLENOISE_FORWARD(VectorsPerCell, bool)
STEERABLENOISE_FORWARD(UseMaskColor, bool)

// All ranks look for fill values together, in RequestData.
void vtkSteerableNoiseRepresentation::SetMaskUpperThreshold(double threshold)
{
  for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetMaskUpperThreshold(threshold);
  }
  this->MarkModified();
}

// A mapper's own ColorMode is VTK's.
void vtkSteerableNoiseRepresentation::SetColorMode(int mode)
{
  for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetNoiseColorMode(mode);
  }
}

void vtkSteerableNoiseRepresentation::SetMaskColor(double red, double green, double blue)
{
  for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetMaskColor(red, green, blue);
  }
}

int vtkSteerableNoiseRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  // Each rank draws its own part: without this, automatic sizes would differ from part to part.
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    const auto mappers = this->GetMappers();
    mappers[0]->ShareExtremes(this->GeometryFilter->GetOutputDataObject(0), controller);
    std::for_each(mappers.begin() + 1, mappers.end(),
      [&](vtkSteerableNoiseMapper* mapper) { mapper->ShareExtremes(mappers[0]); });
  }
  return result;
}

int vtkSteerableNoiseRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (request == vtkPVView::REQUEST_RENDER())
  {
    for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
    {
      mapper->SetTime(this->GetUpdateTimeValid() ? this->GetUpdateTime() : 0.0);
    }
  }
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}

void vtkSteerableNoiseRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
