// SPDX-License-Identifier: MIT
// The light sample of the first surface of each camera path, kept for the pixels near it (reuse/neighbours.glsl).
#include "integrators/camera_rays.glsl"

void storeReservoir(ivec2 pixel, Reservoir r) {
  imageStore(filmSum, pixel, firstTexel(r));
  imageStore(filmCompensation, pixel, secondTexel(r));
}

Path beginPath(ivec2 pixel, uint samples, int steps) { return cameraPath(pixel, samples, steps); }

float interceptedAt(Path p) { return kFarAway; }

Path intercept(Path p, float t) { return p; }

Path miss(Path p) { return p; }

Path hit(Path p) {
  Surface s = surfaceHit(p);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  if (kPassesLight) p = flyTo(p, s);
  if (p.hit.slot < 0 || isUnlit(s.material) || lightSampleCount() == 0) return p;
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  LitSurface on = LitSurface(s.position, packNormal(s.geometricNormal), takesLightFromBehind(s, m));
  storeReservoir(p.pixel, makeReservoir(on, normalOfLight(s, m), p.sampler, kBounceDimensions + kLightDimension));
  return p;
}

void suspendOwn(Path p, int row) {}

Path resumeOwn(Path p, int row) { return p; }

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  film.samples += 1u;
  return film;
}
