// SPDX-License-Identifier: MIT
// A medium scatters a path: it takes one light sample, and draws one direction from the phase function.

/// The light sample of a point in a medium that light gets into, or that holds lamps.
Path sampleLdInMedium(Path p, vec3 point, float g) {
  uint dimension = kBounceDimensions * uint(p.bounce + 1) + kLightDimension;
  LightSample light = sampleLight(0, point, kNoNormal, p.sampler, dimension);
  float value = phasePdf(g, dot(p.ray.direction, light.direction));
  float weight = lightWeight(light, value);
  if (kThroughGlass) p.connection.throughGlass = isOpen(p.ray.medium);
  p.connection.medium = p.ray.medium;
  return spawnShadowRayFrom(p, point, point, light, p.throughput * light.irradiance * (value * weight));
}

/// Returns true if a lamp stands inside of a solid of the innermost one's material.
bool holdsLamps(uint solids) { return (materialFlags(innermost(solids)) & kMaterialHoldsLamps) != 0u; }

/// Decides by roulette if a path continues after a scattering in a medium. --bounces does not limit these
/// scatterings, because paths in a white, dense medium are long.
Path decideInMedium(Path p) {
  if (maxComponent(p.throughput) <= 0.0) return p;
  bool decides = p.bounce >= frame.rouletteDepth;
  float survival = survivalOf(p, 1.0);
  if (decides && drawFloat(p.sampler, kBounceDimensions * uint(p.bounce) + kRouletteDimension) >= survival) return p;
  if (decides) p.throughput /= survival;
  p.next = kPhaseBegin;
  return p;
}

/// The path's flight has ended in the grid, not in the fog round it: that one's would have been longer.
bool endsInGrid(Path p) {
  if (!kFog) return true;
  float from = passedBefore(p);
  return p.hit.t < flightEnd(p, from, pathRandom(p, kFlightDimension)) * float(1.0 - 1e-6);
}

/// The path's ray ends in its medium, and is scattered.
Path scatterInMedium(Path p) {
  bool outside = (kFog || kDensityGrid) && p.ray.medium == kPrimitiveNone;
  bool inGrid = kDensityGrid && outside && endsInGrid(p);
  vec3 point = p.ray.origin + p.hit.t * p.ray.direction;
  vec4 scatter = vec4(0.0);
  if (kFog && outside) scatter = fog.medium;
  if (kDensityGrid && inGrid) scatter = volume.medium;
  if (kScattering && !outside) {
    Medium m = mediumOf(innermost(p.ray.medium));
    scatter = vec4(scatterWeight(m, channelChances(p.throughput), p.hit.t - passedBefore(p)), m.g);
  }
  if (kDensityGrid && inGrid && volume.extinction.y > 0.0) {
    // Kirchhoff's law: it emits as much as it absorbs.
    vec3 light = volumeRadiance(volume, point, hashBits(p.sampler, flightNumber(p) + kShadowFlights));
    p = addLight(p, clampIndirect(p.throughput * (1.0 - scatter.rgb) * light, countedScatterings(p)));
  }
  p.throughput *= scatter.rgb;
  if (p.cameraRay) p.covered = true;
  if (kEmittedPart) return p;
  if (kLightPart && p.bounce == 0) p.eye.aovWeight = vec3(kDiffusePart ? 1.0 : 0.0);
  vec2 uv = drawPair(p.sampler, kBounceDimensions * uint(p.bounce + 1) + kDirectionDimension);
  bool open = isOpen(p.ray.medium) || (kScattering && holdsLamps(p.ray.medium));
  if (open && lightSampleCount() > 0) p = sampleLdInMedium(p, point, scatter.w);
  vec3 before = p.ray.direction;
  p.ray.direction = samplePhase(scatter.w, before, uv.x, uv.y);
  p.ray.pdf = open ? phasePdf(scatter.w, dot(before, p.ray.direction)) : 0.0;
  if (kRayCones) p.ray.cone = coneBehind(p, 0.0, max(phasePdf(scatter.w, dot(before, p.ray.direction)), 1e-30));
  p.ray.origin = point;
  p.ray.normal = kNoNormal;
  p.ray.tie = 0.0;
  p.cameraRay = false;
  p.eye.clear = false;
  p.bounce += 1;
  p.freeBounces += 1;
  return decideInMedium(p);
}
