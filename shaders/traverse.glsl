// SPDX-License-Identifier: MIT
// Finding what a ray hits. A traversal is a value that can stop at a step limit and go on in a later draw.

/// Where a traversal stands: done when node is kTraversalDone.
struct Traversal {
  int node;   // next inner node, complement of a leaf, or kTraversalDone; iterative: next block of leaves
  float t;    // nearest hit so far, else the ray's limit
  int slot;   // its leaf slot (leaf * 2 + side), or -1
  vec2 weights;  // barycentric, of its second and third vertex (kWeights)
  int steps;  // loop iterations so far in this draw
  int visits; // nodes and leaves visited, counted for the heat map only
  Stack stack;
};

/// The quantisation grid of the tree's boxes and the number of leaves.
struct TreeFrame {
  vec3 origin;
  vec3 cell;
  int leafCount;
};

Traversal startTraversal(float limit, int leafCount) {
  Traversal s;
  s.node = leafCount == 0 ? kTraversalDone : 0;
  s.t = limit;
  s.slot = -1;
  s.weights = vec2(0.0f);
  s.steps = 0;
  s.visits = 0;
  s.stack = emptyStack();
  return s;
}

/// A direction component that is safe to divide by: |d| is at least 2^-60, far below what 24 bits of it can show.
float awayFromZero(float d) {
  return abs(d) < 8.6736173798840355e-19f ? (d < 0.0f ? -8.6736173798840355e-19f : 8.6736173798840355e-19f) : d;
}

/// A hit on one primitive of a leaf; t is -1 for a miss.
struct PrimitiveHit {
  float t;
  vec2 weights;
};

PrimitiveHit intersectWord(vec3 origin, vec3 direction, RayShear shear, vec3 v0, vec3 v1, vec3 v2, uint word) {
  PrimitiveHit r;
  r.t = -1.0f;
  r.weights = vec2(0.0f);
  if (kTriangles) {
    TriangleHit h;
    if (kWatertight) h = intersectTriangle(origin, shear, v0, v1, v2);
    if (!kWatertight) h = intersectTriangleFast(origin, direction, v0, v1, v2);
    bool there = !kCulling || h.front || (word & kPrimitiveCull) == 0u;
    r.t = h.hit && there ? h.t : -1.0f;
    if (kWeights) r.weights = vec2(h.weight1, h.weight2);
  }
  if (kSpheres) {
    float s = intersectSphere(origin, direction, v0, v1.x, !kCulling || (word & kPrimitiveCull) == 0u);
    bool isSphere = (word & kPrimitiveSphere) != 0u && word != kPrimitiveNone;
    r.t = isSphere ? s : (kTriangles ? r.t : -1.0f);
  }
  return r;
}

/// The nearest of what the traversal has and the two primitives of a leaf.
Traversal intersectLeaf(Traversal s, int leaf, vec3 origin, vec3 direction, RayShear shear) {
  LeafPair l = loadLeaf(leaf);
  PrimitiveHit a = intersectWord(origin, direction, shear, l.v0a, l.v1a, l.v2a, l.worda);
  PrimitiveHit b = intersectWord(origin, direction, shear, l.v0b, l.v1b, l.v2b, l.wordb);
  bool hita = a.t > 0.0f && a.t < s.t;
  s.t = hita ? a.t : s.t;
  s.slot = hita ? 2 * leaf : s.slot;
  if (kWeights) s.weights = hita ? a.weights : s.weights;
  bool hitb = b.t > 0.0f && b.t < s.t;
  s.t = hitb ? b.t : s.t;
  s.slot = hitb ? 2 * leaf + 1 : s.slot;
  if (kWeights) s.weights = hitb ? b.weights : s.weights;
  return s;
}

/// One plain loop over all leaves, kLeafBlock of them an iteration (the last block is padded).
Traversal traverseIterative(vec3 origin, vec3 direction, Traversal s, TreeFrame tree, int stepLimit, bool anyHit) {
  RayShear shear = makeShear(direction);
  while (s.node != kTraversalDone && s.steps < stepLimit) {
    for (int i = 0; i < int(kLeafBlock); ++i) {
      s = intersectLeaf(s, s.node + i, origin, direction, shear);
    }
    s.steps += 1;
    if (kHeatmap) s.visits += int(kLeafBlock);
    s.node += int(kLeafBlock);
    if (s.node >= tree.leafCount || (anyHit && s.slot >= 0)) s.node = kTraversalDone;
  }
  return s;
}

/// While-while traversal of the tree (Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs, 2009).
/// kFrontToBack: the nearer child first, boxes behind the hit are discarded; else children in fixed order, and
/// only the ray's own limit discards. The near limit is 0. Boxes are padded when packed, so that rounding in the
/// slab test cannot lose one that holds a hit (docs/accuracy.md).
Traversal traverseTree(vec3 origin, vec3 direction, float rayLimit, Traversal s, TreeFrame tree, int stepLimit,
                       bool anyHit) {
  RayShear shear = makeShear(direction);
  vec3 inverse = vec3(1.0f) / vec3(awayFromZero(direction.x), awayFromZero(direction.y), awayFromZero(direction.z));
  vec3 scale = tree.cell * inverse;
  vec3 bias = (tree.origin - origin) * inverse;
  while (s.node != kTraversalDone && s.steps < stepLimit) {
    // Both conditions in one sign bit: at an inner node, and below the limit.
    while ((s.node | (stepLimit - 1 - s.steps)) >= 0) {
      NodePair n = loadNode(s.node);
      float limit = kFrontToBack ? s.t : rayLimit;
      vec3 a0 = n.low0 * scale + bias;
      vec3 b0 = n.high0 * scale + bias;
      vec3 a1 = n.low1 * scale + bias;
      vec3 b1 = n.high1 * scale + bias;
      float near0 = slabMax(slabMax(slabMin(a0.x, b0.x), slabMin(a0.y, b0.y)), slabMax(slabMin(a0.z, b0.z), 0.0f));
      float far0 = slabMin(slabMin(slabMax(a0.x, b0.x), slabMax(a0.y, b0.y)), slabMin(slabMax(a0.z, b0.z), limit));
      float near1 = slabMax(slabMax(slabMin(a1.x, b1.x), slabMin(a1.y, b1.y)), slabMax(slabMin(a1.z, b1.z), 0.0f));
      float far1 = slabMin(slabMin(slabMax(a1.x, b1.x), slabMax(a1.y, b1.y)), slabMin(slabMax(a1.z, b1.z), limit));
      bool hit0 = near0 <= far0;
      bool hit1 = near1 <= far1;
      bool swap = kFrontToBack && near1 < near0;
      bool both = hit0 && hit1;
      bool first1 = both ? swap : hit1;
      int pushed = first1 ? n.child0 : n.child1;
      int popped = s.stack.s0;
      bool none = !hit0 && !hit1;
      s.node = none ? popped : (first1 ? n.child1 : n.child0);
      s.stack = stepStack(s.stack, both, none, pushed);
      s.steps += 1;
      if (kHeatmap) s.visits += 1;
    }
    bool atLeaf = s.node < 0 && s.node != kTraversalDone;
    if (atLeaf) {
      s = intersectLeaf(s, ~s.node, origin, direction, shear);
      s.steps += 1;
      if (kHeatmap) s.visits += 1;
      s.node = anyHit && s.slot >= 0 ? kTraversalDone : s.stack.s0;
      s.stack = stepStack(s.stack, false, true, 0);
    }
  }
  return s;
}

#include "literals.glsl"

/// Goes on with a traversal of the ray until it is done or has taken stepLimit steps. direction is unit length.
Traversal traverse(vec3 origin, vec3 direction, float rayLimit, Traversal s, TreeFrame tree, int stepLimit,
                   bool anyHit) {
  if (kLiterals) return traverseLiterals(origin, direction, s, anyHit);
  if (kLargeFirst) {
    s = traverseLiterals(origin, direction, s, anyHit);
    if (anyHit && s.slot >= 0) s.node = kTraversalDone;
  }
  if (kIterative) return traverseIterative(origin, direction, s, tree, stepLimit, anyHit);
  return traverseTree(origin, direction, rayLimit, s, tree, stepLimit, anyHit);
}
