// SPDX-License-Identifier: MIT
// A tree of which some primitives are left out.
#pragma once

#include "bvh/bvh.h"

namespace fragtrace {

/// Leaves out primitives, the marked ones of the first. Nodes, leaves and slots keep their numbers: a child
/// that holds nothing has an empty box (BvhLeaf: kMissIndex), and rays do not visit it.
Bvh pruned(Bvh bvh, const std::vector<bool>& leftOut);

}  // namespace fragtrace
