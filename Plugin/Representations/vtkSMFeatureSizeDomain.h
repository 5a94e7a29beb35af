// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMFeatureSizeDomain
 * @brief   for a size whose 0 is automatic: its reset is the size in use
 *
 * A BoundsDomain, so that ParaView's panel offers to scale the value and to reset it. Reset fills in what the required
 * property "InUse", an information property, says since the last update, to scale it from there; before the first
 * update it is 0, automatic. In XML: FeatureSizeDomain.
 */
#ifndef vtkSMFeatureSizeDomain_h
#define vtkSMFeatureSizeDomain_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro
#include "vtkSMBoundsDomain.h"

class STEERABLENOISEREPRESENTATIONS_EXPORT vtkSMFeatureSizeDomain : public vtkSMBoundsDomain
{
public:
  static vtkSMFeatureSizeDomain* New();
  vtkTypeMacro(vtkSMFeatureSizeDomain, vtkSMBoundsDomain);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  int SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues) override;

protected:
  vtkSMFeatureSizeDomain();
  ~vtkSMFeatureSizeDomain() override;

private:
  vtkSMFeatureSizeDomain(const vtkSMFeatureSizeDomain&) = delete;
  void operator=(const vtkSMFeatureSizeDomain&) = delete;
};

#endif
