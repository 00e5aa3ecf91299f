// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace fragtrace {

// FNV-1a (Fowler, Noll and Vo), 64 bits. It distinguishes contents and finds damage, but does not protect
// against malice.

inline constexpr uint64_t kHashStart = 0xcbf29ce484222325u;

/// The hash of what `hash` stands for, followed by these values: bytes for FNV-1a itself, or larger words.
template <typename Values>
uint64_t hashOf(const Values& values, uint64_t hash = kHashStart) {
  for (const auto value : values) hash = (hash ^ uint64_t(value)) * 0x100000001b3u;
  return hash;
}

// Appending values to an array of 32-bit words.

inline uint32_t floatWord(float x) { return std::bit_cast<uint32_t>(x); }

inline void appendRow(std::vector<uint32_t>& words, const glm::vec4& v) {
  words.insert(words.end(), {floatWord(v.x), floatWord(v.y), floatWord(v.z), floatWord(v.w)});
}

inline void appendRow(std::vector<uint32_t>& words, const glm::vec3& v, float w) {
  appendRow(words, glm::vec4(v, w));
}

}  // namespace fragtrace
