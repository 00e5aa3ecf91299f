// SPDX-License-Identifier: MIT
// Decoding of nodes and leaves: the one place that knows how the tree is packed (src/pack/pack_tree.cpp writes it).

/// A node of up to four children, whose boxes lie on a grid of its own. Boxes are in cells, by their sides: those that
/// a ray meets first, and the others.
struct WideNode {
  vec3 origin;
  vec3 cell;
  vec4 nearX, nearY, nearZ;
  vec4 farX, farY, farZ;
  uint inner;   // group of the inner children
  uint leaves;  // group of the leaves
};

/// Four bytes, the lowest first.
vec4 bytesOf(uint word) { return vec4(ivec4(uvec4(word, word >> 8, word >> 16, word >> 24) & 0xffu)); }

/// Powers of two, from their exponents as in floats.
vec3 powersOf(uint word) { return uintBitsToFloat(uvec3(word << 23, word << 15, word << 7) & 0x7f800000u); }

WideNode loadNode(int index, vec3 inverse) {
  uvec4 a = readNodes(int(kNodeRows) * index);
  uvec4 b = readNodes(int(kNodeRows) * index + 1);
  uvec4 c = readNodes(int(kNodeRows) * index + 2);
  bool backX = inverse.x < 0.0f;
  bool backY = inverse.y < 0.0f;
  bool backZ = inverse.z < 0.0f;
  WideNode n;
  n.origin = uintBitsToFloat(uvec3(a));
  n.cell = powersOf(a.w);
  n.nearX = bytesOf(mix(b.x, b.y, backX));
  n.farX = bytesOf(mix(b.y, b.x, backX));
  n.nearY = bytesOf(mix(b.z, b.w, backY));
  n.farY = bytesOf(mix(b.w, b.z, backY));
  n.nearZ = bytesOf(mix(c.x, c.y, backZ));
  n.farZ = bytesOf(mix(c.y, c.x, backZ));
  n.inner = c.z;
  n.leaves = c.w;
  return n;
}

/// Two primitives side by side; the second word is kPrimitiveNone (and its vertices equal) when there is one.
struct LeafPair {
  vec3 v0a, v0b;
  vec3 v1a, v1b;
  vec3 v2a, v2b;
  uint worda, wordb;
};

LeafPair loadLeaf(int index) {
  int row = int(kLeafRows) * index;
  uvec4 r0 = readLeaves(row);
  uvec4 r1 = readLeaves(row + 1);
  uvec4 r2 = readLeaves(row + 2);
  uvec4 r3 = readLeaves(row + 3);
  uvec4 r4 = readLeaves(row + 4);
  LeafPair l;
  l.v0a = uintBitsToFloat(uvec3(r0.x, r0.z, r1.x));
  l.v0b = uintBitsToFloat(uvec3(r0.y, r0.w, r1.y));
  l.v1a = uintBitsToFloat(uvec3(r1.z, r2.x, r2.z));
  l.v1b = uintBitsToFloat(uvec3(r1.w, r2.y, r2.w));
  l.v2a = uintBitsToFloat(uvec3(r3.x, r3.z, r4.x));
  l.v2b = uintBitsToFloat(uvec3(r3.y, r3.w, r4.y));
  l.worda = r4.z;
  l.wordb = r4.w;
  return l;
}

/// The word of the primitive in a leaf slot.
uint wordOf(int slot) {
  uvec4 r4 = readLeaves(int(kLeafRows) * (kMoving ? slot / 2 * 2 : slot / 2) + int(kLeafRows) - 1);
  return slot % 2 == 1 ? r4.w : r4.z;
}

/// A time within one of the straight pieces in which surfaces move (kMoving).
struct Moment {
  int segment;
  float part;  // 0..1 of the segment
};

/// time: 0..1 of all segments.
Moment momentAt(float time, int segments) {
  float place = time * float(segments);
  Moment m;
  m.segment = max(0, min(int(place), segments - 1));
  m.part = place - float(m.segment);
  return m;
}

/// A point on its way. Vertices that triangles share stay together: the same numbers give the same result.
vec3 onItsWay(vec3 from, vec3 to, float part) {
  precise vec3 point = from + part * (to - from);
  return point;
}

/// The node at a part of its segment. Its cells have the same size throughout.
WideNode loadMovingNode(int index, vec3 inverse, float part) {
  WideNode n = loadNode(2 * index, inverse);
  WideNode to = loadNode(2 * index + 1, inverse);
  n.origin += part * (to.origin - n.origin);
  n.nearX += part * (to.nearX - n.nearX);
  n.nearY += part * (to.nearY - n.nearY);
  n.nearZ += part * (to.nearZ - n.nearZ);
  n.farX += part * (to.farX - n.farX);
  n.farY += part * (to.farY - n.farY);
  n.farZ += part * (to.farZ - n.farZ);
  return n;
}

/// The leaf at a part of its segment.
LeafPair loadMovingLeaf(int index, float part) {
  LeafPair l = loadLeaf(2 * index);
  LeafPair to = loadLeaf(2 * index + 1);
  l.v0a = onItsWay(l.v0a, to.v0a, part);
  l.v0b = onItsWay(l.v0b, to.v0b, part);
  l.v1a = onItsWay(l.v1a, to.v1a, part);
  l.v1b = onItsWay(l.v1b, to.v1b, part);
  l.v2a = onItsWay(l.v2a, to.v2a, part);
  l.v2b = onItsWay(l.v2b, to.v2b, part);
  return l;
}

/// The vertices of one of its primitives.
struct Corners {
  vec3 v0;
  vec3 v1;
  vec3 v2;
};

Corners cornersIn(LeafPair l, bool second) {
  Corners c;
  c.v0 = second ? l.v0b : l.v0a;
  c.v1 = second ? l.v1b : l.v1a;
  c.v2 = second ? l.v2b : l.v2a;
  return c;
}

/// The transform of an instance, from local space to its mesh's space.
struct InstanceSpace {
  vec3 place;  // the mesh's origin in local space
  vec3 row0;   // rows of the matrix from local space into the mesh's space
  vec3 row1;
  vec3 row2;
};

InstanceSpace loadInstanceSpace(int instance) {
  int row = int(kInstanceRows) * instance;
  vec4 r0 = uintBitsToFloat(readNodes(row));
  vec4 r1 = uintBitsToFloat(readNodes(row + 1));
  vec4 r2 = uintBitsToFloat(readNodes(row + 2));
  InstanceSpace s;
  s.place = vec3(r0.w, r1.w, r2.w);
  s.row0 = vec3(r0);
  s.row1 = vec3(r1);
  s.row2 = vec3(r2);
  return s;
}

/// The transform of an instance from its mesh's space to local space.
struct InstanceReturn {
  vec3 row0;  // rows of the matrix into local space
  vec3 row1;
  vec3 row2;
  float handedness;   // -1 where it mirrors, else 1
  float offsetScale;  // an offset of the mesh's space becomes offsetScale times that, and offsetBase, in local space
  float offsetBase;
  float stretchBack;  // the most that a length grows on the way into the mesh's space
};

InstanceReturn loadInstanceReturn(int instance) {
  int row = int(kInstanceRows) * instance;
  vec4 r0 = uintBitsToFloat(readNodes(row + 4));
  vec4 r1 = uintBitsToFloat(readNodes(row + 5));
  InstanceReturn r;
  r.row0 = vec3(r0);
  r.row1 = vec3(r1);
  vec4 r2 = uintBitsToFloat(readNodes(row + 6));
  r.row2 = vec3(r2);
  r.stretchBack = r2.w;
  r.handedness = r1.w;
  r.offsetScale = uintBitsToFloat(readNodes(row + 3)).y;
  r.offsetBase = r0.w;
  return r;
}

vec3 timesRows(vec3 row0, vec3 row1, vec3 row2, vec3 v) { return vec3(dot(row0, v), dot(row1, v), dot(row2, v)); }

/// The offset of a ray's origin from a triangle of the mesh, in local space.
float offsetOutOfMesh(InstanceReturn r, float offset) { return offset * r.offsetScale + r.offsetBase; }

/// A normal of the mesh's space in local space, by the transpose of the inverse; not of unit length.
vec3 normalOutOfMesh(InstanceSpace s, vec3 normal) { return normal.x * s.row0 + normal.y * s.row1 + normal.z * s.row2; }
