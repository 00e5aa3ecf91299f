// SPDX-License-Identifier: MIT
// The view of a scene that has no camera.
#pragma once

#include "scene/camera.h"

namespace fragtrace {

/// From where the scene's surfaces are seen: kFirstView, or another direction where most of what it has to
/// show would be seen along its edge there.
Orbit firstView(const Scene& scene);

/// What is asked for; in a scene without a camera, for which neither a position nor an orbit is asked for,
/// with firstView(). The scene then fills the picture, unless a focal point or a scale is asked for.
CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene);

}  // namespace fragtrace
