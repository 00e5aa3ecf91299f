// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "image/display/tone_map.h"
#include "image/image.h"

namespace fragtrace {

/// One side of the split view, to be put beside the other.
struct ComposedSide {
  Image image;                      ///< linear R, G, B, and A where it has that, premultiplied; of any size
  bool asItIs = false;              ///< colours of a debug view: neither exposure nor tone map
  std::optional<glm::vec3> page{};  ///< the colour behind the surfaces, as toDisplayOver() takes it
};

/// The way in which two sides are put together.
struct Composition {
  double bar = 0.5;  ///< start of the right side, a part of the width
  bool difference = false;
  double differenceStops = 0.0;
  double exposure = 0.0;
  ToneMap toneMap = ToneMap::Neutral;
};

/// The split view as the window shows it (shaders/entry/window.frag), as linear display values 0..1 for a
/// linear tone map: left of the bar one side, right of it the other, or the absolute difference of radiance
/// times 2^differenceStops. R, G, B and, for the bar, premultiplied A.
Image composite(const std::array<ComposedSide, 2>& sides, glm::ivec2 size, const Composition& composition);

}  // namespace fragtrace
