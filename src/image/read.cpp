// SPDX-License-Identifier: MIT
// readImage, readDisplayImage and decodeTexels: the format is chosen by the first bytes, the file's name only
// stands in messages.
#include <new>
#include <stdexcept>

#include "errors.h"
#include "image/format.h"
#include "image/image.h"
#include "image/jpeg.h"
#include "image/library.h"
#include "image/pfm.h"
#include "image/png.h"
#include "image/tone_map.h"
#include "image/whole_file.h"

namespace fragtrace {
namespace {

/// The format of a picture that is whole as far as its container tells.
ImageFormat checkedFormat(std::span<const uint8_t> bytes) {
  if (bytes.empty()) throw std::runtime_error("it is empty");
  const auto format = formatOfBytes(bytes);
  if (!format) throw std::runtime_error("it is no PNG, JPEG, WebP, OpenEXR, Radiance HDR or PFM picture");
  if ((format == ImageFormat::Png && !isCompletePng(bytes)) ||
      (format == ImageFormat::Jpeg && !isCompleteJpeg(bytes)))
    throw std::runtime_error("the file is truncated");
  return *format;
}

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

Image decodeImage(std::span<const uint8_t> bytes, const std::filesystem::path& path) {
  return decodeNamed(path.string(), [&] {
    const ImageFormat format = checkedFormat(bytes);
    if (format == ImageFormat::Pfm) return decodePfm(bytes);
    return imageLibrary().decode(bytes, format);
  });
}

}  // namespace

Image readImage(const std::filesystem::path& path) { return decodeImage(readWholeFile(path), path); }

Image readDisplayImage(const std::filesystem::path& path) {
  const std::vector<uint8_t> bytes = readWholeFile(path);
  Image image = decodeImage(bytes, path);
  const auto format = formatOfBytes(bytes);
  const bool isLinear =
      format == ImageFormat::OpenExr || format == ImageFormat::Hdr || format == ImageFormat::Pfm;
  return isLinear ? toDefaultDisplay(image) : image;
}

TexelImage decodeTexels(std::span<const uint8_t> bytes, const std::string& name) {
  return decodeNamed(name, [&] {
    const ImageFormat format = checkedFormat(bytes);
    if (format == ImageFormat::Pfm) throw std::runtime_error("a texture cannot be a .pfm picture");
    return imageLibrary().decodeTexels(bytes, format);
  });
}

}  // namespace fragtrace
