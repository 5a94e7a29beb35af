// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How this module's filters use threads, report progress and make their arrays (private).
 */
#ifndef NoiseThreads_h
#define NoiseThreads_h

#include "vtkAlgorithm.h"
#include "vtkFloatArray.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>

namespace noise
{
inline vtkSmartPointer<vtkFloatArray> NewOutputArray(
  const char* name, int components, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
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
 * Sums what `evaluate(begin, end)` returns over all parts. `samples` is their work, from which chunks
 * are sized so that what a chunk sets up does not count. One thread reports progress and asks whether
 * to abort; all of them stop then.
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
  const auto perPart = std::max<std::size_t>(1, static_cast<std::size_t>(samples) / parts);
  const std::size_t grain =
    std::max<std::size_t>(1, std::min((1u << 17) / perPart, parts / 16 + 1));
  std::mutex mutex;
  std::atomic<std::size_t> done(0);
  WithThreads(
    [&]
    {
      vtkSMPTools::For(0, static_cast<vtkIdType>(parts), static_cast<vtkIdType>(grain),
        [&](vtkIdType begin, vtkIdType end)
        {
          // Some backends hand out larger ranges than the grain.
          for (auto first = static_cast<std::size_t>(begin);
               first < static_cast<std::size_t>(end) && !algorithm->GetAbortOutput();
               first += grain)
          {
            if (vtkSMPTools::GetSingleThread())
            {
              algorithm->UpdateProgress(
                progressStart + progressShare * static_cast<double>(done) / parts);
              algorithm->CheckAbort();
            }
            const std::size_t last = std::min(first + grain, static_cast<std::size_t>(end));
            const auto part = evaluate(first, last);
            done += last - first;
            const std::lock_guard<std::mutex> lock(mutex);
            sum += part;
          }
        });
    });
  return sum;
}
} // namespace noise

#endif
