// SPDX-License-Identifier: MIT
// Surfaces that let light pass by their alpha (docs/design/surfaces.md). A traversal asks before it accepts a hit, so
// rays meet only what stops them. Guides alone meet all, and count them by their shares.

/// The key of a ray's chances at primitives, from those of its sample and the number of its scatterings.
uint chanceKey(Sampler s, int bounce) { return mixBits(s.key + bitfieldReverse(s.reversed)) + mixBits(uint(bounce)); }

/// The random number of a ray's meeting with a primitive: the same in whatever order the ray meets its primitives. A
/// sphere is met twice, from the front and from the back.
float chanceAt(uint key, int slot, int instance, bool front) {
  return unitFloat(randomBits(key, 2u * uint(slot) + (front ? 1u : 0u) + mixBits(uint(instance))));
}

/// Returns true if the ray goes through the traversal's hit.
bool letsPass(Traversal hit, vec3 origin, vec3 direction) {
  Surface s = surfaceAt(hit.slot, hit.hitInstance, origin, direction, hit.t, hit.weights, hit.time);
  uint flags = materialFlags(s.material);
  float alpha = alphaAt(s.material, flags, baseColorAt(s.material, s.texcoords, s.color).a);
  if ((flags & kMaterialMask) != 0u) return alpha == 0.0;
  if ((flags & kMaterialBlend) == 0u) return false;
  return kIdAov ? alpha < 0.5 : chanceAt(hit.key, hit.slot, hit.hitInstance, s.front) >= alpha;
}
