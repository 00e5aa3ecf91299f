// SPDX-License-Identifier: MIT
#include "gltf/check/schema_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace fragtrace {
namespace {

using nlohmann::json;

class Checker {
 public:
  Checker(json& root, const Diagnostics& diagnostics) : root_(root), diagnostics_(diagnostics) {}

  void apply(const Rule& rule) {
    rule_ = rule;
    std::string_view pattern = rule.pattern;
    required_ = pattern.ends_with('!');
    if (required_) pattern.remove_suffix(1);
    targetSize_ = rule.target != nullptr ? arraySize(rule.target) : 0;
    place_.clear();
    descend(root_, pattern);
  }

 private:
  size_t arraySize(const char* target) const {
    const json::json_pointer pointer(target);
    return root_.contains(pointer) && root_[pointer].is_array() ? root_[pointer].size() : 0;
  }

  [[noreturn]] void refuse(const std::string& reason) const { diagnostics_.refuse(place_, reason); }

  void visit(json& value, const std::string& name, std::string_view rest) {
    const size_t length = place_.size();
    place_.append("/").append(escapedForPointer(name));
    rest.empty() ? check(value) : descend(value, rest);
    place_.resize(length);
  }

  void descend(json& value, std::string_view pattern) {
    const size_t end = std::min(pattern.find('/', 1), pattern.size());
    const std::string name(pattern.substr(1, end - 1));
    const std::string_view rest = pattern.substr(end);
    if (name == "*") {
      if (value.is_array()) {
        for (size_t i = 0; i < value.size(); ++i) visit(value[i], std::to_string(i), rest);
      } else if (value.is_object()) {
        for (auto& member : value.items()) visit(member.value(), member.key(), rest);
      }
    } else if (value.is_object()) {
      const auto member = value.find(name);
      if (member != value.end()) {
        visit(*member, name, rest);
      } else if (rest.empty() && required_) {
        refuse(inQuotes(name) + " is missing");
      }
    }
  }

  void check(json& value) const {
    switch (rule_.kind) {
      case Kind::Object:
        return expect(value.is_object(), "is not an object");
      case Kind::Array:
        return expect(value.is_array(), "is not an array");
      case Kind::Objects:
        return expectEach(value, "is not an array of objects", &json::is_object);
      case Kind::Text:
        return expect(value.is_string(), "is not a string");
      case Kind::Texts:
        return expectEach(value, "is not an array of strings", &json::is_string);
      case Kind::Flag:
        return expect(value.is_boolean(), "is not true or false");
      case Kind::Number:
        return expect(value.is_number(), "is not a number");
      case Kind::Numbers:
        expectEach(value, "is not an array of numbers", &json::is_number);
        return expect(rule_.size == 0 || value.size() == rule_.size,
                      "does not hold " + std::to_string(rule_.size) + " numbers");
      case Kind::Int:
        return checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
      case Kind::Size:
        return checkWhole(value, uint64_t(1) << 53);
      case Kind::Index:
        return checkIndex(value);
    }
  }

  void expect(bool condition, const std::string& reason) const {
    if (!condition) refuse(reason);
  }

  void expectEach(const json& value, const char* reason, bool (json::*isRight)() const noexcept) const {
    expect(value.is_array(), reason);
    for (const json& element : value) expect((element.*isRight)(), reason);
  }

  void checkWhole(json& value, uint64_t largest) const {
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0.0 && number <= double(largest) && number == std::floor(number))
        value = uint64_t(number);
    }
    expect(value.is_number_unsigned(), "is not a non-negative integer");
    expect(value.get<uint64_t>() <= largest, "is too large");
  }

  void checkIndex(json& value) const {
    checkWhole(value, uint64_t(std::numeric_limits<int32_t>::max()));
    if (value.get<uint64_t>() >= targetSize_) {
      refuse("index " + value.dump() + " is past the " + std::to_string(targetSize_) + " elements of " +
             rule_.target);
    }
  }

  json& root_;
  const Diagnostics& diagnostics_;
  Rule rule_{};
  bool required_ = false;
  size_t targetSize_ = 0;
  std::string place_;
};

}  // namespace

void applyRule(const Rule& rule, json& root, const Diagnostics& diagnostics) {
  Checker(root, diagnostics).apply(rule);
}

std::string_view cutPart(std::string_view& pointer) {
  pointer.remove_prefix(1);
  const size_t end = std::min(pointer.find('/'), pointer.size());
  const std::string_view part = pointer.substr(0, end);
  pointer.remove_prefix(end);
  return part;
}

}  // namespace fragtrace
