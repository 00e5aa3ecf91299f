// SPDX-License-Identifier: MIT
#include "image/worker/messages.h"

#include <array>
#include <charconv>
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

std::string numbersText(const std::vector<float>& numbers) {
  std::string text;
  for (const float number : numbers) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    if (!text.empty()) text += ' ';
    text.append(digits.data(), end);
  }
  return text;
}

std::vector<float> numbersOf(const std::string& text) {
  std::vector<float> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    float number = 0.0f;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc() || (rest != end && *rest != ' '))
      throw std::runtime_error("the image process sent broken numbers");
    numbers.push_back(number);
    at = rest == end ? end : rest + 1;
  }
  return numbers;
}

void appendAttributes(const Image& image, std::vector<std::string>& texts) {
  for (const auto& [name, text] : image.attributes) texts.insert(texts.end(), {name, text});
  for (const auto& [name, numbers] : image.numbers) texts.insert(texts.end(), {name, numbersText(numbers)});
}

void takeAttributes(std::span<const std::string> texts, int numberCount, Image& image) {
  if (texts.size() % 2 != 0 || numberCount < 0 || size_t(numberCount) > texts.size() / 2)
    throw std::runtime_error("the image process sent broken attributes");
  const size_t firstNumber = texts.size() - 2 * size_t(numberCount);
  for (size_t i = 0; i < texts.size(); i += 2) {
    if (i < firstNumber)
      image.attributes[texts[i]] = texts[i + 1];
    else
      image.numbers[texts[i]] = numbersOf(texts[i + 1]);
  }
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
