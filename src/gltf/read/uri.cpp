// SPDX-License-Identifier: MIT
#include "gltf/read/uri.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>

#include "base/errors.h"
#include "gltf/read/diagnostics.h"
#include "image/limits.h"

namespace fragtrace {
namespace {

int hexValue(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// RFC 4648 base64 with or without padding. Throws at the first character that does not belong.
std::vector<uint8_t> decodeBase64(std::string_view text) {
  static constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static const std::array<int8_t, 256> kValues = [] {
    std::array<int8_t, 256> values;
    values.fill(-1);
    for (size_t i = 0; i < kAlphabet.size(); ++i) values[uint8_t(kAlphabet[i])] = int8_t(i);
    return values;
  }();
  const auto refuse = [] { throw std::runtime_error("the data URI is not valid base64"); };
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) refuse();
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  int bitCount = 0;
  for (const char c : text) {
    const int8_t value = kValues[uint8_t(c)];
    if (value < 0) refuse();
    bits = bits << 6 | uint32_t(value);
    bitCount += 6;
    if (bitCount >= 8) {
      bitCount -= 8;
      bytes.push_back(uint8_t(bits >> bitCount));
    }
  }
  return bytes;
}

std::vector<uint8_t> decodeDataUri(std::string_view uri, MemoryBudget memory) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw std::runtime_error("the data URI has no comma");
  if (uri.substr(0, comma).find(";;") != std::string_view::npos)
    throw std::runtime_error("the data URI has an empty parameter");
  const std::string_view payload = uri.substr(comma + 1);
  memory.take(payload.size());
  if (uri.substr(0, comma).ends_with(";base64")) return decodeBase64(payload);
  const std::string text = percentDecoded(payload);
  return {text.begin(), text.end()};
}

/// RFC 3986, 3.1: a letter, then letters, digits, + - and . up to a colon.
bool hasScheme(std::string_view uri) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (uri.empty() || (!isLetter(uri[0]) && uri[0] != ':')) return false;
  for (const char c : uri) {
    if (c == ':') return true;
    if (!isLetter(c) && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return false;
  }
  return false;
}

/// True if the path, without its "." and "..", starts at the root or above the folder.
bool leadsOut(const std::filesystem::path& path) {
  const std::filesystem::path normal = path.lexically_normal();
  return normal.is_absolute() || (!normal.empty() && *normal.begin() == "..");
}

/// True when the open file lies in the folder or below, symbolic links followed.
bool isBelow(int file, const std::filesystem::path& folder) {
  std::error_code error;
  const auto there = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(file), error);
  if (error) return true;  // without /proc it cannot be checked
  const auto root = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) return false;
  const auto [rootEnd, thereAt] = std::mismatch(root.begin(), root.end(), there.begin(), there.end());
  return rootEnd == root.end();
}

/// Owns the descriptor until it is read.
std::vector<uint8_t> readRegularFile(int file, const FileAccess& access, const MemoryBudget& memory) {
  struct stat status {};
  std::string reason;
  if (::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
    reason = "is not a regular file";
  } else if (!access.allowExternal && !isBelow(file, access.folder)) {
    reason = "is a link out of the scene's folder (--allow-external-files reads it)";
  }
  if (reason.empty()) return readOpenFile(file, memory, {}, access.progress);
  ::close(file);
  throw std::runtime_error(reason);
}

/// "; wood.png lies there" where a file of the folder has the same name except for the case of its letters;
/// systems that do not tell the two apart write such files.
std::string likeNamed(const std::filesystem::path& path) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path(), error)) {
    const std::string name = entry.path().filename().string();
    if (isSameButForCase(name, path.filename().string())) return "; " + name + " lies there";
  }
  return "";
}

}  // namespace

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

std::string_view mediaTypeOf(std::string_view dataUri) {
  dataUri.remove_prefix(std::string_view("data:").size());
  return dataUri.substr(0, dataUri.find_first_of(";,"));
}

std::filesystem::path pathOfUri(const FileAccess& access, std::string_view uri) {
  return access.folder / percentDecoded(uri);
}

std::vector<uint8_t> readUri(const FileAccess& access, std::string_view uri, const MemoryBudget& memory) {
  if (isDataUri(uri)) return decodeDataUri(uri, memory);
  const std::string decoded = percentDecoded(uri);
  if (decoded.empty() || hasScheme(uri) || decoded.find('\0') != std::string::npos)
    throw std::runtime_error("the URI " + inQuotes(uri) + " is neither a data URI nor a relative path");
  if (decoded.find('\\') != std::string::npos && !std::filesystem::exists(pathOfUri(access, uri)))
    throw std::runtime_error("the URI " + inQuotes(uri) + " has a backslash, where glTF has /");
  if (!access.allowExternal && leadsOut(decoded)) {
    throw std::runtime_error("the URI " + inQuotes(uri) +
                             " leads out of the scene's folder (--allow-external-files reads it)");
  }
  const std::filesystem::path path = pathOfUri(access, uri);
  // Opening a pipe to which nobody writes would wait without end.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  try {
    if (file < 0) throw std::runtime_error("cannot be opened: " + systemReason(errno) + likeNamed(path));
    return readRegularFile(file, access, memory);
  } catch (const std::runtime_error& error) {
    // A data URI whose first letters are wrong is such a name, too.
    constexpr size_t kLongestName = 512;
    const std::string name = path.string();
    throw std::runtime_error((name.size() <= kLongestName ? name : inQuotes(uri)) + " " + error.what());
  }
}

}  // namespace fragtrace
