// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageSubbandNoiseSource
 * @brief   periodic tiles of subband noise
 *
 * Makes a flat vtkImageData of TileSize x TileSize points with one array, "Subbands": isotropic noise
 * (Goldberg, Zwicker and Durand 2008) cut into bands of Orientations directions and Scales octaves.
 * Band (i, j) is component j * Orientations + i, named o<i>s<j>; larger j is coarser. World coordinates
 * are texture coordinates in repeats: the spacing is 1 / TileSize and the image repeats after 1.
 *
 * All bands are cut from one spectrum of white noise with unit variance, so that sums of bands have
 * known variances: the sum over the orientations of scale j has 3.52617 BandCenter^2 4^-j.
 *
 * The field array "BandCenter" holds what the property says.
 *
 * Bytes hold each band at +-4 standard deviations: value / 127.5 - 1, times the band's range, which is
 * in the field array "SubbandRanges".
 *
 * @sa
 * vtkPolyDataSubbandNoise vtkImageSubbandDecomposition
 */
#ifndef vtkImageSubbandNoiseSource_h
#define vtkImageSubbandNoiseSource_h

#include "SteerableNoiseFiltersModule.h" // For export macro
#include "vtkImageAlgorithm.h"

class STEERABLENOISEFILTERS_EXPORT vtkImageSubbandNoiseSource : public vtkImageAlgorithm
{
public:
  static vtkImageSubbandNoiseSource* New();
  vtkTypeMacro(vtkImageSubbandNoiseSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum OutputTypeType
  {
    FLOAT = 0,
    UNSIGNED_CHAR = 1
  };

  ///@{
  /// Directions of the bands: 3, 4, 6 or 8, default 8; others become one of these, with a warning.
  void SetOrientations(int orientations);
  vtkGetMacro(Orientations, int);
  ///@}

  ///@{
  /// Scales, one octave apart, 1 to 6, default 4. The coarsest needs 2 cycles in a tile at least.
  vtkSetClampMacro(Scales, int, 1, 6);
  vtkGetMacro(Scales, int);
  ///@}

  ///@{
  /// Texels along each axis of the tile, 16 to 2048, default 256.
  vtkSetClampMacro(TileSize, int, 16, 2048);
  vtkGetMacro(TileSize, int);
  ///@}

  ///@{
  /**
   * Centre of the finest scale in cycles per texel, 1/128 to 1/4, default 1/8, which suits Catmull-Rom
   * interpolation; bilinear wants 1/16.
   */
  vtkSetClampMacro(BandCenter, double, 1.0 / 128, 0.25);
  vtkGetMacro(BandCenter, double);
  ///@}

  ///@{
  /// Another seed, another noise; default 0.
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Two more components, "high" and "low": what is finer and what is coarser than all bands, with
   * the mean. The sum of all components is then white noise of variance one. Default off.
   */
  vtkSetMacro(Residuals, bool);
  vtkGetMacro(Residuals, bool);
  vtkBooleanMacro(Residuals, bool);
  ///@}

  ///@{
  /// FLOAT, the default, or UNSIGNED_CHAR: bytes at +-4 standard deviations.
  vtkSetClampMacro(OutputType, int, FLOAT, UNSIGNED_CHAR);
  vtkGetMacro(OutputType, int);
  ///@}

protected:
  vtkImageSubbandNoiseSource();
  ~vtkImageSubbandNoiseSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Orientations = 8;
  int Scales = 4;
  int TileSize = 256;
  double BandCenter = 0.125;
  int Seed = 0;
  bool Residuals = false;
  int OutputType = FLOAT;

private:
  vtkImageSubbandNoiseSource(const vtkImageSubbandNoiseSource&) = delete;
  void operator=(const vtkImageSubbandNoiseSource&) = delete;
};

#endif
