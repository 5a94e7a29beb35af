// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseArrays.h"

#include "TupleFloats.h"

#include "SteeringChoice.h"
#include "SurfaceFields.h"

#include "vtkArrayDispatch.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <sstream>
#include <type_traits>
#include <utility>

namespace noise
{
namespace
{
/// Tuples of any array as doubles, one after the other.
struct CopyTuples
{
  template <typename ArrayT, typename Visit>
  void operator()(ArrayT* array, std::size_t first, std::size_t count, Visit&& visit) const
  {
    const auto begin = static_cast<vtkIdType>(first);
    const auto range =
      vtk::DataArrayTupleRange(array, begin, begin + static_cast<vtkIdType>(count));
    const int components = array->GetNumberOfComponents();
    double tuple[9] = {};
    std::size_t i = 0;
    for (const auto values : range)
    {
      for (int c = 0; c < components; ++c)
      {
        tuple[c] = static_cast<double>(values[c]);
      }
      visit(i++, tuple);
    }
  }
};

template <typename Visit>
void ForEachTuple(vtkDataArray* array, std::size_t first, std::size_t count, Visit&& visit)
{
  using Dispatcher = vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>;
  const CopyTuples worker;
  if (!Dispatcher::Execute(array, worker, first, count, visit))
  {
    worker(array, first, count, visit);
  }
}

using steerable::ToFloats;

class VectorReader : public steerable::TupleReader<float>
{
public:
  VectorReader(vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane)
    : Array(array)
    , InAxes(axes)
    , TwoAxes(inPlane ? WorldPlane : plane)
    , Rotated(axes != WorldAxes && !(inPlane && array->GetNumberOfComponents() == 2))
  {
  }

  const float* Read(std::size_t first, std::size_t count, float* scratch) const override
  {
    const int components = this->Array->GetNumberOfComponents();
    ForEachTuple(this->Array, first, count,
      [&](std::size_t i, const double* tuple)
      {
        double vector[3] = { tuple[0], tuple[1], components > 2 ? tuple[2] : 0.0 };
        if (components == 2 && this->TwoAxes != WorldPlane)
        {
          vector[0] = vector[1] = 0.0;
          vector[this->TwoAxes[0]] = tuple[0];
          vector[this->TwoAxes[1]] = tuple[1];
        }
        if (this->Rotated)
        {
          const double world[3] = { vector[0], vector[1], vector[2] };
          for (int row = 0; row < 3; ++row)
          {
            vector[row] = 0.0;
            for (int c = 0; c < 3; ++c)
            {
              // Not 0 times NaN: what the axis does not see does not matter.
              vector[row] += this->InAxes[row][c] != 0.0 ? this->InAxes[row][c] * world[c] : 0.0;
            }
          }
        }
        ToFloats(vector, 3, scratch + 3 * i);
      });
    return scratch;
  }

private:
  vtkDataArray* Array;
  Axes InAxes;
  Plane TwoAxes;
  bool Rotated;
};

/// Floats for tensors of any size, of which the direction counts; doubles for metrics, times a factor.
template <typename Value>
class TensorReader : public steerable::TupleReader<Value>
{
public:
  TensorReader(
    vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane, double factor = 1.0)
    : Array(array)
    , InAxes(axes)
    , TwoAxes(inPlane ? WorldPlane : plane)
    , Rotated(axes != WorldAxes && !(inPlane && array->GetNumberOfComponents() == 4))
    , FillsThird(!inPlane)
    , Factor(factor)
  {
  }

  const Value* Read(std::size_t first, std::size_t count, Value* scratch) const override
  {
    const int components = this->Array->GetNumberOfComponents();
    ForEachTuple(this->Array, first, count,
      [&](std::size_t i, const double* t)
      {
        double full[3][3] = {};
        if (components == 4)
        {
          const int a = this->TwoAxes[0];
          const int b = this->TwoAxes[1];
          full[a][a] = t[0];
          full[a][b] = full[b][a] = 0.5 * (t[1] + t[2]);
          full[b][b] = t[3];
          if (std::is_same_v<Value, double> && this->FillsThird)
          {
            // A metric needs a third axis: as far as the mean of the two.
            full[3 - a - b][3 - a - b] = 0.5 * (t[0] + t[3]);
          }
        }
        else if (components == 6)
        {
          full[0][0] = t[0];
          full[1][1] = t[1];
          full[2][2] = t[2];
          full[0][1] = full[1][0] = t[3];
          full[1][2] = full[2][1] = t[4];
          full[0][2] = full[2][0] = t[5];
        }
        else
        {
          for (int row = 0; row < 3; ++row)
          {
            for (int c = 0; c < 3; ++c)
            {
              full[row][c] = 0.5 * (t[3 * row + c] + t[3 * c + row]);
            }
          }
        }
        const auto get = [&](int row, int column)
        {
          if (!this->Rotated)
          {
            return full[row][column];
          }
          double sum = 0.0;
          for (int a = 0; a < 3; ++a)
          {
            for (int b = 0; b < 3; ++b)
            {
              const double factor = this->InAxes[row][a] * this->InAxes[column][b];
              sum += factor != 0.0 ? factor * full[a][b] : 0.0;
            }
          }
          return sum;
        };
        const double symmetric[6] = { get(0, 0), get(1, 1), get(2, 2), get(0, 1), get(1, 2),
          get(0, 2) };
        if constexpr (std::is_same_v<Value, double>)
        {
          std::transform(symmetric, symmetric + 6, scratch + 6 * i,
            [this](double value) { return this->Factor * value; });
        }
        else
        {
          ToFloats(symmetric, 6, scratch + 6 * i);
        }
      });
    return scratch;
  }

private:
  vtkDataArray* Array;
  Axes InAxes;
  Plane TwoAxes;
  bool Rotated;
  bool FillsThird;
  double Factor;
};

template <typename Value>
class LeavingOutReader : public steerable::TupleReader<Value>
{
public:
  LeavingOutReader(std::unique_ptr<steerable::TupleReader<Value>> reader, int components,
    const std::vector<unsigned char>& left)
    : Reader(std::move(reader))
    , Components(components)
    , Left(left)
  {
  }
  const Value* Read(std::size_t first, std::size_t count, Value* scratch) const override
  {
    const Value* tuples = this->Reader->Read(first, count, scratch);
    const auto values = static_cast<std::ptrdiff_t>(count * this->Components);
    if (tuples != scratch)
    {
      std::copy(tuples, tuples + values, scratch);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      if (this->Left[first + i])
      {
        std::fill_n(scratch + i * this->Components, this->Components,
          std::numeric_limits<Value>::quiet_NaN());
      }
    }
    return scratch;
  }

private:
  std::unique_ptr<steerable::TupleReader<Value>> Reader;
  std::size_t Components;
  const std::vector<unsigned char>& Left;
};

class ShapeReader : public steerable::TupleReader<float>
{
public:
  explicit ShapeReader(const ShapeArrays& arrays)
    : Arrays(arrays)
  {
  }
  const float* Read(std::size_t first, std::size_t count, float* scratch) const override
  {
    std::fill_n(scratch, 3 * count, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t which = 0; which < this->Arrays.size(); ++which)
    {
      vtkDataArray* array = this->Arrays[which];
      if (!array)
      {
        continue;
      }
      const bool scalar = array->GetNumberOfComponents() == 1;
      ForEachTuple(array, first, count,
        [&](std::size_t i, const double* t)
        {
          const double value =
            scalar ? t[0] : std::sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
          scratch[3 * i + which] = static_cast<float>(value);
        });
    }
    return scratch;
  }

private:
  ShapeArrays Arrays;
};

/// Floats as doubles, three each.
class FloatPositionReader : public steerable::TupleReader<double>
{
public:
  explicit FloatPositionReader(const float* values)
    : Values(values)
  {
  }
  const double* Read(std::size_t first, std::size_t count, double* scratch) const override
  {
    std::copy_n(this->Values + 3 * first, 3 * count, scratch);
    return scratch;
  }

private:
  const float* Values;
};

class PositionReader : public steerable::TupleReader<double>
{
public:
  explicit PositionReader(vtkDataArray* array)
    : Array(array)
  {
  }
  const double* Read(std::size_t first, std::size_t count, double* scratch) const override
  {
    ForEachTuple(this->Array, first, count,
      [&](std::size_t i, const double* tuple) { std::copy(tuple, tuple + 3, scratch + 3 * i); });
    return scratch;
  }

private:
  vtkDataArray* Array;
};

class DataSetPositionReader : public steerable::TupleReader<double>
{
public:
  explicit DataSetPositionReader(vtkDataSet* dataset)
    : DataSet(dataset)
  {
  }
  const double* Read(std::size_t first, std::size_t count, double* scratch) const override
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      this->DataSet->GetPoint(static_cast<vtkIdType>(first + i), scratch + 3 * i);
    }
    return scratch;
  }

private:
  vtkDataSet* DataSet;
};
} // namespace

std::unique_ptr<steerable::TupleReader<float>> MakeVectorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane)
{
  auto* floats = vtkFloatArray::FastDownCast(array);
  if (floats && floats->GetNumberOfComponents() == 3 && axes == WorldAxes)
  {
    return std::make_unique<steerable::ContiguousReader<float, 3>>(floats->GetPointer(0));
  }
  return std::make_unique<VectorReader>(array, axes, inPlane, plane);
}

std::unique_ptr<steerable::TupleReader<float>> MakeTensorReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane)
{
  return std::make_unique<TensorReader<float>>(array, axes, inPlane, plane);
}

std::unique_ptr<steerable::TupleReader<double>> MakeMetricReader(
  vtkDataArray* array, const Axes& axes, bool inPlane, const Plane& plane, double factor)
{
  return std::make_unique<TensorReader<double>>(array, axes, inPlane, plane, factor);
}

std::string GetChosenName(vtkInformation* choice)
{
  const char* name =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  return name && std::strcmp(name, "None") != 0 ? name : "";
}

std::unique_ptr<steerable::TupleReader<float>> MakeShapeReader(const ShapeArrays& arrays)
{
  return std::make_unique<ShapeReader>(arrays);
}

std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataArray* array)
{
  if (auto* doubles = vtkDoubleArray::FastDownCast(array))
  {
    return std::make_unique<steerable::ContiguousReader<double, 3>>(doubles->GetPointer(0));
  }
  if (auto* floats = vtkFloatArray::FastDownCast(array))
  {
    return std::make_unique<FloatPositionReader>(floats->GetPointer(0));
  }
  return std::make_unique<PositionReader>(array);
}

std::unique_ptr<steerable::TupleReader<double>> MakePositionReader(vtkDataSet* dataset)
{
  return std::make_unique<DataSetPositionReader>(dataset);
}

std::unique_ptr<steerable::TupleReader<float>> LeaveOut(
  std::unique_ptr<steerable::TupleReader<float>> reader, int components,
  const std::vector<unsigned char>& left)
{
  return std::make_unique<LeavingOutReader<float>>(std::move(reader), components, left);
}

std::unique_ptr<steerable::TupleReader<double>> LeaveOut(
  std::unique_ptr<steerable::TupleReader<double>> reader, int components,
  const std::vector<unsigned char>& left)
{
  return std::make_unique<LeavingOutReader<double>>(std::move(reader), components, left);
}

void ReadLengths(vtkDataArray* array, std::size_t first, std::size_t count, double* lengths)
{
  const int components = array->GetNumberOfComponents();
  ForEachTuple(array, first, count,
    [&](std::size_t i, const double* t)
    {
      double sum = 0.0;
      if (components == 4)
      {
        sum = t[0] * t[0] + t[3] * t[3] + 0.5 * (t[1] + t[2]) * (t[1] + t[2]);
      }
      else if (components == 6)
      {
        sum = t[0] * t[0] + t[1] * t[1] + t[2] * t[2] +
          2.0 * (t[3] * t[3] + t[4] * t[4] + t[5] * t[5]);
      }
      else if (components == 9)
      {
        for (int row = 0; row < 3; ++row)
        {
          for (int c = 0; c < 3; ++c)
          {
            const double mean = 0.5 * (t[3 * row + c] + t[3 * c + row]);
            sum += mean * mean;
          }
        }
      }
      else
      {
        sum = components > 2 ? t[0] * t[0] + t[1] * t[1] + t[2] * t[2] : t[0] * t[0] + t[1] * t[1];
      }
      lengths[i] = steerable::LengthFromSquares(sum, t, components);
    });
}

double GetLargestComponent(vtkDataArray* array, vtkIdType index)
{
  double largest = 0.0;
  for (int c = 0; c < array->GetNumberOfComponents(); ++c)
  {
    const double value = array->GetComponent(index, c);
    largest = std::abs(value) > std::abs(largest) ? value : largest;
  }
  return largest;
}

namespace
{
ArrayFacts FactsOf(vtkDataSetAttributes* attributes, int index)
{
  ArrayFacts facts;
  if (vtkDataArray* array = attributes->GetArray(index)) // not strings
  {
    facts.Name = array->GetName() ? array->GetName() : "";
    facts.DataType = array->GetDataType();
    facts.Components = array->GetNumberOfComponents();
    facts.Attribute = attributes->IsArrayAnAttribute(index);
  }
  return facts;
}
} // namespace

bool MaySteer(const ArrayFacts& array)
{
  return array.Attribute != vtkDataSetAttributes::NORMALS &&
    array.Attribute != vtkDataSetAttributes::TCOORDS && array.DataType != VTK_UNSIGNED_CHAR;
}

int ChooseArray(const std::vector<ArrayFacts>& arrays)
{
  const auto active = [&](int attribute)
  {
    const auto found = std::find_if(arrays.begin(), arrays.end(),
      [=](const ArrayFacts& array) { return array.Attribute == attribute; });
    return found != arrays.end() ? static_cast<int>(found - arrays.begin()) : -1;
  };
  int chosen = active(vtkDataSetAttributes::VECTORS);
  if (chosen >= 0)
  {
    return chosen;
  }
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    const ArrayFacts& array = arrays[i];
    const bool isReal = array.DataType == VTK_FLOAT || array.DataType == VTK_DOUBLE;
    if (isReal && array.Components == 3 && MaySteer(array) && array.Name != "Normals" &&
      (chosen < 0 || array.Name < arrays[static_cast<std::size_t>(chosen)].Name))
    {
      chosen = static_cast<int>(i);
    }
  }
  return chosen >= 0 ? chosen : active(vtkDataSetAttributes::TENSORS);
}

vtkDataArray* FindDefaultArray(vtkDataSetAttributes* attributes)
{
  std::vector<ArrayFacts> arrays;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    arrays.push_back(FactsOf(attributes, i));
  }
  const int chosen = ChooseArray(arrays);
  return chosen >= 0 ? attributes->GetArray(chosen) : nullptr;
}

vtkDataArray* FindSteeringArray(
  vtkDataSet* dataset, vtkInformation* choice, bool& cells, std::string& why)
{
  why.clear();
  const int association = choice->Has(vtkDataObject::FIELD_ASSOCIATION())
    ? choice->Get(vtkDataObject::FIELD_ASSOCIATION())
    : vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS;
  const char* name =
    choice->Has(vtkDataObject::FIELD_NAME()) ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  // The association that was asked for, then the other one.
  const bool cellsFirst = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  for (const bool onCells : { cellsFirst, !cellsFirst })
  {
    vtkDataSetAttributes* attributes =
      dataset->GetAttributes(onCells ? vtkDataObject::CELL : vtkDataObject::POINT);
    vtkDataArray* array = name && *name ? attributes->GetArray(name) : FindDefaultArray(attributes);
    if (!array)
    {
      continue;
    }
    std::ostringstream message;
    message << "Array '" << (array->GetName() ? array->GetName() : "") << "' ";
    const int components = array->GetNumberOfComponents();
    const vtkIdType samples = onCells ? dataset->GetNumberOfCells() : dataset->GetNumberOfPoints();
    // Chosen by default in a panel when nothing better is there, but no flow.
    ArrayFacts facts;
    facts.DataType = array->GetDataType();
    facts.Attribute = array == attributes->GetNormals() ? vtkDataSetAttributes::NORMALS
      : array == attributes->GetTCoords()               ? vtkDataSetAttributes::TCOORDS
                                                        : -1;
    if (!MaySteer(facts))
    {
      message << "holds normals, texture coordinates or colours, not vectors. Choose another one, or copy "
                 "it with the Calculator if it is meant.";
    }
    else if (!IsVector(components) && !IsTensor(components))
    {
      message << "has " << components
              << " component(s). Choose one with 2 or 3 (vectors) or 4, 6 or 9 (tensors).";
    }
    else if (array->GetNumberOfTuples() != samples)
    {
      message << "has " << array->GetNumberOfTuples() << " tuples for " << samples
              << (onCells ? " cells" : " points") << ". Mend the data or choose another array.";
    }
    else
    {
      cells = onCells;
      return array;
    }
    why = message.str();
  }
  if (why.empty())
  {
    why = name && *name
      ? "There is no array '" + std::string(name) +
        "' on points or cells. Choose one that exists."
      : "There are no vectors. Name an array with 2 or 3 components (vectors) or 4, 6 or 9 "
        "(tensors); three scalars can be merged with Merge Vector Components or the Calculator.";
  }
  return nullptr;
}
} // namespace noise
