// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "bvh/bvh.h"
#include "pack/gpu_scene.h"
#include "scene/scene.h"

namespace fragtrace {

// The triangles of a small scene as a mesh of shared vertices, neighbours merged to quadrilaterals.

/// One test of a ray: a triangle or a convex quadrilateral.
struct LiteralFace {
  std::array<uint32_t, 4> corner{};  ///< indices of points, counter-clockwise seen from the front
  bool quad = false;                 ///< else the fourth corner is not there
  bool parallelogram = false;        ///< a quadrilateral that is one
  bool culled = false;               ///< its back is not there
  uint32_t slot = 0;        ///< leaf slot of the triangle; of a quadrilateral, of its first three corners
  uint32_t otherSlot = 0;   ///< leaf slot of a quadrilateral's other triangle
  uint32_t first = 0;       ///< the vertex of the triangle in `slot` that is the first corner
  uint32_t otherFirst = 0;  ///< the vertex of the other triangle that is the third corner
};

struct LiteralMesh {
  std::vector<glm::vec3> points;  ///< each place once
  std::vector<LiteralFace> faces;
};

/// The shapes that two triangles of the same plane, material and sides may form.
enum class Joining : uint8_t { None, Parallelograms, ConvexQuadrilaterals };

/// The triangles in the leaves from firstLeaf on. emissiveApart: triangles that emit light are not joined.
LiteralMesh literalMesh(const Scene& scene, const Bvh& bvh, uint32_t firstLeaf, Joining joining,
                        bool emissiveApart = false);

struct LiteralOptions {
  bool weights = false;  ///< barycentric ones are kept; the faces must be triangles or parallelograms then
  bool whole = false;    ///< there is nothing else to test
  bool passing =
      false;  ///< rays pass through surfaces: hits are ordered as by isNearer() of shaders/tree/leaf.glsl
  bool backFaces = false;  ///< light paths ask for the backs of single-sided faces
};

// Scenes so small that they become part of the shader's text: no tree, no reads.

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

/// The text for a tree with triangles next to it (Bvh::besideTree): only these are literals.
std::string largeFirst(const Scene& scene, const Bvh& bvh, const ShaderVariant& variant);

/// The text that replaces shaders/literals.glsl for this scene. Triangles that share a vertex share its
/// projection, and those that share an edge share its edge function, so the tests are as watertight as those
/// of the tree. Two triangles that make a parallelogram are one test.
std::string literalScene(const Scene& scene, const Bvh& bvh, const GpuScene& packed,
                         const ShaderVariant& variant);

}  // namespace fragtrace
