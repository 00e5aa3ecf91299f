// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"
#include "scene/volume/grid.h"

namespace fragtrace {

/// Texels of 8 bytes that a grid takes on the device.
size_t texelsOf(const VolumeGrid& grid);

/// Fills an array with the grid's table, which is larger by a brick before the first along each axis, and its
/// bricks (shaders/media/volume.glsl).
PackedGrid packGrid(const VolumeGrid& grid, Words& texels);

}  // namespace fragtrace
