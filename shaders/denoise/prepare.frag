// SPDX-License-Identifier: MIT
// The first pass of the variance filter: light without albedo, its variance, and the guides.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D noisy;    // radiance; variance of its luminance from independent samples
layout(binding = 1) uniform sampler2D albedos;  // albedo, coverage
layout(binding = 2) uniform sampler2D normals;  // normal, depth; means that count misses as 0, as albedo does
// samples; one observation of the variance (observedVariance() of src/render/film/noise.h), negative: none
layout(binding = 3) uniform sampler2D counts;
layout(binding = 4) uniform sampler2D means;    // output of summary.frag
layout(binding = 5) uniform sampler2D logarithms;

layout(location = 0) out vec4 light;      // without albedo; variance of its luminance, -1: not known
layout(location = 1) out float observed;  // of it
layout(location = 2) out uvec4 guide;

float logDepth(ivec2 pixel) {
  float coverage = max(texelFetch(albedos, pixel, 0).a, 1e-6);
  return log2(max(texelFetch(normals, pixel, 0).a / coverage, 1e-9));
}

/// The smaller of the steps to both neighbours, because an edge is on one side only.
float slopeAlong(ivec2 pixel, ivec2 axis, float depth) {
  float least = 1e4;
  if (inside(pixel - axis)) least = min(least, abs(logDepth(pixel - axis) - depth));
  if (inside(pixel + axis)) least = min(least, abs(logDepth(pixel + axis) - depth));
  return least < 1e4 ? least : 0.0;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 radiance = texelFetch(noisy, pixel, 0);
  vec4 albedo = texelFetch(albedos, pixel, 0);
  vec4 normal = texelFetch(normals, pixel, 0);
  vec3 divisor = demodulation(albedo);
  float part = luminance(divisor);
  float scale = scaleOf(texelFetch(means, ivec2(0), 0), texelFetch(logarithms, ivec2(0), 0));
  vec2 count = texelFetch(counts, pixel, 0).xy;
  light = vec4(scaledLight(radiance.rgb, scale) / divisor,
               count.x > 1.0 ? scaledVariance(radiance.a, scale) / (part * part) : -1.0);
  observed = scaledVariance(count.y, scale) / (part * part);
  float coverage = max(albedo.a, 1e-6);
  float depth = logDepth(pixel);
  guide = packedGuide(Guide(vec4(albedo.rgb / coverage, albedo.a), normal.xyz / coverage, depth,
                            vec2(slopeAlong(pixel, ivec2(1, 0), depth), slopeAlong(pixel, ivec2(0, 1), depth))));
}
