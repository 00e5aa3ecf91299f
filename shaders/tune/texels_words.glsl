// SPDX-License-Identifier: MIT
// Texels as words of image buffers, the fastest reads of llvmpipe: 8 bits a channel in a word, 16 in two.
// texel_words.glsl is written by src/shader/assemble.cpp: readTexelWord(buffer, index), and srgbValue(value), the
// linear light of a value of 8 bits in sRGB, by a table with one more.

#include "texel_words.glsl"

/// The linear light of 16 bits in sRGB, between the values of 8 bits: within 6e-6, and exact where the curve is a line.
float srgbValue16(uint value) {
  uint place = value / 257u;
  return mix(srgbValue(place), srgbValue(place + 1u), float(value - place * 257u) * float(1.0 / 257.0));
}

/// The linear colour and alpha of a texel of a slot's picture.
vec4 readTexel(uvec4 slot, ivec2 place, bool srgb) {
  uint unit = slot.z >> kTexturePlaceShift;
  int texel = place.y * int(slot.y & 0xffffu) + place.x;
  if (kWideTextures && (slot.z & kTextureWide) != 0u) {
    uint low = readTexelWord(unit, int(slot.x) + 2 * texel);
    uint high = readTexelWord(unit, int(slot.x) + 2 * texel + 1);
    vec4 value = vec4(unpackUnorm2x16(low), unpackUnorm2x16(high));
    if (!srgb) return value;
    return vec4(srgbValue16(low & 0xffffu), srgbValue16(low >> 16), srgbValue16(high & 0xffffu), value.w);
  }
  uint word = readTexelWord(unit, int(slot.x) + texel);
  vec4 value = unpackUnorm4x8(word);
  if (!srgb) return value;
  return vec4(srgbValue(word & 255u), srgbValue((word >> 8) & 255u), srgbValue((word >> 16) & 255u), value.w);
}
