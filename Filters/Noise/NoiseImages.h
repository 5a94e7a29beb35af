// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Images finer than their input, and pieces no larger than what was asked for (private).
 */
#ifndef NoiseImages_h
#define NoiseImages_h

#include <vector>

class vtkDataSet;
class vtkImageData;
class vtkInformation;

namespace noise
{
/// Whole extent and spacing of an image with `factor` samples for each of the input's.
void MagnifyInformation(vtkInformation* inInfo, vtkInformation* outInfo, int factor);

/**
 * The smallest factor, up to 16, with which a streak of the finest octave, `fineness` times as fine as `featureSize`
 * (0: automatic), has 6 samples, but no more than 2^22 in all. Only from the whole extent, so the same for all pieces.
 */
int GetAutomaticMagnification(vtkInformation* inInfo, double featureSize, double fineness);

/// Throws std::runtime_error if there is no memory for the images with `factor` samples for each of theirs.
void CheckMemory(const std::vector<vtkImageData*>& images, int factor);

/**
 * Fills `output` with that image over `updateExtent` (null: all of it) and one sample of the input around it, which
 * curvature looks at. Point arrays are interpolated linearly, samples at the input's places keep their values,
 * whole numbers of one component are those of the nearest point (vtkGhostType: hidden next to a hidden one), and cell arrays repeated, except that
 * floating-point cell arrays of 2 to 9 components (which may steer the noise) are interpolated between
 * cell centres, hidden ones left out.
 */
void Magnify(vtkImageData* input, vtkImageData* output, const int* updateExtent, int factor);

/// Drops the border that curvature asked for, where an extent was requested.
void CropToUpdateExtent(vtkDataSet* output, vtkInformation* outInfo);
} // namespace noise

#endif
