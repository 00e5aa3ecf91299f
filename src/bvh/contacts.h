// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "bvh/bvh.h"
#include "scene/scene.h"
#include "scene/solids.h"

namespace fragtrace {

/// Calls `meet` for each primitive of a tree whose box overlaps the box.
template <typename Meet>
void meetAll(const Bvh& bvh, const Bounds& box, const Meet& meet) {
  std::vector<uint32_t> open{0};
  while (!open.empty()) {
    const BvhNode& node = bvh.nodes[open.back()];
    open.pop_back();
    // A root with one leaf has it as both children.
    const size_t sides = node.child[0] == node.child[1] ? 1 : 2;
    for (size_t side = 0; side < sides; ++side) {
      if (!box.overlaps(node.bounds[side])) continue;
      if ((node.child[side] & kBvhLeafBit) == 0) {
        open.push_back(node.child[side]);
        continue;
      }
      for (const uint32_t primitive : bvh.leaves[node.child[side] & ~kBvhLeafBit].primitive)
        if (primitive != kMissIndex) meet(primitive);
    }
  }
}

// Faces that lie on glass, solids that touch, and lamps that lie in surfaces.

/// A ray that leaves glass starts a little beyond its face (docs/design/ray-origins.md), and so beyond an
/// opaque face in the same place. So opaque triangles that lie on a triangle of glass, or nearer to it than
/// four offsets, are moved that far off it, with all opaque triangles that share their corners: outwards from
/// solid glass, and back from their own front where the glass is thin. Instances of shared meshes and spheres
/// stay where they are. Returns the number of triangles that lay on glass.
size_t partFromGlass(Scene& scene);

/// A ray that leaves a solid starts a little beyond its face, and so beyond the face of another solid in the
/// same place, such as that of water that fills a glass. Where faces of two parts of solids coincide or lie
/// nearer than four offsets, those of the smaller part are moved inwards by so much. Instances of shared
/// meshes and spheres stay where they are.
void partSolids(Scene& scene, const std::vector<SolidPart>& parts);

/// Marks emissive triangles with which another surface coincides (scene/coincidence.h).
void markLampsInSurfaces(Scene& scene);

// Glass that has a thickness and bounds no solid.

/// Makes thin walls of open parts of solid glass that are panes, and takes them out of the parts: parts that
/// are flat within a thickness of at most a twentieth of their size, or whose open edges, for the most part,
/// are nearer than a thousandth of their size to no other surface. A part under which another surface lies
/// within its thickness, as the bed of a water does, stays a solid. A part is what hangs together by common
/// edges; shared meshes are left alone. Their triangles get copies of their materials, behind all others,
/// without thickness. Returns the number of such parts by the material's place.
std::map<std::string, size_t> thinOpenPanes(Scene& scene, std::vector<SolidPart>& parts);

}  // namespace fragtrace
