// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The flow that the kernel is timed with.
#ifndef BenchmarkFlow_h
#define BenchmarkFlow_h

#include <array>
#include <cmath>
#include <cstdint>

/// At a sample of an image; 2D: within its plane.
inline std::array<float, 3> BenchmarkFlow(
  int dimension, std::int64_t i, std::int64_t j, std::int64_t k)
{
  return { std::cos(0.013f * j + 0.02f * k), std::sin(0.011f * i),
    dimension == 2 ? 0.0f : 0.5f * std::sin(0.017f * (i + j)) };
}

#endif
