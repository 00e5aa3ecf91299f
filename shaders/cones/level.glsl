// SPDX-License-Identifier: MIT
// The level of a picture that a ray cone asks for. Variants without cones do not have this file.

/// The areas that the cone of the ray covers at the surface, in both sets of texture coordinates; 0 asks for level 0.
vec2 coveredAreas = vec2(0.0);

/// The slot row of the level whose texels are about as large as the covered area.
uvec4 slotOfLevel(uvec4 slot) {
  float area = (slot.z & kTextureTexcoord1) != 0u ? coveredAreas.y : coveredAreas.x;
  if (kTextureTransforms && slot.w != 0u) {
    vec2 u = uintBitsToFloat(readMaterials(int(slot.w))).xy;
    vec2 v = uintBitsToFloat(readMaterials(int(slot.w) + 1)).xy;
    area *= abs(u.x * v.y - u.y * v.x);
  }
  uint width = slot.y & 0xffffu;
  uint height = slot.y >> 16;
  // The whole part of the logarithm of a side is that of the area's, which is an exponent, halved.
  int level = (int(floatBitsToUint(area * float(width) * float(height)) >> 23) - 127) >> 1;
  return slotAtLevel(slot, clamp(level, 0, findMSB(min(width, height))));
}
