// SPDX-License-Identifier: MIT
#include "view/files/file_uri.h"

#include <charconv>
#include <string>

namespace fragtrace {

std::optional<std::filesystem::path> fileOfUri(std::string_view uri) {
  constexpr std::string_view kScheme = "file://";
  constexpr std::string_view kHost = "localhost";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  uri.remove_prefix(kScheme.size());
  if (uri.starts_with(kHost)) uri.remove_prefix(kHost.size());
  if (!uri.starts_with('/')) return std::nullopt;
  std::string path;
  for (size_t i = 0; i < uri.size(); ++i) {
    char decoded = uri[i];
    if (decoded == '%') {
      unsigned char byte = 0;
      const std::string_view digits = uri.substr(i + 1, 2);
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
      if (error != std::errc() || end != digits.data() + 2 || byte == 0) return std::nullopt;
      decoded = char(byte);
      i += 2;
    }
    path += decoded;
  }
  return path;
}

}  // namespace fragtrace
