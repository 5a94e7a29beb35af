// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSteerableNoiseFilter
 * @brief   noise that streaks along a vector field
 *
 * Takes any vtkDataSet, or a composite of them, with vectors (2 or 3 components) or tensors (4, 6 or 9)
 * on its points or cells, and adds one float array of steerable Perlin noise (Rice 2025), which it
 * makes the active scalars. Everything else is passed on; the input is not written.
 *
 * The value at a sample is a function of its place, its vector and the seed (with FollowCurvature: of
 * its neighbours' vectors too), so it does not depend on the camera, on threads, on pieces or on ranks.
 *
 * Flat images get 2D noise in their plane; volumes get 3D noise; cells of dimension 2 in other datasets
 * get 3D noise whose metric lies in the surface. The blocks of a composite agree on it over all ranks: flat images
 * next to other data are surfaces, and structured grids one cell thick are surfaces only where no volume is. Turned images use lattices along their own axes.
 *
 * Vectors that are zero, NaN or infinite are blank (BlankValue); if more than half of the samples have no direction, a
 * warning says so. Vectors along the normal of a surface get isotropic noise.
 * A missing array is an error in a plain dataset; a block of a composite without it is passed on and
 * counted. Automatic values and the plane of two components are agreed on by all ranks of the
 * Controller, which all have to take part.
 *
 * Two components (tensors: four) lie in the coordinate plane that all the data are in (x-y, x-z or y-z), and
 * along x and y where they are in none; flat images have them along their own axes.
 *
 * @sa
 * vtkPolyDataSubbandNoise
 */
#ifndef vtkSteerableNoiseFilter_h
#define vtkSteerableNoiseFilter_h

#include "SteerableNoiseFiltersModule.h" // For export macro
#include "vtkPassInputTypeAlgorithm.h"

#include <memory>

class vtkMultiProcessController;

class STEERABLENOISEFILTERS_EXPORT vtkSteerableNoiseFilter : public vtkPassInputTypeAlgorithm
{
public:
  static vtkSteerableNoiseFilter* New();
  vtkTypeMacro(vtkSteerableNoiseFilter, vtkPassInputTypeAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum ModelType
  {
    MODEL_STEERABLE = 0,
    MODEL_PERLIN = 1
  };
  enum DirectionType
  {
    DIRECTION_FIELD = 0,
    DIRECTION_NONE = 1
  };
  enum TensorUseType
  {
    TENSOR_DIRECTION = 0,
    TENSOR_METRIC = 1,
    TENSOR_WORLD_METRIC = 2
  };
  enum StrengthModeType
  {
    CONSTANT = 0,
    MAGNITUDE = 1
  };
  enum NormalizationType
  {
    NONE = 0,
    WEIGHT_SUM = 1,
    UNIT_VARIANCE = 2
  };
  enum BasisType
  {
    GRADIENT = 0,
    VALUE = 1,
    STREAKS = 2
  };
  enum FadeType
  {
    CUBIC = 0,
    QUINTIC = 1,
    WIDE = 2
  };
  enum FalloffType
  {
    SEPARABLE = 0,
    RADIAL = 1
  };
  enum LatticeType
  {
    SQUARE = 0,
    JITTERED = 1,
    SIMPLICIAL = 2
  };
  enum GradientSetType
  {
    UNIFORM = 0,
    PERLIN = 1
  };
  enum BlankValueType
  {
    BLANK_ZERO = 0,
    BLANK_NAN = 1,
    BLANK_HIDDEN = 2
  };

  ///@{
  /**
   * MODEL_STEERABLE, the default, or MODEL_PERLIN: Perlin's own noise as Kensler writes it, with
   * his variants by Fade, Falloff, Lattice, GradientSet, Basis and Period. It stands for Direction
   * NONE, LatticeWindow on, Quality 0, AnisotropicWeight and MetricInProjection off and
   * Normalization NONE, whatever these are set to.
   */
  vtkSetClampMacro(Model, int, MODEL_STEERABLE, MODEL_PERLIN);
  vtkGetMacro(Model, int);
  ///@}

  /**
   * Arrays that StreakLength, Strength and EigenvalueSum come from, sample by sample: input arrays
   * 1, 2 and 3 of SetInputArrayToProcess, the first for the vectors. They lie where the vectors do;
   * of vectors the length counts. Values are kept within the property's range, and where they are
   * not finite the property counts. Without a name, or with "None", it counts everywhere, which is
   * the default.
   */
  enum InputArrayType
  {
    STEERING_ARRAY = 0,
    STREAK_LENGTH_ARRAY = 1,
    STRENGTH_ARRAY = 2,
    EIGENVALUE_SUM_ARRAY = 3
  };

  ///@{
  /**
   * DIRECTION_FIELD, the default: vectors or tensors steer the noise, and data without them are an
   * error. DIRECTION_NONE: nothing does, no array is needed, and noise is isotropic on any dataset:
   * at its points, or at its cells if SetInputArrayToProcess asks for them. What goes by vectors
   * (Strength, the masks, FollowCurvature, Speed) does not count then, and Basis STREAKS is an
   * error.
   */
  vtkSetClampMacro(Direction, int, DIRECTION_FIELD, DIRECTION_NONE);
  vtkGetMacro(Direction, int);
  ///@}

  ///@{
  /**
   * What tensors are. TENSOR_DIRECTION, the default: the eigenvector of their largest eigenvalue is
   * the direction of streaks, whose shape the properties below give. TENSOR_METRIC: the metric
   * itself, which measures distances, in 1 / FeatureSize² as OutputMetric has it: a streak reaches
   * 1 / √eigenvalue cells along each eigenvector. TENSOR_WORLD_METRIC: the same in 1 / world
   * units². StreakLength, EigenvalueSum, Quality and MinimumEigenvalue do not count then;
   * eigenvalues are bounded to 1/400 (with LatticeWindow 1/1000) and 16 / FeatureSize², with a
   * warning that counts them. A metric has no sense: streaks' heads and motion may point to either
   * side.
   */
  vtkSetClampMacro(TensorUse, int, TENSOR_DIRECTION, TENSOR_WORLD_METRIC);
  vtkGetMacro(TensorUse, int);
  ///@}

  ///@{
  /**
   * Side of a lattice cell in world units: the width of a streak is about one of it. 0, the default:
   * 1/100 of the diagonal of the bounds of all blocks on all ranks, at most 1/8 of their second longest
   * side, but not finer than 4 distances of neighbouring samples; rounded to a power of the fourth root
   * of 2, so that it does not change with every step of a series. Negative and NaN: an error.
   */
  vtkSetMacro(FeatureSize, double);
  vtkGetMacro(FeatureSize, double);
  ///@}

  /// FeatureSize of the last execution, world units.
  vtkGetMacro(ResolvedFeatureSize, double);

  /// Samples of the last execution without a direction, ghosts not counted.
  vtkGetMacro(NumberOfDegenerateSamples, vtkIdType);

  /// Samples of the last execution at or below MaskThreshold.
  vtkGetMacro(NumberOfStagnantSamples, vtkIdType);

  /// Samples of the last execution above MaskUpperThreshold, or taken for fill values.
  vtkGetMacro(NumberOfOverlongSamples, vtkIdType);

  ///@{
  /// Half-length of a streak in cells, 1 to 20, default 6. With LatticeWindow it does not count.
  vtkSetClampMacro(StreakLength, double, 1.0, 20.0);
  vtkGetMacro(StreakLength, double);
  ///@}

  ///@{
  /// With LatticeWindow: length of streaks, 0 to 8, default 4; surflets reach Quality + 1 cells.
  vtkSetClampMacro(Quality, int, 0, 8);
  vtkGetMacro(Quality, int);
  ///@}

  ///@{
  /// With LatticeWindow: smallest eigenvalue at Quality 0, 0.01 to 1, default 0.5: smaller is longer.
  vtkSetClampMacro(MinimumEigenvalue, double, 0.01, 1.0);
  vtkGetMacro(MinimumEigenvalue, double);
  ///@}

  ///@{
  /**
   * Trace of the metric, 2 to 16, default 3.2: larger is thinner streaks, with gaps from 4 on.
   * Normalization WeightSum needs 4 or less.
   */
  vtkSetClampMacro(EigenvalueSum, double, 2.0, 16.0);
  vtkGetMacro(EigenvalueSum, double);
  ///@}

  ///@{
  /**
   * The paper's own model, default off: a window over the lattice's axes, and the length that Quality and
   * MinimumEigenvalue say. Take it to compare with the paper; without it lines are longer and contrast is
   * the same in every direction.
   */
  vtkSetMacro(LatticeWindow, bool);
  vtkGetMacro(LatticeWindow, bool);
  vtkBooleanMacro(LatticeWindow, bool);
  ///@}

  ///@{
  /**
   * Surflets fade with the distance that the metric measures, default on. Off needs LatticeWindow,
   * which bounds them then: Fig. 2 b of the paper, and with MetricInProjection off too, Fig. 2 a.
   * All corners in the window are visited: at Quality 0 that is fast, at 8 in volumes it takes some
   * thousand for each sample.
   */
  vtkSetMacro(AnisotropicWeight, bool);
  vtkGetMacro(AnisotropicWeight, bool);
  vtkBooleanMacro(AnisotropicWeight, bool);
  ///@}

  ///@{
  /// Gradients are projected with the metric, as in the paper, default on.
  vtkSetMacro(MetricInProjection, bool);
  vtkGetMacro(MetricInProjection, bool);
  vtkBooleanMacro(MetricInProjection, bool);
  ///@}

  ///@{
  /// Anisotropy, 0 (isotropic noise) to 1, default 1.
  vtkSetClampMacro(Strength, double, 0.0, 1.0);
  vtkGetMacro(Strength, double);
  ///@}

  ///@{
  /**
   * CONSTANT, the default, or MAGNITUDE: Strength times the vector's length over
   * ReferenceMagnitude, at most Strength.
   */
  vtkSetClampMacro(StrengthMode, int, CONSTANT, MAGNITUDE);
  vtkGetMacro(StrengthMode, int);
  ///@}

  ///@{
  /// Length of vectors with the full Strength; 0, the default: the longest on all ranks.
  vtkSetClampMacro(ReferenceMagnitude, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(ReferenceMagnitude, double);
  ///@}

  ///@{
  /**
   * What the sum of surflets is divided by: NONE, WEIGHT_SUM (its weights, as the paper does) or
   * UNIT_VARIANCE, the default: its standard deviation over all gradients, for even contrast.
   */
  vtkSetClampMacro(Normalization, int, NONE, UNIT_VARIANCE);
  vtkGetMacro(Normalization, int);
  ///@}

  ///@{
  /// Surflets bend along the streamlines, default on. Asks for one ghost level.
  vtkSetMacro(FollowCurvature, bool);
  vtkGetMacro(FollowCurvature, bool);
  vtkBooleanMacro(FollowCurvature, bool);
  ///@}

  ///@{
  /**
   * GRADIENT, the default: signed noise; VALUE: blobs; STREAKS: sparse bright streaks from 0 up whose
   * heads point downstream.
   */
  vtkSetClampMacro(Basis, int, GRADIENT, STREAKS);
  vtkGetMacro(Basis, int);
  ///@}

  ///@{
  /**
   * How densely streaks lie, 0.01 to 1, default 0.25: a corner has one with probability Density · 3 /
   * StreakLength, at most 1, with LatticeWindow Density.
   */
  vtkSetClampMacro(Density, double, 0.01, 1.0);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * Position in the loop of motion, [0, 1), default 0; only the fraction of what is set counts. Noise
   * is still where Phase and TimePeriod are 0 and Animate is off.
   */
  void SetPhase(double phase);
  vtkGetMacro(Phase, double);
  ///@}

  ///@{
  /// Surflets are on their clocks at Phase 0 too, so that a track from 0 to 1 has no jump; default off.
  vtkSetMacro(Animate, bool);
  vtkGetMacro(Animate, bool);
  vtkBooleanMacro(Animate, bool);
  ///@}

  ///@{
  /// Half-lengths of a surflet that it travels in a loop, -4 to 4, default 1.
  vtkSetClampMacro(Speed, double, -4.0, 4.0);
  vtkGetMacro(Speed, double);
  ///@}

  ///@{
  /**
   * Pipeline time of one loop; time / TimePeriod is added to Phase. 0, the default: time does not
   * matter. With it, an input without time steps gets TimeSteps of them, from 0 to one step before TimePeriod, and one
   * with a single time the same from there.
   */
  vtkSetClampMacro(TimePeriod, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimePeriod, double);
  ///@}

  ///@{
  /// Time steps that TimePeriod gives to steady data, 2 to 1000, default 24: the frames of a film that loops.
  vtkSetClampMacro(TimeSteps, int, 2, 1000);
  vtkGetMacro(TimeSteps, int);
  ///@}

  ///@{
  /// Terms of the fractal sum, 1 to 16, default 1.
  vtkSetClampMacro(Octaves, int, 1, 16);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /// Factor of fineness from one octave to the next, 1 to 8, default 2.
  vtkSetClampMacro(Lacunarity, double, 1.0, 8.0);
  vtkGetMacro(Lacunarity, double);
  ///@}

  ///@{
  /// Factor of amplitude from one octave to the next, 0 to 1, default 0.5.
  vtkSetClampMacro(Gain, double, 0.0, 1.0);
  vtkGetMacro(Gain, double);
  ///@}

  ///@{
  /// Sum of the absolute values of the octaves, default off.
  vtkSetMacro(Turbulence, bool);
  vtkGetMacro(Turbulence, bool);
  vtkBooleanMacro(Turbulence, bool);
  ///@}

  ///@{
  /// Interpolant of the surflets: CUBIC, QUINTIC (default) or WIDE (Kensler's, twice as far).
  vtkSetClampMacro(Fade, int, CUBIC, WIDE);
  vtkGetMacro(Fade, int);
  ///@}

  ///@{
  /// Shape of the lattice window: SEPARABLE (default) or RADIAL.
  vtkSetClampMacro(Falloff, int, SEPARABLE, RADIAL);
  vtkGetMacro(Falloff, int);
  ///@}

  ///@{
  /// Where surflets stand: SQUARE (default), JITTERED or SIMPLICIAL.
  vtkSetClampMacro(Lattice, int, SQUARE, SIMPLICIAL);
  vtkGetMacro(Lattice, int);
  ///@}

  ///@{
  /// Directions of the gradients: UNIFORM (default) or PERLIN, his twelve.
  vtkSetClampMacro(GradientSet, int, UNIFORM, PERLIN);
  vtkGetMacro(GradientSet, int);
  ///@}

  ///@{
  /**
   * Cells per axis after which the noise repeats; 0, the default: never. Not with SIMPLICIAL, and with
   * several octaves Lacunarity must be a whole number.
   */
  vtkSetVector3Macro(Period, int);
  vtkGetVector3Macro(Period, int);
  ///@}

  ///@{
  /**
   * Images only, also in composites but those of an AMR, whose levels say how fine they are: samples per sample of
   * the input along each axis, 1 to 16, default 1. Point arrays are interpolated linearly, cell arrays are
   * repeated, vectors on cells interpolated for the noise. 0 is automatic: as many as give a streak (of the finest
   * octave) 6 samples, but no more than 2^22 in all; the images of composites stay as they are. ParaView's panel
   * begins with 0.
   */
  vtkSetClampMacro(Magnification, int, 0, 16);
  vtkGetMacro(Magnification, int);
  /// The one in use since the last RequestInformation.
  vtkGetMacro(ResolvedMagnification, int);
  ///@}

  ///@{
  /// Vectors at or below this length are stagnant: output 0 there, counted. 0, the default: none.
  vtkSetClampMacro(MaskThreshold, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaskThreshold, double);
  ///@}

  ///@{
  /**
   * Vectors above this length are left out: output 0, counted, and they do not count as neighbours or for the
   * longest vector. 0, the default: values that stand for missing ones are left out. These are at least 99,
   * 16 times as long as any other vector, and as alike as one number in 1 to 3 components (a factor of 1.75); a
   * warning names them, and what is as long but not alike.
   */
  vtkSetClampMacro(MaskUpperThreshold, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaskUpperThreshold, double);
  ///@}

  ///@{
  /**
   * What the result is where vectors are zero, NaN or infinite, or beyond one of the thresholds: BLANK_ZERO, the default,
   * BLANK_NAN, or BLANK_HIDDEN: 0, and the point or cell is hidden by vtkGhostType.
   */
  vtkSetClampMacro(BlankValue, int, BLANK_ZERO, BLANK_HIDDEN);
  vtkGetMacro(BlankValue, int);
  ///@}

  ///@{
  /// Another seed, another noise; default 0.
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /// Name of the array that is added, default "SteerableNoise".
  vtkSetStringMacro(ResultArrayName);
  vtkGetStringMacro(ResultArrayName);
  ///@}

  ///@{
  /**
   * Adds the metric of every sample, before curvature, as the 6-component double array "Metric": XX
   * YY ZZ XY YZ XZ in units of 1 / FeatureSize². Flat images have 0 across their plane. With
   * TensorUse TENSOR_METRIC it gives the same noise again, where there is a direction. Default off.
   */
  vtkSetMacro(OutputMetric, bool);
  vtkGetMacro(OutputMetric, bool);
  vtkBooleanMacro(OutputMetric, bool);
  ///@}

  ///@{
  /**
   * Whether what depends on the input alone is kept for the next execution: normals, curvature,
   * bounds, distances of samples, and the order to take them in. Then a change of any other property
   * costs the noise alone. It takes 24 bytes for each sample on a surface and 12 in a volume, 4 more
   * where successive samples are far apart, none on images, and is dropped when the input's modification time
   * changes or this is switched off, which drops it at once. The input itself is not kept. Default on.
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

protected:
  vtkSteerableNoiseFilter();
  ~vtkSteerableNoiseFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*) override;

  int Model = MODEL_STEERABLE;
  int Direction = DIRECTION_FIELD;
  int TensorUse = TENSOR_DIRECTION;
  double FeatureSize = 0.0;
  double ResolvedFeatureSize = 0.0;
  vtkIdType NumberOfDegenerateSamples = 0;
  vtkIdType NumberOfStagnantSamples = 0;
  vtkIdType NumberOfOverlongSamples = 0;
  double StreakLength = 6.0;
  int Quality = 4;
  double MinimumEigenvalue = 0.5;
  double EigenvalueSum = 3.2;
  bool LatticeWindow = false;
  bool AnisotropicWeight = true;
  bool MetricInProjection = true;
  double Strength = 1.0;
  int StrengthMode = CONSTANT;
  double ReferenceMagnitude = 0.0;
  int Normalization = UNIT_VARIANCE;
  bool FollowCurvature = true;
  int Basis = GRADIENT;
  double Density = 0.25;
  double Phase = 0.0;
  bool Animate = false;
  double Speed = 1.0;
  double TimePeriod = 0.0;
  int TimeSteps = 24;
  int Octaves = 1;
  double Lacunarity = 2.0;
  double Gain = 0.5;
  bool Turbulence = false;
  int Fade = QUINTIC;
  int Falloff = SEPARABLE;
  int Lattice = SQUARE;
  int GradientSet = UNIFORM;
  int Period[3] = { 0, 0, 0 };
  int Magnification = 1;
  int ResolvedMagnification = 1;
  double MaskThreshold = 0.0;
  double MaskUpperThreshold = 0.0;
  int BlankValue = BLANK_ZERO;
  int Seed = 0;
  char* ResultArrayName = nullptr;
  bool OutputMetric = false;
  bool KeepFields = true;
  vtkMultiProcessController* Controller = nullptr;

private:
  vtkSteerableNoiseFilter(const vtkSteerableNoiseFilter&) = delete;
  void operator=(const vtkSteerableNoiseFilter&) = delete;

  /// Whether vectors or tensors are looked for.
  bool IsSteered() const
  {
    return this->Direction == DIRECTION_FIELD && this->Model == MODEL_STEERABLE;
  }

  struct Execution;
  struct KeptBlocks;
  std::unique_ptr<KeptBlocks> Kept;
};

#endif
