// SPDX-License-Identifier: MIT
#pragma once

#include "bvh/bvh.h"

namespace fragtrace {

/// Makes the wide nodes (Bvh::wide) of a binary tree of one level, and puts the leaves into their order. Of
/// all ways to merge binary nodes, it takes the one whose boxes have the least area in all (Ylitie, Karras
/// and Laine, Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs, 2017).
void collapse(Bvh& bvh);

}  // namespace fragtrace
