// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Which lengths stand out as fill values do.
#include "LengthOctaves.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

using namespace steerable;

namespace
{
LengthOctaves Of(const std::vector<double>& lengths)
{
  LengthOctaves octaves;
  for (const double length : lengths)
  {
    octaves.Add(length);
  }
  return octaves;
}
constexpr double Infinity = std::numeric_limits<double>::infinity();
} // namespace

TEST(LengthOctaves, AlikeAndFarAboveAreFillValues)
{
  const FarAbove found = Of({ 1.0, 60.0, 960.0, 1679.0 }).FindFarAbove();
  EXPECT_EQ(found.Count, 2.0);
  EXPECT_EQ(found.Longest, 1679.0);
  EXPECT_EQ(found.Rest, 60.0);
  EXPECT_TRUE(found.Fill);
  // 1.75 is the limit of likeness.
  EXPECT_FALSE(Of({ 1.0, 60.0, 960.0, 1681.0 }).FindFarAbove().Fill);
  EXPECT_EQ(Of({ 1.0, 60.0, 960.0, 1681.0 }).FindFarAbove().Count, 2.0);
}

TEST(LengthOctaves, NearOrShortOnesAreNot)
{
  EXPECT_EQ(Of({ 1.0, 60.0, 959.0 }).FindFarAbove().Count, 0.0); // 16 times is far
  EXPECT_EQ(Of({ 1.0, 98.9 }).FindFarAbove().Count, 0.0);        // 99 is the least
  EXPECT_EQ(Of({ 1.0, 99.0 }).FindFarAbove().Count, 1.0);
  EXPECT_EQ(Of({ 1e20, 1e20 }).FindFarAbove().Count, 0.0); // nothing else is there
}

TEST(LengthOctaves, SeveralFillValuesAreOne)
{
  const FarAbove found = Of({ 2.0, 999.0, 30000.0, 1e20 }).FindFarAbove();
  EXPECT_EQ(found.Count, 3.0);
  EXPECT_EQ(found.Longest, 1e20);
  EXPECT_EQ(found.Rest, 2.0);
}

TEST(LengthOctaves, WhatIsNoLengthDoesNotCount)
{
  const double unknown = -std::numeric_limits<double>::quiet_NaN();
  const LengthOctaves octaves = Of({ 0.0, -0.0, Infinity, -1.0, unknown, 1e-310, 3.0 });
  EXPECT_EQ(octaves.GetLongest(Infinity), 3.0);
  double count = 0.0;
  for (const LengthOctaves::Octave& octave : octaves.Octaves)
  {
    count += octave.Count;
  }
  EXPECT_EQ(count, 2.0);
}

TEST(LengthOctaves, PartsCombineToTheWhole)
{
  LengthOctaves parts = Of({ 1.0, 50.0 });
  parts += Of({ 55.0, 1e6 });
  parts += Of({});
  const FarAbove found = parts.FindFarAbove();
  EXPECT_EQ(found.Rest, 55.0);
  EXPECT_EQ(parts.GetLongest(found.Rest), 55.0);
  EXPECT_EQ(parts.GetLongest(Infinity), 1e6);
}
