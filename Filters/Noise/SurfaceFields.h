// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What steers noise at the points of a surface, as a renderer wants it: vectors or tensors, normals and
 * curvature, the same as vtkSteerableNoiseFilter takes. Shared with this project's rendering module.
 */
#ifndef SurfaceFields_h
#define SurfaceFields_h

#include "SteerableNoiseFiltersModule.h" // For export macro

#include "vtkFloatArray.h"
#include "vtkSmartPointer.h"

#include <limits>
#include <string>

class vtkDataArray;
class vtkDataSet;
class vtkInformation;
class vtkPolyData;

namespace noise
{
struct SurfaceFields
{
  /**
   * 3 components (vectors) or 6 (tensors, XX YY ZZ XY YZ XZ), divided by Longest; a sample that is not
   * finite has components of NotFinite.
   */
  vtkSmartPointer<vtkFloatArray> Steering;
  /// 3 components, unit normals, 0 off surfaces; null for tensors.
  vtkSmartPointer<vtkFloatArray> Normals;
  /// 3 components, curvature of the streamlines in 1 / world units; null for tensors.
  vtkSmartPointer<vtkFloatArray> Curvature;
  /// Length (Frobenius norm) of the longest finite vector (tensor); 1 where there is none.
  double Longest = 1.0;
  /// Diagonal of the box that holds the largest cell, in world units; 0 for tensors.
  double LargestCell = 0.0;

  /// So much longer than what is finite that it shows through any interpolation.
  static constexpr float NotFinite = 1e30f;
};

/**
 * Fields at the points of a surface from an array on its points or, `cells`, on its cells: then the points
 * get means over their cells, hidden ones left out, unless `perCell` asks for the fields of the cells
 * themselves. Tuples longer than `limit` count as not finite. An array with another number of components gives
 * no Steering.
 */
STEERABLENOISEFILTERS_EXPORT SurfaceFields ComputeSurfaceFields(
  vtkPolyData* surface, vtkDataArray* array, bool cells, bool perCell,
  double limit = std::numeric_limits<double>::infinity());

/**
 * The FeatureSize that vtkSteerableNoiseFilter takes by itself, in world units, for data with these bounds over all
 * blocks and ranks. `sampleSpacing`: how far apart samples are; 0 where noise does not depend on them.
 */
STEERABLENOISEFILTERS_EXPORT double GetAutomaticFeatureSize(
  const double (&bounds)[6], double sampleSpacing = 0.0);

/**
 * The array of a dataset that steers noise, as vtkAlgorithm::SetInputArrayToProcess chose it in `choice`, on
 * the association that was asked for or else on the other; `cells` tells on which. Where no name was given:
 * the choice of SteeringChoice.h. Null, with `why` in a
 * sentence that says what to do, where there is none that can be used.
 */
STEERABLENOISEFILTERS_EXPORT vtkDataArray* FindSteeringArray(
  vtkDataSet* dataset, vtkInformation* choice, bool& cells, std::string& why);
} // namespace noise

#endif
