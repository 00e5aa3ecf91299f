// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/vectors.h"
#include "scene/scene.h"

namespace fragtrace {

// A bounding-volume hierarchy. It is built, refitted and walked on the host as a binary one: inner nodes hold
// the boxes of both children, leaves hold one or two primitives. Shaders walk the same leaves by nodes of up
// to four children.

/// Set in BvhNode::child when the child is a leaf (the rest is the index into Bvh::leaves).
inline constexpr uint32_t kBvhLeafBit = 0x80000000u;

/// Set next to kBvhLeafBit when the child is an instance (the rest is the index into Scene::instances).
inline constexpr uint32_t kBvhInstanceBit = 0x40000000u;

/// No path from the root passes more inner nodes of the binary tree than this, so a traversal stack of this
/// size cannot overflow.
inline constexpr uint32_t kMaxBvhDepth = 32;

/// The same for a path through an instance into the tree of its mesh; the way back counts as one more.
inline constexpr uint32_t kMaxTwoLevelDepth = 48;

struct BvhNode {
  std::array<Bounds, 2> bounds;
  std::array<uint32_t, 2> child{0, 0};
};

struct BvhLeaf {
  std::array<uint32_t, 2> primitive{kMissIndex, kMissIndex};  ///< the second may be kMissIndex
};

/// A node of the tree that shaders walk. A child is a place in the binary tree: 2 * node + side. Inner
/// children come first and stand one after the other in Bvh::wide; leaves do so in Bvh::leaves. An instance
/// is the one child of its node.
struct WideNode {
  static constexpr uint32_t kMost = 4;
  std::array<uint32_t, kMost> place{};
  uint32_t firstInner = 0;
  uint16_t innerCount = 0;
  uint16_t count = 0;  ///< children
};

/// The tree of a shared mesh, in the mesh's space.
struct BvhMesh {
  uint32_t root = 0;      ///< its first node
  uint32_t wideRoot = 0;  ///< the same in Bvh::wide
  Bounds bounds;
};

/// Node 0 is the root. There are no nodes only if there are no primitives; with one leaf, both children of
/// the root are that leaf. Children always come after their parent.
struct Bvh {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
  /// The boxes of each node at the end of its segment, if surfaces move (bvh/scene_tree.h).
  std::vector<std::array<Bounds, 2>> endBounds{};
  std::vector<WideNode>
      wide{};  ///< none for a list of leaves; the root is node 0, and children come after their parent
  uint32_t besideTree = 0;  ///< leaves at the end to which no node refers: see scene_tree.h
  uint32_t depth = 0;  ///< inner nodes on the longest path from the root, at most kMaxBvhDepth; with meshes
                       ///< kMaxTwoLevelDepth
  uint32_t stackNeed = 0;  ///< the most entries that a walk of `wide` has on its stack, less than depth
  Bounds bounds;
  std::vector<BvhMesh>
      meshes;  ///< shared meshes by Instance::mesh; their nodes and leaves stand behind the scene's
};

inline uint32_t childAt(const Bvh& bvh, uint32_t place) { return bvh.nodes[place / 2].child[place % 2]; }

inline const Bounds& boxAt(const Bvh& bvh, uint32_t place) { return bvh.nodes[place / 2].bounds[place % 2]; }

/// Returns true if the node's one child is an instance.
inline bool showsInstance(const Bvh& bvh, const WideNode& node) {
  return node.innerCount == 0 && (childAt(bvh, node.place[0]) & kBvhInstanceBit) != 0;
}

/// Wide nodes of the tree in local space.
inline size_t topWideCount(const Bvh& bvh) {
  return bvh.meshes.empty() ? bvh.wide.size() : bvh.meshes[0].wideRoot;
}

/// The primitive in a leaf slot (leaf * 2 + side), as shaders name hits; kMissIndex for a negative one.
inline uint32_t primitiveInSlot(const Bvh& bvh, int32_t slot) {
  return slot < 0 ? kMissIndex : bvh.leaves.at(size_t(slot) / 2).primitive[size_t(slot) % 2];
}

/// Builds the tree by binned SAH over the primitives' boxes, on all cores. Primitives from firstSingle on
/// (spheres) always get a leaf of their own. Deterministic: the same boxes give the same tree. Boxes that are
/// moved in are freed before the nodes are made. The build takes another 40 bytes a primitive besides the
/// tree.
Bvh buildBvh(std::vector<Bounds> primitiveBounds, uint32_t firstSingle);

/// Boxes of the scene's primitives: triangles first, then spheres.
std::vector<Bounds> primitiveBounds(const Scene& scene);
Bounds triangleBounds(const Scene& scene, uint32_t triangle);
Bounds sphereBounds(const Sphere& sphere);

struct BvhQuality {
  double sahCost = 0.0;    ///< expected node visits + leaf visits of a random ray through the root's box
  uint32_t nodeCount = 0;  ///< wide nodes, which these numbers are about
  uint32_t leafCount = 0;
  uint32_t depth = 0;
  double primitivesPerLeaf = 0.0;
  uint32_t meshNodeCount = 0;  ///< nodes that belong to shared meshes
};
BvhQuality bvhQuality(const Bvh& bvh);

/// Returns true if both levels together fit kMaxTwoLevelDepth: a tree over `topPrimitives` primitives and
/// instances, and a tree over `meshTriangles` triangles.
bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles);

/// Without instances it has one level, as buildBvh(primitiveBounds()) builds it. Meshes of instances must
/// fulfil fitsTwoLevels().
Bvh buildSceneBvh(const Scene& scene);

// A tree of which some primitives are left out.

/// Leaves out primitives, the marked ones of the first. Nodes, leaves and slots keep their numbers: a child
/// that holds nothing has an empty box (BvhLeaf: kMissIndex), and rays do not visit it.
Bvh pruned(Bvh bvh, const std::vector<bool>& leftOut);

}  // namespace fragtrace
