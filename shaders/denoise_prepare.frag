// SPDX-License-Identifier: MIT
// The first pass of the variance filter: light without albedo and its variance, and what tells surfaces apart.
#include "denoise.glsl"

layout(binding = 0) uniform sampler2D noisy;    // radiance; variance of its luminance, -1: not known
layout(binding = 1) uniform sampler2D albedos;  // albedo, coverage
layout(binding = 2) uniform sampler2D normals;  // normal, depth; means that count misses as 0, as albedo does

layout(location = 0) out vec4 light;    // light without albedo; variance of the luminance of its mean
layout(location = 1) out vec4 surface;  // albedo of what was hit, coverage
layout(location = 2) out vec4 shape;    // its normal, logarithm of its depth
layout(location = 3) out vec2 slope;    // of that logarithm, a pixel

const int kPool = 1;    // variance is the mean of so many pixels each way
const int kWindow = 2;  // where there is but one sample, that of the luminance within

vec3 lightAt(ivec2 pixel) { return texelFetch(noisy, pixel, 0).rgb / demodulation(texelFetch(albedos, pixel, 0)); }

float varianceAt(ivec2 pixel) {
  float part = brightness(demodulation(texelFetch(albedos, pixel, 0)));
  return texelFetch(noisy, pixel, 0).a / (part * part);
}

float pooledVariance(ivec2 pixel) {
  float sum = 0.0;
  float count = 0.0;
  for (int y = -kPool; y <= kPool; ++y) {
    for (int x = -kPool; x <= kPool; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      if (!inside(other)) continue;
      float variance = varianceAt(other);
      if (variance < 0.0) continue;
      sum += variance;
      count += 1.0;
    }
  }
  return sum / max(count, 1.0);
}

float windowVariance(ivec2 pixel) {
  float sum = 0.0;
  float squares = 0.0;
  float count = 0.0;
  for (int y = -kWindow; y <= kWindow; ++y) {
    for (int x = -kWindow; x <= kWindow; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      if (!inside(other)) continue;
      float value = brightness(lightAt(other));
      sum += value;
      squares += value * value;
      count += 1.0;
    }
  }
  float mean = sum / count;
  return max(squares / count - mean * mean, 0.0);
}

float logDepth(ivec2 pixel) {
  float coverage = max(texelFetch(albedos, pixel, 0).a, 1e-6);
  return log2(max(texelFetch(normals, pixel, 0).a / coverage, 1e-9));
}

/// The smaller of the steps to both neighbours: an edge is on one side.
float slopeAlong(ivec2 pixel, ivec2 axis, float depth) {
  float least = 1e9;
  if (inside(pixel - axis)) least = abs(logDepth(pixel - axis) - depth);
  if (inside(pixel + axis)) least = min(least, abs(logDepth(pixel + axis) - depth));
  return least < 1e9 ? least : 0.0;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 albedo = texelFetch(albedos, pixel, 0);
  float coverage = max(albedo.a, 1e-6);
  bool known = texelFetch(noisy, pixel, 0).a >= 0.0;
  light = vec4(lightAt(pixel), known ? pooledVariance(pixel) : windowVariance(pixel));
  float depth = logDepth(pixel);
  surface = vec4(albedo.rgb / coverage, albedo.a);
  shape = vec4(texelFetch(normals, pixel, 0).xyz / coverage, depth);
  slope = vec2(slopeAlong(pixel, ivec2(1, 0), depth), slopeAlong(pixel, ivec2(0, 1), depth));
}
