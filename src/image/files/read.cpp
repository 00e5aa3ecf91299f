// SPDX-License-Identifier: MIT
// readImage, readDisplayImage, readLinearImage and decodeTexels: the format is chosen by the first bytes, the
// file's name only stands in messages.
#include <algorithm>
#include <new>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "image/display/tone_map.h"
#include "image/files/as_shown.h"
#include "image/files/header.h"
#include "image/files/pfm.h"
#include "image/files/process.h"
#include "image/files/whole_file.h"
#include "image/format.h"
#include "image/image.h"

namespace fragtrace {
namespace {

/// Runs a decoder, and says in its errors which picture it was.
template <typename Decode>
auto decodeNamed(const std::string& name, Decode decode) {
  try {
    return decode();
  } catch (const std::bad_alloc&) {
    throw InputError("cannot read the picture " + name + ": it does not fit into memory");
  } catch (const std::exception& error) {
    throw InputError("cannot read the picture " + name + ": " + error.what());
  }
}

Image decodeStored(std::span<const uint8_t> bytes, const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeNamed(path.string(), [&] {
    const ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Ktx2 || header.format == ImageFormat::Avif)
      throw std::runtime_error("a KTX2 or AVIF picture is read as a texture only");
    MemoryBudget(memoryLimit).take(bytes.size() + decodedValues(header) * sizeof(float));
    return asShown(header.format == ImageFormat::Pfm ? decodePfm(bytes) : decodeByProcess(bytes, header),
                   header);
  });
}

Image decodeImage(std::span<const uint8_t> bytes, const std::filesystem::path& path, uint64_t memoryLimit) {
  return wholeOf(decodeStored(bytes, path, memoryLimit));
}

bool isLinear(std::span<const uint8_t> bytes) {
  const auto format = formatOfBytes(bytes);
  return format == ImageFormat::OpenExr || format == ImageFormat::Hdr || format == ImageFormat::Pfm;
}

}  // namespace

Image wholeOf(Image part) {
  if (!part.placement) return part;
  const auto [corner, size] = *part.placement;
  Image whole{size.x,
              size.y,
              part.channels,
              {},
              std::move(part.attributes),
              std::nullopt,
              std::move(part.numbers),
              std::move(part.notes)};
  whole.values.resize(size_t(size.x) * size_t(size.y) * whole.channelCount());
  const size_t row = size_t(part.width) * part.channelCount();
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.pixel(0, y), row, whole.pixel(corner.x, corner.y + y));
  return whole;
}

Image readStoredImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeStored(readWholeFile(path, memoryLimit), path, memoryLimit);
}

Image readImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeImage(readWholeFile(path, memoryLimit), path, memoryLimit);
}

Image readDisplayImage(const std::filesystem::path& path) {
  const uint64_t memoryLimit = defaultMemoryLimit();
  const std::vector<uint8_t> bytes = readWholeFile(path, memoryLimit);
  Image image = decodeImage(bytes, path, memoryLimit);
  return isLinear(bytes) ? toDefaultDisplay(image) : image;
}

LinearImage readLinearImage(const std::filesystem::path& path, uint64_t memoryLimit) {
  const std::vector<uint8_t> bytes = readWholeFile(path, memoryLimit);
  LinearImage read{decodeStored(bytes, path, memoryLimit), !isLinear(bytes)};
  if (read.wasEncoded) {
    for (float& value : read.image.values) value = float(decodeSrgb(double(value)));
  }
  return read;
}

TexelImage decodeTexels(std::span<const uint8_t> bytes, const std::string& name) {
  return decodeNamed(name, [&] {
    const ImageHeader header = readImageHeader(bytes);
    if (header.format == ImageFormat::Pfm) throw std::runtime_error("a texture cannot be a .pfm picture");
    return decodeTexelsByProcess(bytes, header);
  });
}

}  // namespace fragtrace
