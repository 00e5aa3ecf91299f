// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/hit_check.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

namespace {

constexpr double kNear = 1e-5;

}  // namespace

std::vector<FoundHit> foundBy(const RayCaster& caster, const Bvh& bvh) {
  std::vector<FoundHit> found;
  for (const TracedRay& hit : caster.hits()) found.push_back({primitiveInSlot(bvh, hit.slot), hit.t});
  return found;
}

size_t countWrongNearest(std::span<const Ray> rays, std::span<const FoundHit> found,
                         std::span<const ExactHit> exact, double sceneSize) {
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!(rays[i].limit > 0.0f)) continue;
    const bool hit = found[i].primitive != kMissIndex;
    const bool exactHit = exact[i].primitive != kMissIndex;
    bool right = hit == exactHit;
    if (hit && exactHit) {
      // The distance of a grazing hit carries the rounding of the point, many times as large.
      const double slack = found[i].primitive == exact[i].primitive ? 100.0 : 1.0;
      right = std::abs(found[i].t - exact[i].t) <= slack * kNear * (exact[i].t + sceneSize);
    }
    wrong += right ? 0 : 1;
  }
  return wrong;
}

size_t countWrongAny(std::span<const Ray> rays, std::span<const FoundHit> found,
                     std::span<const ExactHit> exact) {
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    const bool same = (found[i].primitive == kMissIndex) == (exact[i].primitive == kMissIndex);
    wrong += rays[i].limit > 0.0f && !same ? 1 : 0;
  }
  return wrong;
}

size_t wrongRaysAllowed(size_t rays) { return 2 + rays / 20000; }

size_t proveTree(const ExactTracer& tracer, size_t primitives, std::span<const Ray> rays) {
  constexpr double kTests = 2e7;
  constexpr size_t kMost = 500;
  std::vector<Ray> chosen;
  for (const Ray& ray : rays) {
    if (ray.limit > 0.0f) chosen.push_back(ray);
  }
  const size_t wanted =
      std::clamp(size_t(kTests / double(std::max<size_t>(primitives, 1))), size_t(4), kMost);
  const size_t count = std::min(wanted, chosen.size());
  for (size_t i = 0; i < count; ++i) chosen[i] = chosen[i * chosen.size() / count];
  chosen.resize(count);
  const std::vector<ExactHit> byTree = tracer.nearest(chosen);
  const std::vector<ExactHit> byAll = tracer.nearestOfAll(chosen);
  for (size_t i = 0; i < count; ++i) {
    // Both compute each distance alike; the order in which they come to primitives at the same one differs.
    if (byTree[i].t != byAll[i].t)
      throw RenderError(formatted("the tree gives a hit at %.9g m where testing all primitives gives %.9g m",
                                  byTree[i].t, byAll[i].t));
  }
  return count;
}

}  // namespace fragtrace
