// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "scene/camera.h"
#include "scene/local_space.h"
#include "scene/scene.h"

namespace fragtrace {

// Finds hits in double precision on the processor. Measurements compare the device with it.

/// The nearest hit of a ray, or kMissIndex.
struct ExactHit {
  double t = 0.0;  ///< local space
  uint32_t primitive = kMissIndex;
  uint32_t instance = kMissIndex;  ///< the instance that shows it, if one does
};

/// A ray whose direction may have any length.
struct ExactRay {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0};
};

/// Traces rays in double precision. It ignores alpha, and does not see the back of single-sided surfaces
/// (docs/design/surfaces.md).
class ExactTracer {
 public:
  /// Keeps references. The tree may be empty when nearest() is not called.
  ExactTracer(const Scene& scene, const Bvh& bvh);

  /// Walks the tree's own boxes.
  ExactHit nearest(const Ray& ray) const;
  /// Tests every primitive.
  ExactHit nearestOfAll(const Ray& ray) const;

  /// nearest() of every ray, on all cores; a ray whose limit is 0 gives a miss.
  std::vector<ExactHit> nearest(std::span<const Ray> rays) const;
  std::vector<ExactHit> nearestOfAll(std::span<const Ray> rays) const;

  /// The unit normal on the front, in local space, as the point is.
  glm::dvec3 normal(uint32_t primitive, const glm::dvec3& point, uint32_t instance = kMissIndex) const;
  /// A bound on the error of a 32-bit point on the primitive (hitPointError of src/scene/hit_error.h).
  double pointError(uint32_t primitive) const;

 private:
  void meet(const ExactRay& ray, uint32_t primitive, uint32_t instance, ExactHit& hit) const;
  /// Descends from a node of the tree in local space, or of an instance's mesh.
  void descend(const ExactRay& ray, uint32_t root, uint32_t instance, ExactHit& hit) const;
  ExactRay inMesh(const ExactRay& ray, uint32_t instance) const;

  const Scene& scene_;
  const Bvh& bvh_;
  std::vector<glm::dmat4> toMesh_;  ///< matrices by instance
};

// Picking: finds what is drawn at a place of the picture.

struct Pick {
  std::string node;                 ///< its name, or its JSON pointer
  uint32_t nodeIndex = 0;           ///< its place in the file
  std::string mesh;                 ///< the mesh's name, or its JSON pointer; empty for a sphere
  uint32_t primitive = kMissIndex;  ///< index in the scene: triangles first, then spheres
  uint32_t triangle = kMissIndex;   ///< its number in the mesh primitive; kMissIndex for a sphere
  uint32_t material = 0;
  uint32_t instance = kMissIndex;  ///< index of the shared mesh's instance that it belongs to
  double distance = 0.0;           ///< metres from the camera, or from the plane of an orthographic one
  glm::dvec3 point{0.0};           ///< world space
  glm::dvec3 normal{0.0};          ///< geometric, unit, towards the camera
};

/// The surface nearest to the camera there, by the tree; nothing where there is none. It ignores alpha, and
/// does not see the back of single-sided surfaces.
std::optional<Pick> pickAt(const Scene& scene, const Bvh& bvh, const Projection& projection,
                           const glm::dvec2& place);

}  // namespace fragtrace
