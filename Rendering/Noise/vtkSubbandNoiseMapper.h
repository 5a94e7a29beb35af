// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSubbandNoiseMapper
 * @brief   surfaces with even noise at the resolution of the picture, however their texture is stretched
 *
 * Draws polygonal data, or a composite of it, as its superclass does, and lays subband noise (Goldberg, Zwicker and
 * Durand 2008) over the colours. vtkPolyDataSubbandNoise weighs the bands at the points of the mesh; here they are looked up
 * in tiles at each fragment, and fade where the footprint of the pixel is too large for them, in each direction by
 * itself. So the mesh may be as coarse as its shape allows, and the value at a vertex is the filter's without
 * AntiAlias. Without texture coordinates three planar projections are blended.
 *
 * Input arrays are those of the filter, by the same numbers: 0 steers, 1 weights, 2 wavelength, 3 anisotropy. Without a
 * name nothing steers. Blocks that the filter refuses, and places where it has no weights, show their own colour.
 *
 * Graphics cards pass at least 60 values to a fragment, most 120 or more. Where the weights are
 * more, as with 8 Orientations steered on planar projections (120), the mapper takes 6, or 4:
 * GetOrientationsInUse tells.
 *
 * Graphics memory: 16 bytes a vertex and 4 for each weight, of each direction and scale; with planar
 * projections three times as many and 16 bytes more. Tiles of the texture, and of each of three
 * planes, take about 1.5 MB for each four directions; 0.4 MB with a TileSize of 256. With CUBIC
 * interpolation they are as large for each scale: 262144 bytes for 4 Orientations, one scale and a
 * TileSize of 256, as in the paper. FloatTiles takes four times as much. Weights are uploaded when
 * the input or what they depend on changes: not for Octaves, Persistence, Function, AntiAlias, Seed
 * and Phase.
 *
 * @sa
 * vtkPolyDataSubbandNoise
 */
#ifndef vtkSubbandNoiseMapper_h
#define vtkSubbandNoiseMapper_h

#include "SteerableNoiseRenderingModule.h" // For export macro
#include "vtkSurfaceNoiseMapper.h"

#include <memory> // For std::unique_ptr

class vtkMultiProcessController;
class vtkPolyDataSubbandNoise;

class STEERABLENOISERENDERING_EXPORT vtkSubbandNoiseMapper : public vtkSurfaceNoiseMapper
{
public:
  static vtkSubbandNoiseMapper* New();
  vtkTypeMacro(vtkSubbandNoiseMapper, vtkSurfaceNoiseMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum InterpolationType
  {
    LINEAR = 0,
    CUBIC = 1
  };

  ///@{
  /**
   * As in vtkPolyDataSubbandNoise, which documents them; a change uploads weights anew. The automatic
   * Wavelength does not depend on the points here, and TileSize is 512 by default, so that noise on
   * planes repeats after 16 wavelengths.
   */
  void SetWavelength(double wavelength);
  double GetWavelength();
  void SetAnisotropy(double anisotropy);
  double GetAnisotropy();
  void SetParameterization(int parameterization);
  int GetParameterization();
  void SetMethod(int method);
  int GetMethod();
  void SetOrientations(int orientations);
  int GetOrientations();
  void SetWrapSeams(bool wrap);
  bool GetWrapSeams();
  vtkBooleanMacro(WrapSeams, bool);
  void SetBlendSeams(bool blend);
  bool GetBlendSeams();
  vtkBooleanMacro(BlendSeams, bool);
  void SetTileSize(int size);
  int GetTileSize();
  ///@}

  ///@{
  /// In use since the last frame: Wavelength in world units; Orientations, which may be fewer than were set.
  double GetResolvedWavelength();
  int GetOrientationsInUse();
  ///@}

  ///@{
  /// Terms of the sum over octaves, 1 to 8, default 1; each is twice as fine as the one before.
  void SetOctaves(int octaves);
  int GetOctaves();
  ///@}

  ///@{
  /// Factor of amplitude from one octave to the next, 0 to 1, default 0.7.
  void SetPersistence(double persistence);
  double GetPersistence();
  ///@}

  ///@{
  /// vtkPolyDataSubbandNoise::FRACTAL, the default, sums the noise over octaves, TURBULENCE its absolute value.
  void SetFunction(int function);
  int GetFunction();
  ///@}

  ///@{
  /**
   * Bands fade where they are too fine for the pixels, default on: by a Gaussian with a deviation of one pixel, in each
   * direction by itself, so that a plane keeps its detail across the view up to the horizon.
   */
  void SetAntiAlias(bool fades);
  bool GetAntiAlias();
  vtkBooleanMacro(AntiAlias, bool);
  ///@}

  ///@{
  /// Another seed, another noise; default 0.
  void SetSeed(int seed);
  int GetSeed();
  ///@}

  ///@{
  /// Position in a loop of blended tiles, [0, 1), default 0; only the fraction of what is set counts.
  void SetPhase(double phase);
  double GetPhase();
  ///@}

  ///@{
  /// Time of one loop; Time / TimePeriod is added to Phase. 0, the default: time does not matter.
  void SetTimePeriod(double period);
  double GetTimePeriod();
  ///@}

  ///@{
  /// Time of the picture, in units of TimePeriod; default 0.
  void SetTime(double time) override;
  double GetTime();
  ///@}

  ///@{
  /**
   * LINEAR, the default: one lookup for four bands, 4 % off; CUBIC: 16 texels of the filter's own
   * tiles, its value but for the bytes.
   */
  void SetInterpolation(int interpolation);
  int GetInterpolation();
  ///@}

  ///@{
  /// Tiles of floats in place of bytes, default off.
  void SetFloatTiles(bool floats);
  bool GetFloatTiles();
  vtkBooleanMacro(FloatTiles, bool);
  ///@}

  /**
   * Wavelength, tiles and all that depends on the whole surface come from `data`, the part of the surface on this rank, and
   * the parts of the other ranks of `controller`, which all call this with the same options. By default the mapper's own input
   * is all there is.
   */
  void ShareExtremes(vtkDataObject* data, vtkMultiProcessController* controller);
  /// Takes what another mapper's are from.
  void ShareExtremes(vtkSubbandNoiseMapper* other);

  /// Takes the options of a filter.
  void SetOptionsFrom(vtkPolyDataSubbandNoise* filter);

  /**
   * When tiles were last uploaded, of all windows; 0: never. Once the phase has changed all tiles of the loop are there, four
   * times as many, and the graphics card blends them.
   */
  vtkMTimeType GetTileUploadTime();

  ///@{
  /// Bytes of graphics memory since the last frame, in each window: of the tiles, and of the weights of all vertices.
  vtkIdType GetTileBytes();
  vtkIdType GetWeightBytes();
  ///@}

  void Render(vtkRenderer* renderer, vtkActor* actor) override;
  void ShallowCopy(vtkAbstractMapper* mapper) override;

  struct Internals;
  Internals& GetInternals() { return *this->Internal; }

protected:
  vtkSubbandNoiseMapper();
  ~vtkSubbandNoiseMapper() override;

  vtkNoiseHelper* MakeHelper() override;

  /// Has the filter weigh the bands at the vertices of the input.
  void FindWeights(vtkRenderer* renderer);

private:
  vtkSubbandNoiseMapper(const vtkSubbandNoiseMapper&) = delete;
  void operator=(const vtkSubbandNoiseMapper&) = delete;

  std::unique_ptr<Internals> Internal;
};

#endif
