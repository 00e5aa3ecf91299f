// SPDX-License-Identifier: MIT
// Adds the samples of a past picture to those of the present one, as far as noise explains their difference.
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D radiances;  // the present, from film.frag
layout(binding = 1) uniform sampler2D counts;
layout(binding = 2) uniform sampler2D pasts;      // these are outputs of reproject.frag
layout(binding = 3) uniform sampler2D aparts;
layout(location = 1) uniform float most;          // samples that the past counts for

layout(location = 0) out vec4 radiance;
layout(location = 1) out vec2 count;

/// x: the square of the past's error around the pixel, which is the larger of the squared mean difference and
/// the mean squared difference, each less its noise. y: the variance of one pixel's difference.
vec2 wrongness(ivec2 pixel) {
  const int reach = 2;  // pixels each way that tell whether the past still holds
  vec2 sums = vec2(0.0);
  float pixels = 0.0;
  float beyond = 0.0;
  float known = 0.0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (((x ^ y) & 1) != 0) continue;
      ivec2 other = pixel + ivec2(x, y);
      if (!inside(other)) continue;
      vec4 apart = texelFetch(aparts, other, 0);
      sums += apart.w * vec2(apart.x, apart.x * apart.x);
      pixels += apart.w;
      if (apart.w > 0.0 && apart.y >= 0.0) {
        beyond += apart.x * apart.x - apart.y;
        known += 1.0;
      }
    }
  }
  float mean = sums.x / pixels;
  float spread = max(sums.y / pixels - mean * mean, 0.0);
  float bias = max(mean * mean - spread / pixels, 0.0);
  if (known > 0.0) bias = max(bias, beyond / known);
  return vec2(bias, spread);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  radiance = texelFetch(radiances, pixel, 0);
  count = texelFetch(counts, pixel, 0).xy;
  vec4 apart = texelFetch(aparts, pixel, 0);
  if (!(apart.z > 0.0)) return;
  vec4 past = texelFetch(pasts, pixel, 0);
  // The mean of n samples has the variance v. A past with the error b counts as n v / b^2 samples, which gives the
  // least error.
  vec2 wrong = wrongness(pixel);
  float noise = count.x > 1.0 ? radiance.a : wrong.y;
  float worth = wrong.x > 0.0 ? count.x * noise / wrong.x : most;
  float counted = min(min(apart.z, most), worth);
  if (!(counted > 0.0)) return;
  float samples = count.x + counted;
  // A past of more samples than count gets the variance of as many as count.
  float pastVariance = past.a * apart.z / counted;
  // Chan, Golub and LeVeque (1979).
  float m2 = radiance.a * count.x * (count.x - 1.0) + pastVariance * counted * max(counted - 1.0, 0.0) +
             apart.x * apart.x * count.x * counted / samples;
  radiance = vec4((radiance.rgb * count.x + past.rgb * counted) / samples, m2 / (samples * max(samples - 1.0, 1e-3)));
  count.x = samples;
}
