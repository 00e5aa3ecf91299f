// SPDX-License-Identifier: MIT
// What the passes of the variance filter share (src/render/denoise.h). Pictures are textures of one texel a pixel; light is divided by the albedo, so that
// textures stay sharp.

const float kAlbedoFloor = 0.04;  // of light that the base colour does not tint

layout(location = 0) uniform ivec2 size;

bool inside(ivec2 pixel) { return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size)); }

float brightness(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

/// What a pixel's light is divided by; albedo and coverage are means over its samples.
vec3 demodulation(vec4 albedo) { return albedo.a > 0.0 ? mix(max(albedo.rgb, vec3(0.0)), vec3(1.0), kAlbedoFloor) : vec3(1.0); }
