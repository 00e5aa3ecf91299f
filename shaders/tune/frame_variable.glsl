// SPDX-License-Identifier: MIT
// For software drivers the uniform block is copied to a variable. llvmpipe reads a uniform lane by lane, so each is
// read once a draw.

layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frameBlock; };
Frame frame = Frame(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0u, vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0),
                    0.0, vec2(0.0), vec2(0.0), 0.0, 0.0, 0.0, 0.0, ivec2(0), 0, 0, ivec4(0), 0, 0, 0, 0, 0, 0, 0, 0,
                    ivec2(0), ivec2(0), vec3(0.0), 0.0, vec3(0.0), 0.0, vec4(0.0), vec2(0.0), vec2(0.0),
                    ivec4(0));

/// Pixels of the draw, before fetchFrame().
ivec4 tileOfDraw() { return frameBlock.tile; }

/// Fetches the block. A film's flags are never 0xffffffff, but compilers do not know that. Without the test they would
/// move the block's reads back into the loops.
void fetchFrame(uint filmFlags) {
  if (filmFlags != 0xffffffffu) frame = frameBlock;
}
