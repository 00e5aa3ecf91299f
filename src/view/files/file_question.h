// SPDX-License-Identifier: MIT
// A question for a file, whoever asks it: the desktop's dialog, or a list in the window.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace fragtrace {

/// Extensions in lower case, with their dot.
inline constexpr std::array kSceneExtensions{".gltf", ".glb"};
inline constexpr std::array kEnvironmentExtensions{".hdr", ".exr", ".pfm"};
/// Pictures that the viewer writes; the first is that of a name without any.
inline constexpr std::array kPictureExtensions{".png", ".jpg", ".exr"};

/// Files of one kind.
struct FileFilter {
  std::string name;
  std::vector<std::string> extensions;  ///< as above
};

struct FileQuestion {
  bool save = false;  ///< the file may be new
  std::string title;
  std::filesystem::path folder;  ///< folder that is shown first; absolute
  std::string name;              ///< name to save under, unless another one is typed
  std::vector<FileFilter> filters;
};

/// Asks for a file to show. If environments are wanted, their filter stands first.
FileQuestion openQuestion(const std::filesystem::path& folder, bool environment);

/// Asks for the name of a picture.
FileQuestion saveQuestion(const std::filesystem::path& picture);

/// Asks for the name of a model, which keeps its extension, and its folder if it refers to other files.
FileQuestion saveModelQuestion(const std::filesystem::path& model, bool refersToFiles);

/// Returns true if the filter lets the file pass.
bool passes(const FileFilter& filter, const std::filesystem::path& file);

}  // namespace fragtrace
