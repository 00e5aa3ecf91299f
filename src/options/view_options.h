// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options/parse_render.h"

namespace fragtrace {

struct ViewOptions {
  RenderOptions render;  ///< options of the first picture
  bool watch = false;    ///< reload when the scene's files or the shaders change
  std::filesystem::path statusFile;
  std::vector<std::filesystem::path> others;  ///< models after the scene
  std::filesystem::path reference;            ///< a picture that is shown as side B; empty: none
  bool panel = true;                          ///< the panel is open at the start
  std::string warning;                        ///< why the file of defaults is left out; empty: it is not
  // These members are for measurements alone.
  /// The most milliseconds of a picture in motion; 0: it has full resolution; none: the device decides.
  std::optional<double> movingMs{};
  bool waitsForPasses = false;  ///< wait for each pass, so that its time can be measured
  bool keepsPast = true;        ///< pictures of moving views reuse the view before
};

struct RawView {
  RawRender render;
  std::string config;
  std::string statusFile;
  std::vector<std::string> others;
  std::string reference;
  bool watch = false;
  bool noPanel = false;
  bool noConfig = false;
};

// Files of the user's.

/// fragtrace/NAME in the folder that the variable names, by default in `usual` below the home (XDG Base
/// Directory Specification 0.8); empty where there is neither.
std::filesystem::path userFile(const char* variable, const char* usual, const char* name);

/// Replaces the file as a whole, and makes its folder. Throws RenderError.
void writeJson(const std::filesystem::path& file, const std::string& json);

/// view.json under $XDG_CONFIG_HOME, by default ~/.config: the defaults of `view`.
std::filesystem::path defaultsFile();

/// Keeps what these options say of filter, light, tone curve and background in a file as --config takes it;
/// its other members stay. Throws InputError for a file that is not of this kind, RenderError.
void keepDefaults(const std::filesystem::path& file, RenderOptions options);

/// Adds all options of `view`.
void addViewOptions(CLI::App& app, RawView& raw);

/// `defaults` is a file of options that the command line and --config take precedence over; empty: none. If
/// it cannot be used, it is left out with a warning. Throws UsageError, InputError (of a file of options).
ViewOptions finishView(RawView& raw, CLI::App& command, const std::filesystem::path& defaults);

}  // namespace fragtrace
