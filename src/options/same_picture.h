// SPDX-License-Identifier: MIT
// The options that a picture depends on.
#pragma once

#include <string>

#include "shader/render_options.h"

namespace fragtrace {

/// Both are to converge to one picture.
bool showSame(const RenderOptions& a, const RenderOptions& b);

/// And their samples are the same.
bool drawSameSamples(const RenderOptions& a, const RenderOptions& b);

/// Why such a picture has no noise that a filter could take out; empty: it has.
std::string whyWithoutNoise(const RenderOptions& options);

}  // namespace fragtrace
