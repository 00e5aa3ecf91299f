// SPDX-License-Identifier: MIT
#include "bench/stress/stored_png.h"

#include <cassert>
#include <cstdint>
#include <string_view>

namespace fragtrace {

namespace {

std::string bigEndian(uint32_t value) {
  return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

std::string littleEndian(uint32_t value) { return {char(value), char(value >> 8)}; }

/// CRC-32 of PNG's appendix D.
uint32_t crc32(std::string_view bytes) {
  uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= uint8_t(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

/// RFC 1950.
uint32_t adler32(std::string_view bytes) {
  uint32_t a = 1;
  uint32_t b = 0;
  for (const char byte : bytes) {
    a = (a + uint8_t(byte)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

std::string chunk(const std::string& type, const std::string& data) {
  return bigEndian(uint32_t(data.size())) + type + data + bigEndian(crc32(type + data));
}

}  // namespace

std::string storedPng(int width, const std::vector<glm::u8vec3>& texels) {
  const size_t height = texels.size() / size_t(width);
  std::string rows;
  for (size_t i = 0; i < texels.size(); ++i) {
    if (i % size_t(width) == 0) rows += '\0';  // no filter
    rows += {char(texels[i].x), char(texels[i].y), char(texels[i].z)};
  }
  assert(rows.size() <= 0xffff);
  const auto size = uint32_t(rows.size());
  const std::string stream = std::string("\x78\x01\x01", 3) + littleEndian(size) + littleEndian(~size) +
                             rows + bigEndian(adler32(rows));
  const std::string header =
      bigEndian(uint32_t(width)) + bigEndian(uint32_t(height)) + std::string("\x08\x02\x00\x00\x00", 5);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("IDAT", stream) + chunk("IEND", "");
}

}  // namespace fragtrace
