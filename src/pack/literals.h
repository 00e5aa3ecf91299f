// SPDX-License-Identifier: MIT
// Scenes so small that they become part of the shader's text: no tree, no reads.
#pragma once

#include <string>

#include "pack/gpu_scene.h"

namespace fragtrace {

/// Why a scene cannot be literals: spheres, nothing, or too many triangles, materials or emitters. Empty when
/// it can.
std::string whyNoLiterals(const Scene& scene, const GpuScene& packed);

/// Returns true if drawing `paths` paths with every triangle as a literal takes less time than walking the
/// tree. It weighs the expected instructions of both and the longer compilation (docs/design/traversal.md).
/// Scenes with spheres, or with too many faces, materials or emitters to choose from, are never drawn so.
bool paysAsLiterals(const Scene& scene, const Bvh& bvh, const GpuScene& packed, double paths);

/// Returns true if a tree without the large triangles, which are then tested first, takes less work than a
/// tree of all.
bool paysBeside(const Bvh& tree, const Bvh& beside);

/// The text for a tree with triangles beside it (Bvh::besideTree): only these are literals.
std::string largeFirst(const Scene& scene, const Bvh& bvh, const ShaderVariant& variant);

/// The text that replaces shaders/literals.glsl for this scene. Triangles that share a vertex share its
/// projection, and those that share an edge share its edge function, so the tests are as watertight as those
/// of the tree. Two triangles that make a parallelogram are one test.
std::string literalScene(const Scene& scene, const Bvh& bvh, const GpuScene& packed,
                         const ShaderVariant& variant);

}  // namespace fragtrace
