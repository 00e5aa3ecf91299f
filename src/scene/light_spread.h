// SPDX-License-Identifier: MIT
// Whether a scene's lights are so far apart that it pays to choose among them by place.
#pragma once

#include "scene/scene.h"

namespace fragtrace {

/// How many times lower the second moment of a light sample would be, over places in the scene, if lights
/// were chosen by what they send there (importanceOf) rather than by their power alone. Shadows are left out,
/// and emissive textures. 1 with less than two lights.
double gainByPlace(const Scene& scene);

/// The gain from which on a tree over the lights pays for its descent.
inline constexpr double kLeastGainByPlace = 1.25;

}  // namespace fragtrace
