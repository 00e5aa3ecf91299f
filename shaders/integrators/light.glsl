// SPDX-License-Identifier: MIT
// Light paths: a lamp or the sun, delta lobes of casters, a rough surface, then any surfaces, the last of
// which is rough and is seen by the camera. Camera paths leave out exactly these (form.glsl). Particles carry flux, so
// glass and shading normals weigh them in another way than camera paths (flux.glsl).

#include "caustics/emit.glsl"

/// The path until the camera sees it.
struct LightPath {
  vec3 flux;
  float range;       // range of the path's punctual light; 0: unlimited
  float travelled;   // distance since the light, up to the surface that was passed last
  bool glassFirst;   // the path has met smooth glass first
  vec2 splatPixel;   // the place in the picture at which the camera sees the point of the shadow ray
  float waiting;     // sum of the light that the camera may see later; one part waits as the shadow ray (reservoir)
  uint chain;        // a hash of the surfaces that it has met, and of their sides
  int singleSided;   // single-sided surfaces met so far that could have scattered it
} fromLight;

/// The camera as seen from a point.
struct SeenFrom {
  vec3 direction;  // towards it
  float distance;
  vec2 place;        // place of the point in the picture, in pixels; y from the bottom
  float importance;  // importance of the light towards the camera, per unit of projected area; 0: not seen
};

/// The panorama or the fisheye as seen from a point.
SeenFrom roundCameraFrom(vec3 point) {
  vec2 whole = vec2(length(frame.cameraRight), length(frame.cameraUp));
  vec3 from = point - frame.cameraPosition;
  SeenFrom c;
  c.distance = length(from);
  vec3 away = from / max(c.distance, 1e-30);
  c.direction = -away;
  vec3 d = vec3(dot(away, frame.cameraRight) / whole.x, dot(away, frame.cameraUp) / whole.y,
                dot(away, frame.cameraForward));
  vec2 place = kPanorama ? panoramaPlace(d) : fisheyePlace(d) / whole;
  float spread = kPanorama ? panoramaSpread(d) : fisheyeSpread(d) * whole.x * whole.y;
  float pixelAngle = 4.0 * spread / (float(frame.pictureSize.x) * float(frame.pictureSize.y));
  bool seen = c.distance > 0.0 && pixelAngle > 0.0 && (kPanorama || withinFisheye(place));
  c.importance = seen ? 1.0 / (pixelAngle * c.distance * c.distance) : 0.0;
  c.place = (0.5 * place + 0.5) * vec2(frame.pictureSize);
  return c;
}

/// lens: a point of the aperture, in local space along right and up. The film is the plane in focus as seen from there
/// (throughLens of camera.glsl).
SeenFrom cameraFrom(vec3 point, vec2 lens) {
  if (kRoundCamera) return roundCameraFrom(point);
  vec3 right = frame.cameraRight;
  vec3 up = frame.cameraUp;
  vec3 forward = frame.cameraForward;
  float focus = kLens && frame.lens.x > 0.0 ? frame.lens.y : 1.0;
  vec3 offset = lens.x * normalize(right) + lens.y * normalize(up);
  float pixelArea = 4.0 * length(right) * length(up) / (float(frame.pictureSize.x) * float(frame.pictureSize.y));
  SeenFrom c;
  vec3 onFilm;  // place on the film, in units of right and up
  if (frame.orthographic != 0.0) {
    // An orthographic camera has no lens.
    onFilm = point - frame.cameraPosition;
    c.distance = dot(onFilm, forward);
    c.direction = -forward;
    c.importance = c.distance > 0.0 ? 1.0 / pixelArea : 0.0;
  } else {
    vec3 from = point - (frame.cameraPosition + offset);
    c.distance = length(from);
    vec3 away = from / max(c.distance, 1e-30);
    float cosine = dot(away, forward);
    c.direction = -away;
    onFilm = (offset + away * (focus / max(cosine, 1e-9))) / focus;
    c.importance = cosine > 1e-9 ? 1.0 / (pixelArea * cosine * cosine * cosine * c.distance * c.distance) : 0.0;
  }
  vec2 place = vec2(dot(onFilm, right) / dot(right, right), dot(onFilm, up) / dot(up, up));
  if (kLensShift) place -= frame.lensShift;
  c.place = (0.5 * place + 0.5) * vec2(frame.pictureSize);
  const float reach = 2.0;  // no pixel filter reaches farther from the middle of its pixel
  bool inside = all(greaterThan(c.place, vec2(-reach))) && all(lessThan(c.place, vec2(frame.pictureSize) + reach));
  if (!inside) c.importance = 0.0;
  return c;
}

int prefixBehind(Path p, Surface s, float pdf, bool straight) { return lightPrefix(p.prefix, pdf == 0.0, straight); }

/// Returns true if --bounces lets a camera path go the same way back.
bool withinBounces(Path p) {
  int most = kTransmission && fromLight.glassFirst ? frame.maxBounces : frame.maxBounces + 1;
  return 1 + limitedScatterings(p) <= most;
}

/// Traces the shadow ray, after which the path ends unless spawnRay() gives it another ray.
Path traceSplat(Path p) {
  p.next = kPhaseEnd;
  p.phase = kPhaseConnect;
  return beginTraversal(p, p.connection.limit);
}

/// f |wi.Ns| |wo.Ng| / |wi.Ng| of the path's light towards wo, which is towards the camera, and the pdf with which a
/// camera path draws wi. The surface is as seen from wo: layers and compensated energy depend on that side alone.
BsdfValue scatteredTowards(Path p, Surface s, SurfaceMaterial m, vec3 wo) {
  bool through = dot(wo, s.geometricNormal) < 0.0;
  s.front = s.front != through;
  s.geometricNormal = through ? -s.geometricNormal : s.geometricNormal;
  s.shadingNormal = through ? -s.shadingNormal : s.shadingNormal;
  Scattering at = scatteringAt(s, m, normalFacing(s, wo), wo);
  vec3 wi = toFrame(at.around, -p.ray.direction);
  bool sameSide = (dot(p.ray.direction, s.geometricNormal) < 0.0) == (wi.z > 0.0);
  BsdfValue value = evaluateBsdf(at.b, at.wo, wi);
  float arriving = max(abs(dot(p.ray.direction, s.geometricNormal)), kLeastCosine);
  value.value *= sameSide ? abs(dot(wo, s.geometricNormal)) / arriving : 0.0;
  return value;
}

/// The factor by which radiance grows on the way of a path from the lamp. etaScale has it.
float radianceScale(Surface s, SurfaceMaterial m, bool transmitted) {
  float squared = m.ior * m.ior;
  return transmitted && m.solid ? (s.front ? squared : 1.0 / squared) : 1.0;
}

/// The camera as seen from a surface; with a lens from a random point of it.
SeenFrom cameraSeen(Path p, Surface s) {
  vec2 lens = vec2(0.0);
  if (kLens && frame.lens.x > 0.0) {
    vec2 uv = drawPair(p.sampler, kBounceDimensions * uint(p.bounce + 1) + kSplatLensDimensions);
    lens = frame.lens.x * sampleAperture(uv.x, uv.y, int(frame.lens.z));
  }
  return cameraFrom(s.position, lens);
}

/// Sets the shadow ray for the light that the camera sees of the path at a rough surface. With wi towards the path and
/// wo towards the camera it is flux * throughput * f(wo, wi) |wi.Ns| * |wo.Ng| / |wi.Ng| * etaScale * importance. The
/// quotient of cosines is there because particles carry flux (Veach, section 5.3). At the first rough surface the ray
/// is traced at once. Later ones share one ray: each takes it with a probability in proportion to its light (reservoir
/// sampling; Chao, A general purpose unequal probability sampling plan, 1982), and the ray then carries the sum.
Path spawnSplatRay(Path p, Surface s, SeenFrom camera, BsdfValue value, bool first) {
  if (value.pdf > kNarrow) return p;
  vec3 light = fromLight.flux * p.throughput * value.value * (p.etaScale * camera.importance);
  uint solid = innermost(solidsTowards(p, s, camera.direction));
  if (kAbsorption && solid != kPrimitiveNone) {
    light *= exp(-camera.distance * materialFloats(solid, kMaterialVolume).rgb);
  }
  float size = maxComponent(light);
  if (!(size > 0.0) || isNonfinite(size)) return p;
  fromLight.waiting += first ? 0.0 : size;
  bool taken = first || pathRandom(p, kSplatDimension) * fromLight.waiting < size;
  if (!taken) return p;
  p.connection.light = first ? light : light / size;
  fromLight.splatPixel = camera.place;
  // The shadow ray starts at the camera, since single-sided surfaces stop light from one side only.
  vec3 target = offsetOrigin(s.position, s.positionError, s.geometricNormal, camera.direction);
  p.connection.origin = s.position + camera.distance * camera.direction;
  vec3 towards = target - p.connection.origin;
  float distance = length(towards);
  p.connection.direction = distance > 0.0 ? towards / distance : -camera.direction;
  p.connection.limit = distance * float(0.99999);
  p.connection.throughGlass = false;
  return first ? traceSplat(p) : p;
}

/// Stores the light of the shadow ray, which nothing blocks.
Path connected(Path p) {
  storeRecord(p.pixel, fromLight.waiting < 0.0, p.connection.light, fromLight.splatPixel);
  return p;
}

/// Returns true if a shadow ray waits for the end of the path.
bool hasMoreRays(Path p) { return fromLight.waiting > 0.0; }

Path nextRay(Path p, ivec2 pixel, uint samples) {
  p.connection.light *= fromLight.waiting;
  fromLight.waiting = -1.0;
  p = traceSplat(p);
  if (kGpu) p = swapRays(p);
  return p;
}

/// Returns true if rays do not see the back of the surface.
bool isSingleSided(uint material, uint flags) {
  bool passes = materialFloats(material, kMaterialSurface).w > 0.0 ||
                (kDiffuseTransmission && materialFloats(material, kMaterialDiffuseTransmission).w > 0.0);
  return kCulling && (flags & kMaterialDoubleSided) == 0u && !passes;
}

/// Continues behind the surface, as if it were not there.
Path passOn(Path p, Surface s, float times) {
  p.throughput *= times;
  fromLight.travelled += p.hit.t;
  p.ray.origin = offsetOrigin(s.position, s.positionError, s.geometricNormal, p.ray.direction);
  if (kCreases) p.ray.tie = s.front ? -kTie : kTie;
  p.next = kPhaseBegin;
  return p;
}

/// The chain of a path once a surface has scattered it. Parts of a surface that face differently count as several: they
/// have virtual images of their own.
uint chainAfter(Path p, Surface s, bool transmitted) {
  uvec3 facing = uvec3(ivec3(round(1.5 * s.shadingNormal)) + 2);
  uint side = facing.x + 8u * facing.y + 64u * facing.z + (transmitted ? 512u : 0u);
  return mixBits(mixBits(fromLight.chain + side) + s.material);
}

/// One step of a light path. Camera paths go the other way: they see single-sided surfaces from the front and pass
/// through the back. So a light path that meets the back ends. One that meets the front is scattered there, and light
/// also passes through; chance takes one of the two.
Path hit(Path p) {
  Surface s = surfaceHit(p);
  uint flags = materialFlags(s.material);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  if (kPassesLight) p = flyTo(p, s);
  bool unlit = isUnlit(s.material);
  bool glossy = isCaster(flags, false);
  bool mirror = isCaster(flags, true);
  bool caster = glossy || mirror;
  bool scattered = p.prefix != kPrefixNone;
  bool singleSided = isSingleSided(s.material, flags);
  if (singleSided && !s.front) return p;
  const float passedOn = 0.125;  // share of the paths that a single-sided surface sends on behind itself
  bool mayScatter = !unlit && (caster || scattered);
  bool passes = singleSided;
  if (singleSided && mayScatter) {
    passes = hashFloat(p.sampler, kPassedOnDimensions + uint(fromLight.singleSided)) < passedOn;
    fromLight.singleSided += 1;
  }
  if (passes) return passOn(p, s, mayScatter ? 1.0 / passedOn : 1.0);
  if (unlit) return p;
  if (singleSided) p.throughput /= 1.0 - passedOn;
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  if (kDispersion) {
    p = disperse(p, m, s.material);
    if (m.solid) m.ior = dispersedIor(p, s.material);
  }
  Scattering at = scatteringAt(s, m, normalFacing(s, -p.ray.direction), -p.ray.direction);

  // Step: find what the surface may do to the path.
  bool glass = kTransmission && at.b.glass > 0.0;
  bool thin = kThinGlass && glass && !m.solid && isSmoothGlass(at.b) && p.ray.medium == kPrimitiveNone;
  vec4 chances = lobeChances(at.b, at.wo.z);
  bool rough = !(mirror || thin) || !at.b.mirrorLike || chances.z + chances.w > 0.0;

  // Step: let the camera see it. The first surface that is all rough has a ray and a record of its own.
  bool first = p.prefix == kPrefixCaustic && !mirror && !thin && fromLight.waiting == 0.0;
  if (storesPhotons && rough && p.prefix == kPrefixCaustic) {
    storePhoton(p.pixel, s.position, -p.ray.direction, maxComponent(fromLight.flux * p.throughput), fromLight.chain);
    return p;
  }
  SeenFrom camera = cameraSeen(p, s);
  bool seen = rough && scattered && camera.importance > 0.0 && withinBounces(p);

  // Step: draw where it goes. Until a rough surface is met, it scatters at casters alone.
  float choice = pathRandom(p, kLobeDimension);
  vec2 uv = drawPair(p.sampler, kBounceDimensions * uint(p.bounce + 1) + kDirectionDimension);
  BsdfSample next = sampleBsdf(at.b, at.wo, choice, uv.x, uv.y);
  bool delta = next.pdf == 0.0;
  bool straight = thin && next.transmitted;
  vec3 direction = normalize(toWorld(at.around, next.wi));
  if (delta) direction = ontoSide(direction, s.geometricNormal, next.transmitted);
  bool wrongSide = (dot(direction, s.geometricNormal) < 0.0) != next.transmitted;
  bool mayGoOn = (caster || thin || scattered) && !wrongSide;
  bool goesOn = mayGoOn && lightScatters(p.prefix, delta, straight, delta ? mirror : glossy);

  // Step: one loop evaluates the surface towards the camera, and along the next direction.
  BsdfValue towards = BsdfValue(vec3(0.0), 0.0);
  BsdfValue along = towards;
  for (int i = seen ? 0 : 1; i < (goesOn && !delta ? 2 : 1); ++i) {
    along = scatteredTowards(p, s, m, i == 0 ? camera.direction : direction);
    if (i == 0) towards = along;
  }
  if (seen) p = spawnSplatRay(p, s, camera, towards, first);
  if (!goesOn) return p;

  // Step: continue.
  vec2 from = vec2(dot(p.ray.direction, s.geometricNormal), at.wo.z);
  vec2 to = vec2(dot(direction, s.geometricNormal), next.wi.z);
  vec3 weight = next.weight * fluxFactor(from, to);
  if (!delta) weight = along.value / (next.pdf * radianceScale(s, m, next.transmitted));
  float survival = delta ? 1.0 : min(1.0, maxComponent(weight));
  if (!delta && pathRandom(p, kSurvivalDimension) >= survival) return p;
  weight /= survival;
  // A ray that goes straight through a thin wall is still that of the lamp.
  if (!straight && p.bounce == p.straightBounces) {
    float travelled = fromLight.travelled + p.hit.t;
    fromLight.flux *= rangeWindow(travelled * travelled, fromLight.range);
  }
  if (p.bounce == 0) fromLight.glassFirst = glass && delta;
  if (!straight) fromLight.chain = chainAfter(p, s, next.transmitted);
  p = spawnRay(p, s, direction, weight, next.pdf, next.transmitted, m);
  if (!withinBounces(p)) p.next = kPhaseEnd;
  return p;
}

float interceptedAt(Path p) { return kFarAway; }

Path intercept(Path p, float t) { return p; }

Path miss(Path p) { return p; }

/// The key of the random numbers of a pass of light paths, which has Sobol points of its own.
uint keyOfPath(ivec2 pixel) { return pixelKey(uint(frame.firstSample), 0xfffffffeu, uint(frame.seed)); }

/// The path's record in the film.
ivec2 placeOf(ivec2 pixel, uint samples) { return recordOf(pixel, samples); }

/// A pass has as many rows of paths as its height asks for, each as wide as the picture.
Path beginPath(ivec2 pixel, uint samples, int steps) {
  ivec2 place = recordOf(pixel, samples);
  storeRecord(place, false, vec3(0.0), vec2(0.0));
  storeRecord(place, true, vec3(0.0), vec2(0.0));
  ivec2 inPass = inPicture(place);
  Sampler sampler = makeSampler(keyOfPath(pixel), uint(inPass.y * frame.pictureSize.x + inPass.x));
  Emission e = drawEmission(sampler);
  Path p = pathAlong(e.origin, e.direction, sampler, steps, kPrimitiveNone);
  p.pixel = place;
  p.cameraRay = false;
  fromLight = LightPath(e.flux, e.range, 0.0, false, vec2(0.0), 0.0, 0u, 0);
  if (maxComponent(e.flux) <= 0.0f) p.phase = kPhaseEnd;
  return p;
}

void suspendOwn(Path p, int row) {
  LightPath l = fromLight;
  pathStates[row] = floatBitsToUint(vec4(l.flux, l.waiting));
  pathStates[row + 1] = floatBitsToUint(vec4(l.splatPixel, l.range, l.travelled));
  pathStates[row + 2] = uvec4(l.chain, uint(l.singleSided), uint(l.glassFirst), 0u);
}

Path resumeOwn(Path p, int row) {
  vec4 a = uintBitsToFloat(readPathStates(row));
  vec4 b = uintBitsToFloat(readPathStates(row + 1));
  uvec4 c = readPathStates(row + 2);
  fromLight = LightPath(a.xyz, b.z, b.w, c.z != 0u, b.xy, a.w, c.x, int(c.y));
  return p;
}

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  film.samples += 1u;
  return film;
}

void countRay(Path p) { countLightRays(1u); }

void countShadowRay() { countSplatRays(1u); }
