// SPDX-License-Identifier: MIT
// writeImage: encodes in memory, then replaces the file in one step.
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "base/errors.h"
#include "image/channels.h"
#include "image/files/pfm.h"
#include "image/files/process.h"
#include "image/files/video_format.h"
#include "image/files/whole_file.h"
#include "image/format.h"
#include "image/image.h"

namespace fragtrace {
namespace {

constexpr float kLargestHalf = 65504.0f;

/// Rounded to the nearest of the levels up to `highest`; what lies outside 0..1 is clamped, and NaN becomes
/// 0.
uint16_t quantize(float value, float highest) {
  if (!(value > 0)) return 0;  // NaN compares false
  return uint16_t(std::lround(std::min(value, 1.0f) * highest));
}

/// The indices of R, G, B and, if wanted and there, A.
std::vector<size_t> outputChannels(const Image& image, bool withAlpha) {
  const auto color = findColorChannels(image);
  if (!color) throw std::runtime_error("the picture has no colour channels");
  std::vector<size_t> channels(color->begin(), color->end());
  const auto alpha = findChannel(image, "A");
  if (withAlpha && alpha) channels.push_back(*alpha);
  return channels;
}

/// The values of these channels, little-endian; opaque alpha follows them if wanted.
std::vector<uint8_t> levelsOf(const Image& image, const std::vector<size_t>& channels, int bits,
                              bool addsAlpha) {
  const float highest = bits == 16 ? 65535.0f : 255.0f;
  const size_t count = image.values.size() / image.channelCount() * (channels.size() + (addsAlpha ? 1 : 0));
  std::vector<uint8_t> bytes;
  bytes.reserve(count * size_t(bits / 8));
  const auto add = [&](float value) {
    const uint16_t level = quantize(value, highest);
    bytes.push_back(uint8_t(level));
    if (bits == 16) bytes.push_back(uint8_t(level >> 8));
  };
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t channel : channels) add(image.values[first + channel]);
    if (addsAlpha) add(1.0f);
  }
  return bytes;
}

std::vector<uint8_t> encodeBytes(const Image& image, ImageFormat format, int bits) {
  const std::vector<size_t> channels = outputChannels(image, format == ImageFormat::Png);
  return encodeBytesByProcess(image.width, image.height, int(channels.size()), bits,
                              levelsOf(image, channels, bits, false), format);
}

/// The nearest colour that three 8-bit mantissas with one exponent hold (Ward, "Real Pixels", Graphics Gems
/// II, 1991). The image library truncates, which would darken a picture by a third of a percent. No negative
/// value and no NaN can be held: both become 0.
void roundToRgbe(std::span<float, 3> color) {
  constexpr float kBrightest = 1e38f;
  for (float& value : color) value = value > 0 ? std::min(value, kBrightest) : 0.0f;
  int exponent = 0;
  const float peak = *std::ranges::max_element(color);
  if (std::frexp(peak, &exponent) * 256 >= 255.5f) ++exponent;
  for (float& value : color) value = std::ldexp(std::round(std::ldexp(value, 8 - exponent)), exponent - 8);
}

std::vector<uint8_t> encodeHdr(const Image& image) {
  Image color{image.width, image.height, {"R", "G", "B"}, {}, {}};
  color.values.reserve(size_t(image.width) * size_t(image.height) * 3);
  const std::vector<size_t> channels = outputChannels(image, false);
  for (size_t first = 0; first < image.values.size(); first += image.channelCount())
    for (const size_t channel : channels) color.values.push_back(image.values[first + channel]);
  for (size_t first = 0; first < color.values.size(); first += 3)
    roundToRgbe(std::span<float, 3>(color.values.data() + first, 3));
  return encodeFloatsByProcess(color, ImageFormat::Hdr);
}

/// Clamps values that 16-bit floats cannot hold, in the channels that are stored so, and counts them.
size_t clampToHalf(Image& image) {
  std::vector<size_t> halves;
  for (size_t c = 0; c < image.channelCount(); ++c) {
    if (isStoredAsHalf(image.channels[c])) halves.push_back(c);
  }
  size_t clamped = 0;
  for (size_t first = 0; first < image.values.size(); first += image.channelCount()) {
    for (const size_t c : halves) {
      float& value = image.values[first + c];
      if (!(std::abs(value) > kLargestHalf)) continue;  // NaN stays
      value = std::copysign(kLargestHalf, value);
      ++clamped;
    }
  }
  return clamped;
}

struct Encoded {
  std::vector<uint8_t> bytes;
  size_t clamped = 0;  ///< values
};

Encoded encodeExr(const Image& image, bool half) {
  if (!half) return {encodeFloatsByProcess(image, ImageFormat::OpenExr), 0};
  Image stored = image;
  const size_t clamped = clampToHalf(stored);
  return {encodeFloatsByProcess(stored, ImageFormat::OpenExr, true), clamped};
}

Encoded encode(const Image& image, const std::filesystem::path& path, const Encoding& encoding) {
  if (image.width <= 0 || image.height <= 0 || image.channels.empty() ||
      image.values.size() != size_t(image.width) * size_t(image.height) * image.channelCount())
    throw std::runtime_error("the picture is empty, or its values do not fill it");

  if (const auto form = pixelFormOf(path)) return {pixelsOf(image, *form), 0};
  const auto format = formatOfName(path);
  if (!format) throw std::runtime_error("the name must end in .png, .jpg, .exr, .hdr or .pfm");
  if (format == ImageFormat::Pfm) return {encodePfm(image), 0};
  if (format == ImageFormat::Hdr) return {encodeHdr(image), 0};
  if (format == ImageFormat::OpenExr) return encodeExr(image, encoding.half);
  return {encodeBytes(image, *format, format == ImageFormat::Png ? encoding.pngBits : 8), 0};
}

Encoded encodeNamed(const Image& image, const std::filesystem::path& path, const Encoding& encoding) {
  try {
    return encode(image, path, encoding);
  } catch (const std::exception& error) {
    throw RenderError("cannot write " + path.string() + ": " + error.what());
  }
}

/// The bytes of a pixel that cannot be compressed.
uint64_t bytesOfPixel(std::optional<ImageFormat> format, size_t channelCount, const Encoding& encoding) {
  if (format == ImageFormat::OpenExr) return (encoding.half ? 2 : 4) * channelCount;
  if (format == ImageFormat::Png && encoding.pngBits == 16) return 8;
  if (format == ImageFormat::Pfm) return 12;
  return 4;  // .png with alpha, .hdr; .jpg has 3
}

}  // namespace

std::vector<uint8_t> pixelsOf(const Image& image, const PixelForm& form) {
  const std::vector<size_t> channels = outputChannels(image, form.alpha);
  return levelsOf(image, channels, form.bits, form.alpha && channels.size() == 3);
}

size_t writeImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding) {
  const Encoded encoded = encodeNamed(image, path, encoding);
  replaceFile(path, encoded.bytes);
  return encoded.clamped;
}

size_t printImage(const std::filesystem::path& path, const Image& image, const Encoding& encoding) {
  const Encoded encoded = encodeNamed(image, path, encoding);
  writeToStandardOutput(encoded.bytes);
  return encoded.clamped;
}

void checkImageWritable(const std::filesystem::path& path, int width, int height, size_t channelCount,
                        const Encoding& encoding, bool isFile) {
  constexpr int kMostJpegSide = 65500;  // libjpeg's JPEG_MAX_DIMENSION
  if (formatOfName(path) == ImageFormat::Jpeg && std::max(width, height) > kMostJpegSide)
    throw RenderError("cannot write " + path.string() + ": a .jpg has at most " +
                      std::to_string(kMostJpegSide) + " pixels a side");
  encodeNamed({1, 1, {"R", "G", "B"}, {0.0f, 0.0f, 0.0f}, {}}, path, encoding);
  const uint64_t pixels = uint64_t(width) * uint64_t(height);
  if (isFile) checkRoom(path, pixels * bytesOfPixel(formatOfName(path), channelCount, encoding));
}

}  // namespace fragtrace
