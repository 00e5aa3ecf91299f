// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gltf/read/document.h"
#include "scene/parts.h"
#include "scene/scene.h"

namespace fragtrace {

// The node tree in double precision.

/// Metres. Smaller things are left out: squares of their sizes underflow.
inline constexpr double kSmallest = 1e-75;

struct PlacedNode {
  int index = 0;
  glm::dmat4 world{1.0};  ///< affine: the last row is 0, 0, 0, 1
  /// The node or an ancestor is hidden (KHR_node_visibility, or the user's choice): its mesh, sphere and
  /// light are not there.
  bool hidden = false;
  bool hiddenInFile = false;  ///< the same without the user's choice
  int depth = 0;              ///< ancestors
};

/// The nodes of the default scene (else of scene 0, else of the whole file), parents before children, in file
/// order; those that the user hides, by SceneSelection::hiddenNodes, too. All are turned as
/// SceneSelection::up says. Throws InputError for a loop, a node with two parents, and a transform that is
/// not affine or not finite, and UsageError for a node to hide that is not in the file.
std::vector<PlacedNode> placeNodes(Document& document, const SceneSelection& selection);

/// Returns true if the numbers and the products of any four are finite.
bool isMultiplicable(const glm::dmat4& matrix);

/// A node's or mesh's name, or its JSON pointer if it has none.
std::string nameOrPlace(const std::string& name, const char* array, int index);

/// From the mesh of a node into world space, once for each place where the node shows it: one unless it has
/// EXT_mesh_gpu_instancing. Throws InputError for attributes of unlike counts, wrong types or values.
std::vector<glm::dmat4> placesOfMesh(Document& document, const PlacedNode& node);

// The things that a node may place other than a mesh: a camera, a punctual light, a sphere.

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
