// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * From a vector or a tensor to the symmetric positive definite metric that noise is measured with
 * (Rice, supplementary, section 1; surfaces and strength: Documentation/noise-model.md).
 *
 * All metrics of this kernel have the form G = b I + (k - b) u uT + (e - b) m mT: eigenvalue k along
 * the flow u, e along a second axis m (the normal of a surface, or the minor axis of a tensor) and b
 * across. Distances along u are short, so features stretch along it.
 */
#ifndef MetricTensor_h
#define MetricTensor_h

#include "NoiseParameters.h"
#include "Surflet.h"

#include <Eigen/Core>

#include <cmath>

namespace steerable
{
template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

/// Eigenvalues of the metric along the flow and across it.
struct EigenvalueRange
{
  double Along;
  double Across;
};

/// k = GetAlongEigenvalue(), b = (EigenvalueSum - k) / (N - 1) - 1e-4, never below k.
EigenvalueRange VectorEigenvalues(const NoiseParameters& parameters, int dimension);

/// On a surface the normal takes 0.5 of the trace and the one direction across gets the rest.
EigenvalueRange SurfaceEigenvalues(const NoiseParameters& parameters);
constexpr double SurfaceNormalEigenvalue = 0.5;

template <int N>
struct AxialMetric
{
  /// u: unit vector along the flow; the first axis where there is no direction.
  Vector<N> Direction = Vector<N>::UnitX();
  /// m: unit vector, orthogonal to u.
  Vector<N> SecondAxis = Vector<N>::UnitY();
  double Along = 1.0;
  double Across = 1.0;
  double Second = 1.0;
  /**
   * How clear the direction is, 0 to 1: a tensor whose two largest eigenvalues are nearly the same has
   * a plane rather than a direction, and its curvature means nothing.
   */
  double Clarity = 1.0;
  /// Curvature vector of the streamline in cells, at most 1 long.
  Vector<N> Bend = Vector<N>::Zero();
  /// No direction could be had (zero, NaN, infinite or isotropic input): the metric is I.
  bool Degenerate = true;

  Matrix<N> ToMatrix() const
  {
    return this->Across * Matrix<N>::Identity() +
      (this->Along - this->Across) * this->Direction * this->Direction.transpose() +
      (this->Second - this->Across) * this->SecondAxis * this->SecondAxis.transpose();
  }
};

/**
 * Parameters with the StreakLength, Strength and EigenvalueSum of one sample, kept within their
 * ranges; what is not finite is that of all samples. Along with them goes the sum's limit of 4
 * where weights divide.
 */
NoiseParameters WithShape(const NoiseParameters& parameters, const float* shape);

/// Strength in [0, 1] of a vector or tensor of this magnitude.
double StrengthOf(const NoiseParameters& parameters, double magnitude);

/// Metric of a tensor: the closed form of the supplementary's eigenvalue remap.
template <int N>
AxialMetric<N> MetricFromVector(const NoiseParameters& parameters, const Vector<N>& vector);

/**
 * The same of the part in a plane of a vector with this `length`: its strength is that of the whole vector, as
 * on surfaces, and where next to nothing is in the plane there is no direction.
 */
template <int N>
AxialMetric<N> MetricFromVector(
  const NoiseParameters& parameters, const Vector<N>& inPlane, double length);

/// A vector of length 1 has no direction in a plane that it stands on: this much of it is rounding.
constexpr double SmallestInPlane = 1e-5;

/// Length of a vector (norm of a tensor) from its part in a plane and the rest, which counts if it is finite.
inline double WholeLength(double inPlane, double across)
{
  return std::isfinite(across) ? std::hypot(inPlane, across) : inPlane;
}

/// The rest of a tensor, XX YY ZZ XY YZ XZ, whose plane is x-y.
template <typename Value>
double AcrossPlane(const Value* tuple)
{
  const double inRow = std::hypot(double(tuple[4]), double(tuple[5]));
  return std::sqrt(double(tuple[2]) * tuple[2] + 2.0 * inRow * inRow);
}

/**
 * Vector on a surface with this normal, projected on the tangent plane. The normal may have any
 * length; 0 or not finite: not on a surface, the metric is that of the vector in space.
 */
AxialMetric<3> MetricFromSurfaceVector(
  const NoiseParameters& parameters, const Vector<3>& vector, const Vector<3>& normal);

/**
 * Symmetric part of a tensor through Eigen's direct solver; the eigenvalues are mapped linearly onto
 * [k, b] so that the largest becomes k.
 */
template <int N>
AxialMetric<N> MetricFromTensor(const NoiseParameters& parameters, const Matrix<N>& tensor);

/// The same with the strength of a tensor of this Frobenius `norm`, of which `inPlane` is a part.
template <int N>
AxialMetric<N> MetricFromTensor(
  const NoiseParameters& parameters, const Matrix<N>& inPlane, double norm);

/**
 * Eigenvalues between which a metric of the user's own is taken as it is. The least, 1/400, reaches
 * as far as the longest streak; with LatticeWindow, which ends surflets anyway, 1/1000.
 */
inline EigenvalueRange MetricBounds(const NoiseParameters& parameters)
{
  return { parameters.LatticeWindow ? 1e-3 : 1.0 / 400.0, 16.0 };
}

/**
 * Symmetric part of a metric in units of 1 / cells² (Rice: "a metric tensor G of the users
 * choice"), at the given Strength but otherwise as it is: eigenvalues beyond MetricBounds are moved
 * to them, `bounded` then. Zero and what is not finite is no metric. `norm` is that of the whole
 * tensor where this is its part in a plane.
 */
template <int N>
AxialMetric<N> MetricFromMetric(
  const NoiseParameters& parameters, const Matrix<N>& metric, double norm, bool* bounded = nullptr);

/**
 * Frobenius norm of the whole tensor of a tuple, XX YY ZZ XY YZ XZ; `tensor` is what TensorOf takes
 * from it.
 */
template <int N, typename Value>
double NormOf(const Matrix<N>& tensor, const Value* tuple)
{
  const double norm = tensor.norm();
  return N == 2 ? WholeLength(norm, AcrossPlane(tuple)) : norm;
}

/// Symmetric tensor from 6 components, XX YY ZZ XY YZ XZ.
template <int N, typename Value>
Matrix<N> TensorOf(const Value* tuple)
{
  Matrix<N> tensor;
  if constexpr (N == 2)
  {
    tensor << tuple[0], tuple[3], tuple[3], tuple[1];
  }
  else
  {
    tensor << tuple[0], tuple[3], tuple[5], tuple[3], tuple[1], tuple[4], tuple[5], tuple[4],
      tuple[2];
  }
  return tensor;
}

/**
 * Bends the metric along the streamline's parabola: curvature d in 1/cells, |d| clamped to 1, the
 * half-length limited to the radius of curvature, and isotropic as |d| reaches 1 (Curvature).
 */
template <int N>
void ApplyCurvature(AxialMetric<N>& metric, const Vector<N>& curvature);

/// Share of the anisotropy across the flow that a streamline of curvature |d| <= 1 keeps.
inline double CurvatureKeeps(double curvatureSquared)
{
  return 1.0 - curvatureSquared;
}
} // namespace steerable

#endif
