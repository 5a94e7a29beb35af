// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SurfaceMetric.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace steerable
{
namespace
{
// A triangle whose sine between edges is below this is a line.
constexpr double SmallestSine = 1e-10;

// 0 up to `low`, 1 from `high` on, smooth in between.
double SmoothStep(double low, double high, double x)
{
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}
} // namespace

Eigen::Vector2d WrapSeam(const Eigen::Vector2d& step)
{
  return step - step.array().round().matrix();
}

TriangleMapping TriangleGradients(const std::array<Eigen::Vector3d, 3>& points,
  const std::array<Eigen::Vector2d, 3>& texture, bool wrapSeams, TextureGradients& gradients)
{
  gradients.setZero();
  Eigen::Matrix<double, 3, 2> edges;
  Eigen::Matrix2d steps; // one row per edge
  for (int e = 0; e < 2; ++e)
  {
    edges.col(e) = points[e + 1] - points[0];
    const Eigen::Vector2d step = texture[e + 1] - texture[0];
    steps.row(e) = wrapSeams ? WrapSeam(step) : step;
  }

  const double edgeProduct = edges.col(0).norm() * edges.col(1).norm();
  const double area = edges.col(0).cross(edges.col(1)).norm();
  if (!edges.allFinite() || !steps.allFinite() || !(area > SmallestSine * edgeProduct))
  {
    return TriangleMapping::Degenerate;
  }
  const double textureArea = steps.determinant();
  if (!(std::abs(textureArea) > SmallestSine * steps.row(0).norm() * steps.row(1).norm()))
  {
    return TriangleMapping::Singular;
  }
  const Eigen::Matrix2d gram = edges.transpose() * edges;
  gradients = edges * gram.inverse() * steps;
  return textureArea < 0.0 ? TriangleMapping::Flipped : TriangleMapping::Regular;
}

TextureGradients PlanarGradients(const Eigen::Vector3d& normal, int axis, double repeatLength)
{
  const int first = axis == 0 ? 1 : 0;
  const int second = axis == 2 ? 1 : 2;
  TextureGradients gradients;
  gradients.col(0) = Eigen::Vector3d::Unit(first) - normal[first] * normal;
  gradients.col(1) = Eigen::Vector3d::Unit(second) - normal[second] * normal;
  return gradients / repeatLength;
}

Eigen::Vector3d TriplanarBlend(const Eigen::Vector3d& normal)
{
  Eigen::Vector3d weights;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double n = std::abs(normal[axis]);
    weights[axis] = n * n * n * n * SmoothStep(0.25, 0.5, n);
  }
  return weights.normalized();
}

double TextureBlend(double stretch, double followed, double distance)
{
  constexpr double quarter = 1.57079632679489661923;
  // Of an infinite stretch or distance too.
  const double even =
    stretch < 1.5 * followed ? 1.0 - SmoothStep(followed, 1.5 * followed, stretch) : 0.0;
  const double apart = distance < 1.0 ? SmoothStep(0.0, 1.0, distance) : 1.0;
  // A sine, and so a cosine for the rest, has no kink where it comes to 1.
  return std::sin(quarter * even * apart);
}

Eigen::Matrix3d SpacingForm(const std::array<Eigen::Vector3d, 3>& corners)
{
  std::array<Eigen::Vector3d, 3> sides = { corners[1] - corners[0], corners[2] - corners[1],
    corners[0] - corners[2] };
  std::sort(sides.begin(), sides.end(),
    [](const Eigen::Vector3d& a, const Eigen::Vector3d& b)
    { return a.squaredNorm() < b.squaredNorm(); });
  const double lengths = sides[0].norm() * sides[1].norm();
  // Of the angle opposite to the longest side, from 1/2 at 60 degrees to 0 at 90 and beyond.
  const double cosine =
    lengths > 0.0 ? std::min(0.5, std::max(0.0, std::abs(sides[0].dot(sides[1])) / lengths)) : 0.0;
  const bool obtuse =
    sides[2].squaredNorm() >= sides[0].squaredNorm() + sides[1].squaredNorm();
  const double longest = obtuse ? 0.0 : cosine;
  const Eigen::Matrix3d form =
    (1.0 - longest) * (sides[0] * sides[0].transpose() + sides[1] * sides[1].transpose()) +
    longest * sides[2] * sides[2].transpose();
  const double wanted =
    0.5 * (sides[0].squaredNorm() + sides[1].squaredNorm() + sides[2].squaredNorm());
  const double trace = form.trace();
  return trace > 0.0 ? Eigen::Matrix3d(form * (wanted / trace)) : Eigen::Matrix3d::Zero();
}

Eigen::Matrix3d IsotropicFeature(double wavelength)
{
  return wavelength * wavelength * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d SteeredFeature(
  double wavelength, const Eigen::Vector3d& direction, double anisotropy)
{
  const double length = direction.stableNorm();
  if (!(length > 0.0) || !std::isfinite(length))
  {
    return IsotropicFeature(wavelength);
  }
  const Eigen::Vector3d t = direction / length;
  return wavelength * wavelength *
    (Eigen::Matrix3d::Identity() / anisotropy +
      (anisotropy - 1.0 / anisotropy) * t * t.transpose());
}

Eigen::Matrix2d SurfaceMetric(const TextureGradients& gradients, const Eigen::Matrix3d& feature)
{
  return gradients.transpose() * feature * gradients;
}
} // namespace steerable
