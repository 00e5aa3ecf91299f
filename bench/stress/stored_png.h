// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace fragtrace {

/// A PNG file of 8-bit colours, rows from the top, not compressed (its zlib stream is one stored block, so at
/// most 65,535 bytes with one a row).
std::string storedPng(int width, const std::vector<glm::u8vec3>& texels);

}  // namespace fragtrace
