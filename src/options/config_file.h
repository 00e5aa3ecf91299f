// SPDX-License-Identifier: MIT
// --config FILE.json: an object whose members are long option names without their dashes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "options/parse_render.h"

namespace fragtrace {

void addConfigOption(CLI::App& app, std::string& file);

/// Runs a parsed command with its settled options (finishRender()). An option of the file (none: an empty
/// path) counts unless the command line has given it, or one that excludes it. Names of files in it mean
/// what they mean on the command line. Returns the command's status. Throws InputError that names the file
/// and the line, or the member as a JSON pointer, also where `run` throws UsageError about an option of the
/// file; and what else `run` throws.
int runConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command,
                  const std::function<int(const RenderOptions&)>& run);

/// Does the same for a caller that runs nothing yet: the options.
RenderOptions finishConfigured(RawRender& raw, const std::filesystem::path& config, CLI::App& command);

}  // namespace fragtrace
