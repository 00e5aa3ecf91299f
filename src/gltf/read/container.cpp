// SPDX-License-Identifier: MIT
#include "gltf/read/container.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "image/image.h"

namespace fragtrace {

namespace {

/// "%20" to " ", byte by byte, so that UTF-8 stays UTF-8; what is no valid escape is kept as it is.
std::string percentDecoded(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* end = text.data() + std::min(i + 3, text.size());
    const bool isEscape = text[i] == '%' && i + 2 < text.size() &&
                          std::from_chars(text.data() + i + 1, end, byte, 16).ptr == end;
    result += isEscape ? char(byte) : text[i];
    i += isEscape ? 2 : 0;
  }
  return result;
}

constexpr std::string_view kWhiteSpace = " \t\n\r\f";

/// Returns true if base64 has white space or escapes, which are none of its characters and have an obvious
/// meaning.
bool isBase64Escaped(std::string_view text) {
  return text.find('%') != text.npos || text.find_first_of(kWhiteSpace) != text.npos;
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
  const bool isBase64 = uri.substr(0, comma).ends_with(";base64");
  if (isBase64 && !isBase64Escaped(payload)) return decodeBase64(payload);
  std::string text = percentDecoded(payload);
  if (!isBase64) return {text.begin(), text.end()};
  std::erase_if(text, [](char c) { return kWhiteSpace.find(c) != kWhiteSpace.npos; });
  return decodeBase64(text);
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

/// Returns true if the name is read with slashes for its backslashes. A name that leads out is not looked
/// for.
bool isBackslashed(const FileAccess& access, const std::string& name) {
  std::error_code error;
  return name.find('\\') != name.npos &&
         ((!access.allowExternal && leadsOut(name)) || !std::filesystem::exists(access.folder / name, error));
}

std::string withSlashes(std::string name) {
  std::ranges::replace(name, '\\', '/');
  return name;
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
  const bool isOutside = !access.allowExternal && !isBelow(file, access.folder);
  const bool isRegular = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  if (!isOutside && isRegular) return readOpenFile(file, memory, {}, access.progress);
  ::close(file);
  if (isOutside) throw AtStake("is a link out of the scene's folder (--allow-external-files reads it)");
  throw std::runtime_error("is not a regular file");
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

bool isDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::filesystem::path pathOfUri(const FileAccess& access, std::string_view uri) {
  const std::string decoded = percentDecoded(uri);
  return access.folder / (isBackslashed(access, decoded) ? withSlashes(decoded) : decoded);
}

std::string oddityOf(const FileAccess& access, std::string_view uri) {
  if (!isDataUri(uri))
    return isBackslashed(access, percentDecoded(uri)) ? "has backslashes, which are read as slashes" : "";
  const size_t comma = std::min(uri.find(','), uri.size());
  const bool isEscaped = uri.substr(0, comma).ends_with(";base64") && isBase64Escaped(uri.substr(comma));
  return isEscaped ? "has base64 with escapes or white space, which is read without them" : "";
}

bool isMissing(const FileAccess& access, std::string_view uri) {
  const std::string decoded = percentDecoded(uri);
  if (isDataUri(uri) || decoded.empty() || hasScheme(uri) ||
      (!access.allowExternal && leadsOut(withSlashes(decoded))))
    return false;
  std::error_code error;
  return !std::filesystem::exists(pathOfUri(access, uri), error);
}

std::string listed(const std::vector<std::string>& names) {
  constexpr size_t kLongest = 1000;
  std::string text;
  size_t left = 0;
  for (const std::string& name : names) {
    const std::string shown = name.size() <= kLongest / 4 ? name : inQuotes(name);
    if (text.size() + shown.size() > kLongest)
      ++left;
    else
      text += (text.empty() ? "" : ", ") + shown;
  }
  return left == 0 ? text : text + " and " + std::to_string(left) + " more";
}

std::string alsoMissing(const FileAccess& access, const std::vector<std::string>& uris,
                        std::string_view one) {
  std::set<std::string_view> named = {one};
  std::vector<std::string> others;
  for (const std::string& uri : uris) {
    if (isMissing(access, uri) && named.insert(uri).second) others.push_back(uri);
  }
  return others.empty() ? "" : "; also missing: " + listed(others);
}

std::vector<uint8_t> readUri(const FileAccess& access, std::string_view uri, const MemoryBudget& memory) {
  if (isDataUri(uri)) return decodeDataUri(uri, memory);
  const std::string decoded = percentDecoded(uri);
  const std::string isNone = inQuotes(uri) + " is neither a data URI nor a relative path";
  if (hasScheme(uri)) throw AtStake(isNone);
  if (decoded.empty()) throw std::runtime_error(isNone);
  if (decoded.find('\0') != decoded.npos) throw std::runtime_error(isNone + ": it holds a zero byte");
  const bool isOutside = leadsOut(isBackslashed(access, decoded) ? withSlashes(decoded) : decoded);
  if (!access.allowExternal && isOutside) {
    throw AtStake(inQuotes(uri) + " leads out of the scene's folder (--allow-external-files reads it)");
  }
  const std::filesystem::path path = pathOfUri(access, uri);
  // A data URI whose first letters are wrong is such a name, too.
  constexpr size_t kLongestName = 512;
  const std::string name = path.string().size() <= kLongestName ? path.string() : inQuotes(uri);
  // Opening a pipe to which nobody writes would wait without end.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  try {
    if (file < 0) throw std::runtime_error("cannot be opened: " + systemReason(errno) + likeNamed(path));
    return readRegularFile(file, access, memory);
  } catch (const AtStake& error) {
    throw AtStake(name + " " + error.what());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(name + " " + error.what());
  }
}

namespace {

constexpr size_t kHeaderSize = 12;
constexpr size_t kChunkHeaderSize = 8;
constexpr uint32_t kJsonChunk = 0x4e4f534a;
constexpr uint32_t kBinaryChunk = 0x004e4942;

uint32_t readLittleEndian(std::span<const uint8_t> bytes, size_t offset) {
  return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
         uint32_t(bytes[offset + 3]) << 24;
}

bool isBinary(std::span<const uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

/// A kind of file that people take for glTF, by its first bytes, and what to do.
struct ForeignFile {
  std::string_view beginning;
  const char* reason;
};
constexpr ForeignFile kForeignFiles[] = {
    {"PK\x03\x04", "is a ZIP archive, which is to be unpacked first"},
    {"\x1f\x8b", "is compressed by gzip, and to be unpacked first"},
    {"version https://git-lfs", "is a pointer of Git LFS; `git lfs pull` brings the file itself"},
    {"<", "is a page of the web or XML, not the model itself"},
    {"\xff\xfe", "is UTF-16, and glTF is UTF-8"},
    {"\xfe\xff", "is UTF-16, and glTF is UTF-8"},
    {"\x89PNG", "is a picture, not glTF"},
    {"\xff\xd8\xff", "is a picture, not glTF"},
};

/// Formats of other programs, by the file's extension.
struct ForeignFormat {
  std::string_view extensions;  ///< each between two dots
  const char* name;
  const char* opener;  ///< the program that turns them into glTF
};
constexpr ForeignFormat kForeignFormats[] = {
    {".fbx.", "FBX", "Blender"},
    {".obj.", "Wavefront OBJ", "Blender"},
    {".stl.", "STL", "Blender"},
    {".ply.", "PLY", "Blender"},
    {".usd.usda.usdc.usdz.", "USD", "Blender"},
    {".abc.", "Alembic", "Blender"},
    {".dae.", "COLLADA", "Blender"},
    {".blend.blend1.", "a file of Blender", "Blender"},
    {".wrl.x3d.", "X3D", "Blender"},
    {".3ds.", "3DS", "Blender"},
    {".3mf.", "3MF", "Blender"},
    {".max.", "a file of 3ds Max", "3ds Max"},
    {".ma.mb.", "a file of Maya", "Maya"},
    {".c4d.", "a file of Cinema 4D", "Cinema 4D"},
    {".skp.", "a file of SketchUp", "SketchUp"},
    {".step.stp.", "STEP", "FreeCAD"},
    {".iges.igs.", "IGES", "FreeCAD"},
};
/// Such formats by their first bytes, where the file is called otherwise.
constexpr std::pair<std::string_view, std::string_view> kForeignBeginnings[] = {
    {"Kaydara FBX", ".fbx"}, {"BLENDER", ".blend"}, {"PXR-USDC", ".usdc"}, {"#usda ", ".usda"},
    {"ISO-10303", ".step"},  {"solid ", ".stl"},    {"ply\n", ".ply"},     {"ply\r", ".ply"},
};

/// Names the format that has the extension, and what to do; empty if there is none.
std::string foreignFormat(std::string extension) {
  extension = lowered(std::move(extension));
  for (const ForeignFormat& format : kForeignFormats)
    if (!extension.empty() && format.extensions.find(extension + ".") != std::string_view::npos)
      return std::string("is ") + format.name + ", not glTF; " + format.opener +
             " opens it and writes a .glb";
  return "";
}

std::string whyNotGltf(std::string_view text, const std::string& file) {
  if (text.empty()) return "is empty, not glTF";
  if (file.ends_with(".nvdb")) return "is not glTF; --volume places it in a scene";
  std::string format = foreignFormat(std::filesystem::path(file).extension().string());
  for (const auto& [beginning, extension] : kForeignBeginnings)
    if (format.empty() && text.starts_with(beginning)) format = foreignFormat(std::string(extension));
  if (!format.empty()) return format;
  for (const ForeignFile& foreign : kForeignFiles)
    if (text.starts_with(foreign.beginning)) return foreign.reason;
  return "is not glTF: neither JSON nor a .glb";
}

/// Refuses files that are not glTF by their first bytes, and a .glb by its header. Returns how many bytes of
/// the file are worth reading: a .glb's length and one more byte, which shows that there are more.
uint64_t checkBeginning(std::span<const uint8_t> bytes, uint64_t size, const Diagnostics& diagnostics) {
  if (!isBinary(bytes)) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t mark = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
    const size_t start = text.find_first_not_of(" \t\r\n", mark);
    const bool mayFollow = start == std::string_view::npos && size != bytes.size();
    if (!mayFollow && (start == std::string_view::npos || text[start] != '{'))
      diagnostics.refuse("", whyNotGltf(text, diagnostics.file()));
    return std::numeric_limits<uint64_t>::max();
  }
  if (bytes.size() < kHeaderSize) diagnostics.refuse("", "truncated .glb: it ends inside its header");
  const uint32_t version = readLittleEndian(bytes, 4);
  const uint64_t length = readLittleEndian(bytes, 8);
  if (version != 2) diagnostics.refuse("", ".glb version " + std::to_string(version) + " is not supported");
  if (size > 0 && length > size) {
    diagnostics.refuse("", "truncated .glb: its header says " + std::to_string(length) +
                               " bytes, the file has " + std::to_string(size));
  }
  return std::max<uint64_t>(length, kHeaderSize) + 1;
}

[[noreturn]] void refuseChunk(size_t chunk, uint64_t size, const Diagnostics& diagnostics) {
  diagnostics.refuse("", "broken .glb: chunk " + std::to_string(chunk) + " of " + std::to_string(size) +
                             " bytes reaches past the end of the file");
}

/// Refuses a .glb whose first chunks are longer than the file: their headers alone are read.
void checkChunks(const std::filesystem::path& path, uint64_t length, const Diagnostics& diagnostics) {
  constexpr size_t kMostChunks = 16;
  std::ifstream file(path, std::ios::binary);
  uint64_t offset = kHeaderSize;
  for (size_t chunk = 0; chunk < kMostChunks && offset + kChunkHeaderSize <= length; ++chunk) {
    std::array<char, kChunkHeaderSize> header{};
    if (!file.seekg(std::streamoff(offset)) || !file.read(header.data(), header.size())) return;
    offset += kChunkHeaderSize;
    const uint64_t size =
        readLittleEndian({reinterpret_cast<const uint8_t*>(header.data()), header.size()}, 0);
    if (size > length - offset) refuseChunk(chunk, size, diagnostics);
    offset += size;
  }
}

/// Splits a .glb whose beginning is checked: a header, a JSON chunk, perhaps a BIN chunk, perhaps unknown
/// chunks.
Container splitGlb(const std::vector<uint8_t>& bytes, Diagnostics& diagnostics) {
  const size_t length = readLittleEndian(bytes, 8);
  if (length > bytes.size()) {  // this happens with a pipe, whose size is not known before it is read
    diagnostics.refuse("", "truncated .glb: its header says " + std::to_string(length) +
                               " bytes, the file has " + std::to_string(bytes.size()));
  }
  if (length < bytes.size()) diagnostics.warn("", "holds more bytes than its header says; they are ignored");

  Container container;
  size_t offset = kHeaderSize;
  for (size_t chunk = 0; offset < length; ++chunk) {
    if (length - offset < kChunkHeaderSize) {
      diagnostics.refuse("", "broken .glb: chunk " + std::to_string(chunk) + " ends inside its header");
    }
    const size_t size = readLittleEndian(bytes, offset);
    const uint32_t type = readLittleEndian(bytes, offset + 4);
    offset += kChunkHeaderSize;
    if (size > length - offset) refuseChunk(chunk, size, diagnostics);
    const uint8_t* data = bytes.data() + offset;
    if (chunk == 0) {
      if (type != kJsonChunk) diagnostics.refuse("", "broken .glb: its first chunk is not JSON");
      container.json.assign(reinterpret_cast<const char*>(data), size);
    } else if (chunk == 1 && type == kBinaryChunk) {
      container.binary.assign(data, data + size);
      container.hasBinary = true;
    } else if (type == kBinaryChunk || type == kJsonChunk) {
      diagnostics.warn("", "chunk " + std::to_string(chunk) + " of the .glb is one too many, and ignored");
    }
    offset += size;
  }
  if (container.json.empty()) diagnostics.refuse("", "broken .glb: it has no JSON chunk");
  return container;
}

}  // namespace

Container readContainer(const std::filesystem::path& path, uint64_t memoryLimit, Diagnostics& diagnostics,
                        const ReadProgress& progress) {
  const std::vector<uint8_t> bytes = diagnostics.attempt("", [&] {
    const auto check = [&](std::span<const uint8_t> first, uint64_t size) {
      const uint64_t most = checkBeginning(first, size, diagnostics);
      if (size > 0 && isBinary(first)) checkChunks(path, readLittleEndian(first, 8), diagnostics);
      return most;
    };
    return readBytes(path, memoryLimit, check, progress);
  });
  if (isBinary(bytes)) return splitGlb(bytes, diagnostics);
  checkBeginning(bytes, bytes.size(), diagnostics);  // now that all is there
  Container container;
  container.json.assign(bytes.begin(), bytes.end());
  return container;
}

}  // namespace fragtrace
