// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandTileCache.h"

#include "NoiseThreads.h"
#include "SubbandNames.h"

#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace noise
{
namespace
{
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
  vtkDataArray* center = image ? image->GetFieldData()->GetArray(BandCenterName) : nullptr;
  steerable::SubbandTiles tiles;
  steerable::SubbandParameters& pyramid = tiles.Parameters;
  require(array && center && CountSubbands(array, pyramid.Orientations, pyramid.Scales),
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
} // namespace

//------------------------------------------------------------------------------
const std::vector<steerable::SubbandTiles>& SubbandTileCache::Update(
  const steerable::SubbandParameters& pyramid, double phase, int planes, int first)
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
  std::vector<int> needed; // four for each plane, but those that do not count
  std::vector<double> weights;
  for (int n = 0; n < 4 * planes; ++n)
  {
    if (std::abs(loop[n % 4]) > 1e-9)
    {
      needed.push_back(steerable::LoopRealization(first + n / 4, n % 4));
      weights.push_back(loop[n % 4]);
    }
  }
  this->MakeRealizations(pyramid, needed);
  this->Planes.clear();
  const std::size_t each = planes > 0 ? needed.size() / planes : 0;
  for (std::size_t begin = 0; begin < needed.size(); begin += each)
  {
    std::vector<const steerable::SubbandTiles*> tiles;
    for (std::size_t n = begin; n < begin + each; ++n)
    {
      tiles.push_back(&this->Realizations.at(needed[n]));
    }
    this->Planes.push_back(steerable::BlendTiles(
      tiles, std::vector<double>(weights.begin(), weights.begin() + each)));
  }
  this->Phase = phase;
  return this->Planes;
}

//------------------------------------------------------------------------------
void SubbandTileCache::MakeRealizations(
  const steerable::SubbandParameters& pyramid, const std::vector<int>& needed)
{
  std::vector<int> missing;
  for (const int realization : needed)
  {
    if (this->Realizations.emplace(realization, steerable::SubbandTiles()).second)
    {
      missing.push_back(realization);
    }
  }
  WithThreads(
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
}

//------------------------------------------------------------------------------
const steerable::SubbandTiles& SubbandImageTiles::Update(vtkImageData* image)
{
  const vtkMTimeType time = image ? image->GetMTime() : 0;
  if (image != this->Image || time != this->Time || !image)
  {
    this->Image = nullptr;
    this->Tiles = ReadTiles(image);
    this->Image = image;
    this->Time = time;
  }
  return this->Tiles;
}
} // namespace noise
