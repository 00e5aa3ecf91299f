// SPDX-License-Identifier: MIT
// The memory of the viewer from one start to the next: files that were shown, and views with a name.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace fragtrace {

/// A view with a name.
struct Bookmark {
  std::string name;
  std::string camera;  ///< the camera as options of the command line

  bool operator==(const Bookmark&) const = default;
};

struct Remembered {
  std::vector<std::filesystem::path> recent;               ///< absolute; the latest first
  std::map<std::string, std::vector<Bookmark>> bookmarks;  ///< bookmarks by the absolute path of their scene

  bool operator==(const Remembered&) const = default;
};

inline constexpr size_t kMostRecent = 10;

/// fragtrace/viewer.json under $XDG_STATE_HOME, by default ~/.local/state (XDG Base Directory Specification
/// 0.8); empty where there is neither: nothing is remembered then.
std::filesystem::path rememberedFile();

/// The contents of the file; nothing if there is none. Throws InputError for one that is not of this kind.
Remembered readRemembered(const std::filesystem::path& file);

/// Replaces the file as a whole, and makes its folder. Throws RenderError.
void writeRemembered(const std::filesystem::path& file, const Remembered& remembered);

/// Puts a file in front of the others.
void addRecent(Remembered& remembered, const std::filesystem::path& file);

}  // namespace fragtrace
