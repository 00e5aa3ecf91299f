// SPDX-License-Identifier: MIT
// The disc of the sun before the map of the sky (kSun), and the sun of a map that was read (kMapSun). Their rows lie
// behind the map and its backdrop (src/pack/pack_environment.h).

struct Sun {
  vec3 direction;  // direction of the disc's middle, in the scene
  float chance;    // probability that a light sample of the environment takes the sun
  vec3 radiance;   // radiance of the disc's middle, before the environment's factor
  float pdf;       // over solid angle, of a direction to its middle when the sun is taken
};

/// Rows of a map, two texels each.
int mapRows(ivec2 size) { return (size.x * size.y + 1) >> 1; }

int sunRow() { return mapRows(ivec2(frame.environmentSize)) + mapRows(frame.backdropSize); }

/// Returns true if so bright a place of the map is its sun (kMapSun).
bool isMapSun(vec3 radiance) {
  float level = uintBitsToFloat(readEnvironment(sunRow() + 2).x);
  return luminance(radiance) >= level * frame.environmentScale;
}

Sun sunOfSky() {
  int row = sunRow();
  vec4 place = uintBitsToFloat(readEnvironment(row));
  vec4 light = uintBitsToFloat(readEnvironment(row + 1));
  float c = frame.environmentRotation.x;
  float s = frame.environmentRotation.y;
  Sun sun;
  sun.direction = vec3(place.x * c + place.z * s, place.y, -place.x * s + place.z * c);
  sun.chance = place.w;
  sun.radiance = vec3(light);
  sun.pdf = light.w;
  return sun;
}

/// The powers of the cosine at its surface by which the sun gets darker to the limb (kLimbPowers, src/scene/sky/sky.h).
const vec3 kLimb = vec3(0.456f, 0.508f, 0.605f);

/// The radiance of a place of the disc as a part of that of its middle (docs/design/sky.md). squared: the square of the
/// cosine at the sun's surface.
float limbOf(float squared, float power) { return pow(squared, 0.5f * power); }

/// The radiance of the disc along a direction, and the pdf with which sampleSun() draws it as a part of that of its
/// middle. Zeros outside the disc; the ground hides what is below the horizon.
vec4 discAlong(Sun sun, vec3 direction) {
  float radius = kSunRadius;
  vec3 off = (direction - sun.direction) / radius;
  float squared = 1.0f - dot(off, off);
  if (squared <= 0.0f) return vec4(0.0f);
  float green = limbOf(squared, kLimb.y);
  vec3 limb = vec3(limbOf(squared, kLimb.x), green, limbOf(squared, kLimb.z));
  float intensity = direction.y > 0.0f ? frame.environmentScale : 0.0f;
  return vec4(sun.radiance * limb * intensity, green);
}

/// Adds the disc to radiance and pdf of the map along a direction, which environmentAt gives.
vec4 withSun(vec4 there, vec3 direction) {
  Sun sun = sunOfSky();
  vec4 disc = discAlong(sun, direction);
  float sine = sqrt(max(0.0f, 1.0f - direction.y * direction.y));
  there.w = (1.0f - sun.chance) * there.w + sun.chance * sun.pdf * disc.w * 2.0f * kPi * kPi * sine;
  return there + vec4(vec3(disc), 0.0f);
}

/// A direction to the disc by the radiance of its green light.
vec3 sampleSun(Sun sun, float u, float v) {
  float power = kLimb.y;
  float squared = pow(1.0f - u, 2.0f / (2.0f + power));
  float radius = kSunRadius;
  vec2 around = unitCircle(v) * (radius * sqrt(max(0.0f, 1.0f - squared)));
  return normalize(toWorld(frameAround(sun.direction), vec3(around, 1.0f)));
}
