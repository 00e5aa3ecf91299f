// SPDX-License-Identifier: MIT
// The shader's traversals in float, under attack (tests/instruments/rays/ray_attacks.h): nothing is found or
// missed beyond rounding. The oracle is the same text in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "bvh/exact_tracer.h"
#include "shader_scenes.h"
#include "tests/instruments/rays/ray_attacks.h"
#include "tests/instruments/rays/ray_judge.h"

namespace fragtrace {
namespace {

/// A separate run of the test sets the number of rays for each attack (tests/CMakeLists.txt).
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

double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 along = b - a;
  const double place = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::length(p - (a + place * along));
}

/// The directions are those from origins of floats, 300 km away, to the rims; from where the origins were
/// before they were rounded the rays would pass a rim by a ten thousandth of the mesh.
TEST(RaysAtRims, AreAimedFromTheRoundedOrigin) {
  constexpr size_t kRays = 1000;
  const auto attack = std::ranges::find_if(
      rayAttacks(), [](const RayAttack& a) { return a.name == std::string("rims-far-away"); });
  const Scene scene = attack->scene();
  const Bvh bvh = buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const std::vector<Ray> rays = attack->rays(scene, kRays, 1).rays;
  const std::vector<ExactHit> hits = ExactTracer(scene, bvh).nearest(rays);
  const auto corner = [&](size_t hit, int i) {
    return glm::dvec3(scene.vertices.position[scene.triangles[hits[hit].primitive].vertex[i % 3]]);
  };
  size_t close = 0;
  for (size_t i = 0; i < kRays; ++i) {
    if (hits[i].primitive == kMissIndex) continue;
    const glm::dvec3 point = glm::dvec3(rays[i].origin) + hits[i].t * glm::dvec3(rays[i].direction);
    double nearest = scene.bounds.extent().x;
    for (int edge = 0; edge < 3; ++edge) {
      nearest = std::min(nearest, distanceToSegment(point, corner(i, edge), corner(i, edge + 1)));
    }
    close += nearest < 1e-6 * scene.bounds.extent().x ? 1 : 0;
  }
  EXPECT_GT(close, kRays * 9 / 10);
}

}  // namespace
}  // namespace fragtrace
