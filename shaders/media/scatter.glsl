// SPDX-License-Identifier: MIT
// A medium scatters a path: it takes one light sample, and draws one direction from the phase function.

/// The light sample of a point in a medium that light gets into.
Path sampleLdInMedium(Path p, vec3 point, float g) {
  uint dimension = kBounceDimensions * uint(p.bounce + 1) + kLightDimension;
  LightSample light = lightOfSlot(0, point, kNoNormal, p.sampler, dimension);
  float value = phasePdf(g, dot(p.direction, light.direction));
  float weight = lightWeight(light, value);
  if (kThroughGlass) p.throughGlass = true;
  p.shadowMedium = p.medium;
  return spawnShadowRayFrom(p, point, point, light, p.throughput * light.irradiance * (value * weight));
}

/// Roulette decides if a path goes on after a scattering in a medium, which --bounces does not limit: in one that is
/// white and dense, paths are long.
Path decideInMedium(Path p) {
  p.after = kPhaseEnd;
  if (maxComponent(p.throughput) <= 0.0) return p;
  bool decides = p.bounce >= frame.rouletteDepth;
  float most = p.bounce >= kLatestRoulette ? kMediumSurvival : 1.0;
  float survival = min(maxComponent(p.throughput) * p.etaScale, most);
  if (decides && drawFloat(p.sampler, kBounceDimensions * uint(p.bounce) + kRouletteDimension) >= survival) return p;
  if (decides) p.throughput /= survival;
  p.after = kPhaseExtend;
  return p;
}

/// The path's ray ends in its medium, and is scattered.
Path scatterInMedium(Path p) {
  bool inFog = kFog && p.medium == kPrimitiveNone;
  vec4 scatter = vec4(0.0);
  if (kFog && inFog) scatter = fog.medium;
  if (kScattering && !inFog) {
    Medium m = mediumOf(p.medium);
    scatter = vec4(scatterWeight(m, channelChances(p.throughput), p.hitT - passedBefore(p)), m.g);
  }
  p.throughput *= scatter.rgb;
  if (p.cameraRay) p.covered = true;
  p.phase = kPhaseEnd;
  if (kAov == kAovEmission) return p;
  if (kLightAov && p.bounce == 0) p.aovWeight = vec3(kAov == kAovDiffuse ? 1.0 : 0.0);
  vec3 point = p.origin + p.hitT * p.direction;
  vec2 uv = drawPair(p.sampler, kBounceDimensions * uint(p.bounce + 1) + kDirectionDimension);
  bool open = isOpen(p.medium);
  if (open && lightSlotCount() > 0) p = sampleLdInMedium(p, point, scatter.w);
  vec3 before = p.direction;
  p.direction = samplePhase(scatter.w, before, uv.x, uv.y);
  p.pdf = open ? phasePdf(scatter.w, dot(before, p.direction)) : 0.0;
  p.origin = point;
  p.normal = kNoNormal;
  p.tie = 0.0;
  p.cameraRay = false;
  p.bounce += 1;
  p.freeBounces += 1;
  p = decideInMedium(p);
  return p.phase == kPhaseShadow ? p : proceed(p);
}
