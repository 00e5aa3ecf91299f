// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/scene.h"

namespace fragtrace {

/// Texels on a unit of length of the surfaces that show a picture (1 / local space), for each picture of the
/// scene: a mean over all of them, wherever the camera is. At least a millionth of the largest one, so that
/// all can shrink; infinite for a picture that no surface shows.
struct TexelDensities {
  std::vector<double> ofImage;
  double largest = 1.0;  ///< of those that surfaces show
};
TexelDensities texelDensities(const Scene& scene);

}  // namespace fragtrace
