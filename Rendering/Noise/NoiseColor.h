// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From the noise of a fragment to its colour, the same for all mappers of noise (private): options, source and
 * uniforms.
 */
#ifndef NoiseColor_h
#define NoiseColor_h

#include "vtkShader.h"

#include <array>
#include <map>
#include <string>
#include <vector>

class vtkActor;
class vtkShaderProgram;

namespace noise
{
struct ColorOptions
{
  int ColorMode = 0;
  double Intensity = 0.8;
  double Contrast = 1.0;
  std::array<double, 3> MaskColor = { 0.5, 0.5, 0.5 };
  bool UseMaskColor = false;
  bool OutputValue = false;
};

/// Puts `text` after a tag of VTK's template, which stays.
void AddAfter(vtkShader* shader, const std::string& tag, const std::string& text);

/**
 * Adds to the template of a fragment shader: `declarations`; then, before lighting, `noise`, code that declares
 * `float noiseValue` and `bool noiseSteered` (false: no noise here); and what makes colours of them.
 */
void AddColor(vtkShader* fragment, const ColorOptions& options, const std::string& declarations,
  const std::string& noise);

struct Varying
{
  std::string Type;
  std::string Name;
};

/**
 * Has varyings pass from the vertices to the fragments, through the geometry shader too where there is one (of edges
 * and wide lines). `vertex` is code that declares a variable of each name; fragments read nameVSOutput. `geometry`:
 * what a geometry shader does besides.
 */
void AddVaryings(std::map<vtkShader::Type, vtkShader*>& shaders, const std::vector<Varying>& varyings,
  const std::string& declarations, const std::string& vertex, const std::string& geometry = {});

void SetColorUniforms(vtkShaderProgram* program, const ColorOptions& options, vtkActor* actor);
} // namespace noise

#endif
