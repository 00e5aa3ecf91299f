// SPDX-License-Identifier: MIT
#include "image/worker/messages.h"

#include <cstring>
#include <stdexcept>

namespace fragtrace {

PlacementMessage messageOf(const std::optional<Placement>& placement) {
  if (!placement) return {};
  return {placement->corner.x, placement->corner.y, placement->whole.x, placement->whole.y};
}

std::optional<Placement> placementOf(const PlacementMessage& message) {
  if (message.wholeWidth == 0) return std::nullopt;
  return Placement{{message.left, message.top}, {message.wholeWidth, message.wholeHeight}};
}

std::vector<uint8_t> packTexts(const std::vector<std::string>& texts) {
  std::vector<uint8_t> bytes;
  for (const std::string& text : texts) {
    const auto length = uint32_t(text.size());
    const size_t at = bytes.size();
    bytes.resize(at + sizeof length + text.size());
    std::memcpy(bytes.data() + at, &length, sizeof length);
    std::memcpy(bytes.data() + at + sizeof length, text.data(), text.size());
  }
  return bytes;
}

std::vector<std::string> unpackTexts(std::span<const uint8_t> bytes) {
  std::vector<std::string> texts;
  while (!bytes.empty()) {
    uint32_t length = 0;
    if (bytes.size() < sizeof length) throw std::runtime_error("the image process sent broken texts");
    std::memcpy(&length, bytes.data(), sizeof length);
    bytes = bytes.subspan(sizeof length);
    if (length > bytes.size()) throw std::runtime_error("the image process sent broken texts");
    texts.emplace_back(reinterpret_cast<const char*>(bytes.data()), length);
    bytes = bytes.subspan(length);
  }
  return texts;
}

}  // namespace fragtrace
