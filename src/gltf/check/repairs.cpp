// SPDX-License-Identifier: MIT
#include "gltf/check/repairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gltf/read/component_types.h"
#include "gltf/read/json_parts.h"

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
};

constexpr const char* kIsEmpty = "is empty, and nothing is drawn of it";

void mendUri(const Element& element) {
  const json& uri = memberOf(element.value, "uri");
  if (uri.is_string() && uri.get_ref<const std::string&>().empty()) element.takeAsAbsent("uri", "is empty");
}

void mendBuffer(const Element& buffer) {
  mendUri(buffer);
  if (buffer.value["byteLength"] == 0) buffer.warn("/byteLength", kIsEmpty);
}

void mendMesh(const Element& mesh) {
  if (mesh.value["primitives"].empty()) mesh.warn("/primitives", kIsEmpty);
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
  if (view.value["byteLength"] == 0) view.warn("/byteLength", kIsEmpty);
  if (stride == 0) return view.takeAsAbsent("byteStride", "is 0");
  if (stride % 4 != 0 || stride > kLargest)
    view.warn("/byteStride", "is not a multiple of 4 from 4 to 252; it is applied all the same");
}

/// tinygltf refuses files with others.
void mendAccessor(const Element& accessor) {
  const auto type = accessor.value["componentType"].get<unsigned>();
  if (!isComponentType(type))
    accessor.lose("/componentType", std::to_string(type) + " is not a component type");
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

void mendCamera(const Element& camera) {
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
  if (!node.value.contains("rotation")) return;
  json& rotation = node.value["rotation"];
  double largest = 0.0, squared = 0.0;
  for (const json& r : rotation) largest = std::max(largest, std::abs(r.get<double>()));
  if (largest == 0.0) return node.takeAsAbsent("rotation", "is a quaternion of zeros");
  const int exponent = std::ilogb(largest);  // so that squares neither overflow nor vanish
  for (const json& r : rotation) squared += std::pow(std::ldexp(r.get<double>(), -exponent), 2);
  constexpr double kRoundedToBytes = 0.00788;  // four components, each off by half of 1 / 127
  if (std::abs(std::ldexp(std::sqrt(squared), exponent) - 1.0) <= kRoundedToBytes) return;
  node.warn("/rotation", "is not a unit quaternion, and normalized");
  for (json& r : rotation) r = std::ldexp(r.get<double>(), -exponent);
}

struct Repair {
  const char* array;
  void (*mend)(const Element&);
};

constexpr Repair kRepairs[] = {
    {"/buffers", mendBuffer},     {"/bufferViews", mendView},
    {"/images", mendImage},       {"/samplers", mendSampler},
    {"/accessors", mendAccessor}, {"/meshes", mendMesh},
    {"/cameras", mendCamera},     {"/extensions/KHR_lights_punctual/lights", mendLight},
    {"/nodes", mendNode},
};

}  // namespace

void mendValues(json& root, const IsUsed& isUsed, Diagnostics& diagnostics) {
  for (const Repair& repair : kRepairs) {
    const json::json_pointer array(repair.array);
    if (!root.contains(array)) continue;
    const LostObject& object = *lostObjectAt(std::string(repair.array) + "/*");
    for (size_t i = 0; i < root[array].size(); ++i) {
      const std::string place = repair.array + pointerTo(i);
      if (diagnostics.isLost(place)) continue;
      try {
        repair.mend({root[array][i], place, diagnostics});
      } catch (const Loss& loss) {
        loseObject(root, object, place, loss, isUsed, diagnostics);
      }
    }
  }
}

}  // namespace fragtrace
