// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MetricTensor.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace steerable
{
namespace
{
/// Unit vector of any finite vector, however long or short; false where there is none.
template <int N>
bool Normalize(const Vector<N>& vector, Vector<N>& unit)
{
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !vector.allFinite())
  {
    return false;
  }
  unit = (vector / largest).normalized();
  return true;
}

double Blend(double eigenvalue, double strength)
{
  return 1.0 + strength * (eigenvalue - 1.0);
}
} // namespace

EigenvalueRange VectorEigenvalues(const NoiseParameters& parameters, int dimension)
{
  const double along = parameters.GetAlongEigenvalue();
  const double across = (parameters.EigenvalueSum - along) / (dimension - 1) - 1e-4;
  return { along, std::max(along, across) };
}

EigenvalueRange SurfaceEigenvalues(const NoiseParameters& parameters)
{
  const double along = parameters.GetAlongEigenvalue();
  const double across = parameters.EigenvalueSum - along - SurfaceNormalEigenvalue - 1e-4;
  return { along, std::max(along, across) };
}

NoiseParameters WithShape(const NoiseParameters& parameters, const float* shape)
{
  NoiseParameters own = parameters;
  const auto take = [](double& value, double given, double least, double most)
  { value = std::isfinite(given) ? std::min(std::max(given, least), most) : value; };
  take(own.StreakLength, shape[0], 1.0, 20.0);
  take(own.Strength, shape[1], 0.0, 1.0);
  take(own.EigenvalueSum, shape[2], 2.0,
    parameters.Normalization == Normalization::WeightSum ? 4.0 : 16.0);
  return own;
}

double StrengthOf(const NoiseParameters& parameters, double magnitude)
{
  if (parameters.StrengthMode == StrengthMode::Magnitude)
  {
    return parameters.Strength * std::min(1.0, magnitude / parameters.ReferenceMagnitude);
  }
  return parameters.Strength;
}

template <int N>
AxialMetric<N> MetricFromVector(const NoiseParameters& parameters, const Vector<N>& vector)
{
  return MetricFromVector<N>(parameters, vector, vector.stableNorm());
}

template <int N>
AxialMetric<N> MetricFromVector(
  const NoiseParameters& parameters, const Vector<N>& inPlane, double length)
{
  AxialMetric<N> metric;
  Vector<N> direction;
  if (Normalize<N>(inPlane, direction) && !(inPlane.stableNorm() <= SmallestInPlane * length))
  {
    const EigenvalueRange range = VectorEigenvalues(parameters, N);
    const double strength = StrengthOf(parameters, length);
    metric.Direction = direction;
    metric.SecondAxis = metric.Direction.unitOrthogonal();
    metric.Along = Blend(range.Along, strength);
    metric.Across = Blend(range.Across, strength);
    metric.Second = metric.Across;
    metric.Degenerate = false;
  }
  return metric;
}

AxialMetric<3> MetricFromSurfaceVector(
  const NoiseParameters& parameters, const Vector<3>& vector, const Vector<3>& normal)
{
  if (normal.isZero(0.0) || !normal.allFinite())
  {
    return MetricFromVector<3>(parameters, vector);
  }
  AxialMetric<3> metric;
  Vector<3> direction;
  Vector<3> unitNormal;
  Vector<3> inPlane;
  // A vector along the normal has no direction on the surface: what is left of it is rounding.
  if (!Normalize<3>(vector, direction) || !Normalize<3>(normal, unitNormal) ||
    !((inPlane = direction - direction.dot(unitNormal) * unitNormal).norm() > SmallestInPlane))
  {
    return metric;
  }
  const EigenvalueRange range = SurfaceEigenvalues(parameters);
  const double strength = StrengthOf(parameters, vector.norm());
  metric.Direction = inPlane.normalized();
  metric.SecondAxis = unitNormal;
  metric.Along = Blend(range.Along, strength);
  metric.Across = Blend(range.Across, strength);
  metric.Second = Blend(SurfaceNormalEigenvalue, strength);
  metric.Degenerate = false;
  return metric;
}

template <int N>
AxialMetric<N> MetricFromTensor(const NoiseParameters& parameters, const Matrix<N>& tensor)
{
  return MetricFromTensor<N>(parameters, tensor, tensor.norm());
}

template <int N>
AxialMetric<N> MetricFromTensor(
  const NoiseParameters& parameters, const Matrix<N>& tensor, double norm)
{
  AxialMetric<N> metric;
  const double largest = tensor.cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !tensor.allFinite())
  {
    return metric;
  }
  const Matrix<N> scaled = tensor / largest;
  Eigen::SelfAdjointEigenSolver<Matrix<N>> solver;
  solver.computeDirect(0.5 * (scaled + scaled.transpose()));
  const Vector<N> lambda = solver.eigenvalues(); // in increasing order
  const double spread = lambda[N - 1] - lambda[0];
  if (!(spread > 1e-7))
  {
    return metric; // isotropic: no direction is the major one
  }
  const EigenvalueRange range = VectorEigenvalues(parameters, N);
  const double strength = StrengthOf(parameters, norm);
  const auto remap = [&](double value)
  {
    return Blend(
      range.Across + (range.Along - range.Across) * (value - lambda[0]) / spread, strength);
  };
  metric.Direction = solver.eigenvectors().col(N - 1).normalized();
  metric.Along = remap(lambda[N - 1]);
  metric.Across = remap(lambda[0]);
  // In 2D the flow and the direction across are all there is.
  metric.SecondAxis = N == 2 ? Vector<N>(metric.Direction.unitOrthogonal())
                             : Vector<N>(solver.eigenvectors().col(N / 2).normalized());
  metric.Second = N == 2 ? metric.Across : remap(lambda[N / 2]);
  metric.Clarity = N == 2 ? 1.0 : (lambda[N - 1] - lambda[N / 2]) / spread;
  metric.Degenerate = false;
  return metric;
}

template <int N>
AxialMetric<N> MetricFromMetric(
  const NoiseParameters& parameters, const Matrix<N>& tensor, double norm, bool* bounded)
{
  AxialMetric<N> metric;
  const double largest = tensor.cwiseAbs().maxCoeff();
  if (!(largest > 0.0) || !tensor.allFinite())
  {
    return metric;
  }
  // Not the direct solver, which loses half of the digits where two eigenvalues are alike.
  const Matrix<N> scaled = tensor / largest;
  const Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(0.5 * (scaled + scaled.transpose()));
  const Vector<N> lambda = largest * solver.eigenvalues(); // in increasing order
  const double strength = StrengthOf(parameters, norm);
  const EigenvalueRange bounds = MetricBounds(parameters);
  const auto bound = [&](double eigenvalue)
  { return Blend(std::min(std::max(eigenvalue, bounds.Along), bounds.Across), strength); };
  const double rounding = 1e-6;
  if (bounded)
  {
    *bounded = lambda[0] < (1.0 - rounding) * bounds.Along ||
      lambda[N - 1] > (1.0 + rounding) * bounds.Across;
  }
  metric.Direction = solver.eigenvectors().col(0).normalized();
  metric.Along = bound(lambda[0]);
  metric.Across = bound(lambda[N - 1]);
  metric.SecondAxis = N == 2 ? Vector<N>(metric.Direction.unitOrthogonal())
                             : Vector<N>(solver.eigenvectors().col(N / 2).normalized());
  metric.Second = N == 2 ? metric.Across : bound(lambda[N / 2]);
  const double spread = lambda[N - 1] - lambda[0];
  metric.Clarity = !(spread > 1e-7 * largest) ? 0.0
    : N == 2                                  ? 1.0
                                              : (lambda[N / 2] - lambda[0]) / spread;
  metric.Degenerate = false;
  return metric;
}

template <int N>
void ApplyCurvature(AxialMetric<N>& metric, const Vector<N>& curvature)
{
  if (metric.Degenerate || !curvature.allFinite())
  {
    return;
  }
  // A unit vector only turns: what differences leave along the flow is their error.
  const Vector<N> turning =
    metric.Clarity * (curvature - curvature.dot(metric.Direction) * metric.Direction);
  const double length = turning.norm();
  metric.Bend = length > 1.0 ? Vector<N>(turning / length) : turning;
  const double squared = std::min(1.0, length * length);
  const double keeps = CurvatureKeeps(squared);
  metric.Along = std::max(metric.Along, squared);
  metric.Across = Blend(metric.Across, keeps);
  metric.Second = Blend(metric.Second, keeps);
}

template AxialMetric<2> MetricFromVector<2>(const NoiseParameters&, const Vector<2>&);
template AxialMetric<3> MetricFromVector<3>(const NoiseParameters&, const Vector<3>&);
template AxialMetric<2> MetricFromVector<2>(const NoiseParameters&, const Vector<2>&, double);
template AxialMetric<3> MetricFromVector<3>(const NoiseParameters&, const Vector<3>&, double);
template AxialMetric<2> MetricFromTensor<2>(const NoiseParameters&, const Matrix<2>&);
template AxialMetric<3> MetricFromTensor<3>(const NoiseParameters&, const Matrix<3>&);
template AxialMetric<2> MetricFromTensor<2>(const NoiseParameters&, const Matrix<2>&, double);
template AxialMetric<3> MetricFromTensor<3>(const NoiseParameters&, const Matrix<3>&, double);
template AxialMetric<2> MetricFromMetric<2>(
  const NoiseParameters&, const Matrix<2>&, double, bool*);
template AxialMetric<3> MetricFromMetric<3>(
  const NoiseParameters&, const Matrix<3>&, double, bool*);
template void ApplyCurvature<2>(AxialMetric<2>&, const Vector<2>&);
template void ApplyCurvature<3>(AxialMetric<3>&, const Vector<3>&);
} // namespace steerable
