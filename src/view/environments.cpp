// SPDX-License-Identifier: MIT
#include "view/environments.h"

#include <algorithm>
#include <set>

#include "view/files.h"

namespace fragtrace {

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

}  // namespace fragtrace
