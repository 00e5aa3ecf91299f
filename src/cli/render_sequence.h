// SPDX-License-Identifier: MIT
#pragma once

#include "shader/render_options.h"

namespace fragtrace {

/// Draws all pictures that are wanted of a sequence, to numbered files, a video or standard output, and ends
/// as leave() does. Returns the status. Throws what all pictures have in common.
int runSequence(const RenderOptions& options);

}  // namespace fragtrace
