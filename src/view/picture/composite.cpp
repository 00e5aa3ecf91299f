// SPDX-License-Identifier: MIT
#include "view/picture/composite.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace fragtrace {

namespace {

/// The texel of a pixel of a picture of another size.
glm::dvec4 texelAt(const Image& image, glm::ivec2 pixel, glm::ivec2 size) {
  const int x = std::min(int((pixel.x + 0.5) * image.width / size.x), image.width - 1);
  const int y = std::min(int((pixel.y + 0.5) * image.height / size.y), image.height - 1);
  const size_t channels = image.channelCount();
  const float* value = &image.values[(size_t(y) * size_t(image.width) + size_t(x)) * channels];
  return {value[0], value[1], value[2], channels > 3 ? value[3] : 1.0f};
}

/// A texel of the side as a display shows it, premultiplied.
glm::dvec4 displayed(const glm::dvec4& texel, const ComposedSide& side, const Composition& composition) {
  const double factor = side.asItIs ? 1.0 : std::exp2(composition.exposure);
  const ToneMap curve = side.asItIs ? ToneMap::Linear : composition.toneMap;
  if (side.page) return {shownOver(glm::dvec3(*side.page), texel, factor, curve), 1.0};
  const double coverage = std::clamp(texel.a, 0.0, 1.0);
  if (!(coverage > 0.0)) return glm::dvec4(0.0);
  return {applyToneMap(curve, glm::dvec3(texel) / coverage * factor) * coverage, coverage};
}

}  // namespace

Image composite(const std::array<ComposedSide, 2>& sides, glm::ivec2 size, const Composition& composition) {
  const bool difference = composition.difference;
  const bool alpha = !difference && (sides[0].image.channelCount() > 3 || sides[1].image.channelCount() > 3);
  Image picture{size.x, size.y, {"R", "G", "B"}, {}, {}};
  if (alpha) picture.channels.emplace_back("A");
  picture.values.reserve(size_t(size.x) * size_t(size.y) * picture.channelCount());
  const int bar = int(std::lround(composition.bar * size.x));
  const double factor = std::exp2(composition.differenceStops);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      glm::dvec4 value(0.0, 0.0, 0.0, 1.0);
      if (difference) {
        const glm::dvec4 apart =
            texelAt(sides[0].image, {x, y}, size) - texelAt(sides[1].image, {x, y}, size);
        value = glm::dvec4(applyToneMap(ToneMap::Linear, glm::abs(glm::dvec3(apart)) * factor), 1.0);
      } else {
        const ComposedSide& side = sides[x >= bar ? 1 : 0];
        value = displayed(texelAt(side.image, {x, y}, size), side, composition);
      }
      for (int c = 0; c < (alpha ? 4 : 3); ++c) picture.values.push_back(float(value[c]));
    }
  }
  return picture;
}

}  // namespace fragtrace
