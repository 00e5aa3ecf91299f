// SPDX-License-Identifier: MIT
// Finds what a ray hits in a leaf.

/// Rays pass through surfaces. Then all hits along a ray have one order, by distance and slot, so that it meets each
/// once, however close they lie.
bool isOrdered() { return kPassing || kTestsAlpha; }

/// Returns true if a hit at distance t is nearer than the traversal's.
bool isNearer(Traversal s, float t, int slot) {
  if (!isOrdered()) return t > 0.0f && t < s.t;
  return liesBehind(t, s.tMin, slot > s.tMinSlot) && (t < s.t || (t == s.t && slot < s.slot));
}

/// A hit on one primitive of a leaf; t is not above 0 for a miss.
struct PrimitiveHit {
  float t;
  vec2 weights;
};

/// The distance of a hit, less what puts it before surfaces that coincide with it: lamps before all others, and fronts
/// before backs. The reach covers rounding of the triangles, and 2^-19 of the distance that of the ray.
float beforeCoincident(float t, bool front, uint word) {
  float reach = uintBitsToFloat((word & 0xffu) << 23);
  float rank = ((word & kPrimitiveEmits) != 0u ? 2.0f : 0.0f) + (front ? 1.0f : 0.0f);
  return reach > 0.0f ? max(t - rank * (reach + 1.9073486328125e-6f * t), 0.5f * t) : t;
}

/// The plane of a triangle that does not move: unit normal, distance from the origin.
vec4 planeOf(int slot) {
  int row = slot * int(kFaceRows);
  return vec4(vec3(uintBitsToFloat(readFaces(row))), uintBitsToFloat(readFaces(row + 1).x));
}

/// Returns true if rays meet the back of the primitive.
bool hasBack(Traversal s, uint word) {
  return !kCulling || (kLightPaths && s.both) || (word & kPrimitiveCull) == 0u;
}

PrimitiveHit intersectWord(Traversal s, vec3 origin, vec3 direction, RayShear shear, vec3 v0, vec3 v1, vec3 v2,
                           uint word, int slot) {
  countPrimitivesTested(uint(word != kPrimitiveNone));
  PrimitiveHit r;
  r.t = -1.0f;
  r.weights = vec2(0.0f);
  if (kTriangles) {
    TriangleHit h = kWatertight ? intersectTriangle(origin, shear, v0, v1, v2)
                                : intersectTriangleFast(origin, direction, v0, v1, v2);
    if (kSlivers && h.hit && (word & kPrimitiveSliver) != 0u) {
      vec4 plane = kMoving ? planeThrough(v0, v1, v2) : planeOf(slot);
      h.t = distanceToPlane(origin, direction, shear, v0, v1, v2, vec3(plane), plane.w, h.t);
    }
    r.t = mix(-1.0f, h.t, h.hit && (h.front || hasBack(s, word)));
    if (kCoincident && s.extends && r.t > 0.0f) r.t = beforeCoincident(r.t, h.front, word);
    if (kCreases) r.t -= r.t * (h.front ? s.tie : -s.tie);
    if (kWeights) r.weights = vec2(h.weight1, h.weight2);
  }
  if (kSpheres) {
    float tMin = isOrdered() ? s.tMin : 0.0f;
    float t = intersectSphere(origin, direction, v0, v1.x, hasBack(s, word), tMin, isOrdered() && slot > s.tMinSlot);
    bool isSphere = (word & kPrimitiveSphere) != 0u && word != kPrimitiveNone;
    r.t = mix(r.t, t, isSphere);
  }
  return r;
}

/// The nearest of what the traversal has and the two primitives of a leaf. The origin lies at distance `start` along
/// the ray (kInstances). anyHit, for shadow rays: what lets no light pass comes before all else, as kOpaqueSlot.
Traversal intersectLeaf(Traversal s, int leaf, vec3 origin, vec3 direction, RayShear shear, float start, bool anyHit) {
  LeafPair l = kMoving ? loadMovingLeaf(leaf, s.part) : loadLeaf(leaf);
  PrimitiveHit a = intersectWord(s, origin, direction, shear, l.v0a, l.v1a, l.v2a, l.worda, 2 * leaf);
  PrimitiveHit b = intersectWord(s, origin, direction, shear, l.v0b, l.v1b, l.v2b, l.wordb, 2 * leaf + 1);
  if (kInstances) {
    a.t += a.t > 0.0f ? start : 0.0f;
    b.t += b.t > 0.0f ? start : 0.0f;
  }
  bool hita = isNearer(s, a.t, 2 * leaf);
  bool metb = isNearer(s, b.t, 2 * leaf + 1);
  bool passesa = (l.worda & kPrimitivePasses) != 0u;
  bool passesb = (l.wordb & kPrimitivePasses) != 0u;
  bool stops = isStopped(s) || (hita && !passesa) || (metb && !passesb);
  s.t = mix(s.t, a.t, hita);
  s.slot = mix(s.slot, 2 * leaf, hita);
  if (kWeights) s.weights = mix(s.weights, a.weights, bvec2(hita));
  bool hitb = isNearer(s, b.t, 2 * leaf + 1);
  s.t = mix(s.t, b.t, hitb);
  s.slot = mix(s.slot, 2 * leaf + 1, hitb);
  if (kWeights) s.weights = mix(s.weights, b.weights, bvec2(hitb));
  if (kTestsAlpha) {
    bool spheres = kSpheres && ((l.worda | l.wordb) & kPrimitiveSphere) != 0u;
    s.tested = (hita || hitb) && (hitb ? passesb : passesa);
    s.more = (hita && metb) || spheres;
  }
  if (kPassing && anyHit && stops) s.slot = kOpaqueSlot;
  if (kInstances) s.hitInstance = hita || hitb ? s.instance : s.hitInstance;
  return s;
}
