// SPDX-License-Identifier: MIT
#pragma once

#include "image/limits.h"
#include "scene/selection.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// What a file from anywhere may ask for, as options of a command that reads scenes.
void addInputOptions(CLI::App& app, InputLimits& limits);

/// What of a file is shown: options of every command that reads scenes.
void addSelectionOptions(CLI::App& app, SceneSelection& selection);

}  // namespace fragtrace
