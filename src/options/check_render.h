// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "shader/render_options.h"

namespace fragtrace {

// Options that were given and change nothing, or hardly what was meant.

/// One sentence for each such option, which begins with its name. Only what options alone tell: the scene is
/// not looked at.
std::vector<std::string> vainOptions(const RenderOptions& options);

// The options that a picture depends on.

/// Returns true if both converge to one picture.
bool showSame(const RenderOptions& a, const RenderOptions& b);

/// Returns true if both converge to one picture and have the same samples.
bool drawSameSamples(const RenderOptions& a, const RenderOptions& b);

/// Why such a picture has no noise that a filter could take out; empty: it has.
std::string whyWithoutNoise(const RenderOptions& options);

}  // namespace fragtrace
