// SPDX-License-Identifier: MIT
// The shadow catcher (kShadowCatcher): a horizontal plane that only camera rays meet, from above. It shows the share of
// the light that the scene hides from it; of glass, what the glass reflects and absorbs. While a path is caught, its
// radiance is that share so far, and its throughput is the radiance that the camera sees behind the plane. Camera rays
// may come through glass (kTransparentGlass).

/// Distance of the catcher along a ray, 0 where there is none.
float catcherDistance(vec3 origin, vec3 direction) {
  float above = origin.y - frame.catcherHeight;
  return above > 0.0 && direction.y < 0.0 ? above / -direction.y : 0.0;
}

/// The distance at which the path's ray meets the catcher before anything else, or else `otherwise`. A path that is
/// caught is there.
float catcherBefore(Path p, float otherwise) {
  if (p.eye.caught) return 0.0;
  if (!p.cameraRay && !(kTransparentGlass && p.eye.clear)) return otherwise;
  float there = catcherDistance(p.ray.origin, p.ray.direction);
  float t = p.hit.slot < 0 ? kFarAway : p.hit.t;
  // The plane is to be nearer than a surface by a margin. So a surface that lies on it is seen.
  return there > 0.0 && there < t * (1.0 - 1e-4) ? there : otherwise;
}

/// The irradiance of the catcher by environment and punctual lights if nothing is in the way.
vec3 freeIrradiance(vec3 point) {
  vec3 sum = frame.catcherIrradiance * frame.environmentScale;
  for (int i = 0; i < punctualLightCount(); ++i) {
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

/// The camera ray meets the catcher. The path takes one light sample, and one direction in which the environment may be
/// hidden.
Path beginShadow(Path p, float t) {
  if (kTransparentGlass) {
    float passed = passedByGlass(p);
    p.throughput *= p.etaScale;
    p.etaScale = passed;
    p.eye.before = p.radiance;
  }
  p.throughput *= seenBehind(p.ray.direction);
  p.radiance = vec3(0.0);
  p.cameraRay = false;
  p.eye.caught = true;
  p.eye.aovWeight = vec3(1.0);
  Surface s;
  s.position = p.ray.origin + t * p.ray.direction;
  s.position.y = frame.catcherHeight;
  s.positionError = max(maxComponent(abs(s.position)), t) * 1e-6;
  s.geometricNormal = vec3(0.0, 1.0, 0.0);
  vec3 all = freeIrradiance(s.position);
  uint dimension = kBounceDimensions * uint(p.bounce + 1);
  vec2 uv = drawPair(p.sampler, dimension + kDirectionDimension);
  if (lightSampleCount() > 0) {
    LightSample light = sampleLight(0, s.position, kNoNormal, p.sampler, dimension + kLightDimension);
    float cosine = max(light.direction.y, 0.0);
    // The scene that casts the shadow includes emissive triangles, so their light does not count.
    bool counts = light.pdf <= 0.0 || light.distance == kFarAway;
    float weight = misWeight(light.pdf, cosine * kInversePi, true);
    vec3 share = shareOfLight(light.irradiance * (counts ? cosine * weight : 0.0), all);
    if (kShadows) p = spawnShadowRay(p, s, light, share);
    if (p.phase == kPhaseConnect) {
      // The hidden share is share * (1 - V), where V is 1 if the shadow ray meets nothing: it begins as `share`, and
      // connected() adds -share where V is 1.
      p.radiance = p.connection.light;
      p.connection.light = -p.connection.light;
    }
  }
  vec3 lobe = sampleCosineHemisphere(uv.x, uv.y);
  p.ray.direction = vec3(lobe.x, lobe.z, -lobe.y);
  p.ray.origin = offsetOrigin(s.position, s.positionError, s.geometricNormal, p.ray.direction);
  p.ray.pdf = lobe.z * kInversePi;
  p.ray.tie = 0.0;
  if (kClearShadows && p.phase != kPhaseConnect) p.connection.light = vec3(1.0);
  p.next = kEnvironment && p.ray.pdf > 0.0 ? kPhaseBegin : kPhaseEnd;
  return p;
}

/// Dims the caught path by what a solid absorbs on its ray's way to a surface that lets it pass.
Path passSolid(Path p, Surface s) {
  uint solid = solidBefore(p.ray.medium, s, false);
  if (solid != kPrimitiveNone)
    p.connection.light *= exp(-(p.hit.t - passedBefore(p)) * materialFloats(solid, kMaterialVolume).rgb);
  if (isSolid(s.material)) p.ray.medium = behindBoundary(p.ray.medium, s);
  return p;
}

/// Returns true if light passes the surface that the caught path's ray has met.
bool passesToCatcher(inout Path p) {
  Surface s = surfaceAt(p.hit.slot, p.hit.instance, p.ray.origin, p.ray.direction, p.hit.t, p.hit.weights, p.time);
  p.connection.light *= clearThrough(s, vec3(baseColorAt(s.material, s.texcoords, s.color)), p.ray.direction);
  if (kAbsorption) p = passSolid(p, s);
  return maxComponent(p.connection.light) > 0.0;
}

/// The ray along the direction drawn has met a surface, or nothing.
Path endShadow(Path p) {
  bool arrives = p.hit.slot < 0;
  if (arrives && !kClearShadows) return p;
  if (kClearShadows && !arrives && passesToCatcher(p)) {
    p.next = kPhasePass;
    return p;
  }
  vec4 hidden = environmentAlong(p.ray.direction);
  float weight = 1.0;
  if (kEnvironmentSampling)
    weight = misWeight(p.ray.pdf, frame.environmentChance * environmentPdf(hidden, p.ray.direction), true);
  vec3 share = shareOfLight(kPi * weight * hidden.rgb, freeIrradiance(p.ray.origin));
  p.radiance += arrives ? share * (vec3(1.0) - p.connection.light) : share;
  return p;
}

Path meetCatcher(Path p, float t) { return p.eye.caught ? endShadow(p) : beginShadow(p, t); }

/// The share of a shadow that a pixel of the whole picture keeps, since it ends before the edge. The outermost pixels
/// have none. Lines of the same share are round at the corners, and bent along an edge, as far as the model leaves room
/// at the sides: a straight border would be seen.
float shadowLeft(ivec2 pixel) {
  vec2 size = vec2(frame.pictureSize);
  vec2 place = vec2(pixel);
  vec2 toEdge = min(place, size - 1.0 - place);
  vec2 width = max(frame.shadowFade * min(size.x, size.y), vec2(0.5));
  vec2 fromMiddle = 1.0 - 2.0 * toEdge / size;
  vec2 bend = min(4.0 * width / size, vec2(1.0)) * fromMiddle * fromMiddle;
  return 1.0 - smoothstep(0.0, 1.0, length(max(1.0 - toEdge / width + bend.yx, vec2(0.0))));
}

/// The alpha of the finished sample. For a shadow on the catcher it is the luminance of the hidden share.
float coverageOf(Path p) {
  if (kShadowCatcher && p.eye.caught) {
    float shadow = luminance(p.radiance);
    return kTransparentGlass ? 1.0 - p.etaScale * (1.0 - shadow) : shadow;
  }
  if (kTransparentGlass && !p.covered) return 1.0 - p.etaScale;
  return float(coveredRays(p)) / float(kCameraRays);
}

/// The finished sample of a path that was caught: the background times the share of light that arrives.
Path showShadow(Path p) {
  if (!p.eye.caught) return p;
  p.radiance = p.throughput * (vec3(1.0) - p.radiance);
  if (kTransparentGlass) p.radiance += p.eye.before;
  // The camera sees the background directly, with or without a shadow on it. So it is emission.
  if (kLobePart) p.radiance = vec3(0.0);
  return p;
}
