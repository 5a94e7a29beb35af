// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteerableNoiseRepresentation.h"

#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVGeometryFilter.h"
#include "vtkSteerableNoiseMapper.h"

#include <algorithm>

vtkStandardNewMacro(vtkSteerableNoiseRepresentation);

vtkSteerableNoiseRepresentation::vtkSteerableNoiseRepresentation()
{
  this->UseMappers<vtkSteerableNoiseMapper>();
}

vtkSteerableNoiseRepresentation::~vtkSteerableNoiseRepresentation() = default;

std::array<vtkSteerableNoiseMapper*, 4> vtkSteerableNoiseRepresentation::GetSteerableMappers()
{
  const auto mappers = this->GetMappers();
  std::array<vtkSteerableNoiseMapper*, 4> steerable;
  std::transform(mappers.begin(), mappers.end(), steerable.begin(),
    [](vtkSurfaceNoiseMapper* mapper) { return vtkSteerableNoiseMapper::SafeDownCast(mapper); });
  return steerable;
}

#define STEERABLENOISE_FORWARD(name, type)                                                         \
  void vtkSteerableNoiseRepresentation::Set##name(type value)                                      \
  {                                                                                                \
    for (vtkSteerableNoiseMapper * mapper : this->GetSteerableMappers())                                    \
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
STEERABLENOISE_FORWARD(FeatureSizeMode, int)
STEERABLENOISE_FORWARD(StrengthMode, int)
STEERABLENOISE_FORWARD(Basis, int)
STEERABLENOISE_FORWARD(Octaves, int)
STEERABLENOISE_FORWARD(Seed, int)
STEERABLENOISE_FORWARD(FollowCurvature, bool)
STEERABLENOISE_FORWARD(Animate, bool)
STEERABLENOISE_FORWARD(VectorsPerCell, bool)

// All ranks look for fill values together, in RequestData.
void vtkSteerableNoiseRepresentation::SetMaskUpperThreshold(double threshold)
{
  for (vtkSteerableNoiseMapper* mapper : this->GetSteerableMappers())
  {
    mapper->SetMaskUpperThreshold(threshold);
  }
  this->MarkModified();
}

int vtkSteerableNoiseRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  // Each rank draws its own part: without this, automatic sizes would differ from part to part.
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    const auto mappers = this->GetSteerableMappers();
    mappers[0]->ShareExtremes(this->GeometryFilter->GetOutputDataObject(0), controller);
    std::for_each(mappers.begin() + 1, mappers.end(),
      [&](vtkSteerableNoiseMapper* mapper) { mapper->ShareExtremes(mappers[0]); });
  }
  return result;
}

void vtkSteerableNoiseRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
