// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The SIMD levels that the kernel is compiled for, one after the other.
#ifndef SimdLevels_h
#define SimdLevels_h

#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace steerable
{
namespace testing
{
/**
 * While it lives, Highway takes no better SIMD level than this one. Levels come from SimdLevels(),
 * the best first.
 */
class SimdLevel
{
public:
  explicit SimdLevel(std::int64_t target)
  {
    // Better levels have lower bits. Worse ones stay: the kernel is not compiled for all of them.
    hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~(target - 1));
  }
  ~SimdLevel() { hwy::SetSupportedTargetsForTest(0); }
  SimdLevel(const SimdLevel&) = delete;
  SimdLevel& operator=(const SimdLevel&) = delete;
};

inline std::vector<std::int64_t> SimdLevels()
{
  std::vector<std::int64_t> levels = hwy::SupportedAndGeneratedTargets();
  // The kernel is not compiled for this one and would take the scalar level once more.
  levels.erase(std::remove(levels.begin(), levels.end(), HWY_SSSE3), levels.end());
  return levels;
}
} // namespace testing
} // namespace steerable

#endif
