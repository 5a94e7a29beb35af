// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceNoiseRepresentation
 * @brief   ParaView's surface representation with a mapper of noise
 *
 * Hands properties on to its mappers, which document them: here those that all mappers of noise have; and gives the
 * mappers the time of the view.
 *
 * @sa
 * vtkSurfaceNoiseMapper
 */
#ifndef vtkSurfaceNoiseRepresentation_h
#define vtkSurfaceNoiseRepresentation_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro
#include "vtkGeometryRepresentationWithFaces.h"

#include <array> // For mappers

class vtkSurfaceNoiseMapper;

class STEERABLENOISEREPRESENTATIONS_EXPORT vtkSurfaceNoiseRepresentation
  : public vtkGeometryRepresentationWithFaces
{
public:
  vtkTypeMacro(vtkSurfaceNoiseRepresentation, vtkGeometryRepresentationWithFaces);

  /// The array that steers; association as in vtkDataObject::FieldAssociations.
  void SelectInputVectors(int, int, int, int association, const char* name);

  ///@{
  /// See vtkSurfaceNoiseMapper.
  void SetColorMode(int mode);
  void SetNoiseIntensity(double value);
  void SetNoiseContrast(double value);
  void SetUseMaskColor(bool value);
  void SetMaskColor(double red, double green, double blue);
  ///@}

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* inInfo,
    vtkInformation* outInfo) override;

protected:
  vtkSurfaceNoiseRepresentation();
  ~vtkSurfaceNoiseRepresentation() override;

  /// In constructors: what makes mappers.
  template <class Mapper>
  void UseMappers()
  {
    for (vtkMapper** mapper :
      { &this->Mapper, &this->LODMapper, &this->BackfaceMapper, &this->LODBackfaceMapper })
    {
      this->Replace(mapper, Mapper::New());
    }
    this->SetupDefaults();
  }

  /// Of the surface, of its level of detail, and of the back faces of both.
  std::array<vtkSurfaceNoiseMapper*, 4> GetMappers();

private:
  vtkSurfaceNoiseRepresentation(const vtkSurfaceNoiseRepresentation&) = delete;
  void operator=(const vtkSurfaceNoiseRepresentation&) = delete;

  static void Replace(vtkMapper** mapper, vtkSurfaceNoiseMapper* by);
};

#endif
