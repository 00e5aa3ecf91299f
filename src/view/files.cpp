// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.h"
#include "base/folder.h"
#include "image/files/whole_file.h"
#include "image/format.h"
#include "options/view_options.h"

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

constexpr int kLooksAway = 4;  // a file is gone if this many looks in turn miss it

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
  return extension == ".exr" || extension == ".pfm" || isDisplayFormat(path);
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

std::filesystem::path modelBeside(const std::filesystem::path& model,
                                  std::span<const std::filesystem::path> given, int step) {
  const std::filesystem::path here = std::filesystem::absolute(model);
  std::vector<std::filesystem::path> models;
  if (given.size() > 1) {
    for (const std::filesystem::path& one : given) models.push_back(std::filesystem::absolute(one));
  } else {
    for (const FolderEntry& entry : readFolder(here.parent_path()).entries) {
      if (!entry.isFolder && kindOfDropped(entry.name) == DroppedFile::Scene)
        models.push_back(here.parent_path() / entry.name);
    }
  }
  const auto found = std::ranges::find(models, here);
  if (found == models.end()) return models.empty() ? std::filesystem::path() : models.front();
  const std::ptrdiff_t count = std::ssize(models);
  return count > 1 ? models[size_t((found - models.begin() + step + count) % count)]
                   : std::filesystem::path();
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

std::vector<std::filesystem::path> environmentsNear(const RenderOptions& options) {
  std::vector<std::filesystem::path> files;
  std::set<std::filesystem::path> folders;
  for (const std::filesystem::path& file : {options.scene, options.light.hdriFile}) {
    std::error_code error;
    const std::filesystem::path folder = file.parent_path().empty() ? "." : file.parent_path();
    if (file.empty() || !folders.insert(std::filesystem::weakly_canonical(folder, error)).second) continue;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      if (kindOfDropped(entry->path()) == DroppedFile::Environment) files.push_back(entry->path());
      if (files.size() >= kMostEnvironments) break;
    }
  }
  std::ranges::sort(files, {}, [](const std::filesystem::path& file) { return file.filename(); });
  return files;
}

std::vector<EnvironmentChoice> environmentChoices(const ViewedScene& scene) {
  std::vector<EnvironmentChoice> choices;
  if (scene.defaultLight) {
    choices.push_back({.name = "None", .light = DefaultLight::None});
    choices.push_back({.name = "White", .light = DefaultLight::White});
  } else {
    choices.push_back({.name = "The scene's own light"});
  }
  choices.push_back({.name = "Studio", .studio = true});
  choices.push_back({.name = "Sky", .sky = true});
  for (const std::filesystem::path& file : scene.environments)
    choices.push_back({.name = file.filename().string(), .file = file});
  const std::filesystem::path& shown = scene.options.light.hdriFile;
  if (!shown.empty() && std::ranges::find(scene.environments, shown) == scene.environments.end())
    choices.push_back({.name = shown.filename().string(), .file = shown});
  return choices;
}

size_t currentChoice(const ViewedScene& scene, const std::vector<EnvironmentChoice>& choices) {
  const RenderOptions& o = scene.options;
  const bool sky = o.light.sky.on;
  const bool studio =
      o.light.studio || (scene.surroundings == Surroundings::Map && o.light.hdriFile.empty() && !sky);
  const auto lights = [&](const EnvironmentChoice& choice) {
    if (!o.light.hdriFile.empty() || studio || sky)
      return choice.file == o.light.hdriFile && choice.studio == studio && choice.sky == sky;
    return choice.file.empty() && !choice.studio && !choice.sky &&
           (!scene.defaultLight || choice.light == o.light.defaultLight);
  };
  const auto found = std::ranges::find_if(choices, lights);
  return found == choices.end() ? 0 : size_t(found - choices.begin());
}

RenderOptions withEnvironment(RenderOptions options, const EnvironmentChoice& choice) {
  options.light.hdriFile = choice.file;
  options.light.studio = choice.studio;
  options.light.sky.on = choice.sky;
  options.light.defaultLight = choice.light;
  if (choice.file.empty() && !choice.sky) options.light.backgroundBlur = 0.0;
  return options;
}

std::optional<FileWatch::Look> FileWatch::lookAt(const std::filesystem::path& file) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file, error);
  if (error) return std::nullopt;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return std::nullopt;
  return Look{time, size};
}

FileWatch::FileWatch(const std::vector<std::filesystem::path>& files) {
  for (const auto& file : files) files_[file] = lookAt(file);
}

bool FileWatch::changed() {
  bool any = false;
  for (auto& [file, before] : files_) {
    const std::optional<Look> now = lookAt(file);
    // Editors replace files, which are away for a moment.
    int& away = away_[file];
    away = now ? 0 : std::min(away + 1, kLooksAway + 1);
    if (!now && (away != kLooksAway || !before)) continue;
    if (now == before) continue;
    any = true;
    before = now;
  }
  return any;
}

std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder, std::string_view extension) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == extension && entry.is_regular_file(error)) files.push_back(entry.path());
  }
  return files;
}

std::vector<std::filesystem::path> filesUnder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) files.push_back(entry.path());
  }
  return files;
}

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::filesystem::path rememberedFile() { return userFile("XDG_STATE_HOME", ".local/state", "viewer.json"); }

Remembered readRemembered(const std::filesystem::path& file) {
  Remembered remembered;
  std::ifstream stream(file);
  if (file.empty() || !stream) return remembered;
  try {
    const Json json = Json::parse(stream);
    for (const Json& path : json.at("recent")) remembered.recent.emplace_back(path.get<std::string>());
    for (const auto& [scene, views] : json.at("bookmarks").items()) {
      for (const Json& view : views)
        remembered.bookmarks[scene].push_back({view.at("name"), view.at("camera")});
    }
  } catch (const Json::exception& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return remembered;
}

void writeRemembered(const std::filesystem::path& file, const Remembered& remembered) {
  if (file.empty()) return;
  Json json{{"recent", Json::array()}, {"bookmarks", Json::object()}};
  for (const auto& path : remembered.recent) json["recent"].push_back(path.string());
  for (const auto& [scene, views] : remembered.bookmarks) {
    for (const Bookmark& view : views)
      json["bookmarks"][scene].push_back({{"name", view.name}, {"camera", view.camera}});
  }
  writeJson(file, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void addRecent(Remembered& remembered, const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(file, error);
  if (error) return;
  std::erase(remembered.recent, whole);
  remembered.recent.insert(remembered.recent.begin(), whole);
  if (remembered.recent.size() > kMostRecent) remembered.recent.resize(kMostRecent);
}

}  // namespace fragtrace
