// SPDX-License-Identifier: MIT
// Meshes that instances share, and places for them.
#pragma once

#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "bvh/bvh.h"
#include "pack/pack_tree.h"
#include "shader_scenes.h"

namespace fragtrace {
namespace {

using glm::dmat4;

/// The look of instances: turned at random, scaled within these factors, each axis for itself, or mirrored.
struct Look {
  double scaleFrom = 0.05;
  double scaleTo = 0.3;
  bool uneven = false;
};

inline dmat4 randomPlace(Draw& draw, const Look& look, double spread) {
  dmat4 place = glm::translate(dmat4(1.0), spread * draw.inCube(1.0));
  const dvec3 axis = draw.direction();
  place = glm::rotate(place, draw.between(0.0, 6.28), axis);
  const double size = draw.between(look.scaleFrom, look.scaleTo);
  dvec3 scale(size);
  if (look.uneven) {
    scale *= dvec3(draw.between(0.2, 1.0), draw.between(0.2, 1.0), 1.0);
    if (draw.integer(0, 1) == 1) scale.x = -scale.x;
  }
  return glm::scale(place, scale);
}

/// One more shared mesh, of half the size, so that its coordinates are at most 1.
inline void addShared(Scene& scene, const std::vector<Corners>& triangles, uint32_t material) {
  scene.sharedMeshes.push_back({uint32_t(scene.triangles.size()), uint32_t(triangles.size())});
  for (const Corners& corners : triangles) {
    const auto first = uint32_t(scene.vertices.position.size());
    for (const vec3& corner : corners) scene.vertices.position.push_back(0.5f * corner);
    scene.triangles.push_back({{first, first + 1, first + 2}, material});
  }
}

inline PackedTree packInstances(Scene scene) {
  const Bvh bvh = buildSceneBvh(scene);
  PackedTree packed = packTreeOf(std::move(scene), &bvh);
  appendInstances(packed.scene, packed.bvh, packed.nodes);
  return packed;
}

}  // namespace
}  // namespace fragtrace
