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

/// The slot row of a level of its picture. Levels lie one behind the other, each with room for as many texels as fit
/// its size without rounding (texelsBefore() of src/pack/textures/texture_plan.cpp).
uvec4 slotAtLevel(uvec4 slot, int level) {
  uint width = slot.y & 0xffffu;
  uint height = slot.y >> 16;
  uint texels = width * height;
  uint smaller = texels - (texels >> (2 * max(level - 1, 0)));
  uint before = level > 0 ? texels + (11u * smaller >> 5) : 0u;
  slot.x += kWideTextures && (slot.z & kTextureWide) != 0u ? 2u * before : before;
  slot.y = width >> level | height >> level << 16;
  return slot;
}

/// The linear colour and alpha of a texel of a slot's picture.
vec4 readTexel(uvec4 slot, ivec2 place, bool srgb) {
  uint unit = slot.z >> kTexturePlaceShift;
  int texel = place.y * int(slot.y & 0xffffu) + place.x;
  bool wide = kWideTextures && (slot.z & kTextureWide) != 0u;
  uint word = readTexelWord(unit, int(slot.x) + (wide ? 2 * texel : texel));
  vec4 value = unpackUnorm4x8(word);
  if (srgb) value.rgb = vec3(srgbValue(word & 255u), srgbValue((word >> 8) & 255u), srgbValue((word >> 16) & 255u));
  if (kWideTextures && wide) {
    uint high = readTexelWord(unit, int(slot.x) + 2 * texel + 1);
    value = vec4(unpackUnorm2x16(word), unpackUnorm2x16(high));
    if (srgb) value.rgb = vec3(srgbValue16(word & 0xffffu), srgbValue16(word >> 16), srgbValue16(high & 0xffffu));
  }
  return value;
}
