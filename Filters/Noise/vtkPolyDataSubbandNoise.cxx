// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPolyDataSubbandNoise.h"

#include "KeptByInput.h"
#include "NoiseArrays.h"
#include "NoiseBounds.h"
#include "NoiseErrors.h"
#include "NoiseGhosts.h"
#include "NoiseThreads.h"
#include "SubbandAnisotropy.h"
#include "SubbandNames.h"
#include "SubbandSeams.h"
#include "SubbandSurface.h"
#include "SubbandTiles.h"
#include "SubbandWeights.h"
#include "SurfaceMetric.h"

#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkPolyDataSubbandNoise);
vtkCxxSetObjectMacro(vtkPolyDataSubbandNoise, Controller, vtkMultiProcessController);

namespace
{
using noise::SubbandSurface;
using noise::SurfaceSums;

// More of the surface than this share is not folded over by the texture but mirrored charts.
constexpr double LargestFoldedShare = 0.1;
// How far texture coordinates may be stretched beyond the tiles' scales: on average, and at a place.
constexpr double MeanOctavesOutside = 0.002;
constexpr double ClampedOctaves = 0.05;
// Missing the tiles' scales by so much on average is worse than seams.
constexpr double FarOctavesOutside = 0.25;
// Linear interpolation between points wants this many of them in a wavelength.
constexpr double PointsPerWavelength = 8.0;
// A projection with less of the blend's power than this does not show.
constexpr double VisibleBlend = 0.1;
// Points that are evaluated together.
constexpr vtkIdType ChunkSize = 256;
// Octaves whose weights are kept; finer ones fade on most meshes, and each takes four bytes a band.
constexpr std::size_t MostKeptOctaves = 4;
using steerable::MostSubbandComponents;

struct KeptSurface;

/// A surface of the output that gets noise.
struct Block
{
  vtkPolyData* Mesh = nullptr;
  /// The input's, of which it is a shallow copy.
  vtkDataObject* Source = nullptr;
  KeptSurface* Known = nullptr;
  vtkDataArray* Texture = nullptr; // null: planar projections
  vtkDataArray* Vectors = nullptr;
  bool CellVectors = false;
  std::unique_ptr<SubbandSurface> Surface; // made where what is kept does not do
  vtkDataArray* Wavelengths = nullptr; // null: the same at all points
  vtkDataArray* Anisotropies = nullptr;
};

/// Tiles and how they are laid on surfaces: what all blocks with the same parameterization share.
struct Layout
{
  steerable::SubbandParameters Pyramid;
  double Repeats = 1.0;    // of the tile for one repeat of the texture, or for a world unit
  double FixedScale = 0.0; // of noise that ignores the mapping
};

/// Of all points: what the property says, and the least and the greatest where an array does.
struct Wavelengths
{
  double Usual = 1.0;
  double Shortest = 1.0;
  double Longest = 1.0;
};

/// Value of one component, length of more.
double ValueOf(vtkDataArray* array, vtkIdType i)
{
  const int components = array->GetNumberOfComponents();
  double squares = 0.0;
  for (int c = 0; c < components; ++c)
  {
    const double value = array->GetComponent(i, c);
    if (components == 1)
    {
      return value;
    }
    squares += value * value;
  }
  return std::sqrt(squares);
}

/// Value at a point where it is positive and finite, else `usual`; null: always.
double WavelengthAt(vtkDataArray* array, vtkIdType point, double usual)
{
  const double value = array ? ValueOf(array, point) : usual;
  return value > 0.0 && std::isfinite(value) ? value : usual;
}

/// The same of an anisotropy, from 1 to 8.
double AnisotropyAt(vtkDataArray* array, vtkIdType point, double usual)
{
  const double value = array ? ValueOf(array, point) : usual;
  return std::isfinite(value) ? std::clamp(value, 1.0, 8.0) : usual;
}

/// What happened at points; `operator+=` joins what threads found.
struct PointCounts
{
  vtkIdType Points = 0;
  vtkIdType Unmapped = 0;
  vtkIdType Undirected = 0;
  vtkIdType Clamped = 0;
  double Finer = 1.0; // largest factor that clamped noise is finer than wanted, or coarser
  double Coarser = 1.0;

  PointCounts& operator+=(const PointCounts& other)
  {
    this->Points += other.Points;
    this->Unmapped += other.Unmapped;
    this->Undirected += other.Undirected;
    this->Clamped += other.Clamped;
    this->Finer = std::max(this->Finer, other.Finer);
    this->Coarser = std::max(this->Coarser, other.Coarser);
    return *this;
  }
};

void Reduce(vtkMultiProcessController* controller, double* values, std::size_t count, int operation)
{
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    std::vector<double> all(count);
    controller->AllReduce(values, all.data(), static_cast<vtkIdType>(count), operation);
    std::copy(all.begin(), all.end(), values);
  }
}

/// Typical distance of points, from sums that are the same on all ranks.
double GetSpacing(const SurfaceSums& sums, double diagonal)
{
  const double triangles = sums[SurfaceSums::Triangles];
  const double area = sums[SurfaceSums::Area] * std::ldexp(diagonal * diagonal, -40);
  if (!(triangles > 0.0) || !(area > 0.0))
  {
    return 0.0;
  }
  // A closed surface has two triangles for each point. Three digits are enough, and read well.
  const double mean = std::sqrt(2.0 * area / triangles);
  const double unit = std::pow(10.0, std::floor(std::log10(mean)) - 2.0);
  return std::round(mean / unit) * unit;
}

/// The value that half of a histogram's area is below.
double Median(const double* histogram)
{
  double total = 0.0;
  for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
  {
    total += histogram[bin];
  }
  double below = 0.0;
  for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
  {
    below += histogram[bin];
    if (2.0 * below >= total)
    {
      return SurfaceSums::OctavesOf(bin);
    }
  }
  return 0.0;
}

/**
 * Tiles for texture coordinates: the fewest scales, and the fewest repeats, with which all but a little
 * of the surface finds its wavelengths in the pyramid; else the repeats that miss it by least. Only
 * whole repeats keep the texture's seams, so a tile is spread over several repeats of a texture only
 * where that is much too fine.
 */
Layout LayOnTexture(steerable::SubbandParameters pyramid, const SurfaceSums& sums, double diagonal,
  const Wavelengths& wavelengths, double anisotropy)
{
  // Scale of the wanted noise at a singular value of 2^octaves repeats per diagonal.
  const double center = std::log2(wavelengths.Usual / diagonal * pyramid.CenterFrequency());
  const double shorter = std::log2(wavelengths.Usual / wavelengths.Shortest);
  const double longer = std::log2(wavelengths.Longest / wavelengths.Usual);
  const double steering = 0.5 * std::log2(anisotropy);
  const auto octavesOutside = [&](double repeats, int scales)
  {
    const double shift = center + std::log2(repeats);
    double sum = 0.0;
    double total = 0.0;
    for (int bin = 0; bin < SurfaceSums::Bins; ++bin)
    {
      const double scale = SurfaceSums::OctavesOf(bin) + shift;
      const double below = steering + shorter - scale;
      const double above = scale + steering + longer - (scales - 1);
      total += sums.Smaller()[bin];
      sum += sums.Smaller()[bin] * (below > ClampedOctaves ? below : 0.0);
      sum += sums.Larger()[bin] * (above > ClampedOctaves ? above : 0.0);
    }
    return total > 0.0 ? sum / total : 0.0;
  };

  Layout layout;
  const int most = pyramid.MostScales();
  double best = std::numeric_limits<double>::infinity();
  const auto tryRepeats = [&](double repeats, int scales)
  {
    const double outside = octavesOutside(repeats, scales);
    if (outside < best)
    {
      best = outside;
      pyramid.Scales = scales;
      layout.Repeats = repeats;
    }
  };
  for (int scales = std::min(2, most); scales <= most && best > MeanOctavesOutside; ++scales)
  {
    for (int step = 0; step <= 160 && best > MeanOctavesOutside; ++step)
    {
      tryRepeats(std::round(std::exp2(step / 8.0)), scales);
    }
  }
  for (int step = 0; step <= 160 && best > FarOctavesOutside; ++step)
  {
    tryRepeats(1.0 / std::round(std::exp2(step / 8.0)), most);
  }
  layout.Pyramid = pyramid;
  const double mean = 0.5 * (Median(sums.Smaller()) + Median(sums.Larger()));
  layout.FixedScale =
    std::clamp(mean + center + std::log2(layout.Repeats), 0.0, pyramid.Scales - 1.0);
  return layout;
}

/**
 * Tiles for planar projections, which shorten features up to 4:1 where they fade out and 2:1 where
 * they show. The longest feature takes the coarsest scale.
 */
Layout LayOnPlanes(
  steerable::SubbandParameters pyramid, const Wavelengths& wavelengths, double anisotropy)
{
  const double octaves = std::max(2.0, std::log2(anisotropy) + 1.0) +
    std::log2(wavelengths.Longest / wavelengths.Shortest);
  pyramid.Scales = std::min(static_cast<int>(std::ceil(octaves - 1e-9)) + 1, pyramid.MostScales());
  Layout layout;
  layout.Pyramid = pyramid;
  const double coarsest = std::ldexp(pyramid.CenterFrequency(), 1 - pyramid.Scales);
  layout.Repeats = 1.0 / (coarsest * wavelengths.Longest * std::sqrt(anisotropy));
  layout.FixedScale =
    std::clamp(std::log2(layout.Repeats * wavelengths.Usual * pyramid.CenterFrequency()), 0.0,
      pyramid.Scales - 1.0);
  return layout;
}

/// Tiles of one layout, kept while their parameters stand.
class TileCache
{
public:
  /// One blend of tiles for each plane, at this phase of the loop. Planes are counted from `first`,
  /// always the same one of a cache: others are independent noise.
  const std::vector<steerable::SubbandTiles>& Update(
    const steerable::SubbandParameters& pyramid, double phase, int planes, int first = 0)
  {
    const std::array<double, 5> key = { double(pyramid.Orientations), double(pyramid.Scales),
      double(pyramid.TileSize), pyramid.BandCenter, double(pyramid.Seed) };
    if (key != this->Key)
    {
      this->Realizations.clear();
      this->Planes.clear();
      this->Key = key;
    }
    if (phase == this->Phase && static_cast<int>(this->Planes.size()) == planes)
    {
      return this->Planes;
    }
    const std::array<double, 4> loop = steerable::LoopWeights(phase);
    std::vector<int> missing;
    for (int plane = 0; plane < planes; ++plane)
    {
      for (int m = 0; m < 4; ++m)
      {
        const int realization = steerable::LoopRealization(first + plane, m);
        if (Counts(loop[m]) && !this->Realizations.count(realization))
        {
          missing.push_back(realization);
          this->Realizations[realization];
        }
      }
    }
    noise::WithThreads(
      [&]
      {
        vtkSMPTools::For(0, static_cast<vtkIdType>(missing.size()), 1,
          [&](vtkIdType begin, vtkIdType end)
          {
            for (vtkIdType n = begin; n < end; ++n)
            {
              steerable::SubbandParameters parameters = pyramid;
              parameters.Realization = static_cast<std::uint32_t>(missing[n]);
              this->Realizations.at(missing[n]) = steerable::MakeSubbandTiles(parameters);
            }
          });
      });
    this->Planes.clear();
    for (int plane = 0; plane < planes; ++plane)
    {
      std::vector<const steerable::SubbandTiles*> tiles;
      std::vector<double> weights;
      for (int m = 0; m < 4; ++m)
      {
        if (Counts(loop[m]))
        {
          tiles.push_back(&this->Realizations.at(steerable::LoopRealization(first + plane, m)));
          weights.push_back(loop[m]);
        }
      }
      this->Planes.push_back(steerable::BlendTiles(tiles, weights));
    }
    this->Phase = phase;
    return this->Planes;
  }

private:
  static bool Counts(double weight) { return std::abs(weight) > 1e-9; }

  std::array<double, 5> Key = {};
  double Phase = -1.0;
  std::map<int, steerable::SubbandTiles> Realizations;
  std::vector<steerable::SubbandTiles> Planes;
};
/// The tiles that an image of bands holds, made by SubbandDecomposition or SubbandNoiseTiles.
steerable::SubbandTiles ReadTiles(vtkImageData* image)
{
  const auto require = [](bool condition, const std::string& what)
  {
    if (!condition)
    {
      throw std::invalid_argument(what);
    }
  };
  vtkDataArray* array = image ? image->GetPointData()->GetArray("Subbands") : nullptr;
  vtkDataArray* center =
    image ? image->GetFieldData()->GetArray(noise::BandCenterName) : nullptr;
  steerable::SubbandTiles tiles;
  steerable::SubbandParameters& pyramid = tiles.Parameters;
  require(array && center && noise::CountSubbands(array, pyramid.Orientations, pyramid.Scales),
    "The image has no bands. Take that of Subband Decomposition.");
  int sides[3];
  image->GetDimensions(sides);
  require(sides[0] == sides[1] && sides[2] == 1,
    "The image of bands has " + std::to_string(sides[0]) + " x " + std::to_string(sides[1]) + " x " +
      std::to_string(sides[2]) + " points; a tile is square and flat in z. Resample the image first.");
  pyramid.TileSize = sides[0];
  pyramid.BandCenter = center->GetTuple1(0);
  pyramid.Validate();
  const int given = array->GetNumberOfComponents();
  if (given == steerable::ImageComponents(pyramid))
  {
    tiles.Residuals = given - pyramid.Components();
  }
  vtkDataArray* ranges = image->GetFieldData()->GetArray("SubbandRanges"); // of bytes
  const int components = tiles.Components();
  tiles.Values.resize(static_cast<std::size_t>(array->GetNumberOfTuples()) * components);
  for (vtkIdType texel = 0; texel < array->GetNumberOfTuples(); ++texel)
  {
    for (int c = 0; c < components; ++c)
    {
      const double value = array->GetComponent(texel, c);
      tiles.Values[texel * components + c] = static_cast<float>(
        ranges ? (value / 127.5 - 1.0) * ranges->GetComponent(c, 0) : value);
    }
  }
  return tiles;
}

/// The points of a chunk that one set of tiles contributes to, and with what weights.
struct PlanePoints
{
  /// What weights are found from.
  struct Shape
  {
    /// XX, XY and YY, in squared repeats of the tile.
    Eigen::Array3d Metric;
    Eigen::Array3d Footprint;
    double Blend; ///< Of the tiles of several planes.
  };
  std::vector<unsigned char> Points; // within the chunk
  std::vector<Eigen::Vector2d> Texture;
  std::vector<Shape> Shapes;
  /// Of each octave, of each point, of each band.
  std::vector<std::vector<float>> Weights;
};

struct Chunk
{
  std::vector<PlanePoints> Planes;
  std::vector<float> Distortion; // where it is asked for
};

/// What the shapes and weights of points depend on besides their surface.
struct PointsKey
{
  /// Only compared: they may be gone.
  std::array<const vtkDataArray*, 6> Arrays = {};
  std::vector<double> Values;
  std::vector<Eigen::Vector3d> Seams;

  bool operator==(const PointsKey& other) const
  {
    return this->Arrays == other.Arrays && this->Values == other.Values && this->Seams == other.Seams;
  }
};

/// What was found out about a surface of the input, good as long as what it depends on is the same.
struct KeptSurface
{
  std::optional<noise::CommonBounds> Bounds;
  double Diagonal = 0.0;
  std::optional<SurfaceSums> Sums; // with this diagonal
  double ChartSide = 0.0;
  std::optional<SubbandSurface::Charts> Charts; // with this side
  std::optional<noise::SubbandSeams> Seams;

  PointsKey Key;
  bool ArePointsKnown = false;
  std::vector<Chunk> Chunks;
  PointCounts Counts;

  void ForgetPoints()
  {
    this->ArePointsKnown = false;
    this->Chunks = {};
    this->Counts = PointCounts();
  }
};
} // namespace

/// What all blocks of all ranks agree on.
struct vtkPolyDataSubbandNoise::Agreement
{
  noise::CommonBounds Bounds;
  SurfaceSums Sums;
  std::array<double, 3> Lengths;
  std::array<double, 3> Charts;
  noise::SubbandSeams Seams;
};

struct vtkPolyDataSubbandNoise::Internals
{
  std::shared_ptr<const Agreement> Given; // by another filter; null: the ranks agree themselves
  std::shared_ptr<const Agreement> Last;

  /// By the texture coordinates, which are only compared, and WrapSeams.
  noise::KeptByInput<KeptSurface, std::pair<const vtkDataArray*, bool>> Kept;
  TileCache TextureTiles;
  TileCache PlaneTiles;
  TileCache SeamTiles; // of planes that take over from a texture

  /// The tiles that an image of bands holds, read anew only for another image or a changed one.
  const steerable::SubbandTiles& GetImageTiles(vtkImageData* image)
  {
    const vtkMTimeType time = image ? image->GetMTime() : 0;
    if (image != this->Image || time != this->ImageTime || !image)
    {
      this->Image = nullptr;
      this->ImageTiles = ReadTiles(image);
      this->Image = image;
      this->ImageTime = time;
    }
    return this->ImageTiles;
  }

  /// What comes from inputs.
  void Forget()
  {
    this->Kept.Clear();
    this->Image = nullptr;
    this->ImageTiles = steerable::SubbandTiles();
  }

  /// How long features become, tabulated anew only for other parameters: that takes some 20 ms.
  const steerable::SubbandAnisotropy* GetAnisotropy(int orientations, steerable::WeightMethod method)
  {
    if (!this->Anisotropy || orientations != this->AnisotropyOrientations ||
      method != this->AnisotropyMethod)
    {
      this->Anisotropy = std::make_unique<steerable::SubbandAnisotropy>(orientations, method);
      this->AnisotropyOrientations = orientations;
      this->AnisotropyMethod = method;
    }
    return this->Anisotropy.get();
  }

private:
  const vtkImageData* Image = nullptr; // only compared
  vtkMTimeType ImageTime = 0;
  steerable::SubbandTiles ImageTiles;
  std::unique_ptr<steerable::SubbandAnisotropy> Anisotropy;
  int AnisotropyOrientations = 0;
  steerable::WeightMethod AnisotropyMethod = steerable::WeightMethod::None;
};

namespace
{
/// What points are looked up in and weighted with on the texture or in a planar projection.
struct Lookup
{
  const Layout* Lay;
  const steerable::SubbandWeights* Weights;
  const steerable::SubbandTiles* Tiles;
};

/// What the points of all blocks with one kind of lookups are evaluated with.
struct Evaluator
{
  /// The texture's, or those of three planes, or all four where planes take over at seams.
  std::vector<Lookup> Lookups;
  double Wavelength;
  double Anisotropy;
  int Octaves;
  double Persistence;
  bool Turbulence;
  bool AntiAlias;
  std::uint32_t Seed;

  /// Output arrays; they may be null.
  float* Noise = nullptr;
  float* WeightArray = nullptr;
  float* Distortion = nullptr;
  bool NeedsDistortion = false;
  /// Weights of the user's own, one tuple a point of all planes' bands; null: those of the metric.
  vtkDataArray* OwnWeights = nullptr;
  /// Of each octave and orientation, orientation fastest; null: all 1.
  vtkDataArray* Factors = nullptr;
  /// Wavelength and Anisotropy of each point; null: those of all, the latter what SteeredFeature takes.
  vtkDataArray* WavelengthArray = nullptr;
  vtkDataArray* AnisotropyArray = nullptr;
  const steerable::SubbandAnisotropy* Scale = nullptr; // null: Method None
  /// The property, where the array of anisotropies has no value.
  double Wanted = 1.0;
  /// Where planes take over from the texture; null: nowhere.
  const noise::SubbandSeams* Seams = nullptr;
  /// All of an image counts, with its residuals, whatever the metric.
  bool WholeImage = false;
  /// Antialiased weights are held at the variance of noise: not those that are no noise's.
  bool Limited = true;

  double GetWavelength(vtkIdType point) const
  {
    return WavelengthAt(this->WavelengthArray, point, this->Wavelength);
  }
  double GetSteering(vtkIdType point) const
  {
    if (!this->AnisotropyArray)
    {
      return this->Anisotropy;
    }
    const double wanted = AnisotropyAt(this->AnisotropyArray, point, this->Wanted);
    return this->Scale ? this->Scale->GetSteering(wanted) : wanted;
  }

  /// Where the weights of a lookup begin in a tuple of all; of one after the last: their number.
  int GetFirstComponent(std::size_t lookup) const
  {
    int first = 0;
    for (std::size_t l = 0; l < lookup; ++l)
    {
      first += this->Lookups[l].Tiles->Components();
    }
    return first;
  }

  static Eigen::Matrix2d Symmetric(const Eigen::Array3d& entries)
  {
    return (Eigen::Matrix2d() << entries[0], entries[1], entries[1], entries[2]).finished();
  }

  /// Adds a point with this metric, in squared repeats of the tile; tells whether it was clamped.
  bool AddPoint(PlanePoints& plane, std::size_t which, vtkIdType point, const Eigen::Vector2d& texture,
    const Eigen::Matrix2d& metric, const Eigen::Matrix2d& footprint, double blend, PointCounts& counts) const
  {
    if (!texture.allFinite() || !metric.allFinite())
    {
      return false;
    }
    plane.Points.push_back(static_cast<unsigned char>(point));
    plane.Texture.push_back(texture);
    plane.Shapes.push_back({ { metric(0, 0), metric(0, 1), metric(1, 1) },
      { footprint(0, 0), footprint(0, 1), footprint(1, 1) }, blend });
    const Lookup& lookup = this->Lookups[which];
    Eigen::Matrix2d clamped = metric;
    if (lookup.Weights->GetParameters().Method == steerable::WeightMethod::None ||
      this->WholeImage || blend * blend < VisibleBlend || !lookup.Weights->ClampMetric(clamped))
    {
      return false;
    }
    // The range of the factors, from the range of eigenvalues.
    const steerable::SubbandParameters& pyramid = lookup.Lay->Pyramid;
    const double smallest = std::pow(pyramid.CenterFrequency(), -2.0);
    const double largest = std::ldexp(smallest, 2 * (pyramid.Scales - 1));
    const double mean = 0.5 * metric.trace();
    const double radius = std::hypot(0.5 * (metric(0, 0) - metric(1, 1)), metric(0, 1));
    const double low = std::max(mean - radius, 1e-12 * mean);
    const double coarser = std::sqrt(smallest / low);
    const double finer = std::sqrt((mean + radius) / largest);
    counts.Coarser = std::max(counts.Coarser, coarser);
    counts.Finer = std::max(counts.Finer, finer);
    return std::max(coarser, finer) > std::exp2(ClampedOctaves);
  }

  /// What weights and shapes depend on besides the surface.
  PointsKey GetKey(const Block& block, const noise::Plane& plane, int avoided) const
  {
    PointsKey key;
    key.Arrays = { block.Texture, block.Vectors, block.Wavelengths, block.Anisotropies, this->OwnWeights,
      this->Factors };
    key.Values = { double(block.CellVectors), double(plane[0]), double(plane[1]), double(avoided),
      this->Wavelength, this->Anisotropy, this->Wanted, double(this->AntiAlias), double(this->WholeImage),
      double(this->Limited), double(this->NeedsDistortion), double(this->Seams != nullptr) };
    for (const Lookup& lookup : this->Lookups)
    {
      const steerable::SubbandWeightParameters& weights = lookup.Weights->GetParameters();
      const steerable::SubbandParameters& pyramid = weights.Pyramid;
      key.Values.insert(key.Values.end(),
        { double(pyramid.Orientations), double(pyramid.Scales), double(pyramid.TileSize), pyramid.BandCenter,
          double(weights.Method), double(weights.RadialTriple), weights.FixedScale, lookup.Lay->Repeats,
          double(lookup.Tiles->Residuals) });
    }
    if (this->Factors)
    {
      key.Values.push_back(this->Octaves); // of the array's components
    }
    if (this->Seams)
    {
      key.Seams = this->Seams->GetPlaces();
    }
    return key;
  }

  /// Noise of the chunks [begin, end); `known` ones need no surface. Adds to what is known in `kept` if it is there.
  PointCounts Evaluate(const Block& block, const noise::SteeringVectors& vectors,
    vtkUnsignedCharArray* ghosts, bool known, std::vector<Chunk>* kept, std::size_t begin, std::size_t end) const
  {
    PointCounts counts;
    Chunk own;
    for (std::size_t c = begin; c < end; ++c)
    {
      Chunk& chunk = kept ? (*kept)[c] : own;
      const vtkIdType first = static_cast<vtkIdType>(c) * ChunkSize;
      const vtkIdType last = std::min(first + ChunkSize, block.Mesh->GetNumberOfPoints());
      if (!known)
      {
        counts += this->FindPoints(block, vectors, ghosts, first, last, chunk);
      }
      for (std::size_t which = 0; which < chunk.Planes.size(); ++which)
      {
        this->Weigh(chunk.Planes[which], which, first);
      }
      this->CopyWeights(chunk.Planes, first);
      if (this->Noise)
      {
        this->SumOctaves(chunk.Planes, first, last - first);
      }
      if (this->NeedsDistortion)
      {
        std::copy(chunk.Distortion.begin(), chunk.Distortion.end(), this->Distortion + first);
      }
      for (PlanePoints& plane : chunk.Planes)
      {
        plane.Weights.resize(std::min(plane.Weights.size(), MostKeptOctaves));
      }
    }
    return counts;
  }

  PointCounts FindPoints(const Block& block, const noise::SteeringVectors& vectors, vtkUnsignedCharArray* ghosts,
    vtkIdType first, vtkIdType last, Chunk& chunk) const
  {
    PointCounts counts;
    chunk.Planes.assign(this->Lookups.size(), PlanePoints());
    chunk.Distortion.assign(this->NeedsDistortion ? last - first : 0, 0.0f);
    for (vtkIdType point = first; point < last; ++point)
    {
      PointCounts here;
      here.Points = 1;
      if (block.Texture)
      {
        this->AddTextured(*block.Surface, vectors, point, first, chunk, here);
      }
      else
      {
        this->AddProjected(*block.Surface, vectors, point, first, chunk, 1.0, here);
      }
      if (!ghosts || !ghosts->GetValue(point))
      {
        counts += here;
      }
    }
    for (PlanePoints& plane : chunk.Planes)
    {
      plane.Points.shrink_to_fit();
      plane.Texture.shrink_to_fit();
      plane.Shapes.shrink_to_fit();
    }
    return counts;
  }

  void AddTextured(const SubbandSurface& surface, const noise::SteeringVectors& vectors,
    vtkIdType point, vtkIdType first, Chunk& chunk, PointCounts& counts) const
  {
    SubbandSurface::PointMetrics metrics;
    const bool mapped = surface.ComputeTextured(point, vectors, this->GetSteering(point), metrics);
    if (this->NeedsDistortion)
    {
      const double ratio = mapped ? steerable::DistortionRatio(metrics.Isotropic) : 0.0;
      chunk.Distortion[point - first] = static_cast<float>(ratio);
    }
    double share = mapped ? 1.0 : 0.0;
    if (this->Seams)
    {
      if (mapped)
      {
        const int orientations = this->Lookups[0].Lay->Pyramid.Orientations;
        const double wavelength = this->GetWavelength(point);
        share = steerable::TextureBlend(steerable::DistortionRatio(metrics.Isotropic),
          steerable::FollowedStretch(orientations),
          this->Seams->GetDistance(surface.GetPoint(point), wavelength) / wavelength);
      }
      if (share < 1.0)
      {
        this->AddProjected(
          surface, vectors, point, first, chunk, std::sqrt(1.0 - share * share), counts);
      }
    }
    else if (!mapped)
    {
      counts.Unmapped = 1;
    }
    if (!(share > 0.0))
    {
      return;
    }
    counts.Undirected = vectors.Values && !metrics.Directed;
    const double repeats = this->Lookups[0].Lay->Repeats;
    const double scale = repeats * this->GetWavelength(point);
    const bool clamped = this->AddPoint(chunk.Planes[0], 0, point - first,
      repeats * surface.GetTexture(point), metrics.Metric * (scale * scale),
      metrics.Footprint * (repeats * repeats), share, counts);
    counts.Clamped = counts.Clamped || clamped;
  }

  /// `share`: of the projections beside the texture, squares summing to one.
  void AddProjected(const SubbandSurface& surface, const noise::SteeringVectors& vectors,
    vtkIdType point, vtkIdType first, Chunk& chunk, double share, PointCounts& counts) const
  {
    SubbandSurface::PointFeatures features;
    const bool mapped = surface.ComputeProjected(point, vectors, this->GetSteering(point), features);
    if (this->NeedsDistortion && !surface.IsTextured())
    {
      chunk.Distortion[point - first] =
        mapped ? static_cast<float>(1.0 / features.Normal.cwiseAbs().maxCoeff()) : 0.0f;
    }
    if (!mapped)
    {
      counts.Unmapped = 1;
      return;
    }
    counts.Undirected = vectors.Values && !features.Directed;
    const Eigen::Vector3d blend = share * steerable::TriplanarBlend(features.Normal);
    const std::size_t firstPlane = surface.IsTextured() ? 1 : 0;
    const double repeats = this->Lookups[firstPlane].Lay->Repeats;
    const Eigen::Vector3d place = surface.GetPoint(point) * repeats;
    const double wavelength = this->GetWavelength(point);
    const Eigen::Matrix3d feature = features.Feature * (wavelength * wavelength);
    for (int axis = 0; axis < 3; ++axis)
    {
      if (blend[axis] > 0.0)
      {
        const steerable::TextureGradients gradients =
          steerable::PlanarGradients(features.Normal, axis, 1.0 / repeats);
        const Eigen::Vector2d texture(place[axis == 0 ? 1 : 0], place[axis == 2 ? 1 : 2]);
        const std::size_t which = firstPlane + axis;
        const bool clamped = this->AddPoint(chunk.Planes[which], which, point - first, texture,
          steerable::SurfaceMetric(gradients, feature),
          gradients.transpose() * features.Spacing * gradients, blend[axis], counts);
        counts.Clamped = counts.Clamped || clamped;
      }
    }
  }

  /// Octaves with weights of their own; without a filter and factors all have the first one's.
  std::size_t GetWeightedOctaves() const
  {
    return this->AntiAlias || this->Factors ? static_cast<std::size_t>(this->Octaves) : 1;
  }

  /// The weights that a plane still lacks; the chunk begins at the point `first`.
  void Weigh(PlanePoints& plane, std::size_t which, vtkIdType first) const
  {
    const Lookup& lookup = this->Lookups[which];
    const int bands = lookup.Lay->Pyramid.Components();
    const int components = lookup.Tiles->Components();
    const std::size_t points = plane.Points.size();
    const std::size_t known = plane.Weights.size();
    const std::size_t octaves = this->GetWeightedOctaves();
    if (octaves <= known)
    {
      return;
    }
    plane.Weights.resize(octaves);
    for (std::size_t octave = known; octave < octaves; ++octave)
    {
      plane.Weights[octave].resize(components * points);
    }
    double gamma[MostSubbandComponents];
    double beta[MostSubbandComponents];
    for (std::size_t n = 0; n < points; ++n)
    {
      const vtkIdType point = first + plane.Points[n];
      this->ComputeGamma(plane.Shapes[n], which, point, gamma);
      for (std::size_t octave = known; octave < octaves; ++octave)
      {
        std::fill_n(beta, components, 1.0);
        if (this->AntiAlias)
        {
          const Eigen::Matrix2d footprint =
            Symmetric(plane.Shapes[n].Footprint) * std::ldexp(1.0, 2 * static_cast<int>(octave));
          lookup.Weights->Antialias(footprint, beta);
          if (components > bands)
          {
            lookup.Weights->AntialiasHigh(footprint, beta + bands);
          }
        }
        for (int c = 0; c < components; ++c)
        {
          beta[c] *= gamma[c];
        }
        if (this->AntiAlias && this->Limited)
        {
          lookup.Weights->LimitVariance(plane.Shapes[n].Blend * plane.Shapes[n].Blend, beta);
        }
        if (this->Factors)
        {
          const int orientations = lookup.Lay->Pyramid.Orientations;
          // The low residual of an image has no orientation.
          for (int c = 0; c < (components > bands ? components - 1 : components); ++c)
          {
            beta[c] *= this->Factors->GetComponent(
              point, static_cast<int>(octave) * orientations + c % orientations);
          }
        }
        std::copy(beta, beta + components, plane.Weights[octave].begin() + n * components);
      }
    }
  }

  /// Weights before what each octave adds.
  void ComputeGamma(const PlanePoints::Shape& shape, std::size_t which, vtkIdType point, double* gamma) const
  {
    const Lookup& lookup = this->Lookups[which];
    const int components = lookup.Tiles->Components();
    std::fill(gamma + lookup.Lay->Pyramid.Components(), gamma + components, 0.0);
    lookup.Weights->Compute(Symmetric(shape.Metric), gamma);
    if (this->WholeImage)
    {
      std::fill_n(gamma, components, 1.0);
    }
    if (this->OwnWeights)
    {
      const int offset = this->GetFirstComponent(which);
      for (int c = 0; c < components; ++c)
      {
        const double own = this->OwnWeights->GetComponent(point, offset + c);
        gamma[c] = std::isfinite(own) ? own / shape.Blend : 0.0;
      }
    }
    for (int c = 0; c < components; ++c)
    {
      gamma[c] *= shape.Blend;
    }
  }

  /// Those of the first octave, if they are asked for.
  void CopyWeights(const std::vector<PlanePoints>& planes, vtkIdType first) const
  {
    const vtkIdType tuple = this->GetFirstComponent(planes.size());
    for (std::size_t which = 0; this->WeightArray && which < planes.size(); ++which)
    {
      const PlanePoints& plane = planes[which];
      const int components = this->Lookups[which].Tiles->Components();
      for (std::size_t n = 0; n < plane.Points.size(); ++n)
      {
        std::copy_n(plane.Weights[0].data() + n * components, components,
          this->WeightArray + (first + plane.Points[n]) * tuple + this->GetFirstComponent(which));
      }
    }
  }

  void SumOctaves(const std::vector<PlanePoints>& planes, vtkIdType first, vtkIdType count) const
  {
    std::vector<double> uv;
    std::vector<float> values;
    std::array<float, ChunkSize> sum{};
    double amplitude = 1.0;
    for (int octave = 0; octave < this->Octaves; ++octave, amplitude *= this->Persistence)
    {
      const double scale = std::ldexp(1.0, octave);
      // Without a shift octaves would be copies of each other.
      const std::array<double, 2> shift =
        octave == 0 ? std::array<double, 2>{} : steerable::TileOffset(octave, this->Seed);
      std::array<float, ChunkSize> noise{};
      for (std::size_t which = 0; which < planes.size(); ++which)
      {
        const PlanePoints& plane = planes[which];
        const steerable::SubbandTiles& tiles = *this->Lookups[which].Tiles;
        const std::vector<float>& weights =
          plane.Weights[std::min<std::size_t>(octave, this->GetWeightedOctaves() - 1)];
        const std::size_t points = plane.Points.size();
        uv.resize(2 * points);
        values.resize(points);
        for (std::size_t n = 0; n < points; ++n)
        {
          uv[2 * n] = scale * plane.Texture[n][0] + shift[0];
          uv[2 * n + 1] = scale * plane.Texture[n][1] + shift[1];
        }
        steerable::SumSubbands(
          tiles, steerable::TileLookup::CatmullRom, points, uv.data(), weights.data(), values.data());
        for (std::size_t n = 0; n < points; ++n)
        {
          noise[plane.Points[n]] += values[n];
        }
      }
      for (vtkIdType n = 0; n < count; ++n)
      {
        const float value = this->Turbulence ? std::abs(noise[n]) : noise[n];
        sum[n] += static_cast<float>(amplitude) * value;
      }
    }
    std::copy_n(sum.begin(), count, this->Noise + first);
  }
};

/// Collects the surfaces of the input, and what to say about the rest.
class BlockFinder
{
public:
  BlockFinder(vtkPolyDataSubbandNoise* self, vtkInformation* choice)
    : Self(self)
  {
    if (choice->Has(vtkDataObject::FIELD_ASSOCIATION()))
    {
      this->Cells =
        choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    }
    if (choice->Has(vtkDataObject::FIELD_NAME()))
    {
      this->Name = noise::GetChosenName(choice);
    }
    else if (choice->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
    {
      this->Attribute = choice->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
    }
  }

  bool IsSteered() const { return !this->Name.empty() || this->Attribute >= 0; }

  /// False where the block has no noise; then Why says why.
  bool Find(Block& block)
  {
    return this->FindTexture(block) && (!this->IsSteered() || this->FindVectors(block));
  }

  std::string Why;

private:
  bool FindTexture(Block& block)
  {
    const int choice = this->Self->GetNumberOfInputConnections(1) > 0
      ? vtkPolyDataSubbandNoise::TEXTURE_COORDINATES
      : this->Self->GetParameterization();
    if (choice == vtkPolyDataSubbandNoise::TRIPLANAR)
    {
      return true;
    }
    vtkDataArray* texture = block.Mesh->GetPointData()->GetTCoords();
    if (texture && texture->GetNumberOfComponents() >= 2 &&
      texture->GetNumberOfTuples() >= block.Mesh->GetNumberOfPoints())
    {
      block.Texture = texture;
      return true;
    }
    if (choice == vtkPolyDataSubbandNoise::AUTOMATIC)
    {
      return true;
    }
    this->Why =
      "There are no texture coordinates (2 or 3 components) on the points. Make them, for "
      "instance with Texture Map to Sphere, or set Parameterization to Triplanar.";
    return false;
  }

  bool FindVectors(Block& block)
  {
    for (const bool cells : { this->Cells, !this->Cells })
    {
      vtkDataSetAttributes* attributes = cells
        ? static_cast<vtkDataSetAttributes*>(block.Mesh->GetCellData())
        : block.Mesh->GetPointData();
      vtkDataArray* array = this->Attribute >= 0
        ? vtkDataArray::SafeDownCast(attributes->GetAbstractAttribute(this->Attribute))
        : attributes->GetArray(this->Name.c_str());
      if (!array)
      {
        continue;
      }
      const vtkIdType needed =
        cells ? block.Mesh->GetNumberOfCells() : block.Mesh->GetNumberOfPoints();
      if (noise::IsVector(array->GetNumberOfComponents()) && array->GetNumberOfTuples() >= needed)
      {
        block.Vectors = array;
        block.CellVectors = cells;
        return true;
      }
      std::ostringstream message;
      message << "Array '" << (array->GetName() ? array->GetName() : "") << "' has "
              << array->GetNumberOfComponents() << " component(s) and "
              << array->GetNumberOfTuples() << " tuples. Choose vectors, with 2 or 3, for all "
              << needed << (cells ? " cells." : " points.");
      this->Why = message.str();
    }
    if (this->Why.empty())
    {
      this->Why = this->Name.empty()
        ? "There are no active vectors on points or cells. Name an array of vectors, or none."
        : "There is no array '" + this->Name +
          "' on points or cells. Choose vectors that exist, or None.";
    }
    return false;
  }

  vtkPolyDataSubbandNoise* Self;
  std::string Name;
  int Attribute = -1;
  bool Cells = false;
};
} // namespace

//------------------------------------------------------------------------------
vtkPolyDataSubbandNoise::vtkPolyDataSubbandNoise()
  : Cache(new Internals)
{
  this->SetNumberOfInputPorts(2);
  this->SetResultArrayName("SubbandNoise");
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

//------------------------------------------------------------------------------
vtkPolyDataSubbandNoise::~vtkPolyDataSubbandNoise()
{
  this->SetResultArrayName(nullptr);
  this->SetController(nullptr);
  delete this->Cache;
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetKeepFields(bool keepFields)
{
  // No reason to execute again.
  this->KeepFields = keepFields;
  if (!keepFields)
  {
    this->Cache->Forget();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetOrientations(int orientations)
{
  const int allowed = noise::TakeOrientations(this, orientations);
  if (this->Orientations != allowed)
  {
    this->Orientations = allowed;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetPhase(double phase)
{
  phase = std::isfinite(phase) ? phase - std::floor(phase) : 0.0;
  if (this->Phase != phase)
  {
    this->Phase = phase;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::TakeAgreement(vtkPolyDataSubbandNoise* other)
{
  const std::shared_ptr<const Agreement> given = other ? other->Cache->Last : nullptr;
  if (this->Cache->Given != given)
  {
    this->Cache->Given = given;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetSubbandsConnection(vtkAlgorithmOutput* bands)
{
  this->SetInputConnection(1, bands);
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetSubbandsData(vtkImageData* bands)
{
  this->SetInputDataObject(1, bands);
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
    return 1;
  }
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // A point's metric is the mean over the triangles around it.
  using SDDP = vtkStreamingDemandDrivenPipeline;
  inputVector[0]->GetInformationObject(0)->Set(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS(),
    outputVector->GetInformationObject(0)->Get(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS()) + 1);
  if (this->GetNumberOfInputConnections(1) > 0)
  {
    // Each rank looks up all of the image.
    vtkInformation* image = inputVector[1]->GetInformationObject(0);
    int whole[6];
    image->Get(SDDP::WHOLE_EXTENT(), whole);
    image->Set(SDDP::UPDATE_EXTENT(), whole, 6);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  const auto refuse = [&](const std::string& why) { return noise::Refuse(this, output, why); };
  if (!this->ResultArrayName || !*this->ResultArrayName)
  {
    return refuse("ResultArrayName is empty. Give the noise array a name.");
  }
  // Everything else is clamped when it is set, but NaN passes a clamp.
  if (std::isnan(this->Wavelength) || std::isnan(this->Anisotropy) ||
    std::isnan(this->Persistence))
  {
    std::ostringstream why;
    why << "Wavelength is " << this->Wavelength << ", Anisotropy " << this->Anisotropy << ", Persistence "
        << this->Persistence << "; give each a number.";
    return refuse(why.str());
  }

  // On every way out.
  const auto drop = [this](Internals* cache)
  {
    if (!this->KeepFields)
    {
      cache->Forget();
    }
  };
  const std::unique_ptr<Internals, decltype(drop)> dropUnlessKept(this->Cache, drop);

  // The output: shallow copies of the input's datasets, so that arrays can be added.
  BlockFinder finder(this, this->GetInputArrayInformation(0));
  std::vector<Block> blocks;
  SurfaceSums sums;
  noise::CommonBounds bounds;
  vtkIdType blocksWithout = 0;
  std::string otherType;
  const auto addMesh = [&](vtkPolyData* mesh, vtkDataObject* source)
  {
    Block block;
    block.Mesh = mesh;
    block.Source = source;
    if (mesh->GetNumberOfPoints() == 0)
    {
      return;
    }
    if (finder.Find(block))
    {
      blocks.push_back(std::move(block));
    }
    else
    {
      ++blocksWithout;
    }
  };
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (composite)
  {
    auto* inputs = vtkCompositeDataSet::SafeDownCast(input);
    composite->CopyStructure(inputs);
    composite->GetFieldData()->PassData(inputs->GetFieldData());
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(inputs->NewIterator());
    for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      vtkDataObject* leaf = iterator->GetCurrentDataObject();
      auto copy = vtkSmartPointer<vtkDataObject>::Take(leaf->NewInstance());
      copy->ShallowCopy(leaf);
      composite->SetDataSet(iterator, copy);
      if (auto* mesh = vtkPolyData::SafeDownCast(copy))
      {
        addMesh(mesh, leaf);
      }
      else
      {
        ++sums[SurfaceSums::OtherBlocks];
        otherType = leaf->GetClassName();
      }
    }
  }
  else
  {
    output->ShallowCopy(input);
    addMesh(vtkPolyData::SafeDownCast(output), input);
  }

  // What fails on this rank is told of after everything that ranks do together: the others wait for it.
  std::string failure;
  const auto attempt = [&failure](const auto& work)
  {
    try
    {
      if (failure.empty())
      {
        work();
      }
    }
    catch (const std::exception& error)
    {
      failure = error.what();
    }
  };
  const bool ofImage = this->GetNumberOfInputConnections(1) > 0;
  const steerable::SubbandTiles* imageTiles = nullptr;
  if (ofImage && !blocks.empty())
  {
    attempt([&] { imageTiles = &this->Cache->GetImageTiles(vtkImageData::GetData(inputVector[1])); });
  }
  const bool blendSeams = this->BlendSeams && !ofImage;
  this->Cache->Kept.Assign(blocks,
    [this](const Block& block)
    { return std::pair<const vtkDataArray*, bool>(block.Texture, this->WrapSeams); });
  for (const Block& block : blocks)
  {
    std::optional<noise::CommonBounds>& known = block.Known->Bounds;
    if (!known)
    {
      known.emplace();
      known->Add(block.Mesh, noise::HiddenSamples(block.Mesh));
    }
    bounds.Add(*known);
  }
  const std::shared_ptr<const Agreement> given = this->Cache->Given;
  auto agreed = std::make_shared<Agreement>();
  const auto agree = [&](auto& value, auto Agreement::*member, const auto& reduce)
  {
    if (given)
    {
      value = (*given).*member;
    }
    else
    {
      reduce();
    }
    (*agreed).*member = value;
  };
  agree(bounds, &Agreement::Bounds, [&] { bounds.Reduce(this->Controller); });
  const double diagonal = bounds.GetDiagonal();
  const auto getSurface = [&](Block& block) -> SubbandSurface&
  {
    if (!block.Surface)
    {
      block.Surface =
        std::make_unique<SubbandSurface>(block.Mesh, block.Texture, this->WrapSeams, blendSeams);
    }
    return *block.Surface;
  };
  attempt(
    [&]
    {
      for (Block& block : blocks)
      {
        KeptSurface& known = *block.Known;
        if (!known.Sums || known.Diagonal != diagonal)
        {
          known.Diagonal = diagonal;
          known.Sums.emplace();
          getSurface(block).AddTo(*known.Sums, diagonal);
        }
        sums += *known.Sums;
        ++sums[block.Texture ? SurfaceSums::TexturedBlocks : SurfaceSums::ProjectedBlocks];
      }
    });
  const SurfaceSums local = sums;
  agree(sums, &Agreement::Sums,
    [&] { Reduce(this->Controller, sums.Values.data(), sums.Values.size(), vtkCommunicator::SUM_OP); });

  const bool nothing =
    sums[SurfaceSums::TexturedBlocks] + sums[SurfaceSums::ProjectedBlocks] == 0.0;
  if (failure.empty() && blocksWithout > 0 && (!composite || nothing))
  {
    failure = finder.Why;
  }
  if (failure.empty() && local[SurfaceSums::OtherBlocks] > 0 && nothing && blocksWithout == 0)
  {
    failure = "The input holds no surface but " + otherType + ". Extract its surface first.";
  }

  // K directions make features rounder than the metric says: it has to say more.
  double anisotropy = finder.IsSteered() ? this->Anisotropy : 1.0;
  double wanted = anisotropy;
  double asked = anisotropy; // at the most, where an array says it
  const auto nameOf = [&](int which)
  { return noise::GetChosenName(this->GetInputArrayInformation(which)); };
  const std::string wavelengthName = nameOf(WAVELENGTH_ARRAY);
  const std::string anisotropyName =
    finder.IsSteered() ? nameOf(ANISOTROPY_ARRAY) : std::string();
  std::array<double, 3> lengths = { std::numeric_limits<double>::infinity(), // least, -greatest, -anisotropy
    std::numeric_limits<double>::infinity(), -1.0 };
  for (Block& block : blocks)
  {
    if (!failure.empty())
    {
      break;
    }
    const auto find = [&](const std::string& name, const char* property) -> vtkDataArray*
    {
      vtkDataArray* array =
        name.empty() ? nullptr : block.Mesh->GetPointData()->GetArray(name.c_str());
      if (!name.empty() &&
        (!array || array->GetNumberOfComponents() > 3 ||
          array->GetNumberOfTuples() < block.Mesh->GetNumberOfPoints()))
      {
        failure = "Array '" + name + "' for " + property +
          " is not on the points with 1 to 3 components. Choose another one, or None.";
        return nullptr;
      }
      return array;
    };
    block.Wavelengths = find(wavelengthName, "Wavelength");
    block.Anisotropies = find(anisotropyName, "Anisotropy");
    const vtkIdType points = block.Mesh->GetNumberOfPoints();
    for (vtkIdType i = 0; block.Wavelengths && i < points; ++i)
    {
      const double length = WavelengthAt(block.Wavelengths, i, 0.0);
      if (length > 0.0)
      {
        lengths[0] = std::min(lengths[0], length);
        lengths[1] = std::min(lengths[1], -length);
      }
    }
    for (vtkIdType i = 0; block.Anisotropies && i < points; ++i)
    {
      lengths[2] = std::min(lengths[2], -AnisotropyAt(block.Anisotropies, i, 1.0));
    }
  }
  agree(lengths, &Agreement::Lengths,
    [&] { Reduce(this->Controller, lengths.data(), 3, vtkCommunicator::MIN_OP); });
  if (!anisotropyName.empty())
  {
    wanted = asked = -lengths[2];
  }
  const steerable::SubbandAnisotropy* anisotropyScale = nullptr;
  double mostAnisotropy = std::numeric_limits<double>::infinity();
  if (finder.IsSteered() && this->Method != NONE &&
    (this->Anisotropy > 1.0 || !anisotropyName.empty()))
  {
    anisotropyScale = this->Cache->GetAnisotropy(
      this->Orientations, static_cast<steerable::WeightMethod>(this->Method));
    anisotropy = anisotropyScale->GetSteering(this->Anisotropy);
    mostAnisotropy = anisotropyScale->GetMost();
    wanted = std::min(wanted, mostAnisotropy);
  }
  double mostSteering = anisotropy;
  if (!anisotropyName.empty())
  {
    mostSteering = anisotropyScale ? anisotropyScale->GetSteering(asked) : asked;
  }
  const double spacing = GetSpacing(sums, diagonal);
  double wavelength = this->Wavelength;
  if (wavelength <= 0.0)
  {
    wavelength = std::max(bounds.GetSizeInPicture(0.02),
      this->WeightsOnly ? 0.0 : noise::SnapSize(PointsPerWavelength * spacing * std::sqrt(wanted)));
    wavelength = wavelength > 0.0 ? wavelength : 1.0;
  }
  this->ResolvedWavelength = wavelength;
  Wavelengths wavelengths{ wavelength, wavelength, wavelength };
  if (std::isfinite(lengths[0]))
  {
    wavelengths.Shortest = lengths[0];
    wavelengths.Longest = -lengths[1];
    wavelengths.Usual = std::clamp(wavelength, wavelengths.Shortest, wavelengths.Longest);
  }

  // Charts smaller than a wavelength leave no noise but seams.
  std::array<double, 3> charts = { 0.0, 0.0, 0.0 }; // their area, that of all, and their number
  attempt(
    [&]
    {
      for (Block& block : blocks)
      {
        if (this->Parameterization == AUTOMATIC && block.Texture && !ofImage)
        {
          KeptSurface& known = *block.Known;
          if (!known.Charts || known.ChartSide != wavelength)
          {
            known.Charts = getSurface(block).FindChartsBelow(wavelength);
            known.ChartSide = wavelength;
          }
          const SubbandSurface::Charts& small = *known.Charts;
          charts[0] += SurfaceSums::RoundArea(small.Area, diagonal);
          charts[1] += SurfaceSums::RoundArea(small.WholeArea, diagonal);
          charts[2] += small.Count;
        }
      }
    });
  agree(charts, &Agreement::Charts,
    [&] { Reduce(this->Controller, charts.data(), 3, vtkCommunicator::SUM_OP); });
  const bool shattered = charts[0] > 0.5 * charts[1];
  noise::SubbandSeams seams;
  if (blendSeams)
  {
    attempt(
      [&]
      {
        for (Block& block : blocks)
        {
          if (block.Texture && !shattered)
          {
            std::optional<noise::SubbandSeams>& known = block.Known->Seams;
            if (!known)
            {
              known.emplace();
              known->Add(getSurface(block));
            }
            seams.Add(*known);
          }
        }
      });
    agree(seams, &Agreement::Seams,
      [&]
      {
        seams.Gather(this->Controller);
        seams.Build();
      });
  }
  this->Cache->Last = std::move(agreed);
  if (!failure.empty())
  {
    return refuse(failure);
  }

  const double mapped = sums[SurfaceSums::RegularArea] + sums[SurfaceSums::FlippedArea];
  const bool mirrored = sums[SurfaceSums::FlippedArea] > 0.5 * mapped;
  const double foldedArea = sums[mirrored ? SurfaceSums::RegularArea : SurfaceSums::FlippedArea];
  const bool folds = foldedArea <= LargestFoldedShare * mapped;

  PointCounts counts;
  const std::string ownWeights = nameOf(WEIGHTS_ARRAY);
  const std::string factorsName = nameOf(FACTORS_ARRAY);
  double textureRepeats = 1.0;
  try
  {
    steerable::SubbandParameters pyramid;
    pyramid.Orientations = this->Orientations;
    pyramid.TileSize = this->TileSize;
    pyramid.Seed = static_cast<std::uint32_t>(this->Seed);
    Layout layouts[2] = { LayOnPlanes(pyramid, wavelengths, mostSteering),
      LayOnTexture(pyramid, sums, diagonal > 0.0 ? diagonal : 1.0, wavelengths, mostSteering) };
    if (imageTiles)
    {
      // It lies where texture coordinates say.
      layouts[1] = Layout();
      layouts[1].Pyramid = imageTiles->Parameters;
    }
    textureRepeats = layouts[1].Repeats;
    this->TextureRepeats = textureRepeats;
    this->PlaneRepeats = layouts[0].Repeats;
    steerable::SubbandTiles noTiles[2]; // of weights alone
    noTiles[0].Parameters = layouts[0].Pyramid;
    noTiles[1].Parameters = layouts[1].Pyramid;
    std::unique_ptr<steerable::SubbandWeights> solvers[2];
    const auto method = static_cast<steerable::WeightMethod>(this->Method);
    const bool wholeImage = ofImage && method == steerable::WeightMethod::None;
    for (std::size_t b = 0; b < blocks.size() && !this->GetAbortOutput(); ++b)
    {
      Block& block = blocks[b];
      if (shattered && block.Texture)
      {
        block.Texture = nullptr;
        block.Surface.reset();
      }
      const bool textured = block.Texture != nullptr;
      const steerable::TriangleMapping avoided = !folds ? steerable::TriangleMapping::Singular
        : mirrored                                      ? steerable::TriangleMapping::Regular
                                                        : steerable::TriangleMapping::Flipped;
      std::vector<Lookup> lookups;
      const auto addLookups = [&](bool ofTexture, int firstPlane)
      {
        const Layout& layout = layouts[ofTexture];
        if (!solvers[ofTexture])
        {
          steerable::SubbandWeightParameters parameters;
          parameters.Pyramid = layout.Pyramid;
          // All of an image needs no weights, but the best filter.
          parameters.Method = wholeImage ? steerable::WeightMethod::LeastSquares : method;
          parameters.FixedScale = layout.FixedScale;
          parameters.RadialTriple = this->RadialTriple;
          solvers[ofTexture] = std::make_unique<steerable::SubbandWeights>(parameters);
        }
        if (ofImage)
        {
          lookups.push_back({ &layout, solvers[ofTexture].get(), imageTiles });
          return;
        }
        if (this->WeightsOnly)
        {
          lookups.insert(lookups.end(), ofTexture ? 1 : 3,
            Lookup{ &layout, solvers[ofTexture].get(), &noTiles[ofTexture] });
          return;
        }
        TileCache& cache = ofTexture ? this->Cache->TextureTiles
          : firstPlane == 0          ? this->Cache->PlaneTiles
                                     : this->Cache->SeamTiles;
        for (const auto& tiles :
          cache.Update(layout.Pyramid, this->Phase, ofTexture ? 1 : 3, firstPlane))
        {
          lookups.push_back({ &layout, solvers[ofTexture].get(), &tiles });
        }
      };
      addLookups(textured, 0);
      if (textured && blendSeams)
      {
        addLookups(false, 1);
      }

      const vtkIdType points = block.Mesh->GetNumberOfPoints();
      Evaluator evaluator{ lookups, wavelength, anisotropy, this->Octaves, this->Persistence,
        this->Function == TURBULENCE, this->AntiAlias && !this->WeightsOnly, pyramid.Seed };
      evaluator.Seams = textured && blendSeams ? &seams : nullptr;
      evaluator.WholeImage = wholeImage;
      evaluator.Limited = !wholeImage && !(ofImage && !ownWeights.empty());
      vtkSmartPointer<vtkFloatArray> result;
      if (!this->WeightsOnly)
      {
        result = noise::NewOutputArray(this->ResultArrayName, 1, points);
        evaluator.Noise = result->GetPointer(0);
      }
      evaluator.WavelengthArray = block.Wavelengths;
      evaluator.AnisotropyArray = block.Anisotropies;
      evaluator.Scale = anisotropyScale;
      evaluator.Wanted = this->Anisotropy;
      vtkPointData* pointData = block.Mesh->GetPointData();
      const auto find = [&](const std::string& name, int components) -> vtkDataArray*
      {
        vtkDataArray* array = pointData->GetArray(name.c_str());
        return array && array->GetNumberOfComponents() == components &&
            array->GetNumberOfTuples() == points
          ? array
          : nullptr;
      };
      if (!ownWeights.empty())
      {
        const int needed = evaluator.GetFirstComponent(lookups.size());
        evaluator.OwnWeights = find(ownWeights, needed);
        if (!evaluator.OwnWeights)
        {
          throw std::invalid_argument("Weights '" + ownWeights + "' are not on the points with " +
            std::to_string(needed) + " components (" +
            std::to_string(lookups[0].Lay->Pyramid.Orientations) + " orientations, " +
            std::to_string(lookups[0].Lay->Pyramid.Scales) + " scales" +
            (lookups.size() > 3 ? ", and 3 planes with " +
                  std::to_string(lookups[1].Lay->Pyramid.Scales)
                : lookups.size() > 1 ? ", 3 planes"
                : imageTiles && imageTiles->Residuals > 0 ? ", residuals" : "") +
            "). OutputWeights adds such an array to begin with.");
        }
      }
      if (!factorsName.empty())
      {
        const int needed = this->Octaves * lookups[0].Lay->Pyramid.Orientations;
        evaluator.Factors = find(factorsName, needed);
        if (!evaluator.Factors)
        {
          throw std::invalid_argument("Factors '" + factorsName + "' are not on the points with " +
            std::to_string(needed) + " components, one for each octave and orientation.");
        }
      }
      if (this->OutputWeights || this->WeightsOnly)
      {
        auto array = noise::NewOutputArray(
          "SubbandWeights", evaluator.GetFirstComponent(lookups.size()), points);
        array->Fill(0.0);
        for (std::size_t l = 0; l < lookups.size(); ++l)
        {
          const bool onTexture = textured && l == 0;
          const steerable::SubbandParameters& bands = lookups[l].Lay->Pyramid;
          const int first = evaluator.GetFirstComponent(l);
          noise::NameSubbands(array, bands.Orientations, bands.Scales,
            onTexture ? std::string() : std::string(1, "xyz"[textured ? l - 1 : l]), first);
          if (lookups[l].Tiles->Residuals > 0)
          {
            noise::NameResiduals(array, bands.Orientations, first + bands.Components());
          }
        }
        evaluator.WeightArray = array->GetPointer(0);
        pointData->AddArray(array);
      }
      if (this->OutputDistortion)
      {
        auto array = noise::NewOutputArray("Distortion", 1, points);
        evaluator.Distortion = array->GetPointer(0);
        evaluator.NeedsDistortion = true;
        pointData->AddArray(array);
      }
      KeptSurface& known = *block.Known;
      PointsKey key = evaluator.GetKey(block, bounds.GetPlane(), static_cast<int>(avoided));
      const bool arePointsKnown = known.ArePointsKnown && known.Key == key;
      noise::SteeringVectors vectors;
      std::vector<float> scratch;
      std::unique_ptr<steerable::TupleReader<float>> reader;
      if (!arePointsKnown && block.Vectors)
      {
        const auto tuples = static_cast<std::size_t>(block.Vectors->GetNumberOfTuples());
        reader =
          noise::MakeVectorReader(block.Vectors, noise::WorldAxes, false, bounds.GetPlane());
        scratch.resize(3 * tuples);
        vectors.Values = reader->Read(0, tuples, scratch.data());
        vectors.Cells = block.CellVectors;
      }

      const auto chunks = static_cast<std::size_t>((points + ChunkSize - 1) / ChunkSize);
      known.ArePointsKnown = false; // until all of it is done
      if (!arePointsKnown)
      {
        known.ForgetPoints();
        known.Key = std::move(key);
        known.Chunks.resize(this->KeepFields ? chunks : 0);
        getSurface(block).Avoid(avoided);
      }
      vtkUnsignedCharArray* ghosts = block.Mesh->GetPointGhostArray();
      ghosts = ghosts && ghosts->GetNumberOfTuples() >= points ? ghosts : nullptr;
      const PointCounts found = noise::ForEachPart(this, chunks, points,
        static_cast<double>(b) / blocks.size(), 1.0 / blocks.size(),
        [&](std::size_t begin, std::size_t end)
        {
          return evaluator.Evaluate(
            block, vectors, ghosts, arePointsKnown, this->KeepFields ? &known.Chunks : nullptr, begin, end);
        });
      if (!arePointsKnown)
      {
        known.Counts = found;
      }
      known.ArePointsKnown = this->KeepFields && !this->GetAbortOutput();
      counts += known.Counts;
      if (result)
      {
        pointData->AddArray(result);
        pointData->SetActiveScalars(this->ResultArrayName);
      }
      block.Surface.reset();
    }
  }
  catch (const std::exception& error)
  {
    return refuse(error.what());
  }

  // One warning that says everything.
  std::ostringstream message;
  if (shattered)
  {
    message << "\nMost of the surface lies in charts of the texture that are smaller than a wavelength ("
            << charts[2] << " of them): planar projections took its place. Lower Wavelength, or set "
               "Parameterization to Texture Coordinates to have it all the same.";
  }
  if (!shattered && textureRepeats < 1.0 && local[SurfaceSums::TexturedBlocks] > 0.0)
  {
    message << "\nThe wavelength is long for the texture: a tile is spread over "
            << std::round(1.0 / textureRepeats)
            << " repeats of it, and its seams may show. Lower Wavelength or scale the texture "
               "coordinates down.";
  }
  const double triangles = local[SurfaceSums::Triangles];
  const double flipped =
    shattered ? 0.0 : local[mirrored ? SurfaceSums::Regular : SurfaceSums::Flipped];
  const double singular = shattered ? 0.0 : local[SurfaceSums::Singular];
  const double degenerate = local[SurfaceSums::Degenerate];
  if ((folds && flipped > 0.0) || singular > 0.0 || degenerate > 0.0)
  {
    message << "\nOf " << triangles << " triangles " << (folds ? flipped : 0.0)
            << " are folded over by the texture, " << singular << " have no area in it and "
            << degenerate << " none on the surface; they were left out.";
  }
  if (counts.Unmapped > 0)
  {
    message << "\n"
            << counts.Unmapped << " of " << counts.Points
            << " points have no triangle with an area and got 0.";
  }
  if (counts.Undirected > 0)
  {
    message << "\n"
            << counts.Undirected << " of " << counts.Points
            << " points have no direction in the surface (zero, NaN, infinite or normal to it) and "
               "got isotropic noise.";
  }
  if (counts.Clamped > 0)
  {
    message << "\nAt " << counts.Clamped << " of " << counts.Points
            << " points the texture is stretched beyond the tiles' scales: noise is up to "
            << std::round(10.0 * counts.Finer) / 10.0 << " times finer or "
            << std::round(10.0 * counts.Coarser) / 10.0
            << " times coarser than wanted. Raise TileSize, change Wavelength, or set "
               "Parameterization to Triplanar.";
  }
  if (local[SurfaceSums::OtherBlocks] > 0)
  {
    message << "\n"
            << local[SurfaceSums::OtherBlocks] << " block(s) are no surfaces (" << otherType
            << ") and were passed on without noise. Extract their surface first.";
  }
  if (composite && blocksWithout > 0)
  {
    message << "\n" << blocksWithout << " block(s) were passed on without noise. " << finder.Why;
  }
  if (asked > 1.005 * mostAnisotropy && !blocks.empty())
  {
    message << "\nAnisotropy is " << asked << ", but " << this->Orientations
            << " Orientations make features at most " << std::round(10.0 * mostAnisotropy) / 10.0
            << " times longer than wide: they are that. Lower Anisotropy"
            << (this->Orientations < 8 ? ", or raise Orientations." : ".");
  }
  // Octaves that are too fine fade with AntiAlias.
  const double thinnest = wavelengths.Shortest / std::sqrt(wanted) /
    (this->AntiAlias ? 1.0 : std::ldexp(1.0, this->Octaves - 1));
  if (!blocks.empty() && !this->WeightsOnly && !(ofImage && this->Method == NONE) && spacing > 0.0 &&
    thinnest < 0.999 * PointsPerWavelength * spacing)
  {
    message << "\nThe points are " << spacing << " apart: " << thinnest / spacing
            << " to a wavelength of " << thinnest << ", where " << PointsPerWavelength
            << " are wanted. Set Wavelength to at least "
            << wavelength * PointsPerWavelength * spacing / thinnest
            << ", or refine the mesh (Subdivide).";
  }
  if (!message.str().empty())
  {
    vtkWarningMacro(<< message.str().substr(1));
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Wavelength: " << this->Wavelength << "\n";
  os << indent << "ResolvedWavelength: " << this->ResolvedWavelength << "\n";
  os << indent << "Anisotropy: " << this->Anisotropy << "\n";
  os << indent << "Parameterization: " << this->Parameterization << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Orientations: " << this->Orientations << "\n";
  os << indent << "RadialTriple: " << this->RadialTriple << "\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Persistence: " << this->Persistence << "\n";
  os << indent << "Function: " << this->Function << "\n";
  os << indent << "AntiAlias: " << this->AntiAlias << "\n";
  os << indent << "WrapSeams: " << this->WrapSeams << "\n";
  os << indent << "BlendSeams: " << this->BlendSeams << "\n";
  os << indent << "TileSize: " << this->TileSize << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Phase: " << this->Phase << "\n";
  os << indent << "ResultArrayName: " << (this->ResultArrayName ? this->ResultArrayName : "(none)")
     << "\n";
  os << indent << "KeepFields: " << this->KeepFields << "\n";
  os << indent << "OutputWeights: " << this->OutputWeights << "\n";
  os << indent << "WeightsOnly: " << this->WeightsOnly << "\n";
  os << indent << "OutputDistortion: " << this->OutputDistortion << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
