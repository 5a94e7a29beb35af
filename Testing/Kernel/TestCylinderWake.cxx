// SPDX-FileCopyrightText: Copyright (c) The SteerableNoise authors
// SPDX-License-Identifier: BSD-3-Clause

// The program that makes the sample data simulates a cylinder wake as the literature knows it.

#include "LatticeBoltzmann.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

using namespace steerable::data;

namespace
{
// One run for all tests: it takes seconds.
class TestCylinderWake : public ::testing::Test
{
protected:
  static constexpr double SpinUp = 50.0;
  static constexpr double Measured = 30.0;

  // Flux through the columns at x = 1 D, 10 D and 19 D, over that of the uniform inflow.
  static constexpr int FluxColumns = 3;
  static inline double MeanFlux[FluxColumns] = {};
  static inline CylinderWakeParameters* Parameters = nullptr;
  static inline CylinderWake* Wake = nullptr;
  static inline std::size_t First = 0;

  static void SetUpTestSuite()
  {
    Parameters = new CylinderWakeParameters;
    Wake = new CylinderWake(*Parameters);
    Wake->AdvanceTo(SpinUp);
    First = Wake->GetLift().size();
    constexpr int samples = 60;
    for (int sample = 1; sample <= samples; ++sample)
    {
      Wake->AdvanceTo(SpinUp + Measured * sample / samples);
      const std::vector<float> velocity = Wake->GetVelocity();
      for (int column = 0; column < FluxColumns; ++column)
      {
        const int x = Parameters->Diameter * (1 + 9 * column);
        for (int y = 0; y < Parameters->Height; ++y)
        {
          MeanFlux[column] += velocity[3 * (static_cast<std::size_t>(y) * Parameters->Width + x)] /
            (static_cast<double>(samples) * Parameters->Height);
        }
      }
    }
  }

  static void TearDownTestSuite()
  {
    delete Wake;
    delete Parameters;
  }
};
} // namespace

// Unconfined, St = 0.183 at Re 150 (Williamson, J. Fluid Mech. 206, 1989); the sides, 8 D apart,
// speed the flow up and raise it.
TEST_F(TestCylinderWake, StrouhalNumber)
{
  int periods = 0;
  const double period = MeasurePeriod(Wake->GetLift(), First, &periods) * Wake->GetTimeStep();
  EXPECT_GE(periods, 4);
  EXPECT_GT(1.0 / period, 0.18);
  EXPECT_LT(1.0 / period, 0.21);
}

// A street, not a wake that has only begun to sway; symmetric, so no mean lift.
TEST_F(TestCylinderWake, Forces)
{
  // Whole periods, so that the oscillation does not bias the mean.
  int periods = 0;
  const double period = MeasurePeriod(Wake->GetLift(), First, &periods);
  const std::size_t samples = static_cast<std::size_t>(std::lround(period * periods));
  double lift = 0.0;
  double drag = 0.0;
  double peak = 0.0;
  for (std::size_t k = First; k < First + samples; ++k)
  {
    lift += Wake->GetLift()[k] / static_cast<double>(samples);
    drag += Wake->GetDrag()[k] / static_cast<double>(samples);
    peak = std::max(peak, std::abs(Wake->GetLift()[k]));
  }
  EXPECT_NEAR(lift, 0.0, 0.03);
  EXPECT_GT(peak, 0.4);
  EXPECT_LT(peak, 0.9);
  EXPECT_GT(drag, 1.3);
  EXPECT_LT(drag, 1.7);
}

// What comes in goes out. Interpolated bounce-back loses about one permille at the cylinder.
TEST_F(TestCylinderWake, ConservesMass)
{
  for (const double flux : MeanFlux)
  {
    EXPECT_NEAR(flux, 1.0, 0.0025);
  }
  EXPECT_NEAR(Wake->GetMeanDensityDeviation(), 0.0, 0.005);
}

TEST_F(TestCylinderWake, VelocityIsFiniteAndZeroInTheCylinder)
{
  const std::vector<float> velocity = Wake->GetVelocity();
  const std::vector<unsigned char>& solid = Wake->GetSolid();
  ASSERT_EQ(solid.size(), static_cast<std::size_t>(Parameters->Width) * Parameters->Height);
  ASSERT_EQ(velocity.size(), 3 * solid.size());

  std::size_t solidCells = 0;
  double fastest = 0.0;
  for (std::size_t cell = 0; cell < solid.size(); ++cell)
  {
    const double speed = std::hypot(velocity[3 * cell], velocity[3 * cell + 1]);
    ASSERT_TRUE(std::isfinite(speed)) << "cell " << cell;
    ASSERT_EQ(velocity[3 * cell + 2], 0.f) << "cell " << cell;
    if (solid[cell])
    {
      ++solidCells;
      ASSERT_EQ(speed, 0.0) << "cell " << cell;
    }
    fastest = std::max(fastest, speed);
  }
  const double area = 3.14159265 * 0.25 * Parameters->Diameter * Parameters->Diameter;
  EXPECT_NEAR(static_cast<double>(solidCells), area, 0.03 * area);
  EXPECT_GT(fastest, 1.2);
  EXPECT_LT(fastest, 1.8);
}

TEST(TestCylinderWakeMeasurePeriod, FindsThePeriodOfASine)
{
  std::vector<double> series;
  for (int k = 0; k < 1000; ++k)
  {
    series.push_back(3.0 + std::sin(2.0 * 3.14159265 * k / 73.5));
  }
  int periods = 0;
  EXPECT_NEAR(MeasurePeriod(series, 100, &periods), 73.5, 0.05);
  EXPECT_EQ(periods, 11);
  EXPECT_EQ(MeasurePeriod({}, 0), 0.0);
  EXPECT_EQ(MeasurePeriod(std::vector<double>(10, 1.0), 0, &periods), 0.0);
  EXPECT_EQ(periods, 0);
}

TEST(TestCylinderWakeParameters, RejectsWhatCannotBeSimulated)
{
  CylinderWakeParameters coarse;
  coarse.Diameter = 4;
  EXPECT_THROW(CylinderWake{ coarse }, std::invalid_argument);
  CylinderWakeParameters fast;
  fast.LatticeSpeed = 0.5;
  EXPECT_THROW(CylinderWake{ fast }, std::invalid_argument);
  CylinderWakeParameters outside;
  outside.CenterX = -1.0;
  EXPECT_THROW(CylinderWake{ outside }, std::invalid_argument);
}
