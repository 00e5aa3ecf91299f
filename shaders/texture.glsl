// SPDX-License-Identifier: MIT
// Textures of any size and number, with their texels as they are in the files. This file filters them by the
// magnification filter, at level 0 or at that of a ray cone.

#include "texels.glsl"
#include "cones/level.glsl"

/// Brings a texel's place from -1 to twice the size into 0..size-1 by repeating, clamping or mirroring. It does not
/// divide, because llvmpipe divides integers lane by lane.
ivec2 wrapTexel(ivec2 place, ivec2 size, bvec2 clamped, bvec2 mirrored) {
  ivec2 period = mix(size, 2 * size, mirrored);
  ivec2 m = mix(place, place + period, lessThan(place, ivec2(0)));
  m = mix(m, m - period, greaterThanEqual(m, period));
  m = mix(m, m - period, greaterThanEqual(m, period));
  m = mix(m, period - 1 - m, greaterThanEqual(m, size));
  return mix(m, clamp(place, ivec2(0), size - 1), clamped);
}

/// Samples the texture of a slot row (layout.glsl), whose colours are encoded by sRGB or linear. A slot without a
/// texture gives white.
vec4 sampleTexture(uvec4 slot, vec4 texcoords, bool srgb) {
  uint flags = slot.z;
  if ((flags & kTexturePresent) == 0u) return vec4(1.0);
  vec2 uv = mix(texcoords.xy, texcoords.zw, bvec2((flags & kTextureTexcoord1) != 0u));
  if (kTextureTransforms && slot.w != 0u) {
    vec3 place = vec3(clamp(uv, -1e30, 1e30), 1.0);
    int row = int(slot.w);
    uv = vec2(dot(uintBitsToFloat(readMaterials(row)).xyz, place),
              dot(uintBitsToFloat(readMaterials(row + 1)).xyz, place));
  }
  if (kRayCones) slot = slotOfLevel(slot);
  ivec2 size = ivec2(slot.y & 0xffffu, slot.y >> 16);
  bool linear = (flags & kTextureLinear) != 0u;
  bvec2 clamped = notEqual(uvec2(flags) & uvec2(kTextureClampU, kTextureClampV), uvec2(0u));
  bvec2 mirrored = notEqual(uvec2(flags) & uvec2(kTextureMirrorU, kTextureMirrorV), uvec2(0u));
  // Whole periods are subtracted first, so that far coordinates keep their digits and fit an int.
  uv = mix(uv - 2.0 * floor(0.5 * uv), clamp(uv, -1.0, 2.0), clamped);
  vec2 position = uv * vec2(size) - mix(0.0, 0.5, linear);
  vec2 base = floor(position);
  vec2 f = mix(vec2(0.0), position - base, bvec2(linear));
  ivec2 low = wrapTexel(ivec2(base), size, clamped, mirrored);
  ivec2 high = mix(low, wrapTexel(ivec2(base) + 1, size, clamped, mirrored), bvec2(linear));
  vec4 top = mix(readTexel(slot, low, srgb), readTexel(slot, ivec2(high.x, low.y), srgb), f.x);
  vec4 bottom = mix(readTexel(slot, ivec2(low.x, high.y), srgb), readTexel(slot, high, srgb), f.x);
  return mix(top, bottom, f.y);
}
