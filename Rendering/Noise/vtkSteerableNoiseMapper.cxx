// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteerableNoiseMapper.h"

#include "MapperOptions.h"
#include "NoiseHelper.h"
#include "NoiseLengths.h"
#include "NoiseShader.h"
#include "SurfaceFields.h"

#include "vtkActor.h"
#include "vtkAlgorithm.h"
#include "vtkBoundingBox.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkHardwareSelector.h" // vtkCompositeMapperHelper2.h wants it first
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLBufferObject.h"
#include "vtkOpenGLCellToVTKCellMap.h"
#include "vtkOpenGLHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLVertexBufferObject.h"
#include "vtkOpenGLVertexBufferObjectGroup.h"
#include "vtkPolyData.h"
#include "vtkPoints.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkShader.h"
#include "vtkShaderProgram.h"
#include "vtkSmartPointer.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkTextureObject.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

/// Options, and what was found in the input.
struct vtkSteerableNoiseMapper::Internals
{
  struct Block
  {
    noise::SurfaceFields Fields;
    bool PerCell = false;
    vtkMTimeType Time = 0;
    double Limit = 0.0;
  };

  /// What automatic values come from.
  struct Extremes
  {
    vtkBoundingBox Bounds;
    noise::LengthRange Lengths;
  };

  explicit Internals(DrawnState& drawn)
    : Drawn(drawn)
  {
  }

  DrawnState& Drawn;
  noise::ShaderOptions Options;
  noise::ShaderVariant Variant;
  vtkTimeStamp ChosenTime;
  std::map<vtkPolyData*, Block> Blocks;
  Extremes Own;
  vtkMTimeType OwnTime = 0;
  /// Over all ranks, where there are several.
  Extremes Shared;
  bool AreShared = false;
  /// Input and choice of the last warning that there is no array.
  vtkMTimeType WarningTime = 0;

  const Block* Find(vtkPolyData* data) const
  {
    const auto found = this->Blocks.find(data);
    return found != this->Blocks.end() && found->second.Fields.Steering ? &found->second : nullptr;
  }

  /// Of `input`, and what the other ranks of a controller have.
  Extremes FindExtremes(
    vtkDataObject* input, vtkInformation* choice, vtkMultiProcessController* controller) const;

  const Extremes& GetExtremes() const { return this->AreShared ? this->Shared : this->Own; }

  /// The kernel's parameters with automatic values filled in.
  void Resolve()
  {
    steerable::NoiseParameters& model = this->Options.Model;
    const vtkBoundingBox& box = this->GetExtremes().Bounds;
    double bounds[6];
    box.GetBounds(bounds);
    const double longest = this->GetExtremes().Lengths.Longest;
    model.FeatureSize = this->Options.FeatureSize > 0.0 ? this->Options.FeatureSize
      : box.IsValid()                                   ? noise::GetAutomaticFeatureSize(bounds)
                                                        : 1.0;
    model.ReferenceMagnitude = this->Options.ReferenceMagnitude > 0.0
      ? this->Options.ReferenceMagnitude
      : std::max(longest, 1e-300);
    const double period = this->Options.TimePeriod;
    model.Phase = this->Options.Phase + (period > 0.0 ? this->Options.Time / period : 0.0);
  }

  void SetVariant(const noise::ShaderVariant& variant)
  {
    if (!(variant == this->Variant))
    {
      this->Variant = variant;
      this->Drawn.VariantTime.Modified();
    }
  }

  /// Decides on where this view's noise is evaluated.
  void ChooseStage(vtkRenderer* renderer, vtkActor* actor);

  /// After a change of what the source depends on.
  void SetMotion()
  {
    const bool motion =
      this->Options.Animate || this->Options.Phase != 0.0 || this->Options.TimePeriod > 0.0;
    if (motion != this->Options.Model.Motion)
    {
      this->Options.Model.Motion = motion;
      this->Drawn.VariantTime.Modified();
    }
  }
};

namespace
{
class vtkSteerableNoiseHelper : public vtkNoiseHelper
{
public:
  static vtkSteerableNoiseHelper* New();
  vtkTypeMacro(vtkSteerableNoiseHelper, vtkNoiseHelper);

  void ReleaseGraphicsResources(vtkWindow* window) override
  {
    if (this->CellTexture)
    {
      this->CellTexture->ReleaseGraphicsResources(window);
      this->CellBuffer->ReleaseGraphicsResources();
    }
    this->Superclass::ReleaseGraphicsResources(window);
  }

protected:
  vtkSteerableNoiseMapper::Internals& GetInternals()
  {
    return static_cast<vtkSteerableNoiseMapper*>(this->GetMapper())->GetInternals();
  }

  void AddNoise(std::map<vtkShader::Type, vtkShader*>& shaders) override
  {
    noise::AddNoise(
      shaders, this->GetInternals().Options, this->GetDrawn().Color, this->GetInternals().Variant);
  }

  void SetNoiseUniforms(vtkShaderProgram* program, vtkRenderer* renderer, vtkActor* actor,
    const std::array<double, 3>& shift, const std::array<double, 3>& scale) override
  {
    if (!program->IsUniformUsed("noiseVertexScale"))
    {
      return;
    }
    noise::SetUniforms(program, this->GetInternals().Options, renderer, actor, shift, scale);
    if (this->CellTexture && program->IsUniformUsed("noiseCells"))
    {
      program->SetUniformi("noiseCells", this->CellTexture->GetTextureUnit());
    }
  }

  void SetBlockUniforms(vtkShaderProgram* program, vtkPolyData* data, size_t firstPrimitive) override
  {
    const auto* found = this->GetInternals().Find(data);
    if (program->IsUniformUsed("noiseLongest"))
    {
      program->SetUniformf(
        "noiseLongest", found ? static_cast<float>(found->Fields.Longest) : 1.0f);
    }
    if (program->IsUniformUsed("noiseFirstPrimitive"))
    {
      program->SetUniformi("noiseFirstPrimitive", static_cast<int>(firstPrimitive));
    }
  }

  void ActivateTextures(vtkOpenGLRenderWindow*) override
  {
    if (this->CellTexture && this->GetInternals().Variant.PerCell)
    {
      this->CellTexture->Activate();
    }
  }

  void DeactivateTextures() override
  {
    if (this->CellTexture && this->GetInternals().Variant.PerCell)
    {
      this->CellTexture->Deactivate();
    }
  }

  void BeginVertices() override { this->CellLines.clear(); }

  void EndVertices(vtkOpenGLRenderWindow* window) override
  {
    if (!this->CellLines.empty())
    {
      if (!this->CellTexture)
      {
        this->CellTexture = vtkSmartPointer<vtkTextureObject>::New();
        this->CellBuffer = vtkSmartPointer<vtkOpenGLBufferObject>::New();
        this->CellBuffer->SetType(vtkOpenGLBufferObject::TextureBuffer);
      }
      this->CellTexture->SetContext(window);
      this->CellBuffer->Upload(this->CellLines, vtkOpenGLBufferObject::TextureBuffer);
      this->CellTexture->CreateTextureBuffer(static_cast<unsigned int>(this->CellLines.size() / 4),
        4, VTK_FLOAT, this->CellBuffer);
      this->CellLines = std::vector<float>();
    }
  }

  void AppendVertices(vtkPolyData* data, vtkIdType count, vtkActor* actor) override
  {
    const auto& internals = this->GetInternals();
    const auto* found = internals.Find(data);
    if (internals.Variant.PerCell)
    {
      this->AppendCells(data, found, actor);
      return;
    }
    const noise::SurfaceFields fields = found ? found->Fields : noise::SurfaceFields();
    if (internals.Variant.Tensors)
    {
      this->AppendAttribute("noiseSteering", fields.Steering, 0, count);
      this->AppendAttribute("noiseSteering2", fields.Steering, 3, count);
    }
    else
    {
      this->AppendAttribute("noiseSteering", fields.Steering, 0, count);
      this->AppendAttribute("noiseNormal", fields.Normals, 0, count);
      this->AppendAttribute("noiseBend", fields.Curvature, 0, count);
    }
  }

private:
  /// Three components from `component` on; zeros where a block has none, so that vertices stay in step.
  void AppendAttribute(const char* name, vtkFloatArray* array, int component, vtkIdType count)
  {
    vtkSmartPointer<vtkFloatArray> three = array;
    if (!array || array->GetNumberOfComponents() != 3 || array->GetNumberOfTuples() != count)
    {
      three = vtkSmartPointer<vtkFloatArray>::New();
      three->SetNumberOfComponents(3);
      three->SetNumberOfTuples(count);
      std::fill_n(three->GetPointer(0), 3 * count, 0.0f);
      for (vtkIdType i = 0; array && i < std::min(count, array->GetNumberOfTuples()); ++i)
      {
        const float* tuple =
          array->GetPointer(array->GetNumberOfComponents() * i) + component;
        std::copy_n(tuple, 3, three->GetPointer(3 * i));
      }
    }
    this->VBOs->AppendDataArray(name, three, VTK_FLOAT);
  }

  /// Three texels for each primitive: what steers it, then normal and curvature or the rest of a tensor.
  void AppendCells(vtkPolyData* data,
    const vtkSteerableNoiseMapper::Internals::Block* found, vtkActor* actor)
  {
    vtkCellArray* cells[4] = { data->GetVerts(), data->GetLines(), data->GetPolys(),
      data->GetStrips() };
    // The block's own map may know how many primitives there are, but not whose they are.
    vtkNew<vtkOpenGLCellToVTKCellMap> map;
    map->Update(cells, actor->GetProperty()->GetRepresentation(), data->GetPoints());
    const auto append = [this](vtkFloatArray* array, vtkIdType cell, int component)
    {
      for (int c = 0; c < 4; ++c)
      {
        this->CellLines.push_back(array && c < 3
            ? array->GetValue(array->GetNumberOfComponents() * cell + component + c)
            : 0.0f);
      }
    };
    for (std::size_t i = 0; i < static_cast<std::size_t>(map->GetSize()); ++i)
    {
      const vtkIdType cell = map->GetValue(i);
      const noise::SurfaceFields fields =
        found && found->PerCell ? found->Fields : noise::SurfaceFields();
      const bool tensors = fields.Steering && fields.Steering->GetNumberOfComponents() == 6;
      append(fields.Steering, cell, 0);
      append(tensors ? fields.Steering : fields.Normals, cell, tensors ? 3 : 0);
      append(fields.Curvature, cell, 0);
    }
  }

  vtkSmartPointer<vtkTextureObject> CellTexture;
  vtkSmartPointer<vtkOpenGLBufferObject> CellBuffer;
  std::vector<float> CellLines;
};
vtkStandardNewMacro(vtkSteerableNoiseHelper);
} // namespace

vtkStandardNewMacro(vtkSteerableNoiseMapper);

vtkSteerableNoiseMapper::vtkSteerableNoiseMapper()
  : Internal(new Internals(this->GetDrawn()))
{
}

vtkSteerableNoiseMapper::~vtkSteerableNoiseMapper() = default;

vtkNoiseHelper* vtkSteerableNoiseMapper::MakeHelper()
{
  return vtkSteerableNoiseHelper::New();
}

void vtkSteerableNoiseMapper::FindFields()
{
  Internals& internals = *this->Internal;
  vtkDataObject* input = this->GetInputDataObject(0, 0);
  std::map<vtkPolyData*, Internals::Block> blocks;
  noise::ShaderVariant variant;
  internals.Drawn.AnyNoise = false;
  bool changed = false;
  const vtkMTimeType chosen = std::max(
    this->GetInputArrayInformation(0)->GetMTime(), internals.ChosenTime.GetMTime());
  // Of the composite too: a block may have gone.
  vtkMTimeType newest = std::max(input ? input->GetMTime() : 0, chosen);
  noise::ForEachPolyData(input, [&](vtkPolyData* data) { newest = std::max(newest, data->GetMTime()); });
  if (newest != internals.OwnTime)
  {
    internals.OwnTime = newest;
    internals.Own = internals.FindExtremes(input, this->GetInputArrayInformation(0), nullptr);
    if (internals.Own.Lengths.Fills > 0.0)
    {
      vtkWarningMacro(<< internals.Own.Lengths.Fills << " vectors are far longer than all others (up to "
                      << internals.Own.Lengths.Limit << "), as values are that stand for missing ones: they "
                      << "show no noise. MaskUpperThreshold sets the limit by hand; 1e300 takes all of them.");
    }
  }
  const double limit = internals.GetExtremes().Lengths.Limit;
  std::string why;
  noise::ForEachPolyData(input,
    [&](vtkPolyData* data)
    {
      if (data->GetNumberOfPoints() == 0)
      {
        return;
      }
      bool cells = false;
      std::string whyNot;
      vtkDataArray* array =
        noise::FindSteeringArray(data, this->GetInputArrayInformation(0), cells, whyNot);
      if (!array)
      {
        why = whyNot;
        return;
      }
      const bool perCell = cells && internals.Options.VectorsPerCell;
      const bool tensors = array->GetNumberOfComponents() > 3;
      if (internals.Drawn.AnyNoise && (tensors != variant.Tensors || perCell != variant.PerCell))
      {
        return; // one kind at a time: the first block's
      }
      const vtkMTimeType time = std::max(data->GetMTime(), chosen);
      const auto known = internals.Blocks.find(data);
      Internals::Block& block = blocks[data];
      if (known != internals.Blocks.end() && known->second.Time == time &&
        known->second.Limit == limit)
      {
        block = known->second;
      }
      else
      {
        block.Fields = noise::ComputeSurfaceFields(data, array, cells, perCell, limit);
        block.PerCell = perCell;
        block.Time = time;
        block.Limit = limit;
        changed = true;
      }
      variant.Tensors = tensors;
      variant.PerCell = perCell;
      internals.Drawn.AnyNoise = true;
    });
  changed |= blocks.size() < internals.Blocks.size();
  internals.Blocks.swap(blocks);
  if (changed)
  {
    internals.Drawn.FieldsTime.Modified();
  }
  variant.AtVertices = internals.Variant.AtVertices; // the view decides
  internals.SetVariant(variant);
  if (!internals.Drawn.AnyNoise && !why.empty() && internals.WarningTime != newest)
  {
    internals.WarningTime = newest;
    vtkWarningMacro(<< why << " Until then the surface shows its own colours.");
  }
}

void vtkSteerableNoiseMapper::Internals::ChooseStage(vtkRenderer* renderer, vtkActor* actor)
{
  // A fragment of a triangle as small as a pixel costs as much as eight of a large one where eight are shaded at
  // once; vertices always are. Between those of such a triangle there is nothing left to see if the noise has many
  // vertices in a cell of its finest lattice: with this share contrast is 2 to 3 % lower, and nothing else differs.
  constexpr double mostPixels = 2.0;
  constexpr double mostOfFeature = 0.14;
  constexpr double finestOfPixels = 0.63; // of FeaturePixels: sizes go in octaves, with a smooth turn between them
  double largest = 0.0;
  for (const auto& entry : this->Blocks)
  {
    largest = std::max(largest, entry.second.Fields.LargestCell);
  }
  const steerable::NoiseParameters& model = this->Options.Model;
  const double scale = noise::GetScale(actor);
  const double pixel = noise::GetSmallestPixel(renderer, actor);
  const double feature =
    (this->Options.Pixels ? finestOfPixels * this->Options.FeaturePixels * pixel : model.FeatureSize * scale) *
    std::pow(model.Lacunarity, 1 - model.Octaves);
  noise::ShaderVariant variant = this->Variant;
  variant.AtVertices = !variant.Tensors && !variant.PerCell && largest > 0.0 &&
    scale * largest <= std::min(mostPixels * pixel, mostOfFeature * feature);
  this->SetVariant(variant);
}

void vtkSteerableNoiseMapper::Render(vtkRenderer* renderer, vtkActor* actor)
{
  if (!this->Static && this->GetInputAlgorithm())
  {
    this->GetInputAlgorithm()->Update();
  }
  this->FindFields();
  this->Internal->Resolve();
  this->Internal->ChooseStage(renderer, actor);
  this->Superclass::Render(renderer, actor);
}

#define STEERABLENOISE_OPTION(name, type, member, value, AFTER)                                    \
  NOISE_OPTION(vtkSteerableNoiseMapper, name, type, this->Internal->Options.member, value, AFTER)
#define STEERABLENOISE_DRAWN(name, member, low, high)                                              \
  STEERABLENOISE_OPTION(name, double, member, noise::Clamp(name, low, high), )
#define VARIANT this->GetDrawn().VariantTime.Modified()

STEERABLENOISE_DRAWN(FeaturePixels, FeaturePixels, 1.0, 100.0)
STEERABLENOISE_DRAWN(FeatureSize, FeatureSize, 0.0, VTK_DOUBLE_MAX)
STEERABLENOISE_DRAWN(StreakLength, Model.StreakLength, 1.0, 20.0)
STEERABLENOISE_DRAWN(EigenvalueSum, Model.EigenvalueSum, 2.0, 16.0)
STEERABLENOISE_DRAWN(Strength, Model.Strength, 0.0, 1.0)
STEERABLENOISE_DRAWN(ReferenceMagnitude, ReferenceMagnitude, 0.0, VTK_DOUBLE_MAX)
STEERABLENOISE_DRAWN(MaskThreshold, Model.MaskThreshold, 0.0, VTK_DOUBLE_MAX)
STEERABLENOISE_OPTION(MaskUpperThreshold, double, MaskUpperThreshold,
  noise::Clamp(MaskUpperThreshold, 0.0, VTK_DOUBLE_MAX), this->Internal->ChosenTime.Modified())
STEERABLENOISE_DRAWN(Density, Model.Density, 0.01, 1.0)
STEERABLENOISE_DRAWN(Speed, Model.Speed, -4.0, 4.0)
STEERABLENOISE_DRAWN(Lacunarity, Model.Lacunarity, 1.0, 8.0)
STEERABLENOISE_DRAWN(Gain, Model.Gain, 0.0, 1.0)
STEERABLENOISE_DRAWN(Time, Time, -VTK_DOUBLE_MAX, VTK_DOUBLE_MAX)
STEERABLENOISE_OPTION(Phase, double, Phase,
  std::isfinite(Phase) ? Phase - std::floor(Phase) : 0.0, this->Internal->SetMotion())
STEERABLENOISE_OPTION(TimePeriod, double, TimePeriod, noise::Clamp(TimePeriod, 0.0, VTK_DOUBLE_MAX),
  this->Internal->SetMotion())
STEERABLENOISE_OPTION(Animate, bool, Animate, Animate, this->Internal->SetMotion())
STEERABLENOISE_OPTION(FollowCurvature, bool, Model.FollowCurvature, FollowCurvature, )
STEERABLENOISE_OPTION(Seed, int, Model.Seed, static_cast<std::uint32_t>(Seed), )
STEERABLENOISE_OPTION(Octaves, int, Model.Octaves, noise::Clamp(Octaves, 1, 8), VARIANT)
STEERABLENOISE_OPTION(StrengthMode, int, Model.StrengthMode,
  StrengthMode == MAGNITUDE ? steerable::StrengthMode::Magnitude : steerable::StrengthMode::Constant, )
STEERABLENOISE_OPTION(Basis, int, Model.Basis,
  Basis == STREAKS ? steerable::Basis::Streaks : steerable::Basis::Gradient, VARIANT)
STEERABLENOISE_OPTION(VectorsPerCell, bool, VectorsPerCell, VectorsPerCell,
  this->Internal->ChosenTime.Modified())

void vtkSteerableNoiseMapper::SetFeatureSizeMode(int mode)
{
  const bool pixels = mode != WORLD;
  if (pixels != this->Internal->Options.Pixels)
  {
    this->Internal->Options.Pixels = pixels;
    VARIANT;
  }
}

int vtkSteerableNoiseMapper::GetFeatureSizeMode()
{
  return this->Internal->Options.Pixels ? PIXELS : WORLD;
}

vtkSteerableNoiseMapper::Internals::Extremes vtkSteerableNoiseMapper::Internals::FindExtremes(
  vtkDataObject* input, vtkInformation* choice, vtkMultiProcessController* controller) const
{
  Extremes extremes;
  std::vector<noise::LengthSource> arrays;
  noise::ForEachPolyData(input,
    [&](vtkPolyData* data)
    {
      bool cells = false;
      std::string why;
      vtkDataArray* array = data->GetNumberOfPoints() > 0
        ? noise::FindSteeringArray(data, choice, cells, why)
        : nullptr;
      if (data->GetNumberOfPoints() > 0)
      {
        extremes.Bounds.AddBounds(data->GetBounds());
      }
      if (array)
      {
        arrays.push_back({ array });
      }
    });
  extremes.Lengths =
    noise::FindLengths(arrays, this->Options.MaskUpperThreshold, controller);
  if (controller)
  {
    vtkBoundingBox here = extremes.Bounds;
    controller->AllReduce(here, extremes.Bounds);
  }
  return extremes;
}

void vtkSteerableNoiseMapper::ShareExtremes(
  vtkDataObject* data, vtkMultiProcessController* controller)
{
  this->Internal->Shared =
    this->Internal->FindExtremes(data, this->GetInputArrayInformation(0), controller);
  this->Internal->AreShared = true;
}

void vtkSteerableNoiseMapper::ShareExtremes(vtkSteerableNoiseMapper* other)
{
  this->Internal->Shared = other->Internal->Shared;
  this->Internal->AreShared = other->Internal->AreShared;
}

bool vtkSteerableNoiseMapper::SetOptionsFrom(vtkSteerableNoiseFilter* filter)
{
  std::string refused;
  const auto refuse = [&](bool different, const char* name, const char* wanted)
  {
    if (different)
    {
      refused += std::string(refused.empty() ? "" : ", ") + name + " (only " + wanted + ")";
    }
  };
  const int* period = filter->GetPeriod();
  refuse(filter->GetLatticeWindow(), "LatticeWindow", "off");
  refuse(filter->GetBasis() == vtkSteerableNoiseFilter::VALUE, "Basis", "Gradient and Streaks");
  refuse(filter->GetNormalization() != vtkSteerableNoiseFilter::UNIT_VARIANCE, "Normalization",
    "Unit Variance");
  refuse(filter->GetFade() != vtkSteerableNoiseFilter::QUINTIC, "Fade", "Quintic");
  refuse(filter->GetLattice() != vtkSteerableNoiseFilter::SQUARE, "Lattice", "Square");
  refuse(filter->GetGradientSet() != vtkSteerableNoiseFilter::UNIFORM, "GradientSet", "Uniform");
  refuse(filter->GetTurbulence(), "Turbulence", "off");
  refuse(filter->GetOctaves() > 8, "Octaves", "up to 8");
  refuse(period[0] != 0 || period[1] != 0 || period[2] != 0, "Period", "0");
  if (!refused.empty())
  {
    vtkErrorMacro(<< "Noise of fragments does not have: " << refused
                  << ". Set these on the filter, or use the filter's array.");
    return false;
  }
  this->SetFeatureSizeMode(WORLD);
  this->SetFeatureSize(filter->GetFeatureSize());
  this->SetStreakLength(filter->GetStreakLength());
  this->SetEigenvalueSum(filter->GetEigenvalueSum());
  this->SetStrength(filter->GetStrength());
  this->SetStrengthMode(filter->GetStrengthMode());
  this->SetReferenceMagnitude(filter->GetReferenceMagnitude());
  this->SetMaskThreshold(filter->GetMaskThreshold());
  this->SetMaskUpperThreshold(filter->GetMaskUpperThreshold());
  this->SetFollowCurvature(filter->GetFollowCurvature());
  this->SetBasis(filter->GetBasis());
  this->SetDensity(filter->GetDensity());
  this->SetPhase(filter->GetPhase());
  this->SetAnimate(filter->GetAnimate());
  this->SetSpeed(filter->GetSpeed());
  this->SetTimePeriod(filter->GetTimePeriod());
  this->SetOctaves(filter->GetOctaves());
  this->SetLacunarity(filter->GetLacunarity());
  this->SetGain(filter->GetGain());
  this->SetSeed(filter->GetSeed());
  return true;
}

void vtkSteerableNoiseMapper::ShallowCopy(vtkAbstractMapper* mapper)
{
  if (auto* other = vtkSteerableNoiseMapper::SafeDownCast(mapper))
  {
    this->Internal->Options = other->Internal->Options;
    this->ShareExtremes(other);
    VARIANT;
  }
  this->Superclass::ShallowCopy(mapper);
}

void vtkSteerableNoiseMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FeatureSizeMode: " << (this->Internal->Options.Pixels ? "Pixels" : "World") << "\n"
     << indent << "FeaturePixels: " << this->GetFeaturePixels() << "\n"
     << indent << "FeatureSize: " << this->GetFeatureSize() << "\n"
     << indent << "StreakLength: " << this->GetStreakLength() << "\n"
     << indent << "EigenvalueSum: " << this->GetEigenvalueSum() << "\n"
     << indent << "Strength: " << this->GetStrength() << "\n"
     << indent << "StrengthMode: " << this->GetStrengthMode() << "\n"
     << indent << "ReferenceMagnitude: " << this->GetReferenceMagnitude() << "\n"
     << indent << "MaskThreshold: " << this->GetMaskThreshold() << "\n"
     << indent << "MaskUpperThreshold: " << this->GetMaskUpperThreshold() << "\n"
     << indent << "FollowCurvature: " << this->GetFollowCurvature() << "\n"
     << indent << "Basis: " << this->GetBasis() << "\n"
     << indent << "Density: " << this->GetDensity() << "\n"
     << indent << "Phase: " << this->GetPhase() << "\n"
     << indent << "Animate: " << this->GetAnimate() << "\n"
     << indent << "Speed: " << this->GetSpeed() << "\n"
     << indent << "TimePeriod: " << this->GetTimePeriod() << "\n"
     << indent << "Octaves: " << this->GetOctaves() << "\n"
     << indent << "Lacunarity: " << this->GetLacunarity() << "\n"
     << indent << "Gain: " << this->GetGain() << "\n"
     << indent << "Seed: " << this->GetSeed() << "\n"
     << indent << "VectorsPerCell: " << this->GetVectorsPerCell() << "\n";
}
