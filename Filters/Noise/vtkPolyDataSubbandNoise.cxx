// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPolyDataSubbandNoise.h"

#include "KeptByInput.h"
#include "NoiseArrays.h"
#include "NoiseBlocks.h"
#include "NoiseErrors.h"
#include "NoiseThreads.h"
#include "SubbandEvaluator.h"
#include "SubbandNames.h"
#include "SubbandPlan.h"

#include "vtkCellData.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <exception>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkPolyDataSubbandNoise);
vtkCxxSetObjectMacro(vtkPolyDataSubbandNoise, Controller, vtkMultiProcessController);

namespace
{
using noise::SubbandBlock;
using noise::SurfaceSums;

/// What lies on and steers a surface, or what to say where it is not there.
class BlockFinder
{
public:
  BlockFinder(vtkPolyDataSubbandNoise* self, vtkInformation* choice)
    : Self(self)
  {
    if (choice->Has(vtkDataObject::FIELD_ASSOCIATION()))
    {
      this->Cells =
        choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
    }
    if (choice->Has(vtkDataObject::FIELD_NAME()))
    {
      this->Name = noise::GetChosenName(choice);
    }
    else if (choice->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()))
    {
      this->Attribute = choice->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE());
    }
  }

  bool IsSteered() const { return !this->Name.empty() || this->Attribute >= 0; }

  /// False where the block has no noise; then Why says why.
  bool Find(SubbandBlock& block)
  {
    return this->FindTexture(block) && (!this->IsSteered() || this->FindVectors(block));
  }

  std::string Why;

private:
  bool FindTexture(SubbandBlock& block)
  {
    const int choice = this->Self->GetNumberOfInputConnections(1) > 0
      ? vtkPolyDataSubbandNoise::TEXTURE_COORDINATES
      : this->Self->GetParameterization();
    if (choice == vtkPolyDataSubbandNoise::TRIPLANAR)
    {
      return true;
    }
    vtkDataArray* texture = block.Mesh->GetPointData()->GetTCoords();
    if (texture && texture->GetNumberOfComponents() >= 2 &&
      texture->GetNumberOfTuples() >= block.Mesh->GetNumberOfPoints())
    {
      block.Texture = texture;
      return true;
    }
    if (choice == vtkPolyDataSubbandNoise::AUTOMATIC)
    {
      return true;
    }
    this->Why =
      "There are no texture coordinates (2 or 3 components) on the points. Make them, for "
      "instance with Texture Map to Sphere, or set Parameterization to Triplanar.";
    return false;
  }

  bool FindVectors(SubbandBlock& block)
  {
    for (const bool cells : { this->Cells, !this->Cells })
    {
      vtkDataSetAttributes* attributes = cells
        ? static_cast<vtkDataSetAttributes*>(block.Mesh->GetCellData())
        : block.Mesh->GetPointData();
      vtkDataArray* array = this->Attribute >= 0
        ? vtkDataArray::SafeDownCast(attributes->GetAbstractAttribute(this->Attribute))
        : attributes->GetArray(this->Name.c_str());
      if (!array)
      {
        continue;
      }
      const vtkIdType needed =
        cells ? block.Mesh->GetNumberOfCells() : block.Mesh->GetNumberOfPoints();
      if (noise::IsVector(array->GetNumberOfComponents()) && array->GetNumberOfTuples() >= needed)
      {
        block.Vectors = array;
        block.CellVectors = cells;
        return true;
      }
      std::ostringstream message;
      message << "Array '" << (array->GetName() ? array->GetName() : "") << "' has "
              << array->GetNumberOfComponents() << " component(s) and "
              << array->GetNumberOfTuples() << " tuples. Choose vectors, with 2 or 3, for all "
              << needed << (cells ? " cells." : " points.");
      this->Why = message.str();
    }
    if (this->Why.empty())
    {
      this->Why = this->Name.empty()
        ? "There are no active vectors on points or cells. Name an array of vectors, or none."
        : "There is no array '" + this->Name +
          "' on points or cells. Choose vectors that exist, or None.";
    }
    return false;
  }

  vtkPolyDataSubbandNoise* Self;
  std::string Name;
  int Attribute = -1;
  bool Cells = false;
};
} // namespace

struct vtkPolyDataSubbandNoise::Internals
{
  /// By the texture coordinates, which are only compared, and WrapSeams.
  noise::KeptByInput<noise::KeptSurface, std::pair<const vtkDataArray*, bool>> Kept;
  noise::SubbandTileSets Tiles;
  std::shared_ptr<const noise::SubbandAgreement> Given; // by another filter; null: ranks agree
  std::shared_ptr<const noise::SubbandAgreement> Last;

  /// What comes from inputs.
  void Forget()
  {
    this->Kept.Clear();
    this->Tiles.Image = noise::SubbandImageTiles();
  }
};

/// One execution, in the order of RequestData.
struct vtkPolyDataSubbandNoise::Execution
{
  explicit Execution(vtkPolyDataSubbandNoise* self);

  void CollectBlocks(vtkDataObject* input, vtkDataObject* output);
  void AgreeAcrossRanks(vtkImageData* image);
  /// Throws std::exception.
  void Evaluate();
  std::string Report() const;

  noise::SubbandPlan Plan;

private:
  void AddMesh(vtkPolyData* mesh, vtkDataObject* source);
  std::string NameOf(int which) const
  {
    return noise::GetChosenName(this->Self->GetInputArrayInformation(which));
  }
  void EvaluateBlock(SubbandBlock& block, double progress, double share);
  void TakeOwnArrays(const SubbandBlock& block, noise::SubbandPointWeights& weights) const;
  void AddOutputArrays(const SubbandBlock& block, noise::SubbandEvaluator& evaluator) const;
  void EvaluatePoints(SubbandBlock& block, noise::SubbandEvaluator& evaluator, double progress,
    double share);

  vtkPolyDataSubbandNoise* Self;
  BlockFinder Finder;
  std::vector<SubbandBlock> Blocks;
  bool IsComposite = false;
  vtkIdType BlocksWithout = 0;
  std::string OtherType;
  noise::SubbandPointCounts Counts;
};

//------------------------------------------------------------------------------
vtkPolyDataSubbandNoise::vtkPolyDataSubbandNoise()
  : Cache(new Internals)
{
  this->SetNumberOfInputPorts(2);
  this->SetResultArrayName("SubbandNoise");
  this->SetController(vtkMultiProcessController::GetGlobalController());
}

//------------------------------------------------------------------------------
vtkPolyDataSubbandNoise::~vtkPolyDataSubbandNoise()
{
  this->SetResultArrayName(nullptr);
  this->SetController(nullptr);
  delete this->Cache;
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetKeepFields(bool keepFields)
{
  // No reason to execute again.
  this->KeepFields = keepFields;
  if (!keepFields)
  {
    this->Cache->Forget();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetOrientations(int orientations)
{
  const int allowed = noise::TakeOrientations(this, orientations);
  if (this->Orientations != allowed)
  {
    this->Orientations = allowed;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetPhase(double phase)
{
  phase = std::isfinite(phase) ? phase - std::floor(phase) : 0.0;
  if (this->Phase != phase)
  {
    this->Phase = phase;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::TakeAgreement(vtkPolyDataSubbandNoise* other)
{
  const std::shared_ptr<const noise::SubbandAgreement> given =
    other ? other->Cache->Last : nullptr;
  if (this->Cache->Given != given)
  {
    this->Cache->Given = given;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetSubbandsConnection(vtkAlgorithmOutput* bands)
{
  this->SetInputConnection(1, bands);
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::SetSubbandsData(vtkImageData* bands)
{
  this->SetInputDataObject(1, bands);
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
    return 1;
  }
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // A point's metric is the mean over the triangles around it.
  using SDDP = vtkStreamingDemandDrivenPipeline;
  inputVector[0]->GetInformationObject(0)->Set(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS(),
    outputVector->GetInformationObject(0)->Get(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS()) + 1);
  if (this->GetNumberOfInputConnections(1) > 0)
  {
    // Each rank looks up all of the image.
    vtkInformation* image = inputVector[1]->GetInformationObject(0);
    int whole[6];
    image->Get(SDDP::WHOLE_EXTENT(), whole);
    image->Set(SDDP::UPDATE_EXTENT(), whole, 6);
  }
  return 1;
}

//------------------------------------------------------------------------------
vtkPolyDataSubbandNoise::Execution::Execution(vtkPolyDataSubbandNoise* self)
  : Self(self)
  , Finder(self, self->GetInputArrayInformation(STEERING_ARRAY))
{
  noise::SubbandProperties& p = this->Plan.Properties;
  p.Wavelength = self->Wavelength;
  p.Anisotropy = self->Anisotropy;
  p.Method = static_cast<steerable::WeightMethod>(self->Method);
  p.Orientations = self->Orientations;
  p.RadialTriple = self->RadialTriple;
  p.Octaves = self->Octaves;
  p.AntiAlias = self->AntiAlias;
  p.WrapSeams = self->WrapSeams;
  p.BlendSeams = self->BlendSeams;
  p.TileSize = self->TileSize;
  p.Seed = static_cast<std::uint32_t>(self->Seed);
  p.Phase = self->Phase;
  p.ChooseParameterization = self->Parameterization == AUTOMATIC;
  p.WeightsOnly = self->WeightsOnly;
  this->Plan.Controller = self->Controller;
  this->Plan.Given = self->Cache->Given;
  this->Plan.Tiles = &self->Cache->Tiles;
  this->Plan.IsSteered = this->Finder.IsSteered();
  this->Plan.IsOfImage = self->GetNumberOfInputConnections(1) > 0;
  p.WavelengthArray = this->NameOf(WAVELENGTH_ARRAY);
  p.AnisotropyArray = this->Plan.IsSteered ? this->NameOf(ANISOTROPY_ARRAY) : std::string();
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::Execution::CollectBlocks(vtkDataObject* input, vtkDataObject* output)
{
  this->IsComposite = output->IsA("vtkCompositeDataSet");
  noise::CopyBlocks(input, output,
    [this](vtkDataObject* copy, vtkDataObject* source)
    {
      copy->ShallowCopy(source);
      if (auto* mesh = vtkPolyData::SafeDownCast(copy))
      {
        this->AddMesh(mesh, source);
      }
      else
      {
        ++this->Plan.Own[SurfaceSums::OtherBlocks];
        this->OtherType = source->GetClassName();
      }
    });
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::Execution::AddMesh(vtkPolyData* mesh, vtkDataObject* source)
{
  if (mesh->GetNumberOfPoints() == 0)
  {
    return;
  }
  SubbandBlock block;
  block.Mesh = mesh;
  block.Source = source;
  if (this->Finder.Find(block))
  {
    this->Blocks.push_back(std::move(block));
  }
  else
  {
    ++this->BlocksWithout;
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::Execution::AgreeAcrossRanks(vtkImageData* image)
{
  noise::SubbandPlan& plan = this->Plan;
  if (plan.IsOfImage && !this->Blocks.empty())
  {
    noise::Attempt(plan.Failure, [&] { plan.ImageTiles = &plan.Tiles->Image.Update(image); });
  }
  this->Self->Cache->Kept.Assign(this->Blocks,
    [&](const SubbandBlock& block)
    { return std::pair<const vtkDataArray*, bool>(block.Texture, plan.Properties.WrapSeams); });
  plan.AgreeOnSurfaces(this->Blocks);
  const bool nothing =
    plan.Agreed.Sums[SurfaceSums::TexturedBlocks] + plan.Agreed.Sums[SurfaceSums::ProjectedBlocks] ==
    0.0;
  if (plan.Failure.empty() && this->BlocksWithout > 0 && (!this->IsComposite || nothing))
  {
    plan.Failure = this->Finder.Why;
  }
  if (plan.Failure.empty() && plan.Own[SurfaceSums::OtherBlocks] > 0 && nothing &&
    this->BlocksWithout == 0)
  {
    plan.Failure =
      "The input holds no surface but " + this->OtherType + ". Extract its surface first.";
  }
  plan.AgreeOnLengths(this->Blocks);
  plan.AgreeOnTexture(this->Blocks);
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::Execution::Evaluate()
{
  const double share = 1.0 / static_cast<double>(this->Blocks.size());
  for (std::size_t b = 0; b < this->Blocks.size() && !this->Self->GetAbortOutput(); ++b)
  {
    this->EvaluateBlock(
      this->Blocks[b], static_cast<double>(b) / static_cast<double>(this->Blocks.size()), share);
  }
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::Execution::EvaluateBlock(
  SubbandBlock& block, double progress, double share)
{
  noise::SubbandEvaluator evaluator;
  evaluator.Weights = this->Plan.GetPointWeights(block);
  evaluator.Persistence = this->Self->Persistence;
  evaluator.Turbulence = this->Self->Function == TURBULENCE;
  evaluator.Seed = this->Plan.Properties.Seed;
  this->TakeOwnArrays(block, evaluator.Weights);
  vtkSmartPointer<vtkFloatArray> result;
  if (!this->Self->WeightsOnly)
  {
    result =
      noise::NewOutputArray(this->Self->ResultArrayName, 1, block.Mesh->GetNumberOfPoints());
    evaluator.Noise = result->GetPointer(0);
  }
  this->AddOutputArrays(block, evaluator);
  this->EvaluatePoints(block, evaluator, progress, share);
  if (result)
  {
    block.Mesh->GetPointData()->AddArray(result);
    block.Mesh->GetPointData()->SetActiveScalars(this->Self->ResultArrayName);
  }
  block.Surface.reset();
}

//------------------------------------------------------------------------------
// Weights and factors of the user's own.
void vtkPolyDataSubbandNoise::Execution::TakeOwnArrays(
  const SubbandBlock& block, noise::SubbandPointWeights& weights) const
{
  const auto find = [&](const std::string& name, int components) -> vtkDataArray*
  {
    vtkDataArray* array = block.Mesh->GetPointData()->GetArray(name.c_str());
    return array && array->GetNumberOfComponents() == components &&
        array->GetNumberOfTuples() == block.Mesh->GetNumberOfPoints()
      ? array
      : nullptr;
  };
  const std::vector<noise::SubbandLookup>& lookups = weights.Lookups;
  const steerable::SubbandParameters& pyramid = lookups[0].Layout->Pyramid;
  const std::string ownWeights = this->NameOf(WEIGHTS_ARRAY);
  if (!ownWeights.empty())
  {
    const int needed = weights.GetFirstComponent(lookups.size());
    weights.Limited = weights.Limited && !this->Plan.IsOfImage;
    weights.OwnWeights = find(ownWeights, needed);
    if (!weights.OwnWeights)
    {
      throw std::invalid_argument("Weights '" + ownWeights + "' are not on the points with " +
        std::to_string(needed) + " components (" + std::to_string(pyramid.Orientations) +
        " orientations, " + std::to_string(pyramid.Scales) + " scales" +
        (lookups.size() > 3 ? ", and 3 planes with " +
              std::to_string(lookups[1].Layout->Pyramid.Scales)
            : lookups.size() > 1                ? ", 3 planes"
            : lookups[0].Tiles->Residuals > 0 ? ", residuals"
                                                : "") +
        "). OutputWeights adds such an array to begin with.");
    }
  }
  const std::string factors = this->NameOf(FACTORS_ARRAY);
  if (!factors.empty())
  {
    const int needed = weights.Octaves * pyramid.Orientations;
    weights.Factors = find(factors, needed);
    if (!weights.Factors)
    {
      throw std::invalid_argument("Factors '" + factors + "' are not on the points with " +
        std::to_string(needed) + " components, one for each octave and orientation.");
    }
  }
}

//------------------------------------------------------------------------------
// Those that are asked for beside the noise.
void vtkPolyDataSubbandNoise::Execution::AddOutputArrays(
  const SubbandBlock& block, noise::SubbandEvaluator& evaluator) const
{
  const vtkIdType points = block.Mesh->GetNumberOfPoints();
  const bool textured = block.Texture != nullptr;
  if (this->Self->OutputWeights || this->Self->WeightsOnly)
  {
    const noise::SubbandPointWeights& weights = evaluator.Weights;
    auto array = noise::NewOutputArray(
      "SubbandWeights", weights.GetFirstComponent(weights.Lookups.size()), points);
    array->Fill(0.0);
    for (std::size_t l = 0; l < weights.Lookups.size(); ++l)
    {
      const bool onTexture = textured && l == 0;
      const steerable::SubbandParameters& bands = weights.Lookups[l].Layout->Pyramid;
      const int first = weights.GetFirstComponent(l);
      noise::NameSubbands(array, bands.Orientations, bands.Scales,
        onTexture ? std::string() : std::string(1, "xyz"[textured ? l - 1 : l]), first);
      if (weights.Lookups[l].Tiles->Residuals > 0)
      {
        noise::NameResiduals(array, bands.Orientations, first + bands.Components());
      }
    }
    evaluator.WeightArray = array->GetPointer(0);
    block.Mesh->GetPointData()->AddArray(array);
  }
  if (this->Self->OutputDistortion)
  {
    auto array = noise::NewOutputArray("Distortion", 1, points);
    evaluator.Distortion = array->GetPointer(0);
    evaluator.Weights.NeedsDistortion = true;
    block.Mesh->GetPointData()->AddArray(array);
  }
}

//------------------------------------------------------------------------------
// Fills the arrays; shapes of points are found anew where they are not known.
void vtkPolyDataSubbandNoise::Execution::EvaluatePoints(
  SubbandBlock& block, noise::SubbandEvaluator& evaluator, double progress, double share)
{
  noise::KeptSurface& known = *block.Known;
  noise::SubbandPointsKey key = this->Plan.GetPointsKey(block, evaluator.Weights);
  noise::SubbandEvaluation surface;
  surface.Points = block.Mesh->GetNumberOfPoints();
  surface.ArePointsKnown = known.ArePointsKnown && known.Key == key;
  surface.Kept = this->Self->KeepFields ? &known.Chunks : nullptr;
  vtkUnsignedCharArray* ghosts = block.Mesh->GetPointGhostArray();
  surface.Ghosts = ghosts && ghosts->GetNumberOfTuples() >= surface.Points ? ghosts : nullptr;
  const std::size_t chunks = noise::SubbandEvaluator::CountChunks(surface.Points);
  std::vector<float> scratch;
  std::unique_ptr<steerable::TupleReader<float>> reader;
  known.ArePointsKnown = false; // until all of it is done
  if (!surface.ArePointsKnown)
  {
    known.Key = std::move(key);
    known.Chunks = {};
    known.Chunks.resize(surface.Kept ? chunks : 0);
    surface.Surface = &this->Plan.PrepareSurface(block);
    if (block.Vectors)
    {
      const auto tuples = static_cast<std::size_t>(block.Vectors->GetNumberOfTuples());
      reader = noise::MakeVectorReader(
        block.Vectors, noise::WorldAxes, false, this->Plan.Agreed.Bounds.GetPlane());
      scratch.resize(3 * tuples);
      surface.Vectors.Values = reader->Read(0, tuples, scratch.data());
      surface.Vectors.Cells = block.CellVectors;
    }
  }
  const noise::SubbandPointCounts found = noise::ForEachPart(this->Self, chunks, surface.Points,
    progress, share,
    [&](std::size_t begin, std::size_t end) { return evaluator.Evaluate(surface, begin, end); });
  if (!surface.ArePointsKnown)
  {
    known.Counts = found;
  }
  known.ArePointsKnown = surface.Kept && !this->Self->GetAbortOutput();
  this->Counts += known.Counts;
}

//------------------------------------------------------------------------------
// What to say in one warning; empty: nothing.
std::string vtkPolyDataSubbandNoise::Execution::Report() const
{
  const noise::SubbandPlan& plan = this->Plan;
  const noise::SubbandProperties& p = plan.Properties;
  const double repeats = plan.GetLayout(true).Repeats;
  std::ostringstream message;
  if (plan.IsShattered)
  {
    message << "\nMost of the surface lies in charts of the texture that are smaller than a wavelength ("
            << plan.SmallCharts << " of them): planar projections took its place. Lower Wavelength, or set "
               "Parameterization to Texture Coordinates to have it all the same.";
  }
  if (!plan.IsShattered && repeats < 1.0 && plan.Own[SurfaceSums::TexturedBlocks] > 0.0)
  {
    message << "\nThe wavelength is long for the texture: a tile is spread over "
            << std::round(1.0 / repeats)
            << " repeats of it, and its seams may show. Lower Wavelength or scale the texture "
               "coordinates down.";
  }
  const double triangles = plan.Own[SurfaceSums::Triangles];
  const double flipped =
    plan.IsShattered ? 0.0 : plan.Own[plan.IsMirrored ? SurfaceSums::Regular : SurfaceSums::Flipped];
  const double singular = plan.IsShattered ? 0.0 : plan.Own[SurfaceSums::Singular];
  const double degenerate = plan.Own[SurfaceSums::Degenerate];
  if ((plan.IsFolded && flipped > 0.0) || singular > 0.0 || degenerate > 0.0)
  {
    message << "\nOf " << triangles << " triangles " << (plan.IsFolded ? flipped : 0.0)
            << " are folded over by the texture, " << singular << " have no area in it and "
            << degenerate << " none on the surface; they were left out.";
  }
  if (this->Counts.Unmapped > 0)
  {
    message << "\n"
            << this->Counts.Unmapped << " of " << this->Counts.Points
            << " points have no triangle with an area and got 0.";
  }
  if (this->Counts.Undirected > 0)
  {
    message << "\n"
            << this->Counts.Undirected << " of " << this->Counts.Points
            << " points have no direction in the surface (zero, NaN, infinite or normal to it) and "
               "got isotropic noise.";
  }
  if (this->Counts.Clamped > 0)
  {
    message << "\nAt " << this->Counts.Clamped << " of " << this->Counts.Points
            << " points the texture is stretched beyond the tiles' scales: noise is up to "
            << std::round(100.0 * this->Counts.Finer) / 100.0 << " times finer or "
            << std::round(100.0 * this->Counts.Coarser) / 100.0
            << " times coarser than wanted. Raise TileSize, change Wavelength, or set "
               "Parameterization to Triplanar.";
  }
  if (plan.Own[SurfaceSums::OtherBlocks] > 0)
  {
    message << "\n"
            << plan.Own[SurfaceSums::OtherBlocks] << " block(s) are no surfaces (" << this->OtherType
            << ") and were passed on without noise. Extract their surface first.";
  }
  if (this->IsComposite && this->BlocksWithout > 0)
  {
    message << "\n" << this->BlocksWithout << " block(s) were passed on without noise. " << this->Finder.Why;
  }
  if (plan.AskedAnisotropy > 1.005 * plan.MostAnisotropy && !this->Blocks.empty())
  {
    message << "\nAnisotropy is " << plan.AskedAnisotropy << ", but " << p.Orientations
            << " Orientations make features at most " << std::round(10.0 * plan.MostAnisotropy) / 10.0
            << " times longer than wide: they are that. Lower Anisotropy"
            << (p.Orientations < 8 ? ", or raise Orientations." : ".");
  }
  // Octaves that are too fine fade with AntiAlias.
  const double thinnest = plan.Wavelengths.Shortest / std::sqrt(plan.WantedAnisotropy) /
    (p.AntiAlias ? 1.0 : std::ldexp(1.0, p.Octaves - 1));
  if (!this->Blocks.empty() && !p.WeightsOnly && !plan.IsWholeImage() && plan.Spacing > 0.0 &&
    thinnest < 0.999 * noise::PointsPerWavelength * plan.Spacing)
  {
    message << "\nThe points are " << plan.Spacing << " apart: " << thinnest / plan.Spacing
            << " to a wavelength of " << thinnest << ", where " << noise::PointsPerWavelength
            << " are wanted. Set Wavelength to at least "
            << plan.Wavelength * noise::PointsPerWavelength * plan.Spacing / thinnest
            << ", or refine the mesh (Subdivide).";
  }
  const std::string text = message.str();
  return text.empty() ? text : text.substr(1);
}

//------------------------------------------------------------------------------
int vtkPolyDataSubbandNoise::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkDataObject* input = vtkDataObject::GetData(inputVector[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputVector);
  const auto refuse = [&](const std::string& why) { return noise::Refuse(this, output, why); };
  if (!this->ResultArrayName || !*this->ResultArrayName)
  {
    return refuse("ResultArrayName is empty. Give the noise array a name.");
  }
  // Everything else is clamped when it is set, but NaN passes a clamp.
  if (std::isnan(this->Wavelength) || std::isnan(this->Anisotropy) ||
    std::isnan(this->Persistence))
  {
    std::ostringstream why;
    why << "Wavelength is " << this->Wavelength << ", Anisotropy " << this->Anisotropy
        << ", Persistence " << this->Persistence << "; give each a number.";
    return refuse(why.str());
  }
  const noise::AtEnd forget(
    [this]
    {
      if (!this->KeepFields)
      {
        this->Cache->Forget();
      }
    });

  Execution run(this);
  run.CollectBlocks(input, output);
  run.AgreeAcrossRanks(run.Plan.IsOfImage ? vtkImageData::GetData(inputVector[1]) : nullptr);
  this->ResolvedWavelength = run.Plan.Wavelength;
  this->Cache->Last = std::make_shared<noise::SubbandAgreement>(run.Plan.Agreed);
  if (!run.Plan.Failure.empty())
  {
    return refuse(run.Plan.Failure);
  }
  try
  {
    run.Plan.LayTiles();
    this->TextureRepeats = run.Plan.GetLayout(true).Repeats;
    this->PlaneRepeats = run.Plan.GetLayout(false).Repeats;
    run.Evaluate();
  }
  catch (const std::exception& error)
  {
    return refuse(error.what());
  }
  const std::string warning = run.Report();
  if (!warning.empty())
  {
    vtkWarningMacro(<< warning);
  }
  return 1;
}

//------------------------------------------------------------------------------
void vtkPolyDataSubbandNoise::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Wavelength: " << this->Wavelength << "\n";
  os << indent << "ResolvedWavelength: " << this->ResolvedWavelength << "\n";
  os << indent << "Anisotropy: " << this->Anisotropy << "\n";
  os << indent << "Parameterization: " << this->Parameterization << "\n";
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Orientations: " << this->Orientations << "\n";
  os << indent << "RadialTriple: " << this->RadialTriple << "\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Persistence: " << this->Persistence << "\n";
  os << indent << "Function: " << this->Function << "\n";
  os << indent << "AntiAlias: " << this->AntiAlias << "\n";
  os << indent << "WrapSeams: " << this->WrapSeams << "\n";
  os << indent << "BlendSeams: " << this->BlendSeams << "\n";
  os << indent << "TileSize: " << this->TileSize << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "Phase: " << this->Phase << "\n";
  os << indent << "ResultArrayName: " << (this->ResultArrayName ? this->ResultArrayName : "(none)")
     << "\n";
  os << indent << "KeepFields: " << this->KeepFields << "\n";
  os << indent << "OutputWeights: " << this->OutputWeights << "\n";
  os << indent << "WeightsOnly: " << this->WeightsOnly << "\n";
  os << indent << "OutputDistortion: " << this->OutputDistortion << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
