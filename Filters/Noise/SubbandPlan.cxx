// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandPlan.h"

#include "NoiseBlocks.h"
#include "NoiseGhosts.h"

#include "vtkCommunicator.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>

namespace noise
{
namespace
{
// More of the surface than this share is not folded over by the texture but mirrored charts.
constexpr double LargestFoldedShare = 0.1;

/// Typical distance of points, from sums that are the same on all ranks.
double GetSpacing(const SurfaceSums& sums, double diagonal)
{
  const double triangles = sums[SurfaceSums::Triangles];
  const double area = sums[SurfaceSums::Area] * std::ldexp(diagonal * diagonal, -40);
  if (!(triangles > 0.0) || !(area > 0.0))
  {
    return 0.0;
  }
  // A closed surface has two triangles for each point.
  return RoundToThreeDigits(std::sqrt(2.0 * area / triangles));
}
} // namespace

//------------------------------------------------------------------------------
const steerable::SubbandAnisotropy* SubbandTileSets::GetAnisotropy(
  int orientations, steerable::WeightMethod method)
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

//------------------------------------------------------------------------------
const steerable::SubbandWeights* SubbandTileSets::GetWeights(
  bool ofTexture, const steerable::SubbandWeightParameters& parameters)
{
  std::unique_ptr<steerable::SubbandWeights>& weights = this->Weights[ofTexture];
  if (!weights || KeyOf(weights->GetParameters()) != KeyOf(parameters))
  {
    weights = std::make_unique<steerable::SubbandWeights>(parameters);
  }
  return weights.get();
}

//------------------------------------------------------------------------------
SubbandSurface& SubbandPlan::GetSurface(SubbandBlock& block) const
{
  if (!block.Surface)
  {
    block.Surface = std::make_unique<SubbandSurface>(
      block.Mesh, block.Texture, this->Properties.WrapSeams, this->BlendsSeams());
  }
  return *block.Surface;
}

//------------------------------------------------------------------------------
void SubbandPlan::AgreeOnSurfaces(std::vector<SubbandBlock>& blocks)
{
  this->AddBounds(blocks);
  Attempt(this->Failure,
    [&]
    {
      for (SubbandBlock& block : blocks)
      {
        KeptSurface& known = *block.Known;
        if (!known.Sums || known.Diagonal != this->Diagonal)
        {
          known.Diagonal = this->Diagonal;
          known.Sums.emplace();
          this->GetSurface(block).AddTo(*known.Sums, this->Diagonal);
        }
        this->Own += *known.Sums;
        ++this->Own[block.Texture ? SurfaceSums::TexturedBlocks : SurfaceSums::ProjectedBlocks];
      }
    });
  this->Agreed.Sums = this->Own;
  this->Agree(&SubbandAgreement::Sums,
    [this](SurfaceSums& sums)
    {
      Reduce(
        this->Controller, sums.Values.data(), sums.Values.size(), vtkCommunicator::SUM_OP);
    });
  this->Spacing = GetSpacing(this->Agreed.Sums, this->Diagonal);
}

//------------------------------------------------------------------------------
void SubbandPlan::AddBounds(std::vector<SubbandBlock>& blocks)
{
  for (const SubbandBlock& block : blocks)
  {
    std::optional<CommonBounds>& known = block.Known->Bounds;
    if (!known)
    {
      known.emplace();
      known->Add(block.Mesh, HiddenSamples(block.Mesh));
    }
    this->Agreed.Bounds.Add(*known);
  }
  this->Agree(&SubbandAgreement::Bounds,
    [this](CommonBounds& bounds) { bounds.Reduce(this->Controller); });
  this->Diagonal = this->Agreed.Bounds.GetDiagonal();
}

//------------------------------------------------------------------------------
// Null where no name is given, or with a failure where there is no such array.
vtkDataArray* SubbandPlan::FindLengths(
  const SubbandBlock& block, const std::string& name, const char* property)
{
  if (name.empty())
  {
    return nullptr;
  }
  vtkDataArray* array = block.Mesh->GetPointData()->GetArray(name.c_str());
  if (array && array->GetNumberOfComponents() <= 3 &&
    array->GetNumberOfTuples() >= block.Mesh->GetNumberOfPoints())
  {
    return array;
  }
  this->Failure = "Array '" + name + "' for " + property +
    " is not on the points with 1 to 3 components. Choose another one, or None.";
  return nullptr;
}

//------------------------------------------------------------------------------
void SubbandPlan::AgreeOnLengths(std::vector<SubbandBlock>& blocks)
{
  const SubbandProperties& p = this->Properties;
  std::array<double, 3>& ends = this->Agreed.Lengths;
  for (SubbandBlock& block : blocks)
  {
    if (!this->Failure.empty())
    {
      break;
    }
    block.Wavelengths = this->FindLengths(block, p.WavelengthArray, "Wavelength");
    block.Anisotropies = this->FindLengths(block, p.AnisotropyArray, "Anisotropy");
    const vtkIdType points = block.Mesh->GetNumberOfPoints();
    for (vtkIdType i = 0; block.Wavelengths && i < points; ++i)
    {
      const double length = WavelengthAt(block.Wavelengths, i, 0.0);
      if (length > 0.0)
      {
        ends[0] = std::min(ends[0], length);
        ends[1] = std::min(ends[1], -length);
      }
    }
    for (vtkIdType i = 0; block.Anisotropies && i < points; ++i)
    {
      ends[2] = std::min(ends[2], -AnisotropyAt(block.Anisotropies, i, 1.0));
    }
  }
  this->Agree(&SubbandAgreement::Lengths,
    [this](std::array<double, 3>& lengths)
    { Reduce(this->Controller, lengths.data(), lengths.size(), vtkCommunicator::MIN_OP); });

  this->ResolveAnisotropy(-ends[2]);
  this->Wavelength = p.Wavelength;
  if (this->Wavelength <= 0.0)
  {
    // Points that only carry weights are no samples.
    const double fromPoints = p.WeightsOnly
      ? 0.0
      : SnapSize(PointsPerWavelength * this->Spacing * std::sqrt(this->WantedAnisotropy));
    this->Wavelength = std::max(this->Agreed.Bounds.GetSizeInPicture(0.02), fromPoints);
    this->Wavelength = this->Wavelength > 0.0 ? this->Wavelength : 1.0;
  }
  this->Wavelengths = { this->Wavelength, this->Wavelength, this->Wavelength };
  if (std::isfinite(ends[0]))
  {
    this->Wavelengths.Shortest = ends[0];
    this->Wavelengths.Longest = -ends[1];
    this->Wavelengths.Usual =
      std::clamp(this->Wavelength, this->Wavelengths.Shortest, this->Wavelengths.Longest);
  }
}

//------------------------------------------------------------------------------
// K directions make features rounder than the metric says: it has to say more. `largest`: of an array.
void SubbandPlan::ResolveAnisotropy(double largest)
{
  const SubbandProperties& p = this->Properties;
  const bool fromArray = !p.AnisotropyArray.empty();
  this->Anisotropy = this->IsSteered ? p.Anisotropy : 1.0;
  this->AskedAnisotropy = fromArray ? largest : this->Anisotropy;
  this->WantedAnisotropy = this->AskedAnisotropy;
  this->LargestSteering = this->AskedAnisotropy;
  if (this->IsSteered && p.Method != steerable::WeightMethod::None &&
    (p.Anisotropy > 1.0 || fromArray))
  {
    this->Scale = this->Tiles->GetAnisotropy(p.Orientations, p.Method);
    this->Anisotropy = this->Scale->GetSteering(p.Anisotropy);
    this->MostAnisotropy = this->Scale->GetMost();
    this->WantedAnisotropy = std::min(this->WantedAnisotropy, this->MostAnisotropy);
    this->LargestSteering =
      fromArray ? this->Scale->GetSteering(this->AskedAnisotropy) : this->Anisotropy;
  }
}

//------------------------------------------------------------------------------
void SubbandPlan::AgreeOnTexture(std::vector<SubbandBlock>& blocks)
{
  this->FindCharts(blocks);
  if (this->BlendsSeams())
  {
    this->FindSeams(blocks);
  }
  const SurfaceSums& sums = this->Agreed.Sums;
  const double mapped = sums[SurfaceSums::RegularArea] + sums[SurfaceSums::FlippedArea];
  this->IsMirrored = sums[SurfaceSums::FlippedArea] > 0.5 * mapped;
  const double folded =
    sums[this->IsMirrored ? SurfaceSums::RegularArea : SurfaceSums::FlippedArea];
  this->IsFolded = folded <= LargestFoldedShare * mapped;
  for (SubbandBlock& block : blocks)
  {
    if (this->IsShattered && block.Texture)
    {
      block.Texture = nullptr;
      block.Surface.reset();
    }
  }
}

//------------------------------------------------------------------------------
// Charts smaller than a wavelength leave no noise but seams.
void SubbandPlan::FindCharts(std::vector<SubbandBlock>& blocks)
{
  std::array<double, 3>& charts = this->Agreed.Charts;
  Attempt(this->Failure,
    [&]
    {
      for (SubbandBlock& block : blocks)
      {
        if (this->Properties.ChooseParameterization && block.Texture && !this->IsOfImage)
        {
          KeptSurface& known = *block.Known;
          if (!known.Charts || known.ChartSide != this->Wavelength)
          {
            known.Charts = this->GetSurface(block).FindChartsBelow(this->Wavelength);
            known.ChartSide = this->Wavelength;
          }
          charts[0] += SurfaceSums::RoundArea(known.Charts->Area, this->Diagonal);
          charts[1] += SurfaceSums::RoundArea(known.Charts->WholeArea, this->Diagonal);
          charts[2] += known.Charts->Count;
        }
      }
    });
  this->Agree(&SubbandAgreement::Charts,
    [this](std::array<double, 3>& all)
    { Reduce(this->Controller, all.data(), all.size(), vtkCommunicator::SUM_OP); });
  this->IsShattered = charts[0] > 0.5 * charts[1];
  this->SmallCharts = charts[2];
}

//------------------------------------------------------------------------------
void SubbandPlan::FindSeams(std::vector<SubbandBlock>& blocks)
{
  Attempt(this->Failure,
    [&]
    {
      for (SubbandBlock& block : blocks)
      {
        if (block.Texture && !this->IsShattered)
        {
          std::optional<SubbandSeams>& known = block.Known->Seams;
          if (!known)
          {
            known.emplace();
            known->Add(this->GetSurface(block));
          }
          this->Agreed.Seams.Add(*known);
        }
      }
    });
  this->Agree(&SubbandAgreement::Seams,
    [this](SubbandSeams& seams)
    {
      seams.Gather(this->Controller);
      seams.Build();
    });
}

//------------------------------------------------------------------------------
steerable::TriangleMapping SubbandPlan::GetAvoided() const
{
  using Mapping = steerable::TriangleMapping;
  return !this->IsFolded ? Mapping::Singular
    : this->IsMirrored   ? Mapping::Regular
                         : Mapping::Flipped;
}

//------------------------------------------------------------------------------
SubbandSurface& SubbandPlan::PrepareSurface(SubbandBlock& block) const
{
  SubbandSurface& surface = this->GetSurface(block);
  surface.Avoid(this->GetAvoided());
  return surface;
}

//------------------------------------------------------------------------------
void SubbandPlan::LayTiles()
{
  const SubbandProperties& p = this->Properties;
  steerable::SubbandParameters pyramid;
  pyramid.Orientations = p.Orientations;
  pyramid.TileSize = p.TileSize;
  pyramid.Seed = p.Seed;
  this->Layouts[0] = LayOnPlanes(pyramid, this->Wavelengths, this->LargestSteering);
  this->Layouts[1] = LayOnTexture(pyramid, this->Agreed.Sums, this->Diagonal > 0.0 ? this->Diagonal : 1.0,
    this->Wavelengths, this->LargestSteering);
  if (this->ImageTiles)
  {
    // It lies where texture coordinates say.
    this->Layouts[1] = SubbandLayout();
    this->Layouts[1].Pyramid = this->ImageTiles->Parameters;
  }
  for (const int ofTexture : { 0, 1 })
  {
    this->NoTiles[ofTexture].Parameters = this->Layouts[ofTexture].Pyramid;
  }
}

//------------------------------------------------------------------------------
void SubbandPlan::AddLookups(bool ofTexture, int firstPlane, std::vector<SubbandLookup>& lookups)
{
  const SubbandLayout& layout = this->Layouts[ofTexture];
  steerable::SubbandWeightParameters parameters;
  parameters.Pyramid = layout.Pyramid;
  // All of an image needs no weights, but the best filter.
  parameters.Method =
    this->IsWholeImage() ? steerable::WeightMethod::LeastSquares : this->Properties.Method;
  parameters.FixedScale = layout.FixedScale;
  parameters.RadialTriple = this->Properties.RadialTriple;
  const steerable::SubbandWeights* solver = this->Tiles->GetWeights(ofTexture, parameters);
  if (this->IsOfImage)
  {
    lookups.push_back({ &layout, solver, this->ImageTiles });
    return;
  }
  if (this->Properties.WeightsOnly)
  {
    lookups.insert(
      lookups.end(), ofTexture ? 1 : 3, { &layout, solver, &this->NoTiles[ofTexture] });
    return;
  }
  SubbandTileCache& cache = ofTexture ? this->Tiles->Texture
    : firstPlane == 0                 ? this->Tiles->Planes
                                      : this->Tiles->Seams;
  for (const steerable::SubbandTiles& tiles :
    cache.Update(layout.Pyramid, this->Properties.Phase, ofTexture ? 1 : 3, firstPlane))
  {
    lookups.push_back({ &layout, solver, &tiles });
  }
}

//------------------------------------------------------------------------------
SubbandPointWeights SubbandPlan::GetPointWeights(const SubbandBlock& block)
{
  SubbandPointWeights weights;
  const bool textured = block.Texture != nullptr;
  this->AddLookups(textured, 0, weights.Lookups);
  if (textured && this->BlendsSeams())
  {
    this->AddLookups(false, 1, weights.Lookups);
    weights.Seams = &this->Agreed.Seams;
  }
  weights.Wavelength = this->Wavelength;
  weights.Anisotropy = this->Anisotropy;
  weights.Octaves = this->Properties.Octaves;
  weights.AntiAlias = this->Properties.AntiAlias && !this->Properties.WeightsOnly;
  weights.WavelengthArray = block.Wavelengths;
  weights.AnisotropyArray = block.Anisotropies;
  weights.Scale = this->Scale;
  weights.Wanted = this->Properties.Anisotropy;
  weights.WholeImage = this->IsWholeImage();
  weights.Limited = !weights.WholeImage;
  return weights;
}

//------------------------------------------------------------------------------
SubbandPointsKey SubbandPlan::GetPointsKey(
  const SubbandBlock& block, const SubbandPointWeights& weights) const
{
  const Plane plane = this->Agreed.Bounds.GetPlane();
  SubbandPointsKey key;
  key.Arrays = { block.Texture, block.Vectors, block.Wavelengths, block.Anisotropies,
    weights.OwnWeights, weights.Factors };
  key.Values = weights.GetKey();
  key.Values.insert(key.Values.end(),
    { double(block.CellVectors), double(plane[0]), double(plane[1]),
      double(static_cast<int>(this->GetAvoided())) });
  if (weights.Seams)
  {
    key.Seams = weights.Seams->GetPlaces();
  }
  return key;
}
} // namespace noise
