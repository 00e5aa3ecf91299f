// SPDX-License-Identifier: MIT
// The entries of a folder in natural order.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

struct FolderEntry {
  std::string name;
  bool isFolder = false;

  bool operator==(const FolderEntry&) const = default;
};

/// The entries of a folder without hidden ones: folders, then files, each in natural order.
struct FolderContent {
  std::filesystem::path folder;  ///< absolute, without . and ..
  std::vector<FolderEntry> entries;
  std::string error;  ///< why they cannot be read, or not all of them
};
FolderContent readFolder(const std::filesystem::path& folder);

/// Numbers in names by their value, letters whatever their case: "part 9.glb" before "Part 10.glb".
bool naturallyBefore(std::string_view a, std::string_view b);

}  // namespace fragtrace
