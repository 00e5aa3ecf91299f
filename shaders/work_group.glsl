// SPDX-License-Identifier: MIT
// Maps work groups to lanes of a tile. llvmpipe gives each of its threads a run of successive groups, so groups are
// dealt out over the tile: slow pixels are often neighbours, and every thread should get some of them. A GPU runs many
// successive groups at once, whose rays should read the same nodes: they follow Morton's curve through squares.

/// Returns the lane of a tile of `lanes` lanes. It is outside the tile for lanes that have nothing to do.
ivec2 laneOfTile(ivec2 lanes) {
  uint columns = uint(lanes.x + 7) / 8u;
  ivec2 within = ivec2(gl_LocalInvocationID.xy);
  if (kGpu) {
    uint squares = (columns + kMortonSide - 1u) / kMortonSide;
    uint square = gl_WorkGroupID.x / (kMortonSide * kMortonSide);
    uint i = gl_WorkGroupID.x - square * kMortonSide * kMortonSide;
    uvec2 place = uvec2((i & 1u) | (i >> 1 & 2u) | (i >> 2 & 4u), (i >> 1 & 1u) | (i >> 2 & 2u) | (i >> 3 & 4u));
    uint squareRow = square / squares;
    return ivec2(kMortonSide * uvec2(square - squareRow * squares, squareRow) + place) * 8 + within;
  }
  uint each = gl_NumWorkGroups.x / kWorkGroupHands;
  uint hand = gl_WorkGroupID.x / each;
  uint first = (hand & 1u) << 2 | (hand & 2u) | hand >> 2;  // 0, 4, 2, 6, 1, 5, 3, 7: even for halves and quarters, too
  uint group = (gl_WorkGroupID.x - hand * each) * kWorkGroupHands + first;
  uint row = group / columns;
  return ivec2(group - row * columns, row) * 8 + within;
}
