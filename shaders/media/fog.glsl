// SPDX-License-Identifier: MIT
// Fog in a ball round the scene. Its extinction is grey, so that flights are drawn exactly: constant up to a height,
// and falling exponentially above.

/// (1 - exp(-x)) / x.
float fallingMean(float x) {
  float series = 1.0f - x * (0.5f - x * (float(1.0 / 6.0) - x * float(1.0 / 24.0)));
  return abs(x) < float(0.02) ? series : (1.0f - exp(-x)) / x;
}

/// -log(1 - x) / x.
float risingMean(float x) {
  float series = 1.0f + x * (0.5f + x * (float(1.0 / 3.0) + x * 0.25f));
  return abs(x) < float(0.02) ? series : -log(1.0f - x) / x;
}

/// Mean density between two heights over the base, that at the base being 1.
float meanFogDensity(float a, float b, float inverseHeight) {
  float low = min(a, b);
  float high = max(a, b);
  float start = max(low, 0.0f);
  float above = max(high - start, 0.0f);
  float below = high - low - above;
  float falling = exp(-start * inverseHeight) * fallingMean(above * inverseHeight);
  return high > low ? (below + above * falling) / (high - low) : exp(-start * inverseHeight);
}

/// The part of a ray inside of the ball: distances of entry, not below `from`, and exit; an exit before the entry is
/// none.
vec2 insideFog(Fog f, vec3 origin, vec3 direction, float from) {
  vec3 towards = vec3(f.ball) - origin;
  float middle = dot(towards, direction);
  vec3 aside = towards - middle * direction;
  float squared = f.ball.w * f.ball.w - dot(aside, aside);
  if (squared <= 0.0f) return vec2(from, -1.0f);
  float halfChord = sqrt(squared);
  return vec2(max(from, middle - halfChord), middle + halfChord);
}

/// Optical depth of a ray between two distances.
float fogDepth(Fog f, vec3 origin, vec3 direction, float from, float to) {
  vec2 inside = insideFog(f, origin, direction, from);
  float exit = min(inside.y, to);
  if (exit <= inside.x) return 0.0f;
  float start = origin.y - f.density.z;
  float mean = meanFogDensity(start + inside.x * direction.y, start + exit * direction.y, f.density.y);
  return f.density.x * (exit - inside.x) * mean;
}

/// The distance from a height over the base on at which a ray has the optical depth, `slope` being its rise per
/// distance; kFarAway where it never has. The density at the base is `extinction`.
float fogReach(float extinction, float inverseHeight, float height, float slope, float depth) {
  // The part before the base is passed, or all of it.
  bool above = height >= 0.0f;
  float toBase = (height < 0.0f) == (slope > 0.0f) && slope != 0.0f ? abs(height / slope) : kFarAway;
  float density = above ? extinction * exp(-height * inverseHeight) : extinction;
  float x = depth * inverseHeight * slope / max(density, float(1e-37));
  if (above && x >= 1.0f) return kFarAway;
  float reach = above ? depth / density * risingMean(x) : depth / density;
  if (reach <= toBase) return reach;
  float rest = depth - density * toBase * (above ? fallingMean(toBase * inverseHeight * slope) : 1.0f);
  x = rest * inverseHeight * slope / extinction;
  if (!above && x >= 1.0f) return kFarAway;
  return toBase + (above ? rest / extinction : rest / extinction * risingMean(x));
}

/// The distance at which a flight that begins at `from` ends, for a uniform number; kFarAway where it leaves the ball.
float fogFlight(Fog f, vec3 origin, vec3 direction, float from, float u) {
  vec2 inside = insideFog(f, origin, direction, from);
  if (inside.y <= inside.x || f.density.x <= 0.0f) return kFarAway;
  float height = origin.y - f.density.z + inside.x * direction.y;
  float end = inside.x + fogReach(f.density.x, f.density.y, height, direction.y, -log(1.0f - u));
  return end < inside.y ? end : kFarAway;
}
