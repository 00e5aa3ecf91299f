// SPDX-License-Identifier: MIT
// The solids that a ray is inside of. Where solids may be nested (kNestedSolids), a word holds the materials of the two
// innermost ones, the innermost in its lower half; 0xffff is none. Elsewhere it is the material. kPrimitiveNone is none
// at all in both.

const uint kNoSolid = 0xffffu;

/// The material of the innermost solid, or kPrimitiveNone.
uint innermost(uint solids) {
  uint inner = solids & kNoSolid;
  return !kNestedSolids ? solids : inner == kNoSolid ? kPrimitiveNone : inner;
}

/// Returns true if a solid of this material is one of them.
bool isWithin(uint solids, uint material) {
  if (!kNestedSolids) return solids == material;
  return (solids & kNoSolid) == material || solids >> 16 == material;
}

uint entering(uint solids, uint material) { return kNestedSolids ? solids << 16 | material : material; }

/// Solids that overlap may be left in any order.
uint leaving(uint solids, uint material) {
  if (!kNestedSolids) return kPrimitiveNone;
  bool inner = (solids & kNoSolid) == material;
  bool outer = solids >> 16 == material;
  uint rest = inner ? solids >> 16 : solids;
  return inner || outer ? rest | kNoSolid << 16 : solids;
}

bool isSolid(uint material) { return materialFloats(material, kMaterialVolume).w > 0.0; }

/// The solids on the far side of a solid's boundary.
uint behindBoundary(uint solids, Surface s) {
  return s.front ? entering(solids, s.material) : leaving(solids, s.material);
}

/// The solids of a ray that leaves a surface.
uint solidsTowards(Path p, Surface s, vec3 direction) {
  bool crosses = dot(direction, s.geometricNormal) < 0.0 && isSolid(s.material);
  return crosses ? behindBoundary(p.ray.medium, s) : p.ray.medium;
}

/// The material of the solid before a point that a ray has met, or kPrimitiveNone. The back of a solid says what the
/// way led through. The way from a camera says so only of closed solids: a room behind a pane is not inside of it.
uint solidBefore(uint solids, Surface s, bool fromCamera) {
  bool says = !s.front && isSolid(s.material) && !isWithin(solids, s.material);
  if (fromCamera) says = says && (materialFlags(s.material) & kMaterialClosed) != 0u;
  return says ? s.material : innermost(solids);
}

/// Puts the path into a solid that it has been inside of without knowing it.
Path standInside(Path p, uint material) {
  float ior = dispersedIor(p, material);
  if (p.cameraRay && kDrawsLight) p.etaScale *= ior * ior;
  p.ray.medium = entering(p.ray.medium, material);
  return p;
}
