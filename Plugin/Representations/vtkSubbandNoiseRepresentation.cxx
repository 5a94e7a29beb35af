// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSubbandNoiseRepresentation.h"

#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVGeometryFilter.h"
#include "vtkPVView.h"
#include "vtkSubbandNoiseMapper.h"

#include <algorithm>

vtkStandardNewMacro(vtkSubbandNoiseRepresentation);

vtkSubbandNoiseRepresentation::vtkSubbandNoiseRepresentation()
{
  this->UseMappers<vtkSubbandNoiseMapper>();
}

vtkSubbandNoiseRepresentation::~vtkSubbandNoiseRepresentation() = default;

std::array<vtkSubbandNoiseMapper*, 4> vtkSubbandNoiseRepresentation::GetSubbandMappers()
{
  const auto mappers = this->GetMappers();
  std::array<vtkSubbandNoiseMapper*, 4> subband;
  std::transform(mappers.begin(), mappers.end(), subband.begin(),
    [](vtkSurfaceNoiseMapper* mapper) { return vtkSubbandNoiseMapper::SafeDownCast(mapper); });
  return subband;
}

// All ranks agree on what comes from the whole surface, in RequestData.
void vtkSubbandNoiseRepresentation::SelectInputVectors(
  int port, int connection, int index, int association, const char* name)
{
  this->Superclass::SelectInputVectors(port, connection, index, association, name);
  this->MarkModified();
}

#define SUBBANDNOISE_FORWARD_AS(name, own, type, AFTER)                                             \
  void vtkSubbandNoiseRepresentation::Set##own(type value)                                         \
  {                                                                                                \
    for (vtkSubbandNoiseMapper * mapper : this->GetSubbandMappers())                               \
    {                                                                                              \
      mapper->Set##name(value);                                                                    \
    }                                                                                              \
    AFTER;                                                                                         \
  }
#define SUBBANDNOISE_FORWARD(name, type, AFTER) SUBBANDNOISE_FORWARD_AS(name, name, type, AFTER)

SUBBANDNOISE_FORWARD(Wavelength, double, this->MarkModified())
SUBBANDNOISE_FORWARD_AS(Anisotropy, NoiseAnisotropy, double, this->MarkModified())
SUBBANDNOISE_FORWARD(Parameterization, int, this->MarkModified())
SUBBANDNOISE_FORWARD(Method, int, this->MarkModified())
SUBBANDNOISE_FORWARD(Orientations, int, this->MarkModified())
SUBBANDNOISE_FORWARD(WrapSeams, bool, this->MarkModified())
SUBBANDNOISE_FORWARD(BlendSeams, bool, this->MarkModified())
SUBBANDNOISE_FORWARD(TileSize, int, this->MarkModified())
SUBBANDNOISE_FORWARD(Octaves, int, )
SUBBANDNOISE_FORWARD(Persistence, double, )
SUBBANDNOISE_FORWARD(Function, int, )
SUBBANDNOISE_FORWARD(AntiAlias, bool, )
SUBBANDNOISE_FORWARD(Seed, int, )
SUBBANDNOISE_FORWARD(Phase, double, )
SUBBANDNOISE_FORWARD(TimePeriod, double, )
SUBBANDNOISE_FORWARD_AS(Interpolation, NoiseInterpolation, int, )

int vtkSubbandNoiseRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int result = this->Superclass::RequestData(request, inputs, outputs);
  vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController();
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    this->GetSubbandMappers()[0]->ShareExtremes(
      this->GeometryFilter->GetOutputDataObject(0), controller);
  }
  return result;
}

int vtkSubbandNoiseRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (request == vtkPVView::REQUEST_RENDER())
  {
    // A level of detail and back faces show the noise of the surface.
    const auto mappers = this->GetSubbandMappers();
    std::for_each(mappers.begin() + 1, mappers.end(),
      [&](vtkSubbandNoiseMapper* mapper) { mapper->ShareExtremes(mappers[0]); });
  }
  return this->Superclass::ProcessViewRequest(request, inInfo, outInfo);
}

void vtkSubbandNoiseRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
