// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "image/format.h"

namespace fragtrace {

namespace {

/// "Scenes (.gltf, .glb)"
FileFilter fileFilter(std::string name, std::vector<std::string> extensions) {
  const char* separator = " (";
  for (const std::string& extension : extensions) {
    name.append(separator).append(extension);
    separator = ", ";
  }
  return {name + ")", std::move(extensions)};
}

bool isOneOf(std::span<const char* const> extensions, const std::filesystem::path& path) {
  return std::ranges::find(extensions, extensionOf(path)) != extensions.end();
}

}  // namespace

FileQuestion openQuestion(const std::filesystem::path& folder, bool environment) {
  std::vector<std::string> all(kSceneExtensions.begin(), kSceneExtensions.end());
  all.insert(all.end(), kEnvironmentExtensions.begin(), kEnvironmentExtensions.end());
  FileQuestion question{.title = environment ? "Open an environment" : "Open a scene or an environment",
                        .folder = folder,
                        .name = {},
                        .filters = {}};
  question.filters = {
      fileFilter("Scenes and environments", std::move(all)),
      fileFilter("Scenes", {kSceneExtensions.begin(), kSceneExtensions.end()}),
      fileFilter("Environments", {kEnvironmentExtensions.begin(), kEnvironmentExtensions.end()})};
  if (environment) std::rotate(question.filters.begin(), question.filters.end() - 1, question.filters.end());
  return question;
}

FileQuestion saveQuestion(const std::filesystem::path& picture) {
  return {.save = true,
          .title = "Save the picture as",
          .folder = picture.parent_path(),
          .name = picture.filename().string(),
          .filters = {fileFilter("Pictures", {kPictureExtensions.begin(), kPictureExtensions.end()})}};
}

FileQuestion saveModelQuestion(const std::filesystem::path& model, bool refersToFiles) {
  return {.save = true,
          .title = refersToFiles ? "Save the model in this folder, as it refers to other files, as"
                                 : "Save the model as",
          .folder = model.parent_path(),
          .name = model.filename().string(),
          .filters = {fileFilter("Models", {extensionOf(model)})}};
}

bool passes(const FileFilter& filter, const std::filesystem::path& file) {
  return std::ranges::find(filter.extensions, extensionOf(file)) != filter.extensions.end();
}

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

std::optional<std::filesystem::path> fileOfUri(std::string_view uri) {
  constexpr std::string_view kScheme = "file://";
  constexpr std::string_view kHost = "localhost";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  uri.remove_prefix(kScheme.size());
  if (uri.starts_with(kHost)) uri.remove_prefix(kHost.size());
  if (!uri.starts_with('/')) return std::nullopt;
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    char decoded = uri[i];
    if (decoded == '%') {
      unsigned char byte = 0;
      const std::string_view digits = uri.substr(i + 1, 2);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
      if (error != std::errc() || end != digits.data() + 2 || byte == 0) return std::nullopt;
      decoded = char(byte);
      i += 2;
    }
    path += decoded;
  }
  return path;
}

}  // namespace fragtrace
