// SPDX-License-Identifier: MIT
// The stages before global illumination: Blinn-Phong under every light, mirror reflection and smooth glass. They visit
// a hit once for each of their light samples.
#include "integrators/camera_rays.glsl"

/// The light sample of the hit that is next.
int lightSample = 0;

Path beginPath(ivec2 pixel, uint samples, int steps) { return cameraPath(pixel, samples, steps); }

/// Blinn-Phong, mirror reflection and smooth glass.
Path shadeLocal(Path p, Surface s, SurfaceMaterial m, vec3 normal) {
  if (kRefraction && pathRandom(p, kGlassDimension) < m.transmission * (1.0 - m.metallic)) {
    return scatterGlass(p, s, m, normal, pathRandom(p, kLobeDimension));
  }
  vec3 wo = -p.ray.direction;
  vec3 f0 = phongF0(m.baseColor, m.metallic, m.dielectricF0);
  vec3 diffuse = (1.0 - m.metallic) * m.baseColor;
  float exponent = phongExponent(m.roughness);
  if (lightSample == 0) p.radiance += 0.03 * p.throughput * m.baseColor;
  if (kEnvironment && lightSample == 0)
    p.radiance += p.throughput * environmentReflected(diffuse, f0, exponent, normal, wo);
  int lights = lightSampleCount();
  if (lightSample < lights) {
    uint dimension = kBounceDimensions * uint(p.bounce + 1);
    LightSample light = sampleLight(lightSample, s.position, kNoNormal, p.sampler, dimension + kLightDimension);
    if (kVertexNormals) diffuse *= terminatorFade(s.geometricNormal, s.shadingNormal, light.direction);
    vec3 value = phongValue(diffuse, f0, exponent, normal, wo, light.direction);
    bool above = dot(light.direction, s.geometricNormal) > 0.0;
    if (kThinGlass) p.connection.throughGlass = passesGlass(p, s, light.direction);
    p = spawnShadowRay(p, s, light, above ? p.throughput * light.irradiance * value : vec3(0.0));
  }
  lightSample += 1;
  p.next = kPhaseMeet;
  if (lightSample < lights) return p;
  lightSample = 0;
  float gloss = 1.0 - m.roughness;
  return scatterMirror(p, s, m, normal, gloss * gloss);
}

Path hit(Path p) {
  Surface s = surfaceHit(p);
  vec3 baseColor = vec3(baseColorAt(s.material, s.texcoords, s.color));
  bool first = lightSample == 0;
  if (kPassesLight && first) p = flyTo(p, s);
  if (first && !arrives(p, s, baseColor)) return p;
  return shadeLocal(p, s, materialAt(s.material, baseColor, s.texcoords), normalFacing(s, -p.ray.direction));
}

float interceptedAt(Path p) { return kFarAway; }

Path intercept(Path p, float t) { return p; }

Path miss(Path p) { return meetSurroundings(p); }

void suspendOwn(Path p, int row) { pathStates[row].x = uint(lightSample); }

Path resumeOwn(Path p, int row) {
  lightSample = int(readPathStates(row).x);
  return p;
}

FilmPixel record(FilmPixel film, Path p, ivec2 pixel) { return addSample(film, p.radiance, p.covered ? 1.0 : 0.0); }
