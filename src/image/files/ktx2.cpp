// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "image/files/header.h"

namespace fragtrace {
namespace {

using Bytes = std::span<const uint8_t>;

/// KTX 2.0 specification, 3.1, and the first entry of the level index (3.9.7). All numbers are little-endian.
struct Fields {
  std::array<uint8_t, 12> identifier;
  uint32_t format, typeSize, width, height, depth, layers, faces, levels, scheme;
  uint32_t formatOffset, formatLength, metadataOffset, metadataLength;
  uint64_t globalOffset, globalLength;
  uint64_t levelOffset, levelLength, levelUncompressed;
};
static_assert(sizeof(Fields) == 104);

// Schemes of supercompression, and colour models of the Khronos data format.
constexpr uint32_t kNone = 0, kBasisLz = 1, kZstandard = 2;
constexpr uint32_t kEtc1s = 163, kUastc = 166;

[[noreturn]] void refuse(const std::string& reason) { throw std::runtime_error(reason); }

Bytes sliceOf(Bytes bytes, uint64_t offset, uint64_t length) {
  if (offset > bytes.size() || length > bytes.size() - offset) refuse("the file is truncated");
  return bytes.subspan(offset, length);
}

template <typename Value>
Value valueAt(Bytes bytes, uint64_t offset) {
  Value value;
  std::memcpy(&value, sliceOf(bytes, offset, sizeof value).data(), sizeof value);
  return value;
}

void checkShape(const Fields& header) {
  constexpr uint32_t kLargestSide = 16384;  // the decoder's limit
  if (header.faces != 1) refuse("it is a cube map, and textures of glTF have two dimensions");
  if (header.layers != 0)
    refuse("it is an array or a film of " + std::to_string(header.layers) + " layers, and no picture");
  if (header.depth != 0 || header.height == 0 || header.width == 0)
    refuse("it has " + std::string(header.depth != 0 ? "three dimensions" : "one dimension") + ", not two");
  if (std::max(header.width, header.height) > kLargestSide)
    refuse("a size of " + std::to_string(header.width) + " x " + std::to_string(header.height) +
           " pixels is not supported");
}

/// Level 0 of UASTC has a block of 16 bytes for each 4 x 4 texels.
void checkSizes(const Fields& header, uint32_t model) {
  const uint64_t blocks = uint64_t(header.width + 3) / 4 * ((header.height + 3) / 4);
  const uint64_t bytes = header.levelUncompressed;
  if (model == kUastc && (bytes != 16 * blocks || (header.scheme == kNone && bytes != header.levelLength)))
    refuse("its level 0 has " + std::to_string(bytes) + " bytes for " + std::to_string(blocks) + " blocks");
  constexpr uint64_t kGlobalHeader = 20;
  if (model == kEtc1s && header.globalLength < kGlobalHeader) refuse("it has no codebooks");
}

/// The data format descriptor (Khronos data format specification, 5).
void checkFormat(const Fields& header, Bytes format) {
  constexpr uint64_t kModelAt = 12, kFlagsAt = 15, kFirstSampleEnd = 44;
  constexpr uint8_t kMultipliedByAlpha = 1;
  if (format.size() < kFirstSampleEnd) refuse("the KTX2 header is wrong");
  const uint32_t model = format[kModelAt];
  const bool isRead =
      header.format == 0 && ((model == kEtc1s && header.scheme == kBasisLz) ||
                             (model == kUastc && (header.scheme == kNone || header.scheme == kZstandard)));
  if (!isRead)
    refuse("it is neither ETC1S nor UASTC, which textures of glTF have (vkFormat " +
           std::to_string(header.format) + ", colour model " + std::to_string(model) + ", supercompression " +
           std::to_string(header.scheme) + ")");
  if ((format[kFlagsAt] & kMultipliedByAlpha) != 0)
    refuse("its colours are multiplied by alpha, which textures of glTF must not be");
  checkSizes(header, model);
}

/// Key and value, with a zero behind each text, and zeros up to a multiple of four.
void checkMetadata(Bytes metadata) {
  uint64_t at = 0;
  while (at < metadata.size()) {
    const Bytes entry = sliceOf(metadata, at + 4, valueAt<uint32_t>(metadata, at));
    const std::string_view text(reinterpret_cast<const char*>(entry.data()), entry.size());
    const std::string_view key = text.substr(0, text.find('\0'));
    std::string_view value = text.substr(std::min(key.size() + 1, text.size()));
    value = value.substr(0, value.find('\0'));
    const bool isMirrored = key == "KTXorientation" && value != "rd";
    const bool isSwizzled = key == "KTXswizzle" && value != "rgba";
    if (isMirrored || isSwizzled)
      refuse("its " + std::string(key) + " is not " + (isMirrored ? "rd" : "rgba") +
             ", as it must be in glTF");
    at += (4 + entry.size() + 3) / 4 * 4;
  }
}

}  // namespace

ImageHeader readKtx2Header(Bytes bytes) {
  const auto header = valueAt<Fields>(bytes, 0);
  checkShape(header);
  checkFormat(header, sliceOf(bytes, header.formatOffset, header.formatLength));
  checkMetadata(sliceOf(bytes, header.metadataOffset, header.metadataLength));
  sliceOf(bytes, header.globalOffset, header.globalLength);
  if (sliceOf(bytes, header.levelOffset, header.levelLength).empty()) refuse("its level 0 is empty");
  return {ImageFormat::Ktx2, int(header.width), int(header.height), kMostTextureChannels, {}, {}, 8};
}

}  // namespace fragtrace
