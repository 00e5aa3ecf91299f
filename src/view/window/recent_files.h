// SPDX-License-Identifier: MIT
// The files that were shown before, as a list to choose from.
#pragma once

#include <filesystem>
#include <vector>

namespace fragtrace {

/// The recent files as they were when the list was opened: the disk is not asked in each frame.
struct RecentFiles {
  std::vector<std::filesystem::path> files;
  std::vector<bool> gone;
  int frame = -1;  ///< Dear ImGui's frame in which the list was drawn last
};

}  // namespace fragtrace
