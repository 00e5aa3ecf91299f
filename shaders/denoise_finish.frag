// SPDX-License-Identifier: MIT
// The last pass of the variance filter: what is filtered counts as far as its distance from the noisy light is no more than noise (James and Stein 1961, over
// a window), and the albedo comes back.
#include "denoise.glsl"

layout(binding = 0) uniform sampler2D lights;    // noisy, of denoise_prepare.frag
layout(binding = 1) uniform sampler2D filtered;
layout(binding = 2) uniform sampler2D albedos;

layout(location = 0) out vec4 denoised;

const int kWindow = 2;  // pixels each way

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float noise = 0.0;
  float moved = 0.0;
  for (int y = -kWindow; y <= kWindow; ++y) {
    for (int x = -kWindow; x <= kWindow; ++x) {
      ivec2 other = pixel + ivec2(x, y);
      if (!inside(other)) continue;
      vec4 light = texelFetch(lights, other, 0);
      float away = brightness(texelFetch(filtered, other, 0).rgb - light.rgb);
      noise += light.a;
      moved += away * away;
    }
  }
  float share = moved > noise ? noise / moved : 1.0;
  vec3 light = mix(texelFetch(lights, pixel, 0).rgb, texelFetch(filtered, pixel, 0).rgb, share);
  denoised = vec4(light * demodulation(texelFetch(albedos, pixel, 0)), 1.0);
}
