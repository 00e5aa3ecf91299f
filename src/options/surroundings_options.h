// SPDX-License-Identifier: MIT
// The options of `render` that say what is around the scene: environment, background, shadow catcher.
#pragma once

#include "options/parse_render.h"

namespace fragtrace {

void addSurroundingsOptions(CLI::App& app, RawRender& raw);

/// Checks them, but for numbers that are not finite. Throws UsageError.
void finishSurroundings(const RawRender& raw, RenderOptions& o);

}  // namespace fragtrace
