// SPDX-License-Identifier: MIT
// The plain tracer that `bench traversal --plain` compares with: a binary tree of boxes in floats, the nearer child
// first, a stack in an array, and Moeller and Trumbore's test (Fast, Minimum Storage Ray-Triangle Intersection, 1997).
// It reads the rays and writes the hits of rays.glsl. tests/instruments/rays/plain_scene.cpp packs its tree:
//
//     node   4 rows   low corner, high corner of child 0; the same of child 1; w of the low ones names the child
//     leaf   6 rows   two triangles of three corners; w of the first: 0 for none, 1 for two sides, 2 for the front

#include "layout.glsl"
layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frame; };
#include "read.glsl"

layout(std430, binding = kPathStatesBinding) readonly restrict buffer RaysBlock { vec4 rays[]; };
layout(std430, binding = kProgressBinding) writeonly restrict buffer RayHitsBlock { uvec2 rayHits[]; };

/// Where a ray enters a box, or `limit` where it does not.
float plainEntry(vec3 low, vec3 high, vec3 origin, vec3 inverse, float limit) {
  vec3 a = (low - origin) * inverse;
  vec3 b = (high - origin) * inverse;
  vec3 near = min(a, b);
  vec3 far = max(a, b);
  float from = max(max(near.x, near.y), max(near.z, 0.0));
  float to = min(min(far.x, far.y), far.z) * 1.000001;  // more than rounding (Ize, Robust BVH Ray Traversal, 2013)
  return from <= to ? from : limit;
}

/// The distance of a triangle, or `limit`.
float plainDistance(int row, vec3 origin, vec3 direction, float limit) {
  vec4 first = uintBitsToFloat(readLeaves(row));
  vec3 u = uintBitsToFloat(readLeaves(row + 1)).xyz - first.xyz;
  vec3 v = uintBitsToFloat(readLeaves(row + 2)).xyz - first.xyz;
  vec3 p = cross(direction, v);
  float determinant = dot(u, p);
  vec3 s = (origin - first.xyz) / determinant;
  vec3 q = cross(s, u);
  float a = dot(s, p);
  float b = dot(direction, q);
  float t = dot(v, q);
  bool there = first.w == 1.0 || (first.w == 2.0 && determinant > 0.0);
  return there && a >= 0.0 && b >= 0.0 && a + b <= 1.0 && t > 0.0 && t < limit ? t : limit;
}

void tracePlain(ivec2 lane, bool anyHit) {
  const uint leafFlag = 0x80000000u;
  const uint end = 0xffffffffu;
  int index = lane.y * frame.pictureSize.x + lane.x;
  vec4 ray = rays[2 * index];
  vec3 direction = rays[2 * index + 1].xyz;
  vec3 inverse = 1.0 / mix(direction, vec3(1e-18), lessThan(abs(direction), vec3(1e-18)));
  float t = ray.w;
  uint slot = end;
  uint stack[32];  // kMaxBvhDepth
  int count = 0;
  uint node = t > 0.0 ? 0u : end;
  while (node != end) {
    uint next = end;
    if (node >= leafFlag) {
      uint leaf = node & ~leafFlag;
      for (uint side = 0u; side < 2u; ++side) {
        float found = plainDistance(int(6u * leaf + 3u * side), ray.xyz, direction, t);
        slot = found < t ? 2u * leaf + side : slot;
        t = found;
      }
    } else {
      int row = 4 * int(node);
      uvec4 first = readNodes(row);
      uvec4 second = readNodes(row + 2);
      vec3 high = uintBitsToFloat(readNodes(row + 1).xyz);
      float a = plainEntry(uintBitsToFloat(first.xyz), high, ray.xyz, inverse, t);
      high = uintBitsToFloat(readNodes(row + 3).xyz);
      float b = plainEntry(uintBitsToFloat(second.xyz), high, ray.xyz, inverse, t);
      next = a < t && (a <= b || b >= t) ? first.w : b < t ? second.w : end;
      if (a < t && b < t) stack[count++] = a <= b ? second.w : first.w;
    }
    if (next == end && count > 0) next = stack[--count];
    node = anyHit && slot != end ? end : next;
  }
  rayHits[index] = uvec2(slot, floatBitsToUint(t));
}
