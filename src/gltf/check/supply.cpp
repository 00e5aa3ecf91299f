// SPDX-License-Identifier: MIT
#include "gltf/check/supply.h"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gltf/read/component_types.h"
#include "gltf/read/json_parts.h"

namespace fragtrace {
namespace {

using nlohmann::json;

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

}  // namespace

void supplyMembers(json& root, Diagnostics& diagnostics) {
  Context context{root, std::vector<uint32_t>(memberOf(root, "bufferViews").size(), 0)};
  forEachIn(root, "accessors", [&](const json& accessor, const std::string&) {
    const json& view = memberOf(accessor, "bufferView");
    if (view.is_number_unsigned() && view.get<size_t>() < context.uses.size())
      ++context.uses[view.get<size_t>()];
  });
  for (const Supply& supply : kSupplies) {
    const json::json_pointer array(supply.array);
    if (!root.is_object() || !root.contains(array) || !root[array].is_array()) continue;
    for (size_t i = 0; i < root[array].size(); ++i) {
      json& object = root[array][i];
      if (!object.is_object() || !memberOf(object, supply.member).is_null()) continue;
      json value = supply.read(context, object);
      if (value.is_null()) continue;
      const std::string place = supply.array + pointerTo(i);
      const bool isNull = object.contains(supply.member);
      diagnostics.warn(isNull ? place + pointerTo(supply.member) : place,
                       (isNull ? "is null; " : inQuotes(supply.member) + " is missing; ") + supply.words);
      object[supply.member] = std::move(value);
    }
  }
}

}  // namespace fragtrace
