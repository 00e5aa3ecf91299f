// SPDX-License-Identifier: MIT
// What integrators share of a hit: its surface, its BSDF, what it emits, and what it lets through.

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

/// A path that meets dispersive glass continues for one of red, green and blue, which stands for all three.
Path disperse(Path p, SurfaceMaterial m, uint material) {
  if (p.oneChannel || !m.solid || m.transmission * (1.0 - m.metallic) <= 0.0) return p;
  if (materialFloats(material, kMaterialClearcoat).w <= 0.0) return p;
  int channel = pathChannel(p);
  p.throughput *= 3.0 * vec3(channel == 0 ? 1.0 : 0.0, channel == 1 ? 1.0 : 0.0, channel == 2 ? 1.0 : 0.0);
  p.oneChannel = true;
  return p;
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

/// Smooth glass of the stages before global illumination: one ray, chosen by the reflectance.
Path scatterGlass(Path p, Surface s, SurfaceMaterial m, vec3 normal, float choice) {
  Bsdf b = baseBsdf(m, s.front);
  Frame3 around = frameAround(normal);
  BsdfSample next = sampleSmoothGlass(b, toFrame(around, -p.ray.direction), choice);
  vec3 direction = ontoSide(normalize(toWorld(around, next.wi)), s.geometricNormal, next.transmitted);
  return spawnRay(p, s, direction, next.weight, 0.0, next.transmitted, m);
}

/// Mirror reflection of the stages before global illumination, scaled by a share.
Path scatterMirror(Path p, Surface s, SurfaceMaterial m, vec3 normal, float share) {
  vec3 wo = -p.ray.direction;
  vec3 f0 = phongF0(m.baseColor, m.metallic, m.dielectricF0);
  vec3 weight = vec3(0.0);
  if (kReflections) weight = fresnelSchlick(f0, mix(m.specular, 1.0, m.metallic), dot(normal, wo)) * share;
  vec3 direction = ontoSide(normalize(mirrorDirection(wo, normal)), s.geometricNormal, false);
  return spawnRay(p, s, direction, weight, 0.0, false, m);
}

/// The shading normal as seen from `wo`.
vec3 normalFacing(Surface s, vec3 wo) {
  vec3 normal = facingNormal(mappedNormal(s), wo);
  return kGi && kSpecular ? reflectingNormal(normal, s.geometricNormal, wo) : normal;
}

bool isUnlit(uint material) { return kUnlit && (materialFlags(material) & kMaterialUnlit) != 0u; }

/// The share of a shadow ray's light that a surface lets straight through: the weight of a path that passes it.
vec3 lightThrough(Surface s, vec3 baseColor, vec3 direction) {
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  if (m.transmission * (1.0 - m.metallic) <= 0.0) return vec3(0.0);
  if (m.solid && !(kMatchedGlass && isMatched(s.material))) return vec3(0.0);
  if (isUnlit(s.material)) return vec3(0.0);
  Bsdf b = baseBsdf(m, s.front);
  vec3 anisotropy = kAnisotropy ? anisotropyAt(s.material, s.texcoords) : vec3(0.0);
  Frame3 around = frameAround(normalFacing(s, -direction));
  b = addLayers(b, s, around, -direction, anisotropy.z);
  return straightThrough(b, toFrame(around, -direction));
}

/// The share of a shadow ray's light that glass lets pass to the catcher, whether it bends light, spreads it or
/// neither. Light comes from outside, so that no angle reflects all of it.
vec3 clearThrough(Surface s, vec3 baseColor, vec3 direction) {
  SurfaceMaterial m = materialAt(s.material, baseColor, s.texcoords);
  if (isUnlit(s.material)) return vec3(0.0);
  Bsdf b = baseBsdf(m, true);
  return b.glass * (1.0 - glassFresnel(b, abs(dot(normalFacing(s, -direction), direction)))) * b.baseColor;
}

/// The depth of a point at a distance along the camera's ray of a path with this time, in metres.
float depthAlong(vec3 direction, float t, float time) {
  return (kRoundCamera ? t : t * dot(direction, forwardAt(time))) * frame.metresPerUnit;
}

/// Metres along the view axis, or from a panorama or a fisheye; of a path with this time.
float depthOf(Surface s, float time) {
  vec3 way = s.position - (kMovingCamera ? cameraAt(time).position : frame.cameraPosition);
  return (kRoundCamera ? length(way) : dot(way, forwardAt(time))) * frame.metresPerUnit;
}

/// The surface that the path's ray has hit.
Surface surfaceHit(Path p) {
  Surface s = surfaceAt(p.hit.slot, p.hit.instance, p.ray.origin, p.ray.direction, p.hit.t, p.hit.weights, p.time);
  if (kRayCones) coverSurface(p, s);
  return s;
}

/// A path arrives at a surface. Returns false if it ends there: on an unlit one, or behind too many bounces.
bool arrives(inout Path p, Surface s, vec3 baseColor) {
  if (p.cameraRay) p.covered = true;
  bool unlit = isUnlit(s.material);
  if (unlit) p = addLight(p, p.throughput * baseColor);
  if (kEmission && !unlit) p = addLight(p, clampIndirect(p.throughput * emittedAt(p, s), countedScatterings(p)));
  if (unlit || kEmittedPart) return false;
  bool cut = kScatters && limitedScatterings(p) > frame.maxBounces;
  if (cut) p.next = kPhaseCut;
  return !cut;
}
