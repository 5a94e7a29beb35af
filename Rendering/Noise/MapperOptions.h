// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How mappers of noise write their setters, and visit their input (private).
 */
#ifndef MapperOptions_h
#define MapperOptions_h

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>

namespace noise
{
/// NaN becomes the lower limit.
template <class T>
T Clamp(T value, T low, T high)
{
  return value >= low ? std::min(value, high) : low;
}

template <class Visit>
void ForEachPolyData(vtkDataObject* input, Visit&& visit)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    vtkSmartPointer<vtkCompositeDataIterator> iterator;
    iterator.TakeReference(composite->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      if (auto* data = vtkPolyData::SafeDownCast(iterator->GetCurrentDataObject()))
      {
        visit(data);
      }
    }
  }
  else if (auto* data = vtkPolyData::SafeDownCast(input))
  {
    visit(data);
  }
}
} // namespace noise

// Options that are drawn, not computed from: they leave the modification time alone, which would upload all
// vertices again. Where more depends on them, AFTER is what follows a change.
#define NOISE_OPTION(cls, name, type, member, value, AFTER)                                        \
  void cls::Set##name(type name)                                                                   \
  {                                                                                                \
    const auto wanted = value;                                                                     \
    if (!(member == wanted))                                                                       \
    {                                                                                              \
      member = wanted;                                                                             \
      AFTER;                                                                                       \
    }                                                                                              \
  }                                                                                                \
  type cls::Get##name()                                                                            \
  {                                                                                                \
    return static_cast<type>(member);                                                              \
  }

#endif
