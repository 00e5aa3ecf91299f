// SPDX-License-Identifier: MIT
// Guides (kAovGuides), by which a filter distinguishes surfaces. Albedo and normal are those of the first surface
// that is not just smooth glass or a smooth metal, so that what is seen through or in these stays sharp. Depth is that
// of the first surface of all, which separates these from the rest. Where alpha lets a part of the light pass, surfaces
// count by their shares, not by chance.

const float kGuideAlpha = 0.01;    // the roughest that is followed: what it shows is hardly blurred
const int kGuideScatterings = 16;  // largest number of scatterings
const float kGuideRest = 0.01;     // share of a ray below which surfaces behind no longer count
const float kGuideFog = 1e-3;      // optical depth of the thinnest fog that counts

/// The share of the ray that alpha has let pass so far.
float guideRest(Path p) { return kAlpha ? 1.0 - p.guide.share : 1.0; }

/// Ends a share of the ray at a surface of this albedo.
Path addGuide(Path p, float share, vec3 albedo, vec3 normal) {
  p.guide.albedo += share * albedo;
  p.guide.normal += share * normal;
  p.guide.share += share;
  return p;
}

/// The tint of the way so far, without the factor by which glass around the point scales radiance.
vec3 guideTint(Path p) { return kPassesLight ? p.throughput * p.etaScale : p.throughput; }

/// The rest of the ray ends here, or continues from here without chance.
Path takeGuide(Path p, float depth, vec3 normal) {
  if (p.cameraRay) p.guide.depth += guideRest(p) * depth;
  p.guide.lastNormal = normal;
  p.covered = true;
  p.phase = kPhaseEnd;
  return p;
}

Path guideStop(Path p, vec3 albedo) {
  p.throughput = guideTint(p) * albedo;
  p.etaScale = 1.0;
  return p;
}

/// One surface along the camera path is a guide, or leads to the next one. The stronger of reflection and refraction is
/// followed, since noise of the guides would be noise of the picture.
Path guideAt(Path p, Surface s, uint flags, vec4 base) {
  vec3 normal = facingNormal(mappedNormal(s), -p.direction);
  bool blends = kAlpha && (flags & (kMaterialMask | kMaterialBlend)) != 0u;
  float share = blends ? guideRest(p) * alphaAt(s.material, flags, base.a) : 1.0;
  if (blends && guideRest(p) - share > kGuideRest) {
    if (p.cameraRay) p.guide.depth += share * depthOf(s, p.time);
    p = addGuide(p, share, guideTint(p) * base.rgb, normal);
    p.phase = kPhaseExtend;
    return tracePast(p, kFarAway, p.hitT, p.hitSlot);
  }
  p = takeGuide(p, depthOf(s, p.time), normal);
  SurfaceMaterial m;
  if (kSmoothSurfaces) m = materialAt(s.material, base.rgb, s.texcoords);
  bool follows = kSmoothSurfaces && p.bounce < kGuideScatterings && m.roughness * m.roughness < kGuideAlpha;
  bool refracts = kRefraction && follows && m.transmission * (1.0 - m.metallic) > 0.5;
  // Milk hides what is behind it.
  if (kScattering) refracts = refracts && (flags & kMaterialScatters) == 0u;
  if (kRefraction && refracts) return proceed(scatterGlass(p, s, m, normal, 0.5));
  if (kReflections && follows && m.metallic > 0.5) return proceed(scatterMirror(p, s, m, normal, 1.0));
  return guideStop(p, base.rgb);
}

/// A medium before all surfaces is a white surface at a distance, since its light is noisy, too.
Path guideInMedium(Path p, float t) {
  p = takeGuide(p, depthAlong(p.direction, t, p.time), -p.direction);
  return guideStop(p, vec3(1.0));
}

/// Fog counts before the surroundings.
Path guideInFog(Path p) {
  p = meetSurroundings(p);
  bool thick = p.cameraRay && fogDepth(fog, p.origin, p.direction, 0.0, kFarAway) >= kGuideFog;
  return thick ? guideInMedium(p, insideFog(fog, p.origin, p.direction, 0.0).y) : p;
}

/// The distance of the grid's box where a flight of the camera's ray ends in the grid before it meets a surface, or
/// kFarAway. The guides of a pixel are means over such flights; their own distances would part its neighbours.
float gridBefore(Path p) {
  if (!p.cameraRay) return kFarAway;
  uint seed = hashBits(p.sampler, flightNumber(p));
  Walk walk = walkVolume(volume, p.origin, p.direction, 0.0, p.hitT, false, seed);
  return walk.end < kFarAway ? max(walk.entry, 0.0) : kFarAway;
}

/// The path has ended: its last surface takes the rest.
Path endGuide(Path p) {
  if (p.covered) p = addGuide(p, guideRest(p), guideTint(p), p.guide.lastNormal);
  return p;
}
