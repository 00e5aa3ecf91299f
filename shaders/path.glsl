// SPDX-License-Identifier: MIT
// What integrators share of a path: how it begins at the camera, scatters, and meets emission and surroundings.

/// Decides by chance what alpha lets pass of the ray that is traced next.
Path withChances(Path p) {
  p.traversal.chances = chancesOf(p.sampler, p.bounce);
  p.traversal.time = p.time;
  return p;
}

/// Starts a traversal of a ray up to its limit, keeping the step count of this draw.
Path beginTraversal(Path p, float limit) {
  int steps = p.traversal.steps;
  p.traversal = startTraversal(limit, frame.leafCount);
  if (kMoving) p.traversal = beginAt(p.traversal, momentAt(p.time, frame.segments.x), frame.segments.y);
  p.traversal.steps = steps;
  return p;
}

/// Exchanges the path's ray and its shadow ray (kGpu): there what is traced lies in p.ray, and the other one waits. A
/// choice between both in each round takes 8 registers and more.
Path swapRays(Path p) {
  vec3 origin = p.ray.origin;
  vec3 direction = p.ray.direction;
  p.ray.origin = p.connection.origin;
  p.ray.direction = p.connection.direction;
  p.connection.origin = origin;
  p.connection.direction = direction;
  return p;
}

/// The place of a pixel of the film in the picture; y from the bottom.
ivec2 inPicture(ivec2 pixel) { return pixel + frame.filmOffset; }

/// The key of the random numbers of a pixel of the film.
uint keyOfPixel(ivec2 pixel) {
  ivec2 place = inPicture(pixel);
  return pixelKey(uint(place.x), uint(frame.pictureSize.y - 1 - place.y), uint(frame.seed));
}

/// A path that begins with a ray inside of solids.
Path pathAlong(vec3 origin, vec3 direction, Sampler sampler, int steps, uint solids) {
  Path p = newPath(origin, direction, sampler);
  p.traversal.steps = steps;
  if (kTimed) p.time = kIdAov ? 0.5 : timeOf(sampler);
  if (kNestedSolids && solids >> 16 != kNoSolid) p = standInside(p, solids >> 16);
  if (kPassesLight && solids != kPrimitiveNone) p = standInside(p, innermost(solids));
  return p;
}

/// The ray of a panorama or a fisheye.
CameraRay roundCameraRay(vec2 point) {
  vec2 angles = point * vec2(length(frame.cameraRight), length(frame.cameraUp));
  vec3 d = kPanorama ? panoramaDirection(point.x, point.y) : fisheyeDirection(angles.x, angles.y);
  CameraRay r;
  r.origin = frame.cameraPosition;
  r.direction = normalize(d.x * normalize(frame.cameraRight) + d.y * normalize(frame.cameraUp) +
                          d.z * frame.cameraForward);
  return r;
}

/// Returns true if the point of the picture lies in the circle of the fisheye, which touches the nearer edges.
bool withinFisheye(vec2 point) {
  vec2 whole = vec2(length(frame.cameraRight), length(frame.cameraUp));
  return length(point * whole) <= min(whole.x, whole.y);
}

/// Camera rays that do not continue have numbers from the far half of the sequence. The one that continues has those of
/// a sample with one ray, so that its numbers of all samples are stratified together.
const uint kFarHalf = 0x80000000u;
const uint kShortRays = uint(kCameraRays) - 1u;

bool isShort(int earlier) { return uint(earlier) < kShortRays; }

/// The index in the sequence of a sample's camera ray that has so many earlier ones.
uint indexOfRay(uint sampleIndex, int earlier) {
  return isShort(earlier) ? kFarHalf + sampleIndex * kShortRays + uint(earlier) : sampleIndex;
}

/// Starts with the camera ray that has so many earlier ones in its sample.
Path startPath(ivec2 pixel, uint key, uint sampleIndex, int earlier, int steps) {
  Sampler sampler = makeSampler(key, indexOfRay(sampleIndex, earlier));
  vec2 place = vec2(inPicture(pixel)) + 0.5;
  if (!kIdAov) {
    vec2 jitter = drawPair(sampler, kCameraDimensions);
    // A coarse picture's first sample is in the middle: edges with chance would be ragged.
    bool middle = frame.firstInMiddle > 0.0 && sampleIndex == uint(frame.firstSample);
    // This is the box filter; the text of the others is left out with the branch.
    vec2 offset = jitter - 0.5;
    if (kPixelFilter != kBoxFilter) offset = samplePixelFilter(kPixelFilter, jitter.x, jitter.y);
    if (!middle) place += offset;
  }
  vec2 point = place / vec2(frame.pictureSize) * 2.0 - 1.0;
  if (kLensShift) point += frame.lensShift;
  CameraRay ray;
  if (kRoundCamera) {
    ray = roundCameraRay(point);
  } else {
    ray = makeCameraRay(frame.cameraPosition, frame.cameraRight, frame.cameraUp,
                        frame.cameraForward, frame.orthographic != 0.0, point.x, point.y);
  }
  if (kLens && !kIdAov && frame.lens.x > 0.0) {
    vec2 uv = drawPair(sampler, kLensDimensions);
    vec2 lens = frame.lens.x * sampleAperture(uv.x, uv.y, int(frame.lens.z));
    ray = throughLens(ray, frame.cameraRight, frame.cameraUp, frame.cameraForward, lens, frame.lens.y);
  }
  if (kMovingCamera && !kIdAov) ray = carried(cameraAt(timeOf(sampler)), ray);
  // Outside of the fisheye's circle the ray goes up from above all, and meetSurroundings() gives it no light.
  if (kFisheye && !withinFisheye(point)) ray = CameraRay(vec3(0.0, kAboveAll, 0.0), vec3(0.0, 1.0, 0.0));
  Path p = pathAlong(ray.origin, ray.direction, sampler, steps, frame.cameraSolids);
  if (kRayCones) p.ray.cone = cameraCone(p);
  p.pixel = pixel;
  p.throughput = vec3(1.0 / float(kCameraRays));
  return p;
}

/// Adds light, or the share of it that belongs to the AOV.
Path addLight(Path p, vec3 light) {
  p.radiance += kLightPart ? p.eye.aovWeight * light : light;
  return p;
}

/// Clamps light that came over more than one scattering (one is direct light). The result is biased.
vec3 clampIndirect(vec3 light, int scatterings) {
  if (!kClampIndirect || scatterings < 2) return light;
  return light * min(1.0, intBitsToFloat(frame.clampBits) / max(maxComponent(light), 1e-30));
}

/// Scatterings that --bounces limits. Those at smooth glass end by roulette alone: a thick rim or nested glasses take
/// dozens.
int limitedScatterings(Path p) { return p.bounce - p.freeBounces; }

/// The scatterings that --clamp-indirect counts. Light straight through thin walls counts as if there were no walls.
int countedScatterings(Path p) { return kThroughGlass ? p.bounce - p.straightBounces : p.bounce; }

/// Returns true if the shadow ray of a light sample passes smooth glass that does not bend it. It does where the path
/// itself could go there, and continue behind it. Inside of a solid it does not: paths there lose light at each wall.
bool passesGlass(Path p, Surface s, vec3 direction) {
  return isOpen(solidsTowards(p, s, direction)) && limitedScatterings(p) < frame.maxBounces;
}

/// The radiance that the camera sees where its ray meets nothing.
vec3 seenBehind(vec3 direction) {
  if (!kEnvironment || frame.backgroundShows <= 0.0) return frame.background;
  if (kBackdrop) return backdropAlong(direction);
  return environmentAlong(direction).rgb;
}

/// The part of the page's light that reaches the camera through the glass on the way of a clear path.
float passedByGlass(Path p) { return dot(p.throughput, vec3(1.0 / 3.0)) * p.etaScale; }

/// A clear path has met nothing: it shows the page. From here on `etaScale` is the part of it that is seen.
Path seePage(Path p) {
  p = addLight(p, p.throughput * p.etaScale * seenBehind(p.ray.direction));
  p.etaScale = passedByGlass(p);
  p.covered = false;
  return p;
}

/// The path's ray has met nothing.
Path meetSurroundings(Path p) {
  if (kFisheye && p.cameraRay && p.ray.origin.y == kAboveAll) return p;
  if (p.cameraRay) return addLight(p, p.throughput * seenBehind(p.ray.direction));
  if (kTransparentGlass && p.eye.clear) return seePage(p);
  if (!kEnvironment) return p;
  // Surroundings are outside of everything: who has left less than was entered has missed a face that touches another.
  if (kPassesLight) p.throughput *= p.etaScale;
  // Light paths bring the sun.
  vec4 seen = environmentAlong(p.ray.direction);
  if (kSunPaths && p.prefix == kPrefixCaustic) seen.rgb = mapBesideSun(p.ray.direction);
  float weight = 1.0;
  if (kEnvironmentSampling && p.ray.pdf > 0.0) {
    float samples = lightSamplesAt(countedScatterings(p) - 1);
    float other = samples * frame.environmentChance * environmentPdf(seen, p.ray.direction);
    weight = misWeight(p.ray.pdf, other, true);
  }
  return addLight(p, clampIndirect(p.throughput * (weight * seen.rgb), countedScatterings(p)));
}

/// Returns true if light may come through the surface.
bool takesLightFromBehind(Surface s, SurfaceMaterial m) {
  if (m.transmission > 0.0) return true;
  return kDiffuseTransmission && materialFloats(s.material, kMaterialDiffuseTransmission).w > 0.0;
}

/// The normal by which the light tree chooses lights for a surface: none where light comes through.
uint normalOfLight(Surface s, SurfaceMaterial m) {
  if (kLightTree && !takesLightFromBehind(s, m)) return packNormal(s.geometricNormal);
  return kNoNormal;
}

/// Returns true if a lobe of a material with these flags makes caustics.
bool isCaster(uint flags, bool delta) { return (flags & (delta ? kMaterialCaster : kMaterialGlossyCaster)) != 0u; }

/// The probability to survive roulette: the throughput as seen from outside of all solids, at most `most`. Late paths
/// have less than 1: light may lose nothing in a closed box.
float survivalOf(Path p, float most) {
  float late = p.bounce >= kLatestRoulette ? min(most, 0.999) : most;
  return min(maxComponent(p.throughput) * p.etaScale, late);
}

/// The prefix of a path that a surface has scattered; the integrator's.
int prefixBehind(Path p, Surface s, float pdf, bool straight);

/// Sets where the path continues from the surface. `weight` multiplies the throughput, and zero ends the path.
Path spawnRay(Path p, Surface s, vec3 direction, vec3 weight, float pdf, bool transmitted, SurfaceMaterial m) {
  p.throughput *= weight;
  bool deltaGlass = atDeltaGlass(m, pdf);
  bool straight = goesStraight(p.ray.medium, s, m, deltaGlass, transmitted);
  // The last camera ray of a sample alone continues, for all.
  if (kCameraRays > 1 && countedScatterings(p) == 0 && !straight)
    p.throughput *= isShort(earlierRays(p)) ? 0.0 : float(kCameraRays);
  bool ends = maxComponent(p.throughput) <= 0.0;
  if (transmitted && m.solid) {
    p.ray.medium = behindBoundary(p.ray.medium, s);
    float squared = m.ior * m.ior;
    float before = p.etaScale;
    p.etaScale = s.front ? before * squared : max(before / squared, 1.0);
    // No index is below that of air. A path that would get below it has missed a face that touches another one, so the
    // scale ends at 1. The weight holds the whole factor, which is corrected here.
    if (!s.front) p.throughput *= before / (squared * p.etaScale);
  }
  p.bounce += 1;
  p.freeBounces += deltaGlass ? 1 : 0;
  // At smooth glass roulette begins by kLatestRoulette in any stage: nothing else ends a ray trapped inside.
  bool roulette = (kGi || deltaGlass) && kDrawsLight &&
                  p.bounce >= (deltaGlass ? min(frame.rouletteDepth, kLatestRoulette) : frame.rouletteDepth);
  // A path that guiding has aimed carries little, but goes where light comes from.
  bool isGuided = kGuided && p.prefix == kPrefixGuided;
  // Paths through smooth glass that absorbs nothing get fewer by a factor from each scattering to the next; were that
  // factor above the survival, their variance would be infinite.
  float most = deltaGlass ? 0.99 : isGuided ? 0.95 : 1.0;
  float survival = isGuided ? most : survivalOf(p, most);
  uint rouletteDimension = kBounceDimensions * uint(p.bounce) + kRouletteDimension;
  if (roulette && drawFloat(p.sampler, rouletteDimension) >= survival) ends = true;
  if (roulette) p.throughput /= survival;
  p.cameraRay = false;
  p.eye.clear = p.eye.clear && transmitted && m.transmission > 0.0;
  if (kCaustics) p.prefix = prefixBehind(p, s, pdf, straight);
  // Straight through a thin wall the path keeps its ray, and the pdf that light sampling shares with it.
  p.straightBounces += straight ? 1 : 0;
  p.next = ends ? kPhaseEnd : straight ? kPhasePass : kPhaseBegin;
  if (straight) return p;
  if (kRayCones) p.ray.cone = scatteredCone(p, pdf, transmitted);
  p.ray.pdf = pdf;
  p.ray.normal = normalOfLight(s, m);
  p.ray.origin = offsetOrigin(s.position, s.positionError, s.geometricNormal, direction);
  p.ray.direction = direction;
  // At a sharp edge, rounding decides which of two faces a ray hits first. A ray that has left a front is to meet a
  // front.
  if (kCreases) p.ray.tie = (dot(direction, s.geometricNormal) > 0.0) == s.front ? kTie : -kTie;
  return p;
}

/// The MIS weight, against light sampling, of the emission that the path's ray has hit: 1 if no light sample finds it.
float weightOfEmission(Path p, Surface s, float cosine) {
  if (!kEmissiveTriangles || !s.emitter || p.ray.pdf <= 0.0) return 1.0;
  int slot = kMoving ? slotInFirst(p.hit.slot, p.time) : p.hit.slot;
  float pdf = kLightTree ? treePdf(slot, p.ray.origin, p.ray.normal, p.hit.t, cosine)
                         : emitterPdf(s.material, p.hit.t, cosine);
  return misWeight(p.ray.pdf, lightSamplesAt(countedScatterings(p) - 1) * pdf, false);
}

/// Emission of the point hit, weighted against light sampling.
vec3 emittedAt(Path p, Surface s) {
  if (!s.front && (materialFlags(s.material) & kMaterialDoubleSided) == 0u) return vec3(0.0);
  // Light paths bring it.
  bool sampled = kEmissiveTriangles && s.emitter && materialFloats(s.material, kMaterialMaps).z > 0.0;
  if (kCaustics && sampled && p.prefix == kPrefixCaustic) return vec3(0.0);
  float cosine = abs(dot(s.geometricNormal, p.ray.direction));
  // The weight comes first: compilers for Intel spill less.
  float weight = weightOfEmission(p, s, cosine);
  vec3 radiance = emissionAt(s.material, s.texcoords);
  if (kClearcoat) radiance *= emissionUnderCoat(s.material, s.texcoords, cosine);
  return radiance * weight;
}

/// Sets up the shadow ray of a light sample of a point that would add `value`; without shadows it is added at once. The
/// ray begins at `origin`, next to the point.
Path spawnShadowRayFrom(Path p, vec3 point, vec3 origin, LightSample light, vec3 value) {
  bool lit = maxComponent(value) > 0.0;
  if (!kShadows && !lit) return p;
  value = clampIndirect(value, countedScatterings(p) + 1);
  p.connection.light = kLightPart ? p.eye.aovWeight * value : value;
  p.connection.origin = origin;
  p.connection.direction = light.direction;
  p.connection.limit = kFarAway;
  if (!kShadows) {
    if (kDims) p = dimShadow(p, innermost(p.connection.medium), 0.0, light.distance);
    p.radiance += p.connection.light;
    return p;
  }
  if (light.distance < kFarAway) {
    // The ray begins next to the point, and is aimed again: near a light, a parallel one would end behind it.
    vec3 towards = light.distance * light.direction - (origin - point);
    float distance = length(towards);
    p.connection.direction = distance > 0.0 ? towards / distance : light.direction;
    // The light's own surface is kept out by a relative margin above the rounding of the point chosen on it.
    p.connection.limit = distance * float(0.9999);
  }
  if (kDims && !kDimsLate) p = dimShadow(p, innermost(p.connection.medium), 0.0, p.connection.limit);
  if (lit) p.phase = kPhaseConnect;
  return beginTraversal(p, p.connection.limit);
}

/// Returns the same of a point of a surface.
Path spawnShadowRay(Path p, Surface s, LightSample light, vec3 value) {
  if (kDims) p.connection.medium = solidsTowards(p, s, light.direction);
  vec3 origin = offsetOrigin(s.position, s.positionError, s.geometricNormal, light.direction);
  return spawnShadowRayFrom(p, s.position, origin, light, value);
}
