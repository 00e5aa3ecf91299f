// SPDX-License-Identifier: MIT
// The light of the environment in the stages before global illumination: the same for each sample, and without shadows
// (docs/design/surfaces.md). Its rows lie behind the map and its backdrop (src/pack/pack_environment.h).

int environmentLightRow() { return kSun ? sunRow() + int(kSunRows) : sunRow(); }

vec3 irradianceFactor(int index) { return vec3(uintBitsToFloat(readEnvironment(environmentLightRow() + index))); }

/// Irradiance of a surface by spherical harmonics (Ramamoorthi and Hanrahan, 2001). Where their sum is negative, 0 is
/// nearer to the irradiance.
vec3 environmentIrradiance(vec3 normal) {
  float c = frame.environmentRotation.x;
  float s = frame.environmentRotation.y;
  vec3 n = vec3(normal.x * c - normal.z * s, normal.y, normal.x * s + normal.z * c);
  vec3 sum = irradianceFactor(0) + n.x * irradianceFactor(1) + n.y * irradianceFactor(2) + n.z * irradianceFactor(3);
  sum += n.x * n.y * irradianceFactor(4) + n.y * n.z * irradianceFactor(5) + n.z * n.x * irradianceFactor(6);
  sum += (n.x * n.x - n.z * n.z) * irradianceFactor(7) + (3.0f * n.y * n.y - 1.0f) * irradianceFactor(8);
  float intensity = frame.environmentScale;
  return max(sum, vec3(0.0f)) * intensity;
}

/// Radiance of a level of lobes; its first and last row are the poles.
vec3 lobeAt(int level, vec2 coordinates) {
  uvec4 place = readEnvironment(environmentLightRow() + int(kIrradianceRows) + level);
  ivec2 size = ivec2(int(place.x), int(place.y));
  vec2 texel = vec2(coordinates.x * float(size.x), coordinates.y * float(size.y - 1) + 0.5f);
  return vec3(mapAt(texel, size, int(place.z)));
}

/// Mean radiance of the environment about a direction, by the lobe of a Blinn-Phong exponent.
vec3 environmentLobe(vec3 direction, float exponent) {
  // A level has the exponent 2 * 4^level - 2.
  float level = clamp(log(0.5f * exponent + 1.0f) * float(0.72134752044448170), 0.0f, float(kLobeLevels - 1u));
  int lower = min(int(level), int(kLobeLevels) - 2);
  vec2 coordinates = environmentCoordinates(direction);
  float intensity = frame.environmentScale;
  return mix(lobeAt(lower, coordinates), lobeAt(lower + 1, coordinates), level - float(lower)) * intensity;
}

/// The light that a surface of these colours sends to `wo`. The wider the lobe, the nearer its middle is to the
/// normal.
vec3 environmentReflected(vec3 diffuse, vec3 f0, float exponent, vec3 normal, vec3 wo) {
  vec3 reflected = kInversePi * diffuse * environmentIrradiance(normal);
  if (!kSpecular) return reflected;
  vec3 middle = normalize(mix(normal, mirrorDirection(wo, normal), exponent / (exponent + 8.0f)));
  return reflected + phongAlbedo(exponent, dot(normal, wo)) * f0 * environmentLobe(middle, exponent);
}
