// SPDX-License-Identifier: MIT
// The last pass of the variance filter. Filtered light counts only as far as its distance from the noisy light is noise
// (James and Stein 1961, over a window of like surfaces). Then the albedo is multiplied back in.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D lights;    // noisy
layout(binding = 1) uniform sampler2D filtered;
layout(binding = 2) uniform sampler2D moved;
layout(binding = 3) uniform usampler2D guides;
layout(binding = 4) uniform sampler2D albedos;
layout(binding = 5) uniform sampler2D means;     // output of summary.frag
layout(binding = 6) uniform sampler2D logarithms;

layout(location = 0) out vec4 denoised;

/// The filter may move a window's light by this many times the noise. Distances scatter about the noise, and a share
/// below 1 brings noise back. With many samples that matters less than structure that the filter mistakes for noise.
float trustAt(float samples) {
  const float few = 16.0;
  const float many = 256.0;
  float fading = min(1.0, many / max(samples, 1.0));
  return fading * fading + 0.5 * min(1.0, few / max(samples, 1.0));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  Guide guide = guideOf(texelFetch(guides, pixel, 0));
  vec2 sum = vec2(0.0);
  int reach = empty(guide) ? -1 : kWindow;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      bool there = inside(other);
      other = clamp(other, ivec2(0), size - 1);
      float weight = there ? exp(likeness(guide, guideOf(texelFetch(guides, other, 0)), vec2(x, y))) : 0.0;
      sum += weight * texelFetch(moved, other, 0).xy;
    }
  }
  vec4 mean = texelFetch(means, ivec2(0), 0);
  float trust = trustAt(mean.z / (float(size.x) * float(size.y)));
  float share = sum.x > trust * sum.y ? trust * sum.y / sum.x : 1.0;
  vec3 light = mix(texelFetch(lights, pixel, 0).rgb, texelFetch(filtered, pixel, 0).rgb, share);
  float scale = scaleOf(mean, texelFetch(logarithms, ivec2(0), 0));
  denoised = vec4(light * demodulation(texelFetch(albedos, pixel, 0)) / scale, 1.0);
}
