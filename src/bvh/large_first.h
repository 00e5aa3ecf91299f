// SPDX-License-Identifier: MIT
// Primitives so large that most rays would meet their boxes anyway, such as the walls of a room. They stay
// out of the tree and are tested first, so they do not spoil its upper levels.
#pragma once

#include <span>

#include "bvh/bvh.h"

namespace fragtrace {

/// The indices of those of the first triangleCount primitives whose boxes have at least a fiftieth of the
/// surface area of all, the 32 largest at most, in rising order.
std::vector<uint32_t> largeTriangles(std::span<const Bounds> primitiveBounds, uint32_t triangleCount);

/// A tree of all other primitives; the leaves of the large ones come after its own (Bvh::besideTree of them).
Bvh buildBvhBeside(std::span<const Bounds> primitiveBounds, uint32_t firstSingle,
                   std::span<const uint32_t> large);

}  // namespace fragtrace
