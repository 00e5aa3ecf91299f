// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace fragtrace {

/// Files, and whether one has changed since it was looked at last: by their times and sizes, asked for now
/// and then. One that is not there counts as unchanged until it is back.
class FileWatch {
 public:
  FileWatch() = default;
  explicit FileWatch(const std::vector<std::filesystem::path>& files);
  bool changed();

 private:
  struct Look {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool operator==(const Look&) const = default;
  };
  static std::optional<Look> lookAt(const std::filesystem::path& file);
  std::map<std::filesystem::path, std::optional<Look>> files_;
  std::map<std::filesystem::path, int> away_;  ///< number of looks in turn that have missed it
};

/// Returns all files in a folder whose names end with `extension`, or nothing if there is no such folder.
std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder, std::string_view extension);

/// All files in a folder and in those in it. Empty where there is no such folder.
std::vector<std::filesystem::path> filesUnder(const std::filesystem::path& folder);

}  // namespace fragtrace
