// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * How the noise of the filters looks when it is shown first (private, of the client): grey from -2 to 2, where most
 * values of unit variance lie, and as a surface where ParaView would show an outline.
 */
#ifndef NoiseFirstLook_h
#define NoiseFirstLook_h

#include "SteerableNoiseRepresentationsModule.h" // For export macro

/// Called when the plugin is loaded.
STEERABLENOISEREPRESENTATIONS_EXPORT void SteerableNoiseSetFirstLook();

#endif
