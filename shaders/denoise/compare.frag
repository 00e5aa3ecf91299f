// SPDX-License-Identifier: MIT
// A pass of the variance filter: it compares how far each pixel was moved with its noise. Both are squared, relative to
// the pixel's light, and mapped by x / (1 + x), so that the few brightest samples of a window do not decide alone.
#include "denoise/denoise.glsl"

layout(binding = 0) uniform sampler2D lights;    // noisy
layout(binding = 1) uniform sampler2D filtered;
layout(binding = 2) uniform sampler2D noises;

layout(location = 0) out vec2 moved;  // and noise

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 before = texelFetch(lights, pixel, 0).rgb;
  vec3 after = texelFetch(filtered, pixel, 0).rgb;
  // Light that leaks into a dark place counts relative to that place.
  vec3 light = min(after, 0.5 * (before + after));
  vec3 away = (after - before) * (after - before) / (light * light + kDarkSquared);
  float bright = luminance(light);
  vec2 relative = vec2(dot(away, vec3(1.0 / 3.0)),
                       texelFetch(noises, pixel, 0).r / (bright * bright + kDarkSquared));
  moved = relative / (1.0 + relative);
}
