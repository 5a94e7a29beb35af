// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandAtlas.h"

#include "Subband/SubbandTiles.h"

#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>

namespace noise
{
namespace
{
// Textures may be as wide as this everywhere.
constexpr int MostTexels = 8192;

int SizeOf(const SubbandVariant& variant, int scale)
{
  return variant.Cubic ? variant.TileSize : std::max(variant.TileSize >> scale, 16);
}

int BorderOf(const SubbandVariant& variant)
{
  return variant.Cubic ? 0 : 1;
}

bool Counts(double weight)
{
  return std::abs(weight) > 1e-9;
}

steerable::SubbandParameters PyramidOf(const SubbandVariant& variant, int scales)
{
  steerable::SubbandParameters pyramid;
  pyramid.Orientations = variant.Orientations;
  pyramid.Scales = scales;
  pyramid.TileSize = variant.TileSize;
  return pyramid;
}
} // namespace

double SubbandAtlas::RangeOf(const SubbandVariant& variant, int scale)
{
  const steerable::SubbandParameters pyramid = PyramidOf(variant, scale + 1);
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(variant.Orientations, scale + 1);
  band(0, scale) = 1.0;
  return 4.0 * std::sqrt(steerable::SubbandVariance(pyramid, band));
}

void SubbandAtlas::Lay()
{
  const SubbandVariant& variant = this->Variant;
  const int border = BorderOf(variant);
  this->Layout.clear();
  const auto add = [&](int scales, int plane)
  {
    for (int scale = 0; scale < scales; ++scale)
    {
      for (int group = 0; group < variant.Groups(); ++group)
      {
        this->Layout.push_back({ scale, group, plane, SizeOf(variant, scale) + 2 * border, 0, 0 });
      }
    }
  };
  add(variant.TextureScales, 0);
  for (int axis = 0; axis < 3; ++axis)
  {
    add(variant.PlaneScales, this->FirstPlane + axis);
  }
  // On shelves, the largest first.
  std::vector<Tile*> order;
  for (Tile& tile : this->Layout)
  {
    order.push_back(&tile);
  }
  std::stable_sort(order.begin(), order.end(), [](const Tile* a, const Tile* b) { return a->Side > b->Side; });
  const int largest = order.front()->Side;
  const auto ofLargest =
    std::count_if(order.begin(), order.end(), [=](const Tile* tile) { return tile->Side == largest; });
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(ofLargest))));
  this->Width = largest * std::clamp(columns, 1, std::max(1, MostTexels / largest));
  this->Height = 0;
  int x = 0;
  int shelf = 0;
  for (Tile* tile : order)
  {
    if (x + tile->Side > this->Width || shelf == 0)
    {
      this->Height += shelf;
      shelf = tile->Side;
      x = 0;
    }
    tile->X = x;
    tile->Y = this->Height;
    x += tile->Side;
  }
  this->Height += shelf;
  this->Tiles.clear();
  for (const Tile& tile : this->Layout)
  {
    const float size = static_cast<float>(tile.Side - 2 * border);
    const float w = static_cast<float>(this->Width);
    const float h = static_cast<float>(this->Height);
    if (variant.Cubic)
    {
      this->Tiles.insert(this->Tiles.end(), { float(tile.X), float(tile.Y), size, size });
    }
    else
    {
      this->Tiles.insert(this->Tiles.end(),
        { (tile.X + border + 0.5f) / w, (tile.Y + border + 0.5f) / h, size / w, size / h });
    }
  }
}

vtkIdType SubbandAtlas::GetBytes() const
{
  return 4 * static_cast<vtkIdType>(this->Width) * this->Height * (this->Variant.Bytes ? 1 : 4);
}

void SubbandAtlas::MakeScales(const std::array<double, 4>& weights)
{
  std::vector<std::pair<ScaleKey, std::vector<float>*>> missing;
  for (const Tile& tile : this->Layout)
  {
    for (int m = 0; m < 4; ++m)
    {
      const ScaleKey key = this->GetKey(tile, m);
      if (Counts(weights[m]) && !this->Made.count(key))
      {
        missing.emplace_back(key, &this->Made[key]);
      }
    }
  }
  vtkSMPTools::For(0, static_cast<vtkIdType>(missing.size()), 1,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType n = begin; n < end; ++n)
      {
        const auto [size, scale, realization] = missing[n].first;
        // A scale is the same in every pyramid that has it.
        steerable::SubbandParameters pyramid = PyramidOf(this->Variant, scale + 1);
        pyramid.Seed = this->Seed;
        pyramid.Realization = static_cast<std::uint32_t>(realization);
        *missing[n].second = steerable::MakeScaleTiles(pyramid, scale, size,
          this->Variant.Cubic ? steerable::TexelKind::Values : steerable::TexelKind::Bilinear);
      }
    });
}

SubbandAtlas::ScaleKey SubbandAtlas::GetKey(const Tile& tile, int m) const
{
  return { tile.Side - 2 * BorderOf(this->Variant), tile.Scale, steerable::LoopRealization(tile.Plane, m) };
}

void SubbandAtlas::Update(const SubbandVariant& variant, std::uint32_t seed, int firstPlane)
{
  const std::vector<double> madeKey = { double(variant.Orientations), double(variant.TileSize),
    double(seed), double(variant.Cubic) };
  std::vector<double> key = madeKey;
  key.insert(key.end(), { double(variant.TextureScales), double(variant.PlaneScales),
                          double(variant.Bytes), double(firstPlane) });
  if (key == this->Key)
  {
    return;
  }
  this->Key = key;
  if (madeKey != this->MadeKey)
  {
    this->Made.clear();
    this->MadeKey = madeKey;
  }
  this->Variant = variant;
  this->Seed = seed;
  this->FirstPlane = firstPlane;
  ++this->Version;
  this->Lay();
}

SubbandAtlas::Image SubbandAtlas::Make(const std::array<double, 4>& weights)
{
  const SubbandVariant& variant = this->Variant;
  const int border = BorderOf(variant);
  const int orientations = variant.Orientations;
  const std::size_t values = 4 * static_cast<std::size_t>(this->Width) * this->Height;
  Image image;
  image.Floats.assign(values, 0.0f);
  this->MakeScales(weights);
  for (const Tile& tile : this->Layout)
  {
    const int size = tile.Side - 2 * border;
    for (int m = 0; m < 4; ++m)
    {
      if (!Counts(weights[m]))
      {
        continue;
      }
      const std::vector<float>& made = this->Made.at(this->GetKey(tile, m));
      const auto weight = static_cast<float>(weights[m]);
      for (int y = 0; y < tile.Side; ++y)
      {
        const int fromY = (y - border + size) % size;
        float* texel = image.Floats.data() + 4 * (static_cast<std::size_t>(tile.Y + y) * this->Width + tile.X);
        for (int x = 0; x < tile.Side; ++x, texel += 4)
        {
          const float* from = made.data() +
            (static_cast<std::size_t>(fromY) * size + (x - border + size) % size) * orientations;
          for (int i = 4 * tile.Group; i < std::min(4 * tile.Group + 4, orientations); ++i)
          {
            texel[i - 4 * tile.Group] += weight * from[i];
          }
        }
      }
    }
  }
  if (!variant.Bytes)
  {
    return image;
  }
  image.Bytes.resize(values);
  for (const Tile& tile : this->Layout)
  {
    const auto range = static_cast<float>(RangeOf(variant, tile.Scale));
    for (int y = tile.Y; y < tile.Y + tile.Side; ++y)
    {
      const std::size_t first = 4 * (static_cast<std::size_t>(y) * this->Width + tile.X);
      for (std::size_t n = first; n < first + 4 * static_cast<std::size_t>(tile.Side); ++n)
      {
        image.Bytes[n] = static_cast<std::uint8_t>(
          std::clamp(127.5f * (image.Floats[n] / range + 1.0f) + 0.5f, 0.0f, 255.0f));
      }
    }
  }
  image.Floats = std::vector<float>();
  return image;
}
} // namespace noise
