// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The integer hash of a lattice corner: the project's only source of randomness.
 *
 * Unsigned 32-bit arithmetic only, so that every compiler, SIMD level and shader repeats it bit for
 * bit. There is no table, hence no period below 2^32 cells, and negative coordinates wrap.
 *
 * Each axis is mixed on its own, then the axes are joined by exclusive or and mixed once more. (A
 * linear combination of the coordinates before the mixer would repeat after some 1600 cells in 3D.)
 */
#ifndef LatticeHash_h
#define LatticeHash_h

#include <cstdint>

namespace steerable
{
/**
 * The constants, named once for the C++, SIMD and GLSL versions: large odd numbers with about as
 * many ones as zeros, one pair for each axis, so that no axis is a copy of another.
 */
constexpr std::uint32_t HashAxis[3] = { 0x9E3779B1u, 0x85EBCA77u, 0xC2B2AE3Du };
constexpr std::uint32_t HashAxisFinal[3] = { 0x7FEB352Du, 0x846CA68Bu, 0x2C1B3C6Du };
constexpr std::uint32_t HashSeed = 0x27D4EB2Fu;
constexpr std::uint32_t HashJoin = 0x297A2D39u;
constexpr int HashAxisShift = 16;
constexpr int HashJoinShift = 15;

/// Mixes one coordinate of a corner; `axis` is 0, 1 or 2.
inline std::uint32_t HashOneAxis(std::uint32_t coordinate, int axis)
{
  std::uint32_t h = coordinate * HashAxis[axis];
  h ^= h >> HashAxisShift;
  return h * HashAxisFinal[axis];
}

/// Joins mixed axes (and the mixed seed) into 32 well mixed bits.
inline std::uint32_t HashJoinAxes(std::uint32_t h)
{
  h ^= h >> HashJoinShift;
  h *= HashJoin;
  return h ^ (h >> HashJoinShift);
}

/// The seed's share of a hash: constant over a whole evaluation.
inline std::uint32_t HashOfSeed(std::uint32_t seed)
{
  std::uint32_t h = (seed + 1u) * HashSeed;
  h ^= h >> HashAxisShift;
  return h * HashAxisFinal[0];
}

/// 32 random bits of the corner (x, y, z); pass z = 0 in 2D.
inline std::uint32_t HashCorner(
  std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t seed)
{
  return HashJoinAxes(HashOneAxis(x, 0) ^ HashOneAxis(y, 1) ^ HashOneAxis(z, 2) ^ HashOfSeed(seed));
}

/**
 * Further independent bits of a corner, from its hash: `stream` 1 is the clock of motion, 2 the
 * switch of streaks, 3 to 5 the jitter along x, y and z.
 */
inline std::uint32_t HashStream(std::uint32_t hash, std::uint32_t stream)
{
  return HashJoinAxes(hash + stream * HashSeed);
}

/// The bits as a number in [0, 1), in steps of 2^-24, exactly as float and double hold it.
inline double HashToUnit(std::uint32_t hash)
{
  return static_cast<double>(hash >> 8) * (1.0 / 16777216.0);
}
} // namespace steerable

#endif
