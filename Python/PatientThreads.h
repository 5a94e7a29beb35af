// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Threads whose caller waits with an ear for Ctrl-C.
 */
#ifndef PatientThreads_h
#define PatientThreads_h

#include <nanobind/nanobind.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

/**
 * Runs `evaluate(begin, end)` over all parts, `grain` of them at a time, with at most `threads` threads
 * of its own. This thread only waits, and asks Python now and then whether the user interrupted it. Call
 * it without the GIL.
 */
template <typename Evaluate>
void ForEachPart(std::size_t parts, std::size_t grain, int threads, Evaluate&& evaluate)
{
  const std::size_t chunks = (parts + grain - 1) / grain;
  std::atomic<std::size_t> next{ 0 };
  std::atomic<bool> stop{ false };
  std::mutex mutex;
  std::condition_variable finished;
  int running = 0;
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
  bool interrupted = false;
  std::vector<std::thread> workers;
  {
    std::unique_lock<std::mutex> lock(mutex);
    try
    {
      while (workers.size() < std::min<std::size_t>(threads, chunks))
      {
        workers.emplace_back(work);
        ++running;
      }
    }
    catch (...)
    {
      // Those that there are will do; without any the caller is told.
      error = workers.empty() ? std::current_exception() : error;
    }
    while (!finished.wait_for(lock, std::chrono::milliseconds(100), [&] { return running == 0; }))
    {
      if (!interrupted)
      {
        lock.unlock();
        const nanobind::gil_scoped_acquire gil;
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
    const nanobind::gil_scoped_acquire gil;
    nanobind::raise_python_error();
  }
  if (error)
  {
    std::rethrow_exception(error);
  }
}

#endif
