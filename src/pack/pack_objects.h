// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

/// Appends the numbers of the glTF nodes that show what leaf slots hold and what instances are, from 1 on, 0
/// where there is none: four a row (shaders/layout.glsl).
void appendObjectNumbers(const Scene& scene, const Bvh& bvh, Words& words);

}  // namespace fragtrace
