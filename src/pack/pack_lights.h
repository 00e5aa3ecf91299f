// SPDX-License-Identifier: MIT
#pragma once

#include "pack/gpu_scene.h"

namespace fragtrace {

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
