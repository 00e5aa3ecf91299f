// SPDX-License-Identifier: MIT
// stack_text.h and shaders/tree.glsl: the stack, and nodes and leaves as they are packed.
#include <gtest/gtest.h>

#include "shader_scenes.h"

namespace fragtrace {
namespace {

// ---- the stack ----

TEST(ShaderStack, PushesAndPopsAsAVectorDoesAtEverySize) {
  for (uint32_t size : kBvhStackSizes) {
    const With stackSize(glsl_variant::kStackSize, int(size));
    Draw draw(size);
    glsl_float::Stack stack = glsl_float::emptyStack();
    std::vector<int> expected;
    for (int k = 0; k < 20000; ++k) {
      ASSERT_EQ(glsl_float::topOf(stack), expected.empty() ? layout::kTraversalDone : expected.back());
      // Mostly up, then mostly down, so that it fills and empties.
      const bool up = draw.integer(0, 9) < (k / 100 % 2 == 0 ? 7 : 3);
      const bool push = up && expected.size() < size;
      const bool pop = !up && !expected.empty();
      stack = glsl_float::stepStack(stack, push, pop, k);
      if (push) expected.push_back(k);
      if (pop) expected.pop_back();
    }
    while (expected.size() < size) {
      expected.push_back(int(expected.size()));
      stack = glsl_float::stepStack(stack, true, false, expected.back());
    }
    for (; !expected.empty(); expected.pop_back()) {
      ASSERT_EQ(glsl_float::topOf(stack), expected.back()) << "size " << size;
      stack = glsl_float::stepStack(stack, false, true, 0);
    }
    EXPECT_EQ(glsl_float::topOf(stack), layout::kTraversalDone);
  }
}

TEST(ShaderTree, DecodedBoxesHoldThePackedOnes) {
  for (const NamedTree& named : namedTrees()) {
    const PackedTree& p = named.tree;
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
    for (size_t i = 0; i < p.bvh.nodes.size(); ++i) {
      const auto n = glsl_float::loadNode(int(i));
      const std::array low = {n.low0, n.low1};
      const std::array high = {n.high0, n.high1};
      const std::array child = {n.child0, n.child1};
      for (size_t side = 0; side < 2; ++side) {
        const Bounds& box = p.bvh.nodes[i].bounds[side];
        for (int axis = 0; axis < 3; ++axis) {
          const double origin = p.grid.origin[axis];
          const double cell = p.grid.cell[axis];
          // An eighth of a cell is left for the rounding of the slab test (docs/design/numerics.md).
          constexpr double kPadding = 0.125 - 1e-6;
          EXPECT_LE(origin + cell * (low[side][axis] + kPadding), box.minimum[axis]) << named.name;
          EXPECT_GE(origin + cell * (high[side][axis] - kPadding), box.maximum[axis]) << named.name;
          // The boxes are not too large either: by at most two cells on each side.
          EXPECT_GT(origin + cell * (low[side][axis] + 2.0), box.minimum[axis]) << named.name;
          EXPECT_LT(origin + cell * (high[side][axis] - 2.0), box.maximum[axis]) << named.name;
        }
        const uint32_t packed = p.bvh.nodes[i].child[side];
        EXPECT_EQ(child[side], (packed & kBvhLeafBit) != 0 ? ~int(packed & ~kBvhLeafBit) : int(packed));
      }
    }
  }
}

TEST(ShaderTree, LeafSlotsHoldThePrimitivesOfTheirLeaves) {
  const PackedTree p = packTree(randomTriangles(101, 0.2f), randomSpheres(7, 1));
  const With leaves(glsl_variant::leaves, std::span<const uint32_t>(p.leaves));
  size_t found = 0;
  for (size_t slot = 0; slot < p.bvh.leaves.size() * 2; ++slot) {
    const auto leaf = glsl_float::loadLeaf(int(slot / 2));
    const bool second = slot % 2 == 1;
    const auto v0 = second ? leaf.v0b : leaf.v0a;
    const auto v1 = second ? leaf.v1b : leaf.v1a;
    const auto v2 = second ? leaf.v2b : leaf.v2a;
    const uint32_t word = second ? leaf.wordb : leaf.worda;
    const uint32_t expected = p.primitiveOf(int(slot));
    if (expected == kMissIndex) {
      EXPECT_EQ(word, layout::kPrimitiveNone);
      continue;
    }
    ++found;
    const bool sphere = expected >= p.scene.triangles.size();
    EXPECT_EQ((word & layout::kPrimitiveSphere) != 0, sphere);
    EXPECT_EQ((word & layout::kPrimitiveCull) != 0, sphere);  // material 1 is the single-sided one
    if (sphere) {
      const Sphere& s = p.scene.spheres[expected - p.scene.triangles.size()];
      EXPECT_EQ(v0, s.center);
      EXPECT_EQ(v1.x, s.radius);
    } else {
      const glm::uvec3 v = p.scene.triangles[expected].vertex;
      EXPECT_EQ(v0, p.scene.vertices.position[v.x]);
      EXPECT_EQ(v1, p.scene.vertices.position[v.y]);
      EXPECT_EQ(v2, p.scene.vertices.position[v.z]);
    }
  }
  EXPECT_EQ(found, 108u);
}

}  // namespace
}  // namespace fragtrace
