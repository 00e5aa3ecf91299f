// SPDX-License-Identifier: MIT
// Sums of 16 x 16 texels each.
#include "picture/picture.glsl"

layout(binding = 0) uniform sampler2D terms;

layout(location = 0) out vec4 sum;

void main() {
  ivec2 corner = ivec2(gl_FragCoord.xy) * kBlock;
  ivec2 end = min(corner + kBlock, size);
  sum = vec4(0.0);
  for (int y = corner.y; y < end.y; ++y) {
    for (int x = corner.x; x < end.x; ++x) sum += texelFetch(terms, ivec2(x, y), 0);
  }
}
