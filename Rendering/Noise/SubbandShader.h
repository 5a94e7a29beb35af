// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The shader of vtkSubbandNoiseMapper (private): what it depends on, how the mapper lays out weights and tiles for it,
 * its source and its uniforms.
 */
#ifndef SubbandShader_h
#define SubbandShader_h

#include "NoiseColor.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

class vtkShaderProgram;

namespace noise
{
/**
 * What the source of the shader depends on. A vertex is a line of vec4: the weights as the filter has them, of the
 * texture's bands and of those of the planes along x, y and z; then (u, v, 1 or 0 where there is no noise, 0) and, with
 * planes, (x, y, z, 0) in tiles. Layers of tiles are counted by planes, scales, groups of four directions.
 */
struct SubbandVariant
{
  int Orientations = 8;
  int TextureScales = 0; ///< 0: nothing is looked up at texture coordinates.
  int PlaneScales = 0;   ///< 0: nor in planar projections.
  int TileSize = 256;
  int Octaves = 1;
  bool Turbulence = false;
  bool Fades = true;
  bool Cubic = false;
  bool Bytes = true;

  int Groups() const { return (this->Orientations + 3) / 4; }
  /// Of the texture and three planes.
  int Scales() const { return this->TextureScales + 3 * this->PlaneScales; }
  int Layers() const { return this->Groups() * this->Scales(); }
  int Weights() const { return this->Orientations * this->Scales(); }
  /// vec4 of a vertex, of its weights and in all.
  int WeightVectors() const { return (this->Weights() + 3) / 4; }
  int LineLength() const { return this->WeightVectors() + (this->PlaneScales > 0 ? 2 : 1); }

  bool operator==(const SubbandVariant& other) const { return this->Key() == other.Key(); }

private:
  std::array<int, 9> Key() const
  {
    return { this->Orientations, this->TextureScales, this->PlaneScales, this->TileSize, this->Octaves,
      this->Turbulence, this->Fades, this->Cubic, this->Bytes };
  }
};

/// What is left for four values to each fragment, of the components that OpenGL lets pass (GL_MAX_VARYING_COMPONENTS).
constexpr int MostLineLength(int components)
{
  return components / 4 - 4; // VTK: places, normals, colours, texture coordinates
}

/// Adds the noise to the templates of a polydata mapper, before it fills them. `tiles`: of SubbandAtlas.
void AddSubbandNoise(std::map<vtkShader::Type, vtkShader*>& shaders, const SubbandVariant& variant,
  const std::vector<float>& tiles, const ColorOptions& color);

void SetSubbandUniforms(vtkShaderProgram* program, const SubbandVariant& variant, double persistence,
  std::uint32_t seed);
} // namespace noise

#endif
