// SPDX-License-Identifier: MIT
// The steps where a ray hits: alpha, absorption, emission, then a light sample, then the next ray. Stages before gi
// visit a hit once for each of their light samples.

/// The base of the material, without its compensation.
Bsdf baseBsdf(SurfaceMaterial m, bool front) {
  Bsdf b;
  b.baseColor = m.baseColor;
  b.dielectricF0 = m.dielectricF0;
  b.dielectricF90 = m.specular;
  b.metal = kMetals ? m.metallic : 0.0;
  b.glass = kTransmission ? (1.0 - b.metal) * m.transmission : 0.0;
  b.opaque = 1.0 - b.metal - b.glass;
  b.alpha = m.roughness * m.roughness;
  b.mirrorLike = b.alpha < kMirrorAlpha;
  b.solid = m.solid;
  b.glassLost = 0.0;
  b.sharesGlass = false;
  b.eta = front ? m.ior : 1.0 / m.ior;
  return b;
}

/// The share of the light on rough glass that single scattering loses, seen at `cosine`. A thin wall spreads light both
/// ways as a mirror of its roughness does.
float glassLostAt(Bsdf b, Surface s, float cosine) {
  if (b.glass <= 0.0 || isSmoothGlass(b)) return 0.0;
  if (!b.solid) return ggxLoss(cosine, b.alpha);
  int table = int(materialFloats(s.material, kMaterialVolume).w) - 1;
  return max(0.0, 1.0 - glassAlbedo(table, s.front, cosine, b.alpha));
}

/// A path that meets dispersive glass goes on for one of red, green and blue, which stands for all three.
Path disperse(Path p, SurfaceMaterial m, uint material) {
  if (p.oneChannel || !m.solid || m.transmission * (1.0 - m.metallic) <= 0.0) return p;
  if (materialFloats(material, kMaterialClearcoat).w <= 0.0) return p;
  int channel = pathChannel(p);
  p.throughput *= 3.0 * vec3(channel == 0 ? 1.0 : 0.0, channel == 1 ? 1.0 : 0.0, channel == 2 ? 1.0 : 0.0);
  p.oneChannel = true;
  return p;
}

/// The share of the light that a camera path's first surface scatters from `wi` that belongs to the AOV.
vec3 aovShare(Bsdf b, vec3 wo, vec3 wi) {
  vec3 all = evaluateBsdf(b, wo, wi).value;
  vec3 diffuse = diffuseUnderLayers(b, wo, wi);
  vec3 share = clamp(diffuse / max(all, vec3(1e-30)), vec3(0.0), vec3(1.0));
  return kAov == kAovDiffuse ? share : vec3(1.0) - share;
}

/// The BSDF at a point of a surface as seen from a direction, in its frame.
struct Scattering {
  Bsdf b;
  Frame3 around;
  vec3 wo;
};

Scattering scatteringAt(Surface s, SurfaceMaterial m, vec3 normal, vec3 wo) {
  Scattering at;
  vec3 anisotropy = kAnisotropy ? anisotropyAt(s.material, s.texcoords) : vec3(0.0);
  at.around = kAnisotropy ? frameAlong(s, normal, anisotropy.xy) : frameAround(normal);
  at.b = compensate(addLayers(baseBsdf(m, s.front), s, at.around, wo, anisotropy.z));
  at.b.faceNormal = toFrame(at.around, s.geometricNormal);
  at.b.vertexNormal = toFrame(at.around, s.shadingNormal);
  at.wo = toFrame(at.around, wo);
  if (kGlassTables) at.b.glassLost = glassLostAt(at.b, s, at.wo.z);
  return at;
}

/// The sampler of a light sample. Where the paths of a sample scatter first, their light samples are points of one
/// sequence: nothing else depends on these.
Sampler samplerOfLight(Path p) {
  Sampler s = p.sampler;
  if (kCameraRays == 1 || !kSobol || countedScatterings(p) > 0) return s;
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

/// Takes one light sample, and sets up its shadow ray.
Path sampleLd(Path p, Surface s, SurfaceMaterial m, Scattering at) {
  LightSample light = lightAt(p, s, m);
  if (kCaustics) light.irradiance = irradianceLeft(p, s, light);
  vec3 wi = toFrame(at.around, light.direction);
  // Behind glass, a clear path sees the page instead of the surroundings.
  bool hidden = kTransparentGlass && p.clear && m.transmission > 0.0 && wi.z * at.wo.z < 0.0;
  if (hidden && light.pdf > 0.0 && light.distance == kFarAway) light.irradiance = vec3(0.0);
  bool sameSide = (dot(light.direction, s.geometricNormal) > 0.0) == (wi.z > 0.0);
  BsdfValue value = evaluateBsdf(at.b, at.wo, wi);
  float weight = lightWeight(light, value.pdf / lightSamplesAt(countedScatterings(p)));
  if (kLightPart && p.bounce == 0) p.aovWeight = aovShare(at.b, at.wo, wi);
  if (kThroughGlass) p.throughGlass = passesGlass(p, s, light.direction);
  return spawnShadowRay(p, s, light, sameSide ? p.throughput * light.irradiance * value.value * weight : vec3(0.0));
}

/// The chance that guiding draws the direction of a path. It has none where it draws delta lobes alone.
float guidingChance(Path p, Bsdf b, float cosine) {
  vec4 chances = lobeChances(b, cosine);
  bool guidable = casterCount > 0 && p.bounce > 0 && isGuidable(p.prefix);
  return guidable ? 0.5 * (b.mirrorLike ? min(1.0, chances.z + chances.w) : 1.0) : 0.0;
}

/// A guiding direction by that chance, or else the BSDF's own. Lobes that are no delta lobes are weighted by the
/// pdf of both; next.pdf stays that of the BSDF, by which light samples are weighted.
BsdfSample guided(inout Path p, Surface s, Scattering at, BsdfSample next, uint cell, float chance, vec2 uv) {
  float choice = pathRandom(p, kGuidingDimension);
  bool taken = choice < chance;
  bool delta = !taken && next.pdf == 0.0;
  vec3 direction = toWorld(at.around, next.wi);
  if (taken) {
    direction = guidingDirection(s.position, cell, choice / chance, uv);
    next.wi = toFrame(at.around, direction);
    BsdfValue value = evaluateBsdf(at.b, at.wo, next.wi);
    next.transmitted = next.wi.z < 0.0;
    next.pdf = max(value.pdf, float(1e-30));
    next.weight = value.pdf > 0.0 ? value.value / value.pdf : vec3(0.0);
  }
  float pdf = (1.0 - chance) * next.pdf + chance * guidingPdf(s.position, cell, direction);
  next.weight *= delta ? 1.0 / (1.0 - chance) : next.pdf / pdf;
  if (!delta) p.prefix = taken ? kPrefixGuided : kPrefixNone;
  return next;
}

/// Glass draws both its lobes often in so many scatterings of a camera path. Each makes what lies behind it noisier.
const int kSharedScatterings = 4;

/// Returns true if glass is to draw both its lobes often: the path has met glass alone, so no light path brings the
/// lamp that it may see.
bool sharesGlass(Path p) {
  bool glassAlone = p.prefix == kPrefixNone && p.freeBounces == p.bounce;
  return casterCount > 0 && glassAlone && p.bounce < kSharedScatterings;
}

/// The path-traced material: one light sample, and one direction drawn from the BSDF.
Path shadeGlobal(Path p, Surface s, SurfaceMaterial m, vec3 normal) {
  if (kDispersion) {
    p = disperse(p, m, s.material);
    if (m.solid) m.ior = dispersedIor(p, s.material);
  }
  Scattering at = scatteringAt(s, m, normal, -p.direction);
  if (kCaustics && !kLightPaths) at.b.sharesGlass = sharesGlass(p);
  Frame3 around = at.around;
  Bsdf b = at.b;
  vec3 wo = at.wo;
  uint dimension = kBounceDimensions * uint(p.bounce + 1);
  // The numbers of this bounce are drawn before it is counted.
  float choice = kPassesLight ? pathRandom(p, kLobeDimension) : 0.0;
  vec2 uv = drawPair(p.sampler, dimension + kDirectionDimension);
  if (lightSampleCount() > 0) p = sampleLd(p, s, m, at);
  BsdfSample next = sampleBsdf(b, wo, choice, uv.x, uv.y);
  if (kGuided) {
    // llvmpipe executes a branch that no lane takes, but not an iteration.
    float chance = guidingChance(p, b, wo.z);
    if (chance > 0.0 && next.pdf > 0.0) p.prefix = kPrefixNone;
    uint cell = 0u;
    for (int i = chance > 0.0 ? 0 : 1; i < 1; ++i) cell = guidingCell(s.position);
    if (!hasGuiding(cell)) chance = 0.0;
    for (int i = chance > 0.0 ? 0 : 1; i < 1; ++i) next = guided(p, s, at, next, cell, chance, uv);
  }
  if (kLightPart && p.bounce == 0) {
    bool delta = next.pdf == 0.0;
    p.aovWeight = delta ? vec3(kAov == kAovSpecular ? 1.0 : 0.0) : aovShare(b, wo, next.wi);
  }
  vec3 direction = normalize(toWorld(around, next.wi));
  if (kSpecular && next.pdf == 0.0) direction = ontoSide(direction, s.geometricNormal, next.transmitted);
  bool wrongSide = (dot(direction, s.geometricNormal) < 0.0) != next.transmitted;
  return spawnRay(p, s, direction, wrongSide ? vec3(0.0) : next.weight, next.pdf, next.transmitted, m);
}

/// Smooth glass of the stages before global illumination: one ray, chosen by the reflectance.
Path scatterGlass(Path p, Surface s, SurfaceMaterial m, vec3 normal, float choice) {
  Bsdf b = baseBsdf(m, s.front);
  Frame3 around = frameAround(normal);
  BsdfSample next = sampleSmoothGlass(b, toFrame(around, -p.direction), choice);
  vec3 direction = ontoSide(normalize(toWorld(around, next.wi)), s.geometricNormal, next.transmitted);
  return spawnRay(p, s, direction, next.weight, 0.0, next.transmitted, m);
}

/// Mirror reflection of the stages before global illumination, scaled by a share.
Path scatterMirror(Path p, Surface s, SurfaceMaterial m, vec3 normal, float share) {
  vec3 wo = -p.direction;
  vec3 f0 = phongF0(m.baseColor, m.metallic, m.dielectricF0);
  vec3 weight = vec3(0.0);
  if (kReflections) weight = fresnelSchlick(f0, mix(m.specular, 1.0, m.metallic), dot(normal, wo)) * share;
  vec3 direction = ontoSide(normalize(mirrorDirection(wo, normal)), s.geometricNormal, false);
  return spawnRay(p, s, direction, weight, 0.0, false, m);
}

/// Blinn-Phong, mirror reflection and smooth glass.
Path shadeLocal(Path p, Surface s, SurfaceMaterial m, vec3 normal) {
  if (kRefraction && pathRandom(p, kGlassDimension) < m.transmission * (1.0 - m.metallic)) {
    return scatterGlass(p, s, m, normal, pathRandom(p, kLobeDimension));
  }
  vec3 wo = -p.direction;
  vec3 f0 = phongF0(m.baseColor, m.metallic, m.dielectricF0);
  vec3 diffuse = (1.0 - m.metallic) * m.baseColor;
  float exponent = phongExponent(m.roughness);
  if (p.lightSampleIndex == 0) p.radiance += 0.03 * p.throughput * m.baseColor;
  if (kEnvironmentLight && p.lightSampleIndex == 0)
    p.radiance += p.throughput * environmentReflected(diffuse, f0, exponent, normal, wo);
  int lights = lightSampleCount();
  if (p.lightSampleIndex < lights) {
    uint dimension = kBounceDimensions * uint(p.bounce + 1);
    LightSample light = sampleLight(p.lightSampleIndex, s.position, kNoNormal, p.sampler, dimension + kLightDimension);
    if (kVertexNormals) diffuse *= terminatorFade(s.geometricNormal, s.shadingNormal, light.direction);
    vec3 value = phongValue(diffuse, f0, exponent, normal, wo, light.direction);
    bool above = dot(light.direction, s.geometricNormal) > 0.0;
    if (kThinGlass) p.throughGlass = passesGlass(p, s, light.direction);
    p = spawnShadowRay(p, s, light, above ? p.throughput * light.irradiance * value : vec3(0.0));
  }
  p.lightSampleIndex += 1;
  p.after = kPhaseShade;
  if (p.lightSampleIndex < lights) return p;
  float gloss = 1.0 - m.roughness;
  return scatterMirror(p, s, m, normal, gloss * gloss);
}

/// The shading normal as seen from `wo`.
vec3 normalFacing(Surface s, vec3 wo) {
  vec3 normal = facingNormal(mappedNormal(s), wo);
  return kGi && kSpecular ? reflectingNormal(normal, s.geometricNormal, wo) : normal;
}

/// The share of a shadow ray's light that a surface lets straight through: the weight of a path that passes it.
vec3 lightThrough(Surface s, vec3 baseColor, vec3 direction) {
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  if (m.transmission * (1.0 - m.metallic) <= 0.0) return vec3(0.0);
  if (m.solid && !(kMatchedGlass && isMatched(s.material))) return vec3(0.0);
  if (kUnlit && (materialFlags(s.material) & kMaterialUnlit) != 0u) return vec3(0.0);
  Bsdf b = baseBsdf(m, s.front);
  vec3 anisotropy = kAnisotropy ? anisotropyAt(s.material, s.texcoords) : vec3(0.0);
  Frame3 around = frameAround(normalFacing(s, -direction));
  if (kGi) b = addLayers(b, s, around, -direction, anisotropy.z);
  return straightThrough(b, toFrame(around, -direction));
}

/// The share of a shadow ray's light that glass lets pass to the catcher, whether it bends light, spreads it or
/// neither. Light comes from outside, so that no angle reflects all of it.
vec3 clearThrough(Surface s, vec3 baseColor, vec3 direction) {
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  if (kUnlit && (materialFlags(s.material) & kMaterialUnlit) != 0u) return vec3(0.0);
  Bsdf b = baseBsdf(m, true);
  return b.glass * (1.0 - glassFresnel(b, abs(dot(normalFacing(s, -direction), direction)))) * b.baseColor;
}

/// The depth of a point at a distance along the camera's ray of a path with this time, in metres.
float depthAlong(vec3 direction, float t, float time) {
  vec3 forward = frame.cameraForward;
  if (kMovingCamera) forward = turnedWith(cameraAt(time), forward);
  return (kPanorama || kFisheye ? t : t * dot(direction, forward)) * frame.metresPerUnit;
}

/// Metres along the view axis, or from a panorama or a fisheye; of a path with this time.
float depthOf(Surface s, float time) {
  vec3 way = s.position - frame.cameraPosition;
  vec3 forward = frame.cameraForward;
  if (kMovingCamera) {
    CameraPose pose = cameraAt(time);
    way = s.position - pose.position;
    forward = turnedWith(pose, forward);
  }
  return (kPanorama || kFisheye ? length(way) : dot(way, forward)) * frame.metresPerUnit;
}

/// The number of the glTF node that was hit, from 1 on.
float objectNumber(int slot, int instance) {
  if (!kObjectNumbers) return 0.0;
  bool shown = kInstances && instance >= 0;
  int index = shown ? frame.leafCount * 2 + instance : slot;
  uvec4 four = readMaterials(frame.objectRow + index / 4);
  int place = index % 4;
  return float(place == 0 ? four.x : place == 1 ? four.y : place == 2 ? four.z : four.w);
}

/// Returns the AOV of the point that a camera ray hits.
vec3 aovAt(Surface s, int slot, int instance, vec3 baseColor, vec3 wo, float time) {
  if (kAov == kAovAlbedo) return baseColor;
  if (kAov == kAovNormal) return facingNormal(mappedNormal(s), wo);
  if (kAov == kAovGeometricNormal) return s.geometricNormal;
  if (kAov == kAovRoughness) return vec3(materialAt(s.material, baseColor, s.texcoords).roughness);
  if (kAov == kAovTexcoords) return vec3(s.texcoords.xy, 0.0);
  if (kAov == kAovPosition) return frame.worldOrigin + frame.metresPerUnit * s.position;
  if (kAov == kAovObject || kAov == kAovCryptoObject) return vec3(objectNumber(slot, instance));
  if (kAov == kAovMaterial || kAov == kAovCryptoMaterial) return vec3(materialFloats(s.material, kMaterialPerlin).w);
  return vec3(depthOf(s, time));
}

#include "guides.glsl"
#include "caustics/light_path.glsl"

/// One step at the point hit. The first visit (gi has one only) also settles absorption and emission.
Path shade(Path p) {
  Surface s = surfaceAt(p.hitSlot, p.hitInstance, p.origin, p.direction, p.hitT, p.hitWeights, p.time);
  if (kRayCones) coverSurface(p, s);
  uint flags = materialFlags(s.material);
  vec4 base = baseColorAt(s.material, s.texcoords, s.color);
  bool first = p.lightSampleIndex == 0;
  if (kAov == kAovGuides) return guideAt(p, s, flags, base);
  if (kPassesLight && kDrawsLight && first) p = flyTo(p, s);
  if (kMedia && p.hitSlot < 0) return scatterInMedium(p);
  if (p.cameraRay) p.covered = true;
  if (!kDrawsLight) {
    p.radiance = aovAt(s, p.hitSlot, p.hitInstance, base.rgb, -p.direction, p.time);
    p.phase = kPhaseEnd;
    return p;
  }
  if (kLightPaths) return lightPathAt(p, s, flags, base.rgb);
  if (!kPhong || (kUnlit && (flags & kMaterialUnlit) != 0u)) {
    p = addLight(p, p.throughput * base.rgb);
    p.phase = kPhaseEnd;
    return p;
  }
  if (kEmission && first) p = addLight(p, clampIndirect(p.throughput * emittedAt(p, s, flags), countedScatterings(p)));
  if (kAov == kAovEmission) {
    p.phase = kPhaseEnd;
    return p;
  }
  if (kScatters && first && limitedScatterings(p) > frame.maxBounces) {
    p.phase = kPhaseCut;
    return p;
  }
  SurfaceMaterial m = materialAt(s.material, base.rgb, s.texcoords);
  if (kStoresReservoirs) return fillReservoir(p, s, m);
  vec3 normal = normalFacing(s, -p.direction);
  if (kGi) p = shadeGlobal(p, s, m, normal);
  if (!kGi) p = shadeLocal(p, s, m, normal);
  if (p.phase != kPhaseShadow) p = proceed(p);
  return p;
}

/// The shadow ray is traced. One that met glass may go on behind it; else the light sample is settled.
Path settleShadow(Path p) {
  int slot = p.traversal.slot;
  bool passes = false;
  if (kPassing && slot >= 0 && slot != kOpaqueSlot) {
    if (kCountWork) countWork(kWorkShadowSurfaces, 1u);
    Surface s = surfaceAt(slot, p.traversal.hitInstance, p.shadowOrigin, p.shadowDirection, p.traversal.t,
                          p.traversal.weights, p.time);
    vec4 base = baseColorAt(s.material, s.texcoords, s.color);
    if (kClearShadows && p.caught) {
      p.contribution *= clearThrough(s, base.rgb, p.shadowDirection);
      passes = maxComponent(-p.contribution) > 0.0;
    } else if (kThroughGlass && p.throughGlass) {
      p.contribution *= lightThrough(s, base.rgb, p.shadowDirection);
      passes = maxComponent(p.contribution) > 0.0;
    }
    if (kDimsLate && passes) {
      p = dimShadow(p, solidBefore(p.shadowMedium, s, false), passedBefore(p), p.traversal.t);
      if (isSolid(s.material)) p.shadowMedium = behindBoundary(p.shadowMedium, s);
    }
  }
  if (kPassing && passes) return tracePast(p, p.shadowLimit, p.traversal.t, slot);
  if (kDimsLate && slot < 0) p = dimShadow(p, innermost(p.shadowMedium), passedBefore(p), p.shadowLimit);
  if (kLightPaths && slot < 0) storeSplat(p);
  if (!kLightPaths && slot < 0) p.radiance += p.contribution;
  if (kClearShadows && p.caught) p.contribution = vec3(1.0);
  return proceed(p);
}
