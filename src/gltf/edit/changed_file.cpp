// SPDX-License-Identifier: MIT
#include "gltf/edit/changed_file.h"

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "gltf/build/named_numbers.h"
#include "gltf/build/numbers.h"
#include "gltf/edit/json_text.h"
#include "gltf/read/json_parts.h"
#include "gltf/read/uri.h"
#include "image/files/whole_file.h"
#include "scene/parts.h"

namespace fragtrace {

namespace {

using nlohmann::json;

// A .glb: magic, version, length; then chunks, each with length and kind before its bytes.
constexpr const char* kGlbMagic = "glTF";
constexpr size_t kGlbLengthAt = 8;
constexpr size_t kGlbHeader = 12;
constexpr size_t kGlbChunkHeader = 8;
constexpr size_t kGlbAlignment = 4;

uint32_t wordAt(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  for (size_t i = 0; i < 4; ++i) word |= uint32_t(uint8_t(bytes.at(at + i))) << (8 * i);
  return word;
}

void writeWord(std::string& bytes, size_t at, size_t word) {
  for (size_t i = 0; i < 4; ++i) bytes.at(at + i) = char(uint8_t(word >> (8 * i)));
}

std::string wholeText(const std::filesystem::path& file) {
  const std::vector<uint8_t> read = readWholeFile(file);
  return {read.begin(), read.end()};
}

/// The JSON of a .gltf's or .glb's bytes.
std::string jsonTextOf(const std::string& bytes) {
  if (!bytes.starts_with(kGlbMagic)) return bytes;
  return bytes.substr(kGlbHeader + kGlbChunkHeader, wordAt(bytes, kGlbHeader));
}

/// The .glb with another text as its JSON; what follows that chunk stays.
std::string withJson(const std::string& glb, std::string text) {
  const size_t end = kGlbHeader + kGlbChunkHeader + wordAt(glb, kGlbHeader);
  text.erase(text.find_last_not_of(' ') + 1);
  text.append((kGlbAlignment - text.size() % kGlbAlignment) % kGlbAlignment, ' ');
  std::string result = glb.substr(0, kGlbHeader + kGlbChunkHeader) + text + glb.substr(end);
  writeWord(result, kGlbHeader, text.size());
  writeWord(result, kGlbLengthAt, result.size());
  return result;
}

/// The first file that the document refers to; empty: none.
std::string fileReferredTo(const json& value) {
  if (!value.is_structured()) return {};
  for (const auto& [name, member] : value.items()) {
    const bool isUri = value.is_object() && name == "uri" && member.is_string();
    if (isUri && !isDataUri(member.get_ref<const std::string&>())) return member.get<std::string>();
    if (std::string found = fileReferredTo(member); !found.empty()) return found;
  }
  return {};
}

std::filesystem::path wholeFolderOf(const std::filesystem::path& file) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(file).parent_path());
}

json documentOf(const std::filesystem::path& from) {
  const std::string bytes = wholeText(from);
  try {
    return json::parse(jsonTextOf(bytes));
  } catch (const std::exception& error) {
    throw InputError(from.string() + ": " + error.what());
  }
}

}  // namespace

void checkChange(const std::filesystem::path& from, std::span<const SetNumber> set) {
  checkNumbers(documentOf(from), set);
}

bool hasPart(const std::filesystem::path& file, std::span<const char* const> arrays,
             const std::string& wanted) {
  const json document = documentOf(file);
  return std::ranges::any_of(arrays, [&](const char* array) {
    const json::json_pointer pointer(array);
    if (!document.contains(pointer) || !document[pointer].is_array()) return false;
    std::vector<std::string> names;
    for (const json& part : document[pointer]) {
      const json& name = memberOf(part, "name");
      names.push_back(name.is_string() ? name.get<std::string>() : "");
    }
    const bool isPlace = wanted.starts_with(array) && document.contains(json::json_pointer(wanted));
    return isPlace || findPart(wanted, names).has_value();
  });
}

void writeChanged(const std::filesystem::path& from, const std::filesystem::path& to,
                  std::span<const SetNumber> set) {
  std::string bytes = wholeText(from);
  const bool isGlb = bytes.starts_with(kGlbMagic);
  try {
    if (isGlb) bytes.resize(std::min<size_t>(bytes.size(), wordAt(bytes, kGlbLengthAt)));
    const std::string text = jsonTextOf(bytes);
    const json document = json::parse(text);
    const std::string other = fileReferredTo(document);
    if (!other.empty() && wholeFolderOf(from) != wholeFolderOf(to))
      throw InputError(from.filename().string() + " refers to other files, such as " + other +
                       ": it can only be written into " + wholeFolderOf(from).string());
    checkNumbers(document, set);
    const std::vector<SetNumber> placed = placedValues(document, set);
    const std::string changed = withNumbers(text, placed);
    bytes = isGlb ? withJson(bytes, changed) : changed;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(from.string() + ": " + error.what());
  }
  replaceFile(to, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace fragtrace
