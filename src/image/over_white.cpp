// SPDX-License-Identifier: MIT
#include "image/over_white.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "base/vectors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

constexpr float kRounding = 1e-6f;  // smaller changes of alpha are rounding

}  // namespace

bool isOverWhite(const Image& picture) {
  return picture.attributes.contains(kOverWhiteAttribute) && findChannel(picture, "A");
}

Image laidOverWhite(const Image& picture) {
  Image over = picture;
  const auto color = findColorChannels(picture);
  const auto alpha = findChannel(picture, "A");
  if (!color || !alpha) return over;
  for (size_t first = 0; first < over.values.size(); first += over.channelCount()) {
    for (const size_t c : *color) over.values[first + c] += 1.0f - over.values[first + *alpha];
  }
  return over;
}

Image liftedFromWhite(const Image& picture, const Image& seen) {
  Image lifted = onlyChannels(picture, {"R", "G", "B", "A"});
  for (size_t i = 0; i < lifted.values.size() / 4; ++i) {
    float* pixel = &lifted.values[i * 4];
    const float* over = &seen.values[i * seen.channelCount()];
    if (pixel[0] == 0.0f && pixel[1] == 0.0f && pixel[2] == 0.0f) {
      const float alpha = 1.0f - float(luminance({over[0], over[1], over[2]}));
      pixel[3] = alpha > kRounding ? alpha : 0.0f;
    } else {
      for (int c = 0; c < 3; ++c) pixel[c] = std::max(over[c] - (1.0f - pixel[3]), 0.0f);
    }
  }
  return lifted;
}

}  // namespace fragtrace
