// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How this module's filters use threads, report progress and make their arrays (private).
 */
#ifndef NoiseThreads_h
#define NoiseThreads_h

#include "SteerableNoise.h"

#include "vtkAlgorithm.h"
#include "vtkFloatArray.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace noise
{
/**
 * Asks for large pages where memory is about to be written for the first time: the system clears and
 * enters each page then, which for small pages can take longer than the noise itself.
 */
inline void AdviseLargePages(void* memory, std::size_t bytes)
{
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t page = std::uintptr_t(1) << 21;
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = (address + page - 1) / page * page;
  const std::uintptr_t end = (address + bytes) / page * page;
  if (begin < end)
  {
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE); // a hint: it may fail
  }
#else
  (void)memory;
  (void)bytes;
#endif
}

inline vtkSmartPointer<vtkFloatArray> NewOutputArray(
  const char* name, int components, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  AdviseLargePages(
    array->GetPointer(0), static_cast<std::size_t>(array->GetNumberOfValues()) * sizeof(float));
  return array;
}

/**
 * Runs `work` with threads. ParaView's packages come with a sequential default and the thread pool
 * compiled in; a user who set VTK_SMP_BACKEND_IN_USE, or another backend, keeps it.
 */
template <typename Work>
void WithThreads(Work&& work)
{
  const bool chosen = std::getenv("VTK_SMP_BACKEND_IN_USE") != nullptr;
  if (!chosen && std::strcmp(vtkSMPTools::GetBackend(), "Sequential") == 0)
  {
    vtkSMPTools::LocalScope(vtkSMPTools::Config{ std::string("STDThread") }, work);
  }
  else
  {
    work();
  }
}

/**
 * Runs the jobs 0, 1, ... in threads that each take the next one, with work(job) of its own from `makeWork()`. A job
 * starts when the first `before(job)` are done: at most all before it, and no fewer than the job before it asks for.
 * For steps too short for a vtkSMPTools::For each: VTK 9.2 starts its threads anew every time. Nothing waits for a job
 * that no thread has taken, so one thread gets through as well.
 */
template <typename Before, typename MakeWork>
void RunInOrder(vtkIdType jobs, Before&& before, MakeWork&& makeWork)
{
  struct Counted
  {
    std::atomic<vtkIdType>& Done;
    ~Counted() { this->Done.fetch_add(1, std::memory_order_release); } // whatever was thrown
  };
  std::atomic<vtkIdType> taken{ 0 };
  std::atomic<vtkIdType> done{ 0 };
  vtkSMPTools::For(0, std::max(vtkSMPTools::GetEstimatedNumberOfThreads(), 1), 1,
    [&](vtkIdType, vtkIdType)
    {
      auto work = makeWork();
      for (vtkIdType job = taken++; job < jobs; job = taken++)
      {
        while (done.load(std::memory_order_acquire) < before(job))
        {
          std::this_thread::yield();
        }
        const Counted counted{ done };
        work(job);
      }
    });
}

/**
 * Sums what `evaluate(begin, end)` returns over all parts, which hold `samples` together. They go to
 * the threads in a few slices, between which this thread reports progress and asks whether to abort:
 * observers of progress may be a user interface, which other threads must not touch.
 */
template <typename Evaluate>
auto ForEachPart(vtkAlgorithm* algorithm, std::size_t parts, vtkIdType samples,
  double progressStart, double progressShare, Evaluate&& evaluate) -> decltype(evaluate(0, 0))
{
  decltype(evaluate(0, 0)) sum;
  if (parts == 0)
  {
    return sum;
  }
  // Slices and chunks large enough that what they set up does not count.
  constexpr std::size_t samplesPerSlice = 1u << 19;
  constexpr std::size_t samplesPerChunk = 1u << 15;
  const auto perPart = std::max<std::size_t>(1, static_cast<std::size_t>(samples) / parts);
  // Whole patches of rows, if the parts are rows.
  using steerable::ImageGrid;
  const std::size_t slice =
    ImageGrid::RowsBeyond(std::max(parts / 20, samplesPerSlice / perPart));
  const std::size_t grain = ImageGrid::RowsBeyond(samplesPerChunk / perPart);
  std::mutex mutex;
  WithThreads(
    [&]
    {
      for (std::size_t first = 0; first < parts; first += slice)
      {
        algorithm->UpdateProgress(
          progressStart + progressShare * static_cast<double>(first) / static_cast<double>(parts));
        if (algorithm->CheckAbort())
        {
          return;
        }
        const std::size_t last = std::min(first + slice, parts);
        vtkSMPTools::For(static_cast<vtkIdType>(first), static_cast<vtkIdType>(last),
          static_cast<vtkIdType>(grain),
          [&](vtkIdType begin, vtkIdType end)
          {
            const auto part =
              evaluate(static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
            const std::lock_guard<std::mutex> lock(mutex);
            sum += part;
          });
      }
    });
  return sum;
}
} // namespace noise

#endif
