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
};

/// Adds all options of `view`.
void addViewOptions(CLI::App& app, RawView& raw);

/// Throws UsageError, InputError (of a file of options).
ViewOptions finishView(RawView& raw, CLI::App& command);

}  // namespace fragtrace
