// SPDX-License-Identifier: MIT
#include "bvh/exact_tracer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"

namespace fragtrace {

namespace {

constexpr double kMiss = std::numeric_limits<double>::infinity();

struct Crossing {
  double t = kMiss;
  bool front = false;
};

/// Decides by the signs of the edges as the ray sees them, which are the same for two triangles with a common
/// edge (Woop, Benthin and Wald, Watertight Ray/Triangle Intersection, 2013).
Crossing crossTriangle(const ExactRay& ray, const std::array<glm::dvec3, 3>& points) {
  const glm::dvec3& d = ray.direction;
  const glm::dvec3 size = glm::abs(d);
  const int z = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int x = (z + 1) % 3;
  const int y = (z + 2) % 3;
  std::array<glm::dvec3, 3> p;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 q = points[i] - ray.origin;
    p[i] = {q[x] - d[x] / d[z] * q[z], q[y] - d[y] / d[z] * q[z], q[z] / d[z]};
  }
  const double u = p[2].x * p[1].y - p[2].y * p[1].x;
  const double v = p[0].x * p[2].y - p[0].y * p[2].x;
  const double w = p[1].x * p[0].y - p[1].y * p[0].x;
  const double sum = u + v + w;
  const bool inside = (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
  if (!inside || sum == 0.0) return {};
  return {(u * p[0].z + v * p[1].z + w * p[2].z) / sum, (d[z] > 0.0) == (sum > 0.0)};
}

double crossSphere(const ExactRay& ray, const Sphere& sphere, bool inside) {
  const glm::dvec3 f = ray.origin - glm::dvec3(sphere.center);
  const glm::dvec3 d = glm::normalize(ray.direction);
  const double b = -glm::dot(f, d);
  const double discriminant = double(sphere.radius) * sphere.radius - glm::dot(f + b * d, f + b * d);
  if (discriminant < 0.0) return kMiss;
  const double root = std::sqrt(discriminant);
  if (b - root > 0.0) return b - root;
  return inside && b + root > 0.0 ? b + root : kMiss;
}

/// The distance at which the ray enters the box, widened against rounding, or kMiss.
double enterBox(const ExactRay& ray, const glm::dvec3& inverse, const Bounds& box, double farthest) {
  constexpr double kWiden = 1e-9;
  double enter = 0.0;
  double leave = farthest;
  for (int axis = 0; axis < 3; ++axis) {
    const double margin =
        kWiden * (1.0 + std::abs(double(box.minimum[axis])) + std::abs(double(box.maximum[axis])));
    const double a = (double(box.minimum[axis]) - margin - ray.origin[axis]) * inverse[axis];
    const double b = (double(box.maximum[axis]) + margin - ray.origin[axis]) * inverse[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kMiss;
}

/// Calls work for blocks of indices on all cores.
template <typename Work>
void forAll(size_t count, const Work& work) {
  constexpr size_t kBlock = 256;
  std::atomic<size_t> next = 0;
  runOnThreads(processorCount(), [&](uint32_t) {
    for (size_t first = next.fetch_add(kBlock); first < count; first = next.fetch_add(kBlock)) {
      for (size_t i = first; i < std::min(first + kBlock, count); ++i) work(i);
    }
  });
}

}  // namespace

ExactTracer::ExactTracer(const Scene& scene, const Bvh& bvh) : scene_(scene), bvh_(bvh) {
  toMesh_.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) toMesh_.push_back(glm::inverse(instance.toLocal));
}

ExactRay ExactTracer::inMesh(const ExactRay& ray, uint32_t instance) const {
  const glm::dmat4& toMesh = toMesh_[instance];
  return {glm::dvec3(toMesh * glm::dvec4(ray.origin, 1.0)), glm::dmat3(toMesh) * ray.direction};
}

void ExactTracer::meet(const ExactRay& ray, uint32_t primitive, uint32_t instance, ExactHit& hit) const {
  const uint32_t triangles = uint32_t(scene_.triangles.size());
  double t = kMiss;
  if (primitive < triangles) {
    const Triangle& triangle = scene_.triangles[primitive];
    const Material& m = scene_.materials[triangle.material];
    const Crossing crossing = crossTriangle(ray, cornersOf<glm::dvec3>(scene_, triangle));
    if (crossing.front || m.doubleSided || m.passesLight()) t = crossing.t;
  } else {
    const Sphere& sphere = scene_.spheres[primitive - triangles];
    const Material& m = scene_.materials[sphere.material];
    t = crossSphere(ray, sphere, m.doubleSided || m.passesLight());
  }
  if (t > 0.0 && t < hit.t) hit = {t, primitive, instance};
}

void ExactTracer::descend(const ExactRay& ray, uint32_t root, uint32_t instance, ExactHit& hit) const {
  glm::dvec3 inverse;
  for (int axis = 0; axis < 3; ++axis) {
    // This is far below what a direction of 24 bits can hold next to a larger component.
    const double d = ray.direction[axis];
    inverse[axis] = 1.0 / (std::abs(d) < 1e-30 ? std::copysign(1e-30, d) : d);
  }
  struct Entry {
    uint32_t child;
    double enter;
  };
  std::array<Entry, kMaxBvhDepth + 1> stack;
  size_t depth = 0;
  stack[depth++] = {root, 0.0};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.enter > hit.t) continue;
    const uint32_t index = entry.child & ~(kBvhLeafBit | kBvhInstanceBit);
    if ((entry.child & kBvhLeafBit) != 0 && (entry.child & kBvhInstanceBit) != 0) {
      descend(inMesh(ray, index), bvh_.meshes[scene_.instances[index].mesh].root, index, hit);
      continue;
    }
    if ((entry.child & kBvhLeafBit) != 0) {
      for (const uint32_t primitive : bvh_.leaves[index].primitive) {
        if (primitive != kMissIndex) meet(ray, primitive, instance, hit);
      }
      continue;
    }
    const BvhNode& node = bvh_.nodes[entry.child];
    std::array<Entry, 2> children;
    for (int side = 0; side < 2; ++side)
      children[side] = {node.child[side], enterBox(ray, inverse, node.bounds[side], hit.t)};
    if (children[0].enter < children[1].enter) std::swap(children[0], children[1]);
    for (const Entry& child : children) {
      if (child.enter != kMiss) stack[depth++] = child;
    }
  }
}

ExactHit ExactTracer::nearest(const Ray& ray) const {
  ExactHit hit{double(ray.limit)};
  if (!(ray.limit > 0.0f)) return hit;
  const ExactRay exact{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
  for (size_t i = bvh_.leaves.size() - bvh_.besideTree; i < bvh_.leaves.size(); ++i) {
    for (const uint32_t primitive : bvh_.leaves[i].primitive) {
      if (primitive != kMissIndex) meet(exact, primitive, kMissIndex, hit);
    }
  }
  if (!bvh_.nodes.empty()) descend(exact, 0, kMissIndex, hit);
  return hit;
}

ExactHit ExactTracer::nearestOfAll(const Ray& ray) const {
  ExactHit hit{double(ray.limit)};
  if (!(ray.limit > 0.0f)) return hit;
  const ExactRay exact{glm::dvec3(ray.origin), glm::dvec3(ray.direction)};
  const auto triangles = uint32_t(scene_.triangles.size());
  for (uint32_t i = 0; i < flatTriangleCount(scene_); ++i) meet(exact, i, kMissIndex, hit);
  for (uint32_t i = 0; i < scene_.spheres.size(); ++i) meet(exact, triangles + i, kMissIndex, hit);
  for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
    const SharedMesh& mesh = scene_.sharedMeshes[scene_.instances[i].mesh];
    const ExactRay inside = inMesh(exact, i);
    for (uint32_t k = 0; k < mesh.triangleCount; ++k) meet(inside, mesh.firstTriangle + k, i, hit);
  }
  return hit;
}

std::vector<ExactHit> ExactTracer::nearest(std::span<const Ray> rays) const {
  std::vector<ExactHit> hits(rays.size());
  forAll(rays.size(), [&](size_t i) { hits[i] = nearest(rays[i]); });
  return hits;
}

std::vector<ExactHit> ExactTracer::nearestOfAll(std::span<const Ray> rays) const {
  std::vector<ExactHit> hits(rays.size());
  forEachIndex(rays.size(), [&](size_t i) { hits[i] = nearestOfAll(rays[i]); });
  return hits;
}

glm::dvec3 ExactTracer::normal(uint32_t primitive, const glm::dvec3& point, uint32_t instance) const {
  const size_t triangles = scene_.triangles.size();
  if (primitive >= triangles)
    return glm::normalize(point - glm::dvec3(scene_.spheres[primitive - triangles].center));
  const glm::uvec3& v = scene_.triangles[primitive].vertex;
  const std::vector<glm::vec3>& positions = scene_.vertices.position;
  const glm::dvec3 a(positions[v.x]);
  const glm::dvec3 cross = glm::cross(glm::dvec3(positions[v.y]) - a, glm::dvec3(positions[v.z]) - a);
  return glm::normalize(instance == kMissIndex ? cross
                                               : glm::transpose(glm::dmat3(toMesh_[instance])) * cross);
}

double ExactTracer::pointError(uint32_t primitive) const {
  constexpr double kUnits = 32.0 * 0x1p-24;
  const size_t triangles = scene_.triangles.size();
  glm::vec3 largest(0.0f);
  if (primitive >= triangles) {
    const Sphere& sphere = scene_.spheres[primitive - triangles];
    largest = glm::abs(sphere.center) + glm::vec3(sphere.radius);
  } else {
    for (const glm::vec3& p : cornersOf(scene_, scene_.triangles[primitive]))
      largest = glm::max(largest, glm::abs(p));
  }
  return kUnits * std::max({largest.x, largest.y, largest.z});
}

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
