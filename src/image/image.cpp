// SPDX-License-Identifier: MIT
#include "image/image.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "base/vectors.h"
#include "image/channels.h"

namespace fragtrace {

namespace {

std::string inMegabytes(uint64_t bytes) { return std::to_string((bytes + 999'999) / 1'000'000) + " MB"; }

constexpr float kRounding = 1e-6f;  // smaller changes of alpha are rounding
constexpr float kNearlyFilled = 0.98f;

/// A range of colours that are not multiplied by alpha.
struct ColorRange {
  glm::vec3 least{std::numeric_limits<float>::max()};
  glm::vec3 most{0.0f};

  glm::vec3 clamped(const glm::vec3& color) const { return glm::clamp(color, glm::min(least, most), most); }
};

/// The colours of the surfaces in a pixel of an RGBA picture and its neighbours; a shadow is none.
ColorRange colorsAround(const Image& picture, size_t index) {
  const int x = int(index % size_t(picture.width));
  const int y = int(index / size_t(picture.width));
  ColorRange range;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, picture.height - 1); ++row) {
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, picture.width - 1); ++column) {
      const float* const p = &picture.values[4 * (size_t(row) * size_t(picture.width) + size_t(column))];
      const glm::vec3 color(p[0], p[1], p[2]);
      if (!(p[3] > 0.0f) || color == glm::vec3(0.0f)) continue;
      range.least = glm::min(range.least, color / p[3]);
      range.most = glm::max(range.most, color / p[3]);
    }
  }
  return range;
}

}  // namespace

uint64_t defaultMemoryLimit() {
  uint64_t limit = uint64_t(8) << 30;
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long pageSize = ::sysconf(_SC_PAGESIZE);
  if (pages > 0 && pageSize > 0) limit = std::min(limit, uint64_t(pages) * uint64_t(pageSize) / 2);
  rlimit address{};
  if (::getrlimit(RLIMIT_AS, &address) == 0 && address.rlim_cur != RLIM_INFINITY)
    limit = std::min(limit, uint64_t(address.rlim_cur));
  return limit;
}

void MemoryBudget::take(uint64_t bytes) {
  if (bytes > limit_ - taken_) {
    const uint64_t wanted = bytes > UINT64_MAX - taken_ ? UINT64_MAX : taken_ + bytes;
    throw AtStake("would take " + inMegabytes(wanted) + " of memory, more than the " + inMegabytes(limit_) +
                  " of --memory-limit");
  }
  taken_ += bytes;
}

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

Image liftedFromWhite(const Image& picture, const Image& seen, const Image& noisy) {
  const Image drawn = onlyChannels(noisy, {"R", "G", "B", "A"});
  Image lifted = onlyChannels(picture, {"R", "G", "B", "A"});
  for (size_t i = 0; i < lifted.values.size() / 4; ++i) {
    float* pixel = &lifted.values[i * 4];
    const float* over = &seen.values[i * seen.channelCount()];
    if (pixel[0] == 0.0f && pixel[1] == 0.0f && pixel[2] == 0.0f) {
      const float alpha = 1.0f - float(luminance({over[0], over[1], over[2]}));
      pixel[3] = alpha > kRounding ? alpha : 0.0f;
      continue;
    }
    glm::vec3 color = glm::max(glm::vec3(over[0], over[1], over[2]) - (1.0f - pixel[3]), glm::vec3(0.0f));
    const bool fills = pixel[3] >= 1.0f && drawn.values[i * 4 + 3] >= 1.0f;
    if (!fills) color = pixel[3] * colorsAround(drawn, i).clamped(color / std::max(pixel[3], kRounding));
    for (int c = 0; c < 3; ++c) pixel[c] = color[c];
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
