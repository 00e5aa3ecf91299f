// SPDX-License-Identifier: MIT
// Global illumination: paths from the camera, with a light sample and a direction of the BSDF at each surface. With an
// AOV of a part of the light (kLightPart), only that part counts.
#include "catcher.glsl"
#include "integrators/camera_rays.glsl"

/// The share of the light that a camera path's first surface scatters from `wi` that belongs to the AOV. all:
/// the BSDF's value for that direction.
vec3 aovShare(Bsdf b, vec3 all, vec3 wo, vec3 wi) {
  vec3 diffuse = diffuseUnderLayers(b, wo, wi);
  vec3 share = clamp(diffuse / max(all, vec3(1e-30)), vec3(0.0), vec3(1.0));
  return kDiffusePart ? share : vec3(1.0) - share;
}

/// The sampler of a light sample. Where the paths of a sample scatter first, their light samples are points of one
/// sequence: nothing else depends on these.
Sampler samplerOfLight(Path p) {
  Sampler s = p.sampler;
  if (kShortRays == 0u || !kSobol || countedScatterings(p) > 0) return s;
  uint index = bitfieldReverse(s.reversed);
  uint earlier = uint(earlierRays(p));
  uint sampleIndex = earlier == kShortRays ? index : (index - kFarHalf) / max(kShortRays, 1u);
  s.reversed = bitfieldReverse(kFarHalf + sampleIndex * uint(kCameraRays) + earlier);
  return s;
}

/// The light sample of a scattering.
LightSample lightAt(Path p, Surface s, SurfaceMaterial m) {
  uint normal = normalOfLight(s, m);
  uint dimension = kBounceDimensions * uint(p.bounce + 1) + kLightDimension;
  if (kNeighbours && p.bounce == 0 && reservoirAt(p.pixel).known) {
    return lightOfNeighbours(p, reservoirAt(p.pixel), s.position, normal);
  }
  if (kCandidates) {
    bool through = takesLightFromBehind(s, m);
    return lightOfCandidates(s.position, s.geometricNormal, through, normal, p.sampler, dimension);
  }
  return sampleLight(0, s.position, normal, samplerOfLight(p), dimension);
}

/// The irradiance of a light sample without the light of lamps and the sun that a glossy caster scatters: light paths
/// bring it.
vec3 irradianceLeft(Path p, Surface s, LightSample light) {
  bool glossy = isCaster(materialFlags(s.material), false);
  if (cameraPrefix(p.prefix, p.bounce == 0, false, false, glossy) != kPrefixCaustic) return light.irradiance;
  bool lamp = light.distance < kFarAway || light.pdf <= 0.0;
  if (kSunPaths && !lamp) {
    vec3 all = vec3(environmentAlong(light.direction));
    return light.irradiance * mapBesideSun(light.direction) / max(all, vec3(1e-30));
  }
  return lamp ? vec3(0.0) : light.irradiance;
}

/// The light of a sample that this path is to find.
vec3 irradianceWanted(Path p, Surface s, SurfaceMaterial m, LightSample light, bool behind) {
  vec3 irradiance = kCaustics ? irradianceLeft(p, s, light) : light.irradiance;
  // Behind glass, a clear path sees the page instead of the surroundings.
  bool hidden = kTransparentGlass && p.eye.clear && m.transmission > 0.0 && behind;
  return hidden && light.pdf > 0.0 && light.distance == kFarAway ? vec3(0.0) : irradiance;
}

/// Sets up the shadow ray of a light sample for which the BSDF has this value.
Path sampleLd(Path p, Surface s, Scattering at, LightSample light, vec3 wi, BsdfValue value) {
  bool sameSide = (dot(light.direction, s.geometricNormal) > 0.0) == (wi.z > 0.0);
  float weight = lightWeight(light, value.pdf / lightSamplesAt(countedScatterings(p)));
  if (kLightPart && p.bounce == 0) p.eye.aovWeight = aovShare(at.b, value.value, at.wo, wi);
  if (kThroughGlass) p.connection.throughGlass = passesGlass(p, s, light.direction);
  return spawnShadowRay(p, s, light, sameSide ? p.throughput * light.irradiance * value.value * weight : vec3(0.0));
}

/// The chance that guiding draws the direction of a path. It has none where it draws delta lobes alone.
float guidingChance(Path p, Bsdf b, float cosine) {
  vec4 chances = lobeChances(b, cosine);
  bool guidable = casterCount > 0 && p.bounce > 0 && isGuidable(p.prefix);
  return guidable ? 0.5 * (b.mirrorLike ? min(1.0, chances.z + chances.w) : 1.0) : 0.0;
}

/// How guiding takes part in drawing a direction.
struct Guiding {
  bool possible;  // in some cell
  float chance;   // in this cell
  uint cell;
  bool taken;      // it has drawn the direction
  vec3 direction;  // in local space
};

/// A guiding direction by its chance, or else the BSDF's own.
Guiding guided(Path p, Surface s, Scattering at, inout BsdfSample next, vec2 uv) {
  Guiding g;
  g.chance = guidingChance(p, at.b, at.wo.z);
  g.possible = g.chance > 0.0;
  g.cell = 0u;
  // llvmpipe executes a branch that no lane takes, but not an iteration.
  for (int i = g.chance > 0.0 ? 0 : 1; i < 1; ++i) g.cell = guidingCell(s.position);
  if (!hasGuiding(g.cell)) g.chance = 0.0;
  float choice = pathRandom(p, kGuidingDimension);
  g.taken = choice < g.chance;
  g.direction = toWorld(at.around, next.wi);
  for (int i = g.taken ? 0 : 1; i < 1; ++i) {
    g.direction = guidingDirection(s.position, g.cell, choice / g.chance, uv);
    next.wi = toFrame(at.around, g.direction);
    next.transmitted = next.wi.z < 0.0;
    next.pdf = kUnweighed;
  }
  return g;
}

/// Lobes that are no delta lobes are weighted by the pdf of both; next.pdf stays that of the BSDF, by which light
/// samples are weighted.
BsdfSample weighedByBoth(inout Path p, Surface s, BsdfSample next, Guiding g) {
  bool delta = !g.taken && next.pdf == 0.0;
  if (g.taken) next.pdf = max(next.pdf, float(1e-30));
  if (g.possible && !delta) p.prefix = g.taken ? kPrefixGuided : kPrefixNone;
  for (int i = g.chance > 0.0 ? 0 : 1; i < 1; ++i) {
    float pdf = (1.0 - g.chance) * next.pdf + g.chance * guidingPdf(s.position, g.cell, g.direction);
    next.weight *= delta ? 1.0 / (1.0 - g.chance) : next.pdf / pdf;
  }
  return next;
}

/// Returns true if glass is to draw both its lobes often: the path has met glass alone, so no light path brings the
/// lamp that it may see. Each time makes what lies behind the glass noisier.
bool sharesGlass(Path p) {
  bool glassAlone = p.prefix == kPrefixNone && p.freeBounces == p.bounce;
  return casterCount > 0 && glassAlone && p.bounce < 4;
}

/// More lobes than a diffuse and a specular one. One loop evaluates them for both directions of a surface, since
/// compilers inline each call. Fewer are sooner evaluated by two calls.
const bool kManyLobes = kTransmission || kClearcoat || kSheen || kDiffuseTransmission;

/// The path-traced material: one light sample, and one direction drawn from the BSDF.
Path shadeGlobal(Path p, Surface s, SurfaceMaterial m, vec3 normal) {
  if (kDispersion) {
    p = disperse(p, m, s.material);
    if (m.solid) m.ior = dispersedIor(p, s.material);
  }
  Scattering at = scatteringAt(s, m, normal, -p.ray.direction);
  if (kCaustics) at.b.sharesGlass = sharesGlass(p);
  uint dimension = kBounceDimensions * uint(p.bounce + 1);
  // The numbers of this bounce are drawn before it is counted.
  float choice = kPassesLight ? pathRandom(p, kLobeDimension) : 0.0;
  vec2 uv = drawPair(p.sampler, dimension + kDirectionDimension);
  LightSample light = noLight();
  if (lightSampleCount() > 0) light = lightAt(p, s, m);
  vec3 wi = toFrame(at.around, light.direction);
  light.irradiance = irradianceWanted(p, s, m, light, wi.z * at.wo.z < 0.0);
  BsdfSample next = drawBsdf(at.b, at.wo, choice, uv.x, uv.y);
  Guiding g;
  if (kGuided) g = guided(p, s, at, next, uv);
  BsdfValue towards = BsdfValue(vec3(0.0), 0.0);
  BsdfValue along = towards;
  bool lit = maxComponent(light.irradiance) > 0.0;
  for (int i = lit ? 0 : 1; kManyLobes && i < (next.pdf < 0.0 ? 2 : 1); ++i) {
    along = evaluateBsdf(at.b, at.wo, i == 0 ? wi : next.wi);
    if (i == 0) towards = along;
  }
  if (!kManyLobes && lightSampleCount() > 0) towards = evaluateBsdf(at.b, at.wo, wi);
  if (!kManyLobes && next.pdf < 0.0) along = evaluateBsdf(at.b, at.wo, next.wi);
  if (lightSampleCount() > 0) p = sampleLd(p, s, at, light, wi, towards);
  if (next.pdf < 0.0) next = weighed(next, along);
  if (kGuided) next = weighedByBoth(p, s, next, g);
  if (kLightPart && p.bounce == 0) {
    bool delta = next.pdf == 0.0;
    vec3 share = vec3(kDiffusePart ? 0.0 : 1.0);
    p.eye.aovWeight = delta ? share : aovShare(at.b, along.value, at.wo, next.wi);
  }
  vec3 direction = normalize(toWorld(at.around, next.wi));
  if (kSpecular && next.pdf == 0.0) direction = ontoSide(direction, s.geometricNormal, next.transmitted);
  bool wrongSide = (dot(direction, s.geometricNormal) < 0.0) != next.transmitted;
  return spawnRay(p, s, direction, wrongSide ? vec3(0.0) : next.weight, next.pdf, next.transmitted, m);
}

Path beginPath(ivec2 pixel, uint samples, int steps) { return cameraPath(pixel, samples, steps); }

float interceptedAt(Path p) {
  float t = kMedia && p.hit.slot < 0 ? p.hit.t : kFarAway;
  return kShadowCatcher ? catcherBefore(p, t) : t;
}

Path intercept(Path p, float t) {
  if (kShadowCatcher && (!kMedia || t != p.hit.t)) return meetCatcher(p, t);
  if (kMedia) return scatterInMedium(p);
  return p;
}

Path miss(Path p) { return meetSurroundings(p); }

Path hit(Path p) {
  Surface s = surfaceHit(p);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  if (kPassesLight) p = flyTo(p, s);
  if (kMedia && p.hit.slot < 0) return scatterInMedium(p);
  if (!arrives(p, s, baseColor)) return p;
  return shadeGlobal(p, s, materialAt(s.material, baseColor, s.texcoords), normalFacing(s, -p.ray.direction));
}

void suspendOwn(Path p, int row) {
  if (kLightPart) pathStates[row] = uvec4(floatBitsToUint(p.eye.aovWeight), 0u);
  if (kTransparentGlass) pathStates[row + 1] = uvec4(floatBitsToUint(p.eye.before), 0u);
}

Path resumeOwn(Path p, int row) {
  if (kLightPart) p.eye.aovWeight = uintBitsToFloat(readPathStates(row).xyz);
  if (kTransparentGlass) p.eye.before = uintBitsToFloat(readPathStates(row + 1).xyz);
  return p;
}

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) {
  if (kShadowCatcher && p.eye.caught && frame.shadowFade != vec2(0.0)) p.radiance *= shadowLeft(inPicture(pixel));
  float alpha = coverageOf(p);
  if (kShadowCatcher) {
    p = showShadow(p);
    if (frame.backgroundShows < 0.0) film.flags |= kPixelOverWhite;
  }
  return addSample(film, p.radiance, alpha);
}
