// SPDX-License-Identifier: MIT
#include "gltf/build/sharing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bvh/bvh.h"
#include "scene/strokes.h"

namespace fragtrace {
namespace {

// The scene's own copy, the tree over it, and what is packed for the device, which are not all there at once.
constexpr uint64_t kBytesOfAVertex = 100;
constexpr uint64_t kBytesOfATriangle = 150;
constexpr uint64_t kBytesOfAnInstance = 700;

using Mesh = std::vector<MeshPrimitive>;

/// The uses of one mesh in the scene.
struct MeshUse {
  const MeshPrimitive* first = nullptr;  ///< its first primitive that has triangles
  uint64_t triangles = 0;
  uint64_t bytes = 0;
  uint64_t places = 0;  ///< places in which it may be shared
  uint64_t allPlaces = 0;
  bool shines = false;
  bool isShared = false;
  size_t index = 0;  ///< among the shared ones

  uint64_t flatBytes() const { return places * bytes; }
  uint64_t sharedBytes() const { return bytes + places * kBytesOfAnInstance; }
};

MeshUse useOf(const Mesh& mesh, const std::vector<Material>& materials) {
  MeshUse use;
  for (const MeshPrimitive& primitive : mesh) {
    if (primitive.triangles.empty()) continue;
    if (use.first == nullptr) use.first = &primitive;
    use.triangles += primitive.triangles.size();
    use.bytes +=
        primitive.vertices.position.size() * kBytesOfAVertex + primitive.triangles.size() * kBytesOfATriangle;
    use.shines = use.shines || materials.at(primitive.triangles[0].material).emissive();
  }
  return use;
}

/// Returns false if a matrix scales too unevenly, judged by Frobenius norms. Their product is about 3 for
/// rotations, and larger for uneven scales.
bool isWellConditioned(const glm::dmat3& matrix) {
  constexpr double kMostUneven = 32.0;
  const glm::dmat3 inverse = glm::inverse(matrix);
  double squared = 0.0;
  double inverseSquared = 0.0;
  for (int c = 0; c < 3; ++c) {
    squared += glm::dot(matrix[c], matrix[c]);
    inverseSquared += glm::dot(inverse[c], inverse[c]);
  }
  return std::sqrt(squared) * std::sqrt(inverseSquared) <= kMostUneven;
}

using MeshUses = std::map<const Mesh*, MeshUse>;

bool mayShare(const PrimitiveInstance& i, const MeshUses& uses) {
  return i.whole != nullptr && !uses.at(i.whole).shines && isWellConditioned(glm::dmat3(i.world));
}

/// Counts the uses of each mesh in the scene.
MeshUses countUses(const std::vector<PrimitiveInstance>& instances, const std::vector<Material>& materials) {
  MeshUses uses;
  for (const PrimitiveInstance& i : instances) {
    const auto [use, isNew] = uses.try_emplace(i.whole);
    if (isNew && i.whole != nullptr) use->second = useOf(*i.whole, materials);
    if (i.primitive != use->second.first) continue;
    ++use->second.allPlaces;
    if (mayShare(i, uses)) ++use->second.places;
  }
  return uses;
}

/// Meshes that are shared, with their places, and all else as it is.
void part(std::vector<PrimitiveInstance> instances, MeshUses& uses, PlacedMeshes& placed) {
  for (PrimitiveInstance& i : instances) {
    MeshUse& use = uses.at(i.whole);
    if (!use.isShared || !mayShare(i, uses)) {
      placed.flat.push_back(std::move(i));
    } else if (i.primitive == use.first) {
      if (use.index == 0) {
        placed.shared.push_back({i.whole, i.mesh, {}});
        use.index = placed.shared.size();
      }
      placed.shared[use.index - 1].places.push_back({i.world, std::move(i.node), i.nodeIndex});
    }
  }
}

/// Names the meshes that are copied though the scene has them more than once; empty if there are none.
std::string copiesAmong(const MeshUses& uses) {
  uint64_t shining = 0;
  uint64_t uneven = 0;
  for (const auto& [mesh, use] : uses) {
    if (mesh == nullptr || use.allPlaces < 2) continue;
    shining += use.shines ? 1 : 0;
    uneven += use.shines ? 0 : use.allPlaces - use.places;
  }
  std::string text = shining > 0 ? "emissive meshes (" + std::to_string(shining) + ")" : "";
  if (shining > 0 && uneven > 0) text += ", ";
  if (uneven > 0) text += "unevenly scaled instances (" + std::to_string(uneven) + ")";
  return text;
}

std::string megabytes(uint64_t bytes) { return std::to_string((bytes + 500000) / 1000000) + " MB"; }

}  // namespace

bool paysToShare(const SharingCost& cost, uint64_t limit) {
  constexpr uint64_t kSmall = uint64_t(64) << 20;
  return cost.flat > kSmall && cost.shared < cost.flat && (cost.flat / 2 > cost.shared || cost.flat > limit);
}

PlacedMeshes chooseSharing(std::vector<PrimitiveInstance> instances, Instancing wanted,
                           const std::vector<Material>& materials, uint64_t limit) {
  SharingCost cost;
  uint64_t flatTriangles = 0;
  for (const PrimitiveInstance& i : instances) {
    const uint64_t strokes = i.primitive->strokes.ends.size();
    const uint64_t triangles = i.primitive->triangles.size() + trianglesOf(i.primitive->strokes);
    const uint64_t vertices = i.primitive->vertices.position.size() + strokes * kMostStrokeVertices;
    cost.flat += vertices * kBytesOfAVertex + triangles * kBytesOfATriangle;
    flatTriangles += triangles;
  }
  MeshUses uses = countUses(instances, materials);

  // Step: which of them would take less when shared.
  PlacedMeshes placed;
  cost.shared = cost.flat;
  uint64_t largest = 0;
  uint64_t instanceCount = 0;
  for (auto& [mesh, use] : uses) {
    const bool saves = use.sharedBytes() < use.flatBytes() / 2;
    use.isShared = use.places > 1 && (wanted == Instancing::Share || saves);
    if (!use.isShared) continue;
    cost.shared += use.sharedBytes();
    cost.shared -= use.flatBytes();
    largest = std::max(largest, use.triangles);
    instanceCount += use.places;
    flatTriangles -= use.places * use.triangles;
  }

  // Step: the choice for all of them.
  const std::string amounts = megabytes(cost.shared) + " in place of " + megabytes(cost.flat);
  bool isShared = false;
  if (wanted == Instancing::Flatten) {
    placed.reason = "--instancing flatten";
  } else if (instanceCount == 0) {
    placed.reason = "no mesh that can be shared appears often enough in the scene";
  } else if (!fitsTwoLevels(flatTriangles + instanceCount, largest)) {
    placed.reason = "two trees would be deeper than the stack";
  } else if (wanted == Instancing::Share) {
    isShared = true;
    placed.reason = "--instancing share: " + amounts;
  } else {
    isShared = paysToShare(cost, limit);
    placed.reason = (isShared ? "saves memory: " : "too little to save: ") + amounts;
  }
  placed.copies = wanted == Instancing::Flatten ? "" : copiesAmong(uses);
  placed.bytes = isShared ? cost.shared : cost.flat;
  if (!isShared) {
    placed.flat = std::move(instances);
    return placed;
  }

  part(std::move(instances), uses, placed);
  return placed;
}

}  // namespace fragtrace
