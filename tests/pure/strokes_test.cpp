// SPDX-License-Identifier: MIT
#include "scene/strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>
#include <utility>

namespace fragtrace {
namespace {

/// A camera at (0, 0, 10) that looks along -z, with a view of 2 m in height at the origin.
Camera cameraAt10(bool perspective) {
  Camera camera;
  camera.position = {0.0, 0.0, 10.0};
  camera.type = perspective ? CameraType::Perspective : CameraType::Orthographic;
  camera.fovY = 2.0 * std::atan(0.1);
  return camera;
}

Scene sceneOf(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec2>& ends) {
  Scene scene;
  scene.vertices.position = positions;
  scene.materials.resize(1);
  scene.materials[0].doubleSided = true;
  scene.materials[0].normalTexture.texture = 0;
  scene.strokes.push_back({"node", "mesh", 3, 0, false, ends});
  return scene;
}

/// Returns the volume that the last triangles enclose; it is negative if they are inside out.
double volumeOf(const Scene& scene) {
  double volume = 0.0;
  for (const Triangle& t : scene.triangles) {
    const auto v = cornersOf<glm::dvec3>(scene, t);
    volume += glm::dot(v[0], glm::cross(v[1], v[2])) / 6.0;
  }
  return volume;
}

/// Each edge belongs to two triangles, once in each direction.
void expectClosed(const Scene& scene) {
  std::map<std::pair<uint32_t, uint32_t>, int> edges;
  for (const Triangle& t : scene.triangles) {
    for (int c = 0; c < 3; ++c) ++edges[{t.vertex[c], t.vertex[(c + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

constexpr int kHeight = 100;
constexpr double kPixels = 5.0;
constexpr double kRadius = 0.5 * kPixels * 2.0 / kHeight;  // metres
constexpr double kArea = glm::pi<double>() * kRadius * kRadius;

TEST(Strokes, APointIsAClosedSolidWithTheAreaOfItsCircle) {
  for (const bool perspective : {false, true}) {
    Scene scene = sceneOf({{0, 0, 0}}, {{0, 0}});
    addStrokes(scene, cameraAt10(perspective), glm::ivec2(kHeight), kPixels);
    EXPECT_EQ(scene.triangles.size(), kTrianglesOfAPoint);
    expectClosed(scene);
    const double apex = kRadius * std::sqrt(glm::two_pi<double>() / (3.0 * std::sqrt(3.0)));
    EXPECT_NEAR(volumeOf(scene), 2.0 / 3.0 * kArea * apex, 1e-6 * kArea);
    for (size_t i = 1; i < 7; ++i) EXPECT_NEAR(scene.vertices.position[i].z, 0.0, 1e-6) << "faces the camera";
  }
}

TEST(Strokes, ALineIsAClosedSolidAsWideAsAsked) {
  Scene scene = sceneOf({{-1, 0, 0}, {1, 0, 0}}, {{0, 1}});
  addStrokes(scene, cameraAt10(false), glm::ivec2(kHeight), kPixels);
  EXPECT_EQ(scene.triangles.size(), kTrianglesOfALine);
  EXPECT_LE(scene.vertices.position.size(), 2 + kMostStrokeVertices);
  expectClosed(scene);
  const double apex = kRadius * std::sqrt(glm::two_pi<double>() / (3.0 * std::sqrt(3.0)));
  EXPECT_NEAR(volumeOf(scene), kArea * (2.0 + 2.0 / 3.0 * apex), 1e-6 * kArea);
}

TEST(Strokes, TheWidthFollowsTheDepthAlsoBehindTheCamera) {
  const auto volume = [](float z) {
    Scene scene = sceneOf({{0, 0, z}}, {{0, 0}});
    addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
    return volumeOf(scene);
  };
  EXPECT_NEAR(volume(-10.0f) / volume(0.0f), 8.0, 1e-4);
  EXPECT_NEAR(volume(30.0f) / volume(0.0f), 8.0, 1e-4);
}

/// Returns the width from the left to the right, in pixels, of the vertices at or around the ends of
/// `scene`'s first line.
double shownWidth(const Scene& scene, size_t first, size_t count) {
  double least = 1e9;
  double most = -1e9;
  for (size_t i = first; i < first + count; ++i) {
    const glm::vec3& p = scene.vertices.position[i];
    const double x = p.x / (10.0 - p.z) / 0.1 * 0.5 * kHeight;
    least = std::min(least, x);
    most = std::max(most, x);
  }
  return most - least;
}

TEST(Strokes, ALineIsAsWideAtTheEdgeOfAWideViewAsInItsMiddle) {
  for (const float x : {0.0f, 5.0f, 20.0f}) {
    Scene scene = sceneOf({{x, -1, 0}, {x, 1, 0}}, {{0, 1}});
    addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
    const double width = shownWidth(scene, 2, 6);
    EXPECT_GT(width, 0.95 * kPixels) << x;
    EXPECT_LT(width, 1.11 * kPixels) << x;
  }
}

TEST(Strokes, ALineThatPassesTheCameraIsThinThere) {
  Scene scene = sceneOf({{1, 0, 0}, {1, 0, 20}}, {{0, 1}});
  scene.vertices.color = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
  EXPECT_EQ(scene.triangles.size(), 2 * kTrianglesOfALine);
  for (size_t i = 2; i < scene.vertices.position.size(); ++i) {
    const glm::vec3& p = scene.vertices.position[i];
    EXPECT_LE(std::hypot(p.x - 1.0, p.y), 1.2 * kRadius * std::abs(p.z - 10.0) / 10.0 + 1e-5) << p.z;
    EXPECT_NEAR(scene.vertices.color[i].g, std::clamp(p.z / 20.0, 0.0, 1.0), 0.02) << p.z;
  }
}

TEST(Strokes, ALineWithoutLengthIsNothing) {
  Scene scene = sceneOf({{1, 0, 0}, {1, 0, 0}}, {{0, 1}});
  addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
  EXPECT_TRUE(scene.triangles.empty());
}

TEST(Strokes, WithoutNormalsTheyShowBaseColourAndEmission) {
  Scene scene = sceneOf({{0, 0, 0}}, {{0, 0}});
  scene.materials[0].baseColorFactor = {0.5f, 0.0f, 0.0f, 1.0f};
  scene.materials[0].emissiveFactor = {0.0f, 0.5f, 0.0f};
  scene.materials[0].emissiveStrength = 4.0f;
  scene.materials[0].number = 7;
  addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
  EXPECT_EQ(scene.materials[1].baseColorFactor, glm::vec4(0.5f, 2.0f, 0.0f, 1.0f));
  EXPECT_EQ(scene.materials[1].number, 7u);
}

TEST(Strokes, AreUnlitWithoutNormalsAndNeverHaveNormalTextures) {
  for (const bool lit : {false, true}) {
    Scene scene = sceneOf({{0, 0, 0}}, {{0, 0}});
    scene.strokes[0].lit = lit;
    addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
    ASSERT_EQ(scene.materials.size(), 2u);
    const Material& used = scene.materials[scene.triangles[0].material];
    EXPECT_EQ(used.unlit, !lit);
    EXPECT_FALSE(used.doubleSided);
    EXPECT_FALSE(used.normalTexture.present());
    EXPECT_TRUE(scene.materials[0].normalTexture.present());
  }
}

TEST(Strokes, HaveTheAttributesOfTheirEnds) {
  Scene scene = sceneOf({{-1, 0, 0}, {1, 0, 0}}, {{0, 1}});
  scene.vertices.color = {{1, 0, 0, 1}, {0, 1, 0, 1}};
  addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
  ASSERT_EQ(scene.vertices.color.size(), scene.vertices.position.size());
  for (size_t i = 0; i < scene.vertices.color.size(); ++i)
    EXPECT_EQ(scene.vertices.color[i].r, scene.vertices.position[i].x < 0.0f ? 1.0f : 0.0f) << i;
}

TEST(Strokes, StandBehindOtherTrianglesAndBeforeSharedMeshes) {
  Scene scene = sceneOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0}, {0, 1}});
  scene.triangles = {{{0, 1, 2}, 0, true}, {{0, 2, 1}, 0, true}};
  scene.sharedMeshes = {{1, 1}};
  scene.origins = {{"first", "", 0, 1, 0}, {"", "shared", 1, 1, 0}};
  addStrokes(scene, cameraAt10(true), glm::ivec2(kHeight), kPixels);
  const auto count = uint32_t(kTrianglesOfAPoint + kTrianglesOfALine);
  EXPECT_EQ(scene.strokeTriangles, count);
  ASSERT_EQ(scene.triangles.size(), 2 + count);
  EXPECT_EQ(scene.sharedMeshes[0].firstTriangle, 1 + count);
  EXPECT_EQ(scene.triangles.back().vertex, glm::uvec3(0, 2, 1));
  ASSERT_EQ(scene.origins.size(), 3u);
  EXPECT_EQ(scene.origins[1].firstTriangle, 1u);
  EXPECT_EQ(scene.origins[1].triangleCount, count);
  EXPECT_EQ(scene.origins[1].nodeIndex, 3u);
  EXPECT_EQ(scene.origins[2].firstTriangle, 1 + count);
  EXPECT_EQ(scene.insets.size(), scene.triangles.size());
}

}  // namespace
}  // namespace fragtrace
