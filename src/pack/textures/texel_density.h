// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// Texels on a unit of length of the surfaces that show a picture (1 / local space), for each picture of the
/// scene: a mean over all of them, wherever the camera is. Infinite for a picture that no surface shows; at
/// least a millionth of the largest one otherwise, so that all can shrink.
std::vector<double> texelDensities(const Scene& scene);

}  // namespace fragtrace
