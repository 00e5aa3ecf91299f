// SPDX-License-Identifier: MIT
// Picking: finds what is drawn at a place of the picture.
#pragma once

#include <optional>
#include <string>

#include "bvh/bvh.h"
#include "scene/projection.h"

namespace fragtrace {

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
