// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * VTK's arrays as the kernel's tuple readers (private to this module): any value type, any memory
 * layout, 2 or 3 components for vectors and 4, 6 or 9 for tensors. Arrays that already lie as the
 * kernel wants them are read in place.
 */
#ifndef NoiseArrays_h
#define NoiseArrays_h

#include "SteerableNoise.h"

#include "vtkType.h"

#include <array>
#include <memory>

class vtkDataArray;
class vtkDataSet;
class vtkDataSetAttributes;

namespace noise
{
/// Rotation from world axes to the axes of the noise, row by row.
using Axes = std::array<std::array<double, 3>, 3>;
constexpr Axes WorldAxes = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };

inline bool IsVector(int components)
{
  return components == 2 || components == 3;
}

inline bool IsTensor(int components)
{
  return components == 4 || components == 6 || components == 9;
}

/**
 * Vectors along the first two or all three of `axes`. Two components are those of the first two world
 * axes, or of the plane itself if `inPlane`.
 */
std::unique_ptr<steerable::TupleReader<float>> MakeVectorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane);

/// Symmetric part of tensors as XX YY ZZ XY YZ XZ along `axes`. Four components: XX XY YX YY.
std::unique_ptr<steerable::TupleReader<float>> MakeTensorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane);

/// Coordinates of 3-component arrays.
std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataArray* array);

/// Points of a dataset without an array of them; its GetPoint must be safe to call from threads.
std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataSet* dataset);

/**
 * The array that steers the noise when nobody named one: active vectors, else the first floating-point
 * array of 3 components that is neither normals nor texture coordinates, else active tensors.
 */
vtkDataArray* FindDefaultArray(vtkDataSetAttributes* attributes);
} // namespace noise

#endif
