// SPDX-License-Identifier: MIT
#include "bvh/outlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bvh_triangles.h"
#include "image/display/heatmap.h"

namespace fragtrace {
namespace {

Bvh treeOf(size_t triangles) { return buildBvh(boxesOf(randomTriangles(triangles, 0.05f)), kNoSingles); }

bool within(const Bounds& inner, const Bounds& outer) {
  return glm::all(glm::greaterThanEqual(inner.minimum, outer.minimum)) &&
         glm::all(glm::lessThanEqual(inner.maximum, outer.maximum));
}

TEST(TreeBoxes, EachLevelLiesWithinTheOneAbove) {
  const Bvh bvh = treeOf(500);
  std::vector<Bounds> above = boxesAtLevel(bvh, 0);
  ASSERT_EQ(above.size(), 1u);
  EXPECT_EQ(above[0].minimum, bvh.bounds.minimum);
  EXPECT_EQ(above[0].maximum, bvh.bounds.maximum);
  size_t boxes = 1;
  const uint32_t depth = bvhQuality(bvh).depth;
  for (uint32_t level = 1; level <= depth; ++level) {
    const std::vector<Bounds> here = boxesAtLevel(bvh, level);
    EXPECT_LE(here.size(), 4 * above.size());
    EXPECT_FALSE(here.empty()) << level;
    for (const Bounds& box : here) {
      EXPECT_TRUE(std::ranges::any_of(above, [&](const Bounds& outer) { return within(box, outer); }));
    }
    boxes += here.size();
    above = here;
  }
  // Every inner node and every leaf is on one level.
  EXPECT_EQ(boxes, bvh.wide.size() + bvh.leaves.size());
  EXPECT_TRUE(boxesAtLevel(bvh, depth + 1).empty());
}

TEST(TreeBoxes, OfTinyTreesAreWhatThereIs) {
  EXPECT_TRUE(boxesAtLevel({}, 0).empty());
  const Bvh one = treeOf(1);
  EXPECT_EQ(boxesAtLevel(one, 0).size(), 1u);
  EXPECT_EQ(boxesAtLevel(one, 1).size(), 1u);
  EXPECT_TRUE(boxesAtLevel(one, 2).empty());
}

/// Looks along -z from z = 3 with a view angle of 90 degrees.
Projection frontView() {
  Camera camera;
  camera.position = {0, 0, 3};
  camera.fovY = glm::radians(90.0);
  return projectionOf(camera, 1.0);
}

bool hasLine(const std::vector<PictureLine>& lines, glm::dvec2 a, glm::dvec2 b) {
  const auto near = [](glm::dvec2 p, glm::dvec2 q) { return glm::distance(p, q) < 1e-12; };
  return std::ranges::any_of(lines, [&](const PictureLine& l) {
    return (near(l.from, a) && near(l.to, b)) || (near(l.from, b) && near(l.to, a));
  });
}

TEST(BoxEdges, AreTwelveLinesWhereTheyAreSeen) {
  const std::vector<Bounds> boxes{{glm::vec3(-1, -1, -1), glm::vec3(1, 1, 1)}};
  const std::vector<PictureLine> lines = boxEdges(boxes, frontView(), {});
  ASSERT_EQ(lines.size(), 12u);
  // The front, 2 m away, spans half of the view, the back a quarter.
  EXPECT_TRUE(hasLine(lines, {-0.5, -0.5}, {0.5, -0.5}));
  EXPECT_TRUE(hasLine(lines, {0.5, 0.5}, {0.25, 0.25}));
  EXPECT_TRUE(hasLine(lines, {-0.25, 0.25}, {-0.25, -0.25}));
  // Moved with the origin.
  EXPECT_TRUE(hasLine(boxEdges(boxes, frontView(), {glm::dvec3(4, 0, 0)}), {1.5, -0.5}, {1.5, 0.5}));
}

TEST(BoxEdges, EndAtTheCamera) {
  // From behind the camera to 1 m in front of it: the four edges along z are cut, the four behind are gone.
  const std::vector<Bounds> boxes{{glm::vec3(-1, -1, 2), glm::vec3(1, 1, 5)}};
  const std::vector<PictureLine> lines = boxEdges(boxes, frontView(), {});
  EXPECT_EQ(lines.size(), 8u);
  for (const PictureLine& l : lines) {
    EXPECT_NEAR(std::abs(l.from.x), 1.0, 1e-12);
    EXPECT_GE(glm::dot(l.from, l.to), 0.0);  // none runs through the middle
  }
  EXPECT_TRUE(
      boxEdges(std::vector<Bounds>{{glm::vec3(-1, -1, 4), glm::vec3(1, 1, 5)}}, frontView(), {}).empty());
}

Image blank(int width, int height, std::vector<std::string> channels = {"R", "G", "B"}) {
  Image image{width, height, std::move(channels), {}, {}};
  image.values.resize(size_t(width) * size_t(height) * image.channelCount());
  return image;
}

size_t lit(const Image& image) {
  size_t count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += image.pixel(x, y)[1] == 0.5f ? 1 : 0;
  }
  return count;
}

const glm::vec3 kColor{1.0f, 0.5f, 0.25f};

TEST(DrawLine, CoversAPixelOfEachColumnOrRow) {
  Image image = blank(10, 8);
  drawLine(image, {1.5, 2.5}, {8.5, 5.5}, kColor);
  for (int x = 1; x <= 8; ++x) {
    size_t column = 0;
    for (int y = 0; y < 8; ++y) column += image.pixel(x, y)[0] == 1.0f ? 1 : 0;
    EXPECT_GE(column, 1u) << x;
    EXPECT_LE(column, 2u) << x;
  }
  EXPECT_EQ(image.pixel(1, 2)[2], 0.25f);
  EXPECT_EQ(image.pixel(8, 5)[1], 0.5f);
  EXPECT_EQ(image.pixel(0, 2)[0], 0.0f);
  EXPECT_EQ(image.pixel(9, 6)[0], 0.0f);
  Image upright = blank(10, 8);
  drawLine(upright, {4.5, 6.5}, {4.5, 1.5}, kColor);
  EXPECT_EQ(lit(upright), 6u);
}

TEST(DrawLine, LeavesOutWhatIsOutside) {
  Image image = blank(10, 8);
  drawLine(image, {-1e9, 3.5}, {1e9, 3.5}, kColor);
  EXPECT_EQ(lit(image), 10u);
  Image none = blank(10, 8);
  drawLine(none, {-5, -1}, {15, -1}, kColor);
  drawLine(none, {-5, 2}, {2, -5}, kColor);
  drawLine(none, {11, 0}, {11, 8}, kColor);
  drawLine(none, {std::nan(""), 0}, {5, 5}, kColor);
  drawLine(none, {0, 0}, {double(INFINITY), 5}, kColor);
  EXPECT_EQ(lit(none), 0u);
}

TEST(DrawLine, IsOpaque) {
  Image image = blank(4, 4, {"R", "G", "B", "A"});
  drawLine(image, {0.5, 0.5}, {3.5, 0.5}, kColor);
  EXPECT_EQ(image.pixel(2, 0)[3], 1.0f);
  EXPECT_EQ(image.pixel(2, 1)[3], 0.0f);
}

}  // namespace
}  // namespace fragtrace
