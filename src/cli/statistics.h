// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "bvh/bvh.h"
#include "gl/context.h"
#include "render/renderer.h"
#include "scene/describe.h"

namespace fragtrace {

/// What `--stats` writes about one render; the JSON's keys are the names here.
struct Statistics {
  SceneDescription scene;
  BvhQuality bvh;
  double loadMs = 0.0;
  double bvhBuildMs = 0.0;
  double packMs = 0.0;
  double uploadMs = 0.0;
  double compileMs = 0.0;
  RenderTimes times;
  int spp = 0;
  glm::ivec2 size{0};
  FilmTotals film;
  size_t sceneBytes = 0;
  bool defaultLight = false;
  bool complete = true;
  std::string variant;
  std::string backend;
  std::string glRenderer;
  std::string glVersion;
  std::vector<std::string> skipped;  ///< "refraction: no transmissive material", ...
  std::vector<std::string> warnings;
};

/// Throws RenderError when the file cannot be written.
void writeStatistics(const std::filesystem::path& path, const Statistics& statistics);

double megaPathsPerSecond(const Statistics& statistics);

}  // namespace fragtrace
