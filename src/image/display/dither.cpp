// SPDX-License-Identifier: MIT
#include "image/display/tone_map.h"

#include <cmath>
#include <cstdint>

#include "image/channels.h"

namespace fragtrace {

namespace {

using std::abs;
using std::floor;
using uint = uint32_t;
#include "picture/dither.glsl"

}  // namespace

void dither(Image& display, glm::ivec2 corner) {
  const auto channels = findColorChannels(display);
  if (!channels) return;
  for (int y = 0; y < display.height; ++y) {
    for (int x = 0; x < display.width; ++x) {
      float* pixel = display.pixel(x, y);
      for (uint c = 0; c < 3; ++c) {
        float& value = pixel[(*channels)[c]];
        value = dithered(value, uint(corner.x + x), uint(corner.y + y), c);
      }
    }
  }
}

}  // namespace fragtrace
