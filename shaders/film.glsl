// SPDX-License-Identifier: MIT
// The film: per pixel, the compensated sum of all samples, their variance and their counts. Samples are added one by one
// in order, so the result does not depend on how they were split into draws.

layout(rgba32f, binding = kFilmSumBinding) uniform restrict image2D filmSum;
layout(rgba32f, binding = kFilmCompensationBinding) uniform restrict image2D filmCompensation;
layout(rgba32ui, binding = kFilmCountsBinding) uniform restrict uimage2D filmCounts;

struct FilmPixel {
  vec3 sum;
  float alpha;
  vec3 compensation;
  float m2;          // sum of squared deviations of the luminance from its mean
  uint samples;
  uint rays;
  uint nonfinite;
  uint flags;
};

FilmPixel loadFilm(ivec2 pixel) {
  vec4 sum = imageLoad(filmSum, pixel);
  vec4 compensation = imageLoad(filmCompensation, pixel);
  uvec4 counts = imageLoad(filmCounts, pixel);
  return FilmPixel(sum.rgb, sum.a, compensation.rgb, compensation.a, counts.x, counts.y, counts.z, counts.w);
}

void storeFilm(ivec2 pixel, FilmPixel f) {
  imageStore(filmSum, pixel, vec4(f.sum, f.alpha));
  imageStore(filmCompensation, pixel, vec4(f.compensation, f.m2));
  imageStore(filmCounts, pixel, uvec4(f.samples, f.rays, f.nonfinite, f.flags));
}

/// Infinite or NaN, told by its bits, since a compiler may take isnan() for false.
bool isNonfinite(float x) { return (floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u; }

/// Adds one sample (Kahan, Further Remarks on Reducing Truncation Errors, 1965; Welford, 1962). One that is not finite is counted and adds black.
FilmPixel addSample(FilmPixel f, vec3 radiance, float alpha) {
  if (isNonfinite(radiance.x) || isNonfinite(radiance.y) || isNonfinite(radiance.z)) {
    f.nonfinite += 1u;
    radiance = vec3(0.0);
  }
  float before = f.samples > 0u ? luminance(f.sum) / float(f.samples) : 0.0;
  precise vec3 y = radiance - f.compensation;
  precise vec3 t = f.sum + y;
  precise vec3 lost = (t - f.sum) - y;
  f.compensation = lost;
  f.sum = t;
  f.alpha += alpha;
  f.samples += 1u;
  float value = luminance(radiance);
  float after = luminance(f.sum) / float(f.samples);
  f.m2 += (value - before) * (value - after);
  return f;
}
