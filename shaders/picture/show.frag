// SPDX-License-Identifier: MIT
// Shows a filtered picture in the window, mixed with the unfiltered one by the filter's share; its first row is at the
// top.
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D raw;       // linear R, G, B, and alpha
layout(binding = 1) uniform sampler2D filtered;  // linear R, G, B
layout(location = 1) uniform float share;        // share of the filtered picture
layout(location = 2) uniform bool background;    // the background is seen: nothing shows through
layout(location = 3) uniform bool overWhite;     // the filtered picture is over white

layout(location = 0) out vec4 shown;

/// The same as liftedFromWhite() of src/image/image.h. Rounding of alpha counts as 0.
vec4 liftedFromWhite(vec4 own, vec3 seen) {
  float alpha = 1.0 - luminance(seen);
  if (own.rgb == vec3(0.0)) return vec4(own.rgb, alpha > 1e-6 ? alpha : 0.0);
  return vec4(max(seen - (1.0 - own.a), vec3(0.0)), own.a);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.x, size.y - 1 - int(gl_FragCoord.y));
  shown = texelFetch(raw, pixel, 0);
  vec3 clean = texelFetch(filtered, pixel, 0).rgb;
  shown = mix(shown, overWhite ? liftedFromWhite(shown, clean) : vec4(clean, shown.a), share);
  if (background) shown.a = 1.0;
}
