// SPDX-License-Identifier: MIT
// Options of the command that writes a picture: which part of it, where to, and what is told meanwhile.
#pragma once

#include "options/parse_render.h"

namespace fragtrace {

/// --region, --checkpoint, --resume, --format, --progress.
void addOutputOptions(CLI::App& app, RawRender& raw);

/// Where --output is "-", the picture goes to standard output. Throws UsageError where that cannot be.
void chooseStandardOutput(const RawRender& raw, RenderOptions& options);

}  // namespace fragtrace
