// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSteerableNoiseFilter.h"

#include "KeptByInput.h"
#include "MetricTensor.h"
#include "NoiseArrays.h"
#include "NoiseBlocks.h"
#include "NoiseErrors.h"
#include "NoiseGhosts.h"
#include "NoiseImages.h"
#include "NoiseLengths.h"
#include "NoiseSamples.h"
#include "NoiseSizes.h"
#include "NoiseThreads.h"
#include "SurfaceFields.h"

#include "vtkCellData.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkRectilinearGrid.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkSteerableNoiseFilter);
vtkCxxSetObjectMacro(vtkSteerableNoiseFilter, Controller, vtkMultiProcessController);

namespace
{
struct KeptBlock;

/// A dataset of the output that gets noise, and the array that steers it.
struct Block
{
  vtkDataSet* DataSet = nullptr;
  /// The input's, of which it is a shallow copy; a magnified image is its own.
  vtkDataObject* Source = nullptr;
  KeptBlock* Known = nullptr;
  vtkDataArray* Array = nullptr;
  bool Cells = false;
  noise::ShapeArrays ShapeArrays = {};
  noise::Shape Shape;
  /// What a magnified image was made from: interpolated lengths lie between those that are there.
  vtkDataSet* Original = nullptr;
  vtkDataArray* OriginalArray = nullptr;

  vtkDataSet* GetOriginal() const { return this->Original ? this->Original : this->DataSet; }
  vtkDataArray* GetOriginalArray() const
  {
    return this->OriginalArray ? this->OriginalArray : this->Array;
  }
};

/// What was found out about a dataset of the input, good as long as what it depends on is the same.
struct KeptBlock
{
  bool AreSizesKnown = false;
  bool AreSizesExact = false;
  noise::CommonSizes Sizes;

  /// The array is only compared, never used: it may be gone.
  const vtkDataArray* Array = nullptr;
  noise::Plane Plane = noise::WorldPlane;
  double Limit = 0.0;
  noise::SampleFields Fields;

  const noise::CommonSizes& GetSizes(const Block& block, bool exact)
  {
    if (!this->AreSizesKnown || this->AreSizesExact != exact)
    {
      this->Sizes = noise::CommonSizes();
      this->Sizes.Add(block.DataSet, block.Cells, block.Shape.Slab, exact);
      this->AreSizesKnown = true;
      this->AreSizesExact = exact;
    }
    return this->Sizes;
  }

  noise::SampleFields* GetFields(const Block& block, const noise::Plane& plane, double limit)
  {
    if (this->Array != block.Array || this->Plane != plane || this->Limit != limit)
    {
      this->Fields = noise::SampleFields();
      this->Array = block.Array;
      this->Plane = plane;
      this->Limit = limit;
    }
    return &this->Fields;
  }
};

vtkDataSetAttributes* GetAttributes(vtkDataSet* dataset, bool cells)
{
  return cells ? static_cast<vtkDataSetAttributes*>(dataset->GetCellData())
               : dataset->GetPointData();
}

/// Data without time, or of one time, which is `only`.
bool IsSteady(vtkInformation* info, double& only)
{
  using SDDP = vtkStreamingDemandDrivenPipeline;
  if (info->Has(SDDP::TIME_STEPS()) && info->Length(SDDP::TIME_STEPS()) > 0)
  {
    only = info->Get(SDDP::TIME_STEPS(), 0);
    return info->Length(SDDP::TIME_STEPS()) == 1;
  }
  if (info->Has(SDDP::TIME_RANGE()))
  {
    only = info->Get(SDDP::TIME_RANGE(), 0);
    return only == info->Get(SDDP::TIME_RANGE(), 1);
  }
  return true;
}

/// That the output is asked for; 0 if none is.
double GetTime(vtkInformation* outInfo)
{
  using SDDP = vtkStreamingDemandDrivenPipeline;
  return outInfo->Has(SDDP::UPDATE_TIME_STEP()) ? outInfo->Get(SDDP::UPDATE_TIME_STEP()) : 0.0;
}

/// Those of the input, which may be one.
std::vector<vtkImageData*> GetImages(vtkDataObject* input)
{
  std::vector<vtkImageData*> images;
  noise::VisitBlocks(input,
    [&](vtkDataObject* leaf)
    {
      if (auto* image = vtkImageData::SafeDownCast(leaf))
      {
        images.push_back(image);
      }
    });
  return images;
}

constexpr const char* HyperTreeGridMessage =
  "A HyperTreeGrid has no points or cells of its own. Apply Hyper Tree Grid To Unstructured Grid "
  "(vtkHyperTreeGridToUnstructuredGrid) first, or Resample To Image.";

/// Not all zeros, and every component finite.
bool HasValue(vtkDataArray* array, vtkIdType i)
{
  double tuple[9];
  array->GetTuple(i, tuple);
  const double* const first = tuple;
  const double* const end = tuple + array->GetNumberOfComponents();
  return std::all_of(first, end, [](double value) { return std::isfinite(value); }) &&
    std::any_of(first, end, [](double value) { return value != 0.0; });
}

/// Degenerate samples are counted by the kernel with the ghosts; these are the duplicates among them.
vtkIdType CountDegenerateGhosts(const Block& block, const std::vector<unsigned char>& leftOut)
{
  vtkUnsignedCharArray* ghosts = noise::GetGhosts(
    GetAttributes(block.DataSet, block.Cells), block.Array->GetNumberOfTuples());
  if (!ghosts || !noise::IsVector(block.Array->GetNumberOfComponents()))
  {
    return 0;
  }
  vtkIdType count = 0;
  for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i)
  {
    count += ghosts->GetValue(i) && (leftOut.empty() || !leftOut[i]) && !HasValue(block.Array, i);
  }
  return count;
}

/// vtkGhostType of the samples, of which the output has a copy of its own from here on.
vtkSmartPointer<vtkUnsignedCharArray> OwnGhosts(const Block& block)
{
  vtkDataSetAttributes* attributes = GetAttributes(block.DataSet, block.Cells);
  const vtkIdType count = block.Array->GetNumberOfTuples();
  auto own = vtkSmartPointer<vtkUnsignedCharArray>::New();
  if (vtkUnsignedCharArray* ghosts = noise::GetGhosts(attributes, count))
  {
    own->DeepCopy(ghosts);
  }
  else
  {
    own->SetNumberOfTuples(count);
    own->Fill(0);
  }
  own->SetName(vtkDataSetAttributes::GhostArrayName());
  attributes->AddArray(own);
  return own;
}

/// Points whose coordinates are not finite: unlike vectors that are missing, they are a mistake in the mesh.
vtkIdType CountBadPlaces(vtkDataSet* dataset)
{
  auto* set = vtkPointSet::SafeDownCast(dataset);
  vtkIdType count = 0;
  for (vtkIdType i = 0; set && i < set->GetNumberOfPoints(); ++i)
  {
    double place[3];
    set->GetPoint(i, place);
    count += !std::isfinite(place[0] + place[1] + place[2]);
  }
  return count;
}
} // namespace

/// By whether samples are in cells, and the slab that they are taken in.
struct vtkSteerableNoiseFilter::KeptBlocks
{
  noise::KeptByInput<KeptBlock, std::pair<bool, int>> Blocks;
};

/// One execution, in the order of RequestData.
struct vtkSteerableNoiseFilter::Execution
{
  vtkSteerableNoiseFilter* Self;
  vtkInformation* OutInfo;
  steerable::NoiseParameters Parameters;
  std::vector<Block> Blocks;
  bool IsComposite = false;
  /// Extent of what a piece is one of; empty: the input is all there is.
  std::vector<int> WholeExtent;
  noise::CommonSizes Sizes;
  noise::LengthRange Lengths;
  /// Why this rank cannot go on; empty: it can.
  std::string Failure;

  steerable::EvaluationCounts Counts;
  vtkIdType Samples = 0;
  /// Of all ranks: degenerate ones, and all.
  double AllDegenerate = 0.0;
  double AllSamples = 0.0;
  vtkIdType TooLong = 0;
  vtkIdType BadPlaces = 0;
  vtkIdType BlocksWithout = 0;
  /// Of an AMR, which Magnification leaves alone.
  vtkIdType ImagesAsTheyAre = 0;
  /// Why the last of them could not be used.
  std::string Why;

  Execution(vtkSteerableNoiseFilter* self, vtkInformation* outInfo)
    : Self(self)
    , OutInfo(outInfo)
    , Parameters(this->GetParameters(GetTime(outInfo)))
  {
  }

  const int* GetWholeExtent() const
  {
    return this->WholeExtent.empty() ? nullptr : this->WholeExtent.data();
  }

  steerable::NoiseParameters GetParameters(double time) const
  {
    const vtkSteerableNoiseFilter& f = *this->Self;
    steerable::NoiseParameters p;
    p.FeatureSize = f.FeatureSize;
    p.StreakLength = f.StreakLength;
    p.Quality = f.Quality;
    p.MinimumEigenvalue = f.MinimumEigenvalue;
    p.EigenvalueSum = f.EigenvalueSum;
    p.LatticeWindow = f.LatticeWindow;
    p.AnisotropicWeight = f.AnisotropicWeight;
    p.MetricInProjection = f.MetricInProjection;
    p.Strength = f.Strength;
    p.StrengthMode = f.IsSteered() ? static_cast<steerable::StrengthMode>(f.StrengthMode)
                                 : steerable::StrengthMode::Constant;
    p.ReferenceMagnitude = f.ReferenceMagnitude;
    p.MaskThreshold = f.MaskThreshold;
    p.FollowCurvature = f.FollowCurvature;
    p.Normalization = static_cast<steerable::Normalization>(f.Normalization);
    p.Basis = static_cast<steerable::Basis>(f.Basis);
    p.Density = f.Density;
    p.Motion = f.Animate || f.Phase != 0.0 || f.TimePeriod > 0.0;
    p.Phase = f.Phase + (f.TimePeriod > 0.0 ? time / f.TimePeriod : 0.0);
    p.Speed = f.Speed;
    p.Octaves = f.Octaves;
    p.Lacunarity = f.Lacunarity;
    p.Gain = f.Gain;
    p.Turbulence = f.Turbulence;
    p.Fade = static_cast<steerable::Fade>(f.Fade);
    p.Falloff = static_cast<steerable::Falloff>(f.Falloff);
    p.Lattice = static_cast<steerable::Lattice>(f.Lattice);
    p.GradientSet = static_cast<steerable::GradientSet>(f.GradientSet);
    p.Period = { f.Period[0], f.Period[1], f.Period[2] };
    p.Seed = static_cast<std::uint32_t>(f.Seed);
    if (f.Model == MODEL_PERLIN)
    {
      p.LatticeWindow = true;
      p.Quality = 0;
      p.AnisotropicWeight = false;
      p.MetricInProjection = false;
      p.Normalization = steerable::Normalization::None;
    }
    return p;
  }

  /**
   * Makes the output: shallow copies of the input's datasets, so that arrays can be added, and magnified
   * images.
   */
  void CollectBlocks(vtkDataObject* input, vtkDataObject* output)
  {
    this->IsComposite = output->IsA("vtkCompositeDataSet");
    // The levels of an AMR say how fine its images are.
    const bool isAMR = output->IsA("vtkUniformGridAMR");
    const int magnification = this->Self->ResolvedMagnification;
    if (magnification > 1 && !isAMR)
    {
      noise::Attempt(this->Failure, [&] { noise::CheckMemory(GetImages(input), magnification); });
    }
    noise::CopyBlocks(input, output,
      [&](vtkDataObject* copy, vtkDataObject* source)
      {
        auto* image = vtkImageData::SafeDownCast(source);
        const bool finer = image && magnification > 1 && !isAMR && this->Failure.empty();
        if (finer)
        {
          noise::Attempt(this->Failure, [&] { this->Magnify(image, vtkImageData::SafeDownCast(copy)); });
        }
        else
        {
          copy->ShallowCopy(source);
        }
        this->ImagesAsTheyAre += image && isAMR && magnification > 1;
        if (auto* dataset = vtkDataSet::SafeDownCast(copy))
        {
          this->AddBlock(dataset, source, finer ? image : nullptr);
        }
        else if (copy->IsA("vtkHyperTreeGrid"))
        {
          ++this->BlocksWithout;
          this->Why = HyperTreeGridMessage;
        }
      });
    using SDDP = vtkStreamingDemandDrivenPipeline;
    if (!this->IsComposite && this->OutInfo->Has(SDDP::WHOLE_EXTENT()))
    {
      this->WholeExtent.resize(6);
      this->OutInfo->Get(SDDP::WHOLE_EXTENT(), this->WholeExtent.data());
    }
    if (this->IsComposite && this->Blocks.empty() && this->BlocksWithout > 0 &&
      !this->Self->Controller && this->Failure.empty())
    {
      this->Failure = this->Why;
    }
  }

  void Magnify(vtkImageData* image, vtkImageData* copy) const
  {
    int extent[6];
    if (!this->IsComposite)
    {
      this->OutInfo->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT(), extent);
    }
    noise::Magnify(
      image, copy, this->IsComposite ? nullptr : extent, this->Self->ResolvedMagnification);
  }

  /// `original`: what `dataset` was magnified from, or null.
  void AddBlock(vtkDataSet* dataset, vtkDataObject* source, vtkDataSet* original)
  {
    Block block;
    block.DataSet = dataset;
    block.Source = original ? dataset : source;
    std::string why;
    if (this->FindArray(block, why))
    {
      Block coarse;
      coarse.DataSet = original;
      if (original && this->FindArray(coarse, why) && coarse.Cells == block.Cells)
      {
        block.Original = original;
        block.OriginalArray = coarse.Array;
      }
      this->Blocks.push_back(block);
    }
    else if (dataset->GetNumberOfPoints() > 0)
    {
      this->Why = why;
      ++this->BlocksWithout;
      if (!this->IsComposite && this->Failure.empty())
      {
        this->Failure = why;
      }
    }
  }

  /// Finds the array of a block, if anything steers; false with `why` where there is none that can be used.
  bool FindArray(Block& block, std::string& why) const
  {
    vtkInformation* choice = this->Self->GetInputArrayInformation(0);
    if (!this->Self->IsSteered())
    {
      block.Cells = choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::CELL &&
        block.DataSet->GetNumberOfCells() > 0;
      return true;
    }
    block.Array = noise::FindSteeringArray(block.DataSet, choice, block.Cells, why);
    if (!block.Array)
    {
      why += " Noise without a direction needs none: set Direction to None.";
      return false;
    }
    return this->FindShapeArrays(block, why);
  }

  /// Arrays that properties come from; false with `why` where one is named that cannot be used.
  bool FindShapeArrays(Block& block, std::string& why) const
  {
    constexpr const char* names[] = { "StreakLength", "Strength", "EigenvalueSum" };
    vtkDataSetAttributes* attributes = GetAttributes(block.DataSet, block.Cells);
    for (int which = 0; which < 3; ++which)
    {
      const std::string name = noise::GetChosenName(
        this->Self->GetInputArrayInformation(STREAK_LENGTH_ARRAY + which));
      if (name.empty())
      {
        continue;
      }
      vtkDataArray* array = attributes->GetArray(name.c_str());
      if (!array || array->GetNumberOfComponents() > 3 ||
        array->GetNumberOfTuples() != block.Array->GetNumberOfTuples())
      {
        const char* place = block.Cells ? "cells" : "points";
        why = "Array '" + name + "' for " + names[which] +
          (array ? " has not 1 to 3 components with a value for each of the "
                 : " is not on the ") +
          place + ", where the vectors are. Choose another one, or convert it (" +
          (block.Cells ? "Point Data to Cell Data" : "Cell Data to Point Data") + ").";
        return false;
      }
      block.ShapeArrays[which] = array;
    }
    return true;
  }

  bool NeedsMagnitude() const
  {
    return this->Self->IsSteered() && this->Self->StrengthMode == MAGNITUDE &&
      this->Self->ReferenceMagnitude <= 0.0;
  }

  /// What ranks do together comes before anything that may fail on one of them.
  void AgreeAcrossRanks()
  {
    noise::CommonShape shape;
    for (const Block& block : this->Blocks)
    {
      shape.Add(block.DataSet, block.Cells, this->GetWholeExtent());
    }
    shape.Reduce(this->Self->Controller);
    for (Block& block : this->Blocks)
    {
      block.Shape = shape.Get(block.DataSet, block.Cells, this->GetWholeExtent());
    }
    this->Self->Kept->Blocks.Assign(this->Blocks,
      [](const Block& block) { return std::make_pair(block.Cells, block.Shape.Slab); });
    std::vector<noise::LengthSource> arrays;
    for (const Block& block : this->Blocks)
    {
      this->Sizes.Add(block.Known->GetSizes(block, this->Self->FeatureSize == 0.0));
      if (this->Self->IsSteered())
      {
        arrays.push_back({ block.GetOriginalArray(), block.GetOriginal(), block.Cells });
      }
    }
    this->Sizes.Reduce(this->Self->Controller);
    this->Lengths = noise::FindLengths(
      arrays, this->Self->MaskUpperThreshold, this->Self->Controller, this->NeedsMagnitude());
  }

  /// Automatic values.
  void Resolve()
  {
    if (this->Self->FeatureSize == 0.0)
    {
      this->Parameters.FeatureSize = this->Sizes.GetFeatureSize();
    }
    if (this->NeedsMagnitude())
    {
      this->Parameters.ReferenceMagnitude =
        this->Lengths.Longest > 0.0 ? this->Lengths.Longest : 1.0;
    }
    this->Self->ResolvedFeatureSize = this->Parameters.FeatureSize;
  }

  void Evaluate()
  {
    const double share = 1.0 / static_cast<double>(this->Blocks.size());
    noise::Attempt(this->Failure,
      [&]
      {
        for (std::size_t i = 0; i < this->Blocks.size() && !this->Self->GetAbortOutput(); ++i)
        {
          this->EvaluateBlock(this->Blocks[i],
            static_cast<double>(i) / static_cast<double>(this->Blocks.size()), share);
        }
      });
  }

  void EvaluateBlock(const Block& block, double progressStart, double progressShare)
  {
    steerable::NoiseParameters parameters = this->Parameters;
    const noise::Plane plane = this->Sizes.Bounds.GetPlane();
    const double limit = this->Lengths.Limit;
    const int magnification = block.Original ? this->Self->ResolvedMagnification : 1;
    noise::Samples samples(
      block.DataSet, block.Array, block.Cells, block.Shape, magnification, plane, limit,
      block.Known->GetFields(block, plane, limit));
    const noise::ShapeArrays& shapes = block.ShapeArrays;
    if (shapes[0] || shapes[1] || shapes[2])
    {
      samples.SetShapes(shapes);
    }
    const double threshold = parameters.MaskThreshold;
    if (this->Self->TensorUse != TENSOR_DIRECTION && block.Array &&
      noise::IsTensor(block.Array->GetNumberOfComponents()))
    {
      const double factor = this->Self->TensorUse == TENSOR_WORLD_METRIC
        ? parameters.FeatureSize * parameters.FeatureSize
        : 1.0;
      samples.TakeTensorsAsMetrics(factor);
      parameters.MaskThreshold *= factor;
      parameters.ReferenceMagnitude *= factor;
    }
    const steerable::SteerableNoise kernel(parameters, samples.GetDimension());
    if (parameters.FollowCurvature)
    {
      noise::WithThreads([&] { samples.ComputeCurvature(parameters.FeatureSize); });
    }
    noise::WithThreads([&] { samples.FindOrder(); });
    auto result =
      noise::NewOutputArray(this->Self->ResultArrayName, 1, samples.GetNumberOfSamples());
    float* values = result->GetPointer(0);
    steerable::EvaluationCounts counts = noise::ForEachPart(this->Self, samples.GetNumberOfParts(),
      samples.GetNumberOfSamples(), progressStart, progressShare,
      [&](std::size_t begin, std::size_t end)
      { return samples.Evaluate(kernel, begin, end, values); });
    if (this->Self->GetAbortOutput())
    {
      return; // half an array is none
    }
    this->Samples += samples.GetNumberOfSamples();
    const bool anyDegenerate = counts.Degenerate > 0;
    // What is left out has no direction; with a mask it is stagnant.
    const std::vector<unsigned char>& leftOut = samples.GetLeftOut();
    const auto leave = [](std::uint64_t& count, std::uint64_t out)
    { count -= std::min(count, out); };
    leave(parameters.MaskThreshold > 0.0 ? counts.Stagnant : counts.Degenerate,
      leftOut.size() - std::count(leftOut.begin(), leftOut.end(), 0));
    if (counts.Degenerate > 0)
    {
      leave(counts.Degenerate, CountDegenerateGhosts(block, leftOut));
    }
    this->Counts += counts;
    const vtkIdType tooLong =
      std::count(leftOut.begin(), leftOut.end(), noise::Samples::IsTooLong);
    this->TooLong += tooLong;
    if (anyDegenerate)
    {
      this->BadPlaces += CountBadPlaces(block.GetOriginal());
    }
    if (anyDegenerate || counts.Stagnant > 0 || tooLong > 0)
    {
      this->Blank(block, leftOut, threshold, values);
    }

    vtkDataSetAttributes* attributes = GetAttributes(block.DataSet, block.Cells);
    if (this->Self->OutputMetric)
    {
      vtkNew<vtkDoubleArray> metrics;
      metrics->SetName("Metric");
      metrics->SetNumberOfComponents(6);
      metrics->SetNumberOfTuples(samples.GetNumberOfSamples());
      double* tuples = metrics->GetPointer(0);
      const vtkIdType count = samples.GetNumberOfSamples();
      vtkSMPTools::For(0, count, 1024,
        [&](vtkIdType begin, vtkIdType end)
        { samples.EvaluateMetrics(parameters, begin, end, tuples); });
      attributes->AddArray(metrics);
    }
    attributes->AddArray(result);
    attributes->SetActiveScalars(this->Self->ResultArrayName);
  }

  /**
   * Gives BlankValue to the samples whose vector is zero, has no value, is at most `threshold` long or is too
   * long. Those along the normal of a surface have a value and keep their noise.
   */
  void Blank(const Block& block, const std::vector<unsigned char>& leftOut, double threshold,
    float* values) const
  {
    const int mode = this->Self->BlankValue;
    const float blank = mode == BLANK_NAN ? std::numeric_limits<float>::quiet_NaN() : 0.0f;
    vtkSmartPointer<vtkUnsignedCharArray> ghosts;
    if (mode == BLANK_HIDDEN)
    {
      ghosts = OwnGhosts(block);
    }
    const unsigned char flag =
      block.Cells ? +vtkDataSetAttributes::HIDDENCELL : +vtkDataSetAttributes::HIDDENPOINT;
    vtkSMPTools::For(0, block.Array->GetNumberOfTuples(), 4096,
      [&](vtkIdType begin, vtkIdType end)
      {
        for (vtkIdType i = begin; i < end; ++i)
        {
          const bool tooLong = !leftOut.empty() && leftOut[i] == noise::Samples::IsTooLong;
          // The kernel gives exactly 0 where the flow is stagnant, but not only there: noise has zeros, streaks gaps.
          double length = 0.0;
          if (threshold > 0.0 && values[i] == 0.0f)
          {
            noise::ReadLengths(block.Array, static_cast<std::size_t>(i), 1, &length);
          }
          const bool stagnant =
            threshold > 0.0 && values[i] == 0.0f && static_cast<float>(length) <= 1.000001f * threshold;
          if (tooLong || stagnant || !HasValue(block.Array, i))
          {
            values[i] = blank;
            if (ghosts)
            {
              ghosts->SetValue(i, ghosts->GetValue(i) | flag);
            }
          }
        }
      });
  }

  /// All ranks take part, after all have tried.
  void ShareCounts()
  {
    double all[2] = { static_cast<double>(this->Counts.Degenerate),
      static_cast<double>(this->Samples) };
    noise::Reduce(this->Self->Controller, all, 2, vtkCommunicator::SUM_OP);
    this->AllDegenerate = all[0];
    this->AllSamples = all[1];
  }

  /// One warning that says everything.
  void Report() const
  {
    const steerable::NoiseParameters& parameters = this->Parameters;
    const noise::LengthRange& lengths = this->Lengths;
    std::ostringstream message;
    if (lengths.Fills > 0.0 && this->TooLong > 0)
    {
      message << "\n"
              << this->TooLong << " samples hold " << lengths.FarValue
              << ", far more than all others (the longest vector is " << lengths.FarLongest
              << ", the next " << lengths.FarRest
              << "), as values do that stand for missing ones: they got 0 and count for nothing. "
                 "MaskUpperThreshold sets the limit by hand; 1e300 takes all of them.";
    }
    else if (lengths.Fills == 0.0 && lengths.FarCount > 0.0)
    {
      message << "\n"
              << lengths.FarCount << " vectors are far longer than all others: with components up to "
              << lengths.FarValue << ", " << lengths.FarLongest << " long, the next " << lengths.FarRest
              << ". If they stand for missing values, set MaskUpperThreshold "
              << 2.0 * lengths.FarRest << ".";
    }
    if (this->Counts.Bounded > 0)
    {
      const steerable::EigenvalueRange bounds = steerable::MetricBounds(parameters);
      message << "\n"
              << this->Counts.Bounded << " metrics had eigenvalues that are not from " << bounds.Along << " to "
              << bounds.Across
              << " in 1 / FeatureSize^2 and were bounded. Check TensorUse and FeatureSize: a streak reaches "
                 "1 / sqrt(eigenvalue) cells.";
    }
    // Every wall and body has a few, and a rank may hold nothing else; most of the data are a mistake.
    if (2.0 * this->AllDegenerate > this->AllSamples && this->Counts.Degenerate > 0)
    {
      message << "\n"
              << this->AllDegenerate << " of " << this->AllSamples
              << " samples have no direction (zero, NaN, infinite or along the surface's normal). "
                 "Check that the right array is chosen.";
    }
    if (this->BadPlaces > 0)
    {
      message << "\n"
              << this->BadPlaces
              << " points have coordinates that are not finite: noise at them and beside them means nothing. Clean the mesh.";
    }
    if (this->IsComposite && this->BlocksWithout > 0)
    {
      message << "\n"
              << this->BlocksWithout
              << " block(s) have no usable array and were passed on without noise. " << this->Why;
    }
    if (this->ImagesAsTheyAre > 0)
    {
      message << "\nMagnification leaves the " << this->ImagesAsTheyAre
              << " images of an AMR as they are: its levels say how fine they are. Resample to Image, or "
                 "Extract Level and Merge Blocks, first.";
    }
    const double smallest = this->Sizes.GetSmallestSize();
    const double finest =
      parameters.FeatureSize / std::pow(parameters.Lacunarity, parameters.Octaves - 1);
    if (finest < 0.999 * smallest)
    {
      message << "\nThe samples are " << this->Sizes.GetSampleSpacing()
              << " apart, too far for noise of FeatureSize " << finest
              << ". Set FeatureSize to at least " << smallest
              << ", refine the data (Magnification on images, Resample to Image, Subdivide), or show them as "
                 "Steerable Noise (the representation or vtkSteerableNoiseMapper), as fine as the picture.";
    }
    // Scripts from before StreakLength set these.
    const steerable::NoiseParameters defaults;
    if (!parameters.LatticeWindow &&
      (parameters.Quality != defaults.Quality ||
        parameters.MinimumEigenvalue != defaults.MinimumEigenvalue))
    {
      steerable::NoiseParameters paper = parameters;
      paper.LatticeWindow = true;
      message << "\nQuality and MinimumEigenvalue do not count without LatticeWindow. Set StreakLength ("
              << std::round(10.0 / std::sqrt(paper.GetAlongEigenvalue())) / 10.0
              << " is as long), or LatticeWindow 1 and EigenvalueSum 4 for the noise they gave before.";
    }
    if (!message.str().empty())
    {
      vtkWarningWithObjectMacro(this->Self, << message.str().substr(1));
    }
  }
};

//------------------------------------------------------------------------------
vtkSteerableNoiseFilter::vtkSteerableNoiseFilter()
{
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::VECTORS);
  this->SetResultArrayName("SteerableNoise");
  this->SetController(vtkMultiProcessController::GetGlobalController());
  this->Kept.reset(new KeptBlocks);
}

//------------------------------------------------------------------------------
vtkSteerableNoiseFilter::~vtkSteerableNoiseFilter()
{
  this->SetResultArrayName(nullptr);
  this->SetController(nullptr);
}

//------------------------------------------------------------------------------
void vtkSteerableNoiseFilter::SetKeepFields(bool keepFields)
{
  // No reason to execute again.
  this->KeepFields = keepFields;
  if (!keepFields)
  {
    this->Kept->Blocks.Clear();
  }
}

//------------------------------------------------------------------------------
void vtkSteerableNoiseFilter::SetPhase(double phase)
{
  phase = std::isfinite(phase) ? phase - std::floor(phase) : 0.0;
  if (this->Phase != phase)
  {
    this->Phase = phase;
    this->Modified();
  }
}

//------------------------------------------------------------------------------
int vtkSteerableNoiseFilter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  // Taken in order to be refused with a sentence.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid");
  return 1;
}

//------------------------------------------------------------------------------
int vtkSteerableNoiseFilter::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  using SDDP = vtkStreamingDemandDrivenPipeline;
  double only = 0.0;
  if (this->TimePeriod > 0.0 && IsSteady(inInfo, only))
  {
    // The period's end is its start again: with it, a film that loops would stand still for a frame.
    std::vector<double> steps(static_cast<std::size_t>(this->TimeSteps));
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
      steps[i] = only + this->TimePeriod * static_cast<double>(i) / static_cast<double>(steps.size());
    }
    const double range[2] = { only, only + this->TimePeriod };
    outInfo->Set(SDDP::TIME_STEPS(), steps.data(), this->TimeSteps);
    outInfo->Set(SDDP::TIME_RANGE(), range, 2);
  }
  else if (!inInfo->Has(SDDP::TIME_RANGE()))
  {
    outInfo->Remove(SDDP::TIME_RANGE());
  }
  this->ResolvedMagnification = std::max(this->Magnification, 1);
  if (vtkImageData::GetData(inInfo))
  {
    if (this->Magnification == 0)
    {
      this->ResolvedMagnification = noise::GetAutomaticMagnification(
        inInfo, this->FeatureSize, std::pow(this->Lacunarity, this->Octaves - 1));
    }
    if (this->ResolvedMagnification > 1)
    {
      noise::MagnifyInformation(inInfo, outInfo, this->ResolvedMagnification);
    }
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkSteerableNoiseFilter::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  using SDDP = vtkStreamingDemandDrivenPipeline;
  double only = 0.0;
  if (this->TimePeriod > 0.0 && inInfo->Has(SDDP::TIME_STEPS()) && IsSteady(inInfo, only))
  {
    inInfo->Set(SDDP::UPDATE_TIME_STEP(), only); // there is no other: nothing is read again
  }
  const bool magnify = this->ResolvedMagnification > 1 && vtkImageData::GetData(inInfo);
  // Curvature looks at the next samples, and so does interpolation.
  const int border = (this->FollowCurvature && this->IsSteered() ? 1 : 0) + (magnify ? 1 : 0);
  inInfo->Set(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS(),
    outInfo->Get(SDDP::UPDATE_NUMBER_OF_GHOST_LEVELS()) + border);
  if (inInfo->Has(SDDP::WHOLE_EXTENT()) && outInfo->Has(SDDP::UPDATE_EXTENT()))
  {
    int whole[6];
    int extent[6];
    inInfo->Get(SDDP::WHOLE_EXTENT(), whole);
    outInfo->Get(SDDP::UPDATE_EXTENT(), extent);
    const int fine = magnify ? this->ResolvedMagnification : 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int low = static_cast<int>(std::floor(double(extent[2 * axis]) / fine)) - border;
      const int high = static_cast<int>(std::ceil(double(extent[2 * axis + 1]) / fine)) + border;
      extent[2 * axis] = std::max(low, whole[2 * axis]);
      extent[2 * axis + 1] = std::min(high, whole[2 * axis + 1]);
    }
    inInfo->Set(SDDP::UPDATE_EXTENT(), extent, 6);
  }
  return 1;
}

//------------------------------------------------------------------------------
int vtkSteerableNoiseFilter::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* inInfo = inputVector[0]->GetInformationObject(0);
  vtkInformation* outInfo = outputVector->GetInformationObject(0);
  vtkDataObject* input = vtkDataObject::GetData(inInfo);
  vtkDataObject* output = vtkDataObject::GetData(outInfo);
  using SDDP = vtkStreamingDemandDrivenPipeline;

  const auto refuse = [&](const std::string& why) { return noise::Refuse(this, output, why); };
  if (!this->ResultArrayName || !*this->ResultArrayName)
  {
    return refuse("ResultArrayName is empty. Give the noise array a name.");
  }

  if (input->IsA("vtkHyperTreeGrid"))
  {
    return refuse(HyperTreeGridMessage);
  }

  const noise::AtEnd forget(
    [this]
    {
      if (!this->KeepFields)
      {
        this->Kept->Blocks.Clear();
      }
    });

  Execution run(this, outInfo);
  run.CollectBlocks(input, output);
  run.AgreeAcrossRanks();
  run.Resolve();
  if (run.Failure.empty() && !run.Blocks.empty())
  {
    run.Evaluate();
  }
  run.ShareCounts();
  if (!run.Failure.empty())
  {
    return refuse(run.Failure);
  }
  if (run.Blocks.empty())
  {
    run.Report();
    return 1;
  }
  if (!run.IsComposite)
  {
    noise::CropToUpdateExtent(vtkDataSet::SafeDownCast(output), outInfo);
  }
  if (this->TimePeriod > 0.0 && outInfo->Has(SDDP::UPDATE_TIME_STEP()))
  {
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), GetTime(outInfo));
  }
  this->NumberOfDegenerateSamples = static_cast<vtkIdType>(run.Counts.Degenerate);
  this->NumberOfStagnantSamples = static_cast<vtkIdType>(run.Counts.Stagnant);
  this->NumberOfOverlongSamples = run.TooLong;
  run.Report();
  return 1;
}

//------------------------------------------------------------------------------
void vtkSteerableNoiseFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Model: " << this->Model << "\n";
  os << indent << "Direction: " << this->Direction << "\n";
  os << indent << "TensorUse: " << this->TensorUse << "\n";
  os << indent << "FeatureSize: " << this->FeatureSize << "\n";
  os << indent << "ResolvedFeatureSize: " << this->ResolvedFeatureSize << "\n";
  os << indent << "StreakLength: " << this->StreakLength << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "MinimumEigenvalue: " << this->MinimumEigenvalue << "\n";
  os << indent << "EigenvalueSum: " << this->EigenvalueSum << "\n";
  os << indent << "LatticeWindow: " << this->LatticeWindow << "\n";
  os << indent << "AnisotropicWeight: " << this->AnisotropicWeight << "\n";
  os << indent << "MetricInProjection: " << this->MetricInProjection << "\n";
  os << indent << "Strength: " << this->Strength << "\n";
  os << indent << "StrengthMode: " << this->StrengthMode << "\n";
  os << indent << "ReferenceMagnitude: " << this->ReferenceMagnitude << "\n";
  os << indent << "Normalization: " << this->Normalization << "\n";
  os << indent << "FollowCurvature: " << this->FollowCurvature << "\n";
  os << indent << "Basis: " << this->Basis << "\n";
  os << indent << "Density: " << this->Density << "\n";
  os << indent << "Phase: " << this->Phase << "\n";
  os << indent << "Animate: " << this->Animate << "\n";
  os << indent << "Speed: " << this->Speed << "\n";
  os << indent << "TimePeriod: " << this->TimePeriod << "\n";
  os << indent << "TimeSteps: " << this->TimeSteps << "\n";
  os << indent << "Octaves: " << this->Octaves << "\n";
  os << indent << "Lacunarity: " << this->Lacunarity << "\n";
  os << indent << "Gain: " << this->Gain << "\n";
  os << indent << "Turbulence: " << this->Turbulence << "\n";
  os << indent << "Fade: " << this->Fade << "\n";
  os << indent << "Falloff: " << this->Falloff << "\n";
  os << indent << "Lattice: " << this->Lattice << "\n";
  os << indent << "GradientSet: " << this->GradientSet << "\n";
  os << indent << "Period: " << this->Period[0] << " " << this->Period[1] << " " << this->Period[2]
     << "\n";
  os << indent << "Magnification: " << this->Magnification << "\n";
  os << indent << "ResolvedMagnification: " << this->ResolvedMagnification << "\n";
  os << indent << "MaskThreshold: " << this->MaskThreshold << "\n";
  os << indent << "MaskUpperThreshold: " << this->MaskUpperThreshold << "\n";
  os << indent << "BlankValue: " << this->BlankValue << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
  os << indent << "ResultArrayName: " << (this->ResultArrayName ? this->ResultArrayName : "(none)")
     << "\n";
  os << indent << "KeepFields: " << this->KeepFields << "\n";
  os << indent << "OutputMetric: " << this->OutputMetric << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
