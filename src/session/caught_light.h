// SPDX-License-Identifier: MIT
// The lights whose shadows a shadow catcher shows.
#pragma once

#include <vector>

#include "pack/gpu_scene.h"
#include "scene/shadow_outline.h"
#include "shader/render_options.h"

namespace fragtrace {

/// Returns true if the camera is to be moved until the shadow on the catcher is in the picture, too.
inline bool fitsShadow(const RenderOptions& options, const CameraOverrides& overrides) {
  return overrides.fitShadow && options.light.shadowCatcher && has(options.stages, Stage::Gi);
}

/// The environment, coarsely, and the punctual lights, as the plane of that height (Y, metres) gets them in
/// the middle of the scene.
std::vector<PlaneLight> caughtLights(const Scene& scene, const Environment& environment,
                                     const RenderOptions& options, double height);

}  // namespace fragtrace
