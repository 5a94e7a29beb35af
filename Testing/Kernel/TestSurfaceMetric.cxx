// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SurfaceMetric.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace steerable;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace
{
const std::array<Vector3d, 3> Points = { Vector3d(1.0, 2.0, 3.0), Vector3d(2.0, 2.5, 3.0),
  Vector3d(0.5, 3.0, 4.0) };
const std::array<Vector2d, 3> Texture = { Vector2d(0.1, 0.2), Vector2d(0.5, 0.3),
  Vector2d(0.2, 0.6) };
} // namespace

TEST(SurfaceMetric, GradientsReproduceTextureSteps)
{
  TextureGradients gradients;
  ASSERT_EQ(TriangleGradients(Points, Texture, false, gradients), TriangleMapping::Regular);
  for (int corner = 1; corner < 3; ++corner)
  {
    const Vector2d step = gradients.transpose() * (Points[corner] - Points[0]);
    EXPECT_LE((step - (Texture[corner] - Texture[0])).norm(), 1e-14);
  }
  const Vector3d normal = (Points[1] - Points[0]).cross(Points[2] - Points[0]);
  EXPECT_LE((gradients.transpose() * normal).norm(), 1e-14) << "gradients are tangent";
}

TEST(SurfaceMetric, IsInverseFirstFundamentalForm)
{
  TextureGradients gradients;
  TriangleGradients(Points, Texture, false, gradients);
  Eigen::Matrix<double, 3, 2> edges;
  Eigen::Matrix2d steps;
  for (int e = 0; e < 2; ++e)
  {
    edges.col(e) = Points[e + 1] - Points[0];
    steps.row(e) = Texture[e + 1] - Texture[0];
  }
  const Eigen::Matrix2d gram = edges.transpose() * edges;
  const Eigen::Matrix2d expected = 9.0 * steps.transpose() * gram.inverse() * steps;
  const Eigen::Matrix2d metric = SurfaceMetric(gradients, IsotropicFeature(3.0));
  EXPECT_LE((metric - expected).norm(), 1e-13);

  // Neither the order of the corners nor the position of the triangle matters.
  TextureGradients other;
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  ASSERT_EQ(TriangleGradients({ turn * Points[2], turn * Points[0], turn * Points[1] },
              { Texture[2], Texture[0], Texture[1] }, false, other),
    TriangleMapping::Regular);
  EXPECT_LE((SurfaceMetric(other, IsotropicFeature(3.0)) - metric).norm(), 1e-13);
}

TEST(SurfaceMetric, TrianglesWithoutMetricAreReported)
{
  TextureGradients gradients;
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  auto classify = [&](const std::array<Vector3d, 3>& points, const std::array<Vector2d, 3>& uv)
  { return TriangleGradients(points, uv, false, gradients); };
  EXPECT_EQ(classify(Points, { Texture[0], Texture[2], Texture[1] }), TriangleMapping::Flipped);
  EXPECT_GT(gradients.norm(), 0.0);
  EXPECT_EQ(classify(Points, { Texture[0], Texture[1], Texture[1] }), TriangleMapping::Singular);
  EXPECT_EQ(gradients.norm(), 0.0);
  EXPECT_EQ(classify(Points, { Texture[0], Texture[0], Texture[0] }), TriangleMapping::Singular);
  EXPECT_EQ(classify({ Points[0], Points[1], Points[0] }, Texture), TriangleMapping::Degenerate);
  EXPECT_EQ(classify({ Points[0], Points[0], Points[0] }, Texture), TriangleMapping::Degenerate);
  EXPECT_EQ(classify({ Points[0], Points[1], 0.5 * (Points[0] + Points[1]) }, Texture),
    TriangleMapping::Degenerate);
  EXPECT_EQ(classify({ Points[0], Points[1], Vector3d(nan, 0.0, 0.0) }, Texture),
    TriangleMapping::Degenerate);
  EXPECT_EQ(
    classify(Points, { Texture[0], Texture[1], Vector2d(nan, 0.0) }), TriangleMapping::Degenerate);
  EXPECT_EQ(gradients.norm(), 0.0);
  // Small is not degenerate.
  EXPECT_EQ(classify({ 1e-6 * Points[0], 1e-6 * Points[1], 1e-6 * Points[2] }, Texture),
    TriangleMapping::Regular);
}

TEST(SurfaceMetric, SeamsWrapOnRequest)
{
  EXPECT_LE((WrapSeam(Vector2d(-0.9, 0.3)) - Vector2d(0.1, 0.3)).norm(), 1e-15);
  std::array<Vector2d, 3> texture = Texture;
  texture[1] += Vector2d(-1.0, 0.0);
  texture[2] += Vector2d(0.0, 2.0);
  TextureGradients wrapped, expected;
  EXPECT_EQ(TriangleGradients(Points, texture, true, wrapped), TriangleMapping::Regular);
  TriangleGradients(Points, Texture, false, expected);
  EXPECT_LE((wrapped - expected).norm(), 1e-13);
  TriangleGradients(Points, texture, false, wrapped);
  EXPECT_GT((wrapped - expected).norm(), 0.1);
}

TEST(SurfaceMetric, PlanarProjection)
{
  const Vector3d n = Vector3d(0.3, -0.5, 0.8).normalized();
  const double length = 2.5;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int x = axis == 0 ? 1 : 0, y = axis == 2 ? 1 : 2;
    Eigen::Matrix2d expected;
    expected << 1.0 - n[x] * n[x], -n[x] * n[y], -n[x] * n[y], 1.0 - n[y] * n[y];
    const Eigen::Matrix2d metric =
      SurfaceMetric(PlanarGradients(n, axis, length), IsotropicFeature(1.0));
    EXPECT_LE((metric - expected / (length * length)).norm(), 1e-15) << axis;
  }
}

TEST(SurfaceMetric, TriplanarBlendKeepsVarianceAndAvoidsGrazingProjections)
{
  for (int a = 0; a <= 40; ++a)
  {
    for (int b = 0; b <= 40; ++b)
    {
      const double theta = std::acos(-1.0) * a / 40, phi = 2.0 * std::acos(-1.0) * b / 40;
      const Vector3d normal(
        std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const Vector3d weights = TriplanarBlend(normal);
      EXPECT_NEAR(weights.squaredNorm(), 1.0, 1e-14);
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_GE(weights[axis], 0.0);
        EXPECT_TRUE(std::abs(normal[axis]) > 0.25 || weights[axis] == 0.0);
      }
    }
  }
}

TEST(SurfaceMetric, SpacingFormIsThatOfTheLattice)
{
  using Corners = std::array<Eigen::Vector3d, 3>;
  const Eigen::Matrix3d turn =
    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
  // Half a rectangle: its sides.
  const Corners half = { turn * Eigen::Vector3d(0.0, 0.0, 0.0), turn * Eigen::Vector3d(3.0, 0.0, 0.0),
    turn * Eigen::Vector3d(0.0, 0.5, 0.0) };
  Eigen::Matrix3d expected = turn * Eigen::Vector3d(9.0, 0.25, 0.0).asDiagonal() * turn.transpose();
  EXPECT_TRUE(SpacingForm(half).isApprox(expected, 1e-12)) << SpacingForm(half);
  // The order of the corners does not matter.
  EXPECT_TRUE(SpacingForm({ half[2], half[0], half[1] }).isApprox(expected, 1e-12));
  // Equilateral: the same in its plane.
  const Corners even = { turn * Eigen::Vector3d(0.0, 0.0, 0.0), turn * Eigen::Vector3d(2.0, 0.0, 0.0),
    turn * Eigen::Vector3d(1.0, std::sqrt(3.0), 0.0) };
  expected = turn * Eigen::Vector3d(3.0, 3.0, 0.0).asDiagonal() * turn.transpose();
  EXPECT_TRUE(SpacingForm(even).isApprox(expected, 1e-12)) << SpacingForm(even);
  // Obtuse: the two short sides.
  const Corners sheared = { Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(1.0, 0.0, 0.0),
    Eigen::Vector3d(2.0, 1.0, 0.0) };
  Eigen::Matrix3d sides = Eigen::Matrix3d::Zero();
  sides.topLeftCorner<2, 2>() << 2.0, 1.0, 1.0, 1.0; // (1, 0) and (1, 1)
  sides *= 0.5 * (1.0 + 2.0 + 5.0) / 3.0;
  EXPECT_TRUE(SpacingForm(sheared).isApprox(sides, 1e-12)) << SpacingForm(sheared);
  EXPECT_TRUE(SpacingForm({ half[0], half[0], half[0] }).isZero(0.0));
}

TEST(SurfaceMetric, SteeredFeature)
{
  const Vector3d t(3.0, 0.0, 4.0);
  const Eigen::Matrix3d feature = SteeredFeature(2.0, t, 4.0);
  EXPECT_LE((feature * t - 16.0 * t).norm(), 1e-13);
  const Vector3d across(0.0, 5.0, 0.0);
  EXPECT_LE((feature * across - across).norm(), 1e-13);
  EXPECT_EQ((SteeredFeature(2.0, -t, 4.0) - feature).norm(), 0.0);
  EXPECT_LE((SteeredFeature(2.0, t, 1.0) - IsotropicFeature(2.0)).norm(), 1e-14);
  EXPECT_EQ(SteeredFeature(2.0, Vector3d::Zero(), 4.0), IsotropicFeature(2.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(SteeredFeature(2.0, Vector3d(nan, 0.0, 1.0), 4.0), IsotropicFeature(2.0));
}

TEST(SurfaceMetric, TextureBlendGivesWayAtSeamsAndWhereTheTextureIsStretched)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double half = std::sqrt(0.5); // as much power as the projections
  for (const double followed : { 1.5, 4.0 })
  {
    EXPECT_EQ(TextureBlend(1.0, followed, infinity), 1.0);
    EXPECT_EQ(TextureBlend(followed, followed, 1.0), 1.0);
    EXPECT_EQ(TextureBlend(1.0, followed, 0.0), 0.0);
    EXPECT_EQ(TextureBlend(1.5 * followed, followed, infinity), 0.0);
    EXPECT_EQ(TextureBlend(infinity, followed, infinity), 0.0);
    EXPECT_NEAR(TextureBlend(1.0, followed, 0.5), half, 1e-12);
    EXPECT_NEAR(TextureBlend(1.25 * followed, followed, infinity), half, 1e-12);
    double last = 0.0;
    for (double distance = 0.05; distance < 1.0; distance += 0.05)
    {
      EXPECT_GT(TextureBlend(1.0, followed, distance), last);
      last = TextureBlend(1.0, followed, distance);
    }
  }
}
