// SPDX-License-Identifier: MIT
#include "bvh/scene_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <queue>
#include <utility>

#include "base/vectors.h"
#include "scene/motion/moving_scene.h"

namespace fragtrace {

namespace {

using TriangleCorners = std::array<glm::dvec3, 3>;

/// A piece that may be cut, and the area that boxes lose by it.
struct PieceCut {
  double gain = 0.0;
  uint32_t item = 0;
  int axis = 0;
  double place = 0.0;

  bool operator<(const PieceCut& other) const {
    return gain != other.gain ? gain < other.gain : item > other.item;
  }
};

bool mayBeCut(const Material& m) { return !m.testsAlpha() && !m.transmissive() && !m.emissive(); }

/// The box of a long triangle has many times the area of its two sides.
bool isLong(const TriangleCorners& corners, const Bounds& box) {
  constexpr double kLeast = 16.0;
  const auto& [a, b, c] = corners;
  return areaOf(box) > kLeast * glm::length(glm::cross(b - a, c - a));
}

std::vector<uint32_t> longTriangles(const Scene& scene, std::span<const Bounds> boxes, const Bounds& all,
                                    double leastMet) {
  std::vector<uint32_t> found;
  double area = 0.0;
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    if (!mayBeCut(scene.materials[t.material]) || !isLong(cornersOf<glm::dvec3>(scene, t), boxes[i]))
      continue;
    found.push_back(i);
    area += areaOf(boxes[i]);
  }
  if (area < leastMet * areaOf(all)) found.clear();
  return found;
}

/// The first of the planes that halve a range again and again which lies between `low` and `high`.
double halvingPlane(double low, double high, double begin, double end) {
  for (;;) {
    const double middle = 0.5 * (begin + end);
    if ((middle > low && middle < high) || middle <= begin || middle >= end) return middle;
    (middle <= low ? begin : end) = middle;
  }
}

/// The box of a triangle between two planes across an axis, within another box of it. It is larger by what
/// rounding moves a hit: that goes with the size of the whole triangle (docs/design/numerics.md, Boxes).
Bounds boxBetween(const TriangleCorners& corners, const Bounds& within, int axis, double low, double high) {
  constexpr double kRounding = 16.0 * 0x1p-24;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  BoxOf<glm::dvec3> part;
  BoxOf<glm::dvec3> whole;
  for (size_t i = 0; i < 3; ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % 3];
    whole.include(a);
    if (a[axis] >= low && a[axis] <= high) part.include(a);
    for (const double plane : {low, high}) {
      if ((a[axis] < plane) == (b[axis] < plane)) continue;
      glm::dvec3 p = glm::mix(a, b, (plane - a[axis]) / (b[axis] - a[axis]));
      p[axis] = plane;
      part.include(p);
    }
  }
  const glm::dvec3 extent = whole.extent();
  const double margin = kRounding * std::max({extent.x, extent.y, extent.z});
  Bounds box;
  for (int i = 0; i < 3; ++i) {
    box.minimum[i] = std::max(std::nextafter(float(part.minimum[i] - margin), -kFar), within.minimum[i]);
    box.maximum[i] = std::min(std::nextafter(float(part.maximum[i] + margin), kFar), within.maximum[i]);
  }
  return box;
}

/// Both halves of a piece that is cut.
std::array<Bounds, 2> halvesOf(const TriangleCorners& corners, const Bounds& box, int axis, double place) {
  return {boxBetween(corners, box, axis, double(box.minimum[axis]), place),
          boxBetween(corners, box, axis, place, double(box.maximum[axis]))};
}

/// The cut of a piece across its longest axis.
PieceCut cutOfPiece(const Scene& scene, const BuildItem& piece, uint32_t item, const Bounds& all) {
  const TriangleCorners corners = cornersOf<glm::dvec3>(scene, scene.triangles[piece.primitive]);
  const glm::vec3 extent = piece.bounds.extent();
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const double place = halvingPlane(piece.bounds.minimum[axis], piece.bounds.maximum[axis], all.minimum[axis],
                                    all.maximum[axis]);
  const auto [first, second] = halvesOf(corners, piece.bounds, axis, place);
  return {areaOf(piece.bounds) - areaOf(first) - areaOf(second), item, axis, place};
}

}  // namespace

std::vector<BuildItem> cutLong(const Scene& scene, std::span<const Bounds> primitiveBounds, double leastMet) {
  std::vector<BuildItem> items;
  Bounds all;
  for (const Bounds& box : primitiveBounds) all.include(box);
  const std::vector<uint32_t> found = longTriangles(scene, primitiveBounds, all, leastMet);
  if (found.empty()) return items;
  const auto most = size_t(double(primitiveBounds.size()) * kMostPieces);
  items.reserve(most);
  for (uint32_t i = 0; i < primitiveBounds.size(); ++i) items.push_back({primitiveBounds[i], i});
  std::priority_queue<PieceCut> cuts;
  const auto offer = [&](uint32_t item) {
    const PieceCut cut = cutOfPiece(scene, items[item], item, all);
    if (cut.gain > 0.0) cuts.push(cut);
  };
  for (const uint32_t item : found) offer(item);
  while (items.size() < most && !cuts.empty()) {
    const PieceCut best = cuts.top();
    cuts.pop();
    BuildItem& piece = items[best.item];
    const TriangleCorners corners = cornersOf<glm::dvec3>(scene, scene.triangles[piece.primitive]);
    const auto [first, second] = halvesOf(corners, piece.bounds, best.axis, best.place);
    const uint32_t primitive = piece.primitive;
    piece.bounds = first;
    items.push_back({second, primitive});
    offer(best.item);
    offer(uint32_t(items.size() - 1));
  }
  return items;
}

std::vector<uint32_t> largeTriangles(std::span<const Bounds> primitiveBounds, uint32_t triangleCount) {
  constexpr double kShare = 0.02;
  constexpr size_t kMost = 32;
  Bounds all;
  for (const Bounds& box : primitiveBounds) all.include(box);
  std::vector<std::pair<double, uint32_t>> found;
  for (uint32_t i = 0; i < triangleCount; ++i) {
    const double area = areaOf(primitiveBounds[i]);
    if (area >= kShare * areaOf(all) && area > 0.0) found.emplace_back(-area, i);
  }
  std::ranges::sort(found);
  if (found.size() > kMost) found.resize(kMost);
  std::vector<uint32_t> large;
  large.reserve(found.size());
  for (const auto& [area, index] : found) large.push_back(index);
  std::ranges::sort(large);
  return large;
}

Bvh buildBvhBeside(std::span<const Bounds> primitiveBounds, uint32_t firstSingle,
                   std::span<const uint32_t> large) {
  std::vector<Bounds> others;
  std::vector<uint32_t> indices;
  others.reserve(primitiveBounds.size() - large.size());
  indices.reserve(others.capacity());
  size_t next = 0;
  for (uint32_t i = 0; i < primitiveBounds.size(); ++i) {
    if (next < large.size() && large[next] == i) {
      ++next;
      continue;
    }
    others.push_back(primitiveBounds[i]);
    indices.push_back(i);
  }
  Bvh bvh = buildBvh(others, firstSingle - uint32_t(large.size()));
  for (BvhLeaf& leaf : bvh.leaves) {
    for (uint32_t& primitive : leaf.primitive)
      if (primitive != kMissIndex) primitive = indices[primitive];
  }
  for (size_t i = 0; i < large.size(); i += 2) {
    bvh.leaves.push_back({{large[i], i + 1 < large.size() ? large[i + 1] : kMissIndex}});
    ++bvh.besideTree;
  }
  for (const uint32_t i : large) bvh.bounds.include(primitiveBounds[i]);
  return bvh;
}

namespace {

/// Boxes of primitives in a pose: triangles first, then spheres.
std::vector<Bounds> boundsInPose(const Scene& scene, uint32_t pose) {
  const ShutterMotion& motion = scene.motion;
  std::vector<Bounds> bounds;
  bounds.reserve(motion.triangles + motion.spheres);
  for (uint32_t i = 0; i < motion.triangles; ++i) {
    Triangle t = scene.triangles[i];
    t.vertex += pose * motion.vertices;
    Bounds box;
    for (const glm::vec3& corner : cornersOf(scene, t)) box.include(corner);
    bounds.push_back(box);
  }
  for (uint32_t i = 0; i < motion.spheres; ++i)
    bounds.push_back(sphereBounds(scene.spheres[pose * motion.spheres + i]));
  return bounds;
}

/// The primitive of a segment, from its index in the boxes of the segment.
uint32_t primitiveIn(const Scene& scene, uint32_t segment, uint32_t primitive) {
  const ShutterMotion& motion = scene.motion;
  if (primitive == kMissIndex) return primitive;
  if (primitive < motion.triangles) return segment * motion.triangles + primitive;
  return uint32_t(scene.triangles.size()) + segment * motion.spheres + primitive - motion.triangles;
}

constexpr uint32_t kRoom = 3;  // levels more than a tree of halves has, for the heuristic

uint32_t levelsOf(uint64_t leaves) { return uint32_t(std::bit_width(std::max<uint64_t>(leaves, 1) - 1)); }

std::vector<Bvh> buildMeshes(const Scene& scene, uint32_t maxDepth) {
  std::vector<Bvh> trees;
  for (const SharedMesh& mesh : scene.sharedMeshes) {
    std::vector<Bounds> boxes;
    boxes.reserve(mesh.triangleCount);
    for (uint32_t i = 0; i < mesh.triangleCount; ++i)
      boxes.push_back(triangleBounds(scene, mesh.firstTriangle + i));
    trees.push_back(buildBvh(std::move(boxes), mesh.triangleCount, {.maxDepth = maxDepth}));
    collapse(trees.back());
  }
  return trees;
}

/// Boxes that together hold a mesh more closely than its own box: those a few levels down its tree.
void collectParts(const Bvh& bvh, uint32_t node, uint32_t levels, std::vector<Bounds>& parts) {
  for (int side = 0; side < 2; ++side) {
    const uint32_t child = bvh.nodes[node].child[side];
    if ((child & kBvhLeafBit) != 0 || levels == 0) {
      parts.push_back(bvh.nodes[node].bounds[side]);
    } else {
      collectParts(bvh, child, levels - 1, parts);
    }
  }
}

BoundsDouble boxOf(const Instance& instance, const std::vector<Bounds>& parts) {
  BoundsDouble box;
  for (const Bounds& part : parts) {
    for (unsigned i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1u) != 0 ? part.maximum.x : part.minimum.x,
                              (i & 2u) != 0 ? part.maximum.y : part.minimum.y,
                              (i & 4u) != 0 ? part.maximum.z : part.minimum.z);
      box.include(glm::dvec3(instance.toLocal * glm::dvec4(corner, 1.0)));
    }
  }
  return box;
}

/// Widens a box by the distance by which rounding moves a ray that is transformed into the mesh's space, from
/// anywhere in a scene of that size and its surroundings (docs/design/numerics.md). Rounds it outwards.
Bounds padded(const BoundsDouble& box, const Instance& instance, double sceneSize) {
  constexpr double kUnit = 0x1p-24;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const glm::dmat3 linear(instance.toLocal);
  const double uneven = rowNorm(linear) * rowNorm(glm::inverse(linear));
  const glm::dvec3 place = glm::abs(glm::dvec3(instance.toLocal[3]));
  const double pad =
      kUnit * (16.0 * uneven * sceneSize + 4.0 * (rowNorm(linear) + std::max({place.x, place.y, place.z})));
  Bounds result;
  for (int axis = 0; axis < 3; ++axis) {
    result.minimum[axis] = std::nextafter(float(box.minimum[axis] - pad), -kInfinity);
    result.maximum[axis] = std::nextafter(float(box.maximum[axis] + pad), kInfinity);
  }
  return result;
}

std::vector<Bounds> instanceBoxes(const Scene& scene, const std::vector<Bvh>& trees, BoundsDouble all) {
  constexpr uint32_t kLevels = 5;
  std::vector<std::vector<Bounds>> parts(trees.size());
  for (size_t i = 0; i < trees.size(); ++i) collectParts(trees[i], 0, kLevels, parts[i]);
  std::vector<BoundsDouble> boxes;
  boxes.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    boxes.push_back(boxOf(instance, parts[instance.mesh]));
    all.include(boxes.back());
  }
  const glm::dvec3 extent = all.extent();
  const double size = std::max({extent.x, extent.y, extent.z});
  std::vector<Bounds> result;
  result.reserve(boxes.size());
  for (size_t i = 0; i < boxes.size(); ++i) result.push_back(padded(boxes[i], scene.instances[i], size));
  return result;
}

/// Builds the upper level, in which leaves of one instance become references to it.
Bvh buildTop(const Scene& scene, const std::vector<Bvh>& trees, uint32_t maxDepth) {
  const uint32_t flat = flatTriangleCount(scene);
  const auto instances = uint32_t(scene.instances.size());
  std::vector<Bounds> boxes;
  boxes.reserve(flat + instances + scene.spheres.size());
  BoundsDouble all;
  const auto include = [&](const Bounds& box) {
    all.include(glm::dvec3(box.minimum));
    all.include(glm::dvec3(box.maximum));
    return box;
  };
  for (uint32_t i = 0; i < flat; ++i) boxes.push_back(include(triangleBounds(scene, i)));
  for (const Sphere& sphere : scene.spheres) include(sphereBounds(sphere));
  for (const Bounds& box : instanceBoxes(scene, trees, all)) boxes.push_back(box);
  for (const Sphere& sphere : scene.spheres) boxes.push_back(sphereBounds(sphere));
  Bvh bvh = buildBvh(std::move(boxes), flat, {.maxDepth = maxDepth});

  std::vector<uint32_t> childOf(bvh.leaves.size());
  std::vector<BvhLeaf> kept;
  for (size_t i = 0; i < bvh.leaves.size(); ++i) {
    BvhLeaf leaf = bvh.leaves[i];
    if (leaf.primitive[0] >= flat && leaf.primitive[0] - flat < instances) {
      childOf[i] = kBvhLeafBit | kBvhInstanceBit | (leaf.primitive[0] - flat);
      continue;
    }
    if (leaf.primitive[0] >= flat) leaf.primitive[0] += uint32_t(scene.triangles.size()) - flat - instances;
    childOf[i] = kBvhLeafBit | uint32_t(kept.size());
    kept.push_back(leaf);
  }
  for (BvhNode& node : bvh.nodes) {
    for (uint32_t& child : node.child) {
      if ((child & kBvhLeafBit) != 0) child = childOf[child & ~kBvhLeafBit];
    }
  }
  bvh.leaves = std::move(kept);
  collapse(bvh);
  return bvh;
}

void appendMesh(const Bvh& tree, const SharedMesh& mesh, Bvh& bvh) {
  const auto nodes = uint32_t(bvh.nodes.size());
  const auto leaves = uint32_t(bvh.leaves.size());
  const auto wide = uint32_t(bvh.wide.size());
  bvh.meshes.push_back({nodes, wide, tree.bounds});
  for (WideNode node : tree.wide) {
    for (uint32_t& place : node.place) place += 2 * nodes;
    node.firstInner += wide;
    bvh.wide.push_back(node);
  }
  for (BvhNode node : tree.nodes) {
    for (uint32_t& child : node.child) child += (child & kBvhLeafBit) != 0 ? leaves : nodes;
    bvh.nodes.push_back(node);
  }
  for (BvhLeaf leaf : tree.leaves) {
    for (uint32_t& primitive : leaf.primitive) primitive += primitive == kMissIndex ? 0 : mesh.firstTriangle;
    bvh.leaves.push_back(leaf);
  }
}

Bounds boundsOfLeaf(const BvhLeaf& leaf, std::span<const Bounds> primitives) {
  Bounds bounds;
  for (const uint32_t primitive : leaf.primitive) {
    if (primitive != kMissIndex) bounds.include(primitives[primitive]);
  }
  return bounds;
}

/// Gives a tree of one level the boxes that its primitives have now.
void refitTo(Bvh& bvh, std::span<const Bounds> primitives) {
  // Children come after their parent.
  for (size_t i = bvh.nodes.size(); i-- > 0;) {
    BvhNode& node = bvh.nodes[i];
    for (size_t side : {0, 1}) {
      const uint32_t child = node.child[side];
      if ((child & kBvhLeafBit) != 0) {
        node.bounds[side] = boundsOfLeaf(bvh.leaves[child & ~kBvhLeafBit], primitives);
      } else {
        node.bounds[side] = bvh.nodes[child].bounds[0];
        node.bounds[side].include(bvh.nodes[child].bounds[1]);
      }
    }
  }
  bvh.bounds = Bounds();
  for (const BvhLeaf& leaf : bvh.leaves) bvh.bounds.include(boundsOfLeaf(leaf, primitives));
}

}  // namespace

Bvh buildMovingBvh(const Scene& scene) {
  const ShutterMotion& motion = scene.motion;
  const uint32_t middle = motion.segments / 2;
  std::vector<Bounds> whole = boundsInPose(scene, middle);
  const std::vector<Bounds> next = boundsInPose(scene, middle + 1);
  for (size_t i = 0; i < whole.size(); ++i) whole[i].include(next[i]);
  Bvh begins = buildBvh(std::move(whole), motion.triangles);
  Bvh ends = begins;
  const auto nodes = uint32_t(begins.nodes.size());
  const auto leaves = uint32_t(begins.leaves.size());
  Bvh all;
  all.depth = begins.depth;
  all.stackNeed = begins.stackNeed;
  const auto wide = uint32_t(begins.wide.size());
  for (uint32_t segment = 0; segment < motion.segments; ++segment) {
    refitTo(begins, boundsInPose(scene, segment));
    refitTo(ends, boundsInPose(scene, segment + 1));
    all.bounds.include(begins.bounds);
    all.bounds.include(ends.bounds);
    for (BvhNode node : begins.nodes) {
      for (uint32_t& child : node.child) child += segment * ((child & kBvhLeafBit) != 0 ? leaves : nodes);
      all.nodes.push_back(node);
    }
    for (WideNode node : begins.wide) {
      for (uint32_t& place : node.place) place += segment * 2 * nodes;
      node.firstInner += segment * wide;
      all.wide.push_back(node);
    }
    for (const BvhNode& node : ends.nodes) all.endBounds.push_back(node.bounds);
    for (BvhLeaf leaf : begins.leaves) {
      for (uint32_t& primitive : leaf.primitive) primitive = primitiveIn(scene, segment, primitive);
      all.leaves.push_back(leaf);
    }
  }
  return all;
}

bool fitsTwoLevels(uint64_t topPrimitives, uint64_t meshTriangles) {
  const uint32_t top = levelsOf(topPrimitives) + kRoom;
  const uint32_t below = levelsOf((meshTriangles + 1) / 2) + kRoom;
  return top <= kMaxBvhDepth && below <= kMaxBvhDepth && top + 1 + below <= kMaxTwoLevelDepth;
}

Bvh buildSceneBvh(const Scene& scene) {
  if (scene.instances.empty()) return buildBvh(primitiveBounds(scene), uint32_t(scene.triangles.size()));
  const uint64_t topPrimitives =
      uint64_t(flatTriangleCount(scene)) + scene.instances.size() + scene.spheres.size();
  const uint32_t reserved = levelsOf(topPrimitives) + kRoom + 1;
  assert(reserved < kMaxTwoLevelDepth);
  std::vector<Bvh> trees = buildMeshes(scene, std::min(kMaxBvhDepth, kMaxTwoLevelDepth - reserved));
  uint32_t below = 0;
  uint32_t stackBelow = 0;
  for (const Bvh& tree : trees) {
    below = std::max(below, tree.depth);
    stackBelow = std::max(stackBelow, tree.stackNeed);
  }
  Bvh bvh = buildTop(scene, trees, std::min(kMaxBvhDepth, kMaxTwoLevelDepth - 1 - below));
  for (size_t i = 0; i < trees.size(); ++i) {
    appendMesh(trees[i], scene.sharedMeshes[i], bvh);
    trees[i] = Bvh();
  }
  bvh.depth += 1 + below;
  bvh.stackNeed += 1 + stackBelow;
  return bvh;
}

RefittableTree refittable(Bvh bvh, const Scene& scene) {
  const double cost = bvhQuality(bvh).sahCost;
  return {std::move(bvh), cost, scene.triangles.size(), scene.spheres.size()};
}

std::optional<Bvh> refitted(const RefittableTree& tree, const Scene& scene) {
  const bool same = scene.triangles.size() == tree.triangles && scene.spheres.size() == tree.spheres;
  if (!same || tree.bvh.nodes.empty() || !tree.bvh.meshes.empty() || !scene.instances.empty())
    return std::nullopt;
  Bvh bvh = tree.bvh;
  refitTo(bvh, primitiveBounds(scene));
  if (!(bvhQuality(bvh).sahCost <= kMostRefitCost * tree.builtCost)) return std::nullopt;
  return bvh;
}

}  // namespace fragtrace
