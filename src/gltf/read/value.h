// SPDX-License-Identifier: MIT
// Reading of extensions and extras, which tinygltf hands on as generic values. The schema has checked their
// types.
#pragma once

#include <tiny_gltf.h>

#include <string>
#include <vector>

namespace fragtrace {

/// The member of that name, or a null value where there is none.
inline const tinygltf::Value& memberOf(const tinygltf::Value& object, const std::string& name) {
  static const tinygltf::Value kNone;
  return object.Has(name) ? object.Get(name) : kNone;
}

inline double numberOf(const tinygltf::Value& object, const std::string& name, double otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  return member.IsNumber() ? member.GetNumberAsDouble() : otherwise;
}

inline std::vector<double> numbersOf(const tinygltf::Value& object, const std::string& name,
                                     std::vector<double> otherwise) {
  const tinygltf::Value& member = memberOf(object, name);
  if (!member.IsArray()) return otherwise;
  std::vector<double> numbers;
  numbers.reserve(member.ArrayLen());
  for (int i = 0; i < int(member.ArrayLen()); ++i) numbers.push_back(member.Get(i).GetNumberAsDouble());
  return numbers;
}

}  // namespace fragtrace
