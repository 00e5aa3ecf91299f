// SPDX-License-Identifier: MIT
// A tree over lights. The shader descends it to choose one by what it may send to a point
// (scene/light_bounds.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/words.h"
#include "scene/light_bounds.h"

namespace fragtrace {

/// A node's children are neighbours, `child` and `child` + 1. In a leaf, `light` is the index of its one
/// light.
struct LightNode {
  LightBounds bounds;
  uint32_t child = 0;
  uint32_t light = kMissIndex;
  uint32_t parent = kMissIndex;
};

/// The root comes first; 2 n - 1 nodes for n lights, none for none.
std::vector<LightNode> buildLightTree(std::span<const LightBounds> lights);

/// layout.glsl: light nodes. `emitters` holds a word for each light of a leaf: its emitters.
void appendLightNodes(std::vector<uint32_t>& words, std::span<const LightNode> nodes,
                      std::span<const uint32_t> emitters);

}  // namespace fragtrace
