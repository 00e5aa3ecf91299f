// SPDX-License-Identifier: MIT
#include "image/format.h"

#include <algorithm>
#include <string_view>

#include "base/text.h"
#include "image/image.h"

namespace fragtrace {
namespace {

bool beginsWith(std::span<const uint8_t> bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), bytes.begin(),
                    [](char expected, uint8_t found) { return uint8_t(expected) == found; });
}

}  // namespace

std::string extensionOf(const std::filesystem::path& path) { return lowered(path.extension().string()); }

std::optional<ImageFormat> formatOfName(const std::filesystem::path& path) {
  const std::string extension = extensionOf(path);
  if (extension == ".png") return ImageFormat::Png;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::Jpeg;
  if (extension == ".exr") return ImageFormat::OpenExr;
  if (extension == ".hdr") return ImageFormat::Hdr;
  if (extension == ".pfm") return ImageFormat::Pfm;
  return std::nullopt;
}

std::optional<ImageFormat> formatOfBytes(std::span<const uint8_t> bytes) {
  if (beginsWith(bytes, "\x89PNG\r\n\x1a\n")) return ImageFormat::Png;
  if (beginsWith(bytes, "\xff\xd8\xff")) return ImageFormat::Jpeg;
  if (beginsWith(bytes, "\x76\x2f\x31\x01")) return ImageFormat::OpenExr;
  if (beginsWith(bytes, "#?")) return ImageFormat::Hdr;
  if (beginsWith(bytes, "RIFF") && bytes.size() >= 12 && beginsWith(bytes.subspan(8), "WEBP"))
    return ImageFormat::WebP;
  if (beginsWith(bytes, "\xabKTX 20\xbb\r\n\x1a\n")) return ImageFormat::Ktx2;
  // ISO/IEC 23008-12: the box of the file's type names its brand.
  if (bytes.size() >= 12 && beginsWith(bytes.subspan(4), "ftypavif")) return ImageFormat::Avif;
  if (beginsWith(bytes, "PF") || beginsWith(bytes, "Pf")) return ImageFormat::Pfm;
  return std::nullopt;
}

bool isWritableImageName(const std::filesystem::path& path) { return formatOfName(path).has_value(); }

bool isDisplayFormat(const std::filesystem::path& path) {
  const auto format = formatOfName(path);
  return format == ImageFormat::Png || format == ImageFormat::Jpeg;
}

}  // namespace fragtrace
