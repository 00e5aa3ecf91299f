// SPDX-License-Identifier: MIT
// The scene of the plain tracer, with which measurements compare traversal on the same device.
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// Packs the triangles of a scene, and a binary tree of them, for shaders/entry/plain.glsl.
GpuScene plainScene(const Scene& scene, const Bvh& bvh);

}  // namespace fragtrace
