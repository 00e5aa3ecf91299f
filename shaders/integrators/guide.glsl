// SPDX-License-Identifier: MIT
// Guides, by which a filter distinguishes surfaces. Albedo and normal are those of the first surface
// that is not just smooth glass or a smooth metal, so that what is seen through or in these stays sharp. Depth is that
// of the first surface of all, which separates these from the rest. Where alpha lets a part of the light pass, surfaces
// count by their shares, not by chance.
#include "catcher.glsl"
#include "integrators/camera_rays.glsl"

/// The sums of a path, and the normal of its last surface.
struct Guide {
  vec3 albedo;
  vec3 normal;
  float depth;
  float share;      // share of the ray that surfaces have taken so far
  vec3 lastNormal;
} guide;

/// The share of the ray that alpha has let pass so far.
float guideRest() { return 1.0 - guide.share; }

/// Ends a share of the ray at a surface of this albedo.
void addGuide(float share, vec3 albedo, vec3 normal) {
  guide.albedo += share * albedo;
  guide.normal += share * normal;
  guide.share += share;
}

/// The tint of the way so far, without the factor by which glass around the point scales radiance.
vec3 guideTint(Path p) { return kPassesLight ? p.throughput * p.etaScale : p.throughput; }

/// The rest of the ray ends here, or continues from here without chance.
Path takeGuide(Path p, float depth, vec3 normal) {
  if (p.cameraRay) guide.depth += guideRest() * depth;
  guide.lastNormal = normal;
  p.covered = true;
  return p;
}

Path guideStop(Path p, vec3 albedo) {
  p.throughput = guideTint(p) * albedo;
  p.etaScale = 1.0;
  return p;
}

Path beginPath(ivec2 pixel, uint samples, int steps) {
  guide = Guide(vec3(0.0), vec3(0.0), 0.0, 0.0, vec3(0.0, 0.0, 1.0));
  return cameraPath(pixel, samples, steps);
}

/// One surface along the camera path is a guide, or leads to the next one. The stronger of reflection and refraction is
/// followed, since noise of the guides would be noise of the picture.
Path hit(Path p) {
  Surface s = surfaceHit(p);
  uint flags = materialFlags(s.material);
  vec4 base = baseColorAt(s.material, s.texcoords, s.color);
  vec3 normal = facingNormal(mappedNormal(s), -p.ray.direction);
  bool blends = kAlpha && (flags & (kMaterialMask | kMaterialBlend)) != 0u;
  float share = blends ? guideRest() * alphaAt(s.material, flags, base.a) : 1.0;
  const float least = 0.01;  // share of a ray below which surfaces behind no longer count
  if (blends && guideRest() - share > least) {
    if (p.cameraRay) guide.depth += share * depthOf(s, p.time);
    addGuide(share, guideTint(p) * base.rgb, normal);
    p.next = kPhasePass;
    return p;
  }
  p = takeGuide(p, depthOf(s, p.time), normal);
  SurfaceMaterial m;
  if (kSmoothSurfaces) m = materialAt(s.material, base.rgb, s.texcoords);
  // Smoother surfaces show all else hardly blurred.
  bool follows = kSmoothSurfaces && p.bounce < 16 && m.roughness * m.roughness < 0.01;
  bool refracts = kRefraction && follows && m.transmission * (1.0 - m.metallic) > 0.5;
  // Milk hides what is behind it.
  if (kScattering) refracts = refracts && (flags & kMaterialScatters) == 0u;
  if (refracts) return scatterGlass(p, s, m, normal, 0.5);
  if (kReflections && follows && m.metallic > 0.5) return scatterMirror(p, s, m, normal, 1.0);
  return guideStop(p, base.rgb);
}

/// A medium before all surfaces is a white surface at a distance, since its light is noisy, too.
Path guideInMedium(Path p, float t) {
  p = takeGuide(p, depthAlong(p.ray.direction, t, p.time), -p.ray.direction);
  return guideStop(p, vec3(1.0));
}

/// The guides of the catcher are white and level, so that a filter does not take it for empty surroundings.
Path guideAtCatcher(Path p, float t) {
  p = takeGuide(p, depthAlong(p.ray.direction, t, p.time), vec3(0.0, 1.0, 0.0));
  p.eye.caught = true;
  return guideStop(p, vec3(1.0));
}

/// The distance of the grid's box where a flight of the camera's ray ends in the grid before it meets a surface, or
/// kFarAway. The guides of a pixel are means over such flights; their own distances would part its neighbours.
float gridBefore(Path p) {
  if (!p.cameraRay) return kFarAway;
  uint seed = hashBits(p.sampler, flightNumber(p));
  Walk walk = walkVolume(volume, p.ray.origin, p.ray.direction, 0.0, p.hit.t, false, seed);
  return walk.end < kFarAway ? max(walk.entry, 0.0) : kFarAway;
}

float interceptedAt(Path p) {
  float t = kDensityGrid ? gridBefore(p) : kFarAway;
  return kShadowCatcher ? catcherBefore(p, t) : t;
}

Path intercept(Path p, float t) { return kShadowCatcher ? guideAtCatcher(p, t) : guideInMedium(p, t); }

/// Fog counts before the surroundings, unless it is thin.
Path miss(Path p) {
  if (kFog && p.cameraRay && fogDepth(fog, p.ray.origin, p.ray.direction, 0.0, kFarAway) >= 1e-3) {
    p = guideInMedium(p, insideFog(fog, p.ray.origin, p.ray.direction, 0.0).y);
  }
  return p;
}

void suspendOwn(Path p, int row) {
  pathStates[row] = floatBitsToUint(vec4(guide.albedo, guide.depth));
  pathStates[row + 1] = floatBitsToUint(vec4(guide.normal, guide.share));
  pathStates[row + 2] = floatBitsToUint(vec4(guide.lastNormal, 0.0));
}

Path resumeOwn(Path p, int row) {
  vec4 a = uintBitsToFloat(readPathStates(row));
  vec4 b = uintBitsToFloat(readPathStates(row + 1));
  guide = Guide(a.xyz, b.xyz, a.w, b.w, uintBitsToFloat(readPathStates(row + 2).xyz));
  return p;
}

/// The last surface takes the rest of the ray. Where the catcher's shadow has ended, there is nothing to be filtered.
FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  if (kShadowCatcher && p.eye.caught && frame.shadowFade != vec2(0.0) && shadowLeft(inPicture(pixel)) <= 0.0) {
    p.covered = false;
  }
  float alpha = p.covered ? 1.0 : guide.share;
  if (p.covered) addGuide(guideRest(), guideTint(p), guide.lastNormal);
  return addGuides(film, guide.albedo, guide.normal, guide.depth, alpha);
}
