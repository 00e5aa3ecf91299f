// SPDX-License-Identifier: MIT
#include "bvh/pick.h"

#include <algorithm>

#include "bvh/exact_tracer.h"

namespace fragtrace {

namespace {

/// Where a triangle came from; null where that is not known.
const PrimitiveOrigin* originOf(const Scene& scene, uint32_t triangle) {
  const auto after = std::ranges::upper_bound(scene.origins, triangle, {}, &PrimitiveOrigin::firstTriangle);
  return after == scene.origins.begin() ? nullptr : &*std::prev(after);
}

}  // namespace

std::optional<Pick> pickAt(const Scene& scene, const Bvh& bvh, const Projection& projection,
                           const glm::dvec2& place) {
  const ExactTracer tracer(scene, bvh);
  const Ray ray = rayThrough(projection, scene.space, place);
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
    pick.material = sphere.material;
    return pick;
  }
  pick.material = scene.triangles[hit.primitive].material;
  pick.instance = hit.instance;
  const PrimitiveOrigin* found = originOf(scene, hit.primitive);
  if (found == nullptr) return pick;
  const PrimitiveOrigin& origin = *found;
  pick.node = hit.instance == kMissIndex ? origin.node : scene.instances[hit.instance].node;
  pick.mesh = origin.mesh;
  pick.triangle = hit.primitive - origin.firstTriangle;
  return pick;
}

BoundsDouble boundsOfPicked(const Scene& scene, const Pick& pick) {
  BoundsDouble box;
  const size_t triangles = scene.triangles.size();
  if (pick.primitive >= triangles) {
    const Sphere& sphere = scene.spheres[pick.primitive - triangles];
    const glm::dvec3 center(sphere.center);
    for (const double side : {-1.0, 1.0})
      box.include(scene.space.worldOf(center + glm::dvec3(side * double(sphere.radius))));
    return box;
  }
  const PrimitiveOrigin* origin = originOf(scene, pick.primitive);
  const size_t first = origin ? origin->firstTriangle : pick.primitive;
  const size_t count = origin ? origin->triangleCount : 1;
  const bool shared = pick.instance != kMissIndex;
  for (size_t i = first; i < std::min(first + count, triangles); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      glm::dvec3 point(scene.vertices.position[scene.triangles[i].vertex[corner]]);
      if (shared) point = glm::dvec3(scene.instances[pick.instance].toLocal * glm::dvec4(point, 1.0));
      box.include(scene.space.worldOf(point));
    }
  }
  return box;
}

}  // namespace fragtrace
