// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Subband/SubbandAnisotropy.h"

#include <algorithm>
#include <cmath>

namespace steerable
{
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr int Steps = 48; // of the table
constexpr int FieldDirections = 8;
constexpr int Wavelengths = 4;

/// Scales enough for the most steered feature, with its wavelength between any two of them.
SubbandWeightParameters ParametersOf(int orientations, WeightMethod method)
{
  SubbandWeightParameters parameters;
  parameters.Pyramid.Orientations = orientations;
  parameters.Pyramid.Scales = 6;
  parameters.Pyramid.TileSize = 512;
  parameters.Method = method;
  return parameters;
}

double AnisotropyOfStep(int step)
{
  return std::pow(SubbandAnisotropy::MostSteering, static_cast<double>(step) / Steps);
}
} // namespace

SubbandAnisotropy::SubbandAnisotropy(int orientations, WeightMethod method)
  : Method(method)
  , Weights(ParametersOf(orientations, method))
{
  constexpr int directions = 128; // exact for these trigonometric polynomials
  const int scales = this->Weights.GetParameters().Pyramid.Scales;
  for (Eigen::MatrixXd& angular : this->Angular)
  {
    angular.setZero(orientations, orientations);
  }
  for (int n = 0; n < directions; ++n)
  {
    const double theta = Pi * n / directions;
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    const double squares[3] = { c * c, s * s, c * s };
    for (int i = 0; i < orientations; ++i)
    {
      for (int k = 0; k < orientations; ++k)
      {
        const double product =
          AngularFilter(i, orientations, theta) * AngularFilter(k, orientations, theta);
        for (int axis = 0; axis < 3; ++axis)
        {
          this->Angular[axis](i, k) += squares[axis] * product;
        }
      }
    }
  }
  this->Radial = RadialSlopeGram(scales);
  for (int step = 0; step <= Steps; ++step)
  {
    const double measured = step == 0 ? 1.0 : this->Measure(AnisotropyOfStep(step));
    this->Measured.push_back(step == 0 ? measured : std::max(measured, this->Measured.back()));
  }
}

double SubbandAnisotropy::Measure(double anisotropy) const
{
  const SubbandParameters& pyramid = this->Weights.GetParameters().Pyramid;
  const int orientations = pyramid.Orientations;
  const double middle = 0.5 * (pyramid.Scales - 1);
  double sum = 0.0;
  std::vector<double> weights(static_cast<std::size_t>(pyramid.Components()));
  for (int direction = 0; direction < FieldDirections; ++direction)
  {
    // Other directions are these, turned by whole bands.
    const double angle = Pi / orientations * direction / FieldDirections;
    const Eigen::Vector2d t(std::cos(angle), std::sin(angle));
    const Eigen::Matrix2d along = t * t.transpose();
    for (int n = 0; n < Wavelengths; ++n)
    {
      const double octave = middle - 0.5 + (n + 0.5) / Wavelengths;
      const double wavelength = std::exp2(octave) / pyramid.CenterFrequency();
      const Eigen::Matrix2d metric = wavelength * wavelength *
        (anisotropy * along + (Eigen::Matrix2d::Identity() - along) / anisotropy);
      this->Weights.Compute(metric, weights.data());
      const Eigen::Map<const Eigen::MatrixXd> gamma(weights.data(), orientations, pyramid.Scales);
      double tensor[3];
      for (int axis = 0; axis < 3; ++axis)
      {
        tensor[axis] = (gamma.transpose() * this->Angular[axis] * gamma).cwiseProduct(this->Radial).sum();
      }
      const double mean = 0.5 * (tensor[0] + tensor[1]);
      const double radius = std::hypot(0.5 * (tensor[0] - tensor[1]), tensor[2]);
      sum += 0.5 * std::log((mean + radius) / (mean - radius));
    }
  }
  return std::exp(sum / (FieldDirections * Wavelengths));
}

double SubbandAnisotropy::GetSteering(double wanted) const
{
  if (this->Method == WeightMethod::None || !(wanted > 1.0))
  {
    return std::max(1.0, wanted);
  }
  const auto above = std::lower_bound(this->Measured.begin(), this->Measured.end(), wanted);
  if (above == this->Measured.end())
  {
    return MostSteering;
  }
  const auto step = static_cast<int>(above - this->Measured.begin());
  const double high = *above;
  const double low = this->Measured[static_cast<std::size_t>(step) - 1];
  const double share = high > low ? (wanted - low) / (high - low) : 0.0;
  return AnisotropyOfStep(step - 1) +
    share * (AnisotropyOfStep(step) - AnisotropyOfStep(step - 1));
}
} // namespace steerable
