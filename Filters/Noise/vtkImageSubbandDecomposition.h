// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageSubbandDecomposition
 * @brief   cuts an image into bands of direction and scale
 *
 * Takes a flat vtkImageData with a scalar array on its points and gives it the float array
 * "Subbands", in place of its others: the image seen through the filters of
 * vtkImageSubbandNoiseSource (Goldberg, Zwicker and Durand 2008, section 2, there for noise;
 * section 4 and Fig. 8 for any texture). Band (i, j) is component j * Orientations + i, named
 * o<i>s<j>; larger j is coarser. After the bands come what is finer, by direction too, o<i>high,
 * and what is coarser with the mean, low. The sum of all components is the image, to rounding of
 * floats; weighted sums are the image filtered by direction and scale. The field array "BandCenter"
 * holds what the property says.
 *
 * The image counts as periodic: where its edges do not match, the step between them is in the
 * bands. Each side has 16 to 2048 points; those without large prime factors are fastest. Whole
 * extents are requested. Errors: no such array on the points, a Component that it does not have,
 * values that are not finite, an image that is not flat, sides out of range, more Scales than the
 * image has room for.
 *
 * vtkPolyDataSubbandNoise takes the bands of a square image in place of its tiles.
 *
 * @sa
 * vtkImageSubbandNoiseSource vtkPolyDataSubbandNoise
 */
#ifndef vtkImageSubbandDecomposition_h
#define vtkImageSubbandDecomposition_h

#include "SteerableNoiseFiltersModule.h" // For export macro
#include "vtkImageAlgorithm.h"

class STEERABLENOISEFILTERS_EXPORT vtkImageSubbandDecomposition : public vtkImageAlgorithm
{
public:
  static vtkImageSubbandDecomposition* New();
  vtkTypeMacro(vtkImageSubbandDecomposition, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Component of the array that is decomposed, from 0, the default.
  vtkSetClampMacro(Component, int, 0, VTK_INT_MAX);
  vtkGetMacro(Component, int);
  ///@}

  ///@{
  /// Directions of the bands: 3, 4, 6 or 8, default 8; others become one of these, with a warning.
  void SetOrientations(int orientations);
  vtkGetMacro(Orientations, int);
  ///@}

  ///@{
  /// Scales, one octave apart, 1 to 6, default 4. The coarsest needs 2 cycles along the shorter
  /// side.
  vtkSetClampMacro(Scales, int, 1, 6);
  vtkGetMacro(Scales, int);
  ///@}

  ///@{
  /**
   * Centre of the finest scale in cycles per pixel, 1/128 to 1/4, the default, with which the bands
   * reach the finest waves along the axes of an image.
   */
  vtkSetClampMacro(BandCenter, double, 1.0 / 128, 0.25);
  vtkGetMacro(BandCenter, double);
  ///@}

protected:
  vtkImageSubbandDecomposition();
  ~vtkImageSubbandDecomposition() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Component = 0;
  int Orientations = 8;
  int Scales = 4;
  double BandCenter = 0.25;

private:
  vtkImageSubbandDecomposition(const vtkImageSubbandDecomposition&) = delete;
  void operator=(const vtkImageSubbandDecomposition&) = delete;
};

#endif
