// SPDX-License-Identifier: MIT
// The image library behind a shared object of our own, opened when a file first needs it: OpenImageIO brings
// some 250 shared objects with it, which a run that writes .pfm need not pay for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

/// What libfragtrace_imageio.so offers. Host and library are built together, so C++ types may cross. Every
/// function throws std::runtime_error with the bare reason; the caller adds the file.
struct ImageLibrary {
  /// All channels as floats; values as stored, alpha unassociated in 8 and 16 bit formats.
  Image (*decode)(std::span<const uint8_t> bytes, ImageFormat format);
  TexelImage (*decodeTexels)(std::span<const uint8_t> bytes, ImageFormat format);
  /// Interleaved 8-bit RGB, or RGBA with unassociated alpha, as .png or .jpg.
  std::vector<uint8_t> (*encodeBytes)(int width, int height, int channelCount,
                                      std::span<const uint8_t> values, ImageFormat format);
  /// Every channel as .exr, or three as .hdr.
  std::vector<uint8_t> (*encodeFloats)(const Image& image, ImageFormat format);
};

/// The one function that libfragtrace_imageio.so exports, by this name.
inline constexpr const char* kImageLibraryEntry = "fragtraceImageLibrary";
using ImageLibraryEntry = const ImageLibrary* (*)();

/// Opens the library on the first call, from any thread. It is looked for in the folder
/// FRAGTRACE_LIBRARY_PATH, then beside the executable. Throws std::runtime_error naming the library when it
/// cannot be opened, at every call.
const ImageLibrary& imageLibrary();

/// Opens the library ahead of its first use, for a thread that has nothing better to do (join it before the
/// program ends). A failure is kept for the first use to report.
void preloadImageLibrary() noexcept;

}  // namespace fragtrace
