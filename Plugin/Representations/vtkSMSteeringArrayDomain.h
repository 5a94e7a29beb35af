// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMSteeringArrayDomain
 * @brief   arrays that can steer noise, for a property that chooses one
 *
 * An ArrayListDomain without normals, texture coordinates and colours. Where there are no active vectors it preselects
 * what the filter itself would take, not the first array of the list. In XML: SteeringArrayDomain.
 */
#ifndef vtkSMSteeringArrayDomain_h
#define vtkSMSteeringArrayDomain_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro
#include "vtkSMArrayListDomain.h"

class STEERABLENOISEREPRESENTATIONS_EXPORT vtkSMSteeringArrayDomain : public vtkSMArrayListDomain
{
public:
  static vtkSMSteeringArrayDomain* New();
  vtkTypeMacro(vtkSMSteeringArrayDomain, vtkSMArrayListDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMSteeringArrayDomain();
  ~vtkSMSteeringArrayDomain() override;

  bool IsFilteredArray(
    vtkPVDataInformation* information, int association, const char* arrayName) override;

private:
  vtkSMSteeringArrayDomain(const vtkSMSteeringArrayDomain&) = delete;
  void operator=(const vtkSMSteeringArrayDomain&) = delete;
};

#endif
