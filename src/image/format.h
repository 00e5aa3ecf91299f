// SPDX-License-Identifier: MIT
// The picture formats, and how numbers are encoded in them. A file to be written is known by its name, one
// that is read by its first bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace fragtrace {

enum class ImageFormat { Png, Jpeg, OpenExr, Hdr, WebP, Pfm, Ktx2, Avif };

/// The extension of a file's name with its dot, in small letters.
std::string extensionOf(const std::filesystem::path& path);

/// The format that a file name's extension (any case) asks to be written; nothing when none is written.
std::optional<ImageFormat> formatOfName(const std::filesystem::path& path);

/// The format whose signature the bytes begin with.
std::optional<ImageFormat> formatOfBytes(std::span<const uint8_t> bytes);

struct Encoding {
  bool half =
      false;  ///< .exr: 16-bit floats in the channels that isStoredAsHalf() names, 32-bit ones elsewhere
  int pngBits = 8;  ///< .png: 8 or 16 bits per channel

  bool operator==(const Encoding&) const = default;
};

}  // namespace fragtrace
