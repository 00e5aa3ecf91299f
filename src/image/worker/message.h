// SPDX-License-Identifier: MIT
// The input and output of the worker's module for pictures.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "image/format.h"
#include "image/image.h"

namespace fragtrace {

enum class PictureTask : uint32_t { DecodeFloats, DecodeTexels, EncodeBytes, EncodeFloats, ShowByView };

/// Begins the input. The bytes of a file to decode or the values to encode follow. It also begins the output
/// of DecodeFloats, where it describes the picture. The texts of a picture follow its floats.
struct PictureMessage {
  PictureTask task = PictureTask::DecodeFloats;
  ImageFormat format = ImageFormat::Png;
  int32_t width = 0;  ///< to decode a picture: the width of the whole that its header promises
  int32_t height = 0;
  int32_t channelCount = 0;  ///< to decode a picture: the largest number of channels
  /// With DecodeTexels and EncodeBytes: bits of a channel, 8 or 16. With EncodeFloats: 16 if some channels
  /// are half.
  int32_t bits = 0;
  int32_t numberCount = 0;   ///< attributes that are numbers, the last of the texts
  Placement placement = {};  ///< a whole of width 0: none
};

PictureMessage messageOf(const Image& image, PictureTask task, ImageFormat format, int bits);

/// Texts with their lengths before them: the channels; with 16 bits "half" or "float" for each of them; pairs
/// of an attribute's name and its text; pairs of a name and the bytes of its numbers.
std::vector<uint8_t> textsOf(const Image& image, int bits);

/// A picture as it is sent; its values stay where they are.
struct SentImage {
  Image image;  ///< without values
  std::span<const float> values;
  std::vector<bool> halves;  ///< with 16 bits: true for channels that are stored as 16-bit floats
};

/// Takes values and texts apart. Throws std::runtime_error where they are not what the message says.
SentImage takeImage(const PictureMessage& message, std::span<const uint8_t> bytes);

inline std::span<const uint8_t> asBytes(std::span<const float> values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size_bytes()};
}

}  // namespace fragtrace
