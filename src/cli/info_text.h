// SPDX-License-Identifier: MIT
// The lines of `info`.
#pragma once

#include <filesystem>

#include "bvh/bvh.h"
#include "scene/describe.h"
#include "scene/scene.h"
#include "shader/render_options.h"
#include "shader/traits.h"

namespace fragtrace {

/// The scene as somebody sees it who has not made it.
void printContents(const RenderOptions& options, const Scene& scene, const SceneDescription& description);

/// What drawing the scene takes.
struct SceneCosts {
  BvhQuality tree;
  double bytesPerTriangle = 0.0;
  size_t volumeBytes = 0;
  TraitSet traits;
};
void printCosts(const SceneDescription& description, const SceneCosts& costs);

/// A line for each node, indented below its parent.
void printNodes(const std::vector<SceneNode>& nodes);

/// The contents of a node, in words.
std::vector<std::string> contentsOf(const SceneNode& node);

const char* kindOf(const Camera& camera);

}  // namespace fragtrace
