// SPDX-License-Identifier: MIT
#include "session/picture_memory.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "image/channels.h"
#include "image/cryptomatte.h"
#include "render/film/film_pixels.h"

namespace fragtrace {

namespace {

/// The bytes per pixel of the film: three images on the device, a copy of them, and the pixels made from it,
/// as measured at 16384 x 2000. Layers need one more film, adaptive pictures two, which are joined.
uint64_t bytesOfFilm(const RenderOptions& options) {
  constexpr uint64_t kOne = 48 + 48 + sizeof(FilmPixel);
  constexpr uint64_t kWithLayers = kOne + 48 + sizeof(FilmPixel);
  constexpr uint64_t kAdaptive = kOne + 96 + 2 * sizeof(FilmPixel) + 2 * sizeof(double);
  if (isAdaptive(options)) return kAdaptive;
  constexpr uint64_t kMattes = 64;  // the numbers that are counted for a pixel
  if (std::ranges::any_of(options.output.aovs, isMatte)) return kWithLayers + kMattes;
  return options.output.aovs.empty() && options.output.lightGroups.empty() ? kOne : kWithLayers;
}

/// Bytes that filtering takes for a pixel: textures and the sources of two of them, earlier copies of the
/// film, the picture with its layers twice, and the colours.
uint64_t bytesOfFilter(const RenderOptions& options) {
  constexpr uint64_t kDenoised = 7 * 16 + 20 + 20 + 2 * sizeof(FilmPixel) + 8 + 2 * 14 * 4 + 12;
  return options.output.denoise == Denoise::None ? 0 : kDenoised;
}

/// A pixel of a picture that is drawn in parts: the picture, and what encoding makes of it.
uint64_t bytesOfPicture(const RenderOptions& options) { return 4 * sizeof(float) * channelsOf(options); }

uint64_t pixelsOf(glm::ivec2 size) { return uint64_t(size.x) * uint64_t(size.y); }

[[noreturn]] void refuse(glm::ivec2 size, uint64_t limit, uint64_t bytes, const char* how) {
  try {
    MemoryBudget(limit).take(bytes);
    throw std::logic_error("there is memory enough");
  } catch (const std::runtime_error& error) {
    throw UsageError("a picture of " + std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels" +
                     how + " " + error.what());
  }
}

}  // namespace

size_t channelsOf(const RenderOptions& options) {
  size_t channels = 3 + size_t(keepsAlpha(options)) + size_t(options.output.aovSamples) +
                    size_t(options.output.aovVariance);
  for (const Aov aov : options.output.aovs)
    channels += aov == Aov::Guides ? kGuideChannels.size() + 1
                : isMatte(aov)     ? size_t(2 * kMatteRanks)
                                   : rowOf(aov).channels.size();
  channels += 3 * options.output.lightGroups.size();
  if (options.output.denoise != Denoise::None) channels += 3;  // the noisy picture
  return channels;
}

void checkFilmMemory(const RenderOptions& options, glm::ivec2 size) {
  const uint64_t bytes = pixelsOf(size) * (bytesOfFilm(options) + bytesOfFilter(options));
  if (bytes > options.limits.memoryBytes) refuse(size, options.limits.memoryBytes, bytes, "");
}

uint64_t mostFilmPixels(const RenderOptions& options, glm::ivec2 size) {
  constexpr uint64_t kSmall = 1 << 16;
  const uint64_t pixels = pixelsOf(size);
  const uint64_t limit = options.limits.memoryBytes;
  const uint64_t film = bytesOfFilm(options);
  const uint64_t filter = bytesOfFilter(options);
  if (pixels * (film + filter) <= limit) return pixels;
  const uint64_t picture = pixels * (bytesOfPicture(options) + filter);
  const uint64_t left = picture < limit ? (limit - picture) / film : 0;
  if (left >= std::min(pixels, kSmall)) return left;
  refuse(size, limit, picture + std::min(pixels, kSmall) * film, ", drawn in parts,");
}

}  // namespace fragtrace
