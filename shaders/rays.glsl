// SPDX-License-Identifier: MIT
// Traversal alone: one ray per pixel, or lane, comes from a buffer, and its hit goes into another.
#include "layout.glsl"
layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frame; };
#include "work/count.glsl"
#include "read.glsl"
#include "random.glsl"
#include "intersect.glsl"
#include "slab.glsl"
#include "stack.glsl"
#include "tree.glsl"
#include "tree/state.glsl"
#include "tree/ray.glsl"
#include "tree/leaf.glsl"
#include "traverse.glsl"

bool letsPass(Traversal hit, vec3 origin, vec3 direction) { return false; }

// These buffers use bindings that the tracer uses for others.
// Rays are origin, limit; direction. Hits are slot, t.
layout(std430, binding = kPathStatesBinding) readonly restrict buffer RaysBlock { vec4 rays[]; };
layout(std430, binding = kProgressBinding) writeonly restrict buffer RayHitsBlock { uvec2 rayHits[]; };

void traceRay(ivec2 pixel, bool anyHit) {
  int index = pixel.y * frame.pictureSize.x + pixel.x;
  vec4 a = rays[2 * index];
  vec3 direction = rays[2 * index + 1].xyz;
  TreeFrame tree = TreeFrame(frame.treeRounding, frame.leafCount);
  Traversal s = startTraversal(a.w, a.w > 0.0f ? tree.leafCount : 0);
  s = traverse(a.xyz, direction, a.w, s, tree, frame.stepBudget, anyHit);
  const uint unfinished = 0xfffffffeu;  // the step limit ended the ray
  rayHits[index] = uvec2(isDone(s) ? uint(s.slot) : unfinished, floatBitsToUint(s.t));
}
