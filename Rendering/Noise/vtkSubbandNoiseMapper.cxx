// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSubbandNoiseMapper.h"

#include "MapperOptions.h"
#include "NoiseHelper.h"
#include "SubbandAtlas.h"
#include "SubbandShader.h"
#include "SubbandTexture.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyDataSubbandNoise.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace
{
/// GL_MAX_VARYING_COMPONENTS and GL_MAX_TEXTURE_BUFFER_SIZE.
constexpr unsigned int MaxVaryingComponents = 0x8B4B;
constexpr unsigned int MaxTextureBufferSize = 0x8C2B;
/// Of a mapper: those that its vertices depend on.
constexpr int InputArrays = 4;
} // namespace

struct vtkSubbandNoiseMapper::Internals
{
  struct Block
  {
    vtkSmartPointer<vtkFloatArray> Weights;
    vtkSmartPointer<vtkDataArray> Texture; ///< Null: planar projections alone.
  };

  Internals();

  vtkNew<vtkPolyDataSubbandNoise> Filter;
  /// What the filter said while it executed.
  std::string Warnings;
  std::string Errors;

  noise::SubbandVariant Variant;
  double Persistence = 0.7;
  int Seed = 0;
  double Phase = 0.0;
  double TimePeriod = 0.0;
  double Time = 0.0;

  /// What the weights were found from.
  vtkMTimeType InputTime = 0;
  vtkMTimeType FilterTime = 0;
  vtkDataObject* Input = nullptr; // only compared
  std::map<vtkPolyData*, Block> Blocks;
  int FirstPlane = 0;
  /// Whole repeats that are left out of places on planes: tiles repeat, and floats keep their digits.
  std::array<double, 3> WholeRepeats = {};

  noise::SubbandAtlas Atlas;
  vtkTimeStamp TileUploadTime;
  vtkIdType TileBytes = 0;
  vtkIdType WeightBytes = 0;

  /// In the loop at the time of the picture, [0, 1).
  double GetPhase() const
  {
    const double phase = this->Phase + (this->TimePeriod > 0.0 ? this->Time / this->TimePeriod : 0.0);
    return phase - std::floor(phase);
  }

  void Update(vtkDataObject* input);
  /// Scales and kinds of lookups, from the names of the weights.
  void TakeBlock(vtkPolyData* data, vtkPolyData* weighted);
  /// Lines of the shader's vertices, `count` of them.
  void AppendLines(vtkPolyData* data, vtkIdType count, std::vector<float>& lines) const;
};

namespace
{
/// Scales that components are named by: o<i>s<j> of the texture, with x, y or z in front those of a plane.
int CountScales(vtkDataArray* weights, const std::string& plane, int orientations, int& first)
{
  int scales = 0;
  first = -1;
  for (int c = 0; c < weights->GetNumberOfComponents(); ++c)
  {
    const char* name = weights->GetComponentName(c);
    if (name && name == plane + "o0s" + std::to_string(scales))
    {
      first = scales == 0 ? c : first;
      ++scales;
      c += orientations - 1;
    }
  }
  return scales;
}

/// Those that weights depend on.
void CopyWeightOptions(vtkPolyDataSubbandNoise* from, vtkPolyDataSubbandNoise* to)
{
  to->SetWavelength(from->GetWavelength());
  to->SetAnisotropy(from->GetAnisotropy());
  to->SetParameterization(from->GetParameterization());
  to->SetMethod(from->GetMethod());
  to->SetOrientations(from->GetOrientations());
  to->SetWrapSeams(from->GetWrapSeams());
  to->SetBlendSeams(from->GetBlendSeams());
  to->SetTileSize(from->GetTileSize());
}

/// VTK's message without its file, line and class.
std::string MessageOf(void* text)
{
  std::string message = text ? static_cast<const char*>(text) : "";
  const std::size_t begin = message.find("): ");
  message = begin == std::string::npos ? message : message.substr(begin + 3);
  const std::size_t end = message.find_last_not_of("\n ");
  return end == std::string::npos ? std::string() : message.substr(0, end + 1);
}
} // namespace

vtkSubbandNoiseMapper::Internals::Internals()
{
  this->Filter->WeightsOnlyOn();
  this->Filter->SetTileSize(512);
  this->Filter->SetController(nullptr);
  this->Filter->KeepFieldsOff();
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(this);
  listener->SetCallback(
    [](vtkObject*, unsigned long event, void* self, void* text)
    {
      auto* internals = static_cast<Internals*>(self);
      (event == vtkCommand::ErrorEvent ? internals->Errors : internals->Warnings) += MessageOf(text);
    });
  this->Filter->AddObserver(vtkCommand::ErrorEvent, listener);
  this->Filter->AddObserver(vtkCommand::WarningEvent, listener);
}

void vtkSubbandNoiseMapper::Internals::TakeBlock(vtkPolyData* data, vtkPolyData* weighted)
{
  auto* weights = vtkFloatArray::SafeDownCast(
    weighted ? weighted->GetPointData()->GetArray("SubbandWeights") : nullptr);
  if (!weights || weights->GetNumberOfTuples() != data->GetNumberOfPoints())
  {
    return;
  }
  Block& block = this->Blocks[data];
  block.Weights = weights;
  int first = 0;
  const int textureScales = CountScales(weights, "", this->Variant.Orientations, first);
  const int planeScales = CountScales(weights, "x", this->Variant.Orientations, first);
  if (textureScales > 0)
  {
    block.Texture = data->GetPointData()->GetTCoords();
    this->FirstPlane = planeScales > 0 ? 1 : this->FirstPlane;
  }
  this->Variant.TextureScales = std::max(this->Variant.TextureScales, textureScales);
  this->Variant.PlaneScales = std::max(this->Variant.PlaneScales, planeScales);
}

void vtkSubbandNoiseMapper::Internals::Update(vtkDataObject* input)
{
  this->Blocks.clear();
  this->FirstPlane = 0;
  this->Variant.TextureScales = 0;
  this->Variant.PlaneScales = 0;
  this->Variant.Orientations = this->Filter->GetOrientations();
  this->Variant.TileSize = this->Filter->GetTileSize();
  this->Warnings.clear();
  this->Errors.clear();
  if (!input)
  {
    return;
  }
  this->Filter->SetInputDataObject(input);
  this->Filter->Modified();
  this->Filter->Update();
  vtkDataObject* output = this->Filter->GetOutputDataObject(0);
  std::map<vtkPolyData*, vtkPolyData*> pairs;
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(input))
  {
    auto* outputs = vtkCompositeDataSet::SafeDownCast(output);
    auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (iterator->InitTraversal(); outputs && !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
    {
      // An input that the filter refused has no block in its output to look for.
      auto* data = vtkPolyData::SafeDownCast(iterator->GetCurrentDataObject());
      if (data && this->Errors.empty())
      {
        this->TakeBlock(data, vtkPolyData::SafeDownCast(outputs->GetDataSet(iterator)));
      }
    }
  }
  else if (auto* data = vtkPolyData::SafeDownCast(input))
  {
    this->TakeBlock(data, vtkPolyData::SafeDownCast(output));
  }
  double bounds[6] = { 0.0, 0.0, 0.0, 0.0, 0.0, 0.0 };
  if (!this->Blocks.empty())
  {
    this->Blocks.begin()->first->GetBounds(bounds);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const double repeats = std::floor(bounds[2 * axis] * this->Filter->GetPlaneRepeats());
    this->WholeRepeats[axis] = std::isfinite(repeats) ? repeats : 0.0;
  }
  // The weights are all that is wanted of it.
  this->Filter->SetInputDataObject(nullptr);
  output->Initialize();
}

void vtkSubbandNoiseMapper::Internals::AppendLines(
  vtkPolyData* data, vtkIdType count, std::vector<float>& lines) const
{
  const noise::SubbandVariant& variant = this->Variant;
  const std::size_t length = 4 * static_cast<std::size_t>(variant.LineLength());
  const std::size_t begin = lines.size();
  lines.resize(begin + length * static_cast<std::size_t>(count), 0.0f);
  const auto found = this->Blocks.find(data);
  if (found == this->Blocks.end())
  {
    return;
  }
  const Block& block = found->second;
  // Where each component of the array goes to in a line.
  std::vector<std::pair<int, int>> places;
  const auto place = [&](const std::string& plane, int firstScale)
  {
    int first = 0;
    const int scales = CountScales(block.Weights, plane, variant.Orientations, first);
    for (int c = 0; c < scales * variant.Orientations; ++c)
    {
      places.emplace_back(first + c, firstScale * variant.Orientations + c);
    }
  };
  place("", 0);
  for (int axis = 0; axis < 3 && variant.PlaneScales > 0; ++axis)
  {
    place(std::string(1, "xyz"[axis]), variant.TextureScales + axis * variant.PlaneScales);
  }
  const vtkIdType points = std::min(count, block.Weights->GetNumberOfTuples());
  const int components = block.Weights->GetNumberOfComponents();
  const double textureRepeats = this->Filter->GetTextureRepeats();
  const double planeRepeats = this->Filter->GetPlaneRepeats();
  const int after = 4 * variant.WeightVectors();
  for (vtkIdType point = 0; point < points; ++point)
  {
    float* line = lines.data() + begin + length * static_cast<std::size_t>(point);
    const float* weights = block.Weights->GetPointer(point * components);
    bool weighted = false;
    for (const auto& from : places)
    {
      line[from.second] = weights[from.first];
      weighted = weighted || weights[from.first] != 0.0f;
    }
    for (int axis = 0; axis < 2 && block.Texture; ++axis)
    {
      const double value = textureRepeats * block.Texture->GetComponent(point, axis);
      line[after + axis] = std::isfinite(value) ? static_cast<float>(value) : 0.0f;
    }
    line[after + 2] = weighted ? 1.0f : 0.0f;
    double xyz[3];
    data->GetPoint(point, xyz);
    for (int axis = 0; axis < 3 && variant.PlaneScales > 0; ++axis)
    {
      const double value = xyz[axis] * planeRepeats - this->WholeRepeats[axis];
      line[after + 4 + axis] = std::isfinite(value) ? static_cast<float>(value) : 0.0f;
    }
  }
}

namespace
{
class vtkSubbandNoiseHelper : public vtkNoiseHelper
{
public:
  static vtkSubbandNoiseHelper* New();
  vtkTypeMacro(vtkSubbandNoiseHelper, vtkNoiseHelper);

  void ReleaseGraphicsResources(vtkWindow* window) override
  {
    this->Vertices->ReleaseGraphicsResources(window);
    this->VertexBuffer->ReleaseGraphicsResources();
    this->Tiles.Release(window);
    this->Superclass::ReleaseGraphicsResources(window);
  }

protected:
  vtkSubbandNoiseHelper() { this->VertexBuffer->SetType(vtkOpenGLBufferObject::TextureBuffer); }

  vtkSubbandNoiseMapper::Internals& GetInternals()
  {
    return static_cast<vtkSubbandNoiseMapper*>(this->GetMapper())->GetInternals();
  }

  void AddNoise(std::map<vtkShader::Type, vtkShader*>& shaders) override
  {
    const auto& internals = this->GetInternals();
    noise::AddSubbandNoise(shaders, internals.Variant, internals.Atlas.GetTiles(), this->GetDrawn().Color);
  }

  void SetNoiseUniforms(vtkShaderProgram* program, vtkRenderer*, vtkActor*, const std::array<double, 3>&,
    const std::array<double, 3>&) override
  {
    const auto& internals = this->GetInternals();
    noise::SetSubbandUniforms(program, internals.Variant, internals.Persistence,
      static_cast<std::uint32_t>(internals.Seed));
    if (program->IsUniformUsed("noiseVertices"))
    {
      program->SetUniformi("noiseVertices", this->Vertices->GetTextureUnit());
    }
    if (program->IsUniformUsed("noiseTiles"))
    {
      program->SetUniformi("noiseTiles", this->Tiles.GetTexture()->GetTextureUnit());
    }
  }

  void BeginVertices() override { this->Lines.clear(); }

  void AppendVertices(vtkPolyData* data, vtkIdType count, vtkActor*) override
  {
    this->GetInternals().AppendLines(data, count, this->Lines);
  }

  void EndVertices(vtkOpenGLRenderWindow* window) override
  {
    if (this->Lines.empty())
    {
      return;
    }
    this->Vertices->SetContext(window);
    this->VertexBuffer->Upload(this->Lines, vtkOpenGLBufferObject::TextureBuffer);
    this->Vertices->CreateTextureBuffer(
      static_cast<unsigned int>(this->Lines.size() / 4), 4, VTK_FLOAT, this->VertexBuffer);
    this->GetInternals().WeightBytes += static_cast<vtkIdType>(sizeof(float) * this->Lines.size());
    this->Lines = std::vector<float>();
  }

  void ActivateTextures(vtkOpenGLRenderWindow* window) override
  {
    auto& internals = this->GetInternals();
    if (!this->GetDrawn().AnyNoise)
    {
      return;
    }
    if (this->Tiles.Update(window, internals.Atlas, internals.Variant.Bytes, !internals.Variant.Cubic,
          internals.GetPhase()))
    {
      internals.TileUploadTime.Modified();
    }
    internals.TileBytes = this->Tiles.GetBytes();
    this->Vertices->Activate();
    this->Tiles.GetTexture()->Activate();
  }

  void DeactivateTextures() override
  {
    if (this->GetDrawn().AnyNoise)
    {
      this->Tiles.GetTexture()->Deactivate();
      this->Vertices->Deactivate();
    }
  }

private:
  vtkNew<vtkTextureObject> Vertices;
  vtkNew<vtkOpenGLBufferObject> VertexBuffer;
  noise::SubbandTexture Tiles;
  std::vector<float> Lines;
};
vtkStandardNewMacro(vtkSubbandNoiseHelper);
} // namespace

vtkStandardNewMacro(vtkSubbandNoiseMapper);

vtkSubbandNoiseMapper::vtkSubbandNoiseMapper()
  : Internal(new Internals)
{
}

vtkSubbandNoiseMapper::~vtkSubbandNoiseMapper() = default;

vtkNoiseHelper* vtkSubbandNoiseMapper::MakeHelper()
{
  return vtkSubbandNoiseHelper::New();
}

void vtkSubbandNoiseMapper::FindWeights(vtkRenderer* renderer)
{
  Internals& internals = *this->Internal;
  vtkDataObject* input = this->GetInputDataObject(0, 0);
  vtkMTimeType newest = input ? input->GetMTime() : 0;
  noise::ForEachPolyData(input, [&](vtkPolyData* data) { newest = std::max(newest, data->GetMTime()); });
  for (int i = 0; i < InputArrays; ++i)
  {
    vtkInformation* choice = this->GetInputArrayInformation(i);
    newest = std::max(newest, choice->GetMTime());
  }
  if (input == internals.Input && newest == internals.InputTime &&
    internals.Filter->GetMTime() == internals.FilterTime)
  {
    return;
  }
  for (int i = 0; i < InputArrays; ++i)
  {
    internals.Filter->SetInputArrayToProcess(i, this->GetInputArrayInformation(i));
  }
  const noise::SubbandVariant before = internals.Variant;
  internals.Update(input);
  int components = 0;
  int texels = 0;
  vtkOpenGLState* state =
    static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow())->GetState();
  state->vtkglGetIntegerv(MaxVaryingComponents, &components);
  state->vtkglGetIntegerv(MaxTextureBufferSize, &texels);
  // As many directions as the graphics card passes weights to fragments. What the filter has to say is of those that
  // were asked for.
  const int wanted = internals.Filter->GetOrientations();
  const std::string warnings = internals.Warnings;
  for (const int orientations : { 6, 4, 3 })
  {
    if (orientations < wanted && internals.Variant.LineLength() > noise::MostLineLength(components))
    {
      internals.Filter->SetOrientations(orientations);
      internals.Update(input);
    }
  }
  internals.Filter->SetOrientations(wanted);
  internals.Warnings = warnings;
  vtkIdType points = 0;
  for (const auto& block : internals.Blocks)
  {
    points += block.first->GetNumberOfPoints();
  }
  if (points * internals.Variant.LineLength() > texels)
  {
    internals.Errors += std::to_string(points) +
      " points have more weights than this graphics card takes: lower Orientations, or use the filter Subband Noise.";
    internals.Blocks.clear();
  }
  internals.Input = input;
  internals.InputTime = newest;
  internals.FilterTime = internals.Filter->GetMTime();
  internals.WeightBytes = 0;
  this->GetDrawn().AnyNoise = !internals.Blocks.empty();
  this->GetDrawn().FieldsTime.Modified();
  if (!(before == internals.Variant))
  {
    this->GetDrawn().VariantTime.Modified();
  }
  std::string message = internals.Errors;
  if (!internals.Errors.empty())
  {
    message += " Until then the surface shows its own colours.";
  }
  message += (message.empty() || internals.Warnings.empty() ? "" : "\n") + internals.Warnings;
  if (!message.empty())
  {
    vtkWarningMacro(<< message);
  }
}

void vtkSubbandNoiseMapper::Render(vtkRenderer* renderer, vtkActor* actor)
{
  if (!this->Static && this->GetInputAlgorithm())
  {
    this->GetInputAlgorithm()->Update();
  }
  this->FindWeights(renderer);
  Internals& internals = *this->Internal;
  if (this->GetDrawn().AnyNoise)
  {
    internals.Atlas.Update(
      internals.Variant, static_cast<std::uint32_t>(internals.Seed), internals.FirstPlane);
  }
  this->Superclass::Render(renderer, actor);
}

#define SUBBANDNOISE_WEIGHTS(name, type)                                                           \
  void vtkSubbandNoiseMapper::Set##name(type value)                                                \
  {                                                                                                \
    this->Internal->Filter->Set##name(value);                                                      \
  }                                                                                                \
  type vtkSubbandNoiseMapper::Get##name()                                                          \
  {                                                                                                \
    return this->Internal->Filter->Get##name();                                                    \
  }

SUBBANDNOISE_WEIGHTS(Wavelength, double)
SUBBANDNOISE_WEIGHTS(Anisotropy, double)
SUBBANDNOISE_WEIGHTS(Parameterization, int)
SUBBANDNOISE_WEIGHTS(Method, int)
SUBBANDNOISE_WEIGHTS(Orientations, int)
SUBBANDNOISE_WEIGHTS(WrapSeams, bool)
SUBBANDNOISE_WEIGHTS(BlendSeams, bool)
SUBBANDNOISE_WEIGHTS(TileSize, int)

#define SUBBANDNOISE_OPTION(name, type, member, value, AFTER)                                      \
  NOISE_OPTION(vtkSubbandNoiseMapper, name, type, this->Internal->member, value, AFTER)
#define VARIANT this->GetDrawn().VariantTime.Modified()

SUBBANDNOISE_OPTION(Octaves, int, Variant.Octaves, noise::Clamp(Octaves, 1, 8), VARIANT)
SUBBANDNOISE_OPTION(Persistence, double, Persistence, noise::Clamp(Persistence, 0.0, 1.0), )
SUBBANDNOISE_OPTION(
  Function, int, Variant.Turbulence, Function == vtkPolyDataSubbandNoise::TURBULENCE, VARIANT)
SUBBANDNOISE_OPTION(AntiAlias, bool, Variant.Fades, AntiAlias, VARIANT)
SUBBANDNOISE_OPTION(Seed, int, Seed, Seed, )
SUBBANDNOISE_OPTION(
  Phase, double, Phase, std::isfinite(Phase) ? Phase - std::floor(Phase) : 0.0, )
SUBBANDNOISE_OPTION(
  TimePeriod, double, TimePeriod, noise::Clamp(TimePeriod, 0.0, VTK_DOUBLE_MAX), )
SUBBANDNOISE_OPTION(Time, double, Time, noise::Clamp(Time, -VTK_DOUBLE_MAX, VTK_DOUBLE_MAX), )
SUBBANDNOISE_OPTION(Interpolation, int, Variant.Cubic, Interpolation == CUBIC, VARIANT)

void vtkSubbandNoiseMapper::SetFloatTiles(bool floats)
{
  if (this->Internal->Variant.Bytes == floats)
  {
    this->Internal->Variant.Bytes = !floats;
    VARIANT;
  }
}

bool vtkSubbandNoiseMapper::GetFloatTiles()
{
  return !this->Internal->Variant.Bytes;
}

double vtkSubbandNoiseMapper::GetResolvedWavelength()
{
  return this->Internal->Filter->GetResolvedWavelength();
}

void vtkSubbandNoiseMapper::ShareExtremes(
  vtkDataObject* data, vtkMultiProcessController* controller)
{
  vtkNew<vtkPolyDataSubbandNoise> all;
  CopyWeightOptions(this->Internal->Filter, all);
  all->WeightsOnlyOn();
  all->SetController(controller);
  for (int i = 0; i < InputArrays; ++i)
  {
    all->SetInputArrayToProcess(i, this->GetInputArrayInformation(i));
  }
  vtkNew<vtkPolyData> nothing;
  all->SetInputDataObject(data ? data : nothing);
  // What there is to say, the mapper's own filter says.
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  all->AddObserver(vtkCommand::ErrorEvent, silent);
  all->AddObserver(vtkCommand::WarningEvent, silent);
  all->Update();
  this->Internal->Filter->TakeAgreement(all);
}

void vtkSubbandNoiseMapper::ShareExtremes(vtkSubbandNoiseMapper* other)
{
  this->Internal->Filter->TakeAgreement(other->Internal->Filter);
}

int vtkSubbandNoiseMapper::GetOrientationsInUse()
{
  return this->Internal->Variant.Orientations;
}

vtkMTimeType vtkSubbandNoiseMapper::GetTileUploadTime()
{
  return this->Internal->TileUploadTime;
}

vtkIdType vtkSubbandNoiseMapper::GetTileBytes()
{
  return this->Internal->TileBytes;
}

vtkIdType vtkSubbandNoiseMapper::GetWeightBytes()
{
  return this->Internal->WeightBytes;
}

void vtkSubbandNoiseMapper::SetOptionsFrom(vtkPolyDataSubbandNoise* filter)
{
  CopyWeightOptions(filter, this->Internal->Filter);
  this->SetOctaves(filter->GetOctaves());
  this->SetPersistence(filter->GetPersistence());
  this->SetFunction(filter->GetFunction());
  this->SetAntiAlias(filter->GetAntiAlias());
  this->SetSeed(filter->GetSeed());
  this->SetPhase(filter->GetPhase());
  for (int i = 0; i < InputArrays; ++i)
  {
    this->SetInputArrayToProcess(i, filter->GetInputArrayInformation(i));
  }
}

void vtkSubbandNoiseMapper::ShallowCopy(vtkAbstractMapper* mapper)
{
  if (auto* other = vtkSubbandNoiseMapper::SafeDownCast(mapper))
  {
    this->SetOptionsFrom(other->Internal->Filter);
    Internals& internals = *this->Internal;
    const Internals& from = *other->Internal;
    internals.Variant = from.Variant;
    internals.Persistence = from.Persistence;
    internals.Seed = from.Seed;
    internals.Phase = from.Phase;
    internals.TimePeriod = from.TimePeriod;
    internals.Time = from.Time;
    internals.InputTime = 0;
    VARIANT;
  }
  this->Superclass::ShallowCopy(mapper);
}

void vtkSubbandNoiseMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Wavelength: " << this->GetWavelength() << "\n"
     << indent << "Anisotropy: " << this->GetAnisotropy() << "\n"
     << indent << "Parameterization: " << this->GetParameterization() << "\n"
     << indent << "Method: " << this->GetMethod() << "\n"
     << indent << "Orientations: " << this->GetOrientations() << "\n"
     << indent << "WrapSeams: " << this->GetWrapSeams() << "\n"
     << indent << "BlendSeams: " << this->GetBlendSeams() << "\n"
     << indent << "TileSize: " << this->GetTileSize() << "\n"
     << indent << "Octaves: " << this->GetOctaves() << "\n"
     << indent << "Persistence: " << this->GetPersistence() << "\n"
     << indent << "Function: " << this->GetFunction() << "\n"
     << indent << "AntiAlias: " << this->GetAntiAlias() << "\n"
     << indent << "Seed: " << this->GetSeed() << "\n"
     << indent << "Phase: " << this->GetPhase() << "\n"
     << indent << "TimePeriod: " << this->GetTimePeriod() << "\n"
     << indent << "Interpolation: " << this->GetInterpolation() << "\n"
     << indent << "FloatTiles: " << this->GetFloatTiles() << "\n";
}
