// SPDX-License-Identifier: MIT
// Scenes and rays at which ray tracers in 32-bit floats break: for `bench stress` and the tests.
#pragma once

#include <span>
#include <vector>

#include "scene/local_space.h"
#include "scene/scene.h"

namespace fragtrace {

struct AttackRays {
  std::vector<Ray> rays;
  std::vector<uint32_t>
      leaves;  ///< the triangle that each ray starts on and must not meet; empty: they start anywhere
};

struct RayAttack {
  const char* name;
  const char* sentence;  ///< the kind of rays and their targets
  double limit;          ///< share of rays that may be wrong beyond rounding (ray_judge.h)
  bool closed;           ///< every ray has to hit something
  Scene (*scene)();
  AttackRays (*rays)(const Scene& scene, size_t count, uint32_t seed);
};

/// Every attack. The same seed gives the same rays.
std::span<const RayAttack> rayAttacks();

}  // namespace fragtrace
