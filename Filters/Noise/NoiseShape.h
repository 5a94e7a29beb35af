// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a dataset is for the noise (private): a flat image, a surface, or a volume. The blocks of a composite agree
 * on it over all ranks, so that a block one cell thick continues its neighbours.
 */
#ifndef NoiseShape_h
#define NoiseShape_h

class vtkDataSet;
class vtkMultiProcessController;

namespace noise
{
/// How the samples of one dataset are taken.
struct Shape
{
  /// Images: a grid along their own axes. Else places in any order, with normals on surfaces.
  bool IsGrid = false;
  /// Of a grid: the axes along which it extends; 2D noise unless it is all three.
  bool Thick[3] = { true, true, true };
  /// The axis along which a structured dataset is one cell thick and counts as a surface; -1: none.
  int Slab = -1;
};

/// Points along each axis of a structured dataset; false for the others.
bool GetDimensions(vtkDataSet* dataset, int dimensions[3]);

class CommonShape
{
public:
  CommonShape();

  /**
   * Adds a dataset with samples on its points or `cells`. `wholeExtent` is that of what the dataset is a piece of;
   * null: it is all there is.
   */
  void Add(vtkDataSet* dataset, bool cells, const int* wholeExtent);

  /// All ranks of the controller take part.
  void Reduce(vtkMultiProcessController* controller);

  /**
   * The shape of one that was added. Images are flat if all datasets are images with the same axes of which one has
   * no extent; next to others they are surfaces where they are flat. A structured grid one cell thick is a surface
   * unless there is a volume beside it.
   */
  Shape Get(vtkDataSet* dataset, bool cells, const int* wholeExtent) const;

private:
  // Each is 0 where nothing was added, and they combine by maximum.
  enum Fact
  {
    ThickX,
    ThickY,
    ThickZ,
    Volume,
    NotImage,
    Directions,
    OppositeDirections = Directions + 9,
    Count = OppositeDirections + 9
  };
  bool IsFlat() const;

  double Facts[Count];
};
} // namespace noise

#endif
