// SPDX-License-Identifier: MIT
// What a filter tells surfaces apart by (kFeatureGuides): albedo and normal of the first surface that is not seen by
// way of smooth glass or a smooth metal alone, so that what stands behind these stays sharp, and depth of the first
// surface of all, which tells these from the rest. No shadow ray is traced meanwhile, so its members keep them, also
// from draw to draw: contribution the normal, shadowLimit depth.

const float kGuideAlpha = 0.01;    // the roughest that is followed: what it shows is hardly blurred
const int kGuideScatterings = 16;  // at most

/// One surface along the camera path: what it shows, or where it leads. Of reflection and refraction the stronger one
/// is followed, without chance, since noise of the guides would be noise of the picture.
Path guideAt(Path p, Surface s, vec3 baseColor) {
  if (p.cameraRay) p.shadowLimit = depthOf(s);
  vec3 normal = facingNormal(mappedNormal(s), -p.direction);
  p.contribution = normal;
  // What glass around the point makes of radiance is no matter of its colour.
  vec3 tint = kPassesLight ? p.throughput * p.compression : p.throughput;
  p.radiance = tint;
  p.phase = kPhaseEnd;
  SurfaceMaterial m;
  if (kSmoothSurfaces) m = materialAt(s.material, baseColor, s.texcoords);
  bool follows = kSmoothSurfaces && p.bounce < kGuideScatterings && m.roughness * m.roughness < kGuideAlpha;
  bool refracts = kRefraction && follows && m.transmission * (1.0 - m.metallic) > 0.5;
  if (kRefraction && refracts) return proceed(scatterGlass(p, s, m, normal, 0.5));
  if (kReflections && follows && m.metallic > 0.5) return proceed(scatterMirror(p, s, m, normal, 1.0));
  p.radiance = tint * baseColor;
  return p;
}
