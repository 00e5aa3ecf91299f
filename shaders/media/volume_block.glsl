// SPDX-License-Identifier: MIT
// The grid of the scene; other scenes have no such block.

layout(std140, binding = kVolumeBinding) uniform VolumeBlock { Volume volume; };
