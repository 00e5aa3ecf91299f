// SPDX-License-Identifier: MIT
// The film as a picture: means of its samples, and of those of a film of guides (film_pixel.glsl).
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D sums;
layout(binding = 1) uniform sampler2D compensations;
layout(binding = 2) uniform usampler2D filmCounts;
layout(binding = 3) uniform sampler2D splats;        // of light paths
layout(binding = 4) uniform sampler2D guideSums;
layout(binding = 5) uniform sampler2D guideCompensations;
layout(binding = 6) uniform usampler2D guideCounts;
layout(location = 1) uniform float lightPaths;       // whose light is in the splats

layout(location = 0) out vec4 shown;     // linear R, G, B, and alpha
layout(location = 1) out vec4 radiance;  // with the variance of the mean's luminance
layout(location = 2) out vec2 counts;    // samples; of the variance nothing was observed: -1
layout(location = 3) out vec4 albedo;    // with coverage
layout(location = 4) out vec4 normal;    // with depth

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 sum = texelFetch(sums, pixel, 0);
  vec4 rest = texelFetch(compensations, pixel, 0);
  float samples = float(texelFetch(filmCounts, pixel, 0).x);
  float each = 1.0 / max(samples, 1.0);
  vec3 mean = each * (sum.rgb - rest.rgb);
  float variance = samples > 1.0 ? each / (samples - 1.0) * rest.a : 0.0;
  if (lightPaths > 0.0 && samples > 0.0) {
    // Every pixel gets the mean of all light paths, as if each of its samples had brought it (Film::addSplats).
    vec4 splat = texelFetch(splats, pixel, 0) / lightPaths;
    float value = luminance(splat.rgb);
    mean += splat.rgb;
    if (samples > 1.0) variance += max(0.0, splat.a - value * value) / max(lightPaths - 1.0, 1.0);
  }
  shown = vec4(mean, each * sum.a);
  radiance = vec4(mean, variance);
  counts = vec2(samples, -1.0);
  float part = 1.0 / max(float(texelFetch(guideCounts, pixel, 0).x), 1.0);
  albedo = part * texelFetch(guideSums, pixel, 0);
  normal = part * texelFetch(guideCompensations, pixel, 0);
}
