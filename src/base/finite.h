// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace fragtrace {

template <glm::length_t components, typename Number>
bool isFinite(const glm::vec<components, Number>& v) {
  for (glm::length_t c = 0; c < components; ++c) {
    if (!std::isfinite(v[c])) return false;
  }
  return true;
}

}  // namespace fragtrace
