// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMFeatureSizeDomain.h"

#include "vtkObjectFactory.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"

vtkStandardNewMacro(vtkSMFeatureSizeDomain);

//------------------------------------------------------------------------------
vtkSMFeatureSizeDomain::vtkSMFeatureSizeDomain() = default;

//------------------------------------------------------------------------------
vtkSMFeatureSizeDomain::~vtkSMFeatureSizeDomain() = default;

//------------------------------------------------------------------------------
int vtkSMFeatureSizeDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  vtkSMProperty* inUse = this->GetRequiredProperty("InUse");
  double size = 0.0;
  if (inUse && inUse->GetParent())
  {
    inUse->GetParent()->UpdatePropertyInformation(inUse);
    size = vtkSMPropertyHelper(inUse).GetAsDouble();
  }
  vtkSMPropertyHelper helper(property);
  helper.SetUseUnchecked(useUncheckedValues);
  helper.Set(size);
  return 1;
}

//------------------------------------------------------------------------------
void vtkSMFeatureSizeDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
