// SPDX-License-Identifier: MIT
// A ray in the space of the tree that it walks: the scene's, or an instance's.

/// A direction component that is safe to divide by: |d| is at least 2^-60, far below what 24 bits of it can show.
float awayFromZero(float d) {
  float least = mix(8.6736173798840355e-19f, -8.6736173798840355e-19f, d < 0.0f);
  return mix(d, least, abs(d) < 8.6736173798840355e-19f);
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
  vec3 inverse;  // 1 / direction
};

TreeRay makeTreeRay(vec3 origin, vec3 direction, float start) {
  TreeRay r;
  r.origin = origin;
  r.direction = direction;
  r.start = start;
  r.from = 0.0f;
  r.shear = makeShear(direction);
  r.inverse = vec3(1.0f) / vec3(awayFromZero(direction.x), awayFromZero(direction.y), awayFromZero(direction.z));
  return r;
}

/// A bound on the rounding of distances along a ray, except for triangles seen edge-on: a hit may lie that far outside
/// its box. It is a 16,384th of the way and of the scene; large triangles need a 2^21st.
float roundingOf(float t, TreeFrame tree) { return 6.103515625e-5f * t + tree.rounding; }

/// Returns the ray in the space of the scene's own tree, or (s.instance >= 0) of an instance's mesh.
TreeRay treeRayOf(Traversal s, vec3 origin, vec3 direction, TreeFrame tree) {
  TreeRay r;
  if (kInstances && s.instance >= 0) {
    MeshRay m = rayInMesh(s.instance, origin, direction);
    r = makeTreeRay(m.origin, m.direction, m.start);
  } else {
    r = makeTreeRay(origin, direction, 0.0f);
  }
  if (kPassing) r.from = max(0.0f, s.tMin - roundingOf(s.tMin, tree) - r.start);
  return r;
}
