// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// Appends the numbers of the glTF nodes that show the primitives in leaf slots, and then those of instances:
/// from 1 on, 0 where there is none, four a row (shaders/layout.glsl).
void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words);

}  // namespace fragtrace
