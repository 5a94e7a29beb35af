// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSteerableNoiseRepresentation
 * @brief   ParaView's surface representation with vtkSteerableNoiseMapper
 *
 * Hands its properties on to its mappers, which document them, and lets all ranks agree on what automatic values come
 * from.
 *
 * @sa
 * vtkSteerableNoiseMapper
 */
#ifndef vtkSteerableNoiseRepresentation_h
#define vtkSteerableNoiseRepresentation_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro
#include "vtkSurfaceNoiseRepresentation.h"

#include <array> // For mappers

class vtkSteerableNoiseMapper;

class STEERABLENOISEREPRESENTATIONS_EXPORT vtkSteerableNoiseRepresentation
  : public vtkSurfaceNoiseRepresentation
{
public:
  static vtkSteerableNoiseRepresentation* New();
  vtkTypeMacro(vtkSteerableNoiseRepresentation, vtkSurfaceNoiseRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// See vtkSteerableNoiseMapper.
  void SetFeaturePixels(double value);
  void SetFeatureSize(double value);
  void SetStreakLength(double value);
  void SetEigenvalueSum(double value);
  void SetStrength(double value);
  void SetReferenceMagnitude(double value);
  void SetMaskThreshold(double value);
  void SetMaskUpperThreshold(double threshold);
  void SetDensity(double value);
  void SetPhase(double value);
  void SetSpeed(double value);
  void SetTimePeriod(double value);
  void SetLacunarity(double value);
  void SetGain(double value);
  void SetFeatureSizeMode(int value);
  void SetStrengthMode(int value);
  void SetBasis(int value);
  void SetOctaves(int value);
  void SetSeed(int value);
  void SetFollowCurvature(bool value);
  void SetAnimate(bool value);
  void SetVectorsPerCell(bool value);
  ///@}

protected:
  vtkSteerableNoiseRepresentation();
  ~vtkSteerableNoiseRepresentation() override;

  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkSteerableNoiseRepresentation(const vtkSteerableNoiseRepresentation&) = delete;
  void operator=(const vtkSteerableNoiseRepresentation&) = delete;

  std::array<vtkSteerableNoiseMapper*, 4> GetSteerableMappers();
};

#endif
