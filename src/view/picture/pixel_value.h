// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "image/image.h"

namespace fragtrace {

/// The first three channels of the pixel at a place, in parts of width and height from the top left.
inline glm::dvec3 radianceAt(const Image& image, const glm::dvec2& place) {
  const glm::ivec2 size(image.width, image.height);
  const glm::ivec2 pixel = glm::clamp(glm::ivec2(place * glm::dvec2(size)), glm::ivec2(0), size - 1);
  const float* value =
      &image.values[(size_t(pixel.y) * size_t(size.x) + size_t(pixel.x)) * image.channelCount()];
  return {value[0], value[1], value[2]};
}

}  // namespace fragtrace
