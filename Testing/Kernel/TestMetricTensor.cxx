// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The metric against the supplementary's own route to it, and its behaviour at the limits.
#include "KernelTestHelpers.h"
#include "MetricTensor.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <sstream>
#include <string>

using namespace steerable;
using namespace steerable::testing;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

template <int N>
Vector<N> RandomVector(std::mt19937& random)
{
  std::normal_distribution<double> normal;
  Vector<N> vector;
  for (int axis = 0; axis < N; ++axis)
  {
    vector[axis] = normal(random);
  }
  return vector;
}

template <int N>
Matrix<N> RandomTensor(std::mt19937& random)
{
  Matrix<N> tensor;
  for (int column = 0; column < N; ++column)
  {
    tensor.col(column) = RandomVector<N>(random);
  }
  return tensor;
}

/**
 * Rice, supplementary, section 1.1: H = u uT, its eigenvalues lambda remapped to
 * mu = (k - (4 - k)/(N - 1) + eps) lambda / |u|^2 + (4 - k)/(N - 1) - eps, G = sum of mu y yT.
 */
template <int N>
Matrix<N> SupplementaryMetric(const Vector<N>& u, int quality)
{
  const double k = 0.5 / (quality + 1.0);
  const double epsilon = 0.0001;
  const Matrix<N> H = u * u.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(H);
  const double top = (4.0 - k) / (N - 1);
  Matrix<N> G = Matrix<N>::Zero();
  for (int i = 0; i < N; ++i)
  {
    const double mu =
      (k - top + epsilon) * solver.eigenvalues()[i] / u.squaredNorm() + top - epsilon;
    G += mu * solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
  }
  return G;
}

template <int N>
void ExpectSupplementaryMetric()
{
  std::mt19937 random(7);
  double largest = 0.0;
  for (int quality = 0; quality <= 8; ++quality)
  {
    const NoiseParameters parameters = PaperModel(quality);
    for (int i = 0; i < 500; ++i)
    {
      const Vector<N> u = RandomVector<N>(random) * std::pow(10.0, i % 7 - 3);
      const AxialMetric<N> metric = MetricFromVector<N>(parameters, u);
      const Matrix<N> G = metric.ToMatrix();
      const double difference = (G - SupplementaryMetric<N>(u, quality)).cwiseAbs().maxCoeff();
      largest = std::max(largest, difference);
      ASSERT_LE(difference, 1e-12) << "Quality " << quality << ", u " << u.transpose();
      ASSERT_LT(G.trace(), 4.0);
      ASSERT_NEAR(G.trace(), 4.0 - (N - 1) * 1e-4, 1e-12);
      ASSERT_FALSE(metric.Degenerate);
      // The same for -u: a metric knows a line, not its sense.
      ASSERT_LE((MetricFromVector<N>(parameters, -u).ToMatrix() - G).norm(), 1e-14);
    }
  }
  std::printf("closed form against the eigen route in %dD: %.1e\n", N, largest);
}

/// Axes of unit length and at right angles, eigenvalues positive: what the kernel builds upon.
template <int N>
void ExpectSound(const AxialMetric<N>& metric)
{
  EXPECT_NEAR(metric.Direction.norm(), 1.0, 1e-12);
  EXPECT_NEAR(metric.SecondAxis.norm(), 1.0, 1e-12);
  EXPECT_NEAR(metric.Direction.dot(metric.SecondAxis), 0.0, 1e-12);
  EXPECT_GT(metric.Along, 0.0);
  EXPECT_GT(metric.Across, 0.0);
  EXPECT_GT(metric.Second, 0.0);
  EXPECT_TRUE(metric.ToMatrix().allFinite());
}

template <int N>
void ExpectIsotropic(const AxialMetric<N>& metric, const std::string& what)
{
  SCOPED_TRACE(what);
  EXPECT_TRUE(metric.Degenerate);
  EXPECT_EQ(metric.ToMatrix(), Matrix<N>(Matrix<N>::Identity()));
  ExpectSound<N>(metric);
}

/**
 * Least sum over the corners of window x fade(q), over a grid of places and many directions: random
 * ones, or the axes and diagonals, which are the hardest since all corners are equally far.
 */
template <int N>
double LeastWeight(int quality, int directions, int samples, bool axes = false)
{
  const NoiseParameters parameters = PaperModel(quality);
  std::mt19937 random(11);
  double least = Infinity;
  const int side = 2 * quality + 2;
  const int corners = N == 2 ? side * side : side * side * side;
  const int places = N == 2 ? samples * samples : samples * samples * samples;
  for (int d = 0; d < directions; ++d)
  {
    Vector<N> u = RandomVector<N>(random);
    if (axes)
    {
      u = Vector<N>::UnitX() + (d & 1) * Vector<N>::UnitY() +
        ((d & 2) ? 1.0 : 0.0) * Vector<N>::Unit(N - 1);
    }
    const AxialMetric<N> metric = MetricFromVector<N>(parameters, u);
    for (int place = 0; place < places; ++place)
    {
      Vector<N> p; // an even number of steps meets the centre of the cell
      for (int axis = 0, rest = place; axis < N; ++axis, rest /= samples)
      {
        p[axis] = static_cast<double>(rest % samples) / (samples - 1);
      }
      double sum = 0.0;
      for (int corner = 0; corner < corners; ++corner)
      {
        double window = 1.0;
        Vector<N> v;
        for (int axis = 0, rest = corner; axis < N; ++axis, rest /= side)
        {
          v[axis] = rest % side - quality - p[axis];
          window *= FadeOf(Fade::Quintic, v[axis] / (quality + 1));
        }
        const double s = v.dot(metric.Direction);
        const double q = metric.Across * v.squaredNorm() + (metric.Along - metric.Across) * s * s;
        sum += window * FadeOf(Fade::Quintic, q);
      }
      least = std::min(least, sum);
    }
  }
  std::printf("least sum of weights in %dD at Quality %d, %s: %.2e\n", N, quality,
    axes ? "axes and diagonals" : "random directions", least);
  return least;
}
} // namespace

TEST(MetricTensor, KeepsAMetricOfTheUsersOwn)
{
  const NoiseParameters parameters;
  // Closed forms: what is within the bounds stays, on axes as they are.
  bool bounded = true;
  Matrix<2> plane;
  plane << 0.8, 0.0, 0.0, 2.0;
  AxialMetric<2> metric = MetricFromMetric<2>(parameters, plane, plane.norm(), &bounded);
  EXPECT_FALSE(bounded);
  EXPECT_FALSE(metric.Degenerate);
  EXPECT_TRUE(metric.ToMatrix().isApprox(plane, 1e-15)) << metric.ToMatrix();
  EXPECT_DOUBLE_EQ(metric.Along, 0.8);
  EXPECT_DOUBLE_EQ(metric.Across, 2.0);
  EXPECT_NEAR(std::abs(metric.Direction[0]), 1.0, 1e-15);
  EXPECT_EQ(metric.Clarity, 1.0);

  Matrix<3> space;
  space << 1.1, 0.3, -0.2, 0.3, 0.9, 0.4, -0.2, 0.4, 5.0;
  Matrix<3> lopsided = space; // the symmetric part counts
  lopsided(0, 1) += 0.5;
  lopsided(1, 0) -= 0.5;
  const AxialMetric<3> volume =
    MetricFromMetric<3>(parameters, lopsided, lopsided.norm(), &bounded);
  EXPECT_FALSE(bounded);
  EXPECT_TRUE(volume.ToMatrix().isApprox(space, 1e-13)) << volume.ToMatrix();
  EXPECT_LE(volume.Along, volume.Second);
  EXPECT_LE(volume.Second, volume.Across);

  // What is not is moved to the nearest bound, alone.
  plane << -1.0, 0.0, 0.0, 100.0;
  metric = MetricFromMetric<2>(parameters, plane, plane.norm(), &bounded);
  EXPECT_TRUE(bounded);
  EXPECT_NEAR(metric.Along, 1.0 / 400.0, 1e-15);
  EXPECT_DOUBLE_EQ(metric.Across, 16.0);
  NoiseParameters window = parameters;
  window.LatticeWindow = true;
  EXPECT_NEAR(MetricFromMetric<2>(window, plane, plane.norm()).Along, 1e-3, 1e-15);

  // Half the strength is half way to the identity, and a length that counts is that of the whole.
  NoiseParameters half = parameters;
  half.Strength = 0.5;
  plane << 0.8, 0.0, 0.0, 2.0;
  metric = MetricFromMetric<2>(half, plane, plane.norm());
  EXPECT_DOUBLE_EQ(metric.Along, 0.9);
  EXPECT_DOUBLE_EQ(metric.Across, 1.5);
  half.StrengthMode = StrengthMode::Magnitude;
  half.ReferenceMagnitude = 10.0;
  EXPECT_DOUBLE_EQ(MetricFromMetric<2>(half, plane, 5.0).Across, 1.25);

  // Alike in all directions: round, and its curvature means nothing. Zero and NaN are no metrics.
  const Matrix<2> ball = 3.0 * Matrix<2>::Identity();
  const AxialMetric<2> round = MetricFromMetric<2>(parameters, ball, 3.0);
  EXPECT_TRUE(round.ToMatrix().isApprox(ball, 1e-15));
  EXPECT_EQ(round.Clarity, 0.0);
  EXPECT_TRUE(MetricFromMetric<2>(parameters, Matrix<2>::Zero(), 0.0).Degenerate);
  plane(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(MetricFromMetric<2>(parameters, plane, 1.0).Degenerate);
}

TEST(MetricTensor, EqualsTheEigenRouteOfTheSupplementary)
{
  ExpectSupplementaryMetric<2>();
  ExpectSupplementaryMetric<3>();
}

TEST(MetricTensor, HasTheEigenvaluesAskedFor)
{
  std::mt19937 random(3);
  for (double sum : { 2.0, 4.0, 6.0, 8.0, 16.0 })
  {
    for (double minimum : { 0.05, 0.5, 1.0 })
    {
      for (int quality : { 0, 3, 8 })
      {
        NoiseParameters parameters = PaperModel(quality);
        parameters.EigenvalueSum = sum;
        parameters.MinimumEigenvalue = minimum;
        const Vector<3> u = RandomVector<3>(random).normalized();
        const AxialMetric<3> metric = MetricFromVector<3>(parameters, u);
        const double k = minimum / (quality + 1);
        const double b = std::max(k, (sum - k) / 2.0 - 1e-4);
        const Eigen::SelfAdjointEigenSolver<Matrix<3>> solver(metric.ToMatrix());
        EXPECT_NEAR(solver.eigenvalues()[0], k, 1e-12);
        EXPECT_NEAR(solver.eigenvalues()[1], b, 1e-12);
        EXPECT_NEAR(solver.eigenvalues()[2], b, 1e-12);
        if (b > k)
        {
          EXPECT_NEAR(std::abs(solver.eigenvectors().col(0).dot(u)), 1.0, 1e-9);
        }
      }
    }
  }
}

TEST(MetricTensor, HasTheLengthAskedForWithoutTheWindow)
{
  for (double length : { 1.0, 2.5, 6.0, 20.0 })
  {
    for (double sum : { 2.0, 3.2, 16.0 })
    {
      NoiseParameters parameters;
      parameters.StreakLength = length;
      parameters.EigenvalueSum = sum;
      parameters.Quality = 8; // of no account
      parameters.MinimumEigenvalue = 0.01;
      const double k = 1.0 / (length * length);
      EXPECT_DOUBLE_EQ(parameters.GetAlongEigenvalue(), k);
      const AxialMetric<2> inPlane = MetricFromVector<2>(parameters, Vector<2>::UnitY());
      EXPECT_NEAR(1.0 / std::sqrt(inPlane.Along), length, 1e-12);
      EXPECT_NEAR(inPlane.Across, std::max(k, sum - k - 1e-4), 1e-12);
      const AxialMetric<3> inSpace = MetricFromVector<3>(parameters, Vector<3>::UnitY());
      EXPECT_NEAR(inSpace.Along, k, 1e-12);
      EXPECT_NEAR(inSpace.Across, std::max(k, (sum - k) / 2.0 - 1e-4), 1e-12);
      const AxialMetric<3> surface =
        MetricFromSurfaceVector(parameters, Vector<3>::UnitY(), Vector<3>::UnitX());
      EXPECT_NEAR(surface.Along, k, 1e-12);
      EXPECT_NEAR(surface.Across, std::max(k, sum - k - 0.5 - 1e-4), 1e-12);
    }
  }
}

TEST(MetricTensor, CountsStreaksByTheirArea)
{
  NoiseParameters parameters;
  EXPECT_DOUBLE_EQ(parameters.GetStreakProbability(), 0.125) << "Density 0.25, StreakLength 6";
  parameters.StreakLength = 3.0;
  EXPECT_DOUBLE_EQ(parameters.GetStreakProbability(), 0.25);
  parameters.Density = 0.8;
  parameters.StreakLength = 1.0;
  EXPECT_EQ(parameters.GetStreakProbability(), 1.0) << "no more than every corner";
  EXPECT_EQ(PaperModel(8).GetStreakProbability(), 0.25) << "the paper's model: share of corners";
}

TEST(MetricTensor, BlendsEigenvaluesByStrength)
{
  const Vector<2> u(3.0, -4.0); // length 5
  NoiseParameters parameters;
  parameters.StreakLength = 2.0;
  const Matrix<2> full = MetricFromVector<2>(parameters, u).ToMatrix();
  for (double strength : { 0.0, 0.25, 0.7, 1.0 })
  {
    parameters.Strength = strength;
    const Matrix<2> blend = (1.0 - strength) * Matrix<2>::Identity() + strength * full;
    EXPECT_LE((MetricFromVector<2>(parameters, u).ToMatrix() - blend).norm(), 1e-14);
  }
  // By magnitude: Strength times |u| / ReferenceMagnitude, no more than Strength.
  parameters.Strength = 0.8;
  parameters.StrengthMode = StrengthMode::Magnitude;
  for (double reference : { 1e-3, 5.0, 20.0, 1e6 })
  {
    parameters.ReferenceMagnitude = reference;
    const double strength = 0.8 * std::min(1.0, 5.0 / reference);
    const Matrix<2> blend = (1.0 - strength) * Matrix<2>::Identity() + strength * full;
    EXPECT_LE((MetricFromVector<2>(parameters, u).ToMatrix() - blend).norm(), 1e-14);
    EXPECT_DOUBLE_EQ(StrengthOf(parameters, 5.0), strength);
  }
  // Surfaces and tensors blend alike; a tensor's magnitude is its Frobenius norm.
  parameters.ReferenceMagnitude = 50.0;
  const double shareOfTensor = 0.8 * 25.0 / 50.0;
  EXPECT_LE((MetricFromTensor<2>(parameters, u * u.transpose()).ToMatrix() -
              ((1.0 - shareOfTensor) * Matrix<2>::Identity() + shareOfTensor * full))
              .norm(),
    1e-12);
  NoiseParameters plain = parameters;
  plain.Strength = 1.0;
  plain.StrengthMode = StrengthMode::Constant;
  const Vector<3> inPlane(3.0, 4.0, 0.0);
  const Matrix<3> surface = MetricFromSurfaceVector(plain, inPlane, Vector<3>::UnitZ()).ToMatrix();
  const double share = 0.8 * 5.0 / 50.0;
  EXPECT_LE((MetricFromSurfaceVector(parameters, inPlane, Vector<3>::UnitZ()).ToMatrix() -
              ((1.0 - share) * Matrix<3>::Identity() + share * surface))
              .norm(),
    1e-14);
}

TEST(MetricTensor, KnowsSurfaces)
{
  std::mt19937 random(5);
  for (int quality : { 0, 1, 4, 8 })
  {
    const NoiseParameters parameters = PaperModel(quality);
    const double k = 0.5 / (quality + 1);
    for (int i = 0; i < 100; ++i)
    {
      const Vector<3> vector = RandomVector<3>(random);
      const Vector<3> normal = RandomVector<3>(random) * std::pow(10.0, i % 5 - 2);
      const AxialMetric<3> metric = MetricFromSurfaceVector(parameters, vector, normal);
      ASSERT_FALSE(metric.Degenerate);
      ExpectSound<3>(metric);
      const Vector<3> n = normal.normalized();
      const Vector<3> u = (vector - vector.dot(n) * n).normalized();
      const Vector<3> c = n.cross(u);
      const Matrix<3> G = k * u * u.transpose() + 0.5 * n * n.transpose() +
        (4.0 - k - 0.5 - 1e-4) * c * c.transpose();
      ASSERT_LE((metric.ToMatrix() - G).cwiseAbs().maxCoeff(), 1e-12);
      ASSERT_LT(metric.ToMatrix().trace(), 4.0);
      // Neither the sense of the normal nor its length matters.
      ASSERT_LE(
        (MetricFromSurfaceVector(parameters, vector, -normal).ToMatrix() - G).norm(), 1e-12);
    }
  }
  const NoiseParameters parameters;
  const Vector<3> n(0.0, 3.0, 4.0);
  ExpectIsotropic<3>(MetricFromSurfaceVector(parameters, n, n), "vector along the normal");
  ExpectIsotropic<3>(
    MetricFromSurfaceVector(parameters, Vector<3>::Zero(), n), "no vector on a surface");
  // No normal: not on a surface.
  const Vector<3> u(1.0, 2.0, 3.0);
  for (const Vector<3>& none :
    { Vector<3>(Vector<3>::Zero()), Vector<3>(0.0, NotANumber, 1.0) })
  {
    EXPECT_LE((MetricFromSurfaceVector(parameters, u, none).ToMatrix() -
                MetricFromVector<3>(parameters, u).ToMatrix())
                .norm(),
      1e-14);
  }
}

TEST(MetricTensor, GivesTensorsOfVectorsTheMetricOfTheVector)
{
  std::mt19937 random(9);
  for (int quality : { 0, 2, 8 })
  {
    const NoiseParameters parameters = PaperModel(quality);
    for (int i = 0; i < 300; ++i)
    {
      const Vector<2> u2 = RandomVector<2>(random) * std::pow(10.0, i % 9 - 4);
      ASSERT_LE((MetricFromTensor<2>(parameters, u2 * u2.transpose()).ToMatrix() -
                  MetricFromVector<2>(parameters, u2).ToMatrix())
                  .norm(),
        1e-11);
      // Two equal eigenvalues in 3D: the closed-form solver gives half the digits there.
      const Vector<3> u3 = RandomVector<3>(random) * std::pow(10.0, i % 9 - 4);
      ASSERT_LE((MetricFromTensor<3>(parameters, u3 * u3.transpose()).ToMatrix() -
                  MetricFromVector<3>(parameters, u3).ToMatrix())
                  .norm(),
        1e-6);
    }
  }
}

template <int N>
void ExpectTensorRemap()
{
  std::mt19937 random(13);
  const NoiseParameters parameters = PaperModel(2);
  const EigenvalueRange range = VectorEigenvalues(parameters, N);
  for (int i = 0; i < 300; ++i)
  {
    // Neither symmetric nor definite.
    const Matrix<N> tensor = RandomTensor<N>(random) * std::pow(10.0, i % 9 - 4);
    const Matrix<N> symmetric = 0.5 * (tensor + tensor.transpose());
    const Eigen::SelfAdjointEigenSolver<Matrix<N>> solver(symmetric);
    const Vector<N> lambda = solver.eigenvalues();
    Matrix<N> expected = Matrix<N>::Zero();
    for (int axis = 0; axis < N; ++axis)
    {
      const double share = (lambda[axis] - lambda[0]) / (lambda[N - 1] - lambda[0]);
      expected += (range.Across + (range.Along - range.Across) * share) *
        solver.eigenvectors().col(axis) * solver.eigenvectors().col(axis).transpose();
    }
    const AxialMetric<N> metric = MetricFromTensor<N>(parameters, tensor);
    ASSERT_LE((metric.ToMatrix() - expected).cwiseAbs().maxCoeff(), 1e-8);
    ASSERT_NEAR(std::abs(metric.Direction.dot(solver.eigenvectors().col(N - 1))), 1.0, 1e-10)
      << "streaks run along the major eigenvector";
    ASSERT_NEAR(metric.Along, range.Along, 1e-10);
    ExpectSound<N>(metric);
  }
}

TEST(MetricTensor, MapsEigenvaluesOfTensorsLinearly)
{
  ExpectTensorRemap<2>();
  ExpectTensorRemap<3>();
}

TEST(MetricTensor, TakesDegenerateInput)
{
  const NoiseParameters parameters;
  for (double bad : { NotANumber, Infinity, -Infinity })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      Vector<3> u(1.0, 2.0, 3.0);
      u[axis] = bad;
      ExpectIsotropic<3>(MetricFromVector<3>(parameters, u), "vector not finite");
      Matrix<3> tensor = Vector<3>(1.0, 2.0, 3.0).asDiagonal();
      tensor(axis, (axis + 1) % 3) = bad;
      ExpectIsotropic<3>(MetricFromTensor<3>(parameters, tensor), "tensor not finite");
    }
    ExpectIsotropic<2>(MetricFromVector<2>(parameters, Vector<2>(1.0, bad)), "vector not finite");
  }
  ExpectIsotropic<2>(MetricFromVector<2>(parameters, Vector<2>::Zero()), "zero vector");
  ExpectIsotropic<3>(MetricFromVector<3>(parameters, Vector<3>::Zero()), "zero vector");
  ExpectIsotropic<2>(MetricFromTensor<2>(parameters, Matrix<2>::Zero()), "zero tensor");
  ExpectIsotropic<3>(MetricFromTensor<3>(parameters, Matrix<3>::Zero()), "zero tensor");
  for (double pressure : { -7.0, 1e-200, 1e200 })
  {
    ExpectIsotropic<2>(
      MetricFromTensor<2>(parameters, pressure * Matrix<2>::Identity()), "isotropic tensor");
    ExpectIsotropic<3>(
      MetricFromTensor<3>(parameters, pressure * Matrix<3>::Identity()), "isotropic tensor");
  }
  Matrix<2> rotation; // its symmetric part is 0
  rotation << 0.0, 1.0, -1.0, 0.0;
  ExpectIsotropic<2>(MetricFromTensor<2>(parameters, rotation), "antisymmetric tensor");
}

TEST(MetricTensor, DoesNotMindTheScaleOfItsInput)
{
  const NoiseParameters parameters;
  std::mt19937 random(17);
  for (double scale : { 1e-300, 1e-160, 1e-30, 1e30, 1e160, 1e300 })
  {
    for (int i = 0; i < 20; ++i)
    {
      const Vector<3> u = RandomVector<3>(random);
      const Matrix<3> G = MetricFromVector<3>(parameters, u).ToMatrix();
      EXPECT_LE((MetricFromVector<3>(parameters, scale * u).ToMatrix() - G).norm(), 1e-13);
      const Vector<3> n = RandomVector<3>(random);
      EXPECT_LE((MetricFromSurfaceVector(parameters, scale * u, scale * n).ToMatrix() -
                  MetricFromSurfaceVector(parameters, u, n).ToMatrix())
                  .norm(),
        1e-12);
      const Matrix<3> tensor = RandomTensor<3>(random);
      EXPECT_LE((MetricFromTensor<3>(parameters, scale * tensor).ToMatrix() -
                  MetricFromTensor<3>(parameters, tensor).ToMatrix())
                  .norm(),
        1e-8);
    }
  }
  // Denormal numbers have a direction, too.
  const double least = std::numeric_limits<double>::denorm_min();
  const AxialMetric<2> metric = MetricFromVector<2>(parameters, Vector<2>(3 * least, 4 * least));
  EXPECT_FALSE(metric.Degenerate);
  EXPECT_LE((metric.Direction - Vector<2>(0.6, 0.8)).norm(), 1e-15);
}

TEST(MetricTensor, BendsUpToTheRadiusOfCurvature)
{
  const NoiseParameters parameters = PaperModel(8);
  const AxialMetric<3> straight = MetricFromVector<3>(parameters, Vector<3>::UnitX());
  for (double curvature : { 0.0, 0.05, 0.2, 0.5, 0.9, 1.0, 1.5, 100.0, 1e12 })
  {
    const double k = std::min(1.0, curvature);
    AxialMetric<3> metric = straight;
    // What lies along the flow is no turning.
    ApplyCurvature<3>(metric, Vector<3>(-0.3, 0.6 * curvature, 0.8 * curvature));
    EXPECT_LE((metric.Bend - k * Vector<3>(0.0, 0.6, 0.8)).norm(), 1e-12);
    EXPECT_NEAR(metric.Along, std::max(straight.Along, k * k), 1e-12);
    // Half-length 1/sqrt(k) within the radius of curvature 1/kappa.
    EXPECT_LE(k / std::sqrt(metric.Along), 1.0 + 1e-12);
    const double keeps = CurvatureKeeps(k * k);
    EXPECT_GE(keeps, 0.0);
    EXPECT_LE(keeps, 1.0);
    EXPECT_NEAR(metric.Across, 1.0 + keeps * (straight.Across - 1.0), 1e-12);
    EXPECT_NEAR(metric.Second, metric.Across, 1e-12);
    ExpectSound<3>(metric);
    if (curvature >= 1.0)
    {
      EXPECT_LE((metric.ToMatrix() - Matrix<3>::Identity()).norm(), 1e-12)
        << "isotropic where a streamline turns within a cell";
    }
  }
  EXPECT_EQ(CurvatureKeeps(0.0), 1.0);
  EXPECT_EQ(CurvatureKeeps(1.0), 0.0);
  for (double bad : { NotANumber, Infinity })
  {
    AxialMetric<3> metric = straight;
    ApplyCurvature<3>(metric, Vector<3>(0.0, bad, 0.0));
    EXPECT_EQ(metric.ToMatrix(), straight.ToMatrix());
    EXPECT_EQ(metric.Bend, Vector<3>(Vector<3>::Zero()));
  }
  AxialMetric<2> none = MetricFromVector<2>(parameters, Vector<2>::Zero());
  ApplyCurvature<2>(none, Vector<2>(0.0, 0.7));
  EXPECT_EQ(none.Bend, Vector<2>(Vector<2>::Zero())) << "no direction, nothing to bend";
  ExpectIsotropic<2>(none, "curvature without a direction");
}

TEST(MetricTensor, KeepsWeightsPositive)
{
  // Rice, supplementary, section 1.2. The least sum is that of an axis-aligned metric at the centre
  // of the cell, where every corner has q = trace / 4.
  const auto record = [](const char* name, double least)
  {
    std::ostringstream text;
    text << least;
    RecordProperty(name, text.str());
    EXPECT_GT(least, 0.0) << name;
  };
  record("LeastWeight2D", LeastWeight<2>(0, 1000, 33));
  record("LeastWeight3D", LeastWeight<3>(0, 1000, 13));
  record("LeastWeight2DAxes", LeastWeight<2>(0, 4, 65, true));
  record("LeastWeight3DAxes", LeastWeight<3>(0, 4, 33, true));
  for (int quality : { 1, 2, 4 })
  {
    EXPECT_GT(LeastWeight<2>(quality, 50, 17), 0.0) << quality;
  }
  EXPECT_GT(LeastWeight<2>(8, 20, 17), 0.0);
  for (int quality : { 1, 2 })
  {
    EXPECT_GT(LeastWeight<3>(quality, 20, 7), 0.0) << quality;
  }
}
