// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
#include "trace.glsl"
#include "work_group.glsl"

void main() {
  ivec2 size = tileOfDraw().zw;
  ivec2 place = laneOfTile(size);
  if (place.x < size.x && place.y < size.y) tracePixel(tileOfDraw().xy + place);
}
