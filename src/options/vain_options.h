// SPDX-License-Identifier: MIT
// Options that were given and change nothing, or hardly what was meant.
#pragma once

#include <string>
#include <vector>

#include "shader/render_options.h"

namespace fragtrace {

/// One sentence for each such option, which begins with its name. Only what options alone tell: the scene is
/// not looked at.
std::vector<std::string> vainOptions(const RenderOptions& options);

}  // namespace fragtrace
