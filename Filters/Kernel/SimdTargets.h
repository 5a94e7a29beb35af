// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * SIMD levels that Highway leaves out, before any of its headers: those that cannot hold registers in
 * arrays (scalable vectors), and near-copies of others.
 */
#ifndef SimdTargets_h
#define SimdTargets_h

#define HWY_DISABLED_TARGETS \
  (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3 | HWY_AVX3_DL)

#endif
