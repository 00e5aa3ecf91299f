// SPDX-License-Identifier: MIT
// The view of a scene that has no camera.
#pragma once

#include "scene/camera.h"

namespace fragtrace {

/// From where the scene's surfaces are seen: kFirstView, or another direction where most of what it has to
/// show would be seen along its edge there.
Orbit firstView(const Scene& scene);

/// The overrides that are asked for. firstView() is added where the scene has no camera, and neither a
/// position nor an orbit is asked for. The scene then fills the picture, unless a focal point or a scale is
/// asked for.
CameraOverrides settledOverrides(CameraOverrides asked, const Scene& scene);

}  // namespace fragtrace
