// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "image/image.h"

namespace fragtrace {

/// Pixels of a picture; all counts have their origin at its top left.
struct PixelArea {
  glm::ivec2 corner{0};
  glm::ivec2 size{0};  ///< 0: none

  bool operator==(const PixelArea&) const = default;
};

/// The values of an area of a picture.
struct PictureValues {
  uint64_t picture = 0;  ///< number of the picture
  glm::ivec2 whole{0};   ///< its size
  PixelArea area;
  Image image;  ///< values of the area: R, G, B and more
};

/// The pixel of a picture of that size at a place, in parts of width and height from the top left.
inline glm::ivec2 pixelAt(glm::ivec2 size, const glm::dvec2& place) {
  return glm::clamp(glm::ivec2(place * glm::dvec2(size)), glm::ivec2(0), size - 1);
}

/// The first three channels of the pixel at a place; none where it is not known.
inline std::optional<glm::dvec3> radianceAt(const PictureValues& values, const glm::dvec2& place) {
  if (values.area.size.x <= 0) return std::nullopt;
  const glm::ivec2 pixel = pixelAt(values.whole, place) - values.area.corner;
  const glm::ivec2 size = values.area.size;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) return std::nullopt;
  const float* value =
      &values.image
           .values[(size_t(pixel.y) * size_t(size.x) + size_t(pixel.x)) * values.image.channelCount()];
  return glm::dvec3(value[0], value[1], value[2]);
}

}  // namespace fragtrace
