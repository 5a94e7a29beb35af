// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The shader of vtkSteerableNoiseMapper (private): its options, its source and its uniforms.
 */
#ifndef NoiseShader_h
#define NoiseShader_h

#include "NoiseColor.h"
#include "NoiseParameters.h"

#include "vtkShader.h"
#include "vtkType.h"

#include <array>
#include <map>
#include <string>

class vtkActor;
class vtkRenderer;
class vtkShaderProgram;

namespace noise
{
/// Options of the mapper; those of the model are the kernel's own.
struct ShaderOptions
{
  steerable::NoiseParameters Model;
  bool Pixels = true;
  double FeaturePixels = 6.0;
  /// As set; 0: automatic. Model has the values in use.
  double FeatureSize = 0.0;
  double ReferenceMagnitude = 0.0;
  double MaskUpperThreshold = 0.0;
  double Phase = 0.0;
  bool Animate = false;
  double TimePeriod = 0.0;
  double Time = 0.0;
  bool VectorsPerCell = false;
};

/// What the source of the shader depends on; all else is uniforms.
struct ShaderVariant
{
  bool Tensors = false;
  bool PerCell = false;
  /// Noise is that of the vertices, interpolated: for vectors at points, where cells are as small as pixels.
  bool AtVertices = false;
};

/// Adds the noise to the templates of a polydata mapper, before it fills them.
void AddNoise(std::map<vtkShader::Type, vtkShader*>& shaders, const ShaderOptions& options,
  const ColorOptions& color, const ShaderVariant& variant);

inline bool operator==(const ShaderVariant& a, const ShaderVariant& b)
{
  return a.Tensors == b.Tensors && a.PerCell == b.PerCell && a.AtVertices == b.AtVertices;
}

/// World units for a unit of an actor's own.
double GetScale(vtkActor* actor);

/// Side of a pixel in world units at the place of the actor that is nearest to the eye.
double GetSmallestPixel(vtkRenderer* renderer, vtkActor* actor);

/// Uniforms that are the same for all blocks. Vertices are (place - `shift`) * `scale`.
void SetUniforms(vtkShaderProgram* program, const ShaderOptions& options, vtkRenderer* renderer,
  vtkActor* actor, const std::array<double, 3>& shift, const std::array<double, 3>& scale);
} // namespace noise

#endif
