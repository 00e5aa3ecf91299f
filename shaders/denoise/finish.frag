// SPDX-License-Identifier: MIT
// The last pass of the variance filter: what is filtered counts as far as its distance from the noisy light is noise
// (James and Stein 1961, over a window of like surfaces), and the albedo comes back.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D lights;    // noisy
layout(binding = 1) uniform sampler2D filtered;
layout(binding = 2) uniform sampler2D moved;
layout(binding = 3) uniform usampler2D guides;
layout(binding = 4) uniform sampler2D albedos;

layout(location = 1) uniform float trust;  // in the filter: its distance may be so many times the noise

layout(location = 0) out vec4 denoised;

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
  float share = sum.x > trust * sum.y ? trust * sum.y / sum.x : 1.0;
  vec3 light = mix(texelFetch(lights, pixel, 0).rgb, texelFetch(filtered, pixel, 0).rgb, share);
  denoised = vec4(light * demodulation(texelFetch(albedos, pixel, 0)), 1.0);
}
