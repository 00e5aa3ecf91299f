// SPDX-License-Identifier: MIT
// One pixel of the film: the compensated sum of all samples, their variance and their counts. Samples are added one by
// one in order, so the result does not depend on how they were split into draws.

struct FilmPixel {
  vec3 sum;
  float alpha;
  vec3 compensation;
  float m2;          // sum of squared deviations of seenLuminance() from its mean
  uint samples;
  uint rays;
  uint nonfinite;
  uint flags;
};

/// Returns true for infinity, NaN, and values so large (2^96) that the sum of the most samples of a pixel would be
/// infinite. It tests the bits, since a compiler may take isnan() for false.
bool isNonfinite(float x) { return (floatBitsToUint(x) & 0x7f800000u) >= 0x6f800000u; }

/// Luminance of light and alpha, up to a constant. A shadow that is in alpha alone counts as laid over white.
float seenLuminance(FilmPixel f, vec3 light, float alpha) {
  bool overWhite = kShadowCatcher && (f.flags & kPixelOverWhite) != 0u;
  return overWhite ? luminance(light) - alpha : luminance(light);
}

/// Adds one sample (Kahan, Further Remarks on Reducing Truncation Errors, 1965; Welford, 1962). A sample that is not
/// finite is counted and adds black.
FilmPixel addSample(FilmPixel f, vec3 radiance, float alpha) {
  if (isNonfinite(radiance.x) || isNonfinite(radiance.y) || isNonfinite(radiance.z)) {
    f.nonfinite += 1u;
    radiance = vec3(0.0f);
  }
  float before = f.samples > 0u ? seenLuminance(f, f.sum, f.alpha) / float(f.samples) : 0.0f;
  precise vec3 y = radiance - f.compensation;
  precise vec3 t = f.sum + y;
  precise vec3 lost = (t - f.sum) - y;
  f.compensation = lost;
  f.sum = t;
  f.alpha += alpha;
  f.samples += 1u;
  float value = seenLuminance(f, radiance, alpha);
  float after = seenLuminance(f, f.sum, f.alpha) / float(f.samples);
  // The square may be infinite where the value is not.
  f.m2 = min(f.m2 + (value - before) * (value - after), float(3.0e38));
  return f;
}

/// Adds guides (kAovGuides), in plain sums: the normal instead of the compensation, depth instead of the squares
/// (Film::readGuides).
FilmPixel addGuides(FilmPixel f, vec3 albedo, vec3 normal, float depth, float alpha) {
  f.samples += 1u;
  f.alpha += alpha;
  if (isNonfinite(dot(albedo, vec3(1.0f))) || isNonfinite(dot(normal, vec3(1.0f))) || isNonfinite(depth)) {
    f.nonfinite += 1u;
    return f;
  }
  f.sum += albedo;
  f.compensation += normal;
  f.m2 += depth;
  return f;
}
