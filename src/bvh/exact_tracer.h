// SPDX-License-Identifier: MIT
// Hits in double precision on the processor: what measurements hold the device against.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/bvh.h"
#include "scene/ray.h"
#include "scene/scene.h"

namespace fragtrace {

/// The nearest hit of a ray, or kMissIndex.
struct ExactHit {
  double t = 0.0;  ///< local space
  uint32_t primitive = kMissIndex;
  uint32_t instance = kMissIndex;  ///< that shows it, if one does
};

/// A ray of any length of direction.
struct ExactRay {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0};
};

/// Alpha is not looked at; the back of single-sided surfaces is not there (docs/design/surfaces.md).
class ExactTracer {
 public:
  /// Keeps references. The tree may be empty when nearest() is not called.
  ExactTracer(const Scene& scene, const Bvh& bvh);

  /// By the tree's own boxes.
  ExactHit nearest(const Ray& ray) const;
  /// By testing every primitive.
  ExactHit nearestOfAll(const Ray& ray) const;

  /// nearest() of every ray, on all cores; rays that are not there give a miss.
  std::vector<ExactHit> nearest(std::span<const Ray> rays) const;
  std::vector<ExactHit> nearestOfAll(std::span<const Ray> rays) const;

  /// Unit, on the front, in local space, as is the point.
  glm::dvec3 normal(uint32_t primitive, const glm::dvec3& point, uint32_t instance = kMissIndex) const;
  /// A bound on the error of a 32-bit point on the primitive (hitPointError of src/scene/hit_error.h).
  double pointError(uint32_t primitive) const;

 private:
  void meet(const ExactRay& ray, uint32_t primitive, uint32_t instance, ExactHit& hit) const;
  /// Goes down from a node of the tree in local space, or of an instance's mesh.
  void descend(const ExactRay& ray, uint32_t root, uint32_t instance, ExactHit& hit) const;
  ExactRay inMesh(const ExactRay& ray, uint32_t instance) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<glm::dmat4> toMesh_;  ///< by instance
};

}  // namespace fragtrace
