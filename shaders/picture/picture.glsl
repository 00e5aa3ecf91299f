// SPDX-License-Identifier: MIT
// Passes over pictures share this (src/render/picture_passes.h). Pictures are textures of one texel per pixel, of which
// the part from the corner counts.
#include "layout.glsl"
#include "luminance.glsl"

const int kBlock = 16;  // texels a side that a sum takes into one

layout(location = 0) uniform ivec2 size;  // size of the textures that are read

bool inside(ivec2 pixel) { return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)); }

/// A pixel's light is divided by this, so that textures stay sharp; albedo and coverage are means over its samples.
vec3 demodulation(vec4 albedo) {
  return albedo.a > 0.0 ? mix(max(albedo.rgb, vec3(0.0)), vec3(1.0), kAlbedoFloor) : vec3(1.0);
}
