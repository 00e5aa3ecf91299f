// SPDX-License-Identifier: MIT
// --config FILE.json: an object whose members are long option names without their dashes.
#pragma once

#include <filesystem>
#include <string>

#include "options/parse_render.h"

namespace fragtrace {

void addConfigOption(CLI::App& app, std::string& file);

/// finishRender() of a parsed command, with all options of the file (none: an empty path) that its command
/// line has not given, nor one that excludes them. Names of files in it mean what they mean on the command
/// line. Throws InputError that names the file and the line, or the member as a JSON pointer, and UsageError.
RenderOptions finishConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command);

}  // namespace fragtrace
