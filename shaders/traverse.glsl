// SPDX-License-Identifier: MIT
// Finding what a ray hits, by walking the tree (docs/design/traversal.md). What a step finds of a node's children are
// two groups (layout.glsl): the leaves are met before any other node, the inner nodes join those that still wait.

#include "literals.glsl"
#include "tree/meet.glsl"

/// One step from an inner node: to the nearest child that is hit, else to the next one of the group, else to what the
/// stack holds. `there` false: nothing changes. kFrontToBack: boxes behind the hit are discarded; else children in
/// fixed order, and only the ray's own limit discards. Boxes are padded, so that rounding in the slab test cannot lose
/// one that holds a hit (docs/design/numerics.md).
Traversal stepNode(Traversal s, TreeRay ray, float rayLimit, TreeFrame tree, bool there) {
  countNodeSteps(uint(there));
  countBoxesTested(4u * uint(there));
  int node = there ? s.node : 0;
  WideNode n = kMoving ? loadMovingNode(node, ray.inverse, s.part) : loadNode(node, ray.inverse);
  float limit = kFrontToBack ? s.t : rayLimit;
  // A surface must not end the ray before others at its distance.
  if (kPassing || kCoincident) limit += roundingOf(limit, tree);
  if (kInstances) limit -= ray.start;
  // Step: where the ray enters and leaves the children's boxes.
  vec3 scale = n.cell * ray.inverse;
  vec3 bias = (n.origin - ray.origin) * ray.inverse;
  vec3 padding = abs(scale) * vec3(kBoxPadding);
  vec3 from = bias - padding;
  vec3 to = bias + padding;
  vec4 near = slabMax(slabMax(n.nearX * scale.x + from.x, n.nearY * scale.y + from.y),
                      slabMax(n.nearZ * scale.z + from.z, vec4(ray.from)));
  vec4 far = slabMin(slabMin(n.farX * scale.x + to.x, n.farY * scale.y + to.y),
                     slabMin(n.farZ * scale.z + to.z, vec4(limit)));
  bvec4 hit = slabHits(near, far);
  uvec4 bits = mix(uvec4(0u), uvec4(kFirstChild, kFirstChild << 1, kFirstChild << 2, kFirstChild << 3), hit);
  uint hits = bits.x | bits.y | bits.z | bits.w | kBaseMask;
  uint inner = n.inner & hits;
  // Step: the nearest inner child. Its number replaces the last two bits of its distance.
  ivec4 order = slabOrder(near);
  int first = mix(0x7fffffff, order.x & -4, (inner & kFirstChild) != 0u);
  first = mix(first, min(first, (order.y & -4) | 1), (inner & kFirstChild << 1) != 0u);
  first = mix(first, min(first, (order.z & -4) | 2), (inner & kFirstChild << 2) != 0u);
  first = mix(first, min(first, (order.w & -4) | 3), (inner & kFirstChild << 3) != 0u);
  // Step: the next node. A group that waits goes onto the stack, or comes from it.
  bool found = inner >= kFirstChild;
  bool left = s.group >= kFirstChild;
  uint group = found ? inner : (left ? s.group : topOf(s.stack));
  s.stack = stepStack(s.stack, there && found && left, there && !found && !left, s.group);
  int child = mix(firstOf(group), first & 3, found && kFrontToBack);
  s.node = mix(s.node, baseOf(group) + child, there);
  s.group = mix(s.group, group ^ kFirstChild << child, there);
  s.leaves = mix(s.leaves, n.leaves & hits, there);
  return s;
}

/// The leaf that comes next.
int leafOf(Traversal s) { return int((s.leaves + uint(firstOf(s.leaves))) & kBaseMask); }

/// The primitives of the leaf that comes next.
Traversal meetLeaf(Traversal s, TreeRay ray, vec3 origin, vec3 direction, bool anyHit) {
  s = meetPrimitives(s, leafOf(s), ray, origin, direction, anyHit);
  s.leaves ^= kFirstChild << firstOf(s.leaves);
  if (anyHit && isStopped(s)) s = ended(s);
  return s;
}

/// Returns true if the next step leads into an instance, or out of one.
bool changesSpace(Traversal s) {
  return s.leaves >= kFirstChild ? leafOf(s) >= kInstanceLeaf : s.node == kInstanceEnd;
}

/// Goes from an instance of the upper tree to the root of its mesh's tree, or at kInstanceEnd back to the upper tree.
Traversal changeSpace(Traversal s) {
  bool ends = s.leaves < kFirstChild;
  s.instance = ends ? -1 : leafOf(s) - kInstanceLeaf;
  // The node that would come next is in its group again until the way back.
  uint kept = s.group | kFirstChild << (s.node - baseOf(s.group));
  uint group = topOf(s.stack);
  int child = firstOf(group);
  s.stack = stepStack(s.stack, !ends, ends, kept);
  s.node = ends ? baseOf(group) + child : int(readNodes(int(kInstanceRows) * s.instance + 3).x);
  s.group = ends ? group ^ kFirstChild << child : kInstanceEndGroup;
  s.leaves = 0u;
  s.steps += 1;
  return s;
}

/// The next step is one from an inner node, and is below the limit: all in one sign bit.
bool isWalking(Traversal s, int stepLimit) {
  return (s.node | int(kBaseMask - s.leaves) | (stepLimit - 1 - s.steps)) >= 0;
}

/// Counts a step, and the nodes and leaves that it has visited.
Traversal counted(Traversal s, int visits) {
  s.steps += 1;
  if (kCountVisits) s.visits += visits;
  return s;
}

/// While-while traversal of the tree (Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs, 2009).
Traversal traverseTree(vec3 origin, vec3 direction, float rayLimit, Traversal s, TreeFrame tree, int stepLimit,
                       bool anyHit) {
  TreeRay ray = treeRayOf(s, origin, direction, tree);
  while (!isDone(s) && s.steps < stepLimit) {
    // The loop asks at its end, since llvmpipe runs the body of a loop once more, without a lane, for a condition at
    // its head.
    bool walks = isWalking(s, stepLimit);
    do {
      if (walks) s = counted(stepNode(s, ray, rayLimit, tree, true), 1);
      walks = isWalking(s, stepLimit);
    } while (walks);
    if (kInstances && changesSpace(s)) {
      s = changeSpace(s);
      ray = treeRayOf(s, origin, direction, tree);
    } else if (s.leaves >= kFirstChild) {
      s = counted(meetLeaf(s, ray, origin, direction, anyHit), 1);
    }
  }
  return s;
}

/// One plain loop over all leaves, kLeafBlock of them an iteration (the last block is padded).
Traversal traverseIterative(vec3 origin, vec3 direction, Traversal s, TreeFrame tree, int stepLimit, bool anyHit) {
  TreeRay ray = makeTreeRay(origin, direction, 0.0f);
  while (s.node != kTraversalDone && s.steps < stepLimit) {
    for (int i = 0; i < int(kLeafBlock); ++i) {
      s = meetPrimitives(s, s.node + i, ray, origin, direction, anyHit);
    }
    s = counted(s, int(kLeafBlock));
    s.node += int(kLeafBlock);
    if (s.node >= tree.leafCount || (anyHit && isStopped(s))) s.node = kTraversalDone;
  }
  return s;
}

/// Meets the triangles that the tree does not hold.
Traversal meetLargeFirst(vec3 origin, vec3 direction, Traversal s, bool anyHit) {
  s = traverseLiterals(origin, direction, s, anyHit);
  if (kPassing && anyHit && s.slot >= 0 && (wordOf(s.slot) & kPrimitivePasses) == 0u) s.slot = kOpaqueSlot;
  if (anyHit && isStopped(s)) s = ended(s);
  return s;
}

/// Continues a traversal of the ray until it is done or has taken stepLimit steps. direction is unit length.
Traversal traverse(vec3 origin, vec3 direction, float rayLimit, Traversal s, TreeFrame tree, int stepLimit,
                   bool anyHit) {
  if (kLiterals) return meetPrimitives(s, 0, makeTreeRay(origin, direction, 0.0f), origin, direction, anyHit);
  if (kLargeFirst) s = meetLargeFirst(origin, direction, s, anyHit);
  if (kIterative) return traverseIterative(origin, direction, s, tree, stepLimit, anyHit);
  return traverseTree(origin, direction, rayLimit, s, tree, stepLimit, anyHit);
}
