// SPDX-License-Identifier: MIT
#include "view/dropped_file.h"

#include <algorithm>

#include "image/format.h"
#include "view/files/file_question.h"

namespace fragtrace {

namespace {

bool isOneOf(std::span<const char* const> extensions, const std::filesystem::path& path) {
  return std::ranges::find(extensions, extensionOf(path)) != extensions.end();
}

}  // namespace

bool mayBeReference(const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  return extension == ".exr" || extension == ".pfm";
}

DroppedFile kindOfDropped(const std::filesystem::path& path) {
  if (isOneOf(kSceneExtensions, path)) return DroppedFile::Scene;
  if (isOneOf(kEnvironmentExtensions, path)) return DroppedFile::Environment;
  return DroppedFile::Unknown;
}

Drop takeDrop(const RenderOptions& shown, std::span<const std::filesystem::path> files,
              const glm::dvec3& up) {
  Drop drop;
  RenderOptions options = shown;
  std::optional<std::filesystem::path> scene;
  std::optional<std::filesystem::path> environment;
  for (const std::filesystem::path& file : files) {
    const DroppedFile kind = kindOfDropped(file);
    if (kind == DroppedFile::Unknown) {
      drop.refused.push_back(file.filename().string() +
                             " is neither a scene (.gltf, .glb) nor an environment (.hdr, .exr, .pfm)");
      continue;
    }
    std::optional<std::filesystem::path>& taken = kind == DroppedFile::Scene ? scene : environment;
    if (taken) drop.refused.push_back(taken->filename().string() + ": only the last of its kind is taken");
    taken = file;
  }
  if (scene) {
    options.scene = *scene;
    options.camera.overrides = {};
    options.camera.index.reset();
    options.camera.sceneOrigin.reset();
    options.selection = {.up = up};
  }
  if (environment) {
    options.light.hdriFile = *environment;
    options.light.studio = false;
    options.light.sky.on = false;
  }
  if (scene || environment) drop.load = options;
  return drop;
}

}  // namespace fragtrace
