// SPDX-License-Identifier: MIT
// The options of `denoise`, and those of other commands that filter files.
#pragma once

#include <filesystem>
#include <string>

#include "options/parse_render.h"

namespace fragtrace {

struct DenoiseOptions {
  std::filesystem::path picture;
  RenderOptions render;  ///< read are output, filter and its library, backend, display
};

struct RawDenoise {
  std::string picture;
  RawRender render;
};

/// Adds all options of `denoise`.
void addDenoiseCommandOptions(CLI::App& app, RawDenoise& raw);

/// Adds what a command needs that can filter a file: the filter itself is another option's.
void addFileFilterOptions(CLI::App& app, RawRender& raw);

/// Throws UsageError.
DenoiseOptions finishDenoise(const RawDenoise& raw);

}  // namespace fragtrace
