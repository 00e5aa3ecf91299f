// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
#include "trace.glsl"
#include "wavefront.glsl"

void main() {
  ivec2 lane = ivec2(gl_GlobalInvocationID.xy);
  if (lane.x < frameBlock.tile.z && lane.y * int(kWaveSlots) < frameBlock.tile.w) traceWave(lane);
}
