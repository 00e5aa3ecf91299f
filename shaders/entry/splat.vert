// SPDX-License-Identifier: MIT
// Two points for each light path, as its records are (storeRecord of film.glsl), over the pixels that the pixel filter
// reaches.
#include "sampling.glsl"
#include "pixel_filter.glsl"

layout(binding = 0) uniform sampler2D lights;  // light, x of where it is seen in the picture
layout(binding = 1) uniform sampler2D places;  // y
layout(location = 0) uniform vec2 corner;  // place of the film's first pixel in the picture
layout(location = 1) uniform vec2 size;    // of the viewport, whose margin of so many pixels keeps points that lie
layout(location = 2) uniform float margin;  // next to the film
layout(location = 3) uniform ivec2 tile;    // size of that of light paths

layout(location = 0) flat out vec3 light;
layout(location = 1) flat out vec2 place;  // place in the film, pixels

void main() {
  ivec2 texel = ivec2(gl_VertexID % tile.x, gl_VertexID / tile.x);
  if (texel.y >= tile.y) texel.y += textureSize(lights, 0).y / 2 - tile.y;
  vec4 first = texelFetch(lights, texel, 0);
  light = first.rgb;
  place = vec2(first.a, texelFetch(places, texel, 0).r) - corner;
  bool shown = max(light.r, max(light.g, light.b)) > 0.0;
  // The middle of its pixel, so that no rounding decides which pixels it covers.
  vec2 middle = floor(place) + 0.5 + margin;
  gl_Position = shown ? vec4(2.0 * middle / size - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = kPixelFilter == kBoxFilter ? 1.0 : kPixelFilter == kGaussianFilter ? 5.0 : 3.0;
}
