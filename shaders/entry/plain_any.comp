// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
#include "entry/plain.glsl"

void main() {
  ivec2 lane = ivec2(gl_GlobalInvocationID.xy);
  if (lane.x < frame.pictureSize.x && lane.y < frame.pictureSize.y) tracePlain(lane, true);
}
