// SPDX-License-Identifier: MIT
#include "gltf/check/validity.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>

#include "base/text.h"
#include "gltf/check/extensions.h"
#include "gltf/check/schema.h"
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

class MemberChecker {
 public:
  explicit MemberChecker(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  /// `owner` is the name of the member that holds the value.
  void visit(json& value, std::string_view owner) {
    if (value.is_array()) {
      for (size_t i = 0; i < value.size(); ++i) descend(value[i], std::to_string(i), "*", owner);
    } else if (value.is_object()) {
      for (auto member = value.begin(); member != value.end();) {
        const std::string& name = member.key();
        if (name == "extensions") warnOfStrangers(*member, owner);
        if (name != "extras") descend(*member, name, name, name);
        member = member->is_null() && takesOut(name) ? value.erase(member) : std::next(member);
      }
    }
  }

 private:
  void descend(json& value, const std::string& part, std::string_view pattern, std::string_view owner) {
    if (!value.is_structured()) return;
    const size_t place = place_.size();
    const size_t length = pattern_.size();
    place_.append("/").append(escapedForPointer(part));
    pattern_.append("/").append(pattern);
    visit(value, owner);
    place_.resize(place);
    pattern_.resize(length);
  }

  /// Returns true, with a warning, if a null can be taken for an absent member.
  bool takesOut(const std::string& name) {
    if (isRequiredAt(pattern_ + "/" + name)) return false;
    diagnostics_.warn(place_ + pointerTo(name), "is null, and taken as absent");
    return true;
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

/// The version in a member of the asset, where it is a text or a number; it becomes a text such as 2.0.
std::optional<Version> readVersion(json& asset, const char* member, Diagnostics& diagnostics) {
  const auto given = asset.find(member);
  if (given == asset.end() || !(given->is_string() || given->is_number())) return std::nullopt;
  const std::string place = pointerTo("asset", member);
  const std::string text = given->is_string() ? given->get<std::string>() : given->dump();
  const size_t point = std::min(text.find('.'), text.size());
  const auto major = numberOfAll<unsigned>(text.substr(0, point));
  const auto minor = point == text.size() ? std::optional(0u) : numberOfAll<unsigned>(text.substr(point + 1));
  if (!major || !minor) diagnostics.refuse(place, inQuotes(text) + " is not a version such as 2.0");
  const std::string read = std::to_string(*major) + "." + std::to_string(*minor);
  if (*given != read) diagnostics.warn(place, given->dump() + " is read as " + inQuotes(read));
  *given = read;
  return Version{*major, *minor};
}

}  // namespace

void checkMembers(json& root, Diagnostics& diagnostics) { MemberChecker(diagnostics).visit(root, ""); }

void checkVersions(json& root, Diagnostics& diagnostics) {
  if (!memberOf(root, "asset").is_object()) return;
  json& asset = root["asset"];
  const std::optional<Version> version = readVersion(asset, "version", diagnostics);
  if (version && version->major != 2)
    diagnostics.refuse("/asset/version",
                       "glTF " + asset["version"].dump() + " is not supported, only 2.x is");
  const std::optional<Version> least = readVersion(asset, "minVersion", diagnostics);
  if (!version || !least) return;
  if (*least > *version)
    diagnostics.refuse("/asset/minVersion", "is above the version, " + asset["version"].dump());
  if (*least > Version{2, 0})
    diagnostics.refuse("/asset/minVersion", "glTF 2.0 is supported, not " + asset["minVersion"].dump());
}

}  // namespace fragtrace
