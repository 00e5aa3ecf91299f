// SPDX-License-Identifier: MIT
// Turns the film into a picture for a filter, with the means of a film of guides.
#include "picture/film_means.glsl"

layout(binding = 4) uniform sampler2D guideSums;
layout(binding = 5) uniform sampler2D guideCompensations;
layout(binding = 6) uniform usampler2D guideCounts;

layout(location = 0) out vec4 raw;       // linear R, G, B, and alpha
// Radiance is laid over white where a shadow is in alpha alone; alpha holds the variance of the mean's luminance.
layout(location = 1) out vec4 radiance;
layout(location = 2) out vec2 counts;    // samples; of the variance nothing was observed: -1
layout(location = 3) out vec4 albedo;    // albedo and coverage
layout(location = 4) out vec4 normal;    // normal and depth

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  FilmMeans m = filmMeans(pixel);
  raw = vec4(m.radiance, m.alpha);
  bool overWhite = (texelFetch(filmCounts, pixel, 0).w & kPixelOverWhite) != 0u;
  radiance = vec4(overWhite ? m.radiance + (1.0 - m.alpha) : m.radiance, m.variance);
  counts = vec2(m.samples, -1.0);
  float part = 1.0 / max(float(texelFetch(guideCounts, pixel, 0).x), 1.0);
  albedo = part * texelFetch(guideSums, pixel, 0);
  normal = part * texelFetch(guideCompensations, pixel, 0);
}
