// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What this module's filters do with blocks and ranks alike (private).
 */
#ifndef NoiseBlocks_h
#define NoiseBlocks_h

#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <utility>

class vtkDataObject;
class vtkMultiProcessController;

namespace noise
{
/**
 * Makes `output` of the structure of `input`, both a dataset or both a composite, and calls `fill`
 * for each dataset: it makes `copy` of `source`, by a shallow copy for instance, and may add arrays
 * to it.
 */
void CopyBlocks(vtkDataObject* input, vtkDataObject* output,
  const std::function<void(vtkDataObject* copy, vtkDataObject* source)>& fill);

/// Calls `visit` for a dataset, or for each of a composite.
void VisitBlocks(vtkDataObject* data, const std::function<void(vtkDataObject*)>& visit);

/// Combines values of all ranks of the controller, which may be null, by a
/// vtkCommunicator::StandardOperations.
void Reduce(
  vtkMultiProcessController* controller, double* values, std::size_t count, int operation);

/**
 * A positive value with three digits, others as they are: enough for sizes, they read well, and the
 * order in which a mean was summed over ranks does not show.
 */
double RoundToThreeDigits(double value);

/**
 * Does what may fail on this rank alone, unless something has failed: `failure` says what, and is
 * told of after everything that ranks do together, because the others wait for this one.
 */
template <class Work>
void Attempt(std::string& failure, Work&& work)
{
  try
  {
    if (failure.empty())
    {
      work();
    }
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
}

/// Does `work` at the end of its scope, on every way out.
template <class Work>
class AtEnd
{
public:
  explicit AtEnd(Work&& work)
    : Do(std::move(work))
  {
  }
  ~AtEnd() { this->Do(); }
  AtEnd(const AtEnd&) = delete;
  void operator=(const AtEnd&) = delete;

private:
  Work Do;
};
} // namespace noise

#endif
