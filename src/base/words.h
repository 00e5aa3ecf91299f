// SPDX-License-Identifier: MIT
// Appending values to an array of 32-bit words.
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace fragtrace {

inline uint32_t floatWord(float x) { return std::bit_cast<uint32_t>(x); }

inline void appendRow(std::vector<uint32_t>& words, const glm::vec4& v) {
  words.insert(words.end(), {floatWord(v.x), floatWord(v.y), floatWord(v.z), floatWord(v.w)});
}

inline void appendRow(std::vector<uint32_t>& words, const glm::vec3& v, float w) {
  appendRow(words, glm::vec4(v, w));
}

}  // namespace fragtrace
