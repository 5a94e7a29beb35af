// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * One dataset as the kernel sees it (private to this module): where its samples are, what steers them
 * and which metric they take. Images are grids in their own axes; everything else is points in any
 * order, with normals where the cells are surfaces.
 */
#ifndef NoiseSamples_h
#define NoiseSamples_h

#include "NoiseArrays.h"
#include "NoiseGhosts.h"
#include "NoiseShape.h"

#include "vtkFloatArray.h"
#include "vtkSmartPointer.h"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkImageData;

namespace noise
{
class CoincidentPoints;

/**
 * What samples off images know of their geometry and field, to be kept from one update to the next while both stay
 * the same: 24 bytes for each sample on a surface, 12 in a volume, 4 more where samples are badly
 * ordered.
 */
struct SampleFields
{
  bool AreNormalsKnown = false;
  vtkSmartPointer<vtkFloatArray> Normals;
  /// The FeatureSize whose steps the curvature has; 0: there is none yet.
  double CurvatureSize = 0.0;
  vtkSmartPointer<vtkFloatArray> Curvature;
  bool IsOrderKnown = false;
  /// In which the kernel takes samples, if not in theirs.
  std::vector<std::uint32_t> Order;
};

class Samples
{
public:
  /**
   * `array`: what steers; null: nothing does. `cells`: it belongs to the cells. `shape` as
   * CommonShape has it. `magnification`: samples of an image
   * for each one that its vectors were interpolated from. `plane`: where two components lie, but flat
   * images have them along their own axes. Vectors longer than `limit` are left out. `kept`: what is known is
   * taken from there, and what is found left there; null: nothing.
   */
  Samples(vtkDataSet* dataset, vtkDataArray* array, bool cells, const Shape& shape, int magnification, const Plane& plane = WorldPlane,
    double limit = std::numeric_limits<double>::infinity(), SampleFields* kept = nullptr);
  ~Samples();

  vtkIdType GetNumberOfSamples() const;
  /// 2 for images with a flat axis, else 3.
  int GetDimension() const { return this->Dimension; }
  /// Parts that are evaluated independently: rows of a grid, or samples.
  std::size_t GetNumberOfParts() const;

  /// Unit normals of samples on surfaces, 0 off them; null where there are none.
  vtkFloatArray* GetNormals() const { return this->Fields->Normals; }
  /// What ComputeCurvature found; null before, for tensors and for images.
  vtkFloatArray* GetCurvature() const { return this->Fields->Curvature; }

  /// Tensors times `factor` are the metric itself; without effect on vectors.
  void TakeTensorsAsMetrics(double factor);

  /// StreakLength, Strength and EigenvalueSum of each sample from arrays, of which one at least is
  /// there.
  void SetShapes(const ShapeArrays& arrays);

  /// Curvature of the streamlines, where the kernel does not find it itself; of noise with this FeatureSize.
  void ComputeCurvature(double featureSize);

  /// Has samples evaluated in another order than theirs where that is faster, with the same values.
  void FindOrder();

  /// Why a sample has no direction and lends none to its neighbours; it gets isotropic noise.
  enum WhyLeftOut : unsigned char
  {
    IsHidden = 1,
    IsTooLong = 2
  };
  /// One value for each sample, 0 if it is not left out; empty where none is.
  const std::vector<unsigned char>& GetLeftOut() const { return this->LeftOut; }

  /// Noise of the parts [begin, end) into an array of GetNumberOfSamples() values.
  steerable::EvaluationCounts Evaluate(const steerable::SteerableNoise& kernel, std::size_t begin,
    std::size_t end, float* noise) const;

  /// The metrics (6 components) of the samples [begin, end), in world axes.
  void EvaluateMetrics(const steerable::NoiseParameters& parameters, vtkIdType begin, vtkIdType end,
    double* metrics) const;

private:
  void SetGrid(vtkImageData* image);
  void SetPoints();
  void SetLeftOut(double limit);
  /// Whether a structured grid is closed along an axis at the row with this first cell.
  bool DoCellsMeet(int axis, vtkIdType cell) const;
  /// Unit normals of samples on cells of dimension 2, 0 for the others; null if all are.
  vtkSmartPointer<vtkFloatArray> ComputeNormals();
  vtkSmartPointer<vtkFloatArray> ComputeSlabNormals() const;
  vtkSmartPointer<vtkFloatArray> FindCurvature(double featureSize);
  const CoincidentPoints& GetCopies();

  vtkDataSet* DataSet;
  vtkDataArray* Array;
  bool Cells;
  Plane InPlane;
  Shape TakenAs;
  HiddenSamples Hidden;
  std::vector<unsigned char> LeftOut;
  int Dimension = 3;
  steerable::ImageGrid Grid;
  Axes InAxes = WorldAxes;
  steerable::Field Field;
  std::unique_ptr<steerable::TupleReader<float>> Steering;
  std::unique_ptr<steerable::TupleReader<double>> Metrics;
  std::unique_ptr<steerable::TupleReader<float>> Shapes;
  std::unique_ptr<steerable::TupleReader<float>> NormalReader;
  std::unique_ptr<steerable::TupleReader<float>> CurvatureReader;
  std::unique_ptr<steerable::TupleReader<double>> Positions;
  std::unique_ptr<CoincidentPoints> Copies;
  SampleFields Own;
  SampleFields* Fields;
  vtkSmartPointer<vtkDataArray> CellCenters;
};

/**
 * How far apart neighbouring samples are along the axes of the world: the largest distance of all images,
 * and the sum of the distances in cells with their number. They combine by maximum and sum.
 */
struct SampleSpacing
{
  double Largest[3] = { 0.0, 0.0, 0.0 };
  double Sum[3] = { 0.0, 0.0, 0.0 };
  double Count = 0.0;

  /**
   * Adds a dataset with samples at its points or, `centers`, one in each of its cells. What a cell tells is
   * the spacing of a lattice with the same number of samples and the same variance of their places along
   * each axis; strips and lines count as their triangles and segments, polygons by their edges, and
   * vertices by the distance of the nearest other place. Ghosts and hidden cells are left out, and of more
   * than `cellsAtMost` cells an even choice is looked at. `slab`: Shape's.
   */
  void Add(vtkDataSet* dataset, bool centers, int slab, const HiddenSamples& hidden,
    vtkIdType cellsAtMost);

  void Add(const SampleSpacing& other);
  /// Along the axes, in one cell; none where one is not finite.
  void Add(const Eigen::Array3d& distances);
};
} // namespace noise

#endif
