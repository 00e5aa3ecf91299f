// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/hit_check.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/text.h"

namespace fragtrace {

namespace {

constexpr double kNear = 1e-5;

/// Index of the material that a pixel's middle sees, -1: none.
int materialOf(const Scene& scene, const ExactHit& hit) {
  if (hit.primitive == kMissIndex) return -1;
  const size_t triangles = scene.triangles.size();
  return int(hit.primitive < triangles ? scene.triangles[hit.primitive].material
                                       : scene.spheres[hit.primitive - triangles].material);
}

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

FlatPictureCheck checkFlatPicture(const Image& picture, const Scene& scene, std::span<const ExactHit> hits) {
  constexpr float kNearColor = 1e-3f;
  FlatPictureCheck check;
  const auto materialAt = [&](int x, int y) {
    return materialOf(scene, hits[size_t(y) * size_t(picture.width) + size_t(x)]);
  };
  for (int y = 1; y + 1 < picture.height; ++y) {
    for (int x = 1; x + 1 < picture.width; ++x) {
      const int material = materialAt(x, y);
      bool uniform = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) uniform = uniform && materialAt(x + dx, y + dy) == material;
      }
      if (!uniform) continue;
      ++check.compared;
      const glm::vec3 color =
          material < 0 ? glm::vec3(0.0f) : glm::vec3(scene.materials[size_t(material)].baseColorFactor);
      const float* pixel = picture.pixel(x, picture.height - 1 - y);
      const glm::vec3 off = glm::abs(glm::vec3(pixel[0], pixel[1], pixel[2]) - color);
      check.wrong += std::max({off.x, off.y, off.z}) <= kNearColor ? 0 : 1;
    }
  }
  return check;
}

}  // namespace fragtrace
