// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What subband noise of all blocks and ranks agrees on (private to this module), so that it goes on
 * from one to the next: bounds, spacing of the points, wavelength, stretch of the texture, seams,
 * and from these how tiles are laid and weights of points are found.
 */
#ifndef SubbandPlan_h
#define SubbandPlan_h

#include "NoiseBounds.h"
#include "SubbandPoints.h"
#include "SubbandSeams.h"
#include "SubbandSurface.h"
#include "SubbandTileCache.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkMultiProcessController;
class vtkPolyData;

namespace noise
{
/// What shapes of points depend on besides their surface.
struct SubbandPointsKey
{
  /// Only compared: they may be gone.
  std::array<const vtkDataArray*, 6> Arrays = {};
  std::vector<double> Values;
  std::vector<Eigen::Vector3d> Seams;

  bool operator==(const SubbandPointsKey& other) const
  {
    return this->Arrays == other.Arrays && this->Values == other.Values &&
      this->Seams == other.Seams;
  }
};

/// What was found out about a surface of the input, good as long as what it depends on is the same.
struct KeptSurface
{
  std::optional<CommonBounds> Bounds;
  double Diagonal = 0.0;
  std::optional<SurfaceSums> Sums; ///< With this diagonal.
  double ChartSide = 0.0;
  std::optional<SubbandSurface::Charts> Charts; ///< With this side.
  std::optional<SubbandSeams> Seams;

  SubbandPointsKey Key;
  bool ArePointsKnown = false;
  std::vector<SubbandChunk> Chunks;
  SubbandPointCounts Counts;
};

/// A surface that gets noise.
struct SubbandBlock
{
  vtkPolyData* Mesh = nullptr;
  /// The input's, of which it is a shallow copy.
  vtkDataObject* Source = nullptr;
  KeptSurface* Known = nullptr;
  vtkDataArray* Texture = nullptr; ///< Null: planar projections.
  vtkDataArray* Vectors = nullptr; ///< Null: nothing steers.
  bool CellVectors = false;
  vtkDataArray* Wavelengths = nullptr; ///< Null: the same at all points.
  vtkDataArray* Anisotropies = nullptr;
  std::unique_ptr<SubbandSurface> Surface; ///< Made where what is known does not do.
};

/// Properties of vtkPolyDataSubbandNoise, by their names there.
struct SubbandProperties
{
  double Wavelength = 0.0;
  double Anisotropy = 4.0;
  steerable::WeightMethod Method = steerable::WeightMethod::LeastSquares;
  int Orientations = 8;
  bool RadialTriple = false;
  int Octaves = 1;
  bool AntiAlias = true;
  bool WrapSeams = false;
  bool BlendSeams = false;
  int TileSize = 256;
  std::uint32_t Seed = 0;
  double Phase = 0.0;
  /// Arrays of wavelengths and anisotropies; empty: none.
  std::string WavelengthArray;
  std::string AnisotropyArray;
  /// Parameterization AUTOMATIC: projections where charts of the texture are too small.
  bool ChooseParameterization = true;
  bool WeightsOnly = false;
};

/// Kept from one plan to the next: they take longest to make.
struct SubbandTileSets
{
  SubbandTileCache Texture;
  SubbandTileCache Planes;
  SubbandTileCache Seams; ///< Of planes that take over from a texture.
  SubbandImageTiles Image;

  /// How long features become, tabulated anew only for other parameters: that takes some 20 ms.
  const steerable::SubbandAnisotropy* GetAnisotropy(
    int orientations, steerable::WeightMethod method);

  /// Weights on the texture or on planes, likewise.
  const steerable::SubbandWeights* GetWeights(
    bool ofTexture, const steerable::SubbandWeightParameters& parameters);

private:
  std::unique_ptr<steerable::SubbandWeights> Weights[2];
  std::unique_ptr<steerable::SubbandAnisotropy> Anisotropy;
  int AnisotropyOrientations = 0;
  steerable::WeightMethod AnisotropyMethod = steerable::WeightMethod::None;
};

/// What all ranks find together, for those who do not meet them.
struct SubbandAgreement
{
  CommonBounds Bounds;
  SurfaceSums Sums;
  /// Of arrays: the least wavelength, and the negated greatest and largest anisotropy.
  std::array<double, 3> Lengths = { std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity(), -1.0 };
  /// Area of small charts, that of all, and number of small ones.
  std::array<double, 3> Charts = {};
  SubbandSeams Seams;
};

/**
 * The AgreeOn functions come first, in their order, on all ranks of the controller; each needs what
 * the ones before found. One that fails on this rank says why in Failure, and the others still take
 * part.
 */
struct SubbandPlan
{
  SubbandProperties Properties;
  vtkMultiProcessController* Controller = nullptr;
  /// Not null: taken in place of agreeing.
  std::shared_ptr<const SubbandAgreement> Given;
  SubbandTileSets* Tiles = nullptr;
  bool IsSteered = false;
  bool IsOfImage = false; ///< Bands of an image take the place of tiles.
  const steerable::SubbandTiles* ImageTiles = nullptr;
  /// Why this rank cannot go on; empty: it can.
  std::string Failure;

  /// Bounds, spacing, and what the triangles say of the texture.
  void AgreeOnSurfaces(std::vector<SubbandBlock>& blocks);
  SubbandAgreement Agreed;
  double Diagonal = 0.0;
  SurfaceSums Own; ///< Of this rank.
  double Spacing = 0.0; ///< Typical distance of points; 0: there is none.

  /// Wavelength and anisotropy, from properties, arrays and spacing.
  void AgreeOnLengths(std::vector<SubbandBlock>& blocks);
  double Wavelength = 1.0;
  WavelengthRange Wavelengths;
  double AskedAnisotropy = 1.0; ///< The most.
  double MostAnisotropy = std::numeric_limits<double>::infinity(); ///< That the orientations reach.
  double WantedAnisotropy = 1.0; ///< The most that is reached.

  /// Whether the texture carries noise, and where planes take over. Takes it from blocks where it
  /// does not.
  void AgreeOnTexture(std::vector<SubbandBlock>& blocks);
  bool IsShattered = false; ///< Into charts smaller than a wavelength.
  double SmallCharts = 0.0;
  bool IsMirrored = false; ///< Most of it, so that triangles of the other kind are folded over.
  bool IsFolded = false;   ///< Little is of the other kind: a mistake, not charts.

  /// Throws std::invalid_argument for properties out of range.
  void LayTiles();
  const SubbandLayout& GetLayout(bool ofTexture) const { return this->Layouts[ofTexture]; }

  /// The whole image counts, not what suits the metric.
  bool IsWholeImage() const
  {
    return this->IsOfImage && this->Properties.Method == steerable::WeightMethod::None;
  }

  /**
   * What weights of a block's points are found with, and in which tiles they are looked up; those
   * that lack are made. It is good until tiles are made for another phase. Throws
   * std::invalid_argument.
   */
  SubbandPointWeights GetPointWeights(const SubbandBlock& block);

  /// For comparison; what GetPointWeights gave, with arrays of the user's own.
  SubbandPointsKey GetPointsKey(
    const SubbandBlock& block, const SubbandPointWeights& weights) const;

  /// The block's triangles, ready for GetPointWeights' FindPoints. Throws std::bad_alloc.
  SubbandSurface& PrepareSurface(SubbandBlock& block) const;

private:
  bool BlendsSeams() const { return this->Properties.BlendSeams && !this->IsOfImage; }
  SubbandSurface& GetSurface(SubbandBlock& block) const;
  /// `reduce` makes what this rank found that of all, unless it was given.
  template <typename Value, typename Reduce>
  void Agree(Value SubbandAgreement::*what, Reduce&& reduce)
  {
    if (this->Given)
    {
      this->Agreed.*what = (*this->Given).*what;
    }
    else
    {
      reduce(this->Agreed.*what);
    }
  }
  void AddBounds(std::vector<SubbandBlock>& blocks);
  void ResolveAnisotropy(double largest);
  vtkDataArray* FindLengths(
    const SubbandBlock& block, const std::string& name, const char* property);
  void FindCharts(std::vector<SubbandBlock>& blocks);
  void FindSeams(std::vector<SubbandBlock>& blocks);
  void AddLookups(bool ofTexture, int firstPlane, std::vector<SubbandLookup>& lookups);
  steerable::TriangleMapping GetAvoided() const;

  double Anisotropy = 1.0;                             // what SteeredFeature takes
  double LargestSteering = 1.0;                        // the same of the largest of an array
  const steerable::SubbandAnisotropy* Scale = nullptr; // null: as it is
  SubbandLayout Layouts[2];                            // on planes, on the texture
  steerable::SubbandTiles NoTiles[2];                  // of weights alone
};
} // namespace noise

#endif
