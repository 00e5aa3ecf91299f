// SPDX-License-Identifier: MIT
// The view of a scene that has no camera.
#pragma once

#include "scene/camera.h"

namespace fragtrace {

/// The direction from which the scene's surfaces are visible: kFirstView, or another one if most of them
/// would be seen along their edges there.
Orbit firstView(const Scene& scene);

/// The overrides that are asked for. firstView() is added if the scene has no camera, and neither a position
/// nor an orbit is asked for. The scene then fills the picture, unless a focal point or a scale is asked for.
CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene);

}  // namespace fragtrace
