// SPDX-License-Identifier: MIT
// Maps work groups to lanes of a tile. llvmpipe gives each of its threads a run of successive groups, so groups are
// dealt out over the tile: slow pixels are often neighbours, and every thread should get some of them.

/// Returns the lane of a tile of `lanes` lanes. It is outside the tile for lanes that have nothing to do.
ivec2 laneOfTile(ivec2 lanes) {
  uint columns = uint(lanes.x + 7) / 8u;
  uint each = gl_NumWorkGroups.x / kWorkGroupHands;
  uint hand = gl_WorkGroupID.x / each;
  uint first = (hand & 1u) << 2 | (hand & 2u) | hand >> 2;  // 0, 4, 2, 6, 1, 5, 3, 7: even for halves and quarters, too
  uint group = (gl_WorkGroupID.x - hand * each) * kWorkGroupHands + first;
  uint row = group / columns;
  return ivec2(group - row * columns, row) * 8 + ivec2(gl_LocalInvocationID.xy);
}
