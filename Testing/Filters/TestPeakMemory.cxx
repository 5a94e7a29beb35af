// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What vtkSteerableNoiseFilter allocates at most while it runs. A program of its own, since it takes
 * the place of the C library's allocator to count.
 */
#include "FilterTestHelpers.h"

#include "vtkAppendFilter.h"
#include "vtkSMPTools.h"
#include "vtkSteerableNoiseFilter.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <atomic>
#include <cerrno>

using namespace filtertest;

namespace
{
std::atomic<std::int64_t> Allocated{ 0 };
std::atomic<std::int64_t> Peak{ 0 };

void* Count(void* memory)
{
  const std::int64_t now = Allocated +=
    memory ? static_cast<std::int64_t>(malloc_usable_size(memory)) : 0;
  for (std::int64_t peak = Peak; now > peak && !Peak.compare_exchange_weak(peak, now);)
  {
  }
  return memory;
}

void Discount(void* memory)
{
  Allocated -= memory ? static_cast<std::int64_t>(malloc_usable_size(memory)) : 0;
}
} // namespace

extern "C"
{
  void* __libc_malloc(std::size_t);
  void* __libc_calloc(std::size_t, std::size_t);
  void* __libc_realloc(void*, std::size_t);
  void* __libc_memalign(std::size_t, std::size_t);
  void __libc_free(void*);

  void* malloc(std::size_t size)
  {
    return Count(__libc_malloc(size));
  }
  void* calloc(std::size_t count, std::size_t size)
  {
    return Count(__libc_calloc(count, size));
  }
  void* realloc(void* memory, std::size_t size)
  {
    Discount(memory);
    return Count(__libc_realloc(memory, size));
  }
  void* memalign(std::size_t alignment, std::size_t size)
  {
    return Count(__libc_memalign(alignment, size));
  }
  void* aligned_alloc(std::size_t alignment, std::size_t size)
  {
    return memalign(alignment, size);
  }
  int posix_memalign(void** memory, std::size_t alignment, std::size_t size)
  {
    *memory = memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
  }
  void free(void* memory)
  {
    Discount(memory);
    __libc_free(memory);
  }
}

namespace
{
/// Bytes at the peak of an update, less what was there before.
std::int64_t GetPeak(vtkDataObject* input, bool curvature)
{
  vtkNew<vtkSteerableNoiseFilter> filter;
  filter->SetInputDataObject(input);
  filter->SetFeatureSize(8.0);
  filter->SetFollowCurvature(curvature);
  filter->UpdateInformation();
  const std::int64_t before = Allocated;
  Peak = before;
  filter->Update();
  return Peak - before;
}

constexpr std::int64_t MiB = 1 << 20;
} // namespace

TEST(PeakMemory, ImagesTakeTheOutputAndOneMebibytePerThread)
{
  const std::int64_t threads = vtkSMPTools::GetEstimatedNumberOfThreads() + 1;
  for (const bool flat : { true, false })
  {
    auto image = flat ? MakeImage(1024, 1024, 1) : MakeImage(128, 128, 64);
    const std::int64_t output = image->GetNumberOfPoints() * sizeof(float);
    for (const bool curvature : { false, true })
    {
      const std::int64_t peak = GetPeak(image, curvature);
      std::printf("%s, curvature %s: output %.2f MiB, peak %.2f MiB\n", flat ? "2D" : "3D",
        curvature ? "on" : "off", output / double(MiB), peak / double(MiB));
      EXPECT_GE(peak, output);
      EXPECT_LE(peak, output + threads * MiB);
    }
  }
}

TEST(PeakMemory, PointsTakeOneVectorMoreWhereTheyAreBent)
{
  const std::int64_t threads = vtkSMPTools::GetEstimatedNumberOfThreads() + 1;
  vtkNew<vtkAppendFilter> append;
  append->SetInputData(MakeImage(64, 64, 64));
  append->Update();
  auto* grid = append->GetOutput();
  const std::int64_t output = grid->GetNumberOfPoints() * sizeof(float);
  const std::int64_t straight = GetPeak(grid, false);
  const std::int64_t bent = GetPeak(grid, true);
  const double perPoint = static_cast<double>(bent - output) / grid->GetNumberOfPoints();
  std::printf("points: output %.2f MiB, peak %.2f MiB; bent %.2f MiB, %.0f bytes per point more\n",
    output / double(MiB), straight / double(MiB), bent / double(MiB), perPoint);
  EXPECT_LE(straight, output + threads * MiB);
  // A float3, and two bytes that count cells.
  EXPECT_LE(bent, output + 14 * grid->GetNumberOfPoints() + threads * MiB);
}
