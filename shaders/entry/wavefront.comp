// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
#include "trace.glsl"
#include "wavefront.glsl"
#include "work_group.glsl"

void main() {
  ivec2 size = tileOfDraw().zw;
  ivec2 lanes = ivec2(size.x, (size.y + int(kWaveSlots) - 1) / int(kWaveSlots));
  ivec2 lane = laneOfTile(lanes);
  if (lane.x < lanes.x && lane.y < lanes.y) traceWave(lane);
}
