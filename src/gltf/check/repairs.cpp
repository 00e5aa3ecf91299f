// SPDX-License-Identifier: MIT
#include "gltf/check/repairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "gltf/read/accessor.h"
#include "gltf/read/json.h"

namespace fragtrace {

namespace {

using nlohmann::json;

/// Calls use(element, its place) for each element of an array of the document.
template <typename Use>
void forEachOf(json& root, const char* pointer, const Use& use) {
  const json::json_pointer array(pointer);
  if (!root.contains(array) || !root[array].is_array()) return;
  for (size_t i = 0; i < root[array].size(); ++i) use(root[array][i], pointer + pointerTo(i));
}

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
  if (numberOf(light.value, "range", 1.0) <= 0.0) light.takeAsAbsent("range", "is not above 0");
  if (light.value["type"] != "spot") return;
  constexpr double kRightAngle = 1.5707963267948966;
  constexpr double kRoundingSlack = 1e-6;  // of an exporter that rounds the right angle up
  constexpr double kDefaultOuter = 0.7853981633974483;
  json& spot = light.value["spot"];
  const double inner = numberOf(spot, "innerConeAngle", 0.0);
  const double outer = numberOf(spot, "outerConeAngle", kDefaultOuter);
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

/// The document, for readings of an object.
struct Context {
  const json& root;
  std::vector<uint32_t> uses;  ///< by buffer view: accessors
};

json toTheEnd(const Context&, const json&) { return kToTheEnd; }

json onlyBuffer(const Context& context, const json&) {
  return memberOf(context.root, "buffers").size() == 1 ? json(0u) : json();
}

/// The kind of an object that has a member of that name, and of no other kind.
json kindOf(const json& object, std::initializer_list<const char*> kinds) {
  json found;
  for (const char* kind : kinds) {
    if (!memberOf(object, kind).is_object()) continue;
    if (!found.is_null()) return {};
    found = kind;
  }
  return found;
}

json lensOf(const Context&, const json& camera) { return kindOf(camera, {"perspective", "orthographic"}); }
json lightOf(const Context&, const json& light) { return kindOf(light, {"spot"}); }

/// 1 to 4 components of a scalar or a vector; 0: another type.
uint64_t componentsOf(const json& type) {
  constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  for (uint64_t i = 0; i < std::size(kTypes); ++i)
    if (type == kTypes[i]) return i + 1;
  return 0;
}

/// As many elements as the accessor's view holds, if no other accessor takes a part of it.
json countThatFits(const Context& context, const json& accessor) {
  const json& index = memberOf(accessor, "bufferView");
  const json& view = elementOf(context.root, "bufferViews", index);
  const json& length = memberOf(view, "byteLength");
  const json& component = memberOf(accessor, "componentType");
  if (!length.is_number_unsigned() || length == kToTheEnd || !component.is_number_unsigned() ||
      context.uses[index.get<size_t>()] != 1)
    return {};
  const auto numberOf = [](const json& number, uint64_t otherwise) {
    return number.is_number_unsigned() ? number.get<uint64_t>() : otherwise;
  };
  const uint64_t size = componentSize(component.get<unsigned>()) * componentsOf(memberOf(accessor, "type"));
  const uint64_t offset = numberOf(memberOf(accessor, "byteOffset"), 0);
  const uint64_t stride = numberOf(memberOf(view, "byteStride"), size);
  const auto bytes = length.get<uint64_t>();
  if (size == 0 || stride < size || offset > bytes || size > bytes - offset) return {};
  return (bytes - offset - size) / stride + 1;
}

struct Supply {
  const char* array;
  const char* member;
  json (*read)(const Context& context, const json& object);  ///< null: nothing tells
  const char* words;
};

/// In the order in which they need each other.
constexpr Supply kSupplies[] = {
    {"/buffers", "byteLength", toTheEnd, "the length of its data is taken"},
    {"/bufferViews", "buffer", onlyBuffer, "the only buffer is taken"},
    {"/bufferViews", "byteLength", toTheEnd, "all up to the end of its buffer is taken"},
    {"/accessors", "count", countThatFits, "as many as its buffer view holds are taken"},
    {"/cameras", "type", lensOf, "the lens that is there is taken"},
    {"/extensions/KHR_lights_punctual/lights", "type", lightOf, "its cone makes it a spot light"},
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

void mendValues(json& root, const IsUsed& isUsed, Diagnostics& diagnostics) {
  for (const Repair& repair : kRepairs) {
    const LostObject& object = *lostObjectAt(std::string(repair.array) + "/*");
    forEachOf(root, repair.array, [&](json& value, const std::string& place) {
      if (diagnostics.isLost(place)) return;
      try {
        repair.mend({value, place, diagnostics});
      } catch (const Loss& loss) {
        loseObject(root, object, place, loss, isUsed, diagnostics);
      }
    });
  }
}

void supplyMembers(json& root, Diagnostics& diagnostics) {
  Context context{root, std::vector<uint32_t>(memberOf(root, "bufferViews").size(), 0)};
  forEachOf(root, "/accessors", [&](const json& accessor, const std::string&) {
    const json& view = memberOf(accessor, "bufferView");
    if (view.is_number_unsigned() && view.get<size_t>() < context.uses.size())
      ++context.uses[view.get<size_t>()];
  });
  for (const Supply& supply : kSupplies) {
    forEachOf(root, supply.array, [&](json& object, const std::string& place) {
      if (!object.is_object() || !memberOf(object, supply.member).is_null()) return;
      json value = supply.read(context, object);
      if (value.is_null()) return;
      const bool isNull = object.contains(supply.member);
      diagnostics.warn(isNull ? place + pointerTo(supply.member) : place,
                       (isNull ? "is null; " : inQuotes(supply.member) + " is missing; ") + supply.words);
      object[supply.member] = std::move(value);
    });
  }
}

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
