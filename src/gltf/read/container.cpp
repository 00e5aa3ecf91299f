// SPDX-License-Identifier: MIT
#include "gltf/read/container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "base/text.h"

namespace fragtrace {
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
  container.isGlb = true;
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
