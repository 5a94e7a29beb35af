// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMSteeringArrayDomain.h"

#include "SteeringChoice.h"

#include "vtkDataObject.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"

#include <vector>

vtkStandardNewMacro(vtkSMSteeringArrayDomain);

namespace
{
std::vector<noise::ArrayFacts> GetFacts(vtkPVDataInformation* information, int association)
{
  std::vector<noise::ArrayFacts> arrays;
  auto* attributes = information ? information->GetAttributeInformation(association) : nullptr;
  for (int i = 0; attributes && i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkPVArrayInformation* array = attributes->GetArrayInformation(i);
    noise::ArrayFacts facts;
    facts.Name = array->GetName() ? array->GetName() : "";
    facts.DataType = array->GetDataType();
    facts.Components = array->GetNumberOfComponents();
    facts.Attribute = attributes->IsArrayAnAttribute(i);
    arrays.push_back(facts);
  }
  return arrays;
}
} // namespace

//------------------------------------------------------------------------------
vtkSMSteeringArrayDomain::vtkSMSteeringArrayDomain() = default;

//------------------------------------------------------------------------------
vtkSMSteeringArrayDomain::~vtkSMSteeringArrayDomain() = default;

//------------------------------------------------------------------------------
int vtkSMSteeringArrayDomain::SetDefaultValues(vtkSMProperty* property, bool useUncheckedValues)
{
  vtkPVDataInformation* information = this->GetInputDataInformation("Input");
  // As the filter: points, then cells.
  for (const int association : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    const std::vector<noise::ArrayFacts> arrays = GetFacts(information, association);
    const int chosen = noise::ChooseArray(arrays);
    for (unsigned int i = 0; chosen >= 0 && i < this->GetNumberOfStrings(); ++i)
    {
      // The list may offer less than there is.
      if (this->GetFieldAssociation(i) == association &&
        arrays[static_cast<std::size_t>(chosen)].Name == this->GetString(i))
      {
        vtkSMPropertyHelper helper(property);
        helper.SetUseUnchecked(useUncheckedValues);
        helper.SetInputArrayToProcess(association, this->GetString(i));
        return 1;
      }
    }
  }
  return this->Superclass::SetDefaultValues(property, useUncheckedValues);
}

//------------------------------------------------------------------------------
bool vtkSMSteeringArrayDomain::IsFilteredArray(
  vtkPVDataInformation* information, int association, const char* arrayName)
{
  for (const noise::ArrayFacts& array : GetFacts(information, association))
  {
    if (arrayName && array.Name == arrayName)
    {
      return !noise::MaySteer(array);
    }
  }
  return this->Superclass::IsFilteredArray(information, association, arrayName);
}

//------------------------------------------------------------------------------
void vtkSMSteeringArrayDomain::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
