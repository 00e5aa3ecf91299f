// SPDX-License-Identifier: MIT
// Decides if a scene's lights are so far apart that it pays to choose among them by place.
#pragma once

#include "scene/scene.h"

namespace fragtrace {

/// The factor by which the second moment of a light sample would fall, over places in the scene, if lights
/// were chosen by what they send there (importanceOf) and not by power alone. Shadows and emissive textures
/// are left out. 1 with less than two lights.
double gainByPlace(const Scene& scene);

/// From this gain on, a tree over the lights pays for its descent.
inline constexpr double kLeastGainByPlace = 1.25;

}  // namespace fragtrace
