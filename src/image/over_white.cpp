// SPDX-License-Identifier: MIT
#include "image/over_white.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "base/vectors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

constexpr float kRounding = 1e-6f;  // smaller changes of alpha are rounding
constexpr float kNearlyFilled = 0.98f;

}  // namespace

bool hasNoisyAlpha(const Image& picture) {
  return picture.attributes.contains(kNoisyAlphaAttribute) && findChannel(picture, "A");
}

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

Image seenOverPage(const Image& picture, const Image& seen, const glm::vec3& page) {
  Image result = onlyChannels(picture, {"R", "G", "B", "A"});
  const double light = luminance(glm::dvec3(page));
  for (size_t i = 0; i < result.values.size() / 4; ++i) {
    float* pixel = &result.values[i * 4];
    const float* over = &seen.values[i * seen.channelCount()];
    const double surfaces = luminance({pixel[0], pixel[1], pixel[2]}) - (1.0 - double(pixel[3])) * light;
    if (light > 0.0 && std::abs(surfaces) <= double(kRounding) * light) {
      const auto alpha = float(1.0 - luminance({over[0], over[1], over[2]}) / light);
      pixel[3] = alpha > kRounding ? alpha : 0.0f;
    }
    std::copy_n(over, 3, pixel);
  }
  return result;
}

Image withAlpha(Image picture, const Image& alpha) {
  const size_t channel = findChannel(picture, "A").value();
  const auto covered = findChannel(picture, kGuideChannels[3]);
  for (size_t i = 0; i < alpha.values.size() / alpha.channelCount(); ++i) {
    float* const pixel = &picture.values[i * picture.channelCount()];
    const float other = std::clamp(alpha.values[i * alpha.channelCount()], 0.0f, 1.0f);
    const bool isFilled = covered && pixel[*covered] >= 1.0f - kRounding && pixel[channel] >= 1.0f;
    if (!isFilled || other < kNearlyFilled) pixel[channel] = other;
  }
  return picture;
}

}  // namespace fragtrace
