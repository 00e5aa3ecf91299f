// SPDX-License-Identifier: MIT
// The environment: an equirectangular map, bilinear; drawn from by the luminance of its texels.

/// Texture coordinates of a direction (docs/conventions.md); the rotation is undone first.
vec2 environmentCoordinates(vec3 d) {
  float c = frame.environment.z;
  float s = frame.environment.w;
  vec3 r = vec3(d.x * c - d.z * s, d.y, d.x * s + d.z * c);
  return vec2(atan(r.z, r.x) * (0.5f * kInversePi) + 0.5f, acos(clamp(r.y, -1.0f, 1.0f)) * kInversePi);
}

vec3 environmentDirection(vec2 uv) {
  vec2 around = unitCircle(uv.x);  // half a turn from the direction
  vec2 down = unitCircle(0.5f * uv.y);
  vec3 r = vec3(-down.y * around.x, down.x, -down.y * around.y);
  float c = frame.environment.z;
  float s = frame.environment.w;
  return vec3(r.x * c + r.z * s, r.y, -r.x * s + r.z * c);
}

vec4 environmentTexel(ivec2 p, ivec2 size) { return uintBitsToFloat(readEnvironment(p.y * size.x + p.x)); }

vec3 environmentRadiance(vec3 direction) {
  if (!kEnvironment) return vec3(0.0f);
  ivec2 size = ivec2(frame.environment);
  vec2 position = environmentCoordinates(direction) * vec2(size) - vec2(0.5f);
  vec2 base = floor(position);
  vec2 f = position - base;
  // Round the seam without a division of integers, which llvmpipe does lane by lane; the position is in -0.5..width.
  int x0 = int(base.x) < 0 ? size.x - 1 : min(int(base.x), size.x - 1);
  int x1 = x0 + 1 == size.x ? 0 : x0 + 1;
  int y0 = clamp(int(base.y), 0, size.y - 1);
  int y1 = clamp(int(base.y) + 1, 0, size.y - 1);
  vec4 top = mix(environmentTexel(ivec2(x0, y0), size), environmentTexel(ivec2(x1, y0), size), f.x);
  vec4 bottom = mix(environmentTexel(ivec2(x0, y1), size), environmentTexel(ivec2(x1, y1), size), f.x);
  return vec3(mix(top, bottom, f.y));
}

/// Density over solid angle with which sampleEnvironment draws a direction.
float environmentDensity(vec3 direction) {
  ivec2 size = ivec2(frame.environment);
  vec2 uv = environmentCoordinates(direction);
  ivec2 p = clamp(ivec2(uv * vec2(size)), ivec2(0), size - 1);
  float sine = sqrt(max(0.0f, 1.0f - direction.y * direction.y));
  return environmentTexel(p, size).w / max(2.0f * kPi * kPi * sine, float(1e-12));
}

/// An entry of an alias table (Walker, 1977) drawn with 32 random bits: its index, and where in the entry the bits fall, in [0, 1). One number
/// for both, so that what is stratified over the whole table stays so within its entries.
struct TablePlace {
  int index;
  float within;
};

TablePlace placeInTable(uint bits, uint count) {
  uint high;
  uint low;
  umulExtended(bits, count, high, low);
  TablePlace place;
  place.index = int(high);
  place.within = unitFloat(low);
  return place;
}

/// `within` as a number of its own in the part below or above the threshold, in [0, 1).
float withinPart(float within, float threshold) {
  float u = within < threshold ? within / threshold : (within - threshold) / (1.0f - threshold);
  return min(u, float(0.99999994));
}

/// A direction drawn by the alias table of the texels, uniform within one.
vec3 sampleEnvironment(uvec2 bits) {
  ivec2 size = ivec2(frame.environment);
  TablePlace place = placeInTable(bits.x, uint(size.x * size.y));
  uvec2 entry = readEnvironmentAlias(place.index);
  float threshold = uintBitsToFloat(entry.x);
  int index = place.within < threshold ? place.index : int(entry.y);
  vec2 texel = vec2(index % size.x, index / size.x);
  return environmentDirection((texel + vec2(withinPart(place.within, threshold), unitFloat(bits.y))) / vec2(size));
}
