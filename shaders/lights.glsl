// SPDX-License-Identifier: MIT
// Light sampling: punctual lights, emissive triangles by power or by a tree, and the environment.

/// Light that reaches a point from one direction. pdf 0: no ray can find it (punctual), so it has no MIS partner.
struct LightSample {
  vec3 direction;
  float distance;   // distance to the light, kFarAway for the environment and directional lights
  vec3 irradiance;  // radiance / pdf, or the punctual light's intensity / d^2; zero when there is none
  float pdf;    // over solid angle, the chance of choosing this light counted in
};

LightSample makeLight(vec3 direction, float distance, vec3 irradiance, float pdf) {
  LightSample s;
  s.direction = direction;
  s.distance = distance;
  s.irradiance = irradiance;
  s.pdf = pdf;
  return s;
}

LightSample noLight() { return makeLight(vec3(0.0f, 0.0f, 1.0f), kFarAway, vec3(0.0f), 0.0f); }

/// The MIS weight of a light sample that scattering would find with the other pdf.
float lightWeight(LightSample s, float other) {
  return misWeight(s.pdf, other, kEnvironmentSampling && s.distance == kFarAway);
}

/// The factor by which the range of a punctual light (0: none) dims it at a squared distance (KHR_lights_punctual).
float rangeWindow(float squared, float range) {
  float ratio = range > 0.0f ? squared / (range * range) : 0.0f;
  return clamp(1.0f - ratio * ratio, 0.0f, 1.0f);
}

float spotFalloff(vec4 axis, float offset, vec3 direction) {
  float falloff = clamp(dot(direction, vec3(axis)) * axis.w + offset, 0.0f, 1.0f);
  return falloff * falloff;
}

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
  float window = rangeWindow(squared, place.w);
  if (intensity.w == kLightSpot) window *= spotFalloff(axis, spotOffset, -direction);
  return makeLight(direction, distance, vec3(intensity) * (window / squared), 0.0f);
}

/// The pdf over solid angle of choosing the point that a ray hit on an emissive triangle.
float emitterPdf(uint material, float distance, float cosine) {
  float pdfOverArea = materialFloats(material, kMaterialMaps).z * (1.0f - frame.environmentChance);
  return pdfOverArea * distance * distance / max(cosine, float(1e-7));
}

uvec4 emitterRow(int emitter, int row) {
  return kLiterals ? literalEmitter(emitter, row) : readEmitters(emitter * int(kEmitterRows) + row);
}

/// The radiance that a point of an emissive triangle, by leaf slot and barycentric weights, emits at `cosine`, on
/// average over the rays that its alpha lets through.
vec3 emittedFrom(uint material, int slot, vec2 weights, float cosine) {
  uvec4 place = kTexcoords || kVertexColors ? faceRow(slot, 1) : uvec4(0u);
  vec4 texcoords = vec4(0.0f);
  if (kLampTextures) {
    texcoords = interpolate(readTexcoordsAt(int(place.y)), readTexcoordsAt(int(place.z)), readTexcoordsAt(int(place.w)),
                            weights);
  }
  if (kRayCones) coveredAreas = vec2(0.0f);
  vec3 radiance = emissionAt(material, texcoords);
  if (kAlpha && (materialFlags(material) & (kMaterialMask | kMaterialBlend)) != 0u) {
    vec4 color = vec4(1.0f);
    if (kVertexColors) {
      color = interpolate(readColorAt(int(place.y)), readColorAt(int(place.z)), readColorAt(int(place.w)), weights);
    }
    radiance *= alphaAt(material, materialFlags(material), baseColorAt(material, texcoords, color).a);
  }
  if (kClearcoat) radiance = radiance * emissionUnderCoat(material, texcoords, cosine);
  return radiance;
}

/// A point on the triangle of an emitter, chosen with `chance`, at a time of the path.
LightSample triangleLight(int emitter, float chance, vec3 point, float u, float v, float time) {
  uvec4 corner = emitterRow(emitter, 1);
  uvec4 edge1 = emitterRow(emitter, 2);
  uvec4 edge2 = emitterRow(emitter, 3);
  vec3 origin = uintBitsToFloat(uvec3(corner));
  vec3 e1 = uintBitsToFloat(uvec3(edge1));
  vec3 e2 = uintBitsToFloat(uvec3(edge2));
  float inverseArea = uintBitsToFloat(edge1.w);
  float standing = inverseArea;
  if (kMoving) {
    Corners at = movingTriangle(slotInSegment(int(edge2.w), time), time).at;
    origin = at.v0;
    e1 = at.v1 - at.v0;
    e2 = at.v2 - at.v0;
    inverseArea = 2.0f / max(length(cross(e1, e2)), float(1e-30));
  }
  vec2 w = sampleTriangle(u, v);
  vec3 towards = origin + w.x * e1 + w.y * e2 - point;
  float squared = dot(towards, towards);
  if (squared <= 0.0f) return noLight();
  float distance = sqrt(squared);
  vec3 direction = towards / distance;
  float cosine = -0.5f * inverseArea * dot(cross(e1, e2), direction);
  if ((corner.w & kEmitterDoubleSided) != 0u) cosine = abs(cosine);
  if (cosine <= 0.0f) return noLight();
  float pdf = chance * inverseArea * squared / cosine;
  vec3 radiance = emittedFrom(corner.w & kFaceMaterialMask, int(edge2.w), w, cosine);
  // MIS uses a moving triangle's area at the beginning, as emitterPdf() does: any weights do that add up to 1.
  return makeLight(direction, distance, radiance / pdf, kMoving ? pdf * standing / inverseArea : pdf);
}

LightSample environmentLight(float chance, uvec2 bits) {
  vec2 place = sampleEnvironment(bits);
  vec4 there = environmentAt(place);
  vec3 direction = environmentDirection(place / vec2(ivec2(frame.environmentSize)));
  float pdf = chance * environmentPdf(there, direction);
  if (pdf <= 0.0f) return noLight();
  return makeLight(direction, kFarAway, vec3(there) / pdf, pdf);
}

/// Returns the same of a sky with its sun (kSun).
LightSample skyLight(float chance, uvec2 bits) {
  vec3 direction = sampleSky(bits);
  vec4 there = environmentAlong(direction);
  float pdf = chance * environmentPdf(there, direction);
  return pdf > 0.0f ? makeLight(direction, kFarAway, vec3(there) / pdf, pdf) : noLight();
}

/// The emitter that bits draw by power: they are in the order of the numbers that draw them, and each tells which its
/// equal share of these can draw.
int emitterAt(uint bits) {
  uvec4 entry = emitterRow(placeInTable(bits, uint(frame.emitterCount)).index, 0);
  int low = int(entry.x);
  int high = int(entry.y);
  while (low < high) {
    int middle = (low + high) / 2;
    bool beyond = bits > emitterRow(middle, 0).z;
    low = beyond ? middle + 1 : low;
    high = beyond ? high : middle;
  }
  return low;
}

bool isPunctual(uint kind) { return kPunctualLights && (kind & kEmitterPunctual) != 0u; }

int punctualLightCount() { return kPunctualLights ? int(frame.punctualCount) : 0; }

/// There are lamps among which light samples choose.
bool hasLamps() { return kPunctualLights || kEmissiveTriangles; }

/// A light sample of an emitter that was chosen with `chance`; u and v choose the point on an emissive triangle.
LightSample lightOfEmitter(int emitter, float chance, vec3 point, float u, float v, bool onlyTriangles, float time) {
  uint kind = emitterRow(emitter, 3).w;
  bool punctual = isPunctual(kind);
  LightSample s = noLight();
  if (chance <= 0.0f) return s;
  if (punctual && !onlyTriangles) {
    s = punctualLight(int(kind & ~kEmitterPunctual), point);
    s.irradiance /= chance;
  }
  if (kEmissiveTriangles && !punctual) s = triangleLight(emitter, chance, point, u, v, time);
  return s;
}

/// The point or direction of the lights that is sampled.
struct LightChoice {
  int emitter;   // kFromEnvironment: the environment
  float chance;  // probability of the emitter or the environment; 0: no light reaches the point
  uvec2 bits;    // a direction of the environment
  float u;       // a point on an emissive triangle
  float v;
  float time;    // time of the path (kMoving)
};

const int kFromEnvironment = -1;

LightChoice makeChoice(int emitter, float chance, uvec2 bits, float u, float v) {
  LightChoice c;
  c.emitter = emitter;
  c.chance = chance;
  c.bits = bits;
  c.u = u;
  c.v = v;
  c.time = 0.0f;
  return c;
}

/// Chooses an emitter by power. `chance` is the probability that the light sample goes to an emitter at all.
LightChoice emitterByPower(float chance, uvec2 bits) {
  int emitter = emitterAt(bits.x);
  uvec4 entry = emitterRow(emitter, 0);
  float share = uintBitsToFloat(entry.w);
  // The place of the bits among the emitter's own numbers.
  float u = min(float(entry.z - bits.x) / (share * 4294967296.0f), float(0.99999994));
  return makeChoice(emitter, chance * share, bits, u, unitFloat(bits.y));
}

/// A light sample by power; onlyTriangles drops punctual lights, which the caller visits one by one.
LightSample emitterLight(float chance, vec3 point, uvec2 bits, bool onlyTriangles, float time) {
  LightChoice c = emitterByPower(chance, bits);
  return lightOfEmitter(c.emitter, c.chance, point, c.u, c.v, onlyTriangles, time);
}

/// Bits of the part of all numbers that begins at `first` and is 1 / `stretch` of them, as bits of their own.
uint stretchBits(uint bits, uint first, float stretch) {
  uint high;
  uint low;
  umulExtended(bits - first, uint(fract(stretch) * 4294967040.0f), high, low);
  return (bits - first) * uint(stretch) + high;
}
