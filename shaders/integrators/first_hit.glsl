// SPDX-License-Identifier: MIT
// What a camera ray hits first, and no more: layers of numbers (kAov), unlit colours (stage flat), or how many nodes it
// has visited (kCountVisits).
#include "integrators/camera_rays.glsl"

Path beginPath(ivec2 pixel, uint samples, int steps) { return cameraPath(pixel, samples, steps); }

/// The number of the glTF node that was hit, from 1 on.
float objectNumber(int slot, int instance) {
  if (!kObjectNumbers) return 0.0;
  bool shown = kInstances && instance >= 0;
  int index = shown ? frame.leafCount * 2 + instance : slot;
  uvec4 four = readMaterials(frame.objectRow + index / 4);
  int place = index % 4;
  return float(place == 0 ? four.x : place == 1 ? four.y : place == 2 ? four.z : four.w);
}

/// Returns the AOV of the point that a camera ray hits.
vec3 aovAt(Surface s, int slot, int instance, vec3 baseColor, vec3 wo, float time) {
  if (kAov == kAovAlbedo || kAov == kAovNone) return baseColor;
  if (kAov == kAovNormal) return facingNormal(mappedNormal(s), wo);
  if (kAov == kAovGeometricNormal) return s.geometricNormal;
  if (kAov == kAovRoughness) return vec3(materialAt(s.material, baseColor, s.texcoords).roughness);
  if (kAov == kAovTexcoords) return vec3(s.texcoords.xy, 0.0);
  if (kAov == kAovPosition) return frame.worldOrigin + frame.metresPerUnit * s.position;
  if (kAov == kAovObject || kAov == kAovCryptoObject) return vec3(objectNumber(slot, instance));
  if (kAov == kAovMaterial || kAov == kAovCryptoMaterial) return vec3(materialFloats(s.material, kMaterialPerlin).w);
  return vec3(depthOf(s, time));
}

Path hit(Path p) {
  Surface s = surfaceHit(p);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  p.covered = !kCountVisits;
  p.radiance = aovAt(s, p.hit.slot, p.hit.instance, baseColor, -p.ray.direction, p.time);
  return p;
}

float interceptedAt(Path p) { return kFarAway; }

Path intercept(Path p, float t) { return p; }

/// The stage flat shows the background.
Path miss(Path p) {
  if (kAov == kAovNone) p = meetSurroundings(p);
  return p;
}

void suspendOwn(Path p, int row) {}

Path resumeOwn(Path p, int row) { return p; }

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  if (kCountVisits) p.radiance = vec3(float(p.traversal.visits));
  return addSample(film, p.radiance, p.covered ? 1.0 : 0.0);
}
