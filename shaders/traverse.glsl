// SPDX-License-Identifier: MIT
// Finding what a ray hits. A traversal is a value that can stop at a step limit and go on in a later draw.

/// The state of a traversal, which is done when node is kTraversalDone.
struct Traversal {
  int node;   // next inner node, complement of a leaf, or kTraversalDone; iterative: next block of leaves
  float t;    // nearest hit so far, else the ray's limit
  int slot;   // its leaf slot (leaf * 2 + side), or -1
  vec2 weights;  // barycentric, of its second and third vertex (kWeights)
  int instance;  // whose mesh is being walked, or -1; node and stack are of its tree then
  int hitInstance;  // instance that shows the slot, or -1
  int steps;  // loop iterations so far in this draw
  // kCreases: part of t by which hits on front faces count as nearer, those on back faces as farther; negative: the
  // other way
  float tie;
  bool extends;  // kCoincident: the ray is a path's own; shadow rays end before the lamp that they are aimed at
  bool both;  // kLightPaths: single-sided surfaces have their backs, too
  float part; // kMoving: of the segment in whose tree the traversal is, 0..1
  int visits; // nodes and leaves visited, counted for the heat map only
  float tMin;     // kPassing: only hits behind this distance count,
  int tMinSlot;   // and those at it in later slots: what the ray has passed through lies there
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
  s.instance = -1;
  s.hitInstance = -1;
  s.steps = 0;
  s.tie = 0.0f;
  s.extends = false;
  s.both = false;
  s.part = 0.0f;
  s.visits = 0;
  s.tMin = 0.0f;
  s.tMinSlot = 0x7fffffff;
  s.stack = emptyStack();
  return s;
}

/// A traversal that begins at a moment, in the tree of its segment.
Traversal beginAt(Traversal s, Moment m, int nodesOfSegment) {
  s.part = m.part;
  s.node = s.node == kTraversalDone ? s.node : m.segment * nodesOfSegment;
  return s;
}

/// Returns true if a hit at distance t is nearer than the traversal's. Where a ray passes through surfaces, all hits
/// along it have one order, by distance and slot, so that it meets each once, however close they lie.
bool isNearer(Traversal s, float t, int slot) {
  if (!kPassing) return t > 0.0f && t < s.t;
  return liesBehind(t, s.tMin, slot > s.tMinSlot) && (t < s.t || (t == s.t && slot < s.slot));
}

/// A direction component that is safe to divide by: |d| is at least 2^-60, far below what 24 bits of it can show.
float awayFromZero(float d) {
  return abs(d) < 8.6736173798840355e-19f ? (d < 0.0f ? -8.6736173798840355e-19f : 8.6736173798840355e-19f) : d;
}

/// A hit on one primitive of a leaf; t is not above 0 for a miss.
struct PrimitiveHit {
  float t;
  vec2 weights;
};

/// The distance of a hit, less what puts it before surfaces that coincide with it: lamps before all others, and fronts
/// before backs. The reach covers rounding of the triangles, and 2^-19 of the distance that of the ray.
float beforeCoincident(float t, bool front, uint word) {
  float reach = uintBitsToFloat((word & kPrimitiveReachMask) << 23);
  float rank = ((word & kPrimitiveEmits) != 0u ? 2.0f : 0.0f) + (front ? 1.0f : 0.0f);
  return reach > 0.0f ? max(t - rank * (reach + 1.9073486328125e-6f * t), 0.5f * t) : t;
}

PrimitiveHit intersectWord(Traversal s, vec3 origin, vec3 direction, RayShear shear, vec3 v0, vec3 v1, vec3 v2,
                           uint word, int slot) {
  if (kCountWork) countWork(kWorkPrimitives, uint(word != kPrimitiveNone));
  PrimitiveHit r;
  r.t = -1.0f;
  r.weights = vec2(0.0f);
  if (kTriangles) {
    TriangleHit h;
    if (kWatertight) h = intersectTriangle(origin, shear, v0, v1, v2);
    if (!kWatertight) h = intersectTriangleFast(origin, direction, v0, v1, v2);
    if (kSlivers && !kMoving && h.hit && (word & kPrimitiveSliver) != 0u) {
      int row = slot * int(kFaceRows);
      h.t = distanceToPlane(origin, direction, shear, v0, v1, v2, vec3(uintBitsToFloat(readFaces(row))),
                            uintBitsToFloat(readFaces(row + 1).x), h.t);
    }
    if (kSlivers && kMoving && h.hit && (word & kPrimitiveSliver) != 0u) {
      vec4 plane = planeThrough(v0, v1, v2);
      h.t = distanceToPlane(origin, direction, shear, v0, v1, v2, vec3(plane), plane.w, h.t);
    }
    bool there = !kCulling || h.front || (kLightPaths && s.both) || (word & kPrimitiveCull) == 0u;
    r.t = h.hit && there ? h.t : -1.0f;
    if (kCoincident && s.extends && r.t > 0.0f) r.t = beforeCoincident(r.t, h.front, word);
    if (kCreases) r.t -= r.t * (h.front ? s.tie : -s.tie);
    if (kWeights) r.weights = vec2(h.weight1, h.weight2);
  }
  if (kSpheres) {
    bool inside = !kCulling || (kLightPaths && s.both) || (word & kPrimitiveCull) == 0u;
    float tMin = kPassing ? s.tMin : 0.0f;
    float t = intersectSphere(origin, direction, v0, v1.x, inside, tMin, kPassing && slot > s.tMinSlot);
    bool isSphere = (word & kPrimitiveSphere) != 0u && word != kPrimitiveNone;
    r.t = isSphere ? t : (kTriangles ? r.t : -1.0f);
  }
  return r;
}

/// The nearest of what the traversal has and the two primitives of a leaf. The origin lies at distance `start` along
/// the ray (kInstances).
Traversal intersectLeaf(Traversal s, int leaf, vec3 origin, vec3 direction, RayShear shear, float start) {
  LeafPair l;
  if (kMoving) l = loadMovingLeaf(leaf, s.part);
  if (!kMoving) l = loadLeaf(leaf);
  PrimitiveHit a = intersectWord(s, origin, direction, shear, l.v0a, l.v1a, l.v2a, l.worda, 2 * leaf);
  PrimitiveHit b = intersectWord(s, origin, direction, shear, l.v0b, l.v1b, l.v2b, l.wordb, 2 * leaf + 1);
  if (kInstances) {
    a.t += a.t > 0.0f ? start : 0.0f;
    b.t += b.t > 0.0f ? start : 0.0f;
  }
  bool hita = isNearer(s, a.t, 2 * leaf);
  s.t = hita ? a.t : s.t;
  s.slot = hita ? 2 * leaf : s.slot;
  if (kWeights) s.weights = hita ? a.weights : s.weights;
  bool hitb = isNearer(s, b.t, 2 * leaf + 1);
  s.t = hitb ? b.t : s.t;
  s.slot = hitb ? 2 * leaf + 1 : s.slot;
  if (kWeights) s.weights = hitb ? b.weights : s.weights;
  if (kInstances) s.hitInstance = hita || hitb ? s.instance : s.hitInstance;
  return s;
}

/// One plain loop over all leaves, kLeafBlock of them an iteration (the last block is padded).
Traversal traverseIterative(vec3 origin, vec3 direction, Traversal s, TreeFrame tree, int stepLimit, bool anyHit) {
  RayShear shear = makeShear(direction);
  while (s.node != kTraversalDone && s.steps < stepLimit) {
    for (int i = 0; i < int(kLeafBlock); ++i) {
      s = intersectLeaf(s, s.node + i, origin, direction, shear, 0.0f);
    }
    s.steps += 1;
    if (kCountVisits) s.visits += int(kLeafBlock);
    s.node += int(kLeafBlock);
    if (s.node >= tree.leafCount || (anyHit && s.slot >= 0)) s.node = kTraversalDone;
  }
  return s;
}

/// A ray in the space of an instance's mesh, of which no part lies before its origin. direction is as long as makes
/// distances those of local space.
struct MeshRay {
  vec3 origin;
  vec3 direction;
  float start;  // distance along the ray at which the origin lies
};

/// The ray begins where it comes near the mesh, so that rounding from there on is of the mesh's size
/// (docs/design/numerics.md).
MeshRay rayInMesh(int instance, vec3 origin, vec3 direction) {
  InstanceSpace s = loadInstanceSpace(instance);
  vec3 from = origin - s.place;
  vec3 o = timesRows(s.row0, s.row1, s.row2, from);
  MeshRay r;
  r.direction = timesRows(s.row0, s.row1, s.row2, direction);
  float squared = dot(r.direction, r.direction);
  r.start = max(0.0f, -dot(o, r.direction) / squared - kMeshReach / sqrt(squared));
  r.origin = o + r.start * r.direction;
  return r;
}

/// A ray as the tree of one space sees it, with all that its tests share.
struct TreeRay {
  vec3 origin;
  vec3 direction;
  float start;  // the start of MeshRay
  float from;   // boxes that end before this distance hold nothing
  RayShear shear;
  vec3 scale;
  vec3 bias;
};

TreeRay makeTreeRay(vec3 origin, vec3 direction, float start, vec3 gridOrigin, vec3 gridCell) {
  TreeRay r;
  r.origin = origin;
  r.direction = direction;
  r.start = start;
  r.from = 0.0f;
  r.shear = makeShear(direction);
  vec3 inverse = vec3(1.0f) / vec3(awayFromZero(direction.x), awayFromZero(direction.y), awayFromZero(direction.z));
  r.scale = gridCell * inverse;
  r.bias = (gridOrigin - origin) * inverse;
  return r;
}

/// A bound on the rounding of distances along a ray, except for triangles seen edge-on: a hit may lie that far outside
/// its box. It is a 16,384th of the way and of the scene, which is 65,536 cells wide; large triangles need a 2^21st.
float roundingOf(float t, TreeFrame tree) {
  return 6.103515625e-5f * t + 4.0f * max(max(tree.cell.x, tree.cell.y), tree.cell.z);
}

/// Returns the ray in the space of the scene's own tree, or (s.instance >= 0) of an instance's mesh.
TreeRay treeRayOf(Traversal s, vec3 origin, vec3 direction, TreeFrame tree) {
  TreeRay r;
  if (kInstances && s.instance >= 0) {
    MeshRay m = rayInMesh(s.instance, origin, direction);
    int row = int(kInstanceRows) * s.instance;
    vec3 gridOrigin = vec3(uintBitsToFloat(readNodes(row + 3)));
    r = makeTreeRay(m.origin, m.direction, m.start, gridOrigin, vec3(uintBitsToFloat(readNodes(row + 4))));
  } else {
    r = makeTreeRay(origin, direction, 0.0f, tree.origin, tree.cell);
  }
  if (kPassing) r.from = max(0.0f, s.tMin - roundingOf(s.tMin, tree) - r.start);
  return r;
}

/// Goes from an instance of the upper tree to the root of its mesh's tree, or at kInstanceEnd back to the upper tree.
Traversal changeSpace(Traversal s) {
  bool ends = s.node == kInstanceEnd;
  int instance = ~s.node - kInstanceLeaf;
  s.instance = ends ? -1 : instance;
  s.node = ends ? topOf(s.stack) : int(readNodes(int(kInstanceRows) * (ends ? 0 : instance) + 3).w);
  s.stack = stepStack(s.stack, !ends, ends, kInstanceEnd);
  s.steps += 1;
  return s;
}

/// One step from an inner node: to the nearer child that is hit, or to what the stack holds. `there` false: nothing
/// changes. kFrontToBack: the nearer child first, boxes behind the hit are discarded; else children in fixed order, and
/// only the ray's own limit discards. Boxes are padded when packed, so that rounding in the slab test cannot lose one
/// that holds a hit (docs/design/numerics.md).
Traversal stepNode(Traversal s, TreeRay ray, float rayLimit, TreeFrame tree, bool there) {
  if (kCountWork) countWork(kWorkNodes, uint(there));
  if (kCountWork) countWork(kWorkBoxes, 2u * uint(there));
  NodePair n;
  if (kMoving) n = loadMovingNode(there ? s.node : 0, s.part);
  if (!kMoving) n = loadNode(there ? s.node : 0);
  float limit = kFrontToBack ? s.t : rayLimit;
  // A surface must not end the ray before others at its distance.
  if (kPassing || kCoincident) limit += roundingOf(limit, tree);
  if (kInstances) limit -= ray.start;
  vec3 a0 = n.low0 * ray.scale + ray.bias;
  vec3 b0 = n.high0 * ray.scale + ray.bias;
  vec3 a1 = n.low1 * ray.scale + ray.bias;
  vec3 b1 = n.high1 * ray.scale + ray.bias;
  float near0 = slabMax(slabMax(slabMin(a0.x, b0.x), slabMin(a0.y, b0.y)), slabMax(slabMin(a0.z, b0.z), ray.from));
  float far0 = slabMin(slabMin(slabMax(a0.x, b0.x), slabMax(a0.y, b0.y)), slabMin(slabMax(a0.z, b0.z), limit));
  float near1 = slabMax(slabMax(slabMin(a1.x, b1.x), slabMin(a1.y, b1.y)), slabMax(slabMin(a1.z, b1.z), ray.from));
  float far1 = slabMin(slabMin(slabMax(a1.x, b1.x), slabMax(a1.y, b1.y)), slabMin(slabMax(a1.z, b1.z), limit));
  bool hit0 = near0 <= far0;
  bool hit1 = near1 <= far1;
  bool swap = kFrontToBack && near1 < near0;
  bool both = hit0 && hit1;
  bool first1 = both ? swap : hit1;
  int pushed = first1 ? n.child0 : n.child1;
  int popped = topOf(s.stack);
  bool none = !hit0 && !hit1;
  int next = none ? popped : (first1 ? n.child1 : n.child0);
  s.node = there ? next : s.node;
  s.stack = stepStack(s.stack, there && both, there && none, pushed);
  return s;
}

/// The primitives of the leaf at which the traversal is; then what the stack holds.
Traversal meetLeaf(Traversal s, TreeRay ray, bool anyHit) {
  s = intersectLeaf(s, ~s.node, ray.origin, ray.direction, ray.shear, ray.start);
  s.node = anyHit && s.slot >= 0 ? kTraversalDone : topOf(s.stack);
  s.stack = stepStack(s.stack, false, true, 0);
  return s;
}

/// While-while traversal of the tree (Aila and Laine, Understanding the Efficiency of Ray Traversal on GPUs, 2009).
Traversal traverseTree(vec3 origin, vec3 direction, float rayLimit, Traversal s, TreeFrame tree, int stepLimit,
                       bool anyHit) {
  TreeRay ray = treeRayOf(s, origin, direction, tree);
  while (s.node != kTraversalDone && s.steps < stepLimit) {
    // Both conditions in one sign bit: at an inner node, and below the limit. The loop asks at its end, since llvmpipe
    // runs the body of a loop once more, without a lane, for a condition at its head.
    bool walks = (s.node | (stepLimit - 1 - s.steps)) >= 0;
    do {
      if (walks) {
        s = stepNode(s, ray, rayLimit, tree, true);
        s.steps += 1;
        if (kCountVisits) s.visits += 1;
      }
      walks = (s.node | (stepLimit - 1 - s.steps)) >= 0;
    } while (walks);
    bool atLeaf = s.node < 0 && s.node != kTraversalDone;
    if (kInstances && atLeaf && ~s.node >= kInstanceLeaf) {
      s = changeSpace(s);
      ray = treeRayOf(s, origin, direction, tree);
      atLeaf = false;
    }
    if (atLeaf) {
      s = meetLeaf(s, ray, anyHit);
      s.steps += 1;
      if (kCountVisits) s.visits += 1;
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
