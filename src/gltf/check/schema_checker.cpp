// SPDX-License-Identifier: MIT
#include "gltf/check/schema_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/split.h"

namespace fragtrace {
namespace {

using nlohmann::json;

/// Members without which what holds them would be read as something else.
bool isIndispensable(std::string_view pattern) {
  return pattern.starts_with("/accessors/*/") || pattern.starts_with("/bufferViews/*/") ||
         pattern == "/animations/*/samplers/*/interpolation" || pattern == "/cameras/*/orthographic" ||
         pattern == "/cameras/*/perspective" ||
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
    targetSize_ = rule.kind == Kind::Index ? arraySize(rule.target) : 0;
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
    faultPlace_ = place();
    return false;
  }

  /// Of the value that is looked at: its JSON pointer.
  std::string place() const {
    std::string pointer;
    for (const Step& step : steps_)
      pointer += step.name.data() != nullptr ? pointerTo(step.name) : pointerTo(step.index);
    return pointer;
  }

  void warn(const std::string& consequence) { context_.diagnostics.warn(faultPlace_, fault_ + consequence); }

  /// A member or an element on the way from the root. Files have a hundred thousand values, and each rule
  /// looks at them: pointers are made of steps where one is told.
  struct Step {
    std::string_view name;  ///< null: an element
    size_t index = 0;
  };

  bool visit(json& value, Step step, std::string_view rest) {
    steps_.push_back(step);
    const bool stays = rest.empty() ? check(value) : descend(value, rest);
    steps_.pop_back();
    return stays;
  }

  /// Returns false if the value cannot stay.
  bool descend(json& value, std::string_view pattern) {
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string_view name = pattern.substr(1, end - 1);
    const std::string_view rest = pattern.substr(end);
    const std::string_view here = pattern_.substr(0, pattern_.size() - rest.size());
    if (name == "*") return value.is_array() ? descendArray(value, rest, here) : descendMembers(value, rest);
    if (!value.is_object()) return true;
    const auto member = value.find(name);
    if (member == value.end())
      return !rest.empty() || !required_ || note(inQuotes(std::string(name)) + " is missing");
    if (visit(*member, {name}, rest)) return true;
    const bool isNeeded = (rest.empty() && required_) || context_.isRequired(here) || isIndispensable(here);
    if (isNeeded) return false;
    value.erase(member);
    warn("; it is taken as absent");
    return true;
  }

  bool descendArray(json& array, std::string_view rest, std::string_view here) {
    const LostObject* object = lostObjectAt(here);
    const bool mayBeLost = object != nullptr && context_.diagnostics.hasLost();
    for (size_t i = 0; i < array.size(); ++i) {
      if (mayBeLost && context_.diagnostics.isLost(place() + pointerTo(i))) continue;
      if (visit(array[i], {{}, i}, rest)) continue;
      if (object != nullptr) {
        loseObject(root_, *object, place() + pointerTo(i), {"", faultPlace_, fault_}, context_.isUsed,
                   context_.diagnostics);
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
      const bool stays = visit(member.value(), {member.key()}, rest);
      if (!stays) warn("; it is taken as absent");
      member = stays ? std::next(member) : object.erase(member);
    }
    return true;
  }

  bool check(json& value) {
    if (value.is_null()) return note("is null");
    switch (rule_.kind) {
      case Kind::Object:
        return value.is_object() || note("is not an object");
      case Kind::Array:
        return value.is_array() || note("is not an array");
      case Kind::Objects:
        return checkObjects(value);
      case Kind::Text:
        return value.is_string() || note("is not a string");
      case Kind::Word:
        return checkWord(value);
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

  bool checkWord(json& value) {
    if (!value.is_string()) return note("is not a string");
    const std::string given = value;
    const std::string_view rule = rule_.target;
    const size_t colon = rule.find(':');
    const auto words = wordsIn(rule.substr(colon + 2));
    const auto word =
        std::ranges::find_if(words, [&](std::string_view one) { return isSameButForCase(one, given); });
    const std::string is = inQuotes(given) + " is ";
    const std::string isNone = is + "no " + std::string(rule.substr(0, colon));
    const bool isKnown = word != words.end();
    if (!isKnown && (required_ || isIndispensable(pattern_))) return note(isNone);
    value = isKnown ? *word : words.front();
    if (value != given)
      context_.diagnostics.warn(place(),
                                (isKnown ? is : isNone + "; it is ") + "read as " + std::string(value));
    return true;
  }

  /// Elements that are no objects become ones without content.
  bool checkObjects(json& value) {
    if (!value.is_array()) return note("is not an array of objects");
    const LostObject* object = lostObjectAt(std::string(pattern_) + "/*");
    for (size_t i = 0; i < value.size(); ++i) {
      if (value[i].is_object()) continue;
      if (object == nullptr) return note("is not an array of objects");
      const std::string place = this->place() + pointerTo(i);
      const std::string is = value[i].is_null() ? "is null" : "is not an object";
      if (std::string_view(object->empty) == "{}") {
        context_.diagnostics.warn(place, is + ", and taken as one without members");
        context_.diagnostics.noteLost(place);
        value[i] = json::object();
      } else {
        loseObject(root_, *object, place, {"", place, is}, context_.isUsed, context_.diagnostics);
      }
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
    bool isIndex = checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (isIndex && value.get<uint64_t>() >= targetSize_) {
      isIndex = note("index " + value.dump() + " is past the " + std::to_string(targetSize_) +
                     " elements of " + rule_.target);
    }
    if (!isIndex && context_.isUsed(place())) context_.diagnostics.refuse(faultPlace_, fault_);
    return isIndex;
  }

  Rule rule_;
  json& root_;
  const SchemaContext& context_;
  bool required_ = false;
  std::string_view pattern_;
  size_t targetSize_ = 0;
  std::vector<Step> steps_;
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
