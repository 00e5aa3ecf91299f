// SPDX-License-Identifier: MIT
// Meeting the primitives of a leaf: those that let the ray pass by their alpha are left out before a hit is accepted.

/// tree/alpha.glsl defines it.
bool letsPass(Traversal hit, vec3 origin, vec3 direction);

/// The nearest of what the traversal has and what stops the ray in a leaf, or (kLiterals) in the whole scene. origin,
/// direction: the ray in local space.
Traversal meetPrimitives(Traversal s, int leaf, TreeRay ray, vec3 origin, vec3 direction, bool anyHit) {
  Traversal found;
  Traversal behind = s;
  bool again = false;
  do {
    if (kLiterals) found = traverseLiterals(origin, direction, behind, anyHit);
    if (!kLiterals) found = intersectLeaf(behind, leaf, ray.origin, ray.direction, ray.shear, ray.start, anyHit);
    if (kTestsAlpha) {
      bool tested = kLiterals ? found.slot >= 0 : found.tested && found.slot != kOpaqueSlot;
      bool passes = tested && letsPass(found, origin, direction);
      countSurfacesPassed(uint(passes));
      again = passes && (kLiterals || found.more);
      behind.tMin = found.t;
      behind.tMinSlot = found.slot;
      behind.steps += 1;
      if (passes) found = behind;
    }
  } while (again);
  found.tMin = s.tMin;
  found.tMinSlot = s.tMinSlot;
  return found;
}
