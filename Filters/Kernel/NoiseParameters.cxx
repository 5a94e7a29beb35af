// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "NoiseParameters.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace steerable
{
namespace
{
/// NaN fails every comparison, so it is refused as well.
void Require(bool inRange, const char* name, double value, const char* range)
{
  if (!inRange)
  {
    std::ostringstream message;
    message << name << " is " << value << "; it must be " << range << ".";
    throw std::invalid_argument(message.str());
  }
}
} // namespace

void NoiseParameters::Validate() const
{
  Require(this->FeatureSize > 0.0 && std::isfinite(this->FeatureSize), "FeatureSize",
    this->FeatureSize, "positive and finite");
  Require(this->StreakLength >= 1.0 && this->StreakLength <= 20.0, "StreakLength",
    this->StreakLength, "from 1 to 20");
  Require(this->Quality >= 0 && this->Quality <= 8, "Quality", this->Quality, "from 0 to 8");
  Require(this->MinimumEigenvalue >= 0.01 && this->MinimumEigenvalue <= 1.0, "MinimumEigenvalue",
    this->MinimumEigenvalue, "from 0.01 to 1");
  Require(this->EigenvalueSum >= 2.0 && this->EigenvalueSum <= 16.0, "EigenvalueSum",
    this->EigenvalueSum, "from 2 to 16");
  Require(this->Normalization != Normalization::WeightSum || this->EigenvalueSum <= 4.0,
    "EigenvalueSum", this->EigenvalueSum, "4 or less with Normalization WeightSum");
  Require(
    this->Strength >= 0.0 && this->Strength <= 1.0, "Strength", this->Strength, "from 0 to 1");
  Require(this->StrengthMode == StrengthMode::Constant || this->ReferenceMagnitude > 0.0,
    "ReferenceMagnitude", this->ReferenceMagnitude, "positive with StrengthMode Magnitude");
  Require(this->MaskThreshold >= 0.0, "MaskThreshold", this->MaskThreshold, "0 or more");
  Require(
    this->Density > 0.0 && this->Density <= 1.0, "Density", this->Density, "above 0, up to 1");
  Require(std::isfinite(this->Phase), "Phase", this->Phase, "finite");
  Require(std::abs(this->Speed) <= 4.0, "Speed", this->Speed, "from -4 to 4");
  Require(this->Octaves >= 1 && this->Octaves <= 16, "Octaves", this->Octaves, "from 1 to 16");
  Require(this->Lacunarity >= 1.0 && this->Lacunarity <= 8.0, "Lacunarity", this->Lacunarity,
    "from 1 to 8");
  Require(this->Gain >= 0.0 && this->Gain <= 1.0, "Gain", this->Gain, "from 0 to 1");
  Require(this->LatticeWindow || this->AnisotropicWeight, "LatticeWindow", 0,
    "on without AnisotropicWeight: one of them must bound a surflet");
  for (int cells : this->Period)
  {
    Require(cells * std::pow(this->Lacunarity, this->Octaves - 1) < 1073741824.0, "Period", cells,
      "less than 2^30 cells in the last octave");
    Require(cells >= 0, "Period", cells, "0 or more");
    Require(cells == 0 || this->Lattice != Lattice::Simplicial, "Period", cells,
      "0 on the Simplicial lattice, whose axes are oblique");
    Require(cells == 0 || this->Octaves == 1 || this->Lacunarity == std::floor(this->Lacunarity),
      "Lacunarity", this->Lacunarity, "a whole number with Period and more than one octave");
  }
}
} // namespace steerable
