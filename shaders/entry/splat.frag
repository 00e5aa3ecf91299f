// SPDX-License-Identifier: MIT
// Writes the light that one light path adds to one pixel, and the square of its luminance.
#include "sampling.glsl"
#include "pixel_filter.glsl"
#include "luminance.glsl"

layout(location = 0) flat in vec3 light;
layout(location = 1) flat in vec2 place;

layout(location = 4) uniform float weight;  // of the light path compared with those of other passes (path_share.h)

layout(location = 0) out vec4 added;

void main() {
  // The box filter covers exactly the pixel in which the point lies, whatever a rounded distance says.
  float pdf = kPixelFilter == kBoxFilter ? 1.0 : pixelFilterPdf(kPixelFilter, gl_FragCoord.xy - place);
  vec3 own = weight * pdf * light;
  float value = luminance(own);
  added = vec4(own, value * value);
}
