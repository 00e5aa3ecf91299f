// SPDX-License-Identifier: MIT
// Rows of rays alone: traversal on the device against double precision.
#pragma once

#include "bench/rays/ray_attacks.h"
#include "bench/stress/stress.h"

namespace fragtrace {

/// The attack's rays by every way of finding triangles that takes the scene.
StressOutcome attackByRays(const StressSetting& setting, const RayAttack& attack);

}  // namespace fragtrace
