// SPDX-License-Identifier: MIT
// Creases of triangles that meet in odd ways; what insets are good for is in shader_creases_test.cpp.
#include "scene/creases.h"

#include <gtest/gtest.h>

namespace fragtrace {
namespace {

/// Triangles with their first vertex at the origin.
Scene fan(const std::vector<std::array<glm::vec3, 2>>& ends) {
  Scene scene;
  scene.vertices.position.emplace_back(0.0f);
  for (const auto& [second, third] : ends) {
    const auto next = uint32_t(scene.vertices.position.size());
    scene.vertices.position.push_back(second);
    scene.vertices.position.push_back(third);
    scene.triangles.push_back({{0, next, next + 1}, 0, true});
  }
  return scene;
}

/// Found by the fuzzer: the line in which the planes meet halves the second triangle, so that it has no side.
TEST(Creases, ATriangleThatLiesOnBothSidesOfTheOthersPlaneAsksForNothing) {
  const std::array<glm::vec3, 2> low{glm::vec3(1.0f, 0.001f, 0.0f), glm::vec3(1.0f, 0.002f, 0.0f)};
  const std::array<glm::vec3, 2> both{glm::vec3(1.0f, 0.0f, 1.0f), glm::vec3(1.0f, 0.0f, -1.0f)};
  Scene scene = fan({low, both});
  // A wedge elsewhere, without which there were no insets at all.
  for (const glm::vec3& p :
       {glm::vec3(5, 0, 0), glm::vec3(5, 0, 1), glm::vec3(6, 0, 0), glm::vec3(6, 0.5f, 0)})
    scene.vertices.position.push_back(p);
  scene.triangles.push_back({{5, 6, 7}, 0, true});
  scene.triangles.push_back({{6, 5, 8}, 0, true});
  const std::vector<uint32_t> insets = creaseInsets(scene);
  ASSERT_EQ(insets.size(), 4u);
  EXPECT_EQ(insets[0], 0u);
  EXPECT_EQ(insets[1], 0u);
  EXPECT_NE(insets[2], 0u);
}

}  // namespace
}  // namespace fragtrace
