// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The stages of a walk one by one, beside all corners of a box in double, at every SIMD level.
// Before Highway's headers.
#include "SimdTargets.h"

#include "KernelTestHelpers.h"
#include "LatticeHash.h"
#include "SteerableNoise.h"
#include "Surflet.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <random>
#include <string>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "TestWalkStages.cxx"
#include <hwy/foreach_target.h>

#include "Fast/Walk/Surflet-inl.h"
#include "Fast/Walk/View-inl.h"

#ifndef TestWalkStages_once
#define TestWalkStages_once
namespace steerable
{
namespace testing
{
/// What a stage got wrong.
struct StageErrors
{
  std::size_t Checked = 0;
  std::size_t Lost = 0;
  double Largest = 0.0;
};
} // namespace testing
} // namespace steerable
#endif

HWY_BEFORE_NAMESPACE();
namespace steerable
{
namespace HWY_NAMESPACE
{
/// A tile of points along a curve through a flow that turns, ready for a walk.
template <int N>
struct CurvedTile
{
  NoiseSetup Setup = {};
  OctaveSetup Octave = {};
  std::unique_ptr<MetricBlock> Block{ new MetricBlock };
  Tile Samples{ TileRegisters, Lanes };

  CurvedTile(unsigned seed, double step, bool biaxial = false)
  {
    this->Setup.Support = 1.0f;
    this->Setup.WindowReach = std::numeric_limits<float>::infinity();
    this->Setup.Curved = true;
    this->Setup.Biaxial = biaxial;
    for (int i = 0; i < 3; ++i)
    {
      this->Setup.LatticeSteps[i][i] = 1.0f;
      this->Setup.LatticeIndices[i][i] = 1.0;
    }
    this->Octave.Seed = HashOfSeed(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const double start = 3.0 * uniform(random);
    const double turn = 0.3 * uniform(random);
    Eigen::Vector3d direction(uniform(random), uniform(random), N == 3 ? uniform(random) : 0.0);
    direction.normalize();
    MetricBlock& block = *this->Block;
    const std::size_t count = TileRegisters * Lanes;
    for (std::size_t i = 0; i < count; ++i)
    {
      const double angle = start + turn * step * static_cast<double>(i);
      Eigen::Vector3d u(std::cos(angle), std::sin(angle), N == 3 ? 0.4 : 0.0);
      u.normalize();
      Eigen::Vector3d bend = turn * Eigen::Vector3d(-std::sin(angle), std::cos(angle), 0.0);
      for (int axis = 0; axis < N; ++axis)
      {
        const double place = 50.3 + step * static_cast<double>(i) * direction[axis];
        const double cell = std::floor(place + 0.5);
        block.Cell[axis][i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(cell));
        block.Fraction[axis][i] = static_cast<float>(place - cell);
        block.U[axis][i] = static_cast<float>(i % 7 == 3 ? -u[axis] : u[axis]); // an axis has no sense
        block.ClampedBend[axis][i] = static_cast<float>(bend[axis]);
      }
      if (biaxial)
      {
        // It turns around the flow, and has no sense either.
        const double around = 0.4 * start + 0.12 * step * static_cast<double>(i);
        const Eigen::Vector3d first = u.unitOrthogonal();
        const Eigen::Vector3d m = std::cos(around) * first + std::sin(around) * u.cross(first);
        for (int axis = 0; axis < 3; ++axis)
        {
          block.M[axis][i] = static_cast<float>(i % 5 == 2 ? -m[axis] : m[axis]);
        }
        block.BentSecond[i] = static_cast<float>(0.5 + 0.01 * static_cast<double>(i % 4));
      }
      if (N == 2)
      {
        const double sign = i % 7 == 3 ? -1.0 : 1.0;
        block.URest[0][i] = RestOf(sign * u[0]);
        block.URest[1][i] = RestOf(sign * u[1]);
      }
      block.BentAlong[i] = static_cast<float>(1.0 / 25.0 + 0.002 * static_cast<double>(i % 5));
      block.BentAcross[i] = static_cast<float>(1.7 + 0.02 * static_cast<double>(i % 3));
      block.Directed[i] = 1.0f;
    }
    for (std::size_t i = 0; i < count; i += Lanes)
    {
      const std::size_t r = this->Samples.Registers++;
      this->Samples.SetRegister(r, i, 0, r, Lanes, 1);
    }
  }

  WalkSetup<N, WalkKind::Plain> GetWalk() const
  {
    return WalkSetup<N, WalkKind::Plain>(this->Setup, this->Octave, *this->Block);
  }

  /// From sample i to the corner at these indices from the cell of sample 0.
  Vector<N> GetVector(std::size_t i, const std::array<int, 3>& corner) const
  {
    Vector<N> v;
    for (int axis = 0; axis < N; ++axis)
    {
      const auto cells =
        static_cast<std::int32_t>(this->Block->Cell[axis][i] - this->Block->Cell[axis][0]);
      v[axis] = corner[axis] - cells - static_cast<double>(this->Block->Fraction[axis][i]);
    }
    return v;
  }

  /// s, the part across after bending, and q.
  double GetQ(std::size_t i, const std::array<int, 3>& corner) const
  {
    Vector<N> u;
    Vector<N> bend;
    for (int axis = 0; axis < N; ++axis)
    {
      u[axis] = this->Block->U[axis][i];
      bend[axis] = this->Block->ClampedBend[axis][i];
    }
    u.normalize();
    const Vector<N> v = this->GetVector(i, corner);
    const double s = v.dot(u);
    const Vector<N> t = v - s * u - 0.5 * s * s * bend;
    double across2 = this->Block->BentAcross[i] * t.squaredNorm();
    if (this->Setup.Biaxial)
    {
      Vector<N> m;
      for (int axis = 0; axis < N; ++axis)
      {
        m[axis] = this->Block->M[axis][i];
      }
      const double second = t.dot(m);
      across2 += (this->Block->BentSecond[i] - this->Block->BentAcross[i]) * second * second;
    }
    return this->Block->BentAlong[i] * s * s + across2;
  }
};

/// Calls `work` with every corner of the box of cells to both sides of the first sample's.
template <int N, class Work>
void ForBox(int half, Work&& work)
{
  for (int z = N == 3 ? -half : 0; z <= (N == 3 ? half : 0); ++z)
  {
    for (int y = -half; y <= half; ++y)
    {
      for (int x = -half; x <= half; ++x)
      {
        work(std::array<int, 3>{ x, y, z });
      }
    }
  }
}

/// Whether the row of a corner, cut for a lane, reaches it.
template <class WalkT, int N>
bool IsOnItsRow(
  const WalkT& walk, const Reach<N>& reach, const std::array<int, 3>& corner, std::size_t lane)
{
  HWY_ALIGN float lows[Lanes];
  HWY_ALIGN float highs[Lanes];
  V low = Const(-1e9f);
  V high = Const(1e9f);
  const IndexAxis axis = GetIndexAxis(walk, reach, N - 1);
  V begin;
  V end;
  GetInterval(walk, reach, N - 1, axis, Const(static_cast<float>(corner[N - 1])), begin, end);
  RowCutter<N, WalkT> cutter(walk, reach);
  cutter.SetLayer(Const(static_cast<float>(corner[2])), begin, end);
  cutter.Cut(Const(static_cast<float>(corner[1])), low, high);
  hn::Store(low, DF(), lows);
  hn::Store(high, DF(), highs);
  return lows[lane] <= corner[0] && corner[0] <= highs[lane];
}

/// Corners within q < 1 of a sample that its rows, cut for it alone, leave out.
template <int N>
testing::StageErrors CheckReachApart(unsigned seed, bool biaxial)
{
  testing::StageErrors errors;
  const CurvedTile<N> tile(seed, 0.1, biaxial);
  const auto walk = tile.GetWalk();
  const Reach<N> reach = GetReachApart<N>(walk, 0);
  for (std::size_t lane = 0; lane < Lanes; ++lane)
  {
    ForBox<N>(9,
      [&](const std::array<int, 3>& corner) HWY_ATTR
      {
        std::array<int, 3> own = corner; // rows count from each sample's own cell
        for (int axis = 0; axis < N; ++axis)
        {
          own[axis] += static_cast<std::int32_t>(
            tile.Block->Cell[axis][lane] - tile.Block->Cell[axis][0]);
        }
        if (tile.GetQ(lane, own) >= 1.0)
        {
          return;
        }
        ++errors.Checked;
        errors.Lost += !IsOnItsRow(walk, reach, corner, lane);
      });
  }
  return errors;
}

/// Corners within q < 1 of samples of a span that are not on its rows, are sifted out, or are not
/// seen.
template <int N>
testing::StageErrors CheckSpan(unsigned seed, bool biaxial)
{
  testing::StageErrors errors;
  const CurvedTile<N> tile(seed, 0.02, biaxial);
  const auto walk = tile.GetWalk();
  const std::size_t end = tile.Samples.Registers;
  const SpanCorners corners(tile.Samples, 0, end);
  VU origin[N];
  Group<N> group;
  Extent extent;
  FitGroup(walk, tile.Samples, corners, 0, end, origin, group, extent);
  FinishGroup(walk, tile.Samples, corners, 0, end, extent, group);
  const Reach<N> reach(group, extent, hn::Abs(group.PlaceStep[0][0]));
  const Span<N> span(tile.Samples, corners, 0, end, group, extent);
  ForBox<N>(10,
    [&](const std::array<int, 3>& corner) HWY_ATTR
    {
      bool any = false;
      for (std::size_t i = 0; i < end * Lanes; ++i)
      {
        any = any || tile.GetQ(i, corner) < 1.0;
      }
      if (!any)
      {
        return;
      }
      ++errors.Checked;
      errors.Lost += !IsOnItsRow(walk, reach, corner, 0);
      CornerList<N> list;
      list.Count = 1;
      for (int axis = 0; axis < N; ++axis)
      {
        std::fill_n(list.Index[axis], Lanes, corner[axis]);
        std::fill_n(list.Offset[axis], Lanes, static_cast<float>(corner[axis]));
        std::fill_n(list.Jitter[axis], Lanes, 0.0f);
      }
      Sift(walk, span, reach, list);
      errors.Lost += list.Count != 1;
      list.Count = 1;
      ListBits reaching[TileRegisters];
      SetReaching(walk, span, list, reaching);
      for (std::size_t i = 0; i < end * Lanes; ++i)
      {
        errors.Lost += tile.GetQ(i, corner) < 1.0 && (reaching[i / Lanes][0] & 1) == 0;
      }
    });
  return errors;
}

/// Hashes of corners beside LatticeHash.h.
template <int N>
testing::StageErrors CheckLattice(unsigned seed)
{
  testing::StageErrors errors;
  CurvedTile<N> tile(seed, 0.1);
  HWY_ALIGN std::uint32_t hashes[Lanes];
  for (const std::int64_t period : { 0, 5 })
  {
    tile.Octave.Period = { period, 0, period };
    VU origin[N];
    for (int axis = 0; axis < N; ++axis)
    {
      origin[axis] = hn::Set(DU(), static_cast<std::uint32_t>(axis + 1));
    }
    for (int x = -6; x < 6; ++x)
    {
      VI corner[N];
      for (int axis = 0; axis < N; ++axis)
      {
        corner[axis] = axis == 0 ? RampInt(x) : hn::Set(DI(), x + axis);
      }
      hn::Store(HashCorners(tile.GetWalk(), origin, corner), DU(), hashes);
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        const std::uint32_t expected =
          HashCorner(WrapToPeriod(x + static_cast<int>(lane) + 1, period),
            static_cast<std::uint32_t>(x + 1 + 2),
            N == 3 ? WrapToPeriod(x + 2 + 3, period) : 0, seed);
        ++errors.Checked;
        errors.Lost += hashes[lane] != expected;
      }
    }
  }
  return errors;
}

/// Sums over all corners of a box beside the same sums in double.
template <int N>
testing::StageErrors CheckSurflet(unsigned seed)
{
  testing::StageErrors errors;
  CurvedTile<N> tile(seed, 0.1);
  const auto walk = tile.GetWalk();
  VU origin[N];
  for (int axis = 0; axis < N; ++axis)
  {
    origin[axis] = hn::Set(DU(), tile.Block->Cell[axis][0]);
  }
  const Sample<N> sample(tile.Setup, *tile.Block, 0, origin);
  using Kind = SurfletKind<true, Normalization::UnitVariance, false>;
  SurfletSums<N> sums;
  std::vector<std::array<double, 2>> expected(Lanes, { 0.0, 0.0 });
  ForBox<N>(9,
    [&](const std::array<int, 3>& corner) HWY_ATTR
    {
      VI index[N];
      V offset[N];
      for (int axis = 0; axis < N; ++axis)
      {
        index[axis] = hn::Set(DI(), corner[axis]);
        offset[axis] = hn::ConvertTo(DF(), index[axis]);
      }
      AddSurflet<Kind>(
        walk, sample, Describe(walk, offset, HashCorners(walk, origin, index)), sums);
      const auto cell = [&](int axis)
      { return axis < N ? tile.Block->Cell[axis][0] + static_cast<std::uint32_t>(corner[axis]) : 0; };
      const Vector<N> g = GradientOf<N>(
        GradientSet::Uniform, HashCorner(cell(0), cell(1), cell(2), seed));
      for (std::size_t lane = 0; lane < Lanes; ++lane)
      {
        Vector<N> u;
        Vector<N> bend;
        for (int axis = 0; axis < N; ++axis)
        {
          const double rest = N == 2 ? tile.Block->URest[axis][lane] : 0.0;
          u[axis] = tile.Block->U[axis][lane] + rest;
          bend[axis] = tile.Block->ClampedBend[axis][lane];
        }
        u.normalize();
        const Vector<N> v = tile.GetVector(lane, corner);
        const double s = v.dot(u);
        const Vector<N> t = v - s * u - 0.5 * s * s * bend;
        const double k = tile.Block->BentAlong[lane];
        const double b = tile.Block->BentAcross[lane];
        const double weight = FadeOf(Fade::Quintic, k * s * s + b * t.squaredNorm());
        const Vector<N> Gv = k * s * u + b * t;
        expected[lane][0] += weight * g.dot(Gv);
        expected[lane][1] += weight * weight * Gv.squaredNorm();
      }
    });
  const Sums found = GetSums<N>(walk, 0, sums);
  HWY_ALIGN float noise[Lanes];
  HWY_ALIGN float variance[Lanes];
  hn::Store(found.Noise, DF(), noise);
  hn::Store(found.Variance, DF(), variance);
  for (std::size_t lane = 0; lane < Lanes; ++lane)
  {
    ++errors.Checked;
    errors.Largest = std::max({ errors.Largest, std::abs(noise[lane] - expected[lane][0]),
      std::abs(variance[lane] - expected[lane][1]) });
  }
  return errors;
}

testing::StageErrors Check(int stage, int dimension, unsigned seed, bool biaxial)
{
  switch (stage)
  {
    case 0:
      return dimension == 2 ? CheckLattice<2>(seed) : CheckLattice<3>(seed);
    case 1:
      return dimension == 2 ? CheckReachApart<2>(seed, false) : CheckReachApart<3>(seed, biaxial);
    case 2:
      return dimension == 2 ? CheckSpan<2>(seed, false) : CheckSpan<3>(seed, biaxial);
    default:
      return dimension == 2 ? CheckSurflet<2>(seed) : CheckSurflet<3>(seed);
  }
}
} // namespace HWY_NAMESPACE
} // namespace steerable
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace steerable
{
HWY_EXPORT(Check);

namespace
{
void CheckAtAllLevels(int stage, double bound, bool biaxial = false)
{
  for (std::int64_t target : testing::SimdLevels())
  {
    const testing::SimdLevel level(target);
    for (int dimension : { 2, 3 })
    {
      for (unsigned seed = 1; seed <= (stage == 2 ? 12 : 6); ++seed)
      {
        const testing::StageErrors errors =
          HWY_DYNAMIC_DISPATCH(Check)(stage, dimension, seed, biaxial);
        SCOPED_TRACE(std::to_string(dimension) + "D, " + hwy::TargetName(target) + ", seed " +
          std::to_string(seed));
        EXPECT_GT(errors.Checked, 0u);
        EXPECT_EQ(errors.Lost, 0u);
        EXPECT_LE(errors.Largest, bound);
      }
    }
  }
}
} // namespace

TEST(WalkStages, LatticeHashesAsLatticeHash)
{
  CheckAtAllLevels(0, 0.0);
}

TEST(WalkStages, ReachOfASampleLosesNoCorner)
{
  CheckAtAllLevels(1, 0.0);
}

TEST(WalkStages, RowsSiftAndViewOfASpanLoseNoCorner)
{
  CheckAtAllLevels(2, 0.0);
}

TEST(WalkStages, SecondAxesLoseNoCorner)
{
  CheckAtAllLevels(1, 0.0, true);
  CheckAtAllLevels(2, 0.0, true);
}

TEST(WalkStages, SurfletsAddUpAsInDouble)
{
  CheckAtAllLevels(3, 2e-6);
}
} // namespace steerable
#endif
