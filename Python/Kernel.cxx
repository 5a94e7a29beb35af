// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The kernel's two evaluations for NumPy arrays. Arguments are checked in steerablenoise/__init__.py; here arrays
 * are read where they lie, whatever their strides.
 */
#include "SteerableNoise.h"
#include "TupleFloats.h"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <vector>

namespace nb = nanobind;
using namespace nb::literals;

namespace
{
/// Axes z, y, x and components; points are (1, 1, n, components).
using Tuples = nb::ndarray<nb::ro, nb::ndim<4>, nb::device::cpu>;
using Output = nb::ndarray<float, nb::numpy, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Tuples of 3 from an array with 2 (the third is 0) or 3 components, x fastest.
template <typename From, typename To>
class StridedReader : public steerable::TupleReader<To>
{
public:
  explicit StridedReader(const Tuples& array)
    : Data(static_cast<const From*>(array.data()))
  {
    for (int axis = 0; axis < 4; ++axis)
    {
      this->Shape[axis] = array.shape(axis);
      this->Stride[axis] = array.stride(axis);
    }
  }

  const To* Read(std::size_t first, std::size_t count, To* scratch) const override
  {
    const std::size_t nx = this->Shape[2];
    const std::size_t ny = this->Shape[1];
    for (std::size_t n = 0; n < count; ++n)
    {
      const std::size_t sample = first + n;
      const From* tuple = this->Data + std::int64_t(sample / nx / ny) * this->Stride[0] +
        std::int64_t(sample / nx % ny) * this->Stride[1] + std::int64_t(sample % nx) * this->Stride[2];
      double values[3] = { 0.0, 0.0, 0.0 };
      for (std::size_t c = 0; c < this->Shape[3]; ++c)
      {
        values[c] = tuple[std::int64_t(c) * this->Stride[3]];
      }
      if constexpr (std::is_same_v<To, float>)
      {
        steerable::ToFloats(values, 3, scratch + 3 * n);
      }
      else
      {
        std::copy_n(values, 3, scratch + 3 * n); // places
      }
    }
    return scratch;
  }

private:
  const From* Data;
  std::size_t Shape[4];
  std::int64_t Stride[4];
};

template <typename To>
std::unique_ptr<steerable::TupleReader<To>> ReaderOf(const Tuples& array)
{
  if (array.dtype() == nb::dtype<float>())
  {
    return std::make_unique<StridedReader<float, To>>(array);
  }
  return std::make_unique<StridedReader<double, To>>(array);
}

/**
 * Runs `evaluate(begin, end)` over all parts with threads of its own. This thread only waits, and asks Python
 * now and then whether the user interrupted it. Call it without the GIL.
 */
template <typename Evaluate>
void ForEachPart(std::size_t parts, std::size_t grain, int threads, Evaluate&& evaluate)
{
  std::atomic<std::size_t> next{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex mutex;
  std::condition_variable finished;
  int running = threads;
  std::exception_ptr error;
  const auto work = [&]
  {
    try
    {
      for (std::size_t begin; !stop && (begin = next.fetch_add(grain)) < parts;)
      {
        evaluate(begin, std::min(begin + grain, parts));
      }
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      error = std::current_exception();
      stop = true;
    }
    const std::lock_guard<std::mutex> lock(mutex);
    --running;
    finished.notify_one();
  };
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i)
  {
    workers.emplace_back(work);
  }
  bool interrupted = false;
  {
    std::unique_lock<std::mutex> lock(mutex);
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; }))
    {
      if (!interrupted)
      {
        lock.unlock();
        const nb::gil_scoped_acquire gil;
        interrupted = PyErr_CheckSignals() != 0;
        stop = stop || interrupted;
        lock.lock();
      }
    }
  }
  for (std::thread& worker : workers)
  {
    worker.join();
  }
  if (interrupted)
  {
    const nb::gil_scoped_acquire gil;
    nb::raise_python_error();
  }
  if (error)
  {
    std::rethrow_exception(error);
  }
}

/// 0 for the samples [begin, end) whose vector is NaN or infinite: nothing is known there.
void ClearMissing(
  const steerable::TupleReader<float>& vectors, std::size_t begin, std::size_t end, float* noise)
{
  constexpr std::size_t chunk = 1024;
  float scratch[3 * chunk];
  for (std::size_t first = begin; first < end; first += chunk)
  {
    const std::size_t count = std::min(chunk, end - first);
    const float* v = vectors.Read(first, count, scratch);
    for (std::size_t i = 0; i < count; ++i, v += 3)
    {
      if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]))
      {
        noise[first + i] = 0.0f;
      }
    }
  }
}

void EvaluateImage(const steerable::NoiseParameters& parameters, const Tuples& vectors,
  const std::array<double, 3>& spacing, const std::array<double, 3>& origin, int threads, Output out)
{
  const steerable::SteerableNoise kernel(parameters, static_cast<int>(vectors.shape(3)));
  const auto reader = ReaderOf<float>(vectors);
  steerable::ImageGrid grid;
  grid.Spacing = spacing;
  grid.Origin = origin;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.Dimensions[axis] = static_cast<std::int64_t>(vectors.shape(2 - axis));
  }
  steerable::Field field;
  field.Vectors = reader.get();
  float* noise = out.data();
  const std::size_t row = vectors.shape(2);
  const nb::gil_scoped_release noGil;
  ForEachPart(grid.GetNumberOfRows(), (1u << 14) / row + 1, threads,
    [&](std::size_t begin, std::size_t end)
    {
      kernel.EvaluateImage(grid, field, begin, end, noise);
      ClearMissing(*reader, begin * row, end * row, noise);
    });
}

void EvaluatePoints(const steerable::NoiseParameters& parameters, const Tuples& points,
  const Tuples& vectors, const std::optional<Tuples>& normals, const std::optional<Tuples>& bends,
  int threads, Output out)
{
  const steerable::SteerableNoise kernel(parameters, static_cast<int>(points.shape(3)));
  const auto positions = ReaderOf<double>(points);
  const auto reader = ReaderOf<float>(vectors);
  const auto normalReader = normals ? ReaderOf<float>(*normals) : nullptr;
  const auto bendReader = bends ? ReaderOf<float>(*bends) : nullptr;
  steerable::Field field;
  field.Vectors = reader.get();
  field.Normals = normalReader.get();
  field.Curvature = bendReader.get();
  float* noise = out.data();
  const nb::gil_scoped_release noGil;
  ForEachPart(points.shape(2), 1u << 14, threads,
    [&](std::size_t begin, std::size_t end)
    {
      kernel.EvaluatePoints(*positions, field, begin, end, noise);
      ClearMissing(*reader, begin, end, noise);
    });
}
} // namespace

NB_MODULE(_kernel, module)
{
  using steerable::NoiseParameters;
  nb::class_<NoiseParameters>(module, "Parameters")
    .def(nb::init<>())
    .def_rw("feature_size", &NoiseParameters::FeatureSize)
    .def_rw("streak_length", &NoiseParameters::StreakLength)
    .def_rw("seed", &NoiseParameters::Seed)
    .def_rw("follow_curvature", &NoiseParameters::FollowCurvature)
    .def_rw("motion", &NoiseParameters::Motion)
    .def_rw("phase", &NoiseParameters::Phase)
    .def_rw("mask_threshold", &NoiseParameters::MaskThreshold)
    .def_rw("octaves", &NoiseParameters::Octaves);
  module.def("image", &EvaluateImage, "parameters"_a, "vectors"_a, "spacing"_a, "origin"_a, "threads"_a, "out"_a);
  module.def("points", &EvaluatePoints, "parameters"_a, "points"_a, "vectors"_a, "normals"_a.none(),
    "bends"_a.none(), "threads"_a, "out"_a);
}
