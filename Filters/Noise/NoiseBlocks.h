// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What this module's filters do with blocks and ranks alike (private).
 */
#ifndef NoiseBlocks_h
#define NoiseBlocks_h

#include <cstddef>
#include <functional>

class vtkDataObject;
class vtkMultiProcessController;

namespace noise
{
/**
 * Makes `output` of the structure of `input`, both a dataset or both a composite, and calls `fill` for each
 * dataset: it makes `copy` of `source`, by a shallow copy for instance, and may add arrays to it.
 */
void CopyBlocks(vtkDataObject* input, vtkDataObject* output,
  const std::function<void(vtkDataObject* copy, vtkDataObject* source)>& fill);

/// Combines values of all ranks of the controller, which may be null, by a vtkCommunicator::StandardOperations.
void Reduce(
  vtkMultiProcessController* controller, double* values, std::size_t count, int operation);

/**
 * A positive value with three digits, others as they are: enough for sizes, they read well, and the order
 * in which a mean was summed over ranks does not show.
 */
double RoundToThreeDigits(double value);
} // namespace noise

#endif
