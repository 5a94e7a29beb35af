// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseImages.h"

#include "NoiseBounds.h"
#include "NoiseGhosts.h"

#include "vtkArrayListTemplate.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSMPTools.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace noise
{
namespace
{
using SDDP = vtkStreamingDemandDrivenPipeline;

/// Where a fine sample lies between two coarse ones along one axis.
struct Between
{
  vtkIdType Low;
  vtkIdType High;
  double Share;
};

Between Locate(double place, int count)
{
  const double inside = std::min(std::max(place, 0.0), count - 1.0);
  const auto low = static_cast<vtkIdType>(std::floor(inside));
  return { low, std::min<vtkIdType>(low + 1, count - 1), inside - low };
}

/// Calls visit(x, y, z, sample) for all samples of a fine lattice, with their places on a coarse one, on threads.
template <typename Place, typename Visit>
void ForEachSample(const int coarse[3], const int fine[3], Place&& place, Visit&& visit)
{
  vtkSMPTools::For(0, static_cast<vtkIdType>(fine[1]) * fine[2],
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType row = begin; row < end; ++row)
      {
        const int jk[2] = { static_cast<int>(row % fine[1]), static_cast<int>(row / fine[1]) };
        const Between y = Locate(place(1, jk[0]), coarse[1]);
        const Between z = Locate(place(2, jk[1]), coarse[2]);
        for (int i = 0; i < fine[0]; ++i)
        {
          visit(Locate(place(0, i), coarse[0]), y, z, row * fine[0] + i);
        }
      }
    });
}

/**
 * Interpolates all arrays of `list` from a coarse lattice to a fine one. Samples that are `hidden` (one value for
 * each, or empty) have no part in those between them and others.
 */
template <typename Place>
void Interpolate(ArrayList& list, const int coarse[3], const int fine[3],
  const std::vector<unsigned char>& hidden, Place&& place)
{
  ForEachSample(coarse, fine, place,
    [&](const Between& x, const Between& y, const Between& z, vtkIdType sample)
    {
      vtkIdType ids[8];
      double weights[8];
      int used = 0;
      double seen = 0.0;
      for (int corner = 0; corner < 8; ++corner)
      {
        const double weight = (corner & 1 ? x.Share : 1.0 - x.Share) *
          (corner & 2 ? y.Share : 1.0 - y.Share) * (corner & 4 ? z.Share : 1.0 - z.Share);
        if (!(weight > 0.0))
        {
          continue; // 0 times NaN is NaN
        }
        const vtkIdType cx = corner & 1 ? x.High : x.Low;
        const vtkIdType cy = corner & 2 ? y.High : y.Low;
        const vtkIdType cz = corner & 4 ? z.High : z.Low;
        ids[used] = (cz * coarse[1] + cy) * coarse[0] + cx;
        weights[used++] = weight;
        seen += hidden.empty() || hidden[ids[used - 1]] ? 0.0 : weight;
      }
      for (int n = used - 1; seen > 0.0 && n >= 0; --n)
      {
        weights[n] /= seen;
        if (hidden[ids[n]])
        {
          std::swap(ids[n], ids[used - 1]);
          std::swap(weights[n], weights[--used]);
        }
      }
      list.Interpolate(used, ids, weights, sample);
    });
}

/**
 * Flags and labels on points: of the nearest, and of vtkGhostType what holds for the samples in between. Next
 * to a hidden one they are hidden; between two of another piece they are duplicates.
 */
template <typename Place>
void CopyLabels(vtkPointData* from, vtkPointData* to, const int coarse[3], const int fine[3],
  Place&& place)
{
  for (int n = 0; n < to->GetNumberOfArrays(); ++n)
  {
    vtkDataArray* labels = to->GetArray(n);
    vtkDataArray* source = labels ? from->GetArray(labels->GetName()) : nullptr;
    if (!source || source->GetNumberOfComponents() != 1 || source->GetDataType() == VTK_FLOAT ||
      source->GetDataType() == VTK_DOUBLE)
    {
      continue;
    }
    auto* ghosts = vtkUnsignedCharArray::SafeDownCast(source);
    const bool isGhost = ghosts &&
      std::string(vtkDataSetAttributes::GhostArrayName()) ==
        (labels->GetName() ? labels->GetName() : "");
    ForEachSample(coarse, fine, place,
      [&](const Between& x, const Between& y, const Between& z, vtkIdType sample)
      {
        const auto at = [&](bool a, bool b, bool c)
        {
          return ((c ? z.High : z.Low) * coarse[1] + (b ? y.High : y.Low)) * coarse[0] +
            (a ? x.High : x.Low);
        };
        if (!isGhost)
        {
          labels->SetTuple(sample, at(x.Share > 0.5, y.Share > 0.5, z.Share > 0.5), source);
          return;
        }
        unsigned char any = 0;
        unsigned char all = 0xff;
        for (int corner = 0; corner < 8; ++corner)
        {
          const bool a = corner & 1 && x.Share > 0.0;
          const bool b = corner & 2 && y.Share > 0.0;
          const bool c = corner & 4 && z.Share > 0.0;
          const unsigned char ghost = ghosts->GetValue(at(a, b, c));
          any |= ghost;
          all &= ghost;
        }
        const unsigned char hidden = vtkDataSetAttributes::HIDDENPOINT;
        labels->SetComponent(sample, 0, (any & hidden) | (all & ~hidden));
      });
  }
}

/// Samples of a magnified image with so many points along each axis, all of them asked for.
double CountMagnified(const int (&points)[3], int factor)
{
  double count = 1.0;
  for (const int along : points)
  {
    count *= along > 0 ? (along - 1) * factor + 1 : 0;
  }
  return count;
}

/// Whole extent and spacing of an image before there is one.
void GetGrid(vtkInformation* info, int (&whole)[6], double (&spacing)[3])
{
  info->Get(SDDP::WHOLE_EXTENT(), whole);
  std::fill_n(spacing, 3, 1.0);
  if (info->Has(vtkDataObject::SPACING()))
  {
    info->Get(vtkDataObject::SPACING(), spacing);
  }
}
} // namespace

void MagnifyInformation(vtkInformation* inInfo, vtkInformation* outInfo, int factor)
{
  int whole[6];
  double spacing[3];
  GetGrid(inInfo, whole, spacing);
  for (int axis = 0; axis < 3; ++axis)
  {
    // A flat axis stays flat; the others keep their first and last sample.
    const bool flat = whole[2 * axis] == whole[2 * axis + 1];
    if (whole[2 * axis] > whole[2 * axis + 1])
    {
      continue; // empty stays empty: (0, -1) times 4 is no extent
    }
    whole[2 * axis] *= factor;
    whole[2 * axis + 1] *= factor;
    spacing[axis] /= factor;
    if (flat)
    {
      whole[2 * axis + 1] = whole[2 * axis];
    }
  }
  outInfo->Set(SDDP::WHOLE_EXTENT(), whole, 6);
  outInfo->Set(vtkDataObject::SPACING(), spacing, 3);
}

int GetAutomaticMagnification(vtkInformation* inInfo, double featureSize, double fineness)
{
  constexpr double mostSamples = 4194304.0;
  constexpr int mostFactor = 16;
  int whole[6];
  double spacing[3];
  GetGrid(inInfo, whole, spacing);
  int points[3];
  double bounds[6];
  double farthest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int cells = whole[2 * axis + 1] - whole[2 * axis];
    points[axis] = cells + 1;
    bounds[2 * axis] = 0.0;
    bounds[2 * axis + 1] = cells * std::abs(spacing[axis]);
    farthest = cells > 0 ? std::max(farthest, std::abs(spacing[axis])) : farthest;
  }
  CommonBounds common;
  common.Add(bounds);
  const double size = (featureSize > 0.0 ? featureSize : common.GetFeatureSize(0.0)) / fineness;
  const double wanted = std::ceil(6.0 * farthest / size);
  int factor = wanted >= 1.0 ? static_cast<int>(std::min<double>(wanted, mostFactor)) : 1;
  while (factor > 1 && CountMagnified(points, factor) > mostSamples)
  {
    --factor;
  }
  return factor;
}

void CheckMemory(const std::vector<vtkImageData*>& images, int factor)
{
  double points = 0.0;
  double bytes = 0.0;
  for (vtkImageData* image : images)
  {
    int coarse[3];
    image->GetDimensions(coarse);
    const double fine = CountMagnified(coarse, factor);
    double perPoint = sizeof(float); // the noise
    for (vtkDataSetAttributes* attributes : { static_cast<vtkDataSetAttributes*>(
                                                image->GetPointData()),
           static_cast<vtkDataSetAttributes*>(image->GetCellData()) })
    {
      for (int n = 0; n < attributes->GetNumberOfArrays(); ++n)
      {
        if (vtkDataArray* array = attributes->GetArray(n))
        {
          perPoint += double(array->GetDataTypeSize()) * array->GetNumberOfComponents();
        }
      }
    }
    points += fine;
    bytes += fine * perPoint;
  }
  bool fits = bytes < double(std::numeric_limits<std::ptrdiff_t>::max());
  if (fits)
  {
    // The functions, not an expression with new: compilers may leave out such a one and its delete, as g++ 16 does.
    void* room = ::operator new(static_cast<std::size_t>(bytes), std::nothrow);
    fits = room != nullptr;
    ::operator delete(room);
  }
  if (!fits)
  {
    std::ostringstream message;
    message << "Magnification " << factor << " makes " << points << " samples, "
            << std::ceil(bytes / 1e9) << " GB with all arrays, more than there is. Lower Magnification.";
    throw std::runtime_error(message.str());
  }
}

void Magnify(vtkImageData* input, vtkImageData* output, const int* updateExtent, int factor)
{
  int coarseExtent[6];
  input->GetExtent(coarseExtent);
  int extent[6];
  for (int i = 0; i < 6; ++i)
  {
    extent[i] = updateExtent ? updateExtent[i] : coarseExtent[i] * factor;
  }
  if (input->GetNumberOfPoints() == 0)
  {
    output->ShallowCopy(input);
    return;
  }
  double spacing[3];
  int fineDims[3];
  int coarseDims[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    // What the input covers, even if a source gave less than it was asked for.
    extent[2 * axis] = std::max(extent[2 * axis] - factor, coarseExtent[2 * axis] * factor);
    extent[2 * axis + 1] =
      std::min(extent[2 * axis + 1] + factor, coarseExtent[2 * axis + 1] * factor);
    spacing[axis] = input->GetSpacing()[axis] / factor;
    fineDims[axis] = std::max(extent[2 * axis + 1] - extent[2 * axis] + 1, 0);
    coarseDims[axis] = coarseExtent[2 * axis + 1] - coarseExtent[2 * axis] + 1;
  }
  output->SetExtent(extent);
  output->SetSpacing(spacing);
  output->SetOrigin(input->GetOrigin());
  output->SetDirectionMatrix(input->GetDirectionMatrix());
  output->GetFieldData()->PassData(input->GetFieldData());
  if (output->GetNumberOfPoints() == 0)
  {
    return;
  }

  const auto coarsePlace = [&](int axis, int index)
  { return double(extent[2 * axis] + index) / factor - coarseExtent[2 * axis]; };
  {
    vtkPointData* out = output->GetPointData();
    out->InterpolateAllocate(input->GetPointData(), output->GetNumberOfPoints());
    out->SetNumberOfTuples(output->GetNumberOfPoints());
    ArrayList list;
    list.AddArrays(output->GetNumberOfPoints(), input->GetPointData(), out, 0.0, false);
    // Of points nothing is left out: between a hidden one and others the fine ones are hidden too.
    Interpolate(list, coarseDims, fineDims, {}, coarsePlace);
    CopyLabels(input->GetPointData(), out, coarseDims, fineDims, coarsePlace);
  }
  vtkCellData* out = output->GetCellData();
  if (input->GetNumberOfCells() == 0 || output->GetNumberOfCells() == 0)
  {
    return;
  }
  int fineCells[3];
  int coarseCells[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    fineCells[axis] = std::max(fineDims[axis] - 1, 1);
    coarseCells[axis] = std::max(coarseDims[axis] - 1, 1);
  }
  const auto cellPlace = [&](int axis, int index)
  {
    return coarseDims[axis] > 1
      ? (extent[2 * axis] + index + 0.5) / factor - coarseExtent[2 * axis] - 0.5
      : 0.0;
  };
  // Labels and scalars of a cell are repeated: interpolated ones would be something else.
  vtkNew<vtkCellData> smooth;
  vtkNew<vtkCellData> repeated;
  smooth->CopyAllOn();
  for (int i = 0; i < input->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = input->GetCellData()->GetArray(i);
    if (!array)
    {
      continue;
    }
    const int components = array->GetNumberOfComponents();
    const bool steers = (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE) &&
      components >= 2 && components <= 9;
    (steers ? smooth : repeated)->AddArray(array);
  }
  const vtkIdType count = output->GetNumberOfCells();
  const std::vector<unsigned char> none;
  const HiddenSamples hiddenSamples(input);
  const auto fill =
    [&](vtkCellData* from, const std::vector<unsigned char>& hidden, auto&& place)
  {
    vtkNew<vtkCellData> to;
    to->InterpolateAllocate(from, count);
    to->SetNumberOfTuples(count);
    ArrayList list;
    list.AddArrays(count, from, to, 0.0, false);
    Interpolate(list, coarseCells, fineCells, hidden, place);
    for (int i = 0; i < to->GetNumberOfArrays(); ++i)
    {
      out->AddArray(to->GetArray(i));
    }
  };
  fill(smooth, hiddenSamples.Get(true), cellPlace);
  fill(repeated, none, [&](int axis, int index) { return std::round(cellPlace(axis, index)); });
  for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
  {
    if (vtkAbstractArray* active = input->GetCellData()->GetAbstractAttribute(attribute))
    {
      out->SetActiveAttribute(active->GetName(), attribute);
    }
  }
}

void CropToUpdateExtent(vtkDataSet* output, vtkInformation* outInfo)
{
  // A request for one piece of several leaves an older request for an extent standing.
  if (!outInfo->Has(SDDP::UPDATE_EXTENT()) || outInfo->Get(SDDP::UPDATE_NUMBER_OF_PIECES()) > 1)
  {
    return;
  }
  int extent[6];
  outInfo->Get(SDDP::UPDATE_EXTENT(), extent);
  if (auto* image = vtkImageData::SafeDownCast(output))
  {
    image->Crop(extent);
  }
  else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(output))
  {
    rectilinear->Crop(extent);
  }
  else if (auto* structured = vtkStructuredGrid::SafeDownCast(output))
  {
    structured->Crop(extent);
  }
}
} // namespace noise
