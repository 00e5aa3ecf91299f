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

// Each layer by its name: its value at the surface that the camera ray hits.
vec3 layerAlbedo(Path p, Surface s, vec3 baseColor) { return baseColor; }
vec3 layerNormal(Path p, Surface s, vec3 baseColor) { return facingNormal(mappedNormal(s), -p.ray.direction); }
vec3 layerDepth(Path p, Surface s, vec3 baseColor) { return vec3(depthOf(s, p.time)); }
vec3 layerGeometricNormal(Path p, Surface s, vec3 baseColor) { return s.geometricNormal; }
vec3 layerRoughness(Path p, Surface s, vec3 baseColor) {
  return vec3(materialAt(s.material, baseColor, s.texcoords).roughness);
}
vec3 layerTexcoords(Path p, Surface s, vec3 baseColor) { return vec3(s.texcoords.xy, 0.0); }
vec3 layerPosition(Path p, Surface s, vec3 baseColor) { return frame.worldOrigin + frame.metresPerUnit * s.position; }
vec3 layerObject(Path p, Surface s, vec3 baseColor) { return vec3(objectNumber(p.hit.slot, p.hit.instance)); }
vec3 layerMaterial(Path p, Surface s, vec3 baseColor) {
  return vec3(materialFloats(s.material, kMaterialPerlin).w);
}

// layer.glsl is written by src/shader/assemble.cpp: layerAt(), the layer that the program draws.
#include "layer.glsl"

Path hit(Path p) {
  Surface s = surfaceHit(p);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  p.covered = !kCountVisits;
  p.radiance = layerAt(p, s, baseColor);
  return p;
}

float interceptedAt(Path p) { return kFarAway; }

Path intercept(Path p, float t) { return p; }

/// The stage flat shows the background.
Path miss(Path p) {
  if (kDrawsLight) p = meetSurroundings(p);
  return p;
}

void suspendOwn(Path p, int row) {}

Path resumeOwn(Path p, int row) { return p; }

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  if (kCountVisits) p.radiance = vec3(float(p.traversal.visits));
  return addSample(film, p.radiance, p.covered ? 1.0 : 0.0);
}
