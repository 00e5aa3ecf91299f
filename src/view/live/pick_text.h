// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bvh/pick.h"

namespace fragtrace {

/// A material's values, a line each: those that the user sees first, and of the others those that are not the
/// defaults.
std::vector<std::string> materialLines(const Material& material);

/// Describes the hit in words, a line a fact: node, mesh, triangle, place, and the values of the material
/// that are not the defaults.
std::vector<std::string> pickLines(const Scene& scene, const Pick& pick);

}  // namespace fragtrace
