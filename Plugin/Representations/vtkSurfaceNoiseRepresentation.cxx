// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSurfaceNoiseRepresentation.h"

#include "vtkMapper.h"
#include "vtkPVView.h"
#include "vtkSurfaceNoiseMapper.h"

vtkSurfaceNoiseRepresentation::vtkSurfaceNoiseRepresentation() = default;

vtkSurfaceNoiseRepresentation::~vtkSurfaceNoiseRepresentation() = default;

void vtkSurfaceNoiseRepresentation::Replace(vtkMapper** mapper, vtkSurfaceNoiseMapper* by)
{
  (*mapper)->Delete();
  *mapper = by;
}

std::array<vtkSurfaceNoiseMapper*, 4> vtkSurfaceNoiseRepresentation::GetMappers()
{
  return { vtkSurfaceNoiseMapper::SafeDownCast(this->Mapper),
    vtkSurfaceNoiseMapper::SafeDownCast(this->LODMapper),
    vtkSurfaceNoiseMapper::SafeDownCast(this->BackfaceMapper),
    vtkSurfaceNoiseMapper::SafeDownCast(this->LODBackfaceMapper) };
}

void vtkSurfaceNoiseRepresentation::SelectInputVectors(
  int, int, int, int association, const char* name)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetInputArrayToProcess(0, 0, 0, association, name ? name : "");
  }
}

// A mapper's own ColorMode is VTK's.
void vtkSurfaceNoiseRepresentation::SetColorMode(int mode)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetNoiseColorMode(mode);
  }
}

void vtkSurfaceNoiseRepresentation::SetNoiseIntensity(double value)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetNoiseIntensity(value);
  }
}

void vtkSurfaceNoiseRepresentation::SetNoiseContrast(double value)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetNoiseContrast(value);
  }
}

void vtkSurfaceNoiseRepresentation::SetUseMaskColor(bool value)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetUseMaskColor(value);
  }
}

void vtkSurfaceNoiseRepresentation::SetMaskColor(double red, double green, double blue)
{
  for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
  {
    mapper->SetMaskColor(red, green, blue);
  }
}

int vtkSurfaceNoiseRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (request == vtkPVView::REQUEST_RENDER())
  {
    for (vtkSurfaceNoiseMapper* mapper : this->GetMappers())
    {
      mapper->SetTime(this->GetUpdateTimeValid() ? this->GetUpdateTime() : 0.0);
    }
  }
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}
