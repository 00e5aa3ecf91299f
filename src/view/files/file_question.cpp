// SPDX-License-Identifier: MIT
#include "view/files/file_question.h"

#include <algorithm>

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

}  // namespace fragtrace
