// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/words.h"
#include "pack/gpu_scene.h"
#include "scene/light_bounds.h"

namespace fragtrace {

// A tree over lights. The shader descends it to choose one by what it may send to a point
// (scene/light_bounds.h).

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

/// Emissive triangles and punctual lights, drawn by power or by a tree.
struct PackedEmitters {
  Words entries;  ///< layout.glsl: emitters
  uint32_t count = 0;
  double power = 0.0;               ///< sum, watts of luminance
  std::vector<double> materialPdf;  ///< for each material, the pdf per square metre of its triangles
};

/// materialRadiance: mean radiance of each material's surface; slots: leaf slot of each triangle; slotCount:
/// that of the tree; radius: that of the scene.
PackedEmitters packEmitters(const Scene& scene, std::span<const glm::vec3> materialRadiance,
                            std::span<const uint32_t> slots, size_t slotCount, double radius,
                            const ShaderVariant& variant);

/// Punctual lights, kLightRows vec4 each.
Words packLights(const Scene& scene);

}  // namespace fragtrace
