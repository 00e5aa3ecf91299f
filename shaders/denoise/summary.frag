// SPDX-License-Identifier: MIT
// The variance filter needs three sums over the whole picture. This is the first pass of each: it sums over blocks of
// 16 x 16 pixels; sums.frag continues until one texel is left.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D noisy;    // the input of prepare.frag
layout(binding = 1) uniform sampler2D albedos;
layout(binding = 2) uniform sampler2D counts;
layout(binding = 3) uniform sampler2D means;    // the steps before this one
layout(binding = 4) uniform sampler2D logarithms;
// The sum: 0 of light, of pixels that have any, and of samples; 1 of logarithms of light; 2 of observed variance, and
// of that of independent samples.
layout(location = 1) uniform int part;

layout(location = 0) out vec4 sum;

/// A pixel's part of the sum. Light of no surface, and light that is not finite, counts as nothing.
vec4 termOf(ivec2 pixel) {
  vec4 radiance = texelFetch(noisy, pixel, 0);
  vec4 albedo = texelFetch(albedos, pixel, 0);
  vec2 count = texelFetch(counts, pixel, 0).xy;
  float light = luminance(radiance.rgb / demodulation(albedo));
  bool counted = albedo.a > 0.0 && abs(light) < 3e38;
  light = max(light, 0.0);
  vec4 mean = texelFetch(means, ivec2(0), 0);
  if (part == 0) return vec4(counted ? vec2(light, 1.0) : vec2(0.0), max(count.x, 0.0), 0.0);
  if (part == 1) return vec4(counted ? log(max(light, leastLight(mean))) : 0.0);
  float scale = scaleOf(mean, texelFetch(logarithms, ivec2(0), 0));
  float bright = luminance(scaledLight(radiance.rgb, scale));
  float weight = count.x > 1.0 ? 1.0 / (bright * bright + kDarkSquared) : 0.0;
  return vec4(weight * scaledVariance(max(count.y, 0.0), scale), weight * scaledVariance(radiance.a, scale), 0.0, 0.0);
}

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * kBlock;
  ivec2 end = min(corner + kBlock, size);
  sum = vec4(0.0);
  for (int y = corner.y; y < end.y; ++y) {
    vec4 row = vec4(0.0);
    for (int x = corner.x; x < end.x; ++x) row += termOf(ivec2(x, y));
    sum += row;
  }
}
