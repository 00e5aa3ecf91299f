// SPDX-License-Identifier: MIT
// The film's counts, summed over blocks of 16 x 16 pixels; sums.frag continues.
#include "picture/picture.glsl"

layout(binding = 0) uniform usampler2D filmCounts;

layout(location = 0) out vec4 sum;  // samples, rays, pixels in which the driver ended a loop

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * kBlock;
  ivec2 end = min(corner + kBlock, size);
  sum = vec4(0.0);
  for (int y = corner.y; y < end.y; ++y) {
    for (int x = corner.x; x < end.x; ++x) {
      uvec4 count = texelFetch(filmCounts, ivec2(x, y), 0);
      sum += vec4(count.x, count.y, (count.w & kPixelBudgetHit) != 0u ? 1.0 : 0.0, 0.0);
    }
  }
}
