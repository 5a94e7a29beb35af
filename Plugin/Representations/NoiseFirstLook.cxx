// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseFirstLook.h"

#include "vtkCallbackCommand.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVRenderViewSettings.h"
#include "vtkProcessModule.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSettings.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMStringListDomain.h"

#include <cstring>
#include <string>

namespace
{
/// As ParaView keeps a colour map that a user has saved as the default of an array. -1: data do not rescale it.
const char* const Colors = R"({
  "array_lookup_tables" : {
    "SteerableNoise" : {
      "PVLookupTable" : {
        "AutomaticRescaleRangeMode" : -1,
        "ColorSpace" : 0,
        "NanColor" : [ 0.5, 0.5, 0.5 ],
        "RGBPoints" : [ -2.0, 0.0, 0.0, 0.0, 2.0, 1.0, 1.0, 1.0 ],
        "ScalarRangeInitialized" : 1
      }
    }
  }
})";

/// The array of noise that `source` has made.
vtkPVArrayInformation* FindNoise(vtkSMSourceProxy* source, int& association)
{
  const char* name = vtkSMPropertyHelper(source, "ResultArrayName").GetAsString();
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    if (auto* found = source->GetDataInformation(0)->GetArrayInformation(name, where))
    {
      association = where;
      return found;
    }
  }
  return nullptr;
}

/**
 * When one of our filters is shown first, noise is seen. ParaView shows volumes as outlines (those above the user's
 * limit stay so), and a filter's output in one colour where its input has one.
 */
void ShowNoise(vtkObject*, unsigned long, void*, void* data)
{
  auto* info = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(data);
  if (!info || !info->Proxy || !info->GroupName || std::strcmp(info->GroupName, "representations") != 0 ||
    info->Proxy->GetSessionProxyManager()->GetInLoadXMLState())
  {
    return;
  }
  vtkSMProperty* inputs = info->Proxy->GetProperty("Input");
  vtkSMProperty* type = info->Proxy->GetProperty("Representation");
  auto* source = inputs && type
    ? vtkSMSourceProxy::SafeDownCast(vtkSMPropertyHelper(inputs).GetAsProxy(0))
    : nullptr;
  const std::string name = source && source->GetXMLName() ? source->GetXMLName() : "";
  if (name != "FlowNoise" && name != "SteerableNoise")
  {
    return;
  }
  const double most = 1e6 * vtkPVRenderViewSettings::GetInstance()->GetOutlineThreshold();
  if (source->GetDataInformation(0)->GetNumberOfCells() >= most)
  {
    return;
  }
  if (name == "FlowNoise")
  {
    const char* const ours = "Steerable Noise";
    auto* types = type->FindDomain<vtkSMStringListDomain>();
    unsigned int index = 0;
    if (types && types->IsInDomain(ours, index))
    {
      vtkSMPropertyHelper(type).Set(ours);
    }
  }
  else
  {
    int association = 0;
    vtkPVArrayInformation* noise = FindNoise(source, association);
    auto* shown = vtkSMPVRepresentationProxy::SafeDownCast(info->Proxy);
    if (noise && shown)
    {
      if (std::strcmp(vtkSMPropertyHelper(type).GetAsString(), "Outline") == 0)
      {
        vtkSMPropertyHelper(type).Set("Surface");
      }
      shown->SetScalarColoring(noise->GetName(), association);
    }
  }
  info->Proxy->UpdateVTKObjects();
}
} // namespace

void SteerableNoiseSetFirstLook()
{
  const auto process = vtkProcessModule::GetProcessType();
  if (process != vtkProcessModule::PROCESS_CLIENT && process != vtkProcessModule::PROCESS_BATCH)
  {
    return; // servers have neither colours nor displays
  }
  // What a user has saved comes first: priorities of sites and users are larger.
  vtkSMSettings::GetInstance()->AddCollectionFromString(Colors, 0.0);
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(ShowNoise);
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, command);
}
