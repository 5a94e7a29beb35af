// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a sum of subbands looks like on a surface, by quadrature of its spectrum: no tile, no random
 * number. Shared by the tests of tiles and weights.
 */
#ifndef SubbandSpectrum_h
#define SubbandSpectrum_h

#include "Subband/SubbandFilters.h"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <vector>

namespace steerable
{
constexpr double Pi = 3.14159265358979323846;

inline Eigen::Matrix2d Rotation(double angle)
{
  Eigen::Matrix2d r;
  r << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return r;
}

/// Moments of the noise's power spectrum over frequencies f = T^T k, in cycles per object unit.
struct SpectralMoments
{
  double Variance = 0.0;
  double Frequency = 0.0; ///< Mean |f|.
  Eigen::Matrix2d StructureTensor = Eigen::Matrix2d::Zero();

  /// Ratio of the structure tensor's eigenvalues, 1 for isotropic noise.
  double Anisotropy() const
  {
    const Eigen::Vector2d values = this->Eigen().eigenvalues();
    return values[1] / values[0];
  }
  double Coherence() const
  {
    const Eigen::Vector2d values = this->Eigen().eigenvalues();
    return (values[1] - values[0]) / (values[1] + values[0]);
  }
  /// The direction in which the noise varies least.
  Eigen::Vector2d LongAxis() const { return this->Eigen().eigenvectors().col(0); }

private:
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> Eigen() const
  {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(this->StructureTensor);
  }
};

/// Moments of the noise with these K*J weights, orientation fastest.
inline SpectralMoments MeasureSpectrum(
  const SubbandParameters& pyramid, const double* weights, const Eigen::Matrix2d& mapping)
{
  constexpr int perOctave = 64, directions = 64;
  const int K = pyramid.Orientations, J = pyramid.Scales;
  SpectralMoments moments;
  std::vector<double> angular(J);
  for (int n = 0; n < directions; ++n)
  {
    const double theta = Pi * n / directions;
    const Eigen::Vector2d direction =
      mapping.transpose() * Eigen::Vector2d(std::cos(theta), std::sin(theta));
    for (int j = 0; j < J; ++j)
    {
      angular[j] = 0.0;
      for (int i = 0; i < K; ++i)
      {
        angular[j] += weights[j * K + i] * AngularFilter(i, K, theta);
      }
    }
    for (int step = 0; step < (J + 1) * perOctave; ++step)
    {
      const double y = 1.0 - static_cast<double>(step) / perOctave;
      double amplitude = 0.0;
      for (int j = 0; j < J; ++j)
      {
        amplitude += angular[j] * RadialFilter(y + j);
      }
      // Area element of the plane over the whole circle, in cycles per texel.
      const double power = amplitude * amplitude * std::pow(pyramid.BandCenter, 2) * std::log(2.0) *
        std::exp2(2.0 * y) / perOctave * 2.0 * Pi / directions;
      const Eigen::Vector2d f = direction * pyramid.CenterFrequency() * std::exp2(y);
      moments.Variance += power;
      moments.Frequency += power * f.norm();
      moments.StructureTensor += power * f * f.transpose();
    }
  }
  moments.Frequency /= moments.Variance;
  return moments;
}
} // namespace steerable

#endif
