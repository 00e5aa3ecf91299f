// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gltf/check/validity.h"
#include "gltf/read/component_types.h"
#include "gltf/read/json_parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

unsigned componentTypeOf(const json& accessor) { return accessor.value("componentType", 0u); }

uint64_t componentSizeOf(const json& accessor) { return componentSize(componentTypeOf(accessor)); }

bool isMatrix(const json& accessor) { return accessor.value("type", "").starts_with("MAT"); }

/// An attribute's name without its set, such as TEXCOORD, and the set.
struct Semantic {
  std::string name;
  std::optional<unsigned> set;
};

constexpr std::array<std::string_view, 3> kSingleSemantics = {"POSITION", "NORMAL", "TANGENT"};
constexpr std::array<std::string_view, 4> kIndexedSemantics = {"TEXCOORD", "COLOR", "JOINTS", "WEIGHTS"};

/// Returns nothing if glTF does not know the name.
std::optional<Semantic> semanticOf(const std::string& attribute) {
  if (std::find(kSingleSemantics.begin(), kSingleSemantics.end(), attribute) != kSingleSemantics.end())
    return Semantic{attribute, {}};
  const size_t bar = attribute.find('_');
  const std::string name = attribute.substr(0, bar);
  if (bar == std::string::npos ||
      std::find(kIndexedSemantics.begin(), kIndexedSemantics.end(), name) == kIndexedSemantics.end())
    return std::nullopt;
  const std::string digits = attribute.substr(bar + 1);
  constexpr size_t kMostDigits = 4;
  const bool isNumber = !digits.empty() && digits.size() <= kMostDigits &&
                        digits.find_first_not_of("0123456789") == std::string::npos &&
                        (digits == "0" || digits[0] != '0');
  if (!isNumber) return std::nullopt;
  return Semantic{name, unsigned(std::stoul(digits))};
}

/// glTF 2.0, 3.7.2.1; with KHR_mesh_quantization nearly any component type.
bool hasFormatOf(const std::string& semantic, const json& accessor, bool quantized) {
  const unsigned component = componentTypeOf(accessor);
  const std::string type = accessor.value("type", "");
  const bool isNormalized = accessor.value("normalized", false);
  const bool isFraction =
      component == kFloat || (isNormalized && (component == kUnsignedByte || component == kUnsignedShort));
  if (semantic == "POSITION" || semantic == "NORMAL")
    return type == "VEC3" && (component == kFloat || (quantized && component <= kUnsignedShort));
  if (semantic == "TANGENT")
    return type == "VEC4" && (component == kFloat || (quantized && component <= kUnsignedShort));
  if (semantic == "TEXCOORD")
    return type == "VEC2" && (isFraction || (quantized && component <= kUnsignedShort));
  if (semantic == "COLOR") return (type == "VEC3" || type == "VEC4") && isFraction;
  if (semantic == "JOINTS")
    return type == "VEC4" && (component == kUnsignedByte || component == kUnsignedShort);
  return type == "VEC4" && isFraction;  // WEIGHTS
}

class DataChecker {
 public:
  DataChecker(const json& root, Diagnostics& diagnostics) : root_(root), diagnostics_(diagnostics) {
    const json& used = memberOf(root, "extensionsUsed");
    quantized_ = std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end();
  }

  void check() {
    forEachIn(root_, "bufferViews",
              [this](const json& view, const std::string& place) { checkView(view, place); });
    forEachIn(root_, "accessors",
              [this](const json& accessor, const std::string& place) { checkAccessor(accessor, place); });
    forEachIn(root_, "images",
              [this](const json& image, const std::string& place) { checkImage(image, place); });
    forEachIn(root_, "meshes",
              [this](const json& mesh, const std::string& place) { checkMesh(mesh, place); });
  }

 private:
  void warn(const std::string& place, const std::string& reason) { diagnostics_.warn(place, reason); }

  const json& viewOf(const json& owner) const {
    return elementOf(root_, "bufferViews", memberOf(owner, "bufferView"));
  }

  void warnStride(const json& view, const std::string& place, const std::string& consequence) {
    if (view.contains("byteStride")) warn(place, "byteStride is for vertex attributes only; " + consequence);
  }

  void checkView(const json& view, const std::string& place) {
    constexpr unsigned kIndexTarget = 34963;
    if (!view.contains("byteStride")) return;
    if (view["byteStride"].get<uint64_t>() > view["byteLength"].get<uint64_t>())
      warn(place + "/byteStride",
           "is larger than the whole buffer view, which has room for one element at most");
    if (memberOf(view, "target") == kIndexTarget)
      warnStride(view, place + "/byteStride", "it is applied all the same");
  }

  void checkAccessor(const json& accessor, const std::string& place) {
    const unsigned component = componentTypeOf(accessor);
    if (accessor.value("normalized", false) && (component == kFloat || component == kUnsignedInt))
      warn(place + "/normalized", "is not for floats and 32-bit integers, and ignored");
    const json& sparse = memberOf(accessor, "sparse");
    if (sparse.is_object()) {
      const auto count = sparse["count"].get<int64_t>();
      if (count > 0 && uint64_t(count) > accessor["count"].get<uint64_t>())
        warn(place + "/sparse/count",
             "is more than there are elements, which is refused where they are read");
      for (const char* part : {"indices", "values"})
        warnStride(viewOf(sparse[part]), place + "/sparse/" + part + "/bufferView", "it is ignored");
    }
    if (!accessor.contains("bufferView")) {
      if (accessor.contains("byteOffset"))
        warn(place + "/byteOffset", "has no buffer view to begin in, and is ignored");
      return;
    }
    if (isComponentType(component)) checkRange(accessor, place);
    constexpr uint64_t kColumnAlignment = 4;
    const uint64_t offset = accessor.value("byteOffset", uint64_t(0));
    const uint64_t size = componentSizeOf(accessor);
    const uint64_t total = offset + viewOf(accessor).value("byteOffset", uint64_t(0));
    if (offset % size != 0 || (isMatrix(accessor) && offset % kColumnAlignment != 0))
      warn(place + "/byteOffset", "is not aligned to its components; it is read all the same");
    if (total % size != 0)
      warn(place, "does not begin at a multiple of its component's size; it is read all the same");
  }

  /// The bytes themselves are checked and refused later; not all buffers have any.
  void checkRange(const json& accessor, const std::string& place) {
    const std::string type = accessor.value("type", "");
    const uint64_t components = type.starts_with("VEC") ? uint64_t(type.back() - '0')
                                : type == "SCALAR"      ? 1
                                                        : 0;
    const json& view = viewOf(accessor);
    const uint64_t size = components * componentSizeOf(accessor);
    const uint64_t stride = view.value("byteStride", size);
    if (stride < size) warn(place, "has elements that overlap, which is refused where they are read");
    const auto count = accessor["count"].get<uint64_t>();
    if (size == 0 || stride == 0 || count == 0) return;
    const auto length = view["byteLength"].get<uint64_t>();
    const uint64_t offset = accessor.value("byteOffset", uint64_t(0));
    if (offset > length || size > length - offset || count - 1 > (length - offset - size) / stride)
      warn(place, "reaches past its buffer view, which is refused where it is read");
  }

  void checkImage(const json& image, const std::string& place) {
    if (!image.contains("bufferView")) return;
    warnStride(viewOf(image), place + "/bufferView", "it is ignored");
    if (!image.contains("mimeType")) warn(place + "/bufferView", "needs a mimeType; the bytes tell it");
  }

  void checkMesh(const json& mesh, const std::string& place) {
    const json& primitives = mesh["primitives"];
    std::optional<size_t> targets;
    for (size_t i = 0; i < primitives.size(); ++i) {
      const std::string there = place + "/primitives/" + std::to_string(i);
      checkPrimitive(primitives[i], there);
      const size_t count = memberOf(primitives[i], "targets").size();
      if (targets && *targets != count)
        warn(there,
             "has another number of morph targets than the mesh's first primitive; those that it has are "
             "applied");
      if (!targets) targets = count;
    }
    const json& weights = memberOf(mesh, "weights");
    if (weights.is_array() && !weights.empty() && targets && weights.size() != *targets)
      warn(place + "/weights",
           "are not as many as the morph targets; what is missing is 0, the rest is ignored");
  }

  void checkPrimitive(const json& primitive, const std::string& place) {
    const json& attributes = primitive["attributes"];
    checkAttributes(attributes, nullptr, place + "/attributes");
    const json& targets = memberOf(primitive, "targets");
    for (size_t i = 0; targets.is_array() && i < targets.size(); ++i) {
      if (targets[i].is_object())
        checkAttributes(targets[i], &attributes, place + "/targets/" + std::to_string(i));
    }
    const json& indices = elementOf(root_, "accessors", memberOf(primitive, "indices"));
    if (!indices.empty()) {
      const unsigned component = componentTypeOf(indices);
      warnStride(viewOf(indices), place + "/indices", "it is applied all the same");
      if (indices.value("type", "") != "SCALAR" ||
          (component != kUnsignedByte && component != kUnsignedShort && component != kUnsignedInt))
        warn(place + "/indices",
             "are not unsigned integers of type SCALAR, which is refused where they are read");
    }
    checkTexcoords(attributes, elementOf(root_, "materials", memberOf(primitive, "material")),
                   place + "/material");
  }

  /// Checks the attributes of a primitive, or of a morph target of a primitive with the attributes `base`.
  void checkAttributes(const json& attributes, const json* base, const std::string& place) {
    std::map<std::string, std::vector<unsigned>> sets;
    std::map<size_t, size_t> usesOfView;
    const json& first =
        elementOf(root_, "accessors", memberOf(base != nullptr ? *base : attributes, "POSITION"));
    for (const auto& attribute : attributes.items()) {
      const json& accessor = elementOf(root_, "accessors", attribute.value());
      const json& view = memberOf(accessor, "bufferView");
      if (view.is_number_unsigned()) ++usesOfView[view.get<size_t>()];
    }
    for (const auto& attribute : attributes.items()) {
      const std::string& name = attribute.key();
      const std::string there = place + "/" + escapedForPointer(name);
      const auto semantic = semanticOf(name);
      if (!semantic && !name.starts_with('_')) warn(there, "is no attribute of glTF, and ignored");
      if (base != nullptr && !base->contains(name))
        warn(there, "is not among the attributes that it would change, and ignored");
      const json& accessor = elementOf(root_, "accessors", attribute.value());
      if (!semantic || accessor.empty()) continue;
      if (semantic->set) sets[semantic->name].push_back(*semantic->set);
      checkAttribute(*semantic, accessor, first, base != nullptr, usesOfView, there);
    }
    for (auto& [name, numbers] : sets) {
      std::sort(numbers.begin(), numbers.end());
      for (size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i] == i) continue;
        warn(place, "the sets of " + name + " do not count from 0; each is taken by its number");
        break;
      }
    }
    if (sets["JOINTS"].size() != sets["WEIGHTS"].size())
      warn(place, "JOINTS and WEIGHTS are not equally many; those without the other are ignored");
  }

  void checkAttribute(const Semantic& semantic, const json& accessor, const json& position, bool isMorph,
                      std::map<size_t, size_t>& usesOfView, const std::string& place) {
    // Morph targets of positions, normals and tangents are three floats each (3.7.2.2).
    const std::string wanted = isMorph && semantic.name == "TANGENT" ? "NORMAL" : semantic.name;
    if (!hasFormatOf(wanted, accessor, quantized_))
      warn(place,
           "has a type that glTF does not allow for it; where it is read, it is refused unless its numbers "
           "are clear");
    if (!position.empty() && accessor["count"] != position["count"])
      warn(place, "has another number of elements than POSITION, which is refused where it is read");
    if (!accessor.contains("bufferView")) return;
    const json& view = viewOf(accessor);
    constexpr uint64_t kVertexAlignment = 4;
    const uint64_t offset = accessor.value("byteOffset", uint64_t(0)) + view.value("byteOffset", uint64_t(0));
    const uint64_t components = accessor.value("type", "") == "VEC2"   ? 2
                                : accessor.value("type", "") == "VEC3" ? 3
                                                                       : 4;
    const uint64_t stride = view.value("byteStride", componentSizeOf(accessor) * components);
    if (offset % kVertexAlignment != 0 || stride % kVertexAlignment != 0)
      warn(place, "is not aligned to 4 bytes; it is read all the same");
    if (!view.contains("byteStride") && usesOfView[accessor["bufferView"].get<size_t>()] > 1)
      warn(place, "shares a buffer view that has no byteStride; it is read as if packed");
  }

  void checkTexcoords(const json& attributes, const json& part, const std::string& place) {
    for (const auto& member : part.items()) {
      if (!member.value().is_object() || member.key() == "extras") continue;
      checkTexcoords(attributes, member.value(), place);
      if (!member.key().ends_with("Texture") || !member.value().contains("index")) continue;
      const json& info = member.value();
      const json::json_pointer transform("/extensions/KHR_texture_transform");
      const bool isOverridden = info.contains(transform) && info[transform].contains("texCoord");
      const json& set = memberOf(isOverridden ? info[transform] : info, "texCoord");
      const std::string name = "TEXCOORD_" + (set.is_number_unsigned() ? set.dump() : "0");
      const bool isRead = name == "TEXCOORD_0" || name == "TEXCOORD_1";
      if (!attributes.contains(name))
        warn(place, "asks for " + name + ", which the primitive does not have; " +
                        (isRead ? "(0, 0)" : "TEXCOORD_0") + " is taken");
    }
  }

  const json& root_;
  Diagnostics& diagnostics_;
  bool quantized_ = false;
};

}  // namespace

void checkDataValidity(const json& root, Diagnostics& diagnostics) { DataChecker(root, diagnostics).check(); }

}  // namespace fragtrace
