// SPDX-License-Identifier: MIT
// Files that the viewer opens and writes: their kinds, questions for them, and the meaning of dropped ones.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "shader/render_options.h"
#include "view/exchange.h"

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

// The meaning of files that are dropped on the window.

enum class DroppedFile : uint8_t { Scene, Environment, Unknown };

/// Returns the kind of a file by its extension, in upper or lower case: .gltf and .glb are scenes, .hdr, .exr
/// and .pfm environments.
DroppedFile kindOfDropped(const std::filesystem::path& path);

/// Returns true if the file may be a picture to compare with: an .exr, .pfm or one of display colours.
bool mayBeReference(const std::filesystem::path& path);

/// The requests of files that are dropped together.
struct Drop {
  std::optional<RenderOptions> load;  ///< none: nothing of it can be loaded
  std::vector<std::string> refused;   ///< a sentence for each file that is not taken
};

/// Puts them into the options of the scene that is shown, or being loaded: a scene with a camera of its own,
/// an environment, or both. Of several of a kind the last is taken. `up` points up in a scene, as in
/// SceneSelection.
Drop takeDrop(const RenderOptions& shown, std::span<const std::filesystem::path> files, const glm::dvec3& up);

/// The model `step` places after another one among those given or, if they are fewer than two, among those of
/// its folder, in natural order and round its end. The first one if that one is not among them; empty: there
/// is no other.
std::filesystem::path modelBeside(const std::filesystem::path& model,
                                  std::span<const std::filesystem::path> given, int step);

/// The path of a file:// URI (RFC 8089), with its %XX decoded; nothing for another scheme, another host than
/// this, or a URI that is malformed.
std::optional<std::filesystem::path> fileOfUri(std::string_view uri);

// The lights of a scene that the viewer offers.

/// Returns environment maps next to the scene and next to the one that lights it now, by name, at most
/// kMostEnvironments.
inline constexpr size_t kMostEnvironments = 200;
std::vector<std::filesystem::path> environmentsNear(const RenderOptions& options);

struct EnvironmentChoice {
  std::string name;
  std::filesystem::path file{};  ///< the environment map; empty: none
  bool studio = false;
  bool sky = false;
  DefaultLight light = DefaultLight::Studio;  ///< used if the scene has no light of its own

  bool operator==(const EnvironmentChoice&) const = default;
};

/// The scene's own light or what stands for it, the studio, and all files.
std::vector<EnvironmentChoice> environmentChoices(const ViewedScene& scene);

/// The index of the choice that lights the scene.
size_t currentChoice(const ViewedScene& scene, const std::vector<EnvironmentChoice>& choices);

/// The options with that light.
RenderOptions withEnvironment(RenderOptions options, const EnvironmentChoice& choice);

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

// The memory of the viewer from one start to the next: files that were shown, and views with a name.

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
