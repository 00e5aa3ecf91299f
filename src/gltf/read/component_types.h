// SPDX-License-Identifier: MIT
// The types of an accessor's components, by glTF's numbers (those of OpenGL).
#pragma once

#include <cstdint>

namespace fragtrace {

inline constexpr unsigned kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                          kUnsignedInt = 5125, kFloat = 5126;

inline bool isComponentType(unsigned type) {
  return (type >= kByte && type <= kUnsignedShort) || type == kUnsignedInt || type == kFloat;
}

/// Bytes; 4 of a type that is none.
inline uint64_t componentSize(unsigned type) {
  if (type == kByte || type == kUnsignedByte) return 1;
  return type == kShort || type == kUnsignedShort ? 2 : 4;
}

}  // namespace fragtrace
