// SPDX-License-Identifier: MIT
#include "gltf/check/validity.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "gltf/check/extensions.h"
#include "gltf/read/json_parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// An extension that is not in the table may be anywhere, unless its name says that it belongs to materials.
bool isAtHome(std::string_view name, std::string_view place, std::string_view owner) {
  const Extension* extension = extensionNamed(name);
  if (extension == nullptr) return !name.starts_with("KHR_materials_") || place == "/materials/*";
  if (extension->places[0] == kTextureInfo) return owner.ends_with("Texture");
  return std::ranges::find(extension->places, place) != extension->places.end();
}

/// Warns of extensions at places where they are not read. Extras are the author's own.
class PlaceChecker {
 public:
  explicit PlaceChecker(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void visit(const json& value, std::string_view owner) {
    if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) descend(value[i], std::to_string(i), "*", owner);
    } else if (value.is_object()) {
      for (const auto& member : value.items()) {
        if (member.key() == "extensions") warnOfStrangers(member.value(), owner);
        if (member.key() != "extras") descend(member.value(), member.key(), member.key(), member.key());
      }
    }
  }

 private:
  void descend(const json& value, const std::string& part, std::string_view pattern, std::string_view owner) {
    if (!value.is_structured()) return;
    const size_t place = place_.size();
    const size_t length = pattern_.size();
    place_.append("/").append(escapedForPointer(part));
    pattern_.append("/").append(pattern);
    visit(value, owner);
    place_.resize(place);
    pattern_.resize(length);
  }

  void warnOfStrangers(const json& extensions, std::string_view owner) {
    if (!extensions.is_object()) return;
    for (const auto& extension : extensions.items()) {
      if (!isAtHome(extension.key(), pattern_, owner))
        diagnostics_.warn(place_ + pointerTo("extensions", extension.key()),
                          "is not expected here, and ignored");
    }
  }

  Diagnostics& diagnostics_;
  std::string place_;
  std::string pattern_;
};

struct Version {
  unsigned major = 0, minor = 0;
  auto operator<=>(const Version&) const = default;  // NOLINT(modernize-use-nullptr): it is none
};

Version versionOf(const std::string& text, const std::string& place, const Diagnostics& diagnostics) {
  Version version;
  const char* end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.major);
  if (major.ec == std::errc{} && major.ptr != end && *major.ptr == '.') {
    const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
    if (minor.ec == std::errc{} && minor.ptr == end) return version;
  }
  diagnostics.refuse(place, inQuotes(text) + " is not a version such as 2.0");
}

}  // namespace

void checkVersion(const json& root, const Diagnostics& diagnostics) {
  const json& version = memberOf(memberOf(root, "asset"), "version");
  if (!version.is_string()) return;
  const auto& text = version.get_ref<const std::string&>();
  if (versionOf(text, "/asset/version", diagnostics).major != 2)
    diagnostics.refuse("/asset/version", "glTF " + inQuotes(text) + " is not supported, only 2.x is");
}

void checkLeastVersion(const json& root, const Diagnostics& diagnostics) {
  const json& asset = root["asset"];
  const auto& text = asset["version"].get_ref<const std::string&>();
  const Version version = versionOf(text, "/asset/version", diagnostics);
  if (!asset.contains("minVersion")) return;
  const auto& least = asset["minVersion"].get_ref<const std::string&>();
  const Version minVersion = versionOf(least, "/asset/minVersion", diagnostics);
  if (minVersion > version)
    diagnostics.refuse("/asset/minVersion", "is above the version, " + inQuotes(text));
  if (minVersion > Version{2, 0})
    diagnostics.refuse("/asset/minVersion", "glTF 2.0 is supported, not " + inQuotes(least));
}

void checkPlacesOfExtensions(const json& root, Diagnostics& diagnostics) {
  PlaceChecker(diagnostics).visit(root, "");
}

}  // namespace fragtrace
