// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the stages of the fast path hand to each other (private to the files of this folder and
 * SteerableNoise.cxx). The names are those of SteerableNoiseReference: u and m the axes of the
 * metric, k, b and e its eigenvalues along, across and on the second axis, v a corner minus the
 * point, q its squared distance.
 */
#ifndef Fast_Stages_h
#define Fast_Stages_h

#include "MetricTensor.h"
#include "SteerableNoise.h"

#include <vector>

namespace steerable
{
/// Samples that go through the stages together: their arrays stay in the nearest caches.
constexpr std::size_t BlockSize = 512;
/// Samples of a row of an image at Quality 0: fewer, since their arrays then stay in the nearest
/// cache.
constexpr std::size_t CellsColumns = 256;
/// Samples that share lists of corners where they can.
constexpr std::size_t TileSamples = 64;
/// Where walks want it, a block of an image is this many rows of this many samples.
constexpr std::size_t PatchRows = ImageGrid::RowsTogether;
constexpr std::size_t PatchColumns = BlockSize / PatchRows;
/// Room for a whole SIMD register behind each row, and behind the block.
constexpr std::size_t PatchStride = PatchColumns + 16;
constexpr std::size_t BlockRoom = PatchRows * PatchStride + 16;
/// A row with its neighbours to either side, and room behind.
constexpr std::size_t RowRoom = PatchColumns + 2 * ImageGrid::MaximumStride + 32;

/// Places beyond this many cells, and those that are not finite, count as 0: 2^50.
constexpr double FarthestCell = 1125899906842624.0;

/// What the nearest float lacks.
inline float RestOf(double value)
{
  return static_cast<float>(value - static_cast<float>(value));
}

/// One octave: everything that is constant over all samples.
struct OctaveSetup
{
  double CellsPerUnit;
  /// Side of its cells in those of the first octave.
  float CellSize;
  float Amplitude;
  std::uint32_t Seed;
  std::array<std::int64_t, 3> Period;
};

/// Everything that is constant over all samples and octaves.
struct NoiseSetup
{
  NoiseParameters Parameters;
  std::vector<OctaveSetup> Octaves;
  /// 1 / √Σ amplitude².
  float OctaveScale;
  /// Half-width of the window in cells; infinite without one.
  float WindowReach;
  /// Largest q (and largest |t| of the fade) at which a surflet is not 0.
  float Support;
  /// Only what the fast loops know: gradients on the square lattice, still, quintic and separable.
  bool Variant;
  /// Nothing but the 2^N corners of the cell: Rice's Quality 0 without sums, Perlin's noise, and
  /// balls.
  bool SingleCell;
  /// The metric is I everywhere, and no window: a surflet is a ball of radius 1 around its corner.
  bool Ball;
  /// The same with one strength for all vectors, and nothing to do with the sum but to hand it out.
  bool Uniform;
  /// 0: a sample belongs to the corner below it. 1/2: to the nearest one, from which its distance
  /// has a float's full relative precision; normalisation would show less.
  double CellRounding;
  /// Nothing steers: every metric is I.
  bool Isotropic;
  /// Second axis in use (tensors and surfaces in 3D).
  bool Biaxial;
  bool Curved;
  /// How far jitter moves a corner down and up an axis.
  float JitterDown;
  float JitterUp;
  /// Middle of its way on every axis, and radius of the ball around that holds all of it; 0: none
  /// moves.
  float JitterMiddle;
  float JitterRadius;
  /// From indices of the lattice to its places, and back.
  float LatticeSteps[3][3];
  double LatticeIndices[3][3];
};

/// Structure of arrays of one block. Axes and eigenvalues, then what the octaves add up to.
struct MetricBlock
{
  alignas(64) float U[3][BlockRoom];
  /// What u as floats lacks: in 2D its components, with a second axis its parts on m and u x m.
  alignas(64) float URest[2][BlockRoom];
  alignas(64) float M[3][BlockRoom];
  alignas(64) float Along[BlockRoom];
  alignas(64) float Across[BlockRoom];
  alignas(64) float Second[BlockRoom];
  /// Curvature of the streamline in 1 / cells of the first octave.
  alignas(64) float Bend[3][BlockRoom];
  /// Length of the vector (Frobenius norm of the tensor).
  alignas(64) float Length[BlockRoom];
  /// 1 with a direction, 0 without: then there is no noise.
  alignas(64) float Directed[BlockRoom];
  /// What the curvature makes of these in one octave, see BendMetrics.
  alignas(64) float BentAlong[BlockRoom];
  alignas(64) float BentAcross[BlockRoom];
  alignas(64) float BentSecond[BlockRoom];
  alignas(64) float ClampedBend[3][BlockRoom];
  alignas(64) float Noise[BlockRoom];
  /// Places of the samples in the lattice: cells and fractions.
  alignas(64) std::uint32_t Cell[3][BlockRoom];
  alignas(64) float Fraction[3][BlockRoom];
  /// Room for tuples that the host converts, and for the directions of a patch and of two more
  /// rows: unit vectors, in 2D vectors and 1/length.
  alignas(64) float Tuples[6 * BlockRoom];
  alignas(64) float Shapes[3 * BlockRoom];
  alignas(64) double MetricTuples[6 * BlockRoom];
  alignas(64) double Positions[3 * BlockRoom];
  alignas(64) float DirectionRows[PatchRows + 2][3][RowRoom];
};
} // namespace steerable

#endif
