// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseColor.h"

#include "NoiseColorGlsl.h"

#include "vtkActor.h"
#include "vtkProperty.h"
#include "vtkShaderProgram.h"

namespace noise
{
namespace
{
const char* const FragmentColor = R"(
  if (noiseSteered)
  {
    ambientColor = ColorOf(ambientColor, noiseValue, noiseWhite.x);
    diffuseColor = ColorOf(diffuseColor, noiseValue, noiseWhite.y);
    opacity = OpacityOf(opacity, noiseValue);
  }
  else if (noiseMaskColor.a > 0.0)
  {
    ambientColor = noiseWhite.x * noiseMaskColor.rgb;
    diffuseColor = noiseWhite.y * noiseMaskColor.rgb;
  }
)";

const char* const FragmentOutputValue = R"(
  gl_FragData[0] = vec4(noiseSteered ? ValueOf(noiseValue) : vec3(0.0), 1.0);
)";

std::string Declare(const std::vector<Varying>& varyings, const char* qualifier, const char* ending)
{
  std::string text;
  for (const Varying& varying : varyings)
  {
    text += std::string(qualifier) + " " + varying.Type + " " + varying.Name + ending + ";\n";
  }
  return text;
}
} // namespace

void AddAfter(vtkShader* shader, const std::string& tag, const std::string& text)
{
  std::string source = shader->GetSource();
  vtkShaderProgram::Substitute(source, tag, tag + "\n" + text, false);
  shader->SetSource(source);
}

void AddColor(vtkShader* fragment, const ColorOptions& options, const std::string& declarations,
  const std::string& noise)
{
  AddAfter(fragment, "//VTK::PositionVC::Dec",
    "#define NOISE_COLOR_MODE " + std::to_string(options.ColorMode) + "\n" + declarations + NoiseColorGlsl);
  AddAfter(fragment, "//VTK::Color::Impl", noise + FragmentColor);
  if (options.OutputValue)
  {
    AddAfter(fragment, "//VTK::Light::Impl", FragmentOutputValue);
  }
}

void AddVaryings(std::map<vtkShader::Type, vtkShader*>& shaders, const std::vector<Varying>& varyings,
  const std::string& declarations, const std::string& vertex, const std::string& geometry)
{
  std::string implementation = vertex;
  for (const Varying& varying : varyings)
  {
    implementation += "  " + varying.Name + "VSOutput = " + varying.Name + ";\n";
  }
  AddAfter(shaders[vtkShader::Vertex], "//VTK::PositionVC::Dec",
    declarations + Declare(varyings, "out", "VSOutput"));
  AddAfter(shaders[vtkShader::Vertex], "//VTK::PositionVC::Impl", implementation);
  AddAfter(shaders[vtkShader::Fragment], "//VTK::PositionVC::Dec", Declare(varyings, "in", "VSOutput"));
  if (shaders[vtkShader::Geometry]->GetSource().empty())
  {
    return;
  }
  // VTK renames what the fragments read from VSOutput to GSOutput where there is such a shader.
  std::string passed;
  for (const Varying& varying : varyings)
  {
    passed += "  " + varying.Name + "GSOutput = " + varying.Name + "VSOutput[i];\n";
  }
  AddAfter(shaders[vtkShader::Geometry], "//VTK::PositionVC::Dec",
    Declare(varyings, "in", "VSOutput[]") + Declare(varyings, "out", "GSOutput"));
  AddAfter(shaders[vtkShader::Geometry], "//VTK::PositionVC::Impl", passed + geometry);
}

void SetColorUniforms(vtkShaderProgram* program, const ColorOptions& options, vtkActor* actor)
{
  const auto setFloat = [&](const char* name, double value)
  {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformf(name, static_cast<float>(value));
    }
  };
  setFloat("noiseIntensity", options.Intensity);
  setFloat("noiseContrast", options.Contrast);
  if (program->IsUniformUsed("noiseMaskColor"))
  {
    const float color[4] = { static_cast<float>(options.MaskColor[0]),
      static_cast<float>(options.MaskColor[1]), static_cast<float>(options.MaskColor[2]),
      options.UseMaskColor ? 1.0f : 0.0f };
    program->SetUniform4f("noiseMaskColor", color);
  }
  const float white[2] = { static_cast<float>(actor->GetProperty()->GetAmbient()),
    static_cast<float>(actor->GetProperty()->GetDiffuse()) };
  if (program->IsUniformUsed("noiseWhite"))
  {
    program->SetUniform2f("noiseWhite", white);
  }
}
} // namespace noise
