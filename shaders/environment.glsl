// SPDX-License-Identifier: MIT
// The environment: an equirectangular map, bilinear. Directions are drawn by inversion of its luminance, so that
// stratified numbers give stratified directions.

/// Texture coordinates of a direction (docs/design/conventions.md); the rotation is undone first.
vec2 environmentCoordinates(vec3 d) {
  float c = frame.environmentRotation.x;
  float s = frame.environmentRotation.y;
  vec3 r = vec3(d.x * c - d.z * s, d.y, d.x * s + d.z * c);
  return vec2(atan(r.z, r.x) * (0.5f * kInversePi) + 0.5f, acos(clamp(r.y, -1.0f, 1.0f)) * kInversePi);
}

/// u may lie beyond 0..1 by whole turns.
vec3 environmentDirection(vec2 uv) {
  vec2 around = unitCircle(uv.x - floor(uv.x));  // half a turn from the direction
  vec2 down = unitCircle(0.5f * uv.y);
  vec3 r = vec3(-down.y * around.x, down.x, -down.y * around.y);
  float c = frame.environmentRotation.x;
  float s = frame.environmentRotation.y;
  return vec3(r.x * c + r.z * s, r.y, -r.x * s + r.z * c);
}

/// Radiance and pdf of a texel, as src/pack/pack_environment.h packs them.
vec4 environmentTexel(ivec2 p, ivec2 size, int first) {
  uvec2 texel = readEnvironmentTexel(2 * first + p.y * size.x + p.x);
  uvec3 digits = uvec3(texel.x & 4095u, (texel.x >> 12u) & 4095u, ((texel.x >> 24u) << 4u) | (texel.y & 15u));
  float unit = uintBitsToFloat((((texel.y >> 4u) & 127u) + 64u) << 23u);
  return vec4(vec3(digits) * unit, uintBitsToFloat((texel.y >> 11u) << 10u));
}

/// Reads a map whose rows begin at `first`, at a place in texels: the middle of the first texel is 0.5, and places
/// reach from -0.5 to half a texel beyond the width.
vec4 mapAt(vec2 place, ivec2 size, int first) {
  vec2 position = place - vec2(0.5f);
  vec2 base = floor(position);
  vec2 f = position - base;
  // Wraps around the seam without a division of integers, which llvmpipe does lane by lane.
  int x0 = int(base.x) < 0 ? size.x - 1 : min(int(base.x), size.x - 1);
  int x1 = x0 + 1 == size.x ? 0 : x0 + 1;
  int y0 = clamp(int(base.y), 0, size.y - 1);
  int y1 = clamp(int(base.y) + 1, 0, size.y - 1);
  vec4 top = mix(environmentTexel(ivec2(x0, y0), size, first), environmentTexel(ivec2(x1, y0), size, first), f.x);
  vec4 bottom = mix(environmentTexel(ivec2(x0, y1), size, first), environmentTexel(ivec2(x1, y1), size, first), f.x);
  return mix(top, bottom, f.y);
}

/// Radiance and pdf at a place of the environment. The pdf is relative to an even one over the map's area.
vec4 environmentAt(vec2 place) {
  vec4 there = mapAt(place, ivec2(frame.environmentSize), 0);
  float intensity = frame.environmentScale;
  return vec4(vec3(there) * intensity, there.w);
}

/// Returns the same for a direction, without the sun.
vec4 mapAlong(vec3 direction) {
  return environmentAt(environmentCoordinates(direction) * vec2(ivec2(frame.environmentSize)));
}

/// Returns the same with the sun.
vec4 environmentAlong(vec3 direction) {
  if (!kEnvironment) return vec4(0.0f);
  if (kSun) return withSun(mapAlong(direction), direction);
  return mapAlong(direction);
}

/// Radiance along a direction without the sun, which light paths bring: that before the map, and that in it (kMapSun).
vec3 mapBesideSun(vec3 direction) {
  vec3 there = vec3(mapAlong(direction));
  return kMapSun && isMapSun(there) ? vec3(0.0f) : there;
}

/// Radiance that camera rays see instead of the environment (kBackdrop).
vec3 backdropAlong(vec3 direction) {
  ivec2 size = frame.backdropSize;
  int first = mapRows(ivec2(frame.environmentSize));
  float intensity = frame.environmentScale;
  return vec3(mapAt(environmentCoordinates(direction) * vec2(size), size, first)) * intensity;
}

/// The pdf over solid angle with which sampleEnvironment draws a direction. along: environmentAlong of that
/// direction.
float environmentPdf(vec4 along, vec3 direction) {
  float sine = sqrt(max(0.0f, 1.0f - direction.y * direction.y));
  return along.w / max(2.0f * kPi * kPi * sine, float(1e-12));
}

/// One of `count` equal parts of the 32-bit numbers, and the place of the bits within it, in [0, 1).
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

/// The place that bits draw, by the `count` steps of a table from row `firstRow` on (src/pack/pack_environment.h).
float invertTable(int firstRow, uint count, uint bits) {
  TablePlace place = placeInTable(bits, count);
  uvec4 row = readEnvironmentInversion(firstRow + place.index);
  float first = float(row.z & 0xffffu) * float(1.0 / 65536.0);
  float second = float(row.z >> 16) * float(1.0 / 65536.0);
  float firstPlace = float(row.w & 0xffffu);
  float secondPlace = float(row.w >> 16);
  bool afterFirst = place.within >= first;
  bool afterSecond = place.within >= second;
  // A change at 0 is no change: the step begins at its own place.
  float begin = mix(mix(0.0f, first, afterFirst), second, afterSecond);
  float end = mix(mix(first, second, afterFirst), 1.0f, afterSecond);
  float low = mix(mix(firstPlace, secondPlace, afterSecond), uintBitsToFloat(row.x), begin == 0.0f);
  float high = mix(mix(firstPlace, secondPlace, afterFirst), uintBitsToFloat(row.y), afterSecond);
  return mix(low, high, (place.within - begin) / (end - begin));
}

/// Draws a number by the pdf 1 - |x|.
float sampleTent(float u) { return u < 0.5f ? sqrt(2.0f * u) - 1.0f : 1.0f - sqrt(2.0f - 2.0f * u); }

/// Draws a place of the map, in texels. Bilinear filtering turns each texel into a tent about its middle. So drawing a
/// texel and a place in its tent has the pdf that environmentAt gives. The part of a row's tent beyond a pole is
/// spread over half a texel by clamping.
vec2 sampleEnvironment(uvec2 bits) {
  ivec2 size = ivec2(frame.environmentSize);
  float row = invertTable(0, uint(size.y), bits.y);
  int y = min(int(row), size.y - 1);
  float inRow = row - float(y);
  bool atPole = inRow < 0.5f ? y == 0 : y + 1 == size.y;
  int steps = clamp(size.x / 2, 1, kMostEnvironmentSteps);
  float column = invertTable(size.y + y * steps, uint(steps), bits.x);
  float x = min(floor(column), float(size.x - 1));
  return vec2(x + 0.5f + sampleTent(column - x), float(y) + (atPole ? inRow : 0.5f + sampleTent(inRow)));
}

/// A direction to the sun with its chance, else one of the map (kSun).
vec3 sampleSky(uvec2 bits) {
  Sun sun = sunOfSky();
  uint border = uint(sun.chance * 4294967040.0f);
  if (bits.x < border) return sampleSun(sun, float(bits.x) / float(border), unitFloat(bits.y));
  bits.x = uint(float(bits.x - border) / float(0xffffffffu - border) * 4294967040.0f);
  return environmentDirection(sampleEnvironment(bits) / vec2(ivec2(frame.environmentSize)));
}
