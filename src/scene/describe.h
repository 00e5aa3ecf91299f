// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/vectors.h"
#include "scene/parts.h"
#include "scene/scene.h"

namespace fragtrace {

// Counts the content of a scene, for `fragtrace info` and the statistics, and says where little of it is
// seen.

struct SceneDescription {
  size_t triangles = 0;
  size_t vertices = 0;
  size_t spheres = 0;
  size_t points = 0;
  size_t lines = 0;      ///< segments
  size_t instances = 0;  ///< mesh primitives, counted once for each node that shows them
  size_t sharedMeshes = 0;
  size_t sharedInstances = 0;  ///< instances of shared meshes
  size_t trianglesDrawn = 0;   ///< number of triangles; those of shared meshes count for each instance
  std::string sharing;         ///< why meshes are shared, or are not
  size_t materials = 0;
  size_t textures = 0;
  size_t images = 0;
  size_t imageBytes = 0;    ///< encoded
  size_t texelBytes = 0;    ///< decoded, on the device
  size_t volumeBricks = 0;  ///< bricks that are stored
  size_t pointLights = 0;
  size_t spotLights = 0;
  size_t directionalLights = 0;
  size_t perspectiveCameras = 0;
  size_t orthographicCameras = 0;
  size_t emissiveTriangles = 0;
  size_t emissiveSpheres = 0;
  std::vector<std::string> extensionsUsed;
  BoundsDouble bounds;  ///< world space
  glm::dvec3 origin{0.0};

  size_t lights() const { return pointLights + spotLights + directionalLights; }
  size_t cameras() const { return perspectiveCameras + orthographicCameras; }
};

/// Counts the content. Unlit materials do not count as emissive, since they only show their base colour.
SceneDescription describe(const Scene& scene);

/// Says that what is selected of the scene has nothing to draw; empty: it has.
std::string whyEmpty(const Scene& scene, const SceneSelection& selection);

/// Returns true if all triangles lie in one point or line, and nothing else is there.
bool hasNoArea(const Scene& scene);

/// Says which of the user's numbers change nothing, since no surface has the material, or no node the light.
std::vector<std::string> setInVain(const Scene& scene, const SceneSelection& selection);

/// Says which node reaches so far beyond nearly all triangles that they are a dot where the whole scene is
/// framed; empty: none does. Looks at a sample of the triangles, and at all of them only where there is such
/// a node.
std::string strayNode(const Scene& scene);

}  // namespace fragtrace
