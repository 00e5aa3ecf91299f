// SPDX-License-Identifier: MIT
// A filtered picture as a window shows it, as far as the filter counts; its first row is at the top.
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D raw;       // linear R, G, B, and alpha
layout(binding = 1) uniform sampler2D filtered;  // linear R, G, B
layout(location = 1) uniform float share;        // of the latter
layout(location = 2) uniform bool background;    // it is seen: nothing shows through

layout(location = 0) out vec4 shown;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.x, size.y - 1 - int(gl_FragCoord.y));
  shown = texelFetch(raw, pixel, 0);
  shown.rgb = mix(shown.rgb, texelFetch(filtered, pixel, 0).rgb, share);
  if (background) shown.a = 1.0;
}
