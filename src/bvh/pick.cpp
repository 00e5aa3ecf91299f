// SPDX-License-Identifier: MIT
#include "bvh/pick.h"

#include <algorithm>

#include "bvh/exact_tracer.h"

namespace fragtrace {

namespace {

/// The place in the file from which a triangle comes; null if it is not known.
const PrimitiveOrigin* originOf(const Scene& scene, uint32_t triangle) {
  const auto after = std::ranges::upper_bound(scene.origins, triangle, {}, &PrimitiveOrigin::firstTriangle);
  return after == scene.origins.begin() ? nullptr : &*std::prev(after);
}

}  // namespace

std::optional<Pick> pickAt(const Scene& scene, const Bvh& bvh, const Projection& projection,
                           const glm::dvec2& place) {
  const std::optional<Ray> through = rayThrough(projection, scene.space, place);
  if (!through) return std::nullopt;
  const Ray& ray = *through;
  const ExactTracer tracer(scene, bvh);
  const ExactHit hit = tracer.nearest(ray);
  if (hit.primitive == kMissIndex) return std::nullopt;
  Pick pick;
  pick.primitive = hit.primitive;
  pick.distance = hit.t * scene.space.unit;
  const glm::dvec3 direction(ray.direction);
  const glm::dvec3 local = glm::dvec3(ray.origin) + hit.t * direction;
  pick.point = scene.space.worldOf(local);
  pick.normal = tracer.normal(hit.primitive, local, hit.instance);
  if (glm::dot(pick.normal, direction) > 0.0) pick.normal = -pick.normal;
  const size_t triangles = scene.triangles.size();
  if (hit.primitive >= triangles) {
    const Sphere& sphere = scene.spheres[hit.primitive - triangles];
    pick.node = sphere.node;
    pick.nodeIndex = sphere.nodeIndex;
    pick.material = sphere.material;
    return pick;
  }
  pick.material = scene.triangles[hit.primitive].material;
  pick.instance = hit.instance;
  const PrimitiveOrigin* found = originOf(scene, hit.primitive);
  if (found == nullptr) return pick;
  const PrimitiveOrigin& origin = *found;
  const bool shared = hit.instance != kMissIndex;
  pick.node = shared ? scene.instances[hit.instance].node : origin.node;
  pick.nodeIndex = shared ? scene.instances[hit.instance].nodeIndex : origin.nodeIndex;
  pick.mesh = origin.mesh;
  pick.triangle = hit.primitive - origin.firstTriangle;
  return pick;
}

}  // namespace fragtrace
