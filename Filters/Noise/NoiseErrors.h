// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Errors of RequestData as one sentence (private to this module).
 */
#ifndef NoiseErrors_h
#define NoiseErrors_h

#include "vtkDataObject.h"
#include "vtkObject.h"

#include <string>

namespace noise
{
/// Empties `output` and says `why`. Returns 1: after a 0 the executive would add a page of its own.
inline int Refuse(vtkObject* self, vtkDataObject* output, const std::string& why)
{
  output->Initialize();
  vtkErrorWithObjectMacro(self, << why);
  return 1;
}
} // namespace noise

#endif
