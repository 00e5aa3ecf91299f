// SPDX-License-Identifier: MIT
// Where light paths begin (kLightPaths): at a lamp drawn by its power, aimed at what makes caustics. Balls enclose all
// casters, so that no path that meets one first is left out.

layout(location = 0) uniform vec4 casters[kMostCasters];  // local space: middle, radius
layout(location = kMostCasters) uniform int casterCount;

/// A ray of light. flux: watts over the density with which it was drawn; zero where there is none.
struct Emission {
  vec3 origin;
  vec3 direction;
  vec3 flux;
  float range;  // of a punctual light; 0: none
};

Emission noEmission() {
  Emission e;
  e.origin = vec3(0.0f);
  e.direction = vec3(0.0f, 0.0f, 1.0f);
  e.flux = vec3(0.0f);
  e.range = 0.0f;
  return e;
}

/// A ray towards a caster, and its density: over solid angle, or over the area across parallel rays. 0: there is none.
struct Aim {
  vec3 origin;
  vec3 direction;
  float density;
};

/// 1 less the cosine of half the angle under which a ball is seen: its solid angle over 2 pi. All of the sphere from
/// inside.
float spreadOf(vec4 ball, vec3 point) {
  vec3 towards = vec3(ball) - point;
  float part = ball.w * ball.w / max(dot(towards, towards), float(1e-30));
  return part < 1.0f ? part / (1.0f + sqrt(1.0f - part)) : 2.0f;
}

/// The same, and 0 for a ball that lies behind the plane of a lamp that shines to one side; normal zero: to all.
float seenSpread(int caster, vec3 point, vec3 normal) {
  vec4 ball = casters[caster];
  bool behind = dot(normal, normal) > 0.0f && dot(normal, vec3(ball) - point) <= -ball.w;
  return behind ? 0.0f : spreadOf(ball, point);
}

/// From a point to a caster chosen by its solid angle: uniform over the cone of its ball.
Aim aimFrom(vec3 point, vec3 normal, float choice, vec2 uv) {
  Aim a;
  a.origin = point;
  a.direction = vec3(0.0f, 0.0f, 1.0f);
  a.density = 0.0f;
  float sum = 0.0f;
  for (int i = 0; i < casterCount; ++i) sum += seenSpread(i, point, normal);
  if (sum <= 0.0f) return a;
  float left = choice * sum;
  int chosen = -1;
  float spread = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    float own = seenSpread(i, point, normal);
    bool here = own > 0.0f && left >= 0.0f;
    chosen = here ? i : chosen;
    spread = here ? own : spread;
    left -= own;
  }
  float down = uv.x * spread;
  vec2 around = unitCircle(uv.y) * sqrt(max(0.0f, down * (2.0f - down)));
  vec3 towards = vec3(casters[chosen]) - point;
  vec3 axis = dot(towards, towards) > 0.0f ? normalize(towards) : vec3(0.0f, 0.0f, 1.0f);
  a.direction = normalize(toWorld(frameAround(axis), vec3(around, 1.0f - down)));
  // Every cone that holds the direction could have drawn it.
  float cones = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    float own = seenSpread(i, point, normal);
    vec3 apart = normalize(vec3(casters[i]) - point) - a.direction;
    bool holds = i == chosen || own >= 2.0f || dot(apart, apart) <= 2.0f * own;
    cones += own > 0.0f && holds ? 1.0f : 0.0f;
  }
  a.density = cones / (2.0f * kPi * sum);
  return a;
}

/// Along a direction, from outside of the scene, through the disk of a caster chosen by its area.
Aim aimAlong(vec3 direction, float choice, vec2 uv) {
  float sum = 0.0f;
  for (int i = 0; i < casterCount; ++i) sum += casters[i].w * casters[i].w;
  float left = choice * sum;
  int chosen = 0;
  for (int i = 0; i < casterCount; ++i) {
    chosen = left >= 0.0f ? i : chosen;
    left -= casters[i].w * casters[i].w;
  }
  Frame3 around = frameAround(direction);
  vec2 disk = casters[chosen].w * sampleDisk(uv.x, uv.y);
  vec3 point = vec3(casters[chosen]) + disk.x * around.tangent + disk.y * around.bitangent;
  float disks = 0.0f;
  for (int i = 0; i < casterCount; ++i) {
    vec3 apart = point - vec3(casters[i]);
    apart -= dot(apart, direction) * direction;
    disks += i == chosen || dot(apart, apart) <= casters[i].w * casters[i].w ? 1.0f : 0.0f;
  }
  Aim a;
  a.origin = point - 131072.0f * length(vec3(frame.gridCell)) * direction;  // two diagonals of the scene's box
  a.direction = direction;
  a.density = disks / (kPi * max(sum, float(1e-30)));
  return a;
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
  if (a.density <= 0.0f || cosine <= 0.0f) return e;
  int slot = int(edge2.w);
  float error = uintBitsToFloat((faceRow(slot, 0).w >> kFaceErrorShift) << kFloatErrorShift);
  e.origin = offsetOrigin(point, error, normal, a.direction);
  e.direction = a.direction;
  vec3 radiance = emittedFrom(corner.w & kFaceMaterialMask, slot, w, cosine);
  e.flux = radiance * (cosine / (share * uintBitsToFloat(edge1.w) * a.density));
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
  if (a.density <= 0.0f) return e;
  e.origin = a.origin;
  e.direction = a.direction;
  e.range = parallel ? 0.0f : place.w;
  float cone = 1.0f;
  if (intensity.w == kLightSpot) cone = spotFalloff(axis, uintBitsToFloat(readLights(row + 3).x), a.direction);
  e.flux = vec3(intensity) * (cone / (share * a.density));
  return e;
}

/// Draws a lamp by its power, a point of it, and a direction.
Emission drawEmission(Sampler numbers) {
  int emitter = emitterAt(drawBits(numbers, kLampDimension));
  float share = uintBitsToFloat(emitterRow(emitter, 0).w);
  uint kind = emitterRow(emitter, 3).w;
  bool punctual = kPunctualLights && (kind & kEmitterPunctual) != 0u;
  float choice = drawFloat(numbers, kCasterDimension);
  vec2 aim = drawPair(numbers, kAimDimensions);
  Emission e = noEmission();
  if (share <= 0.0f) return e;
  if (punctual) e = punctualEmission(int(kind & ~kEmitterPunctual), share, choice, aim);
  if (kEmissiveTriangles && !punctual) {
    e = triangleEmission(emitter, share, choice, drawPair(numbers, kLampPointDimensions), aim);
  }
  return e;
}

/// A light path. Until it is seen by the camera, `contribution` is its flux and `shadowLimit` the range of its light.
/// A pass has Sobol points of its own, and as many rows of paths as its height asks for, each as wide as the picture;
/// those beside it bring nothing.
Path startLightPath(ivec2 record, int steps) {
  ivec2 place = inPicture(record);
  uint index = uint(place.y * frame.picture.x + place.x);
  Sampler numbers = makeSampler(pixelKey(uint(frame.sampling.x), 0xfffffffeu, uint(frame.picture.w)), index);
  Emission e = drawEmission(numbers);
  if (place.x >= frame.picture.x) e.flux = vec3(0.0);
  Path p = pathAlong(e.origin, e.direction, numbers, steps);
  p.cameraRay = false;
  p.contribution = e.flux;
  p.shadowLimit = e.range;
  if (maxComponent(e.flux) <= 0.0f) p.phase = kPhaseEnd;
  return p;
}
