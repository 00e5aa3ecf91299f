// SPDX-License-Identifier: MIT
#include "bench/report/picture_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "image/channels.h"

namespace fragtrace {

namespace {

constexpr int kBlock = 8;
constexpr double kRounding = 1e-4;  // rounding of shown values in sums of floats

/// The variance of the difference of two means of luminance. It is pooled over both pictures, so that one
/// rare bright sample widens it on whichever side it falls. Where a picture's own variance is larger, that is
/// used, since the two may sample in different ways.
double varianceOfDifference(const FilmPixel& a, const FilmPixel& b, CheckAgainst against) {
  const double na = a.samples;
  const double nb = b.samples;
  if (against == CheckAgainst::NoiseFree) return a.variance();
  if (na + nb < 3.0) return 0.0;
  const double pooled = (a.m2 + b.m2) / (na + nb - 2.0) * (1.0 / na + 1.0 / nb);
  return std::max(pooled, a.variance() + b.variance());
}

struct ApartSums {
  double difference = 0.0;
  double variance = 0.0;
  double shown = 0.0;
  double pixels = 0.0;

  void add(const ApartSums& s) {
    difference += s.difference;
    variance += s.variance;
    shown += s.shown;
    pixels += s.pixels;
  }
  /// The number of standard errors between the means. `least` is the difference in one pixel that rounding
  /// and the eye allow.
  double errors(double least) const {
    return std::abs(difference) / std::max(std::sqrt(variance), least * pixels);
  }
};

/// The reason why the pictures cannot be compared (their sizes, pixels without samples, values that are not
/// finite); empty if they can.
std::string whyNotComparable(const FilmPixels& picture, const FilmPixels& other) {
  if (picture.size != other.size || picture.pixels.empty()) return "it is not of the same size";
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    for (const FilmPixels* film : {&picture, &other}) {
      const FilmPixel& p = film->pixels[i];
      if (p.samples == 0) return "a pixel has no sample";
      if (!std::isfinite(p.luminance()) || !std::isfinite(p.m2)) return "a pixel is not finite";
    }
  }
  return "";
}

std::string percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * part);
  return text;
}

/// Fills in all figures of the check.
void measure(const FilmPixels& picture, const FilmPixels& other, CheckAgainst against, PictureCheck& check) {
  double shown = 0.0;
  for (const FilmPixel& p : other.pixels) shown += p.luminance();
  shown /= double(other.pixels.size());

  // Step: sum up blocks, and then all of them.
  ApartSums all;
  std::vector<ApartSums> blocks;
  double differing = 0.0;
  double squares = 0.0;
  const glm::ivec2 size = picture.size;
  for (int top = 0; top < size.y; top += kBlock) {
    for (int left = 0; left < size.x; left += kBlock) {
      ApartSums block;
      for (int y = top; y < std::min(top + kBlock, size.y); ++y) {
        for (int x = left; x < std::min(left + kBlock, size.x); ++x) {
          const size_t i = size_t(y) * size_t(size.x) + size_t(x);
          const FilmPixel& a = picture.pixels[i];
          const FilmPixel& b = other.pixels[i];
          const double difference = a.luminance() - b.luminance();
          const glm::dvec3 apart = a.mean() - b.mean();
          squares += glm::dot(apart, apart) / 3.0;
          differing += std::abs(difference) > kRounding * (std::abs(b.luminance()) + 0.01 * shown);
          block.add({difference, varianceOfDifference(a, b, against), b.luminance(), 1.0});
        }
      }
      blocks.push_back(block);
      all.add(block);
    }
  }
  for (ApartSums& block : blocks) {
    // Few samples often miss rare light, and then show no noise. So the picture's variance is the least.
    block.variance = std::max(block.variance, all.variance / all.pixels * block.pixels);
    const double least = kRounding * (std::abs(block.shown) / block.pixels + 0.01 * shown);
    // If the block is black in both, there is no error at all.
    const double errors = block.difference != 0.0 ? block.errors(least) : 0.0;
    check.farBlocks += !(errors <= kBlockErrors);
    check.worstBlock = std::max(check.worstBlock, errors);
  }
  check.farBlocks /= double(blocks.size());
  check.differing = differing / all.pixels;
  check.rmse = std::sqrt(squares / all.pixels);
  check.meanErrors = all.difference != 0.0 ? all.errors(kRounding * std::abs(shown)) : 0.0;
}

/// Says what these figures show to be wrong; empty if nothing is.
std::string verdict(const PictureCheck& check, CheckAgainst against, uint32_t leastSamples) {
  if (against == CheckAgainst::SameSamples) {
    const double more = std::max(1.0, double(leastSamples) / kDifferingSamples);
    if (check.differing > kMostDiffering * more)
      return percent(check.differing) + " of the pixels differ, although their samples are the same";
    if (more == 1.0) return "";
  }
  if (leastSamples < 2) return "one sample per pixel does not tell its noise";
  if (!(check.meanErrors <= kMostMeanErrors)) {
    char text[64];
    std::snprintf(text, sizeof text, "its mean is %.3g standard errors off", check.meanErrors);
    return text;
  }
  if (check.farBlocks > kMostFarBlocks)
    return percent(check.farBlocks) + " of its blocks of 8 x 8 pixels are more than 4 standard errors off";
  return "";
}

}  // namespace

PictureCheck checkPicture(const FilmPixels& picture, const FilmPixels& other, CheckAgainst against) {
  PictureCheck check;
  check.wrong = whyNotComparable(picture, other);
  if (!check.wrong.empty()) return check;
  measure(picture, other, against, check);
  const uint32_t leastSamples = std::ranges::min(picture.pixels, {}, &FilmPixel::samples).samples;
  check.wrong = verdict(check, against, leastSamples);
  return check;
}

FilmPixels filmOf(const Image& picture, bool& noiseFree) {
  FilmPixels film;
  film.size = {picture.width, picture.height};
  film.pixels.resize(size_t(picture.width) * size_t(picture.height));
  const auto color = findColorChannels(picture);
  const auto samples = findChannel(picture, "samples.Y");
  const auto variance = findChannel(picture, "variance.Y");
  noiseFree = !samples || !variance;
  for (int y = 0; color && y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const float* from = picture.pixel(x, y);
      FilmPixel& p = film.pixels[size_t(picture.height - 1 - y) * size_t(picture.width) + size_t(x)];
      p.samples = noiseFree ? 1 : uint32_t(std::max(1.0f, from[*samples]));
      const double n = p.samples;
      for (int c = 0; c < 3; ++c) p.sum[c] = n * double(from[(*color)[size_t(c)]]);
      if (!noiseFree) p.m2 = double(from[*variance]) * n * (n - 1.0);
    }
  }
  return film;
}

}  // namespace fragtrace
