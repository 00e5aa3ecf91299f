// SPDX-License-Identifier: MIT
// Noise before a display value is rounded to 8 bits, so that a gradient shows no bands. Also read by
// src/image/display/tone_map.cpp.
#include "mix_bits.glsl"

/// Triangular noise between -1 and 1 of a pixel's channel: the error of rounding then has the mean 0 and the same
/// variance for all values (Lipshitz, Wannamaker and Vanderkooy, Quantization and Dither, 1992).
float ditherNoise(uint x, uint y, uint channel) {
  uint bits = mixBits(x + mixBits(y + mixBits(channel)));
  return (float(bits & 0xffffu) + float(bits >> 16) + 1.0f) * 1.52587890625e-5f - 1.0f;
}

/// A value in 0..1 with the noise. One that 8 bits hold keeps its value, so that even areas stay even.
float dithered(float value, uint x, uint y, uint channel) {
  float level = value * 255.0f;
  bool isHeld = abs(level - floor(level + 0.5f)) < 1e-3f;
  return isHeld ? value : value + ditherNoise(x, y, channel) * (1.0f / 255.0f);
}
