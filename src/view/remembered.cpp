// SPDX-License-Identifier: MIT
#include "view/remembered.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "image/files/whole_file.h"

namespace fragtrace {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::filesystem::path rememberedFile() {
  const auto folder = [](const char* name) {
    const char* value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  const std::filesystem::path state = folder("XDG_STATE_HOME");
  if (state.is_absolute()) return state / "fragtrace/viewer.json";
  const std::filesystem::path home = folder("HOME");
  return home.is_absolute() ? home / ".local/state/fragtrace/viewer.json" : std::filesystem::path();
}

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
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  if (error) throw RenderError(file.parent_path().string() + ": " + error.message());
  const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  replaceFile(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
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
