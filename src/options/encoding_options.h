// SPDX-License-Identifier: MIT
// The options that say how the numbers of a picture file are stored.
#pragma once

#include <filesystem>

#include "image/encoding.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// --half, of commands that write .exr.
void addHalfOption(CLI::App& app, Encoding& encoding);

/// --png-depth, of commands that write .png.
void addPngDepthOption(CLI::App& app, Encoding& encoding);

/// Throws UsageError where the file's format has no such choice.
void checkEncoding(const Encoding& encoding, const std::filesystem::path& output);

}  // namespace fragtrace
