// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "SteerableNoiseReference.h"

#include <Eigen/LU>

#include <cmath>

namespace steerable
{
namespace
{
/// Sums over the surflets of one octave: the noise, the weights and the variance.
struct SurfletSums
{
  double Noise = 0.0;
  double Weight = 0.0;
  double Variance = 0.0;
};

template <int N>
struct Octave
{
  const NoiseParameters& Parameters;
  const AxialMetric<N>& Metric;
  std::int64_t PeriodFactor;
  std::uint32_t Seed;

  /// Π_axes fade(v_axis / (Quality + 1)), or the same of the distance.
  double Window(const Vector<N>& v) const
  {
    const Fade fade = this->Parameters.Fade;
    const double reach = this->Parameters.Quality + 1;
    if (!this->Parameters.LatticeWindow)
    {
      return 1.0;
    }
    if (this->Parameters.Falloff == Falloff::Radial)
    {
      return FadeOf(fade, v.norm() / reach);
    }
    double product = 1.0;
    for (int axis = 0; axis < N; ++axis)
    {
      product *= FadeOf(fade, v[axis] / reach);
    }
    return product;
  }

  /// Half the side of the box of corners that can matter.
  double Reach() const
  {
    const double support = FadeSupport(this->Parameters.Fade);
    if (this->Parameters.LatticeWindow)
    {
      return support * (this->Parameters.Quality + 1);
    }
    const double travel = this->Parameters.Motion ? 0.5 * std::abs(this->Parameters.Speed) : 0.0;
    const double along = (std::sqrt(support) + travel) / std::sqrt(this->Metric.Along);
    const double smallest =
      std::min(this->Metric.Across, std::min(this->Metric.Second, this->Metric.Along));
    return along + std::sqrt(support / smallest) + 0.5 * along * along * this->Metric.Bend.norm();
  }

  /// Adds the surflet of the corner with this hash, v = corner - point.
  void AddSurflet(SurfletSums& sums, std::uint32_t hash, Vector<N> v) const
  {
    const NoiseParameters& p = this->Parameters;
    const Vector<N>& u = this->Metric.Direction;
    const Matrix<N> G = this->Metric.ToMatrix();
    if (p.Lattice == Lattice::Jittered || p.Basis == Basis::Streaks)
    {
      // Kensler jitters within the cell, [0, 1); streaks about their corner, [-1/2, 1/2).
      const double shift = p.Lattice == Lattice::Jittered ? 0.0 : -0.5;
      for (int axis = 0; axis < N; ++axis)
      {
        v[axis] += HashToUnit(HashStream(hash, 3 + axis)) + shift;
      }
    }

    // Documentation/noise-model.md, Curvature: the bent offset. Motion: the surflet travels on its own clock.
    const double along = v.dot(u);
    Vector<N> bent = v - 0.5 * along * along * this->Metric.Bend;
    double amplitude = 1.0;
    if (p.Motion)
    {
      const double clock = p.Phase + HashToUnit(HashStream(hash, 1));
      const double tau = clock - std::floor(clock);
      const double speed = this->Metric.Degenerate ? 0.0 : p.Speed;
      bent += (tau - 0.5) * speed / std::sqrt(this->Metric.Along) * u;
      amplitude = std::pow(std::sin(Pi * tau), 2) * MotionAmplitude;
    }

    const double window = this->Window(v);
    const Vector<N> Gv = G * bent;
    const double q = bent.dot(Gv);
    const double weight = window * (p.AnisotropicWeight ? FadeOf(p.Fade, q) : 1.0);
    switch (p.Basis)
    {
      case Basis::Gradient:
      {
        const Vector<N> projected = p.MetricInProjection ? Gv : bent;
        sums.Noise += amplitude * weight * GradientOf<N>(p.GradientSet, hash).dot(projected);
        sums.Variance +=
          weight * weight * projected.squaredNorm() * GradientVariance(p.GradientSet, N);
        sums.Weight += weight;
        break;
      }
      case Basis::Value:
        sums.Noise += amplitude * weight * ValueOf(hash);
        sums.Variance += weight * weight / 3.0;
        sums.Weight += weight;
        break;
      case Basis::Streaks:
      {
        // Other bases. Where the flow has no direction there is no streak.
        const double scaled = bent.dot(u) * std::sqrt(this->Metric.Along);
        const double across = std::sqrt(std::max(0.0, q - scaled * scaled));
        const double profile = this->Metric.Degenerate
          ? 0.0
          : window * StreakProfile(-scaled) * FadeOf(p.Fade, across);
        const double probability = p.GetStreakProbability();
        const bool on = HashToUnit(HashStream(hash, 2)) < probability;
        sums.Noise += on ? amplitude * profile : 0.0;
        sums.Variance += probability * profile * profile;
        sums.Weight += profile;
        break;
      }
    }
  }

  double Evaluate(const Vector<N>& point) const
  {
    const NoiseParameters& p = this->Parameters;
    const Matrix<N> steps = LatticeSteps<N>(p.Lattice);
    const Matrix<N> toIndex = steps.inverse();
    const Vector<N> inLattice = toIndex * point;
    // Jitter moves a corner by up to 1 cell; oblique steps need more of them to fill the box.
    const double boxInSteps = toIndex.cwiseAbs().rowwise().sum().maxCoeff() * (this->Reach() + 1.0);
    const auto range = static_cast<std::int64_t>(std::ceil(boxInSteps));

    SurfletSums sums;
    Eigen::Matrix<std::int64_t, N, 1> offset = Eigen::Matrix<std::int64_t, N, 1>::Constant(-range);
    for (bool more = true; more;)
    {
      Vector<N> v;
      std::array<std::uint32_t, 3> index = { 0, 0, 0 };
      for (int axis = 0; axis < N; ++axis)
      {
        const double cell = std::floor(inLattice[axis]);
        v[axis] = offset[axis] - (inLattice[axis] - cell);
        index[axis] = WrapToPeriod(
          static_cast<std::int64_t>(cell) + offset[axis], p.Period[axis] * this->PeriodFactor);
      }
      this->AddSurflet(sums, HashCorner(index[0], index[1], index[2], this->Seed), steps * v);
      more = false;
      for (int axis = 0; axis < N && !more; ++axis)
      {
        more = ++offset[axis] <= range;
        offset[axis] = more ? offset[axis] : -range;
      }
    }

    // Normalisation.
    switch (p.Normalization)
    {
      case Normalization::WeightSum:
        return sums.Weight > 0.0 ? sums.Noise / sums.Weight : 0.0;
      case Normalization::UnitVariance:
        return sums.Noise / std::sqrt(sums.Variance + VarianceFloor);
      case Normalization::None:
      default:
        return sums.Noise;
    }
  }
};
} // namespace

template <int N>
double SteerableNoiseReference(const NoiseParameters& parameters, const Vector<N>& position,
  const AxialMetric<N>& metric, const Vector<N>& curvature)
{
  parameters.Validate();
  double sum = 0.0;
  double power = 0.0;
  double amplitude = 1.0;
  double featureSize = parameters.FeatureSize;
  double periodFactor = 1.0;
  for (int i = 0; i < parameters.Octaves; ++i)
  {
    AxialMetric<N> bent = metric;
    ApplyCurvature<N>(bent, curvature * featureSize);
    const Octave<N> octave{ parameters, bent, std::llround(periodFactor), parameters.Seed + i };
    const double noise = octave.Evaluate(position / featureSize);
    sum += amplitude * (parameters.Turbulence ? std::abs(noise) : noise);
    power += amplitude * amplitude;
    amplitude *= parameters.Gain;
    featureSize /= parameters.Lacunarity;
    periodFactor *= parameters.Lacunarity;
  }
  return sum / std::sqrt(power);
}

template double SteerableNoiseReference<2>(
  const NoiseParameters&, const Vector<2>&, const AxialMetric<2>&, const Vector<2>&);
template double SteerableNoiseReference<3>(
  const NoiseParameters&, const Vector<3>&, const AxialMetric<3>&, const Vector<3>&);
} // namespace steerable
