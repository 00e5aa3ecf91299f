// SPDX-License-Identifier: MIT
// The shader's traversals in float, under attack (src/bench/ray_attacks.h): nothing is found or missed beyond
// rounding. The oracle is the same text in double precision.
#include <gtest/gtest.h>

#include <cstdlib>

#include "bench/ray_attacks.h"
#include "bench/ray_judge.h"
#include "shader_scenes.h"

namespace fragtrace {
namespace {

/// A run of its own sets how many rays of each attack are traced (tests/CMakeLists.txt).
size_t rayCount() {
  const char* wanted = std::getenv("FRAGTRACE_ATTACK_RAYS");
  return wanted ? size_t(std::atoll(wanted)) : 6000;
}

class Attack : public testing::TestWithParam<RayAttack> {};

TEST_P(Attack, FloatFindsWhatDoubleFinds) {
  constexpr uint32_t kSeed = 1;
  constexpr size_t kMostIterative = 100;
  const RayAttack& attack = GetParam();
  const PackedTree p = packTreeOf(attack.scene());
  const auto [rays, leaves] = attack.rays(p.scene, rayCount(), kSeed);
  const bool few = p.scene.triangles.size() + p.scene.spheres.size() <= kMostIterative;
  size_t cases = 0;
  size_t wrong = 0;
  size_t hits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const Outcome exact = traceDouble(p, Method::FrontToBack, rays[i]);
    hits += exact.slot >= 0 ? 1 : 0;
    if (few) {
      ASSERT_EQ(bruteForce(p.scene, rays[i]), exact.t) << "ray " << i;
    }
    for (Method method : kMethods) {
      if (method == Method::Iterative && !few) continue;
      const Outcome found = traceFloat(p, method, rays[i]);
      const RayFault fault = judgeRay(p.scene, rays[i], {primitiveInSlot(p.bvh, found.slot), float(found.t)},
                                      {exact.t, primitiveInSlot(p.bvh, exact.slot)});
      const bool leaked = attack.closed && found.slot < 0;
      const bool met = !leaves.empty() && primitiveInSlot(p.bvh, found.slot) == leaves[i];
      ++cases;
      if (fault == RayFault::None && !leaked && !met) continue;
      ++wrong;
      if (wrong < 4) ADD_FAILURE() << "ray " << i << ", method " << int(method) << ", fault " << int(fault);
    }
  }
  EXPECT_LE(double(wrong), attack.limit * double(cases));
  EXPECT_GT(hits, rays.size() / 20);  // else it attacks nothing
}

INSTANTIATE_TEST_SUITE_P(Rays, Attack, testing::ValuesIn(rayAttacks().begin(), rayAttacks().end()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace fragtrace
