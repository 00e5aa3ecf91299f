// SPDX-License-Identifier: MIT
#include "gltf/uri.h"

#include <array>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "gltf/diagnostics.h"

namespace fragtrace {
namespace {

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// RFC 4648 base64 with or without padding; false at the first character that does not belong.
bool decodeBase64(std::string_view text, std::vector<uint8_t>& bytes) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<int8_t, 256> kValues = [] {
    std::array<int8_t, 256> values;
    values.fill(-1);
    for (size_t i = 0; i < kAlphabet.size(); ++i) values[uint8_t(kAlphabet[i])] = int8_t(i);
    return values;
  }();
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return false;
  bytes.clear();
  bytes.reserve(text.size() * 3 / 4);
  uint32_t bits = 0;
  int bitCount = 0;
  for (const char c : text) {
    const int8_t value = kValues[uint8_t(c)];
    if (value < 0) return false;
    bits = bits << 6 | uint32_t(value);
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(uint8_t(bits >> bitCount));
    }
  }
  return true;
}

bool decodeDataUri(std::string_view uri, std::vector<uint8_t>& bytes, std::string& reason) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    reason = "the data URI has no comma";
    return false;
  }
  const std::string_view payload = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) {
    if (decodeBase64(payload, bytes)) return true;
    reason = "the data URI is not valid base64";
    return false;
  }
  const std::string text = percentDecoded(payload);
  bytes.assign(text.begin(), text.end());
  return true;
}

}  // namespace

bool readFile(const std::filesystem::path& path, std::vector<uint8_t>& bytes, std::string& reason) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    reason = "is a directory";
    return false;
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    reason = "cannot be opened: " + std::generic_category().message(errno != 0 ? errno : ENOENT);
    return false;
  }
  // A pipe has no size: it is read to its end in pieces, as is a file that grows meanwhile.
  const uintmax_t size = std::filesystem::file_size(path, error);
  bytes.resize(error ? 0 : size_t(size));
  file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  bytes.resize(size_t(file.gcount()));
  std::array<char, 65536> piece;
  while (file.read(piece.data(), piece.size()) || file.gcount() > 0) {
    bytes.insert(bytes.end(), piece.begin(), piece.begin() + file.gcount());
  }
  if (file.bad()) {
    reason = "cannot be read";
    return false;
  }
  return true;
}

std::string percentDecoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hexValue(text[i + 1]) >= 0 && hexValue(text[i + 2]) >= 0) {
      result += char(hexValue(text[i + 1]) * 16 + hexValue(text[i + 2]));
      i += 2;
    } else {
      result += text[i];
    }
  }
  return result;
}

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::filesystem::path pathOfUri(const std::filesystem::path& folder, std::string_view uri) {
  return folder / percentDecoded(uri);
}

bool readUri(const std::filesystem::path& folder, std::string_view uri, std::vector<uint8_t>& bytes,
             std::string& reason) {
  if (isDataUri(uri)) return decodeDataUri(uri, bytes, reason);
  const std::string decoded = percentDecoded(uri);
  if (decoded.empty() || decoded.front() == '/' || decoded.find("://") != std::string::npos ||
      decoded.find('\0') != std::string::npos) {
    reason = "the URI " + inQuotes(uri) + " is neither a data URI nor a relative path";
    return false;
  }
  // A device or a pipe could be read for ever.
  const std::filesystem::path path = pathOfUri(folder, uri);
  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    reason = path.string() + " is not a regular file";
    return false;
  }
  if (readFile(path, bytes, reason)) return true;
  reason = path.string() + " " + reason;
  return false;
}

}  // namespace fragtrace
