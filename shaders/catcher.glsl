// SPDX-License-Identifier: MIT
// The shadow catcher (kShadowCatcher): a horizontal plane that camera rays meet from above, and no other ray. It shows
// which share of the light the scene keeps from it. While a path is caught, its radiance is that share so far, and its
// throughput what the camera sees behind the plane.

/// A plane this much nearer, relative to the distance, is met before a surface: one that lies on it is seen.
const float kCatcherMargin = 1e-4;

/// Distance of the catcher along a ray, 0 where there is none.
float catcherDistance(vec3 origin, vec3 direction) {
  float above = origin.y - frame.worldOrigin.w;
  return above > 0.0 && direction.y < 0.0 ? above / -direction.y : 0.0;
}

/// Returns true if the path's ray meets the catcher before anything else; t is the distance of what it has hit.
bool meetsCatcher(Path p, float t) {
  if (!p.cameraRay) return p.caught;
  float there = catcherDistance(p.origin, p.direction);
  return there > 0.0 && there < t * (1.0 - kCatcherMargin);
}

/// Irradiance of the catcher by environment and punctual lights with nothing in the way.
vec3 freeIrradiance(vec3 point) {
  vec3 sum = frame.catcherLight.rgb * frame.catcherLight.w;
  if (!kPunctualLights) return sum;
  int count = int(frame.lightChoice.w);
  for (int i = 0; i < count; ++i) {
    LightSample light = punctualLight(i, point);
    sum += light.irradiance * max(light.direction.y, 0.0);
  }
  return sum;
}

/// A part of the irradiance as a share of all of it.
vec3 shareOfLight(vec3 part, vec3 all) {
  return vec3(all.x > 0.0 ? part.x / all.x : 0.0, all.y > 0.0 ? part.y / all.y : 0.0,
              all.z > 0.0 ? part.z / all.z : 0.0);
}

/// The camera ray meets the catcher: one light sample, and one direction in which the environment may be hidden. Light
/// counts as hidden until its shadow ray meets nothing.
Path beginShadow(Path p) {
  float t = catcherDistance(p.origin, p.direction);
  p.throughput *= seenBehind(p.direction);
  p.radiance = vec3(0.0);
  p.cameraRay = false;
  p.caught = true;
  p.part = vec3(1.0);
  Surface s;
  s.position = p.origin + t * p.direction;
  s.position.y = frame.worldOrigin.w;
  s.positionError = max(maxComponent(abs(s.position)), t) * 1e-6;
  s.geometricNormal = vec3(0.0, 1.0, 0.0);
  vec3 all = freeIrradiance(s.position);
  uint dimension = kBounceDimensions * uint(p.bounce + 1);
  vec2 uv = drawPair(p.numbers, dimension + kDirectionDimension);
  p.phase = kPhaseExtend;
  if (lightSlotCount() > 0) {
    LightSample light = lightOfSlot(0, s.position, kNoNormal, p.numbers, dimension + kLightDimension);
    float cosine = max(light.direction.y, 0.0);
    // Emissive triangles are part of the scene that casts the shadow: what they give is not counted.
    bool counts = light.density <= 0.0 || light.distance == kFarAway;
    float weight = light.density > 0.0 ? balanceWeight(light.density, cosine * kInversePi) : 1.0;
    vec3 share = shareOfLight(light.irradiance * (counts ? cosine * weight : 0.0), all);
    if (kShadows) p = connect(p, s, light, share);
    if (p.phase == kPhaseShadow) {
      p.radiance = p.contribution;
      p.contribution = -p.contribution;
    }
  }
  vec3 lobe = sampleCosineHemisphere(uv.x, uv.y);
  p.direction = vec3(lobe.x, lobe.z, -lobe.y);
  p.origin = offsetOrigin(s.position, s.positionError, s.geometricNormal, p.direction);
  p.density = lobe.z * kInversePi;
  if (kCreases) p.tie = 0.0;
  p.after = kEnvironment && p.density > 0.0 ? kPhaseExtend : kPhaseEnd;
  if (p.phase != kPhaseShadow) p = proceed(p);
  return p;
}

/// The direction drawn has met a surface, or nothing.
Path endShadow(Path p) {
  p.phase = kPhaseEnd;
  if (p.hitSlot < 0) return p;
  bool passes = false;
  if (kAlpha) {
    Surface s = surfaceAt(p.hitSlot, p.hitInstance, p.origin, p.direction, p.hitT, p.hitWeights);
    uint flags = materialFlags(s.material);
    float alpha = alphaAt(s.material, flags, baseColorAt(s.material, s.texcoords, s.color).a);
    passes = passesThrough(flags, alpha, p.numbers, nextCrossing(p));
  }
  if (kAlpha && passes) {
    p.phase = kPhaseExtend;
    return tracePast(p, kFarAway, p.hitT, p.hitSlot);
  }
  vec4 hidden = environmentAlong(p.direction);
  float weight = 1.0;
  if (kEnvironmentSampling)
    weight = balanceWeight(p.density, frame.lightChoice.x * environmentDensity(hidden, p.direction));
  p.radiance += shareOfLight(kPi * weight * hidden.rgb, freeIrradiance(p.origin));
  return p;
}

/// The guides of the catcher, which keep a filter from taking it for empty surroundings: white, and level.
Path guideAtCatcher(Path p) {
  float t = catcherDistance(p.origin, p.direction);
  p = takeGuide(p, t * dot(p.direction, frame.cameraForward.xyz) * frame.cameraForward.w, vec3(0.0, 1.0, 0.0));
  return guideStop(p, vec3(1.0));
}

Path meetCatcher(Path p) {
  if (kFeature == kFeatureGuides) return guideAtCatcher(p);
  if (p.caught) return endShadow(p);
  return beginShadow(p);
}

/// Alpha of the finished sample; of a shadow on the catcher the luminance of the share of light that is not there.
float coverageOf(Path p) {
  if (kShadowCatcher && p.caught) return luminance(p.radiance);
  if (kFeature == kFeatureGuides && kAlpha && !p.covered) return p.shadowOrigin.x;
  return p.covered ? 1.0 : 0.0;
}

/// The finished sample of a path that was caught: what is behind, as far as the light is there.
Path showShadow(Path p) {
  if (!p.caught) return p;
  p.radiance = p.throughput * (vec3(1.0) - p.radiance);
  // The background, with or without a shadow on it, is what the camera sees: emission.
  if (kFeature == kFeatureDiffuse || kFeature == kFeatureSpecular) p.radiance = vec3(0.0);
  return p;
}
