// SPDX-License-Identifier: MIT
// Textures of any size and number, with their texels as they are in the files. This file filters them by the
// magnification filter, at level 0 or at that of a ray cone.

#include "texels.glsl"
#include "cones/level.glsl"

/// Brings a texel coordinate from -1 to twice the size into 0..size-1 by repeating, clamping or mirroring. It does not
/// divide, because llvmpipe divides integers lane by lane.
int wrapTexel(int x, int size, bool clamped, bool mirrored) {
  int period = mirrored ? 2 * size : size;
  int m = x < 0 ? x + period : x;
  m = m >= period ? m - period : m;
  m = m >= period ? m - period : m;
  m = m >= size ? period - 1 - m : m;
  return clamped ? clamp(x, 0, size - 1) : m;
}

/// Samples the texture of a slot row (layout.glsl), whose colours are encoded by sRGB or linear. A slot without a
/// texture gives white.
vec4 sampleTexture(uvec4 slot, vec4 texcoords, bool srgb) {
  uint flags = slot.z;
  if ((flags & kTexturePresent) == 0u) return vec4(1.0);
  vec2 uv = (flags & kTextureTexcoord1) != 0u ? texcoords.zw : texcoords.xy;
  if (kTextureTransforms && slot.w != 0u) {
    vec3 place = vec3(clamp(uv, -1e30, 1e30), 1.0);
    int row = int(slot.w);
    uv = vec2(dot(uintBitsToFloat(readMaterials(row)).xyz, place),
              dot(uintBitsToFloat(readMaterials(row + 1)).xyz, place));
  }
  if (kRayCones) slot = slotOfLevel(slot);
  ivec2 size = ivec2(slot.y & 0xffffu, slot.y >> 16);
  bool linear = (flags & kTextureLinear) != 0u;
  bool clampU = (flags & kTextureClampU) != 0u;
  bool clampV = (flags & kTextureClampV) != 0u;
  bool mirrorU = (flags & kTextureMirrorU) != 0u;
  bool mirrorV = (flags & kTextureMirrorV) != 0u;
  // Whole periods are subtracted first, so that far coordinates keep their digits and fit an int.
  uv.x = clampU ? clamp(uv.x, -1.0, 2.0) : uv.x - 2.0 * floor(0.5 * uv.x);
  uv.y = clampV ? clamp(uv.y, -1.0, 2.0) : uv.y - 2.0 * floor(0.5 * uv.y);
  vec2 position = uv * vec2(size) - (linear ? 0.5 : 0.0);
  vec2 base = floor(position);
  vec2 f = linear ? position - base : vec2(0.0);
  int x0 = wrapTexel(int(base.x), size.x, clampU, mirrorU);
  int x1 = linear ? wrapTexel(int(base.x) + 1, size.x, clampU, mirrorU) : x0;
  int y0 = wrapTexel(int(base.y), size.y, clampV, mirrorV);
  int y1 = linear ? wrapTexel(int(base.y) + 1, size.y, clampV, mirrorV) : y0;
  vec4 top = mix(readTexel(slot, ivec2(x0, y0), srgb), readTexel(slot, ivec2(x1, y0), srgb), f.x);
  vec4 bottom = mix(readTexel(slot, ivec2(x0, y1), srgb), readTexel(slot, ivec2(x1, y1), srgb), f.x);
  return mix(top, bottom, f.y);
}
