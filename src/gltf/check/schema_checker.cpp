// SPDX-License-Identifier: MIT
#include "gltf/check/schema_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "gltf/check/lost_objects.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// Members without which what holds them would be read as something else.
bool isIndispensable(std::string_view pattern) {
  return pattern.starts_with("/accessors/*/") || pattern.starts_with("/bufferViews/*/") ||
         pattern == "/cameras/*/orthographic" || pattern == "/cameras/*/perspective" ||
         pattern == "/meshes/*/primitives/*/extensions/KHR_draco_mesh_compression";
}

class Checker {
 public:
  Checker(const Rule& rule, json& root, const SchemaContext& context)
      : rule_(rule), root_(root), context_(context) {
    std::string_view pattern = rule.pattern;
    required_ = pattern.ends_with('!');
    if (required_) pattern.remove_suffix(1);
    pattern_ = pattern;
    targetSize_ = rule.target != nullptr ? arraySize(rule.target) : 0;
  }

  void apply() {
    if (!descend(root_, pattern_)) context_.diagnostics.refuse(faultPlace_, fault_);
  }

 private:
  size_t arraySize(const char* target) const {
    const json::json_pointer pointer(target);
    return root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
  }

  /// Notes a fault at the place, and returns false.
  bool note(const std::string& reason) {
    fault_ = reason;
    faultPlace_ = place_;
    return false;
  }

  void warn(const std::string& consequence) { context_.diagnostics.warn(faultPlace_, fault_ + consequence); }

  bool visit(json& value, const std::string& name, std::string_view rest) {
    const size_t length = place_.size();
    place_.append("/").append(escapedForPointer(name));
    const bool stays = rest.empty() ? check(value) : descend(value, rest);
    place_.resize(length);
    return stays;
  }

  /// Returns false if the value cannot stay.
  bool descend(json& value, std::string_view pattern) {
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string name(pattern.substr(1, end - 1));
    const std::string_view rest = pattern.substr(end);
    const std::string_view here = pattern_.substr(0, pattern_.size() - rest.size());
    if (name == "*") return value.is_array() ? descendArray(value, rest, here) : descendMembers(value, rest);
    if (!value.is_object()) return true;
    const auto member = value.find(name);
    if (member == value.end()) return !rest.empty() || !required_ || note(inQuotes(name) + " is missing");
    if (visit(*member, name, rest)) return true;
    const bool isNeeded = (rest.empty() && required_) || context_.isRequired(here) || isIndispensable(here);
    if (isNeeded) return false;
    value.erase(name);
    warn("; it is taken as absent");
    return true;
  }

  bool descendArray(json& array, std::string_view rest, std::string_view here) {
    const LostObject* object = lostObjectAt(here);
    for (size_t i = 0; i < array.size(); ++i) {
      if (visit(array[i], std::to_string(i), rest)) continue;
      const std::string place = place_ + pointerTo(i);
      if (object != nullptr) {
        const bool isUsed = context_.isUsed(place);
        emptyObject(root_, *object, array[i], i);
        context_.diagnostics.warnLoss(faultPlace_, fault_, object->name, isUsed);
      } else if (mayLoseElements(here)) {
        array.erase(i--);
        warn("; it is taken as absent");
      } else {
        return false;
      }
    }
    return true;
  }

  /// References whose number and order mean nothing.
  static bool mayLoseElements(std::string_view here) {
    return here == "/nodes/*/children/*" || here == "/scenes/*/nodes/*";
  }

  bool descendMembers(json& object, std::string_view rest) {
    if (!object.is_object()) return true;
    for (auto member = object.begin(); member != object.end();) {
      const bool stays = visit(member.value(), member.key(), rest);
      if (!stays) warn("; it is taken as absent");
      member = stays ? std::next(member) : object.erase(member);
    }
    return true;
  }

  bool check(json& value) {
    switch (rule_.kind) {
      case Kind::Object:
        return value.is_object() || note("is not an object");
      case Kind::Array:
        return value.is_array() || note("is not an array");
      case Kind::Objects:
        return checkObjects(value);
      case Kind::Text:
        return value.is_string() || note("is not a string");
      case Kind::Texts:
        return isOfEach(value, &json::is_string) || note("is not an array of strings");
      case Kind::Flag:
        return value.is_boolean() || note("is not true or false");
      case Kind::Number:
        return value.is_number() || note("is not a number");
      case Kind::Numbers:
        if (!isOfEach(value, &json::is_number)) return note("is not an array of numbers");
        return rule_.size == 0 || value.size() == rule_.size ||
               note("does not hold " + std::to_string(rule_.size) + " numbers");
      case Kind::Int:
        return checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
      case Kind::Size:
        return checkWhole(value, uint64_t(1) << 53);
      case Kind::Index:
        return checkIndex(value);
    }
    return true;
  }

  static bool isOfEach(const json& value, bool (json::*isRight)() const noexcept) {
    return value.is_array() && std::ranges::all_of(value, [&](const json& e) { return (e.*isRight)(); });
  }

  /// Elements that are no objects become ones without content.
  bool checkObjects(json& value) {
    if (!value.is_array()) return note("is not an array of objects");
    const LostObject* object = lostObjectAt(std::string(pattern_) + "/*");
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_object()) continue;
      if (object == nullptr) return note("is not an array of objects");
      const std::string place = place_ + pointerTo(i);
      const std::string is = value[i].is_null() ? "is null" : "is not an object";
      const bool isUsed = context_.isUsed(place);
      const bool needsNone = std::string_view(object->empty) == "{}";
      emptyObject(root_, *object, value[i], i);
      needsNone ? context_.diagnostics.warn(place, is + ", and taken as one without members")
                : context_.diagnostics.warnLoss(place, is, object->name, isUsed);
    }
    return true;
  }

  bool checkWhole(json& value, uint64_t largest) {
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0.0 && number <= double(largest) && number == std::floor(number))
        value = uint64_t(number);
    }
    if (!value.is_number_unsigned()) return note("is not a non-negative integer");
    return value.get<uint64_t>() <= largest || note("is too large");
  }

  bool checkIndex(json& value) {
    if (value.is_null()) return note("is null");
    bool isIndex = checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (isIndex && value.get<uint64_t>() >= targetSize_) {
      isIndex = note("index " + value.dump() + " is past the " + std::to_string(targetSize_) +
                     " elements of " + rule_.target);
    }
    if (!isIndex && context_.isUsed(place_)) context_.diagnostics.refuse(faultPlace_, fault_);
    return isIndex;
  }

  Rule rule_;
  json& root_;
  const SchemaContext& context_;
  bool required_ = false;
  std::string_view pattern_;
  size_t targetSize_ = 0;
  std::string place_;
  std::string fault_;       ///< the reason why a value cannot stay
  std::string faultPlace_;  ///< its place
};

}  // namespace

void applyRule(const Rule& rule, json& root, const SchemaContext& context) {
  Checker(rule, root, context).apply();
}

std::string_view cutPart(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const size_t end = std::min(pointer.find('/'), pointer.size());
  const std::string_view part = pointer.substr(0, end);
  pointer.remove_prefix(end);
  return part;
}

}  // namespace fragtrace
