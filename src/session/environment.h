// SPDX-License-Identifier: MIT
// The surroundings of a scene, by the options: a map that is read, the studio, a default light.
#pragma once

#include <future>
#include <string>
#include <vector>

#include "image/image.h"
#include "pack/gpu_scene.h"
#include "pack/own_light.h"
#include "shader/render_options.h"

namespace fragtrace {

/// The map of the options' file. Throws InputError.
LinearImage readMap(const RenderOptions& options);

/// The surroundings of a scene with such a light of its own; `map` is what readMap() gives, or invalid
/// without a file. Says warnings, and adds them to `warnings`. Throws InputError.
Environment makeEnvironment(const RenderOptions& options, std::future<LinearImage>& map, OwnLight light,
                            std::vector<std::string>& warnings);

/// Says that the sky is dark, since the sun is below the horizon; empty: it is not.
std::string whyDark(const SkyOptions& sky);

/// The sky of the options. Says that it is dark, and adds a warning to `warnings` at night.
Environment skyOf(const RenderOptions& options, std::vector<std::string>& warnings);

}  // namespace fragtrace
