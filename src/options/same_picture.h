// SPDX-License-Identifier: MIT
// The options that a picture depends on.
#pragma once

#include <string>

#include "shader/render_options.h"

namespace fragtrace {

/// Returns true if both converge to one picture.
bool showSame(const RenderOptions& a, const RenderOptions& b);

/// Returns true if both converge to one picture and have the same samples.
bool drawSameSamples(const RenderOptions& a, const RenderOptions& b);

/// Why such a picture has no noise that a filter could take out; empty: it has.
std::string whyWithoutNoise(const RenderOptions& options);

}  // namespace fragtrace
