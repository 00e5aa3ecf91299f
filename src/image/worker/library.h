// SPDX-License-Identifier: MIT
// Encoding and decoding by an image library, from memory to memory: OpenImageIO (openimageio.cpp), or stb in
// the bundle of bench/gpu/pack. Every function throws std::runtime_error with the library's own words.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

/// All channels as floats; values as stored, alpha unassociated in 8 and 16 bit formats.
Image decodeFloats(std::span<const uint8_t> bytes, ImageFormat format);

/// Fills `rgba`, which holds width x height texels with 8 or 16 bits a channel; throws when the picture has
/// another size.
void decodeTexels(std::span<const uint8_t> bytes, ImageFormat format, int width, int height, int bits,
                  std::span<uint8_t> rgba);

/// Interleaved RGB, or RGBA with unassociated alpha, of 8 bits as .png or .jpg, of 16 as .png.
std::vector<uint8_t> encodeBytes(int width, int height, int channelCount, int bits,
                                 std::span<const uint8_t> values, ImageFormat format);

/// Every channel as .exr, or three as .hdr. `halves` says of each channel whether it is stored as 16-bit
/// floats; empty: none is.
std::vector<uint8_t> encodeFloats(const Image& image, std::span<const float> values,
                                  const std::vector<bool>& halves, ImageFormat format);

/// Turns the channels R, G, B (linear Rec. 709) into what a view of an OpenColorIO configuration shows. The
/// attributes say which: the members of OcioView.
void showByView(Image& image);

/// Everything that the first use of the library would spend its time on.
void openImageLibrary();

}  // namespace fragtrace
