// SPDX-License-Identifier: MIT
// Texels in layers of 2D array textures, many pictures a layer: GPUs have units that read them, and decode sRGB. The
// colours and the numbers of 8 bits are two views of one texture.

layout(binding = kTexelTextures) uniform sampler2DArray texelNumbers;
layout(binding = kTexelTextures + 1u) uniform sampler2DArray texelColors;
layout(binding = kTexelTextures + 2u) uniform sampler2DArray wideTexels;

/// IEC 61966-2-1
vec3 fromSrgb(vec3 value) {
  vec3 curve = pow((value + 0.055) * (1.0 / 1.055), vec3(2.4));
  return mix(curve, value * (1.0 / 12.92), lessThanEqual(value, vec3(0.04045)));
}

/// The slot row of a level of its picture. A layer has its pictures in each level of the texture, in the same places.
uvec4 slotAtLevel(uvec4 slot, int level) {
  slot.x = (slot.x & 0xffffu) >> level | slot.x >> 16 >> level << 16;
  slot.y = (slot.y & 0xffffu) >> level | slot.y >> 16 >> level << 16;
  slot.z |= uint(level) << kTextureLevelShift;
  return slot;
}

/// The linear colour and alpha of a texel of a slot's picture.
vec4 readTexel(uvec4 slot, ivec2 place, bool srgb) {
  ivec3 at = ivec3(int(slot.x & 0xffffu) + place.x, int(slot.x >> 16) + place.y, int(slot.z >> kTexturePlaceShift));
  vec4 value = vec4(0.0);
  int level = 0;
  if (kRayCones) level = int(slot.z >> kTextureLevelShift & 15u);
  if (kWideTextures && (slot.z & kTextureWide) != 0u) {
    value = texelFetch(wideTexels, at, level);
    if (srgb) value.rgb = fromSrgb(value.rgb);
  } else if (srgb) {
    value = texelFetch(texelColors, at, level);
  } else {
    value = texelFetch(texelNumbers, at, level);
  }
  return value;
}
