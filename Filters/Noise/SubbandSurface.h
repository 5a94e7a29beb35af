// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * A surface as subband noise sees it (private to this module): triangles around points, how the texture
 * lies on them, and what steers the noise there.
 */
#ifndef SubbandSurface_h
#define SubbandSurface_h

#include "Subband/SurfaceMetric.h"

#include "vtkType.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

class vtkDataArray;
class vtkPolyData;

namespace noise
{
/**
 * Sums over the triangles of all surfaces. Each is a whole number, areas too (in units of the squared
 * diagonal of the bounds times 2^-40), so that their order over blocks and ranks does not show.
 */
struct SurfaceSums
{
  enum Entry
  {
    Triangles,
    Area,
    RegularArea,
    FlippedArea,
    Regular,
    Flipped,
    Singular,
    Degenerate,
    TexturedBlocks,
    ProjectedBlocks,
    OtherBlocks,
    EntryCount
  };

  // Areas over the octaves of the singular values of T, in repeats per diagonal of the bounds.
  static constexpr int BinsPerOctave = 16;
  static constexpr int Octaves = 96;
  static constexpr int Bins = BinsPerOctave * Octaves;

  std::vector<double> Values = std::vector<double>(EntryCount + 2 * Bins, 0.0);

  double& operator[](Entry entry) { return this->Values[entry]; }
  double operator[](Entry entry) const { return this->Values[entry]; }
  SurfaceSums& operator+=(const SurfaceSums& other)
  {
    std::transform(this->Values.begin(), this->Values.end(), other.Values.begin(),
      this->Values.begin(), std::plus<>());
    return *this;
  }
  double* Smaller() { return this->Values.data() + EntryCount; }
  double* Larger() { return this->Values.data() + EntryCount + Bins; }
  const double* Smaller() const { return this->Values.data() + EntryCount; }
  const double* Larger() const { return this->Values.data() + EntryCount + Bins; }

  static int BinOf(double octaves);
  /// In units of the squared diagonal times 2^-40.
  static double RoundArea(double area, double diagonal);
  static double OctavesOf(int bin) { return (bin + 0.5) / BinsPerOctave - 0.5 * Octaves; }
};

/// A steering array; Values is null where nothing steers.
struct SteeringVectors
{
  const float* Values = nullptr; ///< Three components.
  bool Cells = false;
};

class SubbandSurface
{
public:
  /// Null texture coordinates: planar projections, which else are there on demand. Throws
  /// std::bad_alloc.
  SubbandSurface(
    vtkPolyData* mesh, vtkDataArray* texture, bool wrapSeams, bool projections = false);

  vtkIdType GetNumberOfPoints() const { return static_cast<vtkIdType>(this->Points.size()); }
  bool IsTextured() const { return !this->Texture.empty(); }
  const Eigen::Vector3d& GetPoint(vtkIdType point) const { return this->Points[point]; }
  const Eigen::Vector2d& GetTexture(vtkIdType point) const { return this->Texture[point]; }

  /// Unit normal of a point: the mesh's own, else that of its triangles; false where there is none.
  bool GetNormal(vtkIdType point, Eigen::Vector3d& normal) const;

  /// Adds the triangles that are not ghosts. `diagonal` of the bounds of all surfaces.
  void AddTo(SurfaceSums& sums, double diagonal) const;

  /// Charts: triangles joined by points at which the texture does not jump.
  struct Charts
  {
    double Count = 0.0;
    double Area = 0.0;
    double WholeArea = 0.0; ///< Of all charts.
  };
  /// Those whose area is less than that of a square with this side. Ghosts have a part in charts, but no area.
  Charts FindChartsBelow(double side) const;

  /**
   * Points at which texture coordinates jump by other steps than whole repeats, as they do where
   * many meet at a pole, or turn back, between a triangle that is mirrored and one that is not.
   */
  std::vector<vtkIdType> FindSeams() const;

  /// Triangles of this mapping count only where a point has no others.
  void Avoid(steerable::TriangleMapping mapping) { this->Avoided = mapping; }

  /// Metrics at a point for wavelength one, with texture coordinates in repeats of the mesh's own.
  struct PointMetrics
  {
    Eigen::Matrix2d Metric = Eigen::Matrix2d::Zero();    ///< Steered.
    Eigen::Matrix2d Isotropic = Eigen::Matrix2d::Zero(); ///< Of the texture alone.
    Eigen::Matrix2d Footprint = Eigen::Matrix2d::Zero(); ///< J J^T of the points' spacing.
    bool Directed = false; ///< Some vector had a direction in the surface.
  };

  /// The mean over the triangles around a point, by area. False where there are none.
  bool ComputeTextured(vtkIdType point, const SteeringVectors& vectors, double anisotropy,
    PointMetrics& metrics) const;

  /// What is needed to do the same with planar projections.
  struct PointFeatures
  {
    Eigen::Vector3d Normal;
    Eigen::Matrix3d Feature; ///< B for wavelength one.
    Eigen::Matrix3d Spacing; ///< SpacingForm.
    bool Directed = false;
  };
  bool ComputeProjected(vtkIdType point, const SteeringVectors& vectors, double anisotropy,
    PointFeatures& features) const;

private:
  struct Triangle
  {
    std::array<vtkIdType, 3> Points;
    vtkIdType Cell;
    bool Ghost;
    double Area = 0.0; ///< 0 where there is none.
    Eigen::Matrix3d Spacing = Eigen::Matrix3d::Zero();
  };
  struct Mapping
  {
    steerable::TextureGradients Gradients;
    steerable::TriangleMapping Kind;
  };

  void Triangulate(vtkPolyData* mesh);
  void MeasureTriangles(bool wrapSeams);
  void LinkPoints();
  void JoinSeams();
  void ShareNormals(vtkPolyData* mesh);

  std::vector<Eigen::Vector3d> Points;
  std::vector<Eigen::Vector2d> Texture;
  std::vector<Eigen::Vector3d> Normals; // the mesh's own; may be empty
  std::vector<Triangle> Triangles;
  std::vector<Mapping> Mappings;    // with texture coordinates
  std::vector<vtkIdType> LinkStart; // triangles around point p: Links[LinkStart[p]..LinkStart[p+1]]
  std::vector<vtkIdType> Links;
  std::vector<vtkIdType> NextCopy; // a ring through all copies of a point
  std::vector<vtkIdType> Jumps;    // one point of each place with several rings
  steerable::TriangleMapping Avoided = steerable::TriangleMapping::Singular; // always left out
};
} // namespace noise

#endif
