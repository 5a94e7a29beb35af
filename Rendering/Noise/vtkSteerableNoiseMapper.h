// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSteerableNoiseMapper
 * @brief   surfaces with noise that streaks along a vector field, at the resolution of the picture
 *
 * Draws polygonal data, or a composite of it, as its superclass does, and lays steerable noise (Rice 2025)
 * over the colours. Noise is worked out for each fragment from the interpolated vector, normal and curvature of
 * the streamline, so it is as sharp on a coarse mesh as on a fine one, and it needs no pass of its own:
 * translucency, depth peeling, several views, ranks, selection, edges, textures and lights work as without it.
 *
 * The array that steers is chosen by SetInputArrayToProcess(0, 0, 0, association, name), by default as in
 * vtkSteerableNoiseFilter: 2 or 3 components are vectors, 4, 6 or 9 tensors. Vectors on cells become point
 * vectors, means over the cells of each point, unless VectorsPerCell is on. Where a vector is zero, at or below
 * MaskThreshold, or not finite, and in blocks without the array, the surface shows its own colour.
 *
 * With FeatureSizeMode WORLD the noise is that of vtkSteerableNoiseFilter on the same surface: same seed, same
 * place, same value. With PIXELS, the default, streaks keep their width on the screen.
 *
 * A vertex takes 36 bytes of graphics memory more than a plain mapper's (24 with tensors). Properties that
 * are drawn, not computed from (all but the array, VectorsPerCell, MaskUpperThreshold and what the superclass has), upload nothing when they
 * change. The mapper keeps as many bytes in main memory.
 *
 * @sa
 * vtkSteerableNoiseFilter
 */
#ifndef vtkSteerableNoiseMapper_h
#define vtkSteerableNoiseMapper_h

#include "SteerableNoiseRenderingModule.h" // For export macro
#include "vtkSurfaceNoiseMapper.h"

#include <memory> // For std::unique_ptr

class vtkMultiProcessController;
class vtkSteerableNoiseFilter;

class STEERABLENOISERENDERING_EXPORT vtkSteerableNoiseMapper : public vtkSurfaceNoiseMapper
{
public:
  static vtkSteerableNoiseMapper* New();
  vtkTypeMacro(vtkSteerableNoiseMapper, vtkSurfaceNoiseMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum FeatureSizeModeType
  {
    PIXELS = 0,
    WORLD = 1
  };
  enum StrengthModeType
  {
    CONSTANT = 0,
    MAGNITUDE = 1
  };
  enum BasisType
  {
    GRADIENT = 0,
    STREAKS = 2 // as in vtkSteerableNoiseFilter
  };

  ///@{
  /**
   * PIXELS, the default: a streak is FeaturePixels wide on the screen; WORLD: FeatureSize wide in the scene,
   * the same in every view.
   */
  void SetFeatureSizeMode(int mode);
  int GetFeatureSizeMode();
  ///@}

  ///@{
  /// Width of a streak in pixels, 1 to 100, default 6.
  void SetFeaturePixels(double pixels);
  double GetFeaturePixels();
  ///@}

  ///@{
  /// Width of a streak in world units with WORLD; 0, the default: the size that
  /// the filter takes for fine samples, about 1/100 of the diagonal of the bounds.
  void SetFeatureSize(double size);
  double GetFeatureSize();
  ///@}

  ///@{
  /// Half-length of a streak in its widths, 1 to 20, default 6.
  void SetStreakLength(double length);
  double GetStreakLength();
  ///@}

  ///@{
  /// Trace of the metric, 2 to 16, default 3.2: larger is thinner streaks, with gaps from 4 on.
  void SetEigenvalueSum(double sum);
  double GetEigenvalueSum();
  ///@}

  ///@{
  /// Anisotropy, 0 (isotropic noise) to 1, default 1.
  void SetStrength(double strength);
  double GetStrength();
  ///@}

  ///@{
  /// CONSTANT, the default, or MAGNITUDE: Strength times the vector's length over ReferenceMagnitude, at most Strength.
  void SetStrengthMode(int mode);
  int GetStrengthMode();
  ///@}

  ///@{
  /// Length of vectors with the full Strength; 0, the default: the longest of all blocks.
  void SetReferenceMagnitude(double magnitude);
  double GetReferenceMagnitude();
  ///@}

  ///@{
  /// Vectors at or below this length show no noise; 0, the default: none but zero vectors.
  void SetMaskThreshold(double threshold);
  double GetMaskThreshold();
  ///@}

  ///@{
  /**
   * Vectors above this length show no noise and count for nothing; 0, the default: those that stand for missing
   * values by the rule of vtkSteerableNoiseFilter. A change uploads anew.
   */
  void SetMaskUpperThreshold(double threshold);
  double GetMaskUpperThreshold();
  ///@}

  ///@{
  /// Streaks bend along the streamlines, default on.
  void SetFollowCurvature(bool follow);
  bool GetFollowCurvature();
  vtkBooleanMacro(FollowCurvature, bool);
  ///@}

  ///@{
  /// GRADIENT, the default: even streaks; STREAKS: sparse bright ones whose heads point downstream.
  void SetBasis(int basis);
  int GetBasis();
  ///@}

  ///@{
  /// A corner of the lattice has a streak with probability Density 3 / StreakLength; 0.01 to 1, default 0.25.
  void SetDensity(double density);
  double GetDensity();
  ///@}

  ///@{
  /// Position in the loop of motion, [0, 1), default 0; only the fraction of what is set counts.
  void SetPhase(double phase);
  double GetPhase();
  ///@}

  ///@{
  /// Streaks are in motion at Phase 0 too, so that a track from 0 to 1 has no jump; default off.
  void SetAnimate(bool animate);
  bool GetAnimate();
  vtkBooleanMacro(Animate, bool);
  ///@}

  ///@{
  /// Half-lengths that a streak travels in a loop, -4 to 4, default 1.
  void SetSpeed(double speed);
  double GetSpeed();
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
  /// Terms of the fractal sum, 1 to 8, default 1, each Lacunarity times finer and Gain times weaker.
  void SetOctaves(int octaves);
  int GetOctaves();
  ///@}

  ///@{
  /// Factor of fineness from one octave to the next, 1 to 8, default 2.
  void SetLacunarity(double lacunarity);
  double GetLacunarity();
  ///@}

  ///@{
  /// Factor of amplitude from one octave to the next, 0 to 1, default 0.5.
  void SetGain(double gain);
  double GetGain();
  ///@}

  ///@{
  /// Another seed, another noise; default 0.
  void SetSeed(int seed);
  int GetSeed();
  ///@}

  ///@{
  /// Vectors on cells stay constant over each cell; default off: the points get means of them.
  void SetVectorsPerCell(bool perCell);
  bool GetVectorsPerCell();
  vtkBooleanMacro(VectorsPerCell, bool);
  ///@}

  /**
   * Takes the options of a filter, with FeatureSizeMode WORLD. Options that fragments do not have (the window of the
   * lattice, other bases, normalizations, fades, falloffs, lattices and gradients, Period, Turbulence) are refused:
   * false is returned, an error says which, and nothing is changed.
   */
  bool SetOptionsFrom(vtkSteerableNoiseFilter* filter);

  /**
   * Automatic values come from `data`, the part of the surface on this rank, and the parts of the other ranks of
   * `controller`, which all call this. By default the mapper's own input is all there is.
   */
  void ShareExtremes(vtkDataObject* data, vtkMultiProcessController* controller);
  /// Takes what another mapper shares.
  void ShareExtremes(vtkSteerableNoiseMapper* other);

  void Render(vtkRenderer* renderer, vtkActor* actor) override;

  void ShallowCopy(vtkAbstractMapper* mapper) override;

  struct Internals;
  Internals& GetInternals() { return *this->Internal; }

protected:
  vtkSteerableNoiseMapper();
  ~vtkSteerableNoiseMapper() override;

  vtkNoiseHelper* MakeHelper() override;

  /// Finds or computes what steers the noise of each block of the input.
  void FindFields();

private:
  vtkSteerableNoiseMapper(const vtkSteerableNoiseMapper&) = delete;
  void operator=(const vtkSteerableNoiseMapper&) = delete;

  std::unique_ptr<Internals> Internal;
};

#endif
