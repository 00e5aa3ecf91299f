// SPDX-License-Identifier: MIT
#include "bench/ray_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fragtrace {

namespace {

using glm::dvec3;

double distanceToSegment(const dvec3& p, const dvec3& a, const dvec3& b) {
  const dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  const double s = squared > 0.0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + s * along);
}

/// A triangle or sphere in double precision.
class Shape {
 public:
  Shape(const Scene& scene, uint32_t primitive) {
    if (primitive >= scene.triangles.size()) {
      sphere_ = &scene.spheres[primitive - scene.triangles.size()];
      return;
    }
    for (int i = 0; i < 3; ++i)
      corner_[size_t(i)] = dvec3(scene.vertices.position[scene.triangles[primitive].vertex[i]]);
    const dvec3 cross = glm::cross(corner_[1] - corner_[0], corner_[2] - corner_[0]);
    const double length = glm::length(cross);
    normal_ = length > 0.0 ? cross / length : dvec3(0.0);
  }

  double largestCoordinate() const {
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (sphere_)
        largest = std::max(largest, std::abs(double(sphere_->center[axis])) + double(sphere_->radius));
      for (const dvec3& c : corner_) largest = std::max(largest, std::abs(c[axis]));
    }
    return largest;
  }

  /// From the plane of the triangle, or the surface of the sphere.
  double heightOver(const dvec3& p) const {
    if (sphere_) return std::abs(glm::distance(p, dvec3(sphere_->center)) - double(sphere_->radius));
    return std::abs(glm::dot(normal_, p - corner_[0]));
  }

  double distance(const dvec3& p) const {
    if (sphere_) return heightOver(p);
    bool over = normal_ != dvec3(0.0);
    double rim = HUGE_VAL;
    for (size_t i = 0; i < 3; ++i) {
      const dvec3 side = corner_[(i + 1) % 3] - corner_[i];
      over = over && glm::dot(glm::cross(side, p - corner_[i]), normal_) >= 0.0;
      rim = std::min(rim, distanceToSegment(p, corner_[i], corner_[(i + 1) % 3]));
    }
    return over ? heightOver(p) : rim;
  }

  /// How far the line passes from where rays begin to miss: the edges, or the sphere's outline.
  double rimBeside(const dvec3& origin, const dvec3& direction) const {
    const auto beside = [&](const dvec3& p) {
      const dvec3 q = p - origin;
      return q - glm::dot(q, direction) * direction;
    };
    if (sphere_) return std::abs(glm::length(beside(dvec3(sphere_->center))) - double(sphere_->radius));
    double rim = HUGE_VAL;
    for (size_t i = 0; i < 3; ++i)
      rim = std::min(rim, distanceToSegment(dvec3(0.0), beside(corner_[i]), beside(corner_[(i + 1) % 3])));
    return rim;
  }

 private:
  std::array<dvec3, 3> corner_{};
  dvec3 normal_{0.0};
  const Sphere* sphere_ = nullptr;
};

double largestOf(const dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

}  // namespace

RayFault judgeRay(const Scene& scene, const Ray& ray, const FoundHit& found, const ExactHit& exact) {
  const bool hit = found.primitive != kMissIndex;
  const bool exactHit = exact.primitive != kMissIndex;
  if (hit && exactHit && found.primitive == exact.primitive && double(found.t) == exact.t)
    return RayFault::None;
  const dvec3 origin(ray.origin);
  const dvec3 direction = glm::normalize(dvec3(ray.direction));
  const dvec3 point = origin + double(found.t) * dvec3(ray.direction);
  const auto boundOf = [&](const Shape& shape, const dvec3& at) {
    return kRayRoundings * 0x1p-24 * std::max({largestOf(origin), largestOf(at), shape.largestCoordinate()});
  };
  if (hit) {
    const Shape shape(scene, found.primitive);
    if (!std::isfinite(found.t) || !(shape.distance(point) <= boundOf(shape, point)))
      return RayFault::FalseHit;
  }
  if (!exactHit || (hit && found.primitive == exact.primitive) || (hit && double(found.t) <= exact.t))
    return RayFault::None;
  const Shape shape(scene, exact.primitive);
  const dvec3 exactPoint = origin + exact.t * dvec3(ray.direction);
  const double bound = boundOf(shape, exactPoint);
  if (shape.rimBeside(origin, direction) <= bound || shape.heightOver(origin) <= bound) return RayFault::None;
  if (!hit) return RayFault::Missed;
  return shape.heightOver(point) > bound ? RayFault::Behind : RayFault::None;
}

}  // namespace fragtrace
