// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The kernel for NumPy arrays. Arguments are checked in steerablenoise/__init__.py.
 */
#include "ArrayReaders.h"
#include "LengthOctaves.h"
#include "MetricTensor.h"
#include "PatientThreads.h"
#include "SteerableNoise.h"
#include "Subband/SubbandTiles.h"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace nb = nanobind;
using namespace nb::literals;

namespace
{
using Output = nb::ndarray<float, nb::numpy, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Metrics = nb::ndarray<double, nb::numpy, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
constexpr std::size_t SamplesAtATime = 1u << 14;
/// Of images more: what is next to a part is read for its curvature too.
constexpr std::size_t ImageSamplesAtATime = 1u << 16;

/// Samples without a direction, stagnant ones, and those that were too long.
using Counts = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>;

/// What happens to samples that tell no direction, by the rules of vtkSteerableNoiseFilter.
struct Blanks
{
  const ArrayTuples& Vectors;
  double Threshold;
  double Limit;
  float Value;
  std::mutex Mutex = {};
  Counts Total = {};

  void Apply(steerable::EvaluationCounts counts, std::size_t begin, std::size_t end, float* noise)
  {
    std::uint64_t tooLong = 0;
    if (counts.Degenerate > 0 || counts.Stagnant > 0)
    {
      this->Vectors.ForEach(begin, end - begin,
        [&](std::size_t i, const double (&vector)[3])
        {
          const bool known = std::isfinite(vector[0]) && std::isfinite(vector[1]) &&
            std::isfinite(vector[2]) && (vector[0] != 0.0 || vector[1] != 0.0 || vector[2] != 0.0);
          const double length = LengthOf(vector);
          // The kernel gives 0 to stagnant samples, but noise has zeros of its own.
          const bool stagnant = this->Threshold > 0.0 && noise[i] == 0.0f &&
            static_cast<float>(length) <= 1.000001f * this->Threshold;
          const bool overlong = std::isfinite(this->Limit) && length > this->Limit;
          tooLong += overlong;
          noise[i] = !known || stagnant || overlong ? this->Value : noise[i];
        });
    }
    std::uint64_t& left = this->Threshold > 0.0 ? counts.Stagnant : counts.Degenerate;
    left -= std::min(left, tooLong);
    const std::lock_guard<std::mutex> lock(this->Mutex);
    std::get<0>(this->Total) += counts.Degenerate;
    std::get<1>(this->Total) += counts.Stagnant;
    std::get<2>(this->Total) += tooLong;
  }
};

Counts EvaluateImage(const steerable::NoiseParameters& parameters, int dimension,
  const Components& vectors, const std::array<double, 3>& spacing,
  const std::array<double, 3>& origin, int stride, double limit, float blank, int threads,
  Output out)
{
  const steerable::SteerableNoise kernel(parameters, dimension);
  const ArrayTuples tuples(vectors);
  const auto reader = MakeVectorReader(tuples, limit);
  steerable::ImageGrid grid;
  grid.CurvatureStride = std::clamp(stride, 1, +steerable::ImageGrid::MaximumStride);
  grid.Spacing = spacing;
  grid.Origin = origin;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.Dimensions[axis] = static_cast<std::int64_t>(vectors[0].shape(2 - axis));
  }
  steerable::Field field;
  field.Vectors = reader.get();
  float* noise = out.data();
  const std::size_t row = vectors[0].shape(2);
  const nb::gil_scoped_release noGil;
  Blanks blanks{ tuples, parameters.MaskThreshold, limit, blank };
  ForEachPart(grid.GetNumberOfRows(),
    steerable::ImageGrid::RowsBeyond(ImageSamplesAtATime / row), threads,
    [&](std::size_t begin, std::size_t end) {
      blanks.Apply(
        kernel.EvaluateImage(grid, field, begin, end, noise), begin * row, end * row, noise);
    });
  return blanks.Total;
}

Counts EvaluatePoints(const steerable::NoiseParameters& parameters, int dimension,
  const Components& points, const Components& vectors, const std::optional<Components>& normals,
  const std::optional<Components>& bends, double limit, float blank, int threads, Output out)
{
  const steerable::SteerableNoise kernel(parameters, dimension);
  const ArrayTuples places(points);
  const ArrayTuples tuples(vectors);
  const ArrayTuples normalTuples(normals ? *normals : points);
  const ArrayTuples bendTuples(bends ? *bends : points);
  const PlaceReader positions(places);
  const auto reader = MakeVectorReader(tuples, limit);
  const VectorReader normalReader(normalTuples);
  const VectorReader bendReader(bendTuples);
  steerable::Field field;
  field.Vectors = reader.get();
  field.Normals = normals ? &normalReader : nullptr;
  field.Curvature = bends ? &bendReader : nullptr;
  float* noise = out.data();
  const nb::gil_scoped_release noGil;
  Blanks blanks{ tuples, parameters.MaskThreshold, limit, blank };
  ForEachPart(places.GetNumberOfTuples(), SamplesAtATime, threads,
    [&](std::size_t begin, std::size_t end) {
      blanks.Apply(kernel.EvaluatePoints(positions, field, begin, end, noise), begin, end, noise);
    });
  return blanks.Total;
}

/// N x N matrices of N-dimensional vectors, one after the other.
template <int N>
void WriteMetrics(const steerable::NoiseParameters& parameters, const ArrayTuples& vectors,
  const ArrayTuples* normals, std::size_t begin, std::size_t end, double* out)
{
  std::vector<float> vector(3 * (end - begin));
  std::vector<float> normal(normals ? vector.size() : 0);
  VectorReader(vectors).Read(begin, end - begin, vector.data());
  if (normals)
  {
    VectorReader(*normals).Read(begin, end - begin, normal.data());
  }
  for (std::size_t i = 0; i < end - begin; ++i)
  {
    const steerable::Vector<N> along =
      Eigen::Map<const Eigen::Matrix<float, N, 1>>(vector.data() + 3 * i).template cast<double>();
    steerable::AxialMetric<N> metric;
    if constexpr (N == 3)
    {
      metric = normals ? steerable::MetricFromSurfaceVector(parameters, along,
                           Eigen::Map<const Eigen::Vector3f>(normal.data() + 3 * i).cast<double>())
                       : steerable::MetricFromVector<3>(parameters, along);
    }
    else
    {
      metric = steerable::MetricFromVector<N>(parameters, along, along.norm()); // as the filter says
    }
    // One half twice: the other one is rounded differently.
    Eigen::Map<Eigen::Matrix<double, N, N>>(out + (begin + i) * N * N) =
      metric.ToMatrix().template selfadjointView<Eigen::Upper>();
  }
}

void EvaluateMetrics(const steerable::NoiseParameters& parameters, int dimension,
  const Components& vectors, const std::optional<Components>& normals, int threads, Metrics out)
{
  parameters.Validate();
  const ArrayTuples tuples(vectors);
  const ArrayTuples normalTuples(normals ? *normals : vectors);
  const ArrayTuples* surface = normals ? &normalTuples : nullptr;
  double* metrics = out.data();
  const nb::gil_scoped_release noGil;
  ForEachPart(tuples.GetNumberOfTuples(), SamplesAtATime, threads,
    [&](std::size_t begin, std::size_t end)
    {
      const auto write = dimension == 2 ? &WriteMetrics<2> : &WriteMetrics<3>;
      write(parameters, tuples, surface, begin, end, metrics);
    });
}

/// Powers of 4 that squares of lengths lie in: quick to find, and enough to rule out fill values.
struct OccupiedPowers
{
  std::array<bool, 1024> Occupied = {};

  void Add(const double (&vector)[3])
  {
    const double square = vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2];
    std::uint64_t bits;
    std::memcpy(&bits, &square, sizeof(bits));
    // Squares that are too small are among the first, those too large or not finite among the last.
    const bool any = vector[0] != 0.0 || vector[1] != 0.0 || vector[2] != 0.0;
    this->Occupied[(bits >> 53) % this->Occupied.size()] |= any; // without the sign of a NaN
  }

  OccupiedPowers& operator+=(const OccupiedPowers& more)
  {
    for (std::size_t i = 0; i < this->Occupied.size(); ++i)
    {
      this->Occupied[i] |= more.Occupied[i];
    }
    return *this;
  }

  /// Whether a length can be 16 times another one with none between, or was too long to be seen.
  bool HaveGap() const
  {
    bool gap = this->Occupied.back();
    std::size_t last = this->Occupied.size();
    for (std::size_t i = 0; i < this->Occupied.size(); ++i)
    {
      gap = gap || (this->Occupied[i] && last < i && i - last >= 4);
      last = this->Occupied[i] ? i : last;
    }
    return gap;
  }
};

/// Vectors far longer than all others, and the largest of their components; null if there are none.
using Overlong = std::optional<std::tuple<steerable::FarAbove, double>>;

Overlong FindOverlong(const Components& vectors, int threads)
{
  const ArrayTuples tuples(vectors);
  const nb::gil_scoped_release noGil;
  std::mutex mutex;
  // Quick looks first: hardly any data have them.
  std::atomic<bool> any{ false };
  const std::size_t rows = SamplesAtATime / vectors[0].shape(2) + 1;
  ForEachPart(tuples.GetNumberOfRows(), rows, threads,
    [&](std::size_t begin, std::size_t end)
    { any = any || tuples.AnyFrom(begin, end, steerable::LeastFillLength / 3.0); });
  OccupiedPowers powers;
  ForEachPart(any ? tuples.GetNumberOfTuples() : 0, SamplesAtATime, threads,
    [&](std::size_t begin, std::size_t end)
    {
      OccupiedPowers here;
      tuples.ForEach(begin, end - begin,
        [&](std::size_t, const double (&vector)[3]) { here.Add(vector); });
      const std::lock_guard<std::mutex> lock(mutex);
      powers += here;
    });
  if (!powers.HaveGap())
  {
    return std::nullopt;
  }
  steerable::LengthOctaves lengths;
  ForEachPart(tuples.GetNumberOfTuples(), SamplesAtATime, threads,
    [&](std::size_t begin, std::size_t end)
    {
      steerable::LengthOctaves here;
      tuples.ForEach(begin, end - begin,
        [&](std::size_t, const double (&vector)[3]) { here.Add(LengthOf(vector)); });
      const std::lock_guard<std::mutex> lock(mutex);
      lengths += here;
    });
  const steerable::FarAbove found = lengths.FindFarAbove();
  if (!(found.Count > 0.0))
  {
    return std::nullopt;
  }
  double value = 0.0;
  tuples.ForEach(0, tuples.GetNumberOfTuples(),
    [&](std::size_t, const double (&vector)[3])
    {
      const double length = LengthOf(vector);
      for (int c = 0; c < 3 && length > found.Rest && std::isfinite(length); ++c)
      {
        const double size = std::abs(vector[c]) - std::abs(value);
        value = size > 0.0 || (size == 0.0 && vector[c] > value) ? vector[c] : value;
      }
    });
  return std::make_tuple(found, value);
}

/// Bands of every texel into an array of TileSize² times Orientations times Scales values.
void MakeTiles(const steerable::SubbandParameters& parameters, Output out)
{
  parameters.Validate();
  const std::size_t texels = std::size_t(parameters.TileSize) * parameters.TileSize;
  const std::size_t values = texels * parameters.Components();
  if (out.size() != values)
  {
    throw std::invalid_argument("out has the wrong size");
  }
  const nb::gil_scoped_release noGil;
  const steerable::SubbandTiles tiles = steerable::MakeSubbandTiles(parameters);
  std::copy(tiles.Values.begin(), tiles.Values.end(), out.data());
}
} // namespace

NB_MODULE(_kernel, module)
{
  using namespace steerable;
  nb::enum_<Basis>(module, "Basis")
    .value("gradient", Basis::Gradient)
    .value("value", Basis::Value)
    .value("streaks", Basis::Streaks);
  nb::enum_<Normalization>(module, "Normalization")
    .value("none", Normalization::None)
    .value("weight_sum", Normalization::WeightSum)
    .value("unit_variance", Normalization::UnitVariance);
  nb::enum_<StrengthMode>(module, "StrengthMode")
    .value("constant", StrengthMode::Constant)
    .value("magnitude", StrengthMode::Magnitude);
  nb::class_<NoiseParameters>(module, "Parameters")
    .def(nb::init<>())
    .def_rw("feature_size", &NoiseParameters::FeatureSize)
    .def_rw("streak_length", &NoiseParameters::StreakLength)
    .def_rw("eigenvalue_sum", &NoiseParameters::EigenvalueSum)
    .def_rw("strength", &NoiseParameters::Strength)
    .def_rw("strength_mode", &NoiseParameters::StrengthMode)
    .def_rw("reference_magnitude", &NoiseParameters::ReferenceMagnitude)
    .def_rw("mask_threshold", &NoiseParameters::MaskThreshold)
    .def_rw("follow_curvature", &NoiseParameters::FollowCurvature)
    .def_rw("normalization", &NoiseParameters::Normalization)
    .def_rw("basis", &NoiseParameters::Basis)
    .def_rw("density", &NoiseParameters::Density)
    .def_rw("motion", &NoiseParameters::Motion)
    .def_rw("phase", &NoiseParameters::Phase)
    .def_rw("speed", &NoiseParameters::Speed)
    .def_rw("octaves", &NoiseParameters::Octaves)
    .def_rw("lacunarity", &NoiseParameters::Lacunarity)
    .def_rw("gain", &NoiseParameters::Gain)
    .def_rw("turbulence", &NoiseParameters::Turbulence)
    .def_rw("period", &NoiseParameters::Period)
    .def_rw("seed", &NoiseParameters::Seed);
  nb::class_<SubbandParameters>(module, "SubbandParameters")
    .def(nb::init<>())
    .def_rw("orientations", &SubbandParameters::Orientations)
    .def_rw("scales", &SubbandParameters::Scales)
    .def_rw("tile_size", &SubbandParameters::TileSize)
    .def_rw("band_center", &SubbandParameters::BandCenter)
    .def_rw("seed", &SubbandParameters::Seed);
  nb::class_<FarAbove>(module, "FarAbove")
    .def_ro("count", &FarAbove::Count)
    .def_ro("longest", &FarAbove::Longest)
    .def_ro("rest", &FarAbove::Rest)
    .def_ro("fill", &FarAbove::Fill);
  module.def("image", &EvaluateImage, "parameters"_a, "dimension"_a, "vectors"_a, "spacing"_a,
    "origin"_a, "stride"_a, "limit"_a, "blank"_a, "threads"_a, "out"_a);
  module.def("points", &EvaluatePoints, "parameters"_a, "dimension"_a, "points"_a, "vectors"_a,
    "normals"_a.none(), "bends"_a.none(), "limit"_a, "blank"_a, "threads"_a, "out"_a);
  module.def("metrics", &EvaluateMetrics, "parameters"_a, "dimension"_a, "vectors"_a,
    "normals"_a.none(), "threads"_a, "out"_a);
  module.def("overlong", &FindOverlong, "vectors"_a, "threads"_a);
  module.def("tiles", &MakeTiles, "parameters"_a, "out"_a);
}
