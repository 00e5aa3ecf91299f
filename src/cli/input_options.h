// SPDX-License-Identifier: MIT
#pragma once

#include "image/limits.h"

namespace CLI {
class App;
}

namespace fragtrace {

/// What a file from anywhere may ask for, as options of a command that reads scenes.
void addInputOptions(CLI::App& app, InputLimits& limits);

}  // namespace fragtrace
