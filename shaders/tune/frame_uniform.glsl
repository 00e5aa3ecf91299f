// SPDX-License-Identifier: MIT
// The uniform block for GPUs, which read uniforms almost for free: a copy would take registers.

layout(std140, binding = kFrameBinding) uniform FrameBlock { Frame frame; };

/// The same functions are in frame_variable.glsl.
ivec4 tileOfDraw() { return frame.tile; }
void fetchFrame(uint filmFlags) {}
