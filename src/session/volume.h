// SPDX-License-Identifier: MIT
#pragma once

#include "scene/scene.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Reads the grid that the options, or else the scene ask for, unless `before` has it, and adds its box to
/// the scene's. Warns in the scene of one that has no density. Throws InputError.
void placeVolume(Scene& scene, const RenderOptions& options, const Volume* before);

}  // namespace fragtrace
