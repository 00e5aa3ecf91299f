// SPDX-License-Identifier: MIT
// The fog of the scene; other scenes have no such block.

layout(std140, binding = kFogBinding) uniform FogBlock { Fog fog; };
