// SPDX-License-Identifier: MIT
#include "gltf/check/validity.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "gltf/check/extensions.h"
#include "gltf/read/json_parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

bool names(const json& list, const std::string& name) {
  return list.is_array() && std::find(list.begin(), list.end(), name) != list.end();
}

/// An extension that is not in the table may be anywhere, unless its name says that it belongs to materials.
bool isAtHome(std::string_view name, std::string_view place, std::string_view owner) {
  const Extension* extension = extensionNamed(name);
  if (extension == nullptr) return !name.starts_with("KHR_materials_") || place == "/materials/*";
  if (extension->places[0] == kTextureInfo) return owner.ends_with("Texture");
  return std::ranges::find(extension->places, place) != extension->places.end();
}

/// Visits everything except extras, which are the author's own.
class Walk {
 public:
  Walk(const json& root, Diagnostics& diagnostics)
      : used_(memberOf(root, "extensionsUsed")), diagnostics_(diagnostics) {}

  void visit(const json& value, std::string_view name) {
    if (value.is_array()) {
      if (value.empty()) diagnostics_.warn(place_, "is empty, which glTF forbids, and taken as absent");
      for (size_t i = 0; i < value.size(); ++i) descend(value[i], std::to_string(i), true, name);
    } else if (value.is_object()) {
      if (value.empty()) visitEmpty(name);
      for (const auto& member : value.items()) {
        if (member.key() == "extensions") {
          visitExtensions(member.value(), name);
        } else if (member.key() != "extras") {
          descend(member.value(), member.key(), false, member.key());
        }
      }
    }
  }

 private:
  /// Other objects may be empty. Compressed primitives without attributes are warned about when they are
  /// read.
  void visitEmpty(std::string_view name) {
    if (pattern_ == "/meshes/*/primitives/*/attributes") {
      diagnostics_.warn(place_, "is empty, which glTF forbids; the primitive is left out");
    } else if ((name == "attributes" || name == "targets") &&
               !pattern_.ends_with("/KHR_draco_mesh_compression/attributes")) {
      diagnostics_.warn(place_, "is empty, which glTF forbids, and taken as absent");
    }
  }

  void visitExtensions(const json& extensions, std::string_view owner) {
    if (!extensions.is_object()) return;
    for (const auto& extension : extensions.items()) {
      const std::string place = place_ + "/extensions/" + escapedForPointer(extension.key());
      if (!extension.value().is_object()) diagnostics_.warn(place, "is not an object, and ignored");
      if (!names(used_, extension.key()))
        diagnostics_.warn(place, isApplied(extension.key())
                                     ? "is not named in extensionsUsed; it is applied all the same"
                                     : "is not named in extensionsUsed, and ignored");
      if (!isAtHome(extension.key(), pattern_, owner))
        diagnostics_.warn(place, "is not expected here, and ignored");
      const Rewind rewind(*this);
      place_ = place;
      pattern_ += "/extensions/" + extension.key();
      visit(extension.value(), extension.key());
    }
  }

  void descend(const json& value, const std::string& part, bool isIndex, std::string_view name) {
    if (!value.is_structured()) return;
    const Rewind rewind(*this);
    place_.append("/").append(escapedForPointer(part));
    pattern_.append("/").append(isIndex ? "*" : part);
    visit(value, name);
  }

  struct Rewind {
    explicit Rewind(Walk& w) : walk(w), place(w.place_.size()), pattern(w.pattern_.size()) {}
    ~Rewind() {
      walk.place_.resize(place);
      walk.pattern_.resize(pattern);
    }
    Walk& walk;
    size_t place, pattern;
  };

  const json& used_;
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

/// Refuses a version that is less than the file asks for.
void checkLeastVersion(const json& asset, const Diagnostics& diagnostics) {
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

void checkExtensionLists(const json& root, Diagnostics& diagnostics) {
  const json& used = memberOf(root, "extensionsUsed");
  const json& required = memberOf(root, "extensionsRequired");
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const json& entries = memberOf(root, list);
    for (size_t i = 0; i < entries.size(); ++i) {
      if (std::find(entries.begin(), entries.begin() + std::ptrdiff_t(i), entries[i]) !=
          entries.begin() + std::ptrdiff_t(i))
        diagnostics.warn(pointerTo(list, i), "is named twice, which changes nothing");
    }
  }
  for (size_t i = 0; i < required.size(); ++i) {
    if (!names(used, required[i]))
      diagnostics.warn(pointerTo("extensionsRequired", i),
                       "is not named in extensionsUsed; it is required all the same");
  }
  if (!names(used, "KHR_mesh_quantization") || names(required, "KHR_mesh_quantization")) return;
  const auto entry = std::find(used.begin(), used.end(), "KHR_mesh_quantization");
  diagnostics.warn(pointerTo("extensionsUsed", entry - used.begin()),
                   "KHR_mesh_quantization must be required, too; it is applied all the same");
}

void checkCamera(const json& camera, const std::string& place, Diagnostics& diagnostics) {
  const std::string& type = camera["type"].get_ref<const std::string&>();
  if ((type == "perspective" || type == "orthographic") && !camera.contains(type))
    diagnostics.refuse(place, inQuotes(type) + " is missing");
  if (camera.contains("perspective") && camera.contains("orthographic"))
    diagnostics.warn(place, "is both perspective and orthographic, and taken as its type says");
  for (const char* kind : {"perspective", "orthographic"}) {
    const json& lens = memberOf(camera, kind);
    if (!memberOf(lens, "znear").is_number() || !memberOf(lens, "zfar").is_number()) continue;
    if (lens["zfar"].get<double>() <= lens["znear"].get<double>())
      diagnostics.warn(place + "/" + kind, "zfar is not above znear; rays see all distances");
  }
  for (const char* extent : {"xmag", "ymag"}) {
    const json& value = memberOf(memberOf(camera, "orthographic"), extent);
    if (value.is_number() && value.get<double>() == 0.0)
      diagnostics.warn(place + "/orthographic/" + extent,
                       "is 0, which is refused where a node has the camera");
  }
}

void checkSpotLight(const json& light, const std::string& place, Diagnostics& diagnostics) {
  if (light["type"] != "spot") return;
  const json& spot = memberOf(light, "spot");
  if (spot.is_null()) return diagnostics.warn(place, "\"spot\" is missing, the default cone is taken");
  constexpr double kDefaultOuter = 0.7853981633974483;
  const double inner = spot.value("innerConeAngle", 0.0);
  const double outer = spot.value("outerConeAngle", kDefaultOuter);
  if (!(inner >= 0.0 && inner < outer))
    diagnostics.warn(place + "/spot/outerConeAngle",
                     "is not above the inner cone's angle, which is refused where a node has the light");
}

bool isDecomposable(const json& matrix) {
  glm::dmat3 axes(1.0);
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) axes[c][r] = matrix[4 * size_t(c) + size_t(r)].get<double>();
  constexpr double kLargestCosine = 1e-3;  // rounding of single precision with scales of some hundreds
  for (int c = 0; c < 3; ++c) {
    const glm::dvec3& a = axes[c];
    const glm::dvec3& b = axes[(c + 1) % 3];
    if (!(std::abs(glm::dot(a, b)) <= kLargestCosine * glm::length(a) * glm::length(b))) return false;
  }
  return true;
}

void checkNode(const json& node, const std::string& place, Diagnostics& diagnostics) {
  const json& matrix = memberOf(node, "matrix");
  const bool hasParts = node.contains("translation") || node.contains("rotation") || node.contains("scale");
  if (matrix.is_array() && hasParts)
    diagnostics.warn(place + "/matrix", "stands beside translation, rotation or scale, which are ignored");
  if (matrix.is_array() && !isDecomposable(matrix))
    diagnostics.warn(place + "/matrix",
                     "is not made of translation, rotation and scale; it is applied as it is");
  const json& rotation = memberOf(node, "rotation");
  if (rotation.is_array()) {
    double squared = 0.0;
    for (const json& r : rotation) squared += r.get<double>() * r.get<double>();
    // Four components in bytes, each off by half of 1 / 127.
    constexpr double kRoundedToBytes = 0.00788;
    if (!(std::abs(std::sqrt(squared) - 1.0) <= kRoundedToBytes))
      diagnostics.warn(place + "/rotation", "is not a unit quaternion, and normalized");
  }
  for (const char* member : {"skin", "weights"}) {
    if (node.contains(member) && !node.contains("mesh"))
      diagnostics.warn(place + "/" + member, "has no mesh to act on, and is ignored");
  }
  const char* const instancing = "EXT_mesh_gpu_instancing";
  const json& instances = memberOf(memberOf(node, "extensions"), instancing);
  const std::string there = place + pointerTo("extensions", instancing);
  if (!instances.is_object()) return;
  if (!node.contains("mesh")) diagnostics.warn(there, "has no mesh to act on, and is ignored");
  if (!instances.contains("attributes")) diagnostics.warn(there, "has no attributes; the mesh is drawn once");
}

}  // namespace

void checkVersion(const json& root, const Diagnostics& diagnostics) {
  const json& version = memberOf(memberOf(root, "asset"), "version");
  if (!version.is_string()) return;
  const auto& text = version.get_ref<const std::string&>();
  if (versionOf(text, "/asset/version", diagnostics).major != 2)
    diagnostics.refuse("/asset/version", "glTF " + inQuotes(text) + " is not supported, only 2.x is");
}

void checkValidity(const json& root, Diagnostics& diagnostics) {
  checkLeastVersion(root["asset"], diagnostics);
  checkExtensionLists(root, diagnostics);
  Walk(root, diagnostics).visit(root, "");
  forEachIn(root, "cameras",
            [&](const json& camera, const std::string& place) { checkCamera(camera, place, diagnostics); });
  forEachIn(root, "nodes",
            [&](const json& node, const std::string& place) { checkNode(node, place, diagnostics); });
  const json& lights = memberOf(memberOf(memberOf(root, "extensions"), "KHR_lights_punctual"), "lights");
  for (size_t i = 0; i < lights.size(); ++i)
    checkSpotLight(lights[i], pointerTo("extensions", "KHR_lights_punctual", "lights", i), diagnostics);
}

}  // namespace fragtrace
