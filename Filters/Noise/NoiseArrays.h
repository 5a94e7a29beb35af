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
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkDataSetAttributes;
class vtkInformation;

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

/// World axes that vectors of two components (tensors of four) lie along, outside of images.
using Plane = std::array<int, 2>;
constexpr Plane WorldPlane = { 0, 1 };

/**
 * Vectors along the first two or all three of `axes`. Two components are those of the axes of `plane`, or of the plane itself if `inPlane`.
 */
std::unique_ptr<steerable::TupleReader<float>> MakeVectorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane = WorldPlane);

/// Symmetric part of tensors as XX YY ZZ XY YZ XZ along `axes`. Four components: XX XY YX YY.
std::unique_ptr<steerable::TupleReader<float>> MakeTensorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane = WorldPlane);

/**
 * The same as metrics: in double, times `factor`, and with a third axis where there are four
 * components, which reaches as far as the mean of the two.
 */
std::unique_ptr<steerable::TupleReader<double>> MakeMetricReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane, double factor);

/// Name of the array that SetInputArrayToProcess chose; empty without one, or where it is "None".
std::string GetChosenName(vtkInformation* choice);

/// Arrays that StreakLength, Strength and EigenvalueSum come from, null where they are the same for
/// all samples.
using ShapeArrays = std::array<vtkDataArray*, 3>;

/// The three of each sample: values of one component, lengths of vectors, and NaN where there is no
/// array.
std::unique_ptr<steerable::TupleReader<float>> MakeShapeReader(const ShapeArrays& arrays);

/// Coordinates of 3-component arrays.
std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataArray* array);

/// Points of a dataset without an array of them; its GetPoint must be safe to call from threads.
std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataSet* dataset);

/**
 * Tuples of `reader`, which it takes over, with NaN where `left` out: one value for each, not 0 where the
 * sample shall neither have a direction nor lend one to its neighbours. `left` has to outlive it.
 */
std::unique_ptr<steerable::TupleReader<float>> LeaveOut(
  std::unique_ptr<steerable::TupleReader<float>> reader, int components,
  const std::vector<unsigned char>& left);

std::unique_ptr<steerable::TupleReader<double>> LeaveOut(
  std::unique_ptr<steerable::TupleReader<double>> reader, int components,
  const std::vector<unsigned char>& left);

/**
 * Lengths of the tuples [first, first + count): Euclidean for vectors, all components counted; for tensors
 * the Frobenius norm of their symmetric part. Numbers too large to be squared have the length of the largest
 * one.
 */
void ReadLengths(vtkDataArray* array, std::size_t first, std::size_t count, double* lengths);

/// The component of the largest amount in tuple `index`; NaN beside others does not count.
double GetLargestComponent(vtkDataArray* array, vtkIdType index);

/**
 * The array that steers the noise when nobody named one, as ChooseArray (SteeringChoice.h) has it.
 */
vtkDataArray* FindDefaultArray(vtkDataSetAttributes* attributes);
} // namespace noise

#endif
