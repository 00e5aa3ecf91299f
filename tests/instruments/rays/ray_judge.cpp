// SPDX-License-Identifier: MIT
#include "tests/instruments/rays/ray_judge.h"

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
    corner_ = cornersOf<dvec3>(scene, scene.triangles[primitive]);
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

  /// Returns the distance from the plane of the triangle, or from the surface of the sphere.
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

  /// Distances at which the line of a ray passes a shape.
  struct Passage {
    double rim = HUGE_VAL;  ///< from the edges, or the sphere's outline, beyond which rays miss
    double beside = 0.0;    ///< from the shape; 0: the line goes through it
    double spread =
        1.0;  ///< square of the farthest corner's distance over the area that the ray sees, times two
  };

  Passage passageOf(const dvec3& origin, const dvec3& direction) const {
    const auto across = [&](const dvec3& p) {
      const dvec3 q = p - origin;
      return q - glm::dot(q, direction) * direction;
    };
    Passage passage;
    if (sphere_) {
      const double off = glm::length(across(dvec3(sphere_->center))) - double(sphere_->radius);
      passage.rim = std::abs(off);
      passage.beside = std::max(off, 0.0);
      return passage;
    }
    std::array<dvec3, 3> p;
    double farthest = 0.0;
    for (size_t i = 0; i < 3; ++i) {
      p[i] = across(corner_[i]);
      farthest = std::max(farthest, glm::dot(p[i], p[i]));
    }
    const double area = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), direction);
    bool inside = area != 0.0;
    for (size_t i = 0; i < 3; ++i) {
      passage.rim = std::min(passage.rim, distanceToSegment(dvec3(0.0), p[i], p[(i + 1) % 3]));
      inside = inside && glm::dot(glm::cross(p[i], p[(i + 1) % 3]), direction) * area >= 0.0;
    }
    passage.beside = inside ? 0.0 : passage.rim;
    passage.spread = farthest / std::abs(area);
    return passage;
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
  const dvec3 origin(ray.origin);
  const double length = glm::length(dvec3(ray.direction));
  const dvec3 direction = dvec3(ray.direction) / length;
  const auto boundOf = [&](const Shape& shape, const dvec3& at) {
    return kRayRoundings * 0x1p-24 * std::max({largestOf(origin), largestOf(at), shape.largestCoordinate()});
  };
  // Weights round by the spread, and the distance with them.
  const auto alongOf = [&](double bound, const Shape::Passage& passage) {
    return bound * (1.0 + passage.spread);
  };
  double foundAlong = 0.0;
  if (hit) {
    const Shape shape(scene, found.primitive);
    const dvec3 point = origin + double(found.t) * dvec3(ray.direction);
    const double bound = boundOf(shape, point);
    const Shape::Passage passage = shape.passageOf(origin, direction);
    foundAlong = alongOf(bound, passage);
    if (!std::isfinite(found.t) || passage.beside > bound || !(shape.distance(point) <= foundAlong))
      return RayFault::FalseHit;
  }
  if (!exactHit || (hit && found.primitive == exact.primitive)) return RayFault::None;
  const Shape shape(scene, exact.primitive);
  const double bound = boundOf(shape, origin + exact.t * dvec3(ray.direction));
  const Shape::Passage passage = shape.passageOf(origin, direction);
  if (passage.rim <= bound || shape.heightOver(origin) <= bound) return RayFault::None;
  if (!hit) return RayFault::Missed;
  const double behind = (double(found.t) - exact.t) * length;
  return behind > foundAlong + alongOf(bound, passage) ? RayFault::Behind : RayFault::None;
}

}  // namespace fragtrace
