// SPDX-License-Identifier: MIT
#include "gltf/check/repairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gltf/check/lost_objects.h"
#include "gltf/read/json_parts.h"
#include "scene/parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// An element of one of the document's arrays.
struct Element {
  json& value;
  const std::string& place;
  Diagnostics& diagnostics;

  void warn(const std::string& member, const std::string& reason) const {
    diagnostics.warn(place + member, reason);
  }
  [[noreturn]] void lose(const std::string& member, const std::string& reason) const {
    diagnostics.lose(place + member, reason);
  }
  void takeAsAbsent(const std::string& member, const std::string& reason) const {
    warn(pointerTo(member), reason + "; it is taken as absent");
    value.erase(member);
  }
  double number(const char* member, double otherwise) const { return value.value(member, otherwise); }

  /// Warns of what the file itself has empty.
  void warnEmpty(const std::string& member) const {
    if (memberOf(value, "extras") != "lost") warn(member, "is empty, and nothing is drawn of it");
  }
};

/// Returns true if the word of a member is one of those, or one but for the case of its letters, which is
/// mended.
bool isOneOf(const Element& element, const char* member, std::initializer_list<const char*> words) {
  json& word = element.value[member];
  const auto& given = word.get_ref<const std::string&>();
  const auto* found =
      std::ranges::find_if(words, [&](const char* one) { return isSameButForCase(one, given); });
  if (found == words.end()) return false;
  if (given != *found) element.warn(pointerTo(member), inQuotes(given) + " is read as " + *found);
  word = *found;
  return true;
}

void mendUri(const Element& element) {
  const json& uri = memberOf(element.value, "uri");
  if (uri.is_string() && uri.get_ref<const std::string&>().empty()) element.takeAsAbsent("uri", "is empty");
}

void mendBuffer(const Element& buffer) {
  mendUri(buffer);
  if (buffer.value["byteLength"] == 0) buffer.warnEmpty("/byteLength");
}

void mendMesh(const Element& mesh) {
  if (mesh.value["primitives"].empty()) mesh.warnEmpty("/primitives");
}

void mendImage(const Element& image) {
  mendUri(image);
  if (!image.value.contains("uri") || !image.value.contains("bufferView")) return;
  image.warn("", "has both a URI and a buffer view, which is taken");
  image.value.erase("uri");
}

/// Strides that WebGL does not allow. The document keeps them, but tinygltf may not see them.
void mendView(const Element& view) {
  constexpr uint64_t kLargest = 252;
  const uint64_t stride = view.value.value("byteStride", uint64_t(4));
  if (view.value["byteLength"] == 0) view.warnEmpty("/byteLength");
  if (stride == 0) return view.takeAsAbsent("byteStride", "is 0");
  if (stride % 4 != 0 || stride > kLargest)
    view.warn("/byteStride", "is not a multiple of 4 from 4 to 252; it is applied all the same");
}

void mendSampler(const Element& sampler) {
  constexpr int kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;
  constexpr std::array<int, 3> kClamping = {10496, 33069, 34627};  // CLAMP, TO_BORDER, MIRROR_CLAMP_TO_EDGE
  for (const char* member : {"wrapS", "wrapT"}) {
    const int mode = sampler.value.value(member, kRepeat);
    if (mode == kRepeat || mode == kClampToEdge || mode == kMirroredRepeat) continue;
    const bool clamps = std::ranges::find(kClamping, mode) != kClamping.end();
    sampler.value[member] = clamps ? kClampToEdge : kRepeat;
    sampler.warn(pointerTo(member), std::to_string(mode) + " is no wrap mode of glTF; it is read as " +
                                        (clamps ? "CLAMP_TO_EDGE" : "REPEAT"));
  }
}

void mendMaterial(const Element& material) {
  if (!material.value.contains("alphaMode") || isOneOf(material, "alphaMode", {"OPAQUE", "MASK", "BLEND"}))
    return;
  material.warn("/alphaMode", material.value["alphaMode"].dump() + " is no alpha mode; it is read as OPAQUE");
  material.value["alphaMode"] = "OPAQUE";
}

void mendCamera(const Element& camera) {
  if (!isOneOf(camera, "type", {"perspective", "orthographic"}))
    camera.lose("/type", camera.value["type"].dump() + " is no kind of camera");
  const auto& type = camera.value["type"].get_ref<const std::string&>();
  if (!camera.value.contains(type)) camera.lose("", inQuotes(type) + " is missing");
  json& lens = camera.value[type];
  if (lens.value("aspectRatio", 1.0) <= 0.0) {
    camera.warn(pointerTo(type, "aspectRatio"), "is not above 0; it is taken as absent");
    lens.erase("aspectRatio");
  }
  // tinygltf asks for clipping planes, which rays do not have.
  lens["znear"] = 1.0;
  lens["zfar"] = 2.0;
}

void mendLight(const Element& light) {
  if (!isOneOf(light, "type", {"point", "spot", "directional"}))
    light.lose("/type", light.value["type"].dump() + " is no kind of light");
  if (light.number("range", 1.0) <= 0.0) light.takeAsAbsent("range", "is not above 0");
  if (light.value["type"] != "spot") return;
  constexpr double kRightAngle = 1.5707963267948966;
  constexpr double kRoundingSlack = 1e-6;  // of an exporter that rounds the right angle up
  constexpr double kDefaultOuter = 0.7853981633974483;
  json& spot = light.value["spot"];  // tinygltf refuses a spot light without it
  if (spot.is_null()) spot = json::object();
  const double inner = spot.value("innerConeAngle", 0.0);
  const double outer = spot.value("outerConeAngle", kDefaultOuter);
  const double outerMended = std::min(outer, kRightAngle);
  const double innerMended = std::clamp(inner, 0.0, std::max(outerMended, 0.0));
  if (!(outer > 0.0)) light.lose("/spot/outerConeAngle", "is not above 0");
  if (outer > kRightAngle + kRoundingSlack)
    light.warn("/spot/outerConeAngle", "is above pi / 2, and taken as that");
  if (inner < 0.0) light.warn("/spot/innerConeAngle", "is below 0, and taken as that");
  if (inner >= outer)
    light.warn("/spot/innerConeAngle", "is not below the outer cone's angle, and taken as that: a hard edge");
  spot["innerConeAngle"] = innerMended;
  spot["outerConeAngle"] = outerMended;
}

void mendMatrix(const Element& node) {
  json& matrix = node.value["matrix"];
  constexpr double kRounding = 1e-3;
  bool isRounded = false;
  for (size_t column = 0; column < 4; ++column) {
    json& last = matrix[4 * column + 3];
    const double wanted = column == 3 ? 1.0 : 0.0;
    const auto given = last.get<double>();
    if (std::abs(given - wanted) > kRounding)
      node.lose("/matrix", "is not affine: its last row is not 0, 0, 0, 1");
    isRounded = isRounded || given != wanted;
    last = wanted;
  }
  if (isRounded)
    node.warn("/matrix", "has a last row that is 0, 0, 0, 1 but for rounding, and taken as that");
  for (const char* part : {"translation", "rotation", "scale"}) {
    if (!node.value.contains(part)) continue;
    node.warn("/matrix", "stands beside translation, rotation or scale, which are ignored");
    node.value.erase(part);
  }
}

void mendNode(const Element& node) {
  if (node.value.contains("matrix")) mendMatrix(node);
  const json& rotation = memberOf(node.value, "rotation");
  if (!rotation.is_array()) return;
  double squared = 0.0;
  for (const json& r : rotation) squared += r.get<double>() * r.get<double>();
  constexpr double kRoundedToBytes = 0.00788;  // four components, each off by half of 1 / 127
  if (squared == 0.0)
    node.takeAsAbsent("rotation", "is a quaternion of zeros");
  else if (!(std::abs(std::sqrt(squared) - 1.0) <= kRoundedToBytes))
    node.warn("/rotation", "is not a unit quaternion, and normalized");
}

void mendAnimation(const Element& animation) {
  json& samplers = animation.value["samplers"];
  for (size_t i = 0; i < samplers.size(); ++i) {
    const std::string place = animation.place + pointerTo("samplers", i);
    const Element sampler{samplers[i], place, animation.diagnostics};
    if (sampler.value.contains("interpolation"))
      isOneOf(sampler, "interpolation", {"LINEAR", "STEP", "CUBICSPLINE"});  // others lose their channels
  }
}

struct Repair {
  const char* array;
  void (*mend)(const Element&);
};

constexpr Repair kRepairs[] = {
    {"/buffers", mendBuffer},     {"/bufferViews", mendView},
    {"/images", mendImage},       {"/samplers", mendSampler},
    {"/materials", mendMaterial}, {"/meshes", mendMesh},
    {"/cameras", mendCamera},     {"/extensions/KHR_lights_punctual/lights", mendLight},
    {"/nodes", mendNode},         {"/animations", mendAnimation},
};

bool hasNull(const json& value) {
  return value.is_null() || (value.is_structured() && std::ranges::any_of(value, hasNull));
}

void dropNullsIn(json& value, const std::string& place, Diagnostics& diagnostics) {
  if (value.is_array()) {
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_structured()) dropNullsIn(value[i], place + pointerTo(i), diagnostics);
    }
  } else if (value.is_object()) {
    for (auto member = value.begin(); member != value.end();) {
      const std::string there = place + pointerTo(member.key());
      if (member->is_null()) {
        diagnostics.warn(there, "is null, and taken as absent");
        member = value.erase(member);
        continue;
      }
      if (member->is_structured() && member.key() != "extras") dropNullsIn(*member, there, diagnostics);
      ++member;
    }
  }
}

}  // namespace

void dropNulls(json& root, Diagnostics& diagnostics) {
  if (hasNull(root)) dropNullsIn(root, "", diagnostics);
}

void mendValues(json& root, const IsUsed& isUsed, Diagnostics& diagnostics) {
  for (const Repair& repair : kRepairs) {
    const json::json_pointer array(repair.array);
    if (!root.contains(array)) continue;
    const LostObject& object = *lostObjectAt(std::string(repair.array) + "/*");
    for (size_t i = 0; i < root[array].size(); ++i) {
      json& value = root[array][i];
      const std::string place = repair.array + pointerTo(i);
      try {
        repair.mend({value, place, diagnostics});
      } catch (const Loss& loss) {
        diagnostics.warnLoss(loss.place, loss.reason, object.name, isUsed(place));
        emptyObject(root, object, value, i);
      }
    }
  }
}

}  // namespace fragtrace
