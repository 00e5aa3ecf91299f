// SPDX-License-Identifier: MIT
// One surface at any fineness, made in memory.
#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace fragtrace {

/// A closed, bumpy ball of about one metre radius round the origin, with close to `triangles` of them (at
/// least 64; within 4 %, from 10,000 on within 0.5 %), flat, single-sided, vertices shared. The surface is
/// the same for all counts. One Lambert material. No camera and no light.
Scene makeBallScene(size_t triangles);

}  // namespace fragtrace
