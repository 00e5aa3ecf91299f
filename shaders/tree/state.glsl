// SPDX-License-Identifier: MIT
// The state of a traversal. It is a value that can stop at a step limit and continue in a later draw.

/// The lowest number of a child in a group.
int firstOf(uint group) { return int(0x12131210u >> (group >> 26 & 30u)) & 3; }

/// The index of its child 0; also that of an end, which is negative.
int baseOf(uint group) { return int(group << 5) >> 5; }

/// The state of a traversal.
struct Traversal {
  int node;     // next inner node, kTraversalDone, or kInstanceEnd; iterative: next block of leaves
  uint group;   // its siblings that are still to be visited (layout.glsl)
  uint leaves;  // leaves that come before the next node, as a group
  float t;    // nearest hit so far, else the ray's limit
  int slot;   // its leaf slot (leaf * 2 + side), or -1
  vec2 weights;  // barycentric, of its second and third vertex (kWeights)
  int instance;  // whose mesh is being walked, or -1; node, group and stack are of its tree then
  int hitInstance;  // instance that shows the slot, or -1
  int steps;  // loop iterations so far in this draw
  // kCreases: part of t by which hits on front faces count as nearer, those on back faces as farther; negative: the
  // other way
  float tie;
  bool extends;  // kCoincident: the ray is a path's own; shadow rays end before the lamp that they are aimed at
  bool both;  // kLightPaths: single-sided surfaces have their backs, too
  float part; // kMoving: of the segment in whose tree the traversal is, 0..1
  int visits; // nodes and leaves visited, counted for the heat map only
  float tMin;     // kPassing, kTestsAlpha: only hits behind this distance count,
  int tMinSlot;   // and those at it in later slots: what the ray has passed through lies there
  bool tested;    // kTestsAlpha: alpha may let the ray pass the hit of the last leaf,
  bool more;      // and that leaf may have others
  Sampler chances;  // kTestsAlpha: decide what alpha lets pass (tree/alpha.glsl)
  float time;     // kTestsAlpha and kMoving: of the path
  Stack stack;
};

/// The least rounding of distances in the tree (roundingOf), and the number of leaves.
struct TreeFrame {
  float rounding;
  int leafCount;
};

Traversal startTraversal(float limit, int leafCount) {
  Traversal s;
  s.node = leafCount == 0 ? kTraversalDone : 0;
  s.group = 0u;
  s.leaves = 0u;
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
  s.tested = false;
  s.more = false;
  s.chances = makeSampler(0u, 0u);
  s.time = 0.0f;
  s.stack = emptyStack();
  return s;
}

/// A traversal that begins at a moment, in the tree of its segment.
Traversal beginAt(Traversal s, Moment m, int nodesOfSegment) {
  s.part = m.part;
  s.node = s.node == kTraversalDone ? s.node : m.segment * nodesOfSegment;
  return s;
}

bool isDone(Traversal s) { return s.node == kTraversalDone && s.leaves < kFirstChild; }

/// Returns true if the next step is one from an inner node.
bool isAtNode(Traversal s) { return (s.node | int(kBaseMask - s.leaves)) >= 0; }

/// The slot of a shadow ray that has met a surface through which no light passes, where there are others (kPassing).
const int kOpaqueSlot = 0x7fffffff;

/// Returns true if a shadow ray needs to know no more.
bool isStopped(Traversal s) { return kPassing ? s.slot == kOpaqueSlot : s.slot >= 0; }

/// A traversal that looks no further.
Traversal ended(Traversal s) {
  s.node = kTraversalDone;
  s.leaves = 0u;
  return s;
}
