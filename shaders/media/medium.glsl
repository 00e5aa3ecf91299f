// SPDX-License-Identifier: MIT
// Paths in participating media. A path's ray ends where its flight does (flightLimit), unless it meets a surface
// before: a ray that has met nothing, but has an end, is scattered there. Shadow rays are dimmed by what lies between
// the surfaces that they pass.
#include "media/solids.glsl"

Medium mediumOf(uint material) {
  vec4 scatter = materialFloats(material, kMaterialScatter);
  return Medium(materialFloats(material, kMaterialVolume).rgb, scatter.rgb, scatter.w);
}

/// The boundary of such a solid does not bend light.
bool isMatched(uint material) {
  vec4 surface = materialFloats(material, kMaterialSurface);
  return abs(surface.z - 1.0) < kEqualIndices && surface.w > 0.0;
}

/// Light gets straight into the innermost of these solids: there is none, or its boundary does not bend it.
bool isOpen(uint solids) { return solids == kPrimitiveNone || (kMatchedGlass && isMatched(innermost(solids))); }

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

/// Samples the distance along the path's ray of the next scattering after `from`; kFarAway without a medium
/// that scatters.
float flightEnd(Path p, float from, float u) {
  float end = kFarAway;
  if (kFog && p.ray.medium == kPrimitiveNone) end = fogFlight(fog, p.ray.origin, p.ray.direction, from, u);
  if (kScattering && p.ray.medium != kPrimitiveNone) {
    Medium m = mediumOf(innermost(p.ray.medium));
    if (scattersLight(m)) end = from + flightDistance(m, channelChances(p.throughput), u);
  }
  return end;
}

/// The hashed number of this bounce. Glass that does not bend the ray counts as one.
uint flightNumber(Path p) { return kFlightDimensions + (uint(p.bounce) << 12); }

/// Limits the path's ray, which begins at `from`, to its flight.
Path limitFlight(Path p, float from) {
  p.traversal.t = flightEnd(p, from, pathRandom(p, kFlightDimension));
  if (kDensityGrid && p.ray.medium == kPrimitiveNone) {
    uint seed = hashBits(p.sampler, flightNumber(p));
    Walk walk = walkVolume(volume, p.ray.origin, p.ray.direction, from, p.traversal.t, false, seed);
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
  if (!kAbsorption || p.ray.medium == kPrimitiveNone) return p;
  uint solid = innermost(p.ray.medium);
  float passed = p.hit.t - passedBefore(p);
  vec3 left = kScattering ? passWeight(mediumOf(solid), channelChances(p.throughput), passed)
                          : exp(-passed * materialFloats(solid, kMaterialVolume).rgb);
  p.throughput *= left;
  return p;
}

/// The flight has come to a surface, or so it seemed: where it has not known of its solid, it is drawn once more. A
/// flight that ends before the surface leaves no hit.
Path flyTo(Path p, Surface s) {
  uint solid = solidBefore(p.ray.medium, s, p.cameraRay);
  bool unknown = solid != innermost(p.ray.medium);
  if (unknown) p = standInside(p, solid);
  float end = kFarAway;
  if (kScattering && unknown) end = flightEnd(p, passedBefore(p), hashFloat(p.sampler, kFlightDimensions + 0xfffu));
  bool ends = end < p.hit.t;
  if (ends) p.hit.t = end;
  if (ends) p.hit.slot = -1;
  if (!ends) p = passMedium(p);
  return p;
}

/// Dims the light sample by what lies on its shadow ray between two distances: a solid of this material, or what is
/// outside of all solids (kPrimitiveNone). Surroundings are outside: a ray to them from a solid that only absorbs has
/// missed a face, as that of a path has (meetSurroundings).
Path dimShadow(Path p, uint solid, float from, float to) {
  bool outside = solid == kPrimitiveNone;
  if (kFog && outside) p.connection.light *= exp(-fogDepth(fog, p.connection.origin, p.connection.direction, from, to));
  if (kDensityGrid && outside) {
    uint seed = hashBits(p.sampler, flightNumber(p) + kShadowFlights) ^ floatBitsToUint(from);
    Walk walk = walkVolume(volume, p.connection.origin, p.connection.direction, from, to, true, seed);
    p.connection.light *= walk.transmittance;
    p.traversal.steps += walk.steps;
  }
  bool ends = to < kFarAway || (kScattering && !outside && (materialFlags(solid) & kMaterialScatters) != 0u);
  if (kAbsorption && !outside && ends) {
    p.connection.light *= exp(-(to - from) * materialFloats(solid, kMaterialVolume).rgb);
  }
  return p;
}
