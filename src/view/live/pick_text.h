// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bvh/pick.h"

namespace fragtrace {

/// Describes the hit in words, a line a fact: node, mesh, triangle, place, and the material's name.
std::vector<std::string> pickLines(const Scene& scene, const Pick& pick);

}  // namespace fragtrace
