// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSubbandNoiseRepresentation
 * @brief   ParaView's surface representation with vtkSubbandNoiseMapper
 *
 * Hands its properties on to its mappers, which document them, and lets all ranks agree on wavelength and tiles.
 *
 * @sa
 * vtkSubbandNoiseMapper
 */
#ifndef vtkSubbandNoiseRepresentation_h
#define vtkSubbandNoiseRepresentation_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro
#include "vtkSurfaceNoiseRepresentation.h"

#include <array> // For mappers

class vtkSubbandNoiseMapper;

class STEERABLENOISEREPRESENTATIONS_EXPORT vtkSubbandNoiseRepresentation
  : public vtkSurfaceNoiseRepresentation
{
public:
  static vtkSubbandNoiseRepresentation* New();
  vtkTypeMacro(vtkSubbandNoiseRepresentation, vtkSurfaceNoiseRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The array that steers; no name or None: nothing does.
  void SelectInputVectors(int, int, int, int association, const char* name);

  ///@{
  /// See vtkSubbandNoiseMapper.
  void SetWavelength(double value);
  void SetParameterization(int value);
  void SetMethod(int value);
  void SetOrientations(int value);
  void SetWrapSeams(bool value);
  void SetBlendSeams(bool value);
  void SetTileSize(int value);
  void SetOctaves(int value);
  void SetPersistence(double value);
  void SetFunction(int value);
  void SetAntiAlias(bool value);
  void SetSeed(int value);
  void SetPhase(double value);
  void SetTimePeriod(double value);
  ///@}

  ///@{
  /// Likewise; the superclass has other ones by the mapper's names.
  void SetNoiseAnisotropy(double value);
  void SetNoiseInterpolation(int value);
  ///@}

  int ProcessViewRequest(vtkInformationRequestKey* request, vtkInformation* inInfo,
    vtkInformation* outInfo) override;

protected:
  vtkSubbandNoiseRepresentation();
  ~vtkSubbandNoiseRepresentation() override;

  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSubbandNoiseRepresentation(const vtkSubbandNoiseRepresentation&) = delete;
  void operator=(const vtkSubbandNoiseRepresentation&) = delete;

  std::array<vtkSubbandNoiseMapper*, 4> GetSubbandMappers();
};

#endif
