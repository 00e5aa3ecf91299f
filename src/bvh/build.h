// SPDX-License-Identifier: MIT
// The settings behind buildBvh(), for tests and measurements.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bvh/bvh.h"
#include "bvh/split.h"

namespace fragtrace {

/// Sizes in which the shader's stack (src/shader/stack_text.h) comes; each step up was measured to cost 4 to
/// 7 % of the time on llvmpipe.
inline constexpr std::array<uint32_t, 6> kBvhStackSizes{8, 12, 16, 20, 24, kMaxBvhDepth};

struct BvhBuildSettings {
  uint32_t threadCount = 0;          ///< 0: all cores; the tree is the same for any number
  uint32_t maxDepth = kMaxBvhDepth;  ///< must leave room for the primitives: 2^maxDepth leaves
};

/// Builds the binary tree alone; collapse() adds the wide nodes.
Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle, const BvhBuildSettings& settings);

/// The whole tree over items, of which a primitive may have several.
Bvh buildFromItems(std::vector<BuildItem> items, uint32_t firstSingle);

}  // namespace fragtrace
