// SPDX-License-Identifier: MIT
// readImage, readDisplayImage, readLinearImage and decodeTexels: the format is chosen by the first bytes, the
// file's name only stands in messages.
#include <new>
#include <stdexcept>

#include "errors.h"
#include "image/display/tone_map.h"
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

Image decodeImage(std::span<const uint8_t> bytes, const std::filesystem::path& path, uint64_t memoryLimit) {
  return decodeNamed(path.string(), [&] {
    const ImageHeader header = readImageHeader(bytes);
    const uint64_t values = uint64_t(header.width) * uint64_t(header.height) * uint64_t(header.channelCount);
    MemoryBudget(memoryLimit).take(bytes.size() + values * sizeof(float));
    return header.format == ImageFormat::Pfm ? decodePfm(bytes) : decodeByProcess(bytes, header);
  });
}

bool isLinear(std::span<const uint8_t> bytes) {
  const auto format = formatOfBytes(bytes);
  return format == ImageFormat::OpenExr || format == ImageFormat::Hdr || format == ImageFormat::Pfm;
}

}  // namespace

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
  LinearImage read{decodeImage(bytes, path, memoryLimit), !isLinear(bytes)};
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
