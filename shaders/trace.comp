// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
#include "trace.glsl"

void main() {
  ivec2 place = ivec2(gl_GlobalInvocationID.xy);
  if (place.x < frameBlock.tile.z && place.y < frameBlock.tile.w) tracePixel(frameBlock.tile.xy + place);
}
