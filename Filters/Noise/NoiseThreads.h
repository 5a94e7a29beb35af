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
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <vector>

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
 * Runs jobsOf(0) jobs of phase 0, then those of phase 1 and so on, in threads that stay, each with work(phase, job) of
 * its own from `makeWork()`: VTK 9.2 starts its threads anew for every vtkSMPTools::For, which for short phases takes
 * longer than the work. A phase begins when all but the one right before it are done, so that threads hardly wait for
 * one another. No job waits for one that no thread has taken, so a single one gets through as well.
 */
template <typename JobsOf, typename MakeWork>
void RunInPhases(vtkIdType phases, JobsOf&& jobsOf, MakeWork&& makeWork)
{
  std::vector<vtkIdType> ends(static_cast<std::size_t>(phases));
  std::vector<std::atomic<vtkIdType>> left(ends.size());
  vtkIdType jobs = 0;
  for (std::size_t phase = 0; phase < ends.size(); ++phase)
  {
    left[phase] = jobsOf(static_cast<vtkIdType>(phase));
    ends[phase] = jobs += left[phase];
  }
  std::atomic<vtkIdType> taken{ 0 };
  std::atomic<std::size_t> done{ 0 }; // phases, without a gap
  std::mutex mutex;
  std::condition_variable isDone;
  const auto finish = [&](std::size_t phase)
  {
    if (--left[phase] == 0)
    {
      const std::lock_guard<std::mutex> lock(mutex);
      while (done < left.size() && left[done] == 0)
      {
        ++done;
      }
      isDone.notify_all();
    }
  };
  vtkSMPTools::For(0, std::max(vtkSMPTools::GetEstimatedNumberOfThreads(), 1), 1,
    [&](vtkIdType, vtkIdType)
    {
      auto work = makeWork();
      std::size_t phase = 0;
      for (vtkIdType job = taken++; job < jobs; job = taken++)
      {
        while (job >= ends[phase])
        {
          ++phase;
        }
        if (done + 1 < phase)
        {
          std::unique_lock<std::mutex> lock(mutex);
          isDone.wait(lock, [&] { return done + 1 >= phase; });
        }
        try
        {
          work(static_cast<vtkIdType>(phase), job - (phase > 0 ? ends[phase - 1] : 0));
        }
        catch (...)
        {
          finish(phase);
          throw;
        }
        finish(phase);
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
