// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The corner hash is white noise, to the last figure that the samples can show.
#include "LatticeHash.h"
#include "Surflet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace steerable;

namespace
{
using Index = std::array<std::int32_t, 3>;

/// A block of corners about a place far enough from the origin to have all signs.
std::vector<Index> Corners(const Index& first, const Index& size)
{
  std::vector<Index> corners;
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x)
      {
        corners.push_back({ first[0] + x, first[1] + y, first[2] + z });
      }
    }
  }
  return corners;
}

const std::vector<Index>& PlaneCorners()
{
  static const std::vector<Index> corners = Corners({ -300, -200, 0 }, { 512, 512, 1 });
  return corners;
}

const std::vector<Index>& SpaceCorners()
{
  static const std::vector<Index> corners = Corners({ -40, -30, -20 }, { 64, 64, 64 });
  return corners;
}

std::uint32_t HashAt(const Index& corner, std::uint32_t seed = 0)
{
  return HashCorner(static_cast<std::uint32_t>(corner[0]), static_cast<std::uint32_t>(corner[1]),
    static_cast<std::uint32_t>(corner[2]), seed);
}

Index Shift(const Index& corner, const Index& offset)
{
  // In unsigned arithmetic, as the kernel does it.
  Index shifted;
  for (int axis = 0; axis < 3; ++axis)
  {
    shifted[axis] = static_cast<std::int32_t>(
      static_cast<std::uint32_t>(corner[axis]) + static_cast<std::uint32_t>(offset[axis]));
  }
  return shifted;
}

/// Mean of values of unit variance that should be 0, in standard errors.
class Deviation
{
public:
  void Add(double value)
  {
    this->Sum += value;
    ++this->Count;
  }
  double Get() const { return std::abs(this->Sum) / std::sqrt(this->Count); }

private:
  double Sum = 0.0;
  double Count = 0.0;
};

/// Some thousand such means are tested with this bound: one in 2e8 exceeds it by chance.
constexpr double Limit = 5.5;

/// Bits as a number of variance 1.
double Standardized(std::uint32_t hash)
{
  return std::sqrt(3.0) * ValueOf(hash);
}

double SignOf(std::uint32_t hash)
{
  return (hash >> 31) ? -1.0 : 1.0;
}

/// Chi-square of counts that should be equal, as standard deviations from its mean.
double ChiSquareExcess(const std::vector<int>& counts)
{
  double total = 0.0;
  for (int count : counts)
  {
    total += count;
  }
  const double expected = total / static_cast<double>(counts.size());
  double chiSquare = 0.0;
  for (int count : counts)
  {
    chiSquare += (count - expected) * (count - expected) / expected;
  }
  const double freedom = static_cast<double>(counts.size()) - 1.0;
  return (chiSquare - freedom) / std::sqrt(2.0 * freedom);
}

std::vector<Index> Offsets(int dimension)
{
  std::vector<Index> offsets;
  const int z = dimension == 3 ? 1 : 0;
  for (int k = 0; k <= 2 * z; ++k)
  {
    for (int j = -3; j <= 3; ++j)
    {
      for (int i = -3; i <= 3; ++i)
      {
        if (k > 0 || j > 0 || (j == 0 && i > 0)) // the other half is the same by symmetry
        {
          offsets.push_back({ i, j, k });
        }
      }
    }
  }
  for (int far : { 16, 17, 64, 127, 256, 257, 512, 1024, 1600, 1601, 4096, 32768, 65535, 65536,
         65537, 1 << 20, 1 << 24, 1 << 30 })
  {
    offsets.push_back({ far, 0, 0 });
    offsets.push_back({ 0, far, 0 });
    offsets.push_back({ far, far, 0 });
    offsets.push_back({ far, -far, 0 });
    offsets.push_back({ far, 1, 0 });
    if (dimension == 3)
    {
      offsets.push_back({ 0, 0, far });
      offsets.push_back({ far, 0, far });
      offsets.push_back({ far, far, far });
      offsets.push_back({ -far, far, -far });
    }
  }
  return offsets;
}

template <int N>
void ExpectWhite(const std::vector<Index>& corners)
{
  std::vector<std::uint32_t> hashes;
  std::vector<Vector<N>> gradients;
  for (const Index& corner : corners)
  {
    hashes.push_back(HashAt(corner));
    gradients.push_back(UniformGradient<N>(hashes.back()));
  }
  double worst = 0.0;
  for (const Index& offset : Offsets(N))
  {
    Deviation value;
    Deviation sign;
    Deviation gradient;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      const std::uint32_t other = HashAt(Shift(corners[i], offset));
      value.Add(Standardized(hashes[i]) * Standardized(other));
      sign.Add(SignOf(hashes[i]) * SignOf(other));
      gradient.Add(std::sqrt(N) * gradients[i].dot(UniformGradient<N>(other)));
    }
    const double deviation = std::max({ value.Get(), sign.Get(), gradient.Get() });
    EXPECT_LT(deviation, Limit) << "offset " << offset[0] << ' ' << offset[1] << ' ' << offset[2];
    worst = std::max(worst, deviation);
  }
  std::printf("largest autocorrelation in %dD: %.2f standard errors\n", N, worst);
}
} // namespace

TEST(LatticeHash, KeepsItsBits)
{
  // Worked out by hand from the definition: C++, SIMD levels and shaders must repeat them for ever.
  const auto mix = [](std::uint32_t c, std::uint32_t a, std::uint32_t b)
  {
    const std::uint64_t word = 1ull << 32;
    const std::uint64_t first = (std::uint64_t(c) * a) % word;
    return static_cast<std::uint32_t>(((first ^ (first >> 16)) * b) % word);
  };
  for (const Index& corner : { Index{ 0, 0, 0 }, Index{ 1, 2, 3 }, Index{ -1, -2, -3 },
         Index{ 1 << 30, -(1 << 30), 65536 } })
  {
    std::uint32_t h = mix(corner[0], 0x9E3779B1u, 0x7FEB352Du) ^
      mix(corner[1], 0x85EBCA77u, 0x846CA68Bu) ^ mix(corner[2], 0xC2B2AE3Du, 0x2C1B3C6Du) ^
      mix(7 + 1, 0x27D4EB2Fu, 0x7FEB352Du);
    h = (h ^ (h >> 15)) * 0x297A2D39u;
    h ^= h >> 15;
    EXPECT_EQ(HashAt(corner, 7), h);
  }
}

TEST(LatticeHash, IsWhiteInThePlane)
{
  ExpectWhite<2>(PlaneCorners());
}

TEST(LatticeHash, IsWhiteInSpace)
{
  ExpectWhite<3>(SpaceCorners());
}

TEST(LatticeHash, HasUniformBits)
{
  for (const auto* corners : { &PlaneCorners(), &SpaceCorners() })
  {
    for (int shift : { 24, 20, 16, 8, 0 })
    {
      std::vector<int> counts(256, 0);
      for (const Index& corner : *corners)
      {
        ++counts[(HashAt(corner) >> shift) & 255u];
      }
      EXPECT_LT(std::abs(ChiSquareExcess(counts)), Limit) << "bits from " << shift;
    }
    // Neighbours together: 16 x 16 combinations of their top bits.
    for (const Index& offset : { Index{ 1, 0, 0 }, Index{ 0, 1, 0 }, Index{ 1, 1, 0 },
           Index{ 1, -1, 0 }, Index{ 256, 0, 0 }, Index{ 0, 0, 1 }, Index{ 1, 1, 1 } })
    {
      std::vector<int> counts(256, 0);
      for (const Index& corner : *corners)
      {
        ++counts[(HashAt(corner) >> 28) * 16 + (HashAt(Shift(corner, offset)) >> 28)];
      }
      EXPECT_LT(std::abs(ChiSquareExcess(counts)), Limit)
        << "offset " << offset[0] << ' ' << offset[1] << ' ' << offset[2];
    }
  }
}

TEST(LatticeHash, GivesUniformDirectionsOnTheCircle)
{
  std::vector<int> histogram(128, 0);
  std::array<Deviation, 8> moments;
  for (const Index& corner : PlaneCorners())
  {
    const Vector<2> g = UniformGradient<2>(HashAt(corner));
    ASSERT_NEAR(g.norm(), 1.0, 1e-14);
    const double angle = std::atan2(g[1], g[0]);
    ++histogram[std::min(127, static_cast<int>((angle / Pi + 1.0) * 64.0))];
    for (int m = 1; m <= 4; ++m) // trigonometric moments: all vanish
    {
      moments[2 * m - 2].Add(std::sqrt(2.0) * std::cos(m * angle));
      moments[2 * m - 1].Add(std::sqrt(2.0) * std::sin(m * angle));
    }
  }
  EXPECT_LT(std::abs(ChiSquareExcess(histogram)), Limit);
  for (const Deviation& moment : moments)
  {
    EXPECT_LT(moment.Get(), Limit);
  }
}

TEST(LatticeHash, GivesUniformDirectionsOnTheSphere)
{
  std::vector<int> histogram(256, 0);
  std::array<Deviation, 12> moments;
  for (const Index& corner : SpaceCorners())
  {
    const Vector<3> g = UniformGradient<3>(HashAt(corner));
    ASSERT_NEAR(g.norm(), 1.0, 1e-14);
    const int zone = std::min(15, static_cast<int>((g[2] + 1.0) * 8.0));
    const int sector = std::min(15, static_cast<int>((std::atan2(g[1], g[0]) / Pi + 1.0) * 8.0));
    ++histogram[16 * zone + sector];
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3;
      moments[i].Add(std::sqrt(3.0) * g[i]);             // E g = 0
      moments[3 + i].Add(std::sqrt(15.0) * g[i] * g[j]); // E g gT = I / 3 ...
      moments[6 + i].Add((g[i] * g[i] - 1.0 / 3.0) / std::sqrt(4.0 / 45.0));
      moments[9 + i].Add((std::pow(g[i], 4) - 0.2) / std::sqrt(1.0 / 9.0 - 0.04)); // E g^4 = 1/5
    }
  }
  EXPECT_LT(std::abs(ChiSquareExcess(histogram)), Limit);
  for (std::size_t i = 0; i < moments.size(); ++i)
  {
    EXPECT_LT(moments[i].Get(), Limit) << "moment " << i;
  }
}

TEST(LatticeHash, TreatsNegativeCoordinatesAlike)
{
  // No mirror and no copy: the four quadrants about the origin are independent of each other.
  Deviation mirrored[3];
  for (int y = 1; y <= 400; ++y)
  {
    for (int x = 1; x <= 400; ++x)
    {
      const double here = Standardized(HashAt({ x, y, 0 }));
      mirrored[0].Add(here * Standardized(HashAt({ -x, y, 0 })));
      mirrored[1].Add(here * Standardized(HashAt({ x, -y, 0 })));
      mirrored[2].Add(here * Standardized(HashAt({ -x, -y, 0 })));
    }
  }
  for (const Deviation& deviation : mirrored)
  {
    EXPECT_LT(deviation.Get(), Limit);
  }
  // Nor is the plane symmetric about its diagonals: the axes are mixed differently.
  Deviation swapped;
  for (int y = -250; y < 250; ++y)
  {
    for (int x = -250; x < y; ++x)
    {
      swapped.Add(Standardized(HashAt({ x, y, 0 })) * Standardized(HashAt({ y, x, 0 })));
    }
  }
  EXPECT_LT(swapped.Get(), Limit);
}

TEST(LatticeHash, HasIndependentSeeds)
{
  for (std::uint32_t seed : { 0u, 1u, 41u, 0xFFFFFFFFu })
  {
    for (std::uint32_t step : { 1u, 2u, 3u, 16u, 256u, 65536u, 0x80000000u })
    {
      Deviation same;
      Deviation shifted;
      Deviation sign;
      for (const Index& corner : PlaneCorners())
      {
        const std::uint32_t here = HashAt(corner, seed);
        const std::uint32_t there = HashAt(corner, seed + step);
        same.Add(Standardized(here) * Standardized(there));
        sign.Add(SignOf(here) * SignOf(there));
        // Another seed must not be the same noise moved by a cell either.
        shifted.Add(
          Standardized(here) * Standardized(HashAt(Shift(corner, { 1, 0, 0 }), seed + step)));
      }
      EXPECT_LT(same.Get(), Limit) << seed << " + " << step;
      EXPECT_LT(sign.Get(), Limit) << seed << " + " << step;
      EXPECT_LT(shifted.Get(), Limit) << seed << " + " << step;
    }
  }
}

TEST(LatticeHash, HasIndependentStreams)
{
  const auto streamAt = [](const Index& corner, int stream)
  { return stream == 0 ? HashAt(corner) : HashStream(HashAt(corner), stream); };
  for (int a = 0; a <= 5; ++a)
  {
    for (int b = a; b <= 5; ++b)
    {
      for (const Index& offset : { Index{ 0, 0, 0 }, Index{ 1, 0, 0 }, Index{ 0, 1, 0 },
             Index{ 1, 1, 0 }, Index{ 0, 0, 1 } })
      {
        if (a == b && offset == Index{ 0, 0, 0 })
        {
          continue;
        }
        Deviation value;
        std::vector<int> counts(256, 0);
        for (const Index& corner : SpaceCorners())
        {
          const std::uint32_t here = streamAt(corner, a);
          const std::uint32_t there = streamAt(Shift(corner, offset), b);
          value.Add(Standardized(here) * Standardized(there));
          ++counts[(here >> 28) * 16 + (there >> 28)];
        }
        EXPECT_LT(value.Get(), Limit) << "streams " << a << " and " << b;
        EXPECT_LT(std::abs(ChiSquareExcess(counts)), Limit) << "streams " << a << " and " << b;
      }
    }
  }
  // The numbers in [0, 1) that clocks, jitter and density read.
  for (int stream = 1; stream <= 5; ++stream)
  {
    std::vector<int> counts(256, 0);
    for (const Index& corner : PlaneCorners())
    {
      const double unit = HashToUnit(streamAt(corner, stream));
      ASSERT_GE(unit, 0.0);
      ASSERT_LT(unit, 1.0);
      ++counts[static_cast<int>(unit * 256.0)];
    }
    EXPECT_LT(std::abs(ChiSquareExcess(counts)), Limit) << "stream " << stream;
  }
}

TEST(LatticeHash, HasNoFourPointCorrelation)
{
  // The axes are joined by exclusive or, so the four corners of a rectangle cancel before the last
  // mix. Afterwards nothing of that may show: not in the signs, the values nor in single top bits.
  const std::vector<std::array<Index, 2>> spans = { { { { 1, 0, 0 }, { 0, 1, 0 } } },
    { { { 2, 0, 0 }, { 0, 3, 0 } } }, { { { 16, 0, 0 }, { 0, 16, 0 } } },
    { { { 256, 0, 0 }, { 0, 256, 0 } } }, { { { 65536, 0, 0 }, { 0, 65536, 0 } } },
    { { { 1, 1, 0 }, { 1, -1, 0 } } }, { { { 1, 0, 0 }, { 0, 0, 1 } } },
    { { { 0, 1, 0 }, { 0, 0, 1 } } }, { { { 1, 1, 0 }, { 0, 0, 1 } } },
    { { { 7, 0, 0 }, { 0, 5, 2 } } } };
  double worst = 0.0;
  for (const auto* corners : { &PlaneCorners(), &SpaceCorners() })
  {
    for (const auto& span : spans)
    {
      Deviation value;
      std::array<Deviation, 8> bits; // the top 8: sign and coarse direction
      for (const Index& corner : *corners)
      {
        const std::uint32_t h[4] = { HashAt(corner), HashAt(Shift(corner, span[0])),
          HashAt(Shift(corner, span[1])), HashAt(Shift(Shift(corner, span[0]), span[1])) };
        value.Add(
          Standardized(h[0]) * Standardized(h[1]) * Standardized(h[2]) * Standardized(h[3]));
        const std::uint32_t joined = h[0] ^ h[1] ^ h[2] ^ h[3];
        for (int bit = 0; bit < 8; ++bit)
        {
          bits[bit].Add(SignOf(joined << bit));
        }
      }
      EXPECT_LT(value.Get(), Limit) << "span " << span[0][0] << ' ' << span[1][1];
      worst = std::max(worst, value.Get());
      for (int bit = 0; bit < 8; ++bit)
      {
        EXPECT_LT(bits[bit].Get(), Limit)
          << "span " << span[0][0] << ' ' << span[1][1] << ", bit " << 31 - bit;
        worst = std::max(worst, bits[bit].Get());
      }
    }
  }
  std::printf("largest four-point correlation: %.2f standard errors\n", worst);
}
