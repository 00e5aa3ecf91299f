// SPDX-License-Identifier: MIT
// Reads extensions and extras, which tinygltf passes on as generic values. The schema has checked their
// types.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <string_view>
#include <vector>

namespace fragtrace {

/// The member of that name, or a null value where there is none.
inline const tinygltf::Value& memberOf(const tinygltf::Value& object, std::string_view name) {
  static const tinygltf::Value kNone;
  const std::string key(name);
  return object.Has(key) ? object.Get(key) : kNone;
}

inline double numberOf(const tinygltf::Value& object, std::string_view name, double otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  return member.IsNumber() ? member.GetNumberAsDouble() : otherwise;
}

inline std::vector<double> numbersOf(const tinygltf::Value& object, std::string_view name,
                                     std::vector<double> otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  if (!member.IsArray()) return otherwise;
  std::vector<double> numbers;
  numbers.reserve(member.ArrayLen());
  for (int i = 0; i < int(member.ArrayLen()); ++i) numbers.push_back(member.Get(i).GetNumberAsDouble());
  return numbers;
}

}  // namespace fragtrace
