// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Which array steers noise when nobody names one: the rule, which knows of arrays only what a client knows. Shared
 * with this project's ParaView classes, so that a panel shows what the filters would take.
 */
#ifndef SteeringChoice_h
#define SteeringChoice_h

#include "SteerableNoiseFiltersModule.h" // For export macro

#include <string>
#include <vector>

namespace noise
{
struct ArrayFacts
{
  std::string Name;
  /// VTK_FLOAT and such.
  int DataType = 0;
  int Components = 0;
  /// As which vtkDataSetAttributes::AttributeTypes it is active, -1 if none.
  int Attribute = -1;
};

/// Not normals, texture coordinates or colours, which steer nothing even when they are named.
STEERABLENOISEFILTERS_EXPORT bool MaySteer(const ArrayFacts& array);

/**
 * Index of the array that steers, of those on points or of those on cells: active vectors, else of the
 * floating-point arrays with 3 components that may steer the first by the alphabet, else active tensors; -1 if
 * there is none.
 */
STEERABLENOISEFILTERS_EXPORT int ChooseArray(const std::vector<ArrayFacts>& arrays);
} // namespace noise

#endif
