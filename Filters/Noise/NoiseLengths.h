// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How long the vectors of VTK's arrays are, over blocks and ranks (private).
 */
#ifndef NoiseLengths_h
#define NoiseLengths_h

#include "LengthOctaves.h"

#include <vector>

class vtkDataArray;
class vtkMultiProcessController;

namespace noise
{
/// Whether an array has a number so large that LengthOctaves can find a vector in it; quick.
bool MayHoldFarAbove(vtkDataArray* array);

/**
 * Adds the lengths of the tuples that are at most `limit` long and not hidden (one value for each,
 * or empty).
 */
void AddLengths(steerable::LengthOctaves& octaves, vtkDataArray* array,
  const std::vector<unsigned char>& hidden, double limit);

/// All ranks take part.
void Reduce(steerable::LengthOctaves& octaves, vtkMultiProcessController* controller);
} // namespace noise

#endif
