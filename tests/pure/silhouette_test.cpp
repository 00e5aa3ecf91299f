// SPDX-License-Identifier: MIT
#include "bvh/outlines.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "bvh/bvh.h"

namespace fragtrace {
namespace {

/// Node 2 is a square of 1 x 1 m about (0.5, 0.5, 0), node 5 below it a sphere of radius 1 about (10, 0, 0),
/// node 3 an instance of a shared triangle; node 7 stands next to them and is empty. All about a place far
/// away.
struct OutlinedScene {
  glm::dvec3 place{1000.0, 2000.0, -500.0};
  Scene scene;
  Camera camera;

  OutlinedScene() {
    scene.space.origin = place;
    scene.space.unit = 2.0;
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)})
      scene.vertices.position.emplace_back(0.5f * corner, 0.0f);
    scene.triangles = {{glm::uvec3(0, 1, 2)}, {glm::uvec3(0, 2, 3)}, {glm::uvec3(0, 1, 2)}};
    scene.origins = {{"square", "mesh", 0, 2, 2}, {"", "shared", 2, 1, 0}};
    scene.sharedMeshes = {{2, 1}};
    Instance instance;
    instance.toLocal[3] = glm::dvec4(3, 0, 0, 1);
    instance.nodeIndex = 3;
    scene.instances = {instance};
    scene.spheres.push_back({.center = glm::vec3(5, 0, 0), .radius = 0.5f, .nodeIndex = 5});
    scene.nodes = {{"square", 2, 0}, {"ball", 5, 1}, {"instance", 3, 0}, {"empty", 7, 0}};
    camera.position = place + glm::dvec3(0, 0, 2);
    camera.fovY = glm::radians(90.0);  // the picture is 4 m wide and high where the square is
  }

  std::vector<PictureLine> outline(uint32_t node, glm::ivec2 size) const {
    return outlineOfNodes(scene, nodesBelow(scene, node), projectionOf(camera, double(size.x) / size.y),
                          size);
  }
};

bool isLine(const PictureLine& line, glm::dvec2 from, glm::dvec2 to) {
  return glm::distance(line.from, from) < 1e-12 && glm::distance(line.to, to) < 1e-12;
}

TEST(Silhouette, TakesWhatIsBelowANode) {
  const OutlinedScene stage;
  const NodeSet nodes = nodesBelow(stage.scene, 2);
  EXPECT_EQ(nodes, NodeSet({false, false, true, false, false, true}));
  EXPECT_EQ(nodesBelow(stage.scene, 5), NodeSet({false, false, false, false, false, true}));
  EXPECT_TRUE(nodesBelow(stage.scene, 4).empty());
}

TEST(Silhouette, HasNoGapBetweenTheTrianglesOfASquare) {
  OutlinedScene stage;
  stage.camera.position = stage.place + glm::dvec3(0.5, 0.5, 2.08);
  stage.camera.fovY = glm::radians(60.0);
  const NodeSet square{false, false, true};
  for (int pixels = 16; pixels < 200; ++pixels) {
    const auto lines =
        outlineOfNodes(stage.scene, square, projectionOf(stage.camera, 1.0), glm::ivec2(pixels));
    EXPECT_EQ(lines.size(), 4u) << pixels;
  }
}

TEST(Silhouette, KnowsTheBox) {
  const OutlinedScene stage;
  const BoundsDouble instance = boundsOfNodes(stage.scene, nodesBelow(stage.scene, 3));
  EXPECT_EQ(instance.minimum, stage.place + glm::dvec3(6, 0, 0));
  EXPECT_EQ(instance.maximum, stage.place + glm::dvec3(7, 1, 0));
  const BoundsDouble both = boundsOfNodes(stage.scene, nodesBelow(stage.scene, 2));
  EXPECT_LE(glm::distance(both.minimum, stage.place + glm::dvec3(0, -1, -1)), 1e-9);
  EXPECT_LE(glm::distance(both.maximum, stage.place + glm::dvec3(11, 1, 1)), 1e-9);
  EXPECT_TRUE(boundsOfNodes(stage.scene, nodesBelow(stage.scene, 7)).empty());
}

TEST(Silhouette, RunsAlongThePixelsOfASquare) {
  OutlinedScene stage;
  stage.scene.spheres.clear();
  // Pixels of 0.5 m: two by two of them are covered, right of and above the middle.
  const std::vector<PictureLine> lines = stage.outline(2, {8, 8});
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_TRUE(isLine(lines[0], {0, 0.5}, {0.5, 0.5}));  // from the top
  EXPECT_TRUE(isLine(lines[1], {0, 0}, {0.5, 0}));
  EXPECT_TRUE(isLine(lines[2], {0, 0.5}, {0, 0}));
  EXPECT_TRUE(isLine(lines[3], {0.5, 0.5}, {0.5, 0}));
}

TEST(Silhouette, OfASphereIsRound) {
  OutlinedScene stage;
  stage.camera.position = stage.place + glm::dvec3(10, 0, 2);
  const std::vector<PictureLine> lines = stage.outline(5, {400, 400});
  ASSERT_FALSE(lines.empty());
  // Radius 1 at distance 2 is seen up to the tangent of asin(1/2).
  for (const PictureLine& line : lines) EXPECT_NEAR(glm::length(line.from), 1 / std::sqrt(3.0), 0.02);
}

TEST(Silhouette, IsCutOffAtTheCamera) {
  OutlinedScene stage;
  stage.scene.spheres.clear();
  stage.camera.position = stage.place + glm::dvec3(0.5, 0.25, 0.01);
  stage.camera.forward = {0, 1, 0};
  stage.camera.up = {0, 0, 1};
  // The eye is above the square, and the picture shows a triangle of it that reaches beyond its lower edge.
  const std::vector<PictureLine> lines = stage.outline(2, {100, 100});
  ASSERT_FALSE(lines.empty());
  for (const PictureLine& line : lines) EXPECT_LE(std::max(line.from.y, line.to.y), 0.0);
  stage.camera.forward = {0, -1, 0};
  stage.camera.position = stage.place + glm::dvec3(0.5, -0.25, 0.01);
  EXPECT_TRUE(stage.outline(2, {100, 100}).empty());  // behind it
}

}  // namespace
}  // namespace fragtrace
