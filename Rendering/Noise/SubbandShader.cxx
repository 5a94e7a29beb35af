// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SubbandShader.h"

#include "SubbandNoiseGlsl.h"

#include "SubbandAtlas.h"
#include "Subband/SubbandTiles.h"

#include "vtkShaderProgram.h"

#include <cmath>
#include <sstream>

namespace noise
{
namespace
{
constexpr double Pi = 3.14159265358979323846;

std::string VecOf(const std::array<double, 4>& values)
{
  std::ostringstream os;
  os << std::scientific << "vec4(" << values[0] << ", " << values[1] << ", " << values[2] << ", "
     << values[3] << ")";
  return os.str();
}

/**
 * A function that sums the layers of one set of tiles at `place`, with their weights as arguments. Where tiles are is
 * written into it: software OpenGL (llvmpipe) reads an array of uniforms for each fragment by itself.
 */
std::string DefineSum(const std::string& name, const SubbandVariant& variant, int scales, const float* tiles)
{
  const int groups = variant.Groups();
  std::ostringstream os;
  os << std::scientific << "float " << name << "(vec2 place, vec3 footprint";
  for (int layer = 0; layer < groups * scales; ++layer)
  {
    os << ", vec4 w" << layer;
  }
  os << ")\n{\n  place = fract(place);\n  float sum = 0.0;\n";
  if (variant.Fades)
  {
    // Of the coarsest scale: each finer one has the fourth power.
    const double omega =
      2.0 * Pi * steerable::SubbandParameters().BandCenter * variant.TileSize * std::ldexp(1.0, 1 - scales);
    for (int g = 0; g < groups; ++g)
    {
      std::array<double, 4> xx, xy, yy;
      for (int n = 0; n < 4; ++n)
      {
        const double theta = Pi * (4 * g + n) / variant.Orientations;
        const double factor = -0.25 * omega * omega;
        xx[n] = factor * std::cos(theta) * std::cos(theta);
        xy[n] = factor * std::sin(2.0 * theta);
        yy[n] = factor * std::sin(theta) * std::sin(theta);
      }
      os << "  vec4 t" << g << " = exp(footprint.x * " << VecOf(xx) << " + footprint.y * " << VecOf(xy)
         << " + footprint.z * " << VecOf(yy) << ");\n";
    }
  }
  for (int scale = scales - 1; scale >= 0; --scale)
  {
    const double range = variant.Bytes ? 2.0 * SubbandAtlas::RangeOf(variant, scale) : 1.0;
    for (int g = 0; g < groups; ++g)
    {
      const int layer = scale * groups + g;
      os << "  sum += " << range << " * dot(w" << layer;
      if (variant.Fades)
      {
        os << " * FadeOf(t" << g << ")";
      }
      const float* tile = tiles + 4 * layer;
      os << ", TileAt(" << VecOf({ tile[0], tile[1], tile[2], tile[3] }) << ", place));\n";
      if (variant.Fades && scale > 0)
      {
        os << "  t" << g << " *= t" << g << ";\n  t" << g << " *= t" << g << ";\n";
      }
    }
  }
  os << "  return sum;\n}\n";
  return os.str();
}

std::string GetDefines(const SubbandVariant& variant)
{
  std::ostringstream os;
  os << "#define NOISE_OCTAVES " << variant.Octaves << "\n" << (variant.Bytes ? "#define NOISE_BYTES\n" : "")
     << (variant.Cubic ? "#define NOISE_CUBIC\n" : "");
  return os.str();
}

std::string NameOfVector(int vector)
{
  return "noiseWeights" + std::to_string(vector);
}

/// The weights of each layer of `scales` scales from the one of number `first` on, as a fragment reads them.
std::vector<std::string> GetWeights(const SubbandVariant& variant, int first, int scales)
{
  std::vector<std::string> weights;
  for (int scale = first; scale < first + scales; ++scale)
  {
    for (int i = 0; i < variant.Orientations; ++i)
    {
      const int weight = scale * variant.Orientations + i;
      if (i % 4 == 0)
      {
        weights.emplace_back("vec4(");
      }
      weights.back() += NameOfVector(weight / 4) + "VSOutput." + "xyzw"[weight % 4];
      const bool last = i + 1 == variant.Orientations;
      for (int n = i + 1; last && n % 4 != 0; ++n)
      {
        weights.back() += ", 0.0";
      }
      weights.back() += last || i % 4 == 3 ? ")" : ", ";
    }
  }
  return weights;
}

/// Tiles that are looked up at one place.
struct TileSet
{
  std::string Sum; ///< Name of the function.
  int FirstScale;
  int Scales;
  std::string Place;
};

std::vector<TileSet> GetSets(const SubbandVariant& variant)
{
  std::vector<TileSet> sets;
  if (variant.TextureScales > 0)
  {
    sets.push_back({ "SumTexture", 0, variant.TextureScales, "noiseTextureVSOutput.xy" });
  }
  const char* const planes[3] = { "yz", "xz", "xy" };
  for (int axis = 0; axis < 3 && variant.PlaneScales > 0; ++axis)
  {
    sets.push_back({ std::string("SumPlane") + "XYZ"[axis], variant.TextureScales + axis * variant.PlaneScales,
      variant.PlaneScales, std::string("noisePlaceVSOutput.") + planes[axis] });
  }
  return sets;
}

/// What a fragment does.
std::string GetFragmentNoise(const SubbandVariant& variant)
{
  std::ostringstream os;
  os << "  bool noiseSteered = noiseTextureVSOutput.z > 0.0;\n  float noiseValue = 0.0;\n";
  const std::vector<TileSet> sets = GetSets(variant);
  for (std::size_t s = 0; s < sets.size(); ++s)
  {
    os << "  vec2 noisePlace" << s << " = " << sets[s].Place << ";\n  vec3 noiseFootprint" << s
       << " = FootprintOf(dFdx(noisePlace" << s << "), dFdy(noisePlace" << s << "));\n";
  }
  os << "  float noiseAmplitude = 1.0;\n  float noiseScale = 1.0;\n"
        "  for (int octave = 0; octave < NOISE_OCTAVES; ++octave)\n  {\n    float octaveNoise = 0.0;\n";
  for (std::size_t s = 0; s < sets.size(); ++s)
  {
    os << "    octaveNoise += " << sets[s].Sum << "(noiseScale * noisePlace" << s
       << " + noiseShift[octave], noiseScale * noiseScale * noiseFootprint" << s;
    for (const std::string& weights : GetWeights(variant, sets[s].FirstScale, sets[s].Scales))
    {
      os << ", " << weights;
    }
    os << ");\n";
  }
  os << "    noiseValue += noiseAmplitude * " << (variant.Turbulence ? "abs(octaveNoise)" : "octaveNoise")
     << ";\n    noiseAmplitude *= noisePersistence;\n    noiseScale *= 2.0;\n  }\n";
  return os.str();
}
} // namespace

void AddSubbandNoise(std::map<vtkShader::Type, vtkShader*>& shaders, const SubbandVariant& variant,
  const std::vector<float>& tiles, const ColorOptions& color)
{
  std::vector<Varying> varyings;
  std::ostringstream vertex;
  vertex << "  int noiseLine = gl_VertexID * " << variant.LineLength() << ";\n";
  const auto read = [&](const std::string& type, const std::string& name, const char* components)
  {
    vertex << "  " << type << " " << name << " = texelFetch(noiseVertices, noiseLine + " << varyings.size()
           << ")" << components << ";\n";
    varyings.push_back({ type, name });
  };
  for (int vector = 0; vector < variant.WeightVectors(); ++vector)
  {
    read("vec4", NameOfVector(vector), "");
  }
  read("vec3", "noiseTexture", ".xyz");
  if (variant.PlaneScales > 0)
  {
    read("vec3", "noisePlace", ".xyz");
  }
  AddVaryings(shaders, varyings, "uniform samplerBuffer noiseVertices;\n", vertex.str());

  std::string declarations = GetDefines(variant);
  declarations += "uniform vec2 noiseShift[NOISE_OCTAVES];\nuniform float noisePersistence;\n";
  declarations += SubbandNoiseGlsl;
  for (const TileSet& set : GetSets(variant))
  {
    declarations +=
      DefineSum(set.Sum, variant, set.Scales, tiles.data() + 4 * variant.Groups() * set.FirstScale);
  }
  AddColor(shaders[vtkShader::Fragment], color, declarations, GetFragmentNoise(variant));
}

void SetSubbandUniforms(vtkShaderProgram* program, const SubbandVariant& variant,
  double persistence, std::uint32_t seed)
{
  if (program->IsUniformUsed("noisePersistence"))
  {
    program->SetUniformf("noisePersistence", static_cast<float>(persistence));
  }
  if (program->IsUniformUsed("noiseTaps"))
  {
    program->SetUniformi("noiseTaps", 4);
  }
  if (program->IsUniformUsed("noiseShift"))
  {
    std::vector<float> shifts(2 * static_cast<std::size_t>(variant.Octaves), 0.0f);
    for (int octave = 1; octave < variant.Octaves; ++octave)
    {
      const std::array<double, 2> shift = steerable::TileOffset(static_cast<std::uint32_t>(octave), seed);
      shifts[2 * octave] = static_cast<float>(shift[0]);
      shifts[2 * octave + 1] = static_cast<float>(shift[1]);
    }
    program->SetUniform2fv(
      "noiseShift", variant.Octaves, reinterpret_cast<const float(*)[2]>(shifts.data()));
  }
}
} // namespace noise
