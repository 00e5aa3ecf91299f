// SPDX-License-Identifier: MIT
#include "gltf/edit/changed_file.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "gltf/assemble/numbers.h"
#include "gltf/read/container.h"
#include "gltf/read/json.h"
#include "image/files/whole_file.h"

namespace fragtrace {

namespace {

constexpr const char* kSpace = " \t\r\n";

/// A part of the text: its first byte, and the byte after its last.
struct Range {
  size_t begin = 0;
  size_t end = 0;
};

size_t skipSpace(const std::string& text, size_t at) {
  return std::min(text.find_first_not_of(kSpace, at), text.size());
}

/// Returns the end of the string whose opening quote is at `at`.
size_t endOfString(const std::string& text, size_t at) {
  for (++at; text.at(at) != '"'; ++at) at += text[at] == '\\';
  return at + 1;
}

size_t endOfValue(const std::string& text, size_t at) {
  if (text.at(at) == '"') return endOfString(text, at);
  if (text[at] != '{' && text[at] != '[') return std::min(text.find_first_of(",]} \t\r\n", at), text.size());
  size_t depth = 0;
  do {
    if (text.at(at) == '"') {
      at = endOfString(text, at);
      continue;
    }
    if (text[at] == '{' || text[at] == '[') ++depth;
    if (text[at] == '}' || text[at] == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

/// A member of an object, or an element of an array, which has no key.
struct Entry {
  Range key;  ///< the key with its quotes
  Range value;
};

/// Returns the entries of the object or array that begins at `at`.
std::vector<Entry> entriesAt(const std::string& text, size_t at) {
  const bool isObject = text.at(at) == '{';
  std::vector<Entry> entries;
  at = skipSpace(text, at + 1);
  while (text.at(at) != '}' && text[at] != ']') {
    Entry entry;
    if (isObject) {
      entry.key = {at, endOfString(text, at)};
      at = skipSpace(text, skipSpace(text, entry.key.end) + 1);  // behind the colon
    }
    entry.value = {at, endOfValue(text, at)};
    entries.push_back(entry);
    at = skipSpace(text, entry.value.end);
    if (text.at(at) == ',') at = skipSpace(text, at + 1);
  }
  return entries;
}

std::string nameOf(const std::string& text, const Range& key) {
  return nlohmann::json::parse(text.substr(key.begin, key.end - key.begin)).get<std::string>();
}

/// The entry of that name or index. Of members of the same name the last counts, as for the reader.
std::optional<Entry> entryOf(const std::string& text, const std::vector<Entry>& entries,
                             const std::string& name) {
  std::optional<Entry> found;
  for (size_t i = 0; i < entries.size(); ++i) {
    const bool isMember = entries[i].key.end > 0;
    if (isMember ? nameOf(text, entries[i].key) == name : std::to_string(i) == name) found = entries[i];
  }
  return found;
}

/// The shortest digits that are read as the same number.
std::string numberText(double number) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, number).ptr};
}

std::string valueText(const std::vector<double>& values, bool isArray) {
  if (!isArray) return numberText(values.at(0));
  std::string text = "[";
  for (const double value : values) text += (text.size() > 1 ? ", " : "") + numberText(value);
  return text + "]";
}

void replaceNumber(std::string& text, const Range& range, double number) {
  double before = 0.0;
  const char* end = text.data() + range.end;
  const auto read = std::from_chars(text.data() + range.begin, end, before);
  if (read.ptr == end && float(before) == float(number)) return;
  text.replace(range.begin, range.end - range.begin, numberText(number));
}

void replaceValue(std::string& text, const Range& range, const std::vector<double>& values) {
  if (text[range.begin] != '[') return replaceNumber(text, range, values.at(0));
  const std::vector<Entry> elements = entriesAt(text, range.begin);
  if (elements.size() != values.size()) {
    text.replace(range.begin, range.end - range.begin, valueText(values, true));
    return;
  }
  // The last value is replaced first, so that the places before it stay.
  for (size_t i = values.size(); i-- > 0;) replaceNumber(text, elements[i].value, values[i]);
}

/// Inserts a member behind the last one of the object that begins there, and as far from it as that one is
/// from what stands before it.
void insertMember(std::string& text, size_t object, const std::vector<Entry>& members,
                  const std::string& name, const std::string& value) {
  const std::string key = nlohmann::json(name).dump();
  if (members.empty()) {
    text.insert(object + 1, key + ": " + value);
    return;
  }
  const Entry& last = members.back();
  const size_t before = text.find_last_not_of(kSpace, last.key.begin - 1) + 1;
  const std::string space = text.substr(before, last.key.begin - before);
  const std::string colon = text.substr(last.key.end, last.value.begin - last.key.end);
  text.insert(last.value.end, "," + space + key + colon + value);
}

/// Takes the member out, with the comma that parts it from another one.
void removeMember(std::string& text, const std::vector<Entry>& members, const std::string& name) {
  for (size_t i = members.size(); i-- > 0;) {
    if (nameOf(text, members[i].key) != name) continue;
    const size_t begin = i > 0 ? members[i - 1].value.end : members[i].key.begin;
    const bool isFirst = i == 0 && members.size() > 1;
    const size_t end = isFirst ? members[1].key.begin : members[i].value.end;
    return void(text.erase(begin, end - begin));
  }
}

/// The place of the document's object.
size_t rootOf(const std::string& text) {
  constexpr size_t kMark = 3;  // bytes of UTF-8's mark
  return skipSpace(text, text.starts_with("\xef\xbb\xbf") ? kMark : 0);
}

/// The bytes of a value that are its text in JSON.
std::string jsonOf(const SetNumber& set) {
  if (set.word.empty()) return valueText(set.values, set.values.size() > 1);
  return set.word == "true" || set.word == "false" ? set.word : nlohmann::json(set.word).dump();
}

void setValue(std::string& text, const SetNumber& set) {
  std::vector<std::string> parts;
  for (nlohmann::json::json_pointer at(set.pointer); !at.empty(); at.pop_back())
    parts.insert(parts.begin(), at.back());
  size_t at = rootOf(text);
  for (size_t i = 0; i < parts.size(); ++i) {
    const char first = text.at(at);
    const std::vector<Entry> entries =
        first == '{' || first == '[' ? entriesAt(text, at) : std::vector<Entry>();
    const std::optional<Entry> entry = entryOf(text, entries, parts[i]);
    const bool isLast = i + 1 == parts.size();
    if (set.word == kNoValue && (isLast || !entry)) return removeMember(text, entries, parts[i]);
    if (!entry && first != '{') throw std::runtime_error("the file has no " + set.pointer);
    if (!entry) {
      std::string value = jsonOf(set);
      for (size_t inner = parts.size() - 1; inner > i; --inner)
        value.insert(0, "{" + nlohmann::json(parts[inner]).dump() + ": ").append("}");
      return insertMember(text, at, entries, parts[i], value);
    }
    if (isLast && !set.word.empty()) {
      text.replace(entry->value.begin, entry->value.end - entry->value.begin, jsonOf(set));
      return;
    }
    if (isLast) return replaceValue(text, entry->value, set.values);
    at = entry->value.begin;
  }
}

/// Adds the name to the list of extensions that the file uses, unless it is there.
void useExtension(std::string& text, const std::string& name) {
  const size_t root = rootOf(text);
  const std::vector<Entry> members = entriesAt(text, root);
  const std::string quoted = nlohmann::json(name).dump();
  const std::optional<Entry> used = entryOf(text, members, "extensionsUsed");
  if (!used) return insertMember(text, root, members, "extensionsUsed", "[" + quoted + "]");
  const std::vector<Entry> names = entriesAt(text, used->value.begin);
  for (const Entry& one : names)
    if (text.substr(one.value.begin, one.value.end - one.value.begin) == quoted) return;
  const size_t end = names.empty() ? used->value.begin + 1 : names.back().value.end;
  text.insert(end, (names.empty() ? "" : ", ") + quoted);
}

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

std::string withNumbers(std::string text, std::span<const SetNumber> set) {
  for (const SetNumber& one : set) {
    setValue(text, one);
    const std::string extension = extensionIn(one.pointer);
    if (!extension.empty() && one.word != kNoValue) useExtension(text, extension);
  }
  return text;
}

void checkChange(const std::filesystem::path& from, std::span<const SetNumber> set) {
  checkNumbers(documentOf(from), set);
}

bool hasPart(const std::filesystem::path& file, std::span<const char* const> arrays,
             const std::string& wanted) {
  const json document = documentOf(file);
  return std::ranges::any_of(arrays, [&](const char* array) {
    const json::json_pointer pointer(array);
    if (!document.contains(pointer) || !document[pointer].is_array()) return false;
    const bool isPlace = wanted.starts_with(array) && document.contains(json::json_pointer(wanted));
    return isPlace || findPart(wanted, namesOf(document[pointer])).has_value();
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
