// SPDX-License-Identifier: MIT
// Which options a picture depends on.
#pragma once

#include "stage/options.h"

namespace fragtrace {

/// Both are to converge to one picture.
bool showSame(const RenderOptions& a, const RenderOptions& b);

/// And their samples are the same.
bool drawSameSamples(const RenderOptions& a, const RenderOptions& b);

}  // namespace fragtrace
