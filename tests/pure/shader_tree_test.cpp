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
    std::vector<uint32_t> expected;
    for (int k = 0; k < 20000; ++k) {
      ASSERT_EQ(glsl_float::topOf(stack), expected.empty() ? layout::kEndGroup : expected.back());
      // Mostly up, then mostly down, so that it fills and empties.
      const bool up = draw.integer(0, 9) < (k / 100 % 2 == 0 ? 7 : 3);
      const bool push = up && expected.size() < size;
      const bool pop = !up && !expected.empty();
      stack = glsl_float::stepStack(stack, push, pop, uint32_t(k));
      if (push) expected.push_back(uint32_t(k));
      if (pop) expected.pop_back();
    }
    while (expected.size() < size) {
      expected.push_back(uint32_t(expected.size()));
      stack = glsl_float::stepStack(stack, true, false, expected.back());
    }
    for (; !expected.empty(); expected.pop_back()) {
      ASSERT_EQ(glsl_float::topOf(stack), expected.back()) << "size " << size;
      stack = glsl_float::stepStack(stack, false, true, 0);
    }
    EXPECT_EQ(glsl_float::topOf(stack), layout::kEndGroup);
  }
}

/// Holds the box of a node's child against the exact one, along an axis.
void checkSides(float low, float high, const Bounds& box, float origin, float cell, int axis) {
  const double from = double(origin) + double(cell) * double(low);
  const double to = double(origin) + double(cell) * double(high);
  const double least = box.minimum[axis];
  const double most = box.maximum[axis];
  EXPECT_LE(from, least);
  EXPECT_GE(to, most);
  // The boxes are not too large either.
  EXPECT_TRUE(from == least || from + double(cell) > least);
  EXPECT_TRUE(to == most || to - double(cell) < most);
}

TEST(ShaderTree, DecodedBoxesHoldThePackedOnes) {
  for (const NamedTree& named : namedTrees()) {
    SCOPED_TRACE(named.name);
    const PackedTree& p = named.tree;
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
    ASSERT_FALSE(p.bvh.wide.empty());
    for (size_t i = 0; i < p.bvh.wide.size(); ++i) {
      const WideNode& wide = p.bvh.wide[i];
      // A ray along the diagonal meets the low sides first, or the high ones.
      for (const float sign : {1.0f, -1.0f}) {
        const auto n = glsl_float::loadNode(int(i), vec3(sign));
        const std::array near{n.nearX, n.nearY, n.nearZ};
        const std::array far{n.farX, n.farY, n.farZ};
        const auto& low = sign > 0.0f ? near : far;
        const auto& high = sign > 0.0f ? far : near;
        for (int k = 0; k < wide.count; ++k) {
          for (int axis = 0; axis < 3; ++axis)
            checkSides(low[size_t(axis)][k], high[size_t(axis)][k], boxAt(p.bvh, wide.place[size_t(k)]),
                       n.origin[axis], n.cell[axis], axis);
        }
        // Cells are no larger than the boxes need.
        for (int axis = 0; axis < 3; ++axis) {
          const float most = std::max(
              {high[size_t(axis)].x, high[size_t(axis)].y, high[size_t(axis)].z, high[size_t(axis)].w});
          EXPECT_TRUE(most >= 127.0f || n.cell[axis] < 0x1p-99f) << most;
        }
      }
    }
  }
}

TEST(ShaderTree, GroupsNameTheChildrenOfTheirNodes) {
  for (const NamedTree& named : namedTrees()) {
    SCOPED_TRACE(named.name);
    const PackedTree& p = named.tree;
    const With nodes(glsl_variant::nodes, std::span<const uint32_t>(p.nodes));
    for (size_t i = 0; i < p.bvh.wide.size(); ++i) {
      const WideNode& wide = p.bvh.wide[i];
      const auto n = glsl_float::loadNode(int(i), vec3(1.0f));
      for (uint32_t k = 0; k < WideNode::kMost; ++k) {
        const uint32_t bit = layout::kFirstChild << k;
        EXPECT_EQ((n.inner & bit) != 0, k < wide.innerCount);
        EXPECT_EQ((n.leaves & bit) != 0, k >= wide.innerCount && k < wide.count);
        if (k < wide.innerCount) {
          EXPECT_EQ(glsl_float::baseOf(n.inner) + int(k), int(wide.firstInner + k));
        } else if (k < wide.count) {
          glsl_float::Traversal s = glsl_float::startTraversal(1.0f, 1);
          s.leaves = n.leaves & (bit | layout::kBaseMask);
          EXPECT_EQ(uint32_t(glsl_float::leafOf(s)) | kBvhLeafBit, childAt(p.bvh, wide.place[k]));
        }
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
