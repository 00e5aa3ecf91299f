// SPDX-License-Identifier: MIT
// A search for rays that leave a triangle next to a crease and are not in front of its neighbours: pairs that
// share an edge, and pointed cones, whose faces share a vertex, of any angle, shape, place and size that
// docs/design/ray-origins.md promises. It is steered towards the least height over a neighbour's plane.
#include <gtest/gtest.h>

#include "climb_folds.h"

namespace fragtrace {
namespace {

/// Rays that graze more are searched by LimitSearch.
constexpr double kLeastCosine = 0x1p-10;

struct Trial {
  double height = kImpossible;  ///< least height over a neighbour's plane, in units of eps m
  bool leaks = false;           ///< a ray from there begins behind a neighbour, or finds it behind itself
};

Trial tried(Genes g) {
  const glsl_variant::With spheres(glsl_variant::kSpheres, false);
  const Turn turn(g);
  const Fold fold = g.take() < 0.5 ? wedgeOf(g, turn) : coneOf(g, turn);
  if (!isPromised(fold)) return {};
  const auto error = float(hitPointError(fold.faces[0]) * g.between(1.0, 1.25));
  const vec3 origin(fold.inside);
  const vec3 towards = glm::normalize(vec3(besideCrease(fold.faces[0], g) - dvec3(origin)));
  if (glm::dot(dvec3(towards), normalOf(fold.faces[0])) > -kLeastCosine) return {};
  const std::optional<dvec3> start = startOn(fold, origin, towards, error);
  if (!start) return {};
  Trial trial;
  const glm::dvec2 aim(g.between(0.02, 0.96), g.take());
  for (size_t i = 1; i < fold.faces.size(); ++i) {
    const std::array<vec3, 3>& v = fold.faces[i];
    const double unit = std::max(hitPointError(v), hitPointError(fold.faces[0])) / 32.0;
    trial.height = std::min(trial.height, glm::dot(normalOf(v), *start - dvec3(v[0])) / unit);
    const dvec3 target = pointWith(v, {aim.x, 0.02 + (0.96 - aim.x) * aim.y});
    const vec3 direction = glm::normalize(vec3(target - *start));
    trial.leaks = trial.leaks || trial.height <= 0.0 || isBehind(v, vec3(*start), direction);
  }
  return trial;
}

TEST(CreaseSearch, NoRayStartsBehindAFaceOrMissesIt) {
  Draw draw(uint32_t(numberFrom("FRAGTRACE_ATTACK_SEED", 1)));
  const long cases = numberFrom("FRAGTRACE_ATTACK_RAYS", 6000) * 10;
  long leaks = 0;
  const Climbed found = climb(draw, cases, 400, [&](const Genes& genes) {
    const Trial trial = tried(genes);
    leaks += trial.leaks ? 1 : 0;
    return trial.height;
  });
  std::printf("%ld cases, %ld of them promised, least height %.3f eps m, %ld leaks\n", cases, found.promised,
              found.least, leaks);
  EXPECT_EQ(leaks, 0);
  EXPECT_GT(found.least, 0.0);
  EXPECT_GT(found.promised, cases / 2);
}

}  // namespace
}  // namespace fragtrace
