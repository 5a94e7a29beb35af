// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// From the noise of a fragment to its colour. Colours are those of the surface before lighting, so that light,
// specular highlights and edges stay what they are; the colour map stays readable under Lightness.

uniform float noiseIntensity;
uniform float noiseContrast;
uniform vec4 noiseMaskColor;       // of what shows no noise; alpha 0: the surface's own
uniform vec2 noiseWhite;           // ambient and diffuse light of a white surface

/// Noise of unit variance as a grey value in [0, 1]; `middle` is that of 0.
float GreyOf(float noise, float middle)
{
#ifdef NOISE_STREAKS
  return clamp(0.2 + 0.3 * noiseContrast * noise, 0.0, 1.0);
#else
  return clamp(middle + 0.3 * noiseContrast * noise, 0.0, 1.0);
#endif
}

/// Moves the lightness of a colour, hue and saturation stay: in Oklab (Ottosson 2020), which is even to the eye.
vec3 WithLightness(vec3 color, float change)
{
  vec3 linear = pow(max(color, vec3(0.0)), vec3(2.2));
  vec3 lms = vec3(dot(linear, vec3(0.4122214708, 0.5363325363, 0.0514459929)),
    dot(linear, vec3(0.2119034982, 0.6806995451, 0.1073969566)),
    dot(linear, vec3(0.0883024619, 0.2817188376, 0.6299787005)));
  lms = pow(lms, vec3(1.0 / 3.0));
  float lightness = dot(lms, vec3(0.2104542553, 0.7936177850, -0.0040720468));
  float a = dot(lms, vec3(1.9779984951, -2.4285922050, 0.4505937099));
  float b = dot(lms, vec3(0.0259040371, 0.7827717662, -0.8086757660));
  float moved = clamp(lightness + change, 0.0, 1.0);
  // Darker colours have less room for saturation, as lighter ones do.
  float keep = lightness > 1e-4 ? min(1.0, moved / lightness) : 0.0;
  a *= keep;
  b *= keep;
  lms = vec3(moved + 0.3963377774 * a + 0.2158037573 * b,
    moved - 0.1055613458 * a - 0.0638541728 * b, moved - 0.0894841775 * a - 1.2914855480 * b);
  lms = lms * lms * lms;
  linear = vec3(dot(lms, vec3(4.0767416621, -3.3077115913, 0.2309699292)),
    dot(lms, vec3(-1.2684380046, 2.6097574011, -0.3413193965)),
    dot(lms, vec3(-0.0041960863, -0.7034186147, 1.7076147010)));
  return pow(clamp(linear, 0.0, 1.0), vec3(1.0 / 2.2));
}

/// `white`: what a white surface has in place of `color`, its share of ambient or diffuse light.
vec3 ColorOf(vec3 color, float noise, float white)
{
  if (NOISE_COLOR_MODE == 0) // Multiply
  {
    return color * (1.0 - noiseIntensity * (1.0 - GreyOf(noise, 0.75)));
  }
  if (NOISE_COLOR_MODE == 1) // Blend
  {
    return mix(color, vec3(white * GreyOf(noise, 0.5)), noiseIntensity);
  }
  if (NOISE_COLOR_MODE == 2 && white > 0.0) // Lightness
  {
    return white *
      WithLightness(color / white, 0.5 * noiseIntensity * (GreyOf(noise, 0.5) - 0.5));
  }
  return color; // Opacity
}

float OpacityOf(float opacity, float noise)
{
  return NOISE_COLOR_MODE == 3 ? opacity * (1.0 - noiseIntensity * (1.0 - GreyOf(noise, 0.5)))
                             : opacity;
}

/// For programs that read noise back: 24 bits of (noise + 8) / 16, red the highest.
vec3 ValueOf(float noise)
{
  float value = clamp((noise + 8.0) / 16.0, 0.0, 1.0) * 16777215.0;
  float red = floor(value / 65536.0);
  float green = floor((value - red * 65536.0) / 256.0);
  return vec3(red, green, floor(value - red * 65536.0 - green * 256.0)) / 255.0;
}
