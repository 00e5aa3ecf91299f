// SPDX-License-Identifier: MIT
// What the program and its image process say to each other: a request with a piece of shared memory, a
// reply. The memory holds the input and, at outputOffset(), the output.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/format.h"
#include "image/image.h"
#include "image/region.h"

namespace fragtrace {

enum class ImageTask : uint32_t { DecodeFloats, DecodeTexels, EncodeBytes, EncodeFloats };

/// A Placement; one in a picture of width 0 is none.
struct PlacementMessage {
  int32_t left = 0;
  int32_t top = 0;
  int32_t wholeWidth = 0;
  int32_t wholeHeight = 0;
};

/// Encoded pictures are their file's bytes; decoded ones their values, then texts: the channels, then pairs
/// of an attribute's name and its text. To encode floats of 16 bits, a text "half" or "float" of each channel
/// stands between these. The last attributes are Image::numbers, whose texts are the numbers with a space
/// between.
struct ImageRequest {
  ImageTask task = ImageTask::DecodeFloats;
  ImageFormat format = ImageFormat::Png;
  int32_t width = 0;
  int32_t height = 0;
  int32_t channelCount = 0;
  uint64_t inputBytes = 0;
  uint64_t outputBytes = 0;    ///< room for the output
  PlacementMessage placement;  ///< of what is encoded
  int32_t bits = 0;         ///< of a channel of EncodeBytes, 8 or 16; of EncodeFloats: 16 where some are half
  int32_t numberCount = 0;  ///< attributes that are numbers, the last of the texts
};

struct ImageReply {
  bool done = false;
  int32_t channelCount = 0;
  uint64_t outputBytes = 0;
  int32_t width = 0;  ///< of what was decoded
  int32_t height = 0;
  PlacementMessage placement;
  char reason[1000] = {};   ///< why it is not done
  int32_t numberCount = 0;  ///< as of a request
};

PlacementMessage messageOf(const std::optional<Placement>& placement);
std::optional<Placement> placementOf(const PlacementMessage& message);

/// Numbers with a space between, as few digits as give the same float again.
std::string numbersText(const std::vector<float>& numbers);
/// Throws std::runtime_error when it is no such text.
std::vector<float> numbersOf(const std::string& text);

/// Appends the attributes, those that are numbers behind the others.
void appendAttributes(const Image& image, std::vector<std::string>& texts);
/// Takes all attributes from pairs of texts, of which so many are numbers.
void takeAttributes(std::span<const std::string> texts, int numberCount, Image& image);

/// Texts with their lengths before them.
std::vector<uint8_t> packTexts(const std::vector<std::string>& texts);
/// Throws std::runtime_error when a length does not fit.
std::vector<std::string> unpackTexts(std::span<const uint8_t> bytes);

}  // namespace fragtrace
