// SPDX-License-Identifier: MIT
// Surfaces that let light pass by their alpha (docs/design/surfaces.md). A traversal asks before it accepts a hit, so
// rays meet only what stops them. They ask at level 0: by the mean alpha of distant leaves, cutoffs would let through
// all of them, or none. Guides alone meet all, and count them by their shares.

/// A ray's chances at primitives, from the numbers of its sample and the number of its scatterings.
Sampler chancesOf(Sampler s, int bounce) { return Sampler(mixBits(s.key) + mixBits(uint(bounce)), s.reversed); }

/// The random number of a ray's meeting with a primitive: the same in whatever order the ray meets its primitives. A
/// sphere is met twice, from the front and from the back. Over the samples of a pixel it is stratified, so that the
/// right share of the camera rays passes.
float chanceAt(Sampler chances, int slot, int instance, bool front) {
  return drawFloat(chances, 2u * uint(slot) + (front ? 1u : 0u) + mixBits(uint(instance)));
}

/// Returns true if the ray goes through the traversal's hit.
bool letsPass(Traversal hit, vec3 origin, vec3 direction) {
  Surface s = surfaceAt(hit.slot, hit.hitInstance, origin, direction, hit.t, hit.weights, hit.time);
  uint flags = materialFlags(s.material);
  float alpha = alphaAt(s.material, flags, baseColorAt(s.material, s.texcoords, s.color).a);
  if ((flags & kMaterialMask) != 0u) return alpha == 0.0;
  if ((flags & kMaterialBlend) == 0u) return false;
  return kIdAov ? alpha < 0.5 : chanceAt(hit.chances, hit.slot, hit.hitInstance, s.front) >= alpha;
}
