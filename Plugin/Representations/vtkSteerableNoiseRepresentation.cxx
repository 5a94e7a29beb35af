// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteerableNoiseRepresentation.h"

#include "vtkBoundingBox.h"
#include "vtkCommunicator.h"
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
    vtkBoundingBox bounds;
    double longest = 0.0;
    this->GetMappers()[0]->AddExtremes(this->GeometryFilter->GetOutputDataObject(0), bounds, longest);
    double low[3] = { 1e300, 1e300, 1e300 };
    double high[3] = { -1e300, -1e300, -1e300 };
    if (bounds.IsValid())
    {
      bounds.GetMinPoint(low[0], low[1], low[2]);
      bounds.GetMaxPoint(high[0], high[1], high[2]);
    }
    const double mine[7] = { low[0], low[1], low[2], -high[0], -high[1], -high[2], -longest };
    double all[7];
    controller->AllReduce(mine, all, 7, vtkCommunicator::MIN_OP);
    const vtkBoundingBox whole(all[0], -all[3], all[1], -all[4], all[2], -all[5]);
    for (vtkSteerableNoiseMapper* mapper : this->GetMappers())
    {
      mapper->SetSharedExtremes(whole, -all[6]);
    }
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
