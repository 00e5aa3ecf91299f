// SPDX-License-Identifier: MIT
// Light sampling: punctual lights, emissive triangles by power, and the environment.

/// Light that reaches a point from one direction. density 0: no ray can find it (punctual), so it has no MIS partner.
struct LightSample {
  vec3 direction;
  float distance;   // to the light, kFarAway for the environment and directional lights
  vec3 irradiance;  // radiance / density, or the punctual light's intensity / d^2; zero when there is none
  float density;    // over solid angle, the chance of choosing this light counted in
};

const float kFarAway = float(3.0e38);

LightSample makeLight(vec3 direction, float distance, vec3 irradiance, float density) {
  LightSample s;
  s.direction = direction;
  s.distance = distance;
  s.irradiance = irradiance;
  s.density = density;
  return s;
}

LightSample noLight() { return makeLight(vec3(0.0f, 0.0f, 1.0f), kFarAway, vec3(0.0f), 0.0f); }

/// One punctual light seen from a point (KHR_lights_punctual).
LightSample punctualLight(int index, vec3 point) {
  int row = index * int(kLightRows);
  vec4 intensity = uintBitsToFloat(readLights(row));
  vec4 place = uintBitsToFloat(readLights(row + 1));
  vec4 axis = uintBitsToFloat(readLights(row + 2));
  float spotOffset = uintBitsToFloat(readLights(row + 3).x);
  if (intensity.w == kLightDirectional) return makeLight(-vec3(axis), kFarAway, vec3(intensity), 0.0f);
  vec3 towards = vec3(place) - point;
  float squared = dot(towards, towards);
  if (squared <= 0.0f) return noLight();
  float distance = sqrt(squared);
  vec3 direction = towards / distance;
  float window = 1.0f;
  if (place.w > 0.0f) {
    float ratio = squared / (place.w * place.w);
    window = clamp(1.0f - ratio * ratio, 0.0f, 1.0f);
  }
  if (intensity.w == kLightSpot) {
    float falloff = clamp(dot(-direction, vec3(axis)) * axis.w + spotOffset, 0.0f, 1.0f);
    window *= falloff * falloff;
  }
  return makeLight(direction, distance, vec3(intensity) * (window / squared), 0.0f);
}

/// Density over solid angle of choosing the point that a ray hit on an emissive triangle.
float emitterDensity(uint material, float distance, float cosine) {
  float area = materialFloats(material, kMaterialMaps).z * (1.0f - frame.lightChoice.x);
  return area * distance * distance / max(cosine, float(1e-7));
}

/// A point on the emissive triangle of a leaf slot, chosen with `chance`.
LightSample triangleLight(int slot, float chance, vec3 point, float u, float v) {
  LeafPrimitive p = loadLeafPrimitive(slot);
  vec3 e1 = p.v1 - p.v0;
  vec3 e2 = p.v2 - p.v0;
  vec2 w = sampleTriangle(u, v);
  vec3 n = cross(e1, e2);
  float doubleArea = length(n);
  vec3 towards = p.v0 + w.x * e1 + w.y * e2 - point;
  float squared = dot(towards, towards);
  if (squared <= 0.0f || doubleArea <= 0.0f) return noLight();
  float distance = sqrt(squared);
  vec3 direction = towards / distance;
  float cosine = -dot(n, direction) / doubleArea;
  uvec4 record = readPrimitives(int(p.word & kPrimitiveIndexMask));
  uint material = record.w & kMaterialIndexMask;
  if ((materialFlags(material) & kMaterialDoubleSided) != 0u) cosine = abs(cosine);
  if (cosine <= 0.0f) return noLight();
  vec4 texcoords = vec4(0.0f);
  if (kEmissionTexture && kTexcoords) {
    ivec3 i = ivec3(record);
    texcoords = interpolate(readTexcoordsAt(i.x), readTexcoordsAt(i.y), readTexcoordsAt(i.z), w);
  }
  float density = chance * squared / (0.5f * doubleArea * cosine);
  return makeLight(direction, distance, emissionAt(material, texcoords) / density, density);
}

LightSample environmentLight(float chance, uvec2 bits) {
  vec3 direction = sampleEnvironment(bits);
  float density = chance * environmentDensity(direction);
  if (density <= 0.0f) return noLight();
  return makeLight(direction, kFarAway, environmentRadiance(direction) / density, density);
}

/// An emitter of the alias table by power; onlyTriangles drops punctual lights, which the caller visits one by one.
LightSample emitterLight(float chance, vec3 point, uvec2 bits, bool onlyTriangles) {
  TablePlace place = placeInTable(bits.x, uint(frame.lightChoice.y));
  uvec4 entry = readEmitters(place.index);
  float threshold = uintBitsToFloat(entry.x);
  if (place.within >= threshold) entry = readEmitters(int(entry.y));
  chance *= uintBitsToFloat(entry.w);
  bool punctual = kPunctualLights && (entry.z & kEmitterPunctual) != 0u;
  LightSample s = noLight();
  if (punctual && !onlyTriangles) {
    s = punctualLight(int(entry.z & ~kEmitterPunctual), point);
    s.irradiance /= chance;
  }
  if (kEmissiveTriangles && !punctual) {
    s = triangleLight(int(entry.z), chance, point, withinPart(place.within, threshold), unitFloat(bits.y));
  }
  return s;
}

/// How many light samples each shaded point takes: one with global illumination; else each punctual light, one point of
/// the emissive triangles and one direction of the environment.
int lightSlotCount() {
  if (kGi) return kPunctualLights || kEmissiveTriangles || kEnvironmentSampling ? 1 : 0;
  int count = kPunctualLights ? int(frame.lightChoice.w) : 0;
  return count + (kEmissiveTriangles ? 1 : 0) + (kEnvironmentSampling ? 1 : 0);
}

/// The light sample of one slot; uses four dimensions from `dimension` on.
LightSample lightOfSlot(int slot, vec3 point, Sampler numbers, uint dimension) {
  bool emitters = kPunctualLights || kEmissiveTriangles;
  if (kGi) {
    bool environment = kEnvironmentSampling && (!emitters || drawFloat(numbers, dimension) < frame.lightChoice.x);
    LightSample s = noLight();
    uvec2 bits = drawPairBits(numbers, dimension + 1u);
    if (kEnvironmentSampling && environment) s = environmentLight(frame.lightChoice.x, bits);
    if (emitters && !environment) s = emitterLight(1.0f - frame.lightChoice.x, point, bits, false);
    return s;
  }
  int punctual = kPunctualLights ? int(frame.lightChoice.w) : 0;
  LightSample s = noLight();
  if (kPunctualLights && slot < punctual) s = punctualLight(slot, point);
  if (kEmissiveTriangles && slot == punctual) s = emitterLight(1.0f, point, drawPairBits(numbers, dimension), true);
  if (kEnvironmentSampling && slot == lightSlotCount() - 1) s = environmentLight(1.0f, drawPairBits(numbers, dimension + 2u));
  return s;
}
