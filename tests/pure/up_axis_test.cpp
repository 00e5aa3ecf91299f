// SPDX-License-Identifier: MIT
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <glm/gtx/string_cast.hpp>
#include <random>

namespace fragtrace {
namespace {

/// The largest difference of two vectors' parts.
double apart(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 d = glm::abs(a - b);
  return std::max({d.x, d.y, d.z});
}

/// It leaves the direction at right angles to both where it is, which no other rotation does.
TEST(UpAxis, TheTurnIsTheShortestRotation) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> directions{
      {1e-9, -1, 0}, {3e-5, -1, -4e-5}, {0, -1, 1e-160}, {1e300, -1e300, 1e300}, {1e-300, 0, 0}};
  for (int i = 0; i < 100; ++i) directions.emplace_back(normal(random), normal(random), normal(random));
  for (const glm::dvec3& up : directions) {
    const glm::dvec3 size = glm::abs(up);
    const glm::dvec3 unit = glm::normalize(up / std::max({size.x, size.y, size.z}));
    const glm::dmat3 turn = turnToY(up);
    EXPECT_LT(apart(turn * unit, {0, 1, 0}), 1e-15) << glm::to_string(up);
    EXPECT_NEAR(glm::determinant(turn), 1.0, 1e-14) << glm::to_string(up);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(glm::length(turn[i]), 1.0, 1e-15) << glm::to_string(up);
      EXPECT_NEAR(glm::dot(turn[i], turn[(i + 1) % 3]), 0.0, 1e-15) << glm::to_string(up);
    }
    if (std::hypot(unit.x, unit.z) < 1e-100) continue;  // its square is 0: half a turn about Z
    const glm::dvec3 axis = glm::normalize(glm::dvec3(-unit.z, 0, unit.x));
    EXPECT_LT(apart(turn * axis, axis), 1e-15) << glm::to_string(up);
  }
}

TEST(UpAxis, ThreeLevelPointsGiveTheNearerDirection) {
  // The points are of a plane that rises by a third of a metre per metre along x; the file is turned already.
  const glm::dvec3 up{0.0, 0.0, 1.0};
  const glm::dvec3 wanted = glm::normalize(glm::dvec3(-1, 0, 3));  // in the file's space
  std::array<glm::dvec3, 3> points;
  const std::array<glm::dvec3, 3> inFile{glm::dvec3{3, 1, 11}, glm::dvec3{6, 2, 12}, glm::dvec3{0, 7, 10}};
  for (size_t i = 0; i < 3; ++i) points[i] = turnToY(up) * inFile[i];
  for (int order = 0; order < 2; ++order, std::swap(points[0], points[1])) {
    const std::optional<glm::dvec3> found = levelUp(points, up);
    ASSERT_TRUE(found);
    EXPECT_LT(apart(*found, wanted), 0.51e-6);
    EXPECT_EQ(std::round(found->x * 1e6) / 1e6, found->x);
    // With this axis all three points are at the same height, except for rounding.
    for (const glm::dvec3& p : inFile)
      EXPECT_NEAR((turnToY(*found) * p).y, (turnToY(*found) * inFile[0]).y, 1e-5);
  }
  EXPECT_EQ(levelUp({glm::dvec3{0, 2, 0}, {1, 2, 1e-9}, {0, 2, 3}}, {0, 1, 0}), glm::dvec3(0, 1, 0));
}

TEST(UpAxis, PointsOnALineHaveNoPlane) {
  const glm::dvec3 y{0, 1, 0};
  EXPECT_FALSE(levelUp({glm::dvec3{1, 2, 3}, {2, 4, 6}, {3, 6, 9}}, y));
  EXPECT_FALSE(levelUp({glm::dvec3{1, 2, 3}, {2, 4, 6}, {1, 2, 3}}, y));
  EXPECT_FALSE(levelUp({glm::dvec3{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, y));
  EXPECT_FALSE(levelUp({glm::dvec3{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0.0009}}, y));
  EXPECT_TRUE(levelUp({glm::dvec3{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0.0011}}, y));
}

}  // namespace
}  // namespace fragtrace
