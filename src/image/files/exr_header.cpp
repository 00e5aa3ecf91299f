// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "image/files/header.h"
#include "image/limits.h"

namespace fragtrace {
namespace {

using Bytes = std::span<const uint8_t>;

[[noreturn]] void refuse() { throw std::runtime_error("the OpenEXR header is wrong or truncated"); }

Bytes take(Bytes& bytes, size_t count) {
  if (count > bytes.size()) refuse();
  const Bytes taken = bytes.first(count);
  bytes = bytes.subspan(count);
  return taken;
}

int32_t takeInt(Bytes& bytes) {
  const Bytes b = take(bytes, 4);
  return int32_t(uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24);
}

/// Text up to a zero byte, which is taken too.
std::string_view takeName(Bytes& bytes) {
  constexpr size_t kLongestName = 255;
  const auto* begin = reinterpret_cast<const char*>(bytes.data());
  const void* end = bytes.empty() ? nullptr : std::memchr(begin, 0, std::min(bytes.size(), kLongestName + 1));
  if (end == nullptr) refuse();
  const std::string_view name(begin, size_t(static_cast<const char*>(end) - begin));
  take(bytes, name.size() + 1);
  return name;
}

struct Window {
  int64_t left, top, right, bottom;
  int64_t width() const { return right - left + 1; }
  int64_t height() const { return bottom - top + 1; }
  bool operator==(const Window&) const = default;
};

Window windowOf(Bytes value) {
  const int64_t left = takeInt(value), top = takeInt(value), right = takeInt(value), bottom = takeInt(value);
  const Window window{left, top, right, bottom};
  checkImageSize(window.width(), window.height(), 1);
  return window;
}

/// Name, type, linearity and three bytes, sampling in x and y; then a zero byte.
int channelsOf(Bytes value) {
  constexpr int kMostChannels = 1024;
  constexpr int kSamplingsAt = 8;
  int count = 0;
  while (!takeName(value).empty()) {
    take(value, kSamplingsAt);
    const int32_t samplingX = takeInt(value);
    const int32_t samplingY = takeInt(value);
    if (samplingX < 1 || samplingY < 1 || ++count > kMostChannels) refuse();
  }
  if (count == 0) refuse();
  return count;
}

/// Scan lines per block, by compression (OpenEXR, "File Layout").
int64_t linesOf(uint8_t compression) {
  constexpr int64_t kLines[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  if (compression >= std::size(kLines)) throw std::runtime_error("its OpenEXR compression is not known");
  return kLines[compression];
}

struct Tiles {
  int64_t width, height;
};

Tiles tilesOf(Bytes value) {
  const auto width = uint32_t(takeInt(value));
  const auto height = uint32_t(takeInt(value));
  if (width == 0 || height == 0) refuse();
  return {width, height};
}

struct Attributes {
  std::optional<Window> data, display;
  std::optional<Tiles> tiles;
  int channelCount = 0;
  std::optional<uint8_t> compression;
};

Attributes takeAttributes(Bytes& bytes) {
  Attributes result;
  for (std::string_view name = takeName(bytes); !name.empty(); name = takeName(bytes)) {
    takeName(bytes);  // the type
    const int32_t size = takeInt(bytes);
    if (size < 0) refuse();
    Bytes value = take(bytes, size_t(size));
    if (name == "dataWindow") result.data = windowOf(value);
    if (name == "displayWindow") result.display = windowOf(value);
    if (name == "tiles") result.tiles = tilesOf(value);
    if (name == "channels") result.channelCount = channelsOf(value);
    if (name == "compression") result.compression = take(value, 1)[0];
  }
  return result;
}

/// Returns the number of blocks of a part; `isTiled`: the file says that its only part has tiles.
int64_t blockCountOf(const Attributes& part, bool isTiled, bool isMultiPart) {
  const auto blocks = [](int64_t size, int64_t block) { return (size + block - 1) / block; };
  if (isTiled && !part.tiles) refuse();
  return isTiled || (isMultiPart && part.tiles)
             ? blocks(part.data->width(), part.tiles->width) * blocks(part.data->height(), part.tiles->height)
             : blocks(part.data->height(), linesOf(*part.compression));
}

void extend(Window& window, const Window& other) {
  window = {std::min(window.left, other.left), std::min(window.top, other.top),
            std::max(window.right, other.right), std::max(window.bottom, other.bottom)};
}

}  // namespace

ImageHeader readExrHeader(Bytes bytes) {
  constexpr uint32_t kTiled = 0x200, kDeep = 0x800, kMultiPart = 0x1000;
  take(bytes, 4);  // the signature
  const auto version = uint32_t(takeInt(bytes));
  if ((version & 0xff) != 2) throw std::runtime_error("its OpenEXR version is not supported");
  if ((version & kDeep) != 0) throw std::runtime_error("deep OpenEXR pictures are not supported");
  const bool isMultiPart = (version & kMultiPart) != 0;
  std::optional<Window> data, display;
  int64_t blocks = 0;
  int channelCount = 0;
  do {
    const Attributes part = takeAttributes(bytes);
    if (!part.data || !part.display || !part.compression || part.channelCount == 0) refuse();
    if (display && !(*part.display == *display)) throw std::runtime_error("its parts differ in their sizes");
    display = part.display;
    extend(data ? *data : data.emplace(*part.data), *part.data);
    blocks += blockCountOf(part, (version & kTiled) != 0, isMultiPart);
    channelCount += part.channelCount;
    checkImageSize(data->width(), data->height(), channelCount);
  } while (isMultiPart && !bytes.empty() && bytes[0] != 0);

  // Each block has an entry of 8 bytes in a table, and is itself at least a header of 8.
  constexpr int64_t kLeastOfABlock = 16;
  if (blocks > int64_t(bytes.size()) / kLeastOfABlock) throw std::runtime_error("the file is truncated");
  if (data->left > display->right || data->right < display->left || data->top > display->bottom ||
      data->bottom < display->top)
    throw std::runtime_error("its data window is outside of its display window");
  checkImageSize(display->width(), display->height(), channelCount);
  ImageHeader header{ImageFormat::OpenExr, int(display->width()), int(display->height()), channelCount};
  if (data->left < display->left || data->top < display->top || data->right > display->right ||
      data->bottom > display->bottom)
    header.overscan = {int(data->width()), int(data->height())};
  return header;
}

}  // namespace fragtrace
