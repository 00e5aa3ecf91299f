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

/// Encoded pictures are their file's bytes; decoded ones their values, then texts: the channels, then pairs of
/// an attribute's name and its text. To encode floats of 16 bits, a text "half" or "float" of each channel
/// stands between these.
struct ImageRequest {
  ImageTask task = ImageTask::DecodeFloats;
  ImageFormat format = ImageFormat::Png;
  int32_t width = 0;
  int32_t height = 0;
  int32_t channelCount = 0;
  uint64_t inputBytes = 0;
  uint64_t outputBytes = 0;    ///< room for the output
  PlacementMessage placement;  ///< of what is encoded
  int32_t bits = 0;            ///< of a channel of EncodeBytes, 8 or 16; of EncodeFloats: 16 where some are half
};

struct ImageReply {
  bool done = false;
  int32_t channelCount = 0;
  uint64_t outputBytes = 0;
  int32_t width = 0;  ///< of what was decoded
  int32_t height = 0;
  PlacementMessage placement;
  char reason[1000] = {};  ///< why it is not done
};

PlacementMessage messageOf(const std::optional<Placement>& placement);
std::optional<Placement> placementOf(const PlacementMessage& message);

/// Texts with their lengths before them.
std::vector<uint8_t> packTexts(const std::vector<std::string>& texts);
/// Throws std::runtime_error when a length does not fit.
std::vector<std::string> unpackTexts(std::span<const uint8_t> bytes);

}  // namespace fragtrace
