// SPDX-License-Identifier: MIT
#include "view/file_watch.h"

#include <algorithm>

namespace fragtrace {

namespace {

constexpr int kLooksAway = 4;  // a file is gone if this many looks in turn miss it

}  // namespace

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

}  // namespace fragtrace
