// SPDX-License-Identifier: MIT
// The ground that a scene stands on (--ground).
#pragma once

#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Adds a level square, which is seen from above, a little below the bottom of the bounds (world space), and
/// so large that it ends at the horizon. The scene's own bounds do not hold it, so nothing is framed by it.
/// Does nothing without --ground, or to a scene that shows nothing.
void addGround(Scene& scene, const RenderOptions& options, const BoundsDouble& bounds);

}  // namespace fragtrace
