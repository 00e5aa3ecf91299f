// SPDX-License-Identifier: MIT
// The film's means (film_pixel.glsl), and the light of light paths.
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D sums;
layout(binding = 1) uniform sampler2D compensations;
layout(binding = 2) uniform usampler2D filmCounts;
layout(binding = 3) uniform sampler2D splats;
layout(location = 1) uniform vec2 lightPaths;  // weight and squared weight of those whose light is in the splats

struct FilmMeans {
  vec3 radiance;
  float alpha;
  float variance;  // variance of the mean's luminance
  float samples;
};

FilmMeans filmMeans(ivec2 pixel) {
  vec4 sum = texelFetch(sums, pixel, 0);
  vec4 rest = texelFetch(compensations, pixel, 0);
  float samples = float(texelFetch(filmCounts, pixel, 0).x);
  float each = 1.0 / max(samples, 1.0);
  FilmMeans m = FilmMeans(each * (sum.rgb - rest.rgb), each * sum.a, 0.0, samples);
  if (samples > 1.0) m.variance = each / (samples - 1.0) * rest.a;
  if (lightPaths.x > 0.0 && samples > 0.0) {
    // Every pixel gets the mean of all light paths, as if each of its samples had brought it (Film::addSplats).
    vec4 splat = texelFetch(splats, pixel, 0) / lightPaths.xxxy;
    float value = luminance(splat.rgb);
    float paths = lightPaths.x * lightPaths.x / lightPaths.y;
    m.radiance += splat.rgb;
    if (samples > 1.0) m.variance += max(0.0, splat.a - value * value) / max(paths - 1.0, 1.0);
  }
  return m;
}
