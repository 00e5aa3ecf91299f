// SPDX-License-Identifier: MIT
// Paths in participating media. A path's ray ends where its flight does (flightLimit), unless it meets a surface
// before: a ray that has met nothing, but has an end, is scattered there. Shadow rays are dimmed by what lies between
// the surfaces that they pass.

Medium mediumOf(uint material) {
  vec4 scatter = materialFloats(material, kMaterialScatter);
  return Medium(materialFloats(material, kMaterialVolume).rgb, scatter.rgb, scatter.w);
}

/// The boundary of such a solid does not bend light.
bool isMatched(uint material) {
  vec4 surface = materialFloats(material, kMaterialSurface);
  return abs(surface.z - 1.0) < kEqualIndices && surface.w > 0.0;
}

bool isSolid(uint material) { return materialFloats(material, kMaterialVolume).w > 0.0; }

/// The medium in front of a point that the path's ray has hit: a back face of a solid says what the way led through,
/// even if the camera stands inside.
uint mediumBefore(Surface s, uint known) { return !s.front && isSolid(s.material) ? s.material : known; }

/// The medium on the far side of a solid's boundary.
uint mediumBehind(Surface s) { return s.front ? s.material : kPrimitiveNone; }

/// The medium of a ray that leaves a surface.
uint mediumTowards(Path p, Surface s, vec3 direction) {
  bool crosses = dot(direction, s.geometricNormal) < 0.0 && isSolid(s.material);
  return crosses ? mediumBehind(s) : p.medium;
}

/// Light gets straight into such a medium: there is none, or its boundary does not bend it.
bool isOpen(uint medium) { return medium == kPrimitiveNone || (kMatchedGlass && isMatched(medium)); }

/// Returns true if a direction that was drawn with this pdf is a delta direction at smooth glass.
bool atDeltaGlass(SurfaceMaterial m, float pdf) {
  return kTransmission && pdf == 0.0 && m.transmission * (1.0 - m.metallic) > 0.0;
}

/// Returns true if it goes straight on through glass, which the path has reached in this medium.
bool goesStraight(uint medium, Surface s, SurfaceMaterial m, bool deltaGlass, bool transmitted) {
  bool through = deltaGlass && transmitted;
  if (kMatchedGlass) return through && isOpen(medium) && (!m.solid || isMatched(s.material));
  return kThinGlass && through && !m.solid && medium == kPrimitiveNone;
}

/// A path whose ray has been inside of a solid without knowing it, or begins there.
Path standInside(Path p, uint medium) {
  float ior = dispersedIor(p, medium);
  if (p.cameraRay) p.etaScale = ior * ior;
  p.medium = medium;
  return p;
}

/// Samples the distance along the path's ray of the next scattering after `from`; kFarAway without a medium
/// that scatters.
float flightEnd(Path p, float from, float u) {
  float end = kFarAway;
  if (kFog && p.medium == kPrimitiveNone) end = fogFlight(fog, p.origin, p.direction, from, u);
  if (kScattering && p.medium != kPrimitiveNone) {
    Medium m = mediumOf(p.medium);
    if (scattersLight(m)) end = from + flightDistance(m, channelChances(p.throughput), u);
  }
  return end;
}

/// A number of this bounce, or of this meeting with a surface that lets the ray pass.
uint flightNumber(Path p) { return kFlightDimensions + (uint(p.bounce) << 12) + uint(p.crossings); }

/// Does the same for flightEnd().
float flightRandom(Path p) {
  return p.crossings > 0 ? hashFloat(p.sampler, flightNumber(p)) : pathRandom(p, kFlightDimension);
}

/// Limits the path's ray, which begins at `from`, to its flight.
Path limitFlight(Path p, float from) {
  p.traversal.t = flightEnd(p, from, flightRandom(p));
  if (kDensityGrid && p.medium == kPrimitiveNone) {
    uint seed = hashBits(p.sampler, flightNumber(p));
    Walk walk = walkVolume(volume, p.origin, p.direction, from, p.traversal.t, false, seed);
    p.traversal.t = min(p.traversal.t, walk.end);
    p.traversal.steps += walk.steps;
  }
  return p;
}

/// The distance that the path's ray or its shadow ray, whichever is traced, has passed surfaces up to. A flight begins
/// there.
float passedBefore(Path p) { return kPassing ? p.traversal.tMin : 0.0; }

/// A flight has come to a surface.
Path passMedium(Path p) {
  if (!kScattering || p.medium == kPrimitiveNone) return p;
  p.throughput *= passWeight(mediumOf(p.medium), channelChances(p.throughput), p.hitT - passedBefore(p));
  return p;
}

/// The flight has come to a surface, or so it seemed: where it has not known of its medium, it is drawn once more. A
/// flight that ends before the surface leaves no hit.
Path flyTo(Path p, Surface s) {
  uint medium = mediumBefore(s, p.medium);
  bool unknown = kScattering && medium != p.medium;
  if (unknown) p = standInside(p, medium);
  float end = kFarAway;
  if (unknown) end = flightEnd(p, passedBefore(p), hashFloat(p.sampler, kFlightDimensions + 0xfffu));
  bool ends = end < p.hitT;
  if (ends) p.hitT = end;
  if (ends) p.hitSlot = -1;
  if (!ends) p = passMedium(p);
  return p;
}

/// Dims the light sample by the medium that the shadow ray passes, from what it has met last up to a distance.
Path dimShadow(Path p, uint medium, float to) {
  float from = passedBefore(p);
  bool outside = medium == kPrimitiveNone;
  if (kFog && outside) p.contribution *= exp(-fogDepth(fog, p.shadowOrigin, p.shadowDirection, from, to));
  if (kDensityGrid && outside) {
    uint seed = hashBits(p.sampler, flightNumber(p) + kShadowFlights) ^ floatBitsToUint(from);
    Walk walk = walkVolume(volume, p.shadowOrigin, p.shadowDirection, from, to, true, seed);
    p.contribution *= walk.transmittance;
    p.traversal.steps += walk.steps;
  }
  if (kAbsorption && !outside) p.contribution *= exp(-(to - from) * materialFloats(medium, kMaterialVolume).rgb);
  return p;
}
