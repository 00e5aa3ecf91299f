// SPDX-License-Identifier: MIT
// Pixels without a file's form, for other programs, and the videos that ffmpeg makes of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"

namespace fragtrace {

/// Pixels of a display (sRGB-encoded, unassociated alpha) one after the other, R, G, B and perhaps A, from
/// the top left; 16 bits per channel are little-endian.
struct PixelForm {
  int bits = 8;
  bool alpha = false;
};

/// The pixels of a picture as a display shows it; opaque where it has no A. Throws std::runtime_error
/// without colour.
std::vector<uint8_t> pixelsOf(const Image& image, const PixelForm& form);

/// The form that a path asks for, if it ends in .rgb24 or .rgba64.
std::optional<PixelForm> pixelFormOf(const std::filesystem::path& path);

struct VideoFormat {
  std::string_view extension;  ///< the extension with its dot
  PixelForm pixels;            ///< form of the pixels that the encoder gets
  bool evenSize;               ///< width and height are even: chroma has half of each
  bool yuv;                    ///< the file holds luma and chroma
  bool playsCut;               ///< players show a file that was cut off
  std::string_view encoding;   ///< arguments of ffmpeg, with spaces between
  std::string_view container;  ///< ffmpeg's arguments for the file's container
};

/// The video that a file name's extension (any case) asks for; null: it is no video.
const VideoFormat* videoFormatOf(const std::filesystem::path& path);

/// The arguments of ffmpeg between those of its input and those of the container.
std::vector<std::string> encodingOf(const VideoFormat& format);
/// The arguments that follow them, before the name of the file.
std::vector<std::string> containerOf(const VideoFormat& format);

/// True for what holds tone-mapped, sRGB-encoded values: isDisplayFormat(), pixels and videos.
bool holdsDisplay(const std::filesystem::path& path);

/// True for those of them that hold alpha.
bool holdsDisplayAlpha(const std::filesystem::path& path);

}  // namespace fragtrace
