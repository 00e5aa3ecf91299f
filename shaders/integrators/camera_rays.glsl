// SPDX-License-Identifier: MIT
// What integrators share whose paths begin at the camera.

uint keyOfPath(ivec2 pixel) { return keyOfPixel(pixel); }

/// The pixel of a path's own in the film.
ivec2 placeOf(ivec2 pixel, uint samples) { return pixel; }

/// The first camera ray of the sample after so many.
Path cameraPath(ivec2 pixel, uint samples, int steps) {
  return startPath(pixel, keyOfPixel(pixel), samples + uint(frame.firstSample), 0, steps);
}

/// Nothing is in the way of the shadow ray.
Path connected(Path p) {
  p.radiance += p.connection.light;
  return p;
}

/// Returns true if the sample of a finished path has more camera rays.
bool hasMoreRays(Path p) { return kCameraRays > 1 && isShort(earlierRays(p)); }

/// The next camera ray of a finished path's sample.
Path nextRay(Path p, ivec2 pixel, uint samples) {
  uint index = samples + uint(frame.firstSample);
  Path next = startPath(pixel, keyOfPixel(pixel), index, earlierRays(p) + 1, p.traversal.steps);
  next.radiance = p.radiance;
  next.rays = p.rays + kEarlierRay + (p.covered ? kCoveredRay : 0);
  return next;
}

/// The path's own ray has been traced.
void countRay(Path p) {
  countCameraRays(uint(p.cameraRay));
  countBounceRays(uint(!p.cameraRay));
}

/// A shadow ray has been traced.
void countShadowRay() { countShadowRays(1u); }

int prefixBehind(Path p, Surface s, float pdf, bool straight) {
  bool caster = isCaster(materialFlags(s.material), pdf == 0.0);
  bool first = p.bounce == 1;
  bool narrow = pdf == 0.0 || (first && pdf > kNarrow);
  // Without light paths, camera paths leave out nothing.
  return casterCount < 0 ? kPrefixSmooth : cameraPrefix(p.prefix, first, narrow, straight, caster);
}
