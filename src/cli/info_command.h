// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "scene/describe.h"
#include "scene/scene.h"
#include "shader/render_options.h"
#include "shader/traits.h"

namespace fragtrace {

// Holds what `info` tells of a scene to somebody who has not made it.

/// The materials, each once: some stand several times in a scene, for lines, points or open panes.
std::vector<const Material*> materialsOf(const Scene& scene);

struct TextureContents {
  const char* slot;  ///< "base colour"
  std::string name;  ///< the file's, or the place in the scene's file
  int width;
  int height;
};

/// The textures of a material, in the order of kTextureRefs.
std::vector<TextureContents> texturesOf(const Scene& scene, const Material& material);

struct LampContents {
  std::string name;  ///< that of the node
  const char* type;
  double intensity;
  const char* unit;
};

/// The punctual lights that nodes of the scene place.
std::vector<LampContents> lampsOf(const Scene& scene);

struct FileContents {
  std::string name;
  uint64_t bytes;
};

/// The scene's file and those that it refers to; one that is missing is left out.
std::vector<FileContents> filesOf(const std::filesystem::path& path, const Scene& scene);

/// Returns what would light the scene with these options: its own light, or a word of kDefaultLightNames.
struct WhoLights {
  std::string by;    ///< "own", or that word
  std::string text;  ///< a clause
};
WhoLights whoLights(const RenderOptions& options, const Scene& scene);

/// "3.1 MB", "450 kB", "12 bytes"
std::string bytesText(uint64_t bytes);

// The lines of `info`.

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
