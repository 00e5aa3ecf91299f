// SPDX-License-Identifier: MIT
#include "image/worker/message.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/message.h"
#include "image/channels.h"

namespace fragtrace {
namespace {

using Bytes = std::span<const uint8_t>;

void appendText(std::vector<uint8_t>& texts, Bytes text) {
  const auto length = uint32_t(text.size());
  const Bytes lengthBytes = asMessage(length);
  texts.insert(texts.end(), lengthBytes.begin(), lengthBytes.end());
  texts.insert(texts.end(), text.begin(), text.end());
}

void appendText(std::vector<uint8_t>& texts, std::string_view text) {
  appendText(texts, Bytes(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

[[noreturn]] void refuse() { throw std::runtime_error("the worker process got a broken picture"); }

std::string takeText(Bytes& texts) {
  const auto length = takeMessage<uint32_t>(texts);
  if (length > texts.size()) refuse();
  std::string text(reinterpret_cast<const char*>(texts.data()), length);
  texts = texts.subspan(length);
  return text;
}

}  // namespace

PictureMessage messageOf(const Image& image, PictureTask task, ImageFormat format, int bits) {
  return {task,
          format,
          image.width,
          image.height,
          int32_t(image.channelCount()),
          bits,
          int32_t(image.numbers.size()),
          image.placement.value_or(Placement())};
}

std::vector<uint8_t> textsOf(const Image& image, int bits) {
  std::vector<uint8_t> texts;
  for (const std::string& channel : image.channels) appendText(texts, channel);
  for (size_t c = 0; bits == 16 && c < image.channelCount(); ++c)
    appendText(texts, isStoredAsHalf(image.channels[c]) ? "half" : "float");
  for (const auto& [name, text] : image.attributes) {
    appendText(texts, name);
    appendText(texts, text);
  }
  for (const auto& [name, numbers] : image.numbers) {
    appendText(texts, name);
    appendText(texts, asBytes(numbers));
  }
  return texts;
}

SentImage takeImage(const PictureMessage& message, Bytes bytes) {
  if (message.width <= 0 || message.height <= 0 || message.channelCount <= 0) refuse();
  const auto channelCount = size_t(message.channelCount);
  const size_t count = size_t(message.width) * size_t(message.height) * channelCount;
  if (bytes.size() / sizeof(float) < count) refuse();
  SentImage sent{{message.width, message.height, {}, {}, {}}, {}, {}};
  sent.values = {reinterpret_cast<const float*>(bytes.data()), count};
  if (message.placement.whole.x != 0) sent.image.placement = message.placement;
  Bytes texts = bytes.subspan(count * sizeof(float));
  for (size_t c = 0; c < channelCount; ++c) sent.image.channels.push_back(takeText(texts));
  for (size_t c = 0; message.bits == 16 && c < channelCount; ++c)
    sent.halves.push_back(takeText(texts) == "half");
  std::vector<std::string> attributes;
  while (!texts.empty()) attributes.push_back(takeText(texts));
  const auto numberCount = size_t(message.numberCount);
  if (attributes.size() % 2 != 0 || numberCount > attributes.size() / 2) refuse();
  for (size_t i = 0; i < attributes.size(); i += 2) {
    const std::string& text = attributes[i + 1];
    if (i < attributes.size() - 2 * numberCount) {
      sent.image.attributes[attributes[i]] = text;
    } else {
      std::vector<float>& numbers = sent.image.numbers[attributes[i]];
      numbers.resize(text.size() / sizeof(float));
      std::memcpy(numbers.data(), text.data(), numbers.size() * sizeof(float));
    }
  }
  return sent;
}

}  // namespace fragtrace
