// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the classes of subband noise call and number alike (private to this module).
 */
#ifndef SubbandNames_h
#define SubbandNames_h

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"

#include <string>

namespace noise
{
/// 3, or of 4, 6 and 8 the largest that is not above `orientations`, at least 4; another one with a warning.
inline int TakeOrientations(vtkObject* self, int orientations)
{
  const int allowed = orientations == 3 ? 3 : orientations >= 8 ? 8 : orientations >= 6 ? 6 : 4;
  if (allowed != orientations)
  {
    vtkWarningWithObjectMacro(self,
      "Orientations can be 3, 4, 6 or 8, not " << orientations << ": " << allowed << " was taken.");
  }
  return allowed;
}

/// Names components o<i>s<j>, orientation fastest; `plane` is put in front.
inline void NameSubbands(vtkDataArray* array, int orientations, int scales,
  const std::string& plane = std::string(), int first = 0)
{
  for (int j = 0; j < scales; ++j)
  {
    for (int i = 0; i < orientations; ++i)
    {
      const std::string name = plane + "o" + std::to_string(i) + "s" + std::to_string(j);
      array->SetComponentName(first + j * orientations + i, name.c_str());
    }
  }
}

/// Names the residuals of an image after its bands: o<i>high and low.
inline void NameResiduals(vtkDataArray* array, int orientations, int first)
{
  for (int i = 0; i < orientations; ++i)
  {
    array->SetComponentName(first + i, ("o" + std::to_string(i) + "high").c_str());
  }
  array->SetComponentName(first + orientations, "low");
}

/// Orientations and scales that NameSubbands named components by, from the first on; false: none.
inline bool CountSubbands(vtkDataArray* array, int& orientations, int& scales)
{
  const auto isNamed = [array](int component, int i, int j)
  {
    const std::string name = "o" + std::to_string(i) + "s" + std::to_string(j);
    return component < array->GetNumberOfComponents() && array->GetComponentName(component) &&
      name == array->GetComponentName(component);
  };
  for (orientations = 0; isNamed(orientations, orientations, 0);)
  {
    ++orientations;
  }
  for (scales = 0; orientations > 0 && isNamed(scales * orientations, 0, scales);)
  {
    ++scales;
  }
  return scales > 0 && scales * orientations <= array->GetNumberOfComponents();
}

/// Field array that says which frequency the finest of an image's bands is centred at, cycles per
/// pixel.
constexpr const char* BandCenterName = "BandCenter";

inline void AddBandCenter(vtkDataObject* image, double center)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(BandCenterName);
  array->InsertNextValue(center);
  image->GetFieldData()->AddArray(array);
}
} // namespace noise

#endif
