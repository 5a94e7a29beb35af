// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandWeights.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace steerable
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Ln2 = 0.693147180559945309417;

// Entries of the tables per doubling of q. Weights are right to 3e-6 of the largest, antialiasing
// to 1e-4.
constexpr int TargetBits = 8;
constexpr int FilterBits = 5;

// This many octaves below the pyramid a footprint leaves all of every band, above it nothing.
constexpr int FilterMarginBelow = 9;
constexpr int FilterMarginAbove = 4;

struct Eigenvalues
{
  double Smaller, Larger;
};

Eigenvalues EigenvaluesOf(const Eigen::Matrix2d& m)
{
  const double mean = 0.5 * (m(0, 0) + m(1, 1));
  const double radius = std::hypot(0.5 * (m(0, 0) - m(1, 1)), m(0, 1));
  return { mean - radius, mean + radius };
}

bool IsFinite(const Eigen::Matrix2d& m)
{
  return std::isfinite(m(0, 0)) && std::isfinite(m(0, 1)) && std::isfinite(m(1, 1));
}

// Nothing passes a filter of this size; squares of larger ones overflow.
Eigen::Matrix2d Bounded(const Eigen::Matrix2d& footprint)
{
  constexpr double most = 1e100;
  const double found = footprint.cwiseAbs().maxCoeff();
  return found > most ? Eigen::Matrix2d(footprint * (most / found)) : footprint;
}

/**
 * The least squares fit of a Gaussian by radial profiles. Both residuals take part, as they do in
 * images, so that a filter that changes nothing gets the factors one; noise has no residuals, so their
 * factors are dropped.
 */
class GaussianFit
{
public:
  explicit GaussianFit(int scales)
    : Scales(scales)
  {
    // From an octave above the finest centre, where bands end, to where no area is left.
    const int nodes = (scales + 6) * NodesPerOctave;
    Eigen::MatrixXd profiles(scales + 2, nodes);
    Eigen::VectorXd area(nodes);
    this->SquaredRadius.resize(nodes);
    for (int n = 0; n < nodes; ++n)
    {
      const double y = 1.0 - (n + 0.5) / NodesPerOctave;
      profiles(0, n) = HighResidual(y);
      for (int j = 0; j < scales; ++j)
      {
        profiles(1 + j, n) = RadialFilter(y + j);
      }
      profiles(scales + 1, n) = LowResidual(y, scales);
      this->SquaredRadius(n) = std::exp2(2.0 * y);
      area(n) = this->SquaredRadius(n) * Ln2 / NodesPerOctave;
    }
    const Eigen::MatrixXd weighted = profiles * area.asDiagonal();
    this->Dual = (weighted * profiles.transpose()).inverse() * weighted;
  }

  // The factors of the J scales for exp(-q r^2 / 2), r in units of r0.
  Eigen::VectorXd operator()(double q) const { return this->Fit(q).segment(1, this->Scales); }

  // That of the high residual.
  Eigen::VectorXd FitHigh(double q) const { return this->Fit(q).head(1); }

private:
  static constexpr int NodesPerOctave = 48;

  Eigen::VectorXd Fit(double q) const
  {
    const Eigen::VectorXd target = (-0.5 * q * this->SquaredRadius.array()).exp();
    return this->Dual * target;
  }

  int Scales;
  Eigen::MatrixXd Dual;
  Eigen::VectorXd SquaredRadius;
};

// Where the heuristic probes a band, in octaves from its centre, and how much each probe counts.
struct RadialProbe
{
  double Octaves, Weight;
};
using RadialProbes = std::vector<RadialProbe>;

RadialProbes ProbesOf(const SubbandWeightParameters& parameters)
{
  return parameters.RadialTriple ? RadialProbes{ { -0.5, 0.25 }, { 0.0, 0.5 }, { 0.5, 0.25 } }
                                 : RadialProbes{ { 0.0, 1.0 } };
}

// The wanted ring, probed in the bands of each scale.
Eigen::VectorXd ProbeRing(const RadialProbes& probes, double c, int scales)
{
  Eigen::VectorXd values = Eigen::VectorXd::Zero(scales);
  for (int j = 0; j < scales; ++j)
  {
    for (const RadialProbe& probe : probes)
    {
      values(j) += probe.Weight * RadialFilter(c - j + probe.Octaves);
    }
  }
  return values;
}

// The filter exp(-4^c r^2 / 2), r in units of r0. The area of the plane that a probe stands for
// grows with the square of the radius, and so does its weight.
Eigen::VectorXd ProbeGaussian(const RadialProbes& probes, double c, int scales)
{
  Eigen::VectorXd values = Eigen::VectorXd::Zero(scales);
  for (int j = 0; j < scales; ++j)
  {
    double total = 0.0;
    for (const RadialProbe& probe : probes)
    {
      const double weight = probe.Weight * std::exp2(2.0 * probe.Octaves);
      values(j) += weight * std::exp(-0.5 * std::exp2(2.0 * (c + probe.Octaves - j)));
      total += weight;
    }
    values(j) /= total;
  }
  return values;
}

// The projections of the wanted ring on the rings of each scale.
Eigen::VectorXd ProjectRing(double c, int scales)
{
  Eigen::VectorXd overlaps(scales);
  for (int j = 0; j < scales; ++j)
  {
    overlaps(j) = Ln2 * std::pow(4.0, -j) * RadialOverlap(c - j);
  }
  return overlaps;
}

// The wanted amplitude within each scale.
Eigen::VectorXd MatchPower(double c, int scales)
{
  Eigen::VectorXd amplitudes(scales);
  for (int j = 0; j < scales; ++j)
  {
    amplitudes(j) = std::sqrt(PowerOverlap(c - j));
  }
  return amplitudes;
}
} // namespace

void SubbandWeightParameters::Validate() const
{
  this->Pyramid.Validate();
  if (!(this->FixedScale >= 0.0 && this->FixedScale <= this->Pyramid.Scales - 1))
  {
    throw std::invalid_argument("Subband noise: FixedScale must be 0 to Scales - 1.");
  }
}

SubbandWeights::SubbandWeights(const SubbandWeightParameters& parameters)
  : Parameters(parameters)
{
  parameters.Validate();
  const int orientations = parameters.Pyramid.Orientations;
  const int scales = parameters.Pyramid.Scales;
  this->SmallestMetric = std::pow(parameters.Pyramid.CenterFrequency(), -2.0);
  this->LargestMetric = std::ldexp(this->SmallestMetric, 2 * (scales - 1));
  const Eigen::MatrixXd angular = AngularGram(orientations);
  const Eigen::MatrixXd radial = RadialGram(scales);
  this->Power.Prepare(angular, radial);
  this->Fits = parameters.Method == WeightMethod::LeastSquares ||
    parameters.Method == WeightMethod::PowerMatched;
  for (int i = 0; i < orientations; ++i)
  {
    const double theta = Pi * i / orientations;
    const double c = std::cos(theta), s = std::sin(theta);
    this->Squares.push_back({ c * c, 2.0 * c * s, s * s });
  }

  const int last = scales - 1;
  const int filterFirst = -FilterMarginBelow, filterLast = scales + FilterMarginAbove;
  if (this->Fits)
  {
    const Eigen::VectorXd dual = angular.inverse().col(0);
    this->Fit.Prepare(orientations,
      [&](double theta)
      {
        double sum = 0.0;
        for (int i = 0; i < orientations; ++i)
        {
          sum += dual(i) * AngularFilter(i, orientations, theta);
        }
        return sum;
      });
    const GaussianFit fit(scales);
    this->Filter.Fill(
      filterFirst, filterLast, FilterBits, [&](double c) { return fit(std::exp2(2.0 * c)); });
    this->HighFilter.Fill(filterFirst, filterLast, FilterBits,
      [&](double c) { return fit.FitHigh(std::exp2(2.0 * c)); });
  }
  else
  {
    const RadialProbes probes = ProbesOf(parameters);
    this->Target.Fill(0, last, TargetBits, [&](double c) { return ProbeRing(probes, c, scales); });
    this->Filter.Fill(filterFirst, filterLast, FilterBits,
      [&](double c) { return ProbeGaussian(probes, c, scales); });
    // It counts as scale -1.
    this->HighFilter.Fill(filterFirst, filterLast, FilterBits,
      [&](double c) { return ProbeGaussian(probes, c + 1.0, 1); });
  }
  if (parameters.Method == WeightMethod::LeastSquares)
  {
    const Eigen::MatrixXd radialDual = radial.inverse();
    const Eigen::MatrixXd slopes = RadialSlopeGram(scales);
    this->Target.Fill(0, last, TargetBits,
      [&](double c)
      {
        const Eigen::VectorXd fit = radialDual * ProjectRing(c, scales);
        // On the surface, where frequencies of this direction are 2^c times as high.
        const double squaredGradient = std::exp2(4.0 * c) * fit.dot(slopes * fit);
        return Eigen::VectorXd(std::sqrt(slopes(0, 0) / squaredGradient) * fit);
      });
  }
  else if (parameters.Method == WeightMethod::PowerMatched)
  {
    this->Target.Fill(0, last, TargetBits, [&](double c) { return MatchPower(c, scales); });
  }
}

bool SubbandWeights::Compute(const Eigen::Matrix2d& metric, double* gamma) const
{
  if (!IsFinite(metric))
  {
    std::fill_n(gamma, this->Parameters.Pyramid.Components(), 0.0);
    return false;
  }
  const double k0 = this->Parameters.Pyramid.CenterFrequency();
  Eigen::Matrix2d scaled;
  if (this->Parameters.Method == WeightMethod::None)
  {
    scaled = std::exp2(2.0 * this->Parameters.FixedScale) * Eigen::Matrix2d::Identity();
  }
  else
  {
    scaled = metric;
    this->ClampMetric(scaled);
    scaled *= k0 * k0;
  }
  this->WeighBands(this->Target, scaled, gamma);
  const double scale = 1.0 / std::sqrt(this->GetVariance(gamma));
  std::for_each(
    gamma, gamma + this->Parameters.Pyramid.Components(), [=](double& weight) { weight *= scale; });
  return true;
}

bool SubbandWeights::Antialias(const Eigen::Matrix2d& footprint, double* beta) const
{
  if (!IsFinite(footprint))
  {
    std::fill_n(beta, this->Parameters.Pyramid.Components(), 0.0);
    return false;
  }
  const double omega0 = 2.0 * Pi * this->Parameters.Pyramid.CenterFrequency();
  this->WeighBands(this->Filter, Bounded(footprint) * (omega0 * omega0), beta);
  return true;
}

bool SubbandWeights::AntialiasHigh(const Eigen::Matrix2d& footprint, double* beta) const
{
  if (!IsFinite(footprint))
  {
    std::fill_n(beta, this->Parameters.Pyramid.Orientations, 0.0);
    return false;
  }
  const double omega0 = 2.0 * Pi * this->Parameters.Pyramid.CenterFrequency();
  this->WeighBands(this->HighFilter, Bounded(footprint) * (omega0 * omega0), beta);
  return true;
}

bool SubbandWeights::ClampMetric(Eigen::Matrix2d& metric) const
{
  const double smallest = this->SmallestMetric;
  const double largest = this->LargestMetric;
  // A metric built to lie on the limit may miss it by rounding, which is no change worth reporting.
  constexpr double tolerance = 1e-12;
  // Most lie inside, far from overflow: a plain root is enough to tell.
  const double mean = 0.5 * (metric(0, 0) + metric(1, 1));
  const double half = 0.5 * (metric(0, 0) - metric(1, 1));
  const double radius = std::sqrt(half * half + metric(0, 1) * metric(0, 1));
  if (mean - radius >= smallest * (1.0 - tolerance) && mean + radius <= largest * (1.0 + tolerance))
  {
    return false;
  }
  const Eigenvalues found = EigenvaluesOf(metric);
  const double a = std::clamp(found.Smaller, smallest, largest);
  const double b = std::clamp(found.Larger, smallest, largest);
  // Keep the eigenvectors: shrink the deviator in proportion to the difference of eigenvalues.
  const double difference = found.Larger - found.Smaller;
  const double shrink = difference > 0.0 ? (b - a) / difference : 0.0;
  const Eigen::Matrix2d deviator =
    metric - 0.5 * (found.Smaller + found.Larger) * Eigen::Matrix2d::Identity();
  metric = 0.5 * (a + b) * Eigen::Matrix2d::Identity() + shrink * deviator;
  return true;
}

void SubbandWeights::WeighBands(
  const RadialTable& table, const Eigen::Matrix2d& scaledMetric, double* weights) const
{
  const double entries[3] = { scaledMetric(0, 0), scaledMetric(0, 1), scaledMetric(1, 1) };
  if (this->Fits)
  {
    FitBands(this->Fit, table, entries, weights);
    return;
  }
  const int orientations = this->Parameters.Pyramid.Orientations;
  for (int i = 0; i < orientations; ++i)
  {
    const auto& square = this->Squares[i];
    const double q = square[0] * entries[0] + square[1] * entries[1] + square[2] * entries[2];
    double values[MaximumScales];
    table.Interpolate(q, values);
    for (int j = 0; j < table.Width; ++j)
    {
      weights[j * orientations + i] = values[j];
    }
  }
}

void SubbandWeights::LimitVariance(double most, double* weights) const
{
  const double variance = this->GetVariance(weights);
  if (variance > most)
  {
    const double scale = std::sqrt(most / variance);
    std::for_each(weights, weights + this->Parameters.Pyramid.Components(),
      [=](double& weight) { weight *= scale; });
  }
}

double SubbandWeights::GetVariance(const double* gamma) const
{
  const double center = this->Parameters.Pyramid.BandCenter;
  return center * center * PowerOf(this->Power, gamma);
}

double DistortionRatio(const Eigen::Matrix2d& metric)
{
  const Eigenvalues found = EigenvaluesOf(metric);
  return found.Smaller > 0.0 ? std::sqrt(found.Larger / found.Smaller)
                             : std::numeric_limits<double>::infinity();
}

int RequiredScales(const Eigen::Matrix2d& metric, double centerFrequency)
{
  const Eigenvalues found = EigenvaluesOf(metric * (centerFrequency * centerFrequency));
  return static_cast<int>(
           std::ceil(0.5 * std::log2(found.Larger)) - std::floor(0.5 * std::log2(found.Smaller))) +
    1;
}
} // namespace steerable
