// SPDX-License-Identifier: MIT
#include "bvh/pick.h"

#include <algorithm>

#include "bvh/exact_tracer.h"

namespace fragtrace {

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
  const auto after =
      std::ranges::upper_bound(scene.origins, hit.primitive, {}, &PrimitiveOrigin::firstTriangle);
  if (after == scene.origins.begin()) return pick;
  const PrimitiveOrigin& origin = *std::prev(after);
  pick.node = hit.instance == kMissIndex ? origin.node : scene.instances[hit.instance].node;
  pick.mesh = origin.mesh;
  pick.triangle = hit.primitive - origin.firstTriangle;
  return pick;
}

}  // namespace fragtrace
