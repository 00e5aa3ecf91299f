// SPDX-License-Identifier: MIT
// Light paths begin at the sun or a lamp, which is drawn by its power, and are aimed at casters of
// caustics. Balls enclose all casters, so that no path that meets one first is left out.

// Probability that a light path begins at the sun; 1: no lamps.
layout(location = kMostCasters + 1) uniform float sunChance;
layout(location = kMostCasters + 2) uniform bool storesPhotons;  // light paths end where they land, and are stored

#include "caustics/aim.glsl"

/// A ray of light. flux: watts divided by the pdf with which the ray was drawn; zero if there is no ray.
struct Emission {
  vec3 origin;
  vec3 direction;
  vec3 flux;
  float range;  // range of a punctual light; 0: unlimited
};

Emission noEmission() {
  Emission e;
  e.origin = vec3(0.0f);
  e.direction = vec3(0.0f, 0.0f, 1.0f);
  e.flux = vec3(0.0f);
  e.range = 0.0f;
  return e;
}

Emission triangleEmission(int emitter, float share, float choice, vec2 uv, vec2 aim) {
  uvec4 corner = emitterRow(emitter, 1);
  uvec4 edge1 = emitterRow(emitter, 2);
  uvec4 edge2 = emitterRow(emitter, 3);
  vec3 e1 = uintBitsToFloat(edge1.xyz);
  vec3 e2 = uintBitsToFloat(edge2.xyz);
  vec2 w = sampleTriangle(uv.x, uv.y);
  vec3 point = uintBitsToFloat(corner.xyz) + w.x * e1 + w.y * e2;
  vec3 normal = normalize(cross(e1, e2));
  bool bothSides = (corner.w & kEmitterDoubleSided) != 0u;
  Aim a = aimFrom(point, bothSides ? vec3(0.0f) : normal, choice, aim);
  float cosine = dot(normal, a.direction);
  if (bothSides) cosine = abs(cosine);
  Emission e = noEmission();
  if (a.pdf <= 0.0f || cosine <= 0.0f) return e;
  int slot = int(edge2.w);
  float error = uintBitsToFloat((faceRow(slot, 0).w >> kFaceErrorShift) << kFloatErrorShift);
  e.origin = offsetOrigin(point, error, normal, a.direction);
  e.direction = a.direction;
  vec3 radiance = emittedFrom(corner.w & kFaceMaterialMask, slot, w, cosine);
  e.flux = radiance * (cosine / (share * uintBitsToFloat(edge1.w) * a.pdf));
  return e;
}

Emission punctualEmission(int index, float share, float choice, vec2 aim) {
  int row = index * int(kLightRows);
  vec4 intensity = uintBitsToFloat(readLights(row));
  vec4 place = uintBitsToFloat(readLights(row + 1));
  vec4 axis = uintBitsToFloat(readLights(row + 2));
  bool parallel = intensity.w == kLightDirectional;
  Aim a;
  if (parallel) a = aimAlong(vec3(axis), choice, aim);
  if (!parallel) a = aimFrom(vec3(place), vec3(0.0f), choice, aim);
  Emission e = noEmission();
  if (a.pdf <= 0.0f) return e;
  e.origin = a.origin;
  e.direction = a.direction;
  e.range = parallel ? 0.0f : place.w;
  float cone = 1.0f;
  if (intensity.w == kLightSpot) cone = spotFalloff(axis, uintBitsToFloat(readLights(row + 3).x), a.direction);
  e.flux = vec3(intensity) * (cone / (share * a.pdf));
  return e;
}

/// A ray of the sun of a sky.
Emission sunEmission(float share, float choice, vec2 uv, vec2 aim) {
  Sun sun = sunOfSky();
  vec3 towards = sampleSun(sun, uv.x, uv.y);
  vec4 disc = discAlong(sun, towards);
  Aim a = aimAlong(-towards, choice, aim);
  Emission e = noEmission();
  // Rounding may draw what lies just next to the disc.
  if (disc.w <= 0.0f) return e;
  e.origin = a.origin;
  e.direction = a.direction;
  e.flux = vec3(disc) / (share * sun.pdf * disc.w * a.pdf);
  return e;
}

/// A ray of the sun of a map. Light samples draw the map by its luminance; what is too dim is no sun.
Emission mapSunEmission(float share, float choice, uvec2 bits, vec2 aim) {
  LightSample light = environmentLight(1.0f, bits);
  Emission e = noEmission();
  if (light.pdf <= 0.0f || !isMapSun(vec3(mapAlong(light.direction)))) return e;
  Aim a = aimAlong(-light.direction, choice, aim);
  e.origin = a.origin;
  e.direction = a.direction;
  e.flux = light.irradiance / (share * a.pdf);
  return e;
}

/// Draws the sun or a lamp by its power, a point on it, and a direction.
Emission drawEmission(Sampler sampler) {
  uint bits = drawBits(sampler, kEmitterDimension);
  float choice = drawFloat(sampler, kCasterDimension);
  vec2 aim = drawPair(sampler, kAimDimensions);
  uint border = kSunPaths ? uint(sunChance * 4294967040.0f) : 0u;
  bool ofSun = kSunPaths && (bits < border || sunChance >= 1.0f);
  if (ofSun && kMapSun) {
    return mapSunEmission(sunChance, choice, drawPairBits(sampler, kEmitterPointDimensions), aim);
  }
  if (ofSun) return sunEmission(sunChance, choice, drawPair(sampler, kEmitterPointDimensions), aim);
  Emission e = noEmission();
  if (!hasLamps()) return e;
  if (kSunPaths) bits = stretchBits(bits, border, 1.0f / (1.0f - sunChance));
  int emitter = emitterAt(bits);
  float share = uintBitsToFloat(emitterRow(emitter, 0).w);
  if (kSunPaths) share *= 1.0f - sunChance;
  uint kind = emitterRow(emitter, 3).w;
  bool punctual = isPunctual(kind);
  if (share <= 0.0f) return e;
  if (punctual) e = punctualEmission(int(kind & ~kEmitterPunctual), share, choice, aim);
  if (kEmissiveTriangles && !punctual) {
    e = triangleEmission(emitter, share, choice, drawPair(sampler, kEmitterPointDimensions), aim);
  }
  return e;
}
