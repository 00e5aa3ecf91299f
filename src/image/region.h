// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace fragtrace {

/// A rectangle of a picture, in pixels; its corner is the top left one, from the picture's top left.
struct Region {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};

  bool operator==(const Region&) const = default;
};

/// The place of a picture in a larger one.
struct Placement {
  glm::ivec2 corner{0};  ///< its top left pixel, counted from the larger one's top left
  glm::ivec2 whole{0};   ///< size of the larger one

  bool operator==(const Placement&) const = default;
};

}  // namespace fragtrace
