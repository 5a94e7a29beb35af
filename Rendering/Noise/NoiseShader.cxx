// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseShader.h"

#include "LatticeHash.h"
#include "MetricTensor.h"
#include "SteerableNoiseGlsl.h"
#include "Surflet.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace noise
{
namespace
{
/// The lattices of the sizes that follow pixels differ by their seeds too.
constexpr std::uint32_t LevelSeed = 0x9E3779B9u;

void Define(std::ostream& os, const char* name, const std::uint32_t (&values)[3])
{
  os << "#define " << name << " uvec3(" << values[0] << "u, " << values[1] << "u, " << values[2]
     << "u)\n";
}

std::string GetDefines(const ShaderOptions& options, const ShaderVariant& variant)
{
  using namespace steerable;
  const NoiseParameters& model = options.Model;
  std::ostringstream os;
  Define(os, "HASH_AXIS", HashAxis);
  Define(os, "HASH_AXIS_FINAL", HashAxisFinal);
  os << "#define HASH_SEED " << HashSeed << "u\n#define HASH_JOIN " << HashJoin
     << "u\n#define HASH_AXIS_SHIFT " << HashAxisShift << "\n#define HASH_JOIN_SHIFT "
     << HashJoinShift << "\n#define LEVEL_SEED " << LevelSeed << "u\n#define NOISE_OCTAVES "
     << model.Octaves << "\n"
     << std::scientific << "#define VARIANCE_FLOOR " << VarianceFloor
     << "\n#define SURFACE_NORMAL_EIGENVALUE " << SurfaceNormalEigenvalue
     << "\n#define SMALLEST_IN_PLANE " << SmallestInPlane << "\n#define STREAK_END " << StreakEnd
     << "\n#define MOTION_AMPLITUDE " << std::setprecision(9) << MotionAmplitude << "\n";
  os << (variant.Tensors ? "#define NOISE_TENSORS\n" : "")
     << (variant.PerCell ? "#define NOISE_CELLS\n" : "")
     << (variant.AtVertices ? "#define NOISE_AT_VERTICES\n" : "")
     << (model.Basis == Basis::Streaks ? "#define NOISE_STREAKS\n" : "")
     << (model.Motion ? "#define NOISE_MOTION\n" : "") << (options.Pixels ? "#define NOISE_PIXELS\n" : "");
  return os.str();
}

/// What the vertices give to the fragments.
std::vector<Varying> GetVaryings(const ShaderVariant& variant)
{
  if (variant.AtVertices)
  {
    return { { "vec3", "noiseOfVertex" } };
  }
  std::vector<Varying> varyings = { { "vec3", "noisePlace" } };
  if (variant.Tensors && !variant.PerCell)
  {
    varyings.insert(varyings.end(), { { "vec3", "noiseSteering" }, { "vec3", "noiseSteering2" } });
  }
  else if (!variant.PerCell)
  {
    varyings.insert(varyings.end(),
      { { "vec3", "noiseSteering" }, { "vec3", "noiseNormal" }, { "vec3", "noiseBend" } });
  }
  return varyings;
}

/// Places and what steers them, from the vertices or from a buffer with a line for each primitive.
const char* const VertexDeclarations = R"(
uniform vec3 noiseVertexScale;
#ifndef NOISE_CELLS
in vec3 noiseSteering;
#ifdef NOISE_TENSORS
in vec3 noiseSteering2;
#else
in vec3 noiseNormal;
in vec3 noiseBend;
#endif
#endif
)";

const char* const VertexImplementation = R"(
  vec3 noisePlace = vertexMC.xyz * noiseVertexScale;
#ifdef NOISE_AT_VERTICES
  bool noiseSteered;
  float noiseValue = NoiseAt(
    noisePlace, noiseSteering, vec3(0.0), noiseBend, noiseNormal, gl_Position.w, noiseSteered);
  vec3 noiseOfVertex = vec3(noiseValue, noiseSteered ? 1.0 : 0.0, 0.0);
#endif
)";

const char* const FragmentDeclarations = R"(
#ifdef NOISE_CELLS
uniform samplerBuffer noiseCells;
uniform int noiseFirstPrimitive;
#endif
)";

const char* const FragmentNoise = R"(
#ifdef NOISE_AT_VERTICES
  float noiseValue = noiseOfVertexVSOutput.x;
  bool noiseSteered = noiseOfVertexVSOutput.y > 0.5;
#else
#ifdef NOISE_CELLS
  int noiseLine = 3 * (gl_PrimitiveID + noiseFirstPrimitive);
  vec3 noiseFirst = texelFetch(noiseCells, noiseLine).xyz;
  vec3 noiseSecond = texelFetch(noiseCells, noiseLine + 1).xyz;
  vec3 noiseThird = texelFetch(noiseCells, noiseLine + 2).xyz;
#elif defined(NOISE_TENSORS)
  vec3 noiseFirst = noiseSteeringVSOutput;
  vec3 noiseSecond = noiseSteering2VSOutput;
  vec3 noiseThird = vec3(0.0);
#else
  vec3 noiseFirst = noiseSteeringVSOutput;
  vec3 noiseSecond = noiseNormalVSOutput;
  vec3 noiseThird = noiseBendVSOutput;
#endif
  bool noiseSteered;
#ifdef NOISE_TENSORS
  float noiseValue = NoiseAt(noisePlaceVSOutput, noiseFirst, noiseSecond, vec3(0.0), vec3(0.0),
    1.0 / gl_FragCoord.w, noiseSteered);
#else
  float noiseValue = NoiseAt(noisePlaceVSOutput, noiseFirst, vec3(0.0), noiseThird, noiseSecond,
    1.0 / gl_FragCoord.w, noiseSteered);
#endif
#endif
)";

/// A place as a corner of cells of `size` and what is left, for one axis.
void SplitPlace(double place, double size, int& corner, float& rest)
{
  const double cells = std::floor(place / size);
  rest = static_cast<float>(place - cells * size);
  // The lattice wraps after 2^32 cells, as the filter's does.
  const double wrapped = cells - 4294967296.0 * std::floor(cells / 4294967296.0);
  corner = static_cast<int>(static_cast<std::uint32_t>(std::isfinite(wrapped) ? wrapped : 0.0));
}

/// Side of a pixel in world units; with a perspective camera: at a distance of 1 along its direction.
double GetPixelSize(vtkRenderer* renderer)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  const int* size = renderer->GetSize();
  if (camera->GetParallelProjection())
  {
    return 2.0 * camera->GetParallelScale() / std::max(size[1], 1);
  }
  const int across = std::max(size[camera->GetUseHorizontalViewAngle() ? 0 : 1], 1);
  return 2.0 * std::tan(0.5 * vtkMath::RadiansFromDegrees(camera->GetViewAngle())) / across;
}

void SetUniform3(vtkShaderProgram* program, const char* name, const double (&value)[3])
{
  if (program->IsUniformUsed(name))
  {
    program->SetUniform3f(name, value);
  }
}
} // namespace

void AddNoise(std::map<vtkShader::Type, vtkShader*>& shaders, const ShaderOptions& options,
  const ColorOptions& color, const ShaderVariant& variant)
{
  const std::string defines = GetDefines(options, variant);
  const std::string model = SteerableNoiseGlsl;
  AddVaryings(shaders, GetVaryings(variant),
    defines + VertexDeclarations + (variant.AtVertices ? model : ""), VertexImplementation,
    variant.PerCell ? "  gl_PrimitiveID = gl_PrimitiveIDIn;\n" : "");
  AddColor(shaders[vtkShader::Fragment], color,
    defines + FragmentDeclarations + (variant.AtVertices ? "" : model), FragmentNoise);
}

double GetScale(vtkActor* actor)
{
  vtkNew<vtkMatrix4x4> toWorld;
  actor->GetMatrix(toWorld);
  return std::cbrt(std::abs(toWorld->Determinant()));
}

double GetSmallestPixel(vtkRenderer* renderer, vtkActor* actor)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  const double pixel = GetPixelSize(renderer);
  if (camera->GetParallelProjection())
  {
    return pixel;
  }
  double bounds[6];
  actor->GetBounds(bounds);
  double nearest = 0.0; // along the direction of projection: of each side the nearer
  for (int axis = 0; axis < 3; ++axis)
  {
    const double along = camera->GetDirectionOfProjection()[axis];
    nearest += along * (bounds[2 * axis + (along < 0.0 ? 1 : 0)] - camera->GetPosition()[axis]);
  }
  return pixel * std::max(nearest, camera->GetClippingRange()[0]);
}

void SetUniforms(vtkShaderProgram* program, const ShaderOptions& options, vtkRenderer* renderer,
  vtkActor* actor, const std::array<double, 3>& shift, const std::array<double, 3>& scale)
{
  const steerable::NoiseParameters& model = options.Model;
  const auto setFloat = [&](const char* name, double value)
  {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformf(name, static_cast<float>(value));
    }
  };
  const auto setInt = [&](const char* name, int value)
  {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformi(name, value);
    }
  };

  // Where the eye is, from the vertices: they begin at `shift`, in the actor's own axes.
  vtkNew<vtkMatrix4x4> toWorld;
  actor->GetMatrix(toWorld);
  const double modelScale = GetScale(actor);
  vtkNew<vtkMatrix4x4> toModel;
  vtkMatrix4x4::Invert(toWorld, toModel);
  vtkCamera* camera = renderer->GetActiveCamera();
  const double* position = camera->GetPosition();
  const double eye[4] = { position[0], position[1], position[2], 1.0 };
  double inModel[4];
  toModel->MultiplyPoint(eye, inModel);
  const double fromShift[3] = { inModel[0] - shift[0], inModel[1] - shift[1],
    inModel[2] - shift[2] };
  SetUniform3(program, "noiseEye", fromShift);
  double view[3] = { 0.0, 0.0, 0.0 };
  if (camera->GetParallelProjection())
  {
    const double* direction = camera->GetDirectionOfProjection();
    const double toEye[4] = { -direction[0], -direction[1], -direction[2], 0.0 };
    toModel->MultiplyPoint(toEye, inModel);
    std::copy(inModel, inModel + 3, view);
    vtkMath::Normalize(view);
  }
  SetUniform3(program, "noiseView", view);
  setFloat("noisePixel", GetPixelSize(renderer) / (modelScale > 0.0 ? modelScale : 1.0));

  const double inverse[3] = { 1.0 / scale[0], 1.0 / scale[1], 1.0 / scale[2] };
  SetUniform3(program, "noiseVertexScale", inverse);

  // In PIXELS places are counted in cells of a power of 2 about as large as the farthest of them.
  int level = 0;
  double cell = model.FeatureSize;
  if (options.Pixels)
  {
    const double farthest = 1.0 / std::min({ scale[0], scale[1], scale[2] });
    level = std::isfinite(farthest) && farthest > 0.0 ? std::ilogb(farthest) + 1 : 0;
    cell = std::ldexp(1.0, level);
  }
  std::vector<int> origin(3 * static_cast<std::size_t>(model.Octaves));
  std::vector<float> rest(origin.size());
  double fineness = 1.0;
  for (int i = 0; i < model.Octaves; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      SplitPlace(shift[axis] * fineness, cell, origin[3 * i + axis], rest[3 * i + axis]);
    }
    fineness *= model.Lacunarity;
  }
  if (program->IsUniformUsed("noiseOrigin"))
  {
    program->SetUniform1iv("noiseOrigin", static_cast<int>(origin.size()), origin.data());
  }
  if (program->IsUniformUsed("noiseRest"))
  {
    program->SetUniform1fv("noiseRest", static_cast<int>(rest.size()), rest.data());
  }
  setInt("noiseOriginLevel", level);
  setFloat("noiseFeature", options.Pixels ? options.FeaturePixels : model.FeatureSize);

  setFloat("noiseAlong", model.GetAlongEigenvalue());
  setFloat("noiseEigenvalueSum", model.EigenvalueSum);
  setFloat("noiseStrength", model.Strength);
  setFloat("noiseReference",
    model.StrengthMode == steerable::StrengthMode::Magnitude ? model.ReferenceMagnitude : 0.0);
  setFloat("noiseMask", model.MaskThreshold);
  setFloat("noiseLacunarity", model.Lacunarity);
  setFloat("noiseGain", model.Gain);
  setFloat("noiseDensity", model.GetStreakProbability());
  setFloat("noisePhase", model.Phase - std::floor(model.Phase));
  setFloat("noiseSpeed", model.Speed);
  setFloat("noiseCurvature", model.FollowCurvature ? 1.0 : 0.0);
  setInt("noiseSeed", static_cast<int>(model.Seed));
}
} // namespace noise
