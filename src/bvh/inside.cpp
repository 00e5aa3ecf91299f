// SPDX-License-Identifier: MIT
#include "bvh/inside.h"

#include <limits>
#include <map>

#include "bvh/exact_tracer.h"

namespace fragtrace {

namespace {

constexpr int kMostHits = 256;

uint32_t materialOf(const Scene& scene, uint32_t primitive) {
  const size_t triangles = scene.triangles.size();
  return primitive < triangles ? scene.triangles[primitive].material
                               : scene.spheres[primitive - triangles].material;
}

}  // namespace

std::optional<uint32_t> solidAround(const Scene& scene, const Bvh& bvh, const glm::dvec3& point) {
  if (bvh.leaves.empty()) return std::nullopt;
  const ExactTracer tracer(scene, bvh);
  // Along no axis, so that it runs along no wall.
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.2113, 0.9371, 0.2776));
  std::map<uint32_t, int> entered;
  glm::dvec3 origin = point;
  for (int hits = 0; hits < kMostHits; ++hits) {
    const Ray ray{glm::vec3(origin), glm::vec3(direction), std::numeric_limits<float>::max()};
    // Without nodes there is no tree, but a list (listLeaves).
    const ExactHit hit = bvh.nodes.empty() ? tracer.nearestOfAll(ray) : tracer.nearest(ray);
    if (hit.primitive == kMissIndex) return std::nullopt;
    const glm::dvec3 there = origin + hit.t * direction;
    const uint32_t index = materialOf(scene, hit.primitive);
    const Material& material = scene.materials[index];
    if (material.solid() && material.passesLight()) {
      const bool leaves = glm::dot(tracer.normal(hit.primitive, there, hit.instance), direction) > 0.0;
      if (leaves && entered[index] == 0) return index;
      entered[index] += leaves ? -1 : 1;
    }
    origin = there + direction * (4.0 * tracer.pointError(hit.primitive));
  }
  return std::nullopt;
}

}  // namespace fragtrace
