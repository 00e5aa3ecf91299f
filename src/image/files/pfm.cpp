// SPDX-License-Identifier: MIT
#include "image/files/pfm.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/text.h"
#include "image/channels.h"

namespace fragtrace {
namespace {

bool isSpace(uint8_t c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The bytes of a comment at the beginning, with the end of its line; 0: there is none. Other formats of
/// Netpbm have such comments in their headers.
size_t commentLength(std::span<const uint8_t> bytes) {
  if (bytes.empty() || bytes[0] != '#') return 0;
  const auto end = std::ranges::find(bytes, uint8_t('\n'));
  return std::min(size_t(end - bytes.begin()) + 1, bytes.size());
}

/// Takes the next word off the bytes, with the white space and the comments before it.
std::string_view takeWord(std::span<const uint8_t>& bytes) {
  size_t begin = 0;
  while (begin < bytes.size() && (isSpace(bytes[begin]) || bytes[begin] == '#'))
    begin += std::max<size_t>(commentLength(bytes.subspan(begin)), 1);
  size_t end = begin;
  while (end < bytes.size() && !isSpace(bytes[end])) ++end;
  const std::string_view word(reinterpret_cast<const char*>(bytes.data()) + begin, end - begin);
  bytes = bytes.subspan(end);
  return word;
}

template <typename Number>
Number parseNumber(std::string_view word, const char* name) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto number = numberOfAll<Number>(word);
  if (!number) throw std::runtime_error(std::string("the PFM header is wrong: it has no ") + name);
  return *number;
}

float loadFloat(const uint8_t* bytes, bool littleEndian) {
  uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= uint32_t(bytes[i]) << (8 * (littleEndian ? i : 3 - i));
  return std::bit_cast<float>(bits);
}

}  // namespace

PfmHeader readPfmHeader(std::span<const uint8_t> bytes) {
  // Kind, width, height, scale, one white-space character.
  const std::string_view kind = takeWord(bytes);
  if (kind != "PF" && kind != "Pf") throw std::runtime_error("the PFM header is wrong");
  PfmHeader header;
  header.width = parseNumber<int>(takeWord(bytes), "width");
  header.height = parseNumber<int>(takeWord(bytes), "height");
  header.channelCount = kind == "PF" ? 3 : 1;
  const double scale = parseNumber<double>(takeWord(bytes), "scale");
  if (scale == 0 || !std::isfinite(scale) || bytes.empty())
    throw std::runtime_error("the PFM header is wrong: it has no scale");
  header.littleEndian = scale < 0;
  header.scale = float(std::abs(scale));
  header.rows = bytes.subspan(bytes.size() > 1 && bytes[0] == '\r' && bytes[1] == '\n' ? 2 : 1);
  checkImageSize(header.width, header.height, header.channelCount);
  const size_t rowBytes = size_t(header.width) * size_t(header.channelCount) * sizeof(float);
  // A comment behind the scale looks like pixels, unless there would be more of them than the header says.
  const size_t comment = commentLength(header.rows);
  if (header.rows.size() == rowBytes * size_t(header.height) + comment)
    header.rows = header.rows.subspan(comment);
  if (header.rows.size() / rowBytes < size_t(header.height))
    throw std::runtime_error("the file is truncated");
  return header;
}

Image decodePfm(std::span<const uint8_t> bytes) {
  const PfmHeader header = readPfmHeader(bytes);
  Image image;
  image.width = header.width;
  image.height = header.height;
  if (header.channelCount == 3)
    image.channels = {"R", "G", "B"};
  else
    image.channels = {"Y"};
  const size_t rowValues = size_t(image.width) * image.channelCount();
  image.values.resize(rowValues * size_t(image.height));
  for (int y = 0; y < image.height; ++y) {
    const uint8_t* row = header.rows.data() + size_t(image.height - 1 - y) * rowValues * sizeof(float);
    for (size_t i = 0; i < rowValues; ++i)
      image.pixel(0, y)[i] = loadFloat(row + i * sizeof(float), header.littleEndian) * header.scale;
  }
  return image;
}

std::vector<uint8_t> encodePfm(const Image& image) {
  const auto color = findColorChannels(image);
  if (!color) throw std::runtime_error("the picture has no colour channels");
  const bool grey = (*color)[0] == (*color)[1];

  const std::string header = std::string(grey ? "Pf" : "PF") + "\n" + std::to_string(image.width) + " " +
                             std::to_string(image.height) + "\n-1.0\n";
  std::vector<uint8_t> bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + size_t(image.width) * size_t(image.height) * (grey ? 4 : 12));
  for (int y = image.height - 1; y >= 0; --y) {
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < (grey ? 1 : 3); ++c) {
        const auto bits = std::bit_cast<uint32_t>(image.pixel(x, y)[(*color)[size_t(c)]]);
        for (int i = 0; i < 4; ++i) bytes.push_back(uint8_t(bits >> (8 * i)));
      }
    }
  }
  return bytes;
}

}  // namespace fragtrace
