// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The points of a surface as tiles see them (private to this module): where each is looked up, with
 * which metric, and with which weights of the bands.
 *
 *     texture or planes -> metric and footprint of a point (FindPoints) -> weights (Weigh)
 *
 * SubbandEvaluator sums the tiles with these weights.
 */
#ifndef SubbandPoints_h
#define SubbandPoints_h

#include "Subband/SubbandAnisotropy.h"
#include "Subband/SubbandTiles.h"
#include "Subband/SubbandWeights.h"
#include "SubbandLayout.h"
#include "SubbandSurface.h"

#include "vtkType.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

class vtkDataArray;
class vtkUnsignedCharArray;

namespace noise
{
class SubbandSeams;

/// All that weights with these parameters depend on, for comparison.
std::array<double, 7> KeyOf(const steerable::SubbandWeightParameters& parameters);

/// What points are looked up in and weighted with on the texture or in a planar projection.
struct SubbandLookup
{
  const SubbandLayout* Layout;
  const steerable::SubbandWeights* Weights;
  const steerable::SubbandTiles* Tiles;
};

/// Points that are evaluated together.
constexpr vtkIdType SubbandChunkSize = 256;

/// The points of a chunk that one lookup contributes to.
struct SubbandPlanePoints
{
  /// What weights are found from.
  struct Shape
  {
    /// XX, XY and YY, in squared repeats of the tile.
    Eigen::Array3d Metric;
    Eigen::Array3d Footprint;
    double Blend; ///< Of the tiles of several planes.
  };
  std::vector<unsigned char> Points;    ///< Within the chunk.
  std::vector<Eigen::Vector2d> Texture; ///< Repeats of the tile.
  std::vector<Shape> Shapes;
  /// Of each octave, of each point, of each band.
  std::vector<std::vector<float>> Weights;
};

struct SubbandChunk
{
  std::vector<SubbandPlanePoints> Planes; ///< One for each lookup.
  std::vector<float> Distortion;          ///< Where it is asked for.
};

/// What happened at points; `operator+=` joins what threads found.
struct SubbandPointCounts
{
  vtkIdType Points = 0;
  vtkIdType Unmapped = 0;
  vtkIdType Undirected = 0;
  vtkIdType Clamped = 0;
  double Finer = 1.0; ///< Largest factor that clamped noise is finer than wanted.
  double Coarser = 1.0;

  SubbandPointCounts& operator+=(const SubbandPointCounts& other);
};

/// Value at a point where it is positive and finite, else `usual`; null: always.
double WavelengthAt(vtkDataArray* array, vtkIdType point, double usual);

/// The same of an anisotropy, from 1 to 8.
double AnisotropyAt(vtkDataArray* array, vtkIdType point, double usual);

/// What weights of points are found with. Constant while threads use it.
struct SubbandPointWeights
{
  /// The texture's, or those of three planes, or all four where planes take over at seams.
  std::vector<SubbandLookup> Lookups;
  /// Where they do; null: nowhere.
  const SubbandSeams* Seams = nullptr;

  double Wavelength = 1.0; ///< World units.
  double Anisotropy = 1.0; ///< What SteeredFeature takes.
  int Octaves = 1;
  bool AntiAlias = true;
  bool NeedsDistortion = false;

  /// Wavelength and Anisotropy of each point; null: those of all.
  vtkDataArray* WavelengthArray = nullptr;
  vtkDataArray* AnisotropyArray = nullptr;
  /// From what the array of anisotropies says to what SteeredFeature takes; null: Method None.
  const steerable::SubbandAnisotropy* Scale = nullptr;
  /// The property, where that array has no value.
  double Wanted = 1.0;

  /// Weights of the user's own, one tuple a point of all planes' bands; null: those of the metric.
  vtkDataArray* OwnWeights = nullptr;
  /// Of each octave and orientation, orientation fastest; null: all 1.
  vtkDataArray* Factors = nullptr;

  /// All of an image counts, with its residuals, whatever the metric.
  bool WholeImage = false;
  /// Antialiased weights are held at the variance of noise: not those that are no noise's.
  bool Limited = true;

  /// Where the weights of a lookup begin in a tuple of all; of one after the last: their number.
  int GetFirstComponent(std::size_t lookup) const;

  /// Octaves with weights of their own; without a filter and factors all have the first one's.
  std::size_t GetWeightedOctaves() const;

  /**
   * Fills a chunk with the points [first, last) of a surface, which come without weights. `ghosts`
   * is null or vtkGhostType of the points; those are not counted.
   */
  SubbandPointCounts FindPoints(const SubbandSurface& surface, const SteeringVectors& vectors,
    vtkUnsignedCharArray* ghosts, vtkIdType first, vtkIdType last, SubbandChunk& chunk) const;

  /// Adds the weights of octaves that points of a lookup lack; their chunk begins at the point
  /// `first`.
  void Weigh(SubbandPlanePoints& plane, std::size_t which, vtkIdType first) const;

  /// All that they depend on besides the surface, for comparison.
  std::vector<double> GetKey() const;

private:
  double GetWavelength(vtkIdType point) const;
  double GetSteering(vtkIdType point) const;
  void AddTextured(const SubbandSurface& surface, const SteeringVectors& vectors, vtkIdType point,
    vtkIdType first, SubbandChunk& chunk, SubbandPointCounts& counts) const;
  void AddProjected(const SubbandSurface& surface, const SteeringVectors& vectors, vtkIdType point,
    vtkIdType first, SubbandChunk& chunk, double share, SubbandPointCounts& counts) const;
  bool AddPoint(SubbandPlanePoints& plane, std::size_t which, vtkIdType point,
    const Eigen::Vector2d& texture, const Eigen::Matrix2d& metric,
    const Eigen::Matrix2d& footprint, double blend, SubbandPointCounts& counts) const;
  void ComputeGamma(const SubbandPlanePoints::Shape& shape, std::size_t which, vtkIdType point,
    double* gamma) const;
  void FilterOctave(const SubbandPlanePoints::Shape& shape, std::size_t which, vtkIdType point,
    int octave, const double* gamma, float* weights) const;
};
} // namespace noise

#endif
