// SPDX-License-Identifier: MIT
#include "scene/tangents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// A primitive whose triangles have corners of their own: positions, texture coordinates, and one normal for
/// all.
struct Patch {
  Vertices vertices;
  std::vector<Triangle> triangles;

  void add(const glm::vec3& position, const glm::vec2& texcoord, const glm::vec3& normal = {0, 0, 1}) {
    vertices.position.push_back(position);
    vertices.texcoord0.push_back(texcoord);
    vertices.normal.push_back(normal);
  }
  void triangle(uint32_t a, uint32_t b, uint32_t c) { triangles.push_back({{a, b, c}}); }
  void make() { makeTangents(vertices, triangles, 0); }
  const glm::vec4& tangentAt(size_t triangle, int corner) const {
    return vertices.tangent.at(triangles.at(triangle).vertex[corner]);
  }
};

void expectValid(const Patch& patch) {
  ASSERT_EQ(patch.vertices.tangent.size(), patch.vertices.position.size());
  for (size_t i = 0; i < patch.vertices.tangent.size(); ++i) {
    const glm::vec4& tangent = patch.vertices.tangent[i];
    EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(glm::vec3(tangent), patch.vertices.normal[i]), 0.0f, 1e-5f);
    EXPECT_TRUE(tangent.w == 1.0f || tangent.w == -1.0f);
  }
}

TEST(Tangents, UnmirroredMapHasPositiveHandednessAndTheBitangentPointsUpInTheImage) {
  Patch patch;  // v points down in glTF
  patch.add({0, 0, 0}, {0, 1});
  patch.add({1, 0, 0}, {1, 1});
  patch.add({0, 1, 0}, {0, 0});
  patch.triangle(0, 1, 2);
  patch.make();
  EXPECT_EQ(patch.tangentAt(0, 0), glm::vec4(1, 0, 0, 1));
  const glm::vec3 bitangent = glm::cross(glm::vec3(0, 0, 1), glm::vec3(patch.tangentAt(0, 0)));
  EXPECT_GT(bitangent.y, 0.0f) << "towards smaller v";
}

TEST(Tangents, MirroredMapHasNegativeHandedness) {
  Patch patch;
  patch.add({0, 0, 0}, {1, 1});
  patch.add({1, 0, 0}, {0, 1});
  patch.add({0, 1, 0}, {1, 0});
  patch.triangle(0, 1, 2);
  patch.make();
  EXPECT_EQ(patch.tangentAt(0, 0), glm::vec4(-1, 0, 0, -1));
}

TEST(Tangents, VertexBetweenMirroredHalvesIsDoubled) {
  Patch patch;  // u runs away from x = 0 on both sides
  patch.add({0, 0, 0}, {0, 1});
  patch.add({1, 0, 0}, {1, 1});
  patch.add({0, 1, 0}, {0, 0});
  patch.add({-1, 0, 0}, {1, 1});
  patch.vertices.color.assign(4, glm::vec4(0.5f));
  patch.triangle(0, 1, 2);
  patch.triangle(0, 2, 3);
  patch.make();
  EXPECT_EQ(patch.vertices.position.size(), 6u);
  EXPECT_EQ(patch.vertices.color.size(), 6u);
  EXPECT_NE(patch.triangles[0].vertex.x, patch.triangles[1].vertex.x);
  for (int corner = 0; corner < 3; ++corner) {
    EXPECT_EQ(patch.tangentAt(0, corner), glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(patch.tangentAt(1, corner), glm::vec4(-1, 0, 0, -1));
  }
  expectValid(patch);
}

TEST(Tangents, CornersAreWeightedByAngleAcrossUnweldedVertices) {
  // Two triangles meet in the origin with angles of 90 and 45 degrees; their u axes are 90 degrees apart.
  Patch patch;
  patch.add({0, 0, 0}, {0, 0});
  patch.add({1, 0, 0}, {1, 0});
  patch.add({0, 1, 0}, {0, -1});
  patch.add({0, 0, 0}, {0, 0});
  patch.add({0, -1, 0}, {-1, 0});  // u along +y
  patch.add({1, -1, 0}, {-1, 1});
  patch.triangle(0, 1, 2);
  patch.triangle(3, 4, 5);
  patch.make();
  const glm::vec3 expected = glm::normalize(glm::vec3(2, 1, 0));
  EXPECT_LT(glm::distance(glm::vec3(patch.tangentAt(0, 0)), expected), 1e-6f);
  EXPECT_EQ(patch.tangentAt(0, 0), patch.tangentAt(1, 0));
  EXPECT_EQ(patch.vertices.position.size(), 6u);
}

TEST(Tangents, DifferentNormalsOrTextureCoordinatesAreNotAveraged) {
  Patch patch;
  patch.add({0, 0, 0}, {0, 0});
  patch.add({1, 0, 0}, {1, 0});
  patch.add({0, 1, 0}, {0, -1});
  patch.add({0, 0, 0}, {5, 0});
  patch.add({0, -1, 0}, {4, 0});
  patch.add({1, -1, 0}, {4, 1});
  patch.triangle(0, 1, 2);
  patch.triangle(3, 4, 5);
  patch.make();
  EXPECT_LT(glm::distance(glm::vec3(patch.tangentAt(0, 0)), glm::vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::distance(glm::vec3(patch.tangentAt(1, 0)), glm::vec3(0, 1, 0)), 1e-6f);
}

TEST(Tangents, TextureCoordinatesWithoutAreaGiveAUnitTangent) {
  Patch patch;
  for (int i = 0; i < 3; ++i) patch.add({float(i == 1), float(i == 2), 0}, {0.5f, 0.5f});
  for (int i = 0; i < 3; ++i) patch.add({7, 7, 7}, {float(i), float(i * i)}, glm::vec3(0, 1, 0));
  patch.triangle(0, 1, 2);
  patch.triangle(3, 4, 5);
  patch.make();
  expectValid(patch);
}

TEST(Tangents, RandomTrianglesAllGetUnitTangents) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> coarse(-2, 2);
  Patch patch;
  for (uint32_t i = 0; i < 600; ++i) {
    const glm::vec3 normal(coarse(random), coarse(random), 3);
    patch.add({coarse(random), coarse(random), coarse(random)}, {coarse(random), coarse(random)},
              glm::normalize(normal));
  }
  for (uint32_t i = 0; i < 2000; ++i) patch.triangle(random() % 600, random() % 600, random() % 600);
  patch.make();
  expectValid(patch);
  for (size_t i = 0; i < patch.triangles.size(); ++i) {
    EXPECT_EQ(patch.tangentAt(i, 0).w, patch.tangentAt(i, 1).w);
    EXPECT_EQ(patch.tangentAt(i, 0).w, patch.tangentAt(i, 2).w);
  }
}

GltfBuilder normalMapped() {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 1, 1, 1, 0, 0});
  primitive["attributes"]["TEXCOORD_1"] = builder.addAccessor<float>("VEC2", {0, 0, 0, 1, 1, 0});
  primitive["material"] = 0;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  return builder;
}

TEST(LoadedTangents, AreMadeOnTheNormalTexturesOwnCoordinates) {
  GltfBuilder builder = normalMapped();
  EXPECT_EQ(load(builder).vertices.tangent.at(0), glm::vec4(1, 0, 0, 1));
  builder.root["materials"][0]["normalTexture"]["texCoord"] = 1;
  EXPECT_EQ(load(builder).vertices.tangent.at(0), glm::vec4(0, 1, 0, 1));
}

TEST(LoadedTangents, AreMadeForPerlinMapsAndNotWithoutNeed) {
  GltfBuilder builder = normalMapped();
  builder.root["materials"][0] = {{"extras", {{"perlinNormal", {{"amplitude", 0.1}}}}}};
  EXPECT_EQ(load(builder).vertices.tangent.at(0), glm::vec4(1, 0, 0, 1));
  builder.root["materials"][0] = {{"emissiveTexture", {{"index", 0}}}};
  EXPECT_TRUE(load(builder).vertices.tangent.empty());
}

TEST(LoadedTangents, GivenOnesAreKept) {
  GltfBuilder builder = normalMapped();
  builder.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      builder.addAccessor<float>("VEC4", {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1});
  EXPECT_EQ(load(builder).vertices.tangent.at(0), glm::vec4(0, 1, 0, -1));
}

TEST(LoadedTangents, AMirroringNodeTurnsHandednessSoThatTheBitangentStaysOnTheSurface) {
  GltfBuilder builder = normalMapped();
  builder.node(0)["scale"] = {-1, 1, 1};
  const Scene scene = load(builder);
  EXPECT_EQ(scene.vertices.tangent.at(0), glm::vec4(-1, 0, 0, -1));
  const glm::vec3 bitangent = glm::cross(scene.vertices.normal.at(0), glm::vec3(-1, 0, 0)) * -1.0f;
  EXPECT_EQ(bitangent, glm::vec3(0, 1, 0));
}

TEST(LoadedTangents, FlatTrianglesHaveThemPerCorner) {
  GltfBuilder builder = normalMapped();
  builder.root["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.triangles.at(0).flat);
  EXPECT_EQ(scene.vertices.tangent.at(0), glm::vec4(1, 0, 0, 1));
}

}  // namespace
}  // namespace fragtrace::gltf_test
