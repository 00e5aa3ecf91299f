// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "gltf/build/nodes.h"
#include "scene/scene.h"

namespace fragtrace {

// The things that a node may place besides a mesh: a camera, a punctual light, a sphere.

/// The node's camera in world space, free of the node's scale; none if the node has no camera.
std::optional<Camera> cameraAt(const Document& document, const PlacedNode& node);

/// The file's KHR_lights_punctual lights, in its order.
std::vector<LightSource> lightSources(const Document& document);

/// The node's KHR_lights_punctual light in local space. Throws InputError for one that is too bright there.
std::optional<Light> lightAt(Document& document, const PlacedNode& node, const LocalSpace& space);

/// The node's grid of densities (extras "fragtrace_volume"), whose file is in memory and not yet decoded.
std::optional<Volume> volumeAt(Document& document, const PlacedNode& node);

/// A sphere in world space and double precision, as a node places it.
struct PlacedSphere {
  glm::dvec3 center{0.0};
  double radius = 1.0;
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  uint32_t material = 0;
  std::string node{};  ///< its name, or its JSON pointer
  uint32_t nodeIndex = 0;
};

/// The node's KHR_implicit_shapes sphere (extras "shape" and "material"), which must not be scaled unevenly.
std::optional<PlacedSphere> sphereAt(Document& document, const PlacedNode& node);

}  // namespace fragtrace
