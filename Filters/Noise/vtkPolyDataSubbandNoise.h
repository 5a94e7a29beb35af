// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPolyDataSubbandNoise
 * @brief   even noise on surfaces with distorted texture coordinates, steered by a field
 *
 * Takes a vtkPolyData, or a composite of them, of triangles, quads, polygons and strips, and adds one
 * float point array of anisotropic noise (Goldberg, Zwicker and Durand 2008), which it makes the
 * active scalars. Its variance is one but for what AntiAlias fades, which is most where points are
 * few for a wavelength. Everything else is passed on; the input is not written. Other datasets
 * of a composite are passed on and counted: extract their surface first.
 *
 * Periodic tiles of noise in bands of direction and scale are looked up at the texture coordinates, and
 * the bands are weighted at each point so that the noise has its Wavelength on the surface, however the
 * texture is stretched there. Tangent vectors on points or cells (2 or 3 components) make features
 * longer along them. Without texture coordinates three planar projections are blended.
 *
 * The value at a point depends on the triangles around it, on the seed and on what all blocks and ranks
 * agree on: bounds, mean spacing of the points and how the texture is stretched overall. All ranks of
 * the Controller have to take part. One ghost level is requested.
 *
 * Triangles without area on the surface or in the texture are left out and counted, as are those that
 * the texture folds over; where more than a tenth of the surface is mirrored nothing is folded but
 * charts are, and both sides count. Points without any triangle get 0.
 *
 * @sa
 * vtkImageSubbandNoiseSource vtkImageSubbandDecomposition vtkSteerableNoiseFilter
 */
#ifndef vtkPolyDataSubbandNoise_h
#define vtkPolyDataSubbandNoise_h

#include "SteerableNoiseFiltersModule.h" // For export macro
#include "vtkPassInputTypeAlgorithm.h"

class vtkImageData;
class vtkMultiProcessController;

class STEERABLENOISEFILTERS_EXPORT vtkPolyDataSubbandNoise : public vtkPassInputTypeAlgorithm
{
public:
  static vtkPolyDataSubbandNoise* New();
  vtkTypeMacro(vtkPolyDataSubbandNoise, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ParameterizationType
  {
    AUTOMATIC = 0,
    TEXTURE_COORDINATES = 1,
    TRIPLANAR = 2
  };
  enum MethodType
  {
    LEAST_SQUARES = 0,
    POWER_MATCHED = 1,
    HEURISTIC = 2,
    NONE = 3
  };
  enum FunctionType
  {
    FRACTAL = 0,
    TURBULENCE = 1
  };

  enum InputArrayType
  {
    STEERING_ARRAY = 0,
    WEIGHTS_ARRAY = 1,
    WAVELENGTH_ARRAY = 2,
    ANISOTROPY_ARRAY = 3,
    FACTORS_ARRAY = 4
  };

  /**
   * The array that steers the noise is chosen by SetInputArrayToProcess(0, ...), on points or cells.
   * Without it, or with the names "" and "None", nothing steers.
   *
   * SetInputArrayToProcess(1, ...) chooses weights of the user's own, on points: an array as
   * OutputWeights adds it, with a component for each band, which takes the place of the weights of
   * every octave. They are used as they are, and AntiAlias, if it is on, fades them. Without a
   * name, or with "None", weights come from the metric.
   *
   * SetInputArrayToProcess(4, ...) chooses factors by which the weights of each octave and
   * orientation are multiplied (the paper's f_k for linear functions): Octaves times Orientations
   * components, orientation fastest, on points.
   *
   * SetInputArrayToProcess(2, ...) and (3, ...) choose arrays on points that Wavelength and
   * Anisotropy come from, point by point: values of one component, lengths of 2 or 3, so the
   * steering vectors themselves may say how long features are. Wavelengths that are not positive
   * and finite, and anisotropies that are not finite, are those of the properties; the others are
   * kept from 1 to 8. All blocks must have them.
   */

  ///@{
  /**
   * Optional second input: bands of an image in place of the tiles of noise, made by
   * vtkImageSubbandDecomposition (or vtkImageSubbandNoiseSource). The image is square and lies at
   * the texture coordinates, once for each repeat; there is no other Parameterization. With the
   * methods its bands are weighted like those of noise; with NONE all of them count, with the
   * residuals: the image itself, which AntiAlias filters for the points of the mesh (paper, Fig.
   * 8). Weights of the user's own then have components as the image has. Wavelength counts with the
   * other methods; Orientations, TileSize, Seed, Phase and BlendSeams do not.
   */
  void SetSubbandsConnection(vtkAlgorithmOutput* bands);
  void SetSubbandsData(vtkImageData* bands);
  ///@}

  ///@{
  /**
   * Wavelength in world units. 0, the default: 1/50 of the diagonal of the bounds of all blocks on all
   * ranks, at most 1/4 of their second longest side, but the thinnest features not finer than 8 point spacings;
   * rounded to a power of the fourth root of 2. Negative values are clamped to 0.
   */
  vtkSetClampMacro(Wavelength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(Wavelength, double);
  ///@}

  /// Wavelength of the last execution, world units.
  vtkGetMacro(ResolvedWavelength, double);

  ///@{
  /**
   * Length over width of features along the vectors, 1 (isotropic) to 8, default 4: the root of the
   * ratio of the structure tensor's eigenvalues, on average over directions. Orientations limit it,
   * to 4.3 (8), 3.6 (6) and 2.9 (4) by LEAST_SQUARES; where it is more, a warning names the most,
   * which is taken.
   */
  vtkSetClampMacro(Anisotropy, double, 1.0, 8.0);
  vtkGetMacro(Anisotropy, double);
  ///@}

  ///@{
  /**
   * Where tiles are looked up: AUTOMATIC, the default: at a surface's texture coordinates if it has
   * them, and most of it is not in charts smaller than a wavelength, else TRIPLANAR; TEXTURE_COORDINATES: an error without them; TRIPLANAR: always projections.
   */
  vtkSetClampMacro(Parameterization, int, AUTOMATIC, TRIPLANAR);
  vtkGetMacro(Parameterization, int);
  ///@}

  ///@{
  /**
   * How bands are weighted: LEAST_SQUARES, the default: the closest spectrum; POWER_MATCHED: the best
   * isotropy; HEURISTIC: the cheapest; NONE: plain texture mapping of the same noise, for comparison.
   */
  vtkSetClampMacro(Method, int, LEAST_SQUARES, NONE);
  vtkGetMacro(Method, int);
  ///@}

  ///@{
  /**
   * Directions of the bands: 3, 4, 6 or 8, default 8, follow stretches of 1.5:1, 2:1, 3:1 and 4:1;
   * others become one of these, with a warning.
   */
  void SetOrientations(int orientations);
  vtkGetMacro(Orientations, int);
  ///@}

  ///@{
  /**
   * Heuristic weights, and heuristic antialiasing, from three radii of a band instead of one,
   * default off: less aliasing where samples see the texture at a grazing angle. It counts with
   * Method HEURISTIC only.
   */
  vtkSetMacro(RadialTriple, bool);
  vtkGetMacro(RadialTriple, bool);
  vtkBooleanMacro(RadialTriple, bool);
  ///@}

  ///@{
  /// Terms of the sum over octaves, 1 to 16, default 1; each is twice as fine as the one before.
  vtkSetClampMacro(Octaves, int, 1, 16);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /// Factor of amplitude from one octave to the next, 0 to 1, default 0.7.
  vtkSetClampMacro(Persistence, double, 0.0, 1.0);
  vtkGetMacro(Persistence, double);
  ///@}

  ///@{
  /// What is summed over octaves: FRACTAL, the default: the noise; TURBULENCE: its absolute value.
  vtkSetClampMacro(Function, int, FRACTAL, TURBULENCE);
  vtkGetMacro(Function, int);
  ///@}

  ///@{
  /// Fade bands that are too fine for the points of the mesh, default on.
  vtkSetMacro(AntiAlias, bool);
  vtkGetMacro(AntiAlias, bool);
  vtkBooleanMacro(AntiAlias, bool);
  ///@}

  ///@{
  /**
   * Shorten steps of the texture coordinates along edges by whole repeats, default off: for meshes
   * whose cells straddle a seam; not where a cell truly spans half a repeat.
   */
  vtkSetMacro(WrapSeams, bool);
  vtkGetMacro(WrapSeams, bool);
  vtkBooleanMacro(WrapSeams, bool);
  ///@}

  ///@{
  /**
   * Let noise of planar projections take over where texture coordinates cannot carry noise, default
   * off: within a wavelength of seams, at which they jump by other steps than whole repeats or turn
   * back, and where they are stretched more than Orientations follow, as next to the poles of a
   * sphere (paper, Fig. 12). The variance stays. Seams between blocks do not count.
   */
  vtkSetMacro(BlendSeams, bool);
  vtkGetMacro(BlendSeams, bool);
  vtkBooleanMacro(BlendSeams, bool);
  ///@}

  ///@{
  /**
   * Texels along each axis of a tile, 64 to 1024, default 256. Larger tiles repeat later and have room
   * for more scales (256: 5, 512: 6), so texture coordinates may be stretched more unevenly.
   */
  vtkSetClampMacro(TileSize, int, 64, 1024);
  vtkGetMacro(TileSize, int);
  ///@}

  ///@{
  /// Another seed, another noise; default 0.
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /// Position in a loop of blended tiles, [0, 1), default 0; only the fraction of what is set counts.
  void SetPhase(double phase);
  vtkGetMacro(Phase, double);
  ///@}

  ///@{
  /// Name of the array that is added, default "SubbandNoise".
  vtkSetStringMacro(ResultArrayName);
  vtkGetStringMacro(ResultArrayName);
  ///@}

  ///@{
  /**
   * Adds the weights of the first octave as the float array "SubbandWeights", named o<i>s<j>: one
   * component for each orientation and scale, three times as many where three projections are
   * blended; with BlendSeams those of the projections follow the texture's. Default off.
   */
  vtkSetMacro(OutputWeights, bool);
  vtkGetMacro(OutputWeights, bool);
  vtkBooleanMacro(OutputWeights, bool);
  ///@}

  ///@{
  /**
   * For renderers, which look tiles up themselves: the array SubbandWeights is made and no noise. Points are then no
   * samples, so their spacing does not count, neither for the automatic Wavelength nor in warnings, and AntiAlias fades
   * nothing. Weights do not depend on Seed, Phase, Octaves, Persistence and Function. Default off.
   */
  vtkSetMacro(WeightsOnly, bool);
  vtkGetMacro(WeightsOnly, bool);
  vtkBooleanMacro(WeightsOnly, bool);
  ///@}

  ///@{
  /**
   * How often a tile repeats in one repeat of the texture coordinates, and in a world unit of planar projections; of
   * the last execution.
   */
  vtkGetMacro(TextureRepeats, double);
  vtkGetMacro(PlaneRepeats, double);
  ///@}

  ///@{
  /**
   * Adds the stretch of the texture as the float array "Distortion": ratio of the singular values of
   * the mapping, 1 or more; of the steepest-facing projection in triplanar noise; 0 where there is no
   * mapping. Default off.
   */
  vtkSetMacro(OutputDistortion, bool);
  vtkGetMacro(OutputDistortion, bool);
  vtkBooleanMacro(OutputDistortion, bool);
  ///@}

  ///@{
  /**
   * Whether what depends on the input is kept for the next execution while the properties that it
   * depends on stay the same: of each point metrics of the mapping and weights of the bands. Then
   * another Phase, Persistence, Function or number of Octaves costs the lookups alone, but for the
   * weights of octaves that were not there before. It takes 73 bytes for each point, with planar
   * projections for each one that counts there, and 4 for each band in each of the first four
   * octaves; it is dropped when the input's modification time changes or this is switched off,
   * which drops it at once. The input itself is not kept. Default on.
   */
  virtual void SetKeepFields(bool keepFields);
  vtkGetMacro(KeepFields, bool);
  vtkBooleanMacro(KeepFields, bool);
  ///@}

  ///@{
  /// Ranks that agree on automatic values; default the global controller, null: this process alone.
  virtual void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  /**
   * Takes what `other` and the ranks of its Controller agreed on when it last executed, in place of agreeing: for a part
   * of its surfaces that lies elsewhere now, where ranks do not meet. Null: all ranks of the Controller take part again.
   */
  void TakeAgreement(vtkPolyDataSubbandNoise* other);

protected:
  vtkPolyDataSubbandNoise();
  ~vtkPolyDataSubbandNoise() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*) override;

  double Wavelength = 0.0;
  double ResolvedWavelength = 0.0;
  double Anisotropy = 4.0;
  int Parameterization = AUTOMATIC;
  int Method = LEAST_SQUARES;
  int Orientations = 8;
  bool RadialTriple = false;
  int Octaves = 1;
  double Persistence = 0.7;
  int Function = FRACTAL;
  bool AntiAlias = true;
  bool WrapSeams = false;
  bool BlendSeams = false;
  int TileSize = 256;
  int Seed = 0;
  double Phase = 0.0;
  char* ResultArrayName = nullptr;
  bool OutputWeights = false;
  bool OutputDistortion = false;
  bool WeightsOnly = false;
  double TextureRepeats = 1.0;
  double PlaneRepeats = 1.0;
  bool KeepFields = true;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkPolyDataSubbandNoise(const vtkPolyDataSubbandNoise&) = delete;
  void operator=(const vtkPolyDataSubbandNoise&) = delete;

  struct Execution;
  struct Internals;
  Internals* Cache; // tiles and weights, kept while their parameters stand
};

#endif
