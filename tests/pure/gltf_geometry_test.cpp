// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// Four corners of the unit square, in the order of a strip.
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

TEST(GltfGeometry, StripAlternatesItsWindingSoThatAllFrontsFaceTheSameWay) {
  GltfBuilder builder;
  builder.addMesh({{"POSITION", builder.addAccessor("VEC3", kSquare)}})["mode"] = 5;
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_GT(frontOf(scene, 0).z, 0.0f);
  EXPECT_GT(frontOf(scene, 1).z, 0.0f);
}

TEST(GltfGeometry, FanKeepsItsFirstVertexInEveryTriangle) {
  GltfBuilder builder;
  builder.addMesh(
      {{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}})["mode"] = 6;
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangles.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_GT(frontOf(scene, i).z, 0.0f);
    EXPECT_EQ(scene.triangles[i].vertex.z, 0u);
  }
}

template <typename Index>
Scene loadIndexed() {
  GltfBuilder builder;
  json& primitive = builder.addMesh({{"POSITION", builder.addAccessor("VEC3", kSquare)}});
  primitive["indices"] = builder.addAccessor<Index>("SCALAR", {0, 1, 2, 2, 1, 3});
  return load(builder);
}

TEST(GltfGeometry, IndicesOfEveryTypeGiveTheSameTriangles) {
  for (const Scene& scene : {loadIndexed<uint8_t>(), loadIndexed<uint16_t>(), loadIndexed<uint32_t>()}) {
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.triangles[0].vertex, glm::uvec3(0, 1, 2));
    EXPECT_EQ(scene.triangles[1].vertex, glm::uvec3(2, 1, 3));
  }
}

TEST(GltfGeometry, SparseAccessorReplacesSingleElements) {
  GltfBuilder builder;
  builder.addTriangle();
  const int indices = builder.addView<uint16_t>({2});
  const int values = builder.addView<float>({0, 5, 0});
  builder.root["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {0, 5, 0}));
}

TEST(GltfGeometry, AccessorWithoutBufferViewIsZeroWhereItIsNotSparse) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  const int indices = builder.addView<uint8_t>({1, 2});
  const int values = builder.addView<uint16_t>({1, 2});
  builder.root["accessors"].push_back({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}});
  builder.root["accessors"].back()["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  primitive["indices"] = 1;
  EXPECT_EQ(load(builder).triangles.at(0).vertex, glm::uvec3(0, 1, 2));
}

TEST(GltfGeometry, InterleavedAttributesAreReadWithTheirStride) {
  GltfBuilder builder;
  const int view = builder.addView<float>({0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1});
  builder.root["bufferViews"][size_t(view)]["byteStride"] = 24;
  for (const size_t offset : {size_t(0), size_t(12)}) {
    builder.root["accessors"].push_back({{"bufferView", view},
                                         {"byteOffset", offset},
                                         {"componentType", 5126},
                                         {"count", 3},
                                         {"type", "VEC3"}});
  }
  builder.addMesh({{"POSITION", 0}, {"NORMAL", 1}});
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {2, 0, 0}));
  EXPECT_EQ(scene.vertices.normal.at(2), glm::vec3(0, 0, 1));
}

TEST(GltfGeometry, MissingNormalsMakeTheTriangleFlat) {
  GltfBuilder builder;
  builder.addTriangle();
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.triangles.at(0).flat);
  EXPECT_TRUE(scene.vertices.normal.empty());
}

TEST(GltfGeometry, NormalsThatAreNotNumbersAreReplacedAndCounted) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {nan, 0, 0, 0, 0, 0, 1, 0, 0});
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(scene.vertices.normal.at(0), {0, 0, 1}));
  EXPECT_TRUE(isNear(scene.vertices.normal.at(1), {0, 0, 1}));
  EXPECT_TRUE(isNear(scene.vertices.normal.at(2), {1, 0, 0}));
  EXPECT_TRUE(anyWarningHas(scene, "/meshes/0/primitives/0/attributes/NORMAL"));
  EXPECT_TRUE(anyWarningHas(scene, "(2 times)"));
}

TEST(GltfGeometry, AttributesThatAreNotNumbersAreReplacedAndCounted) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfBuilder builder;
    json& primitive = builder.addTriangle();
    json& attributes = primitive["attributes"];
    attributes["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, bad, 1});
    attributes["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {bad, 0, 0, bad, 0.5, 0.5});
    attributes["COLOR_0"] = builder.addAccessor<float>("VEC4", {0, 0, 0, bad, 0, 0, 0, 0, 0, 0, 0, 0});
    attributes["TANGENT"] = builder.addAccessor<float>("VEC4", {1, 0, 0, bad, bad, 0, 0, 1, 1, 0, 0, 1});
    primitive["material"] = 0;
    builder.root["materials"] = {{{"extras", {{"perlinNormal", {{"amplitude", 1}}}}}}};
    const Scene scene = load(builder);
    const auto finite = [](const auto& vectors) {
      for (const auto& v : vectors) {
        for (int c = 0; c < v.length(); ++c) {
          if (!std::isfinite(v[c])) return false;
        }
      }
      return vectors.size() == 3;
    };
    const Vertices& v = scene.vertices;
    EXPECT_TRUE(finite(v.normal) && finite(v.texcoord0) && finite(v.color) && finite(v.tangent)) << bad;
    EXPECT_EQ(scene.warnings.size(), 4u);
    EXPECT_TRUE(anyWarningHas(scene, "TEXCOORD_0: a texture coordinate that is not finite"));
    EXPECT_TRUE(anyWarningHas(scene, "(2 times)"));
    EXPECT_TRUE(anyWarningHas(scene, "COLOR_0: a vertex colour that is not finite"));
    EXPECT_TRUE(anyWarningHas(scene, "TANGENT: a tangent without a direction"));
    EXPECT_TRUE(anyWarningHas(scene, "NORMAL: a normal without a direction"));
  }
}

template <typename Component>
glm::vec4 firstColor(const std::string& type, const std::vector<Component>& values) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["COLOR_0"] =
      builder.addAccessor(type, values, !std::is_floating_point_v<Component>);
  return load(builder).vertices.color.at(0);
}

TEST(GltfGeometry, VertexColoursOfEveryTypeAreTheSame) {
  const auto isHalfRed = [](const glm::vec4& color, float alpha) {
    return glm::distance(color, glm::vec4(0.2f, 0.4f, 0.6f, alpha)) < 1e-5f;
  };
  EXPECT_TRUE(isHalfRed(firstColor<float>("VEC4", {.2f, .4f, .6f, .8f, 0, 0, 0, 0, 0, 0, 0, 0}), 0.8f));
  EXPECT_TRUE(isHalfRed(firstColor<uint8_t>("VEC4", {51, 102, 153, 204, 0, 0, 0, 0, 0, 0, 0, 0}), 0.8f));
  EXPECT_TRUE(
      isHalfRed(firstColor<uint16_t>("VEC4", {13107, 26214, 39321, 52428, 0, 0, 0, 0, 0, 0, 0, 0}), 0.8f));
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["COLOR_0"] = builder.addAccessor<float>("VEC3", {.2f, .4f, .6f, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(isHalfRed(load(builder).vertices.color.at(0), 1.0f));
}

TEST(GltfGeometry, PrimitivesWithoutColourAreWhiteBesideOnesThatHaveIt) {
  GltfBuilder builder;
  builder.addTriangle();
  json& coloured = builder.addTriangle();
  coloured["attributes"]["COLOR_0"] = builder.addAccessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, 0});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.vertices.color.size(), 6u);
  EXPECT_EQ(scene.vertices.color[0], glm::vec4(1.0f));
  EXPECT_EQ(scene.vertices.color[3], glm::vec4(0, 0, 0, 1));
}

TEST(GltfGeometry, TextureCoordinatesAreKeptWhereTheMaterialReadsThem) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  primitive["attributes"]["TEXCOORD_1"] =
      builder.addAccessor<uint16_t>("VEC2", {0, 0, 65535, 0, 0, 65535}, true);
  primitive["material"] = 0;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}}};
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.vertices.texcoord0.empty());
  ASSERT_EQ(scene.vertices.texcoord1.size(), 3u);
  EXPECT_EQ(scene.vertices.texcoord1[1], glm::vec2(1, 0));
  EXPECT_EQ(scene.materials.at(0).emissiveTexture.texcoord, 1u);
}

TEST(GltfGeometry, PointsAndLinesAreStrokesBetweenTheirVertices) {
  using Ends = std::vector<glm::uvec2>;
  const std::vector<Ends> expected = {
      {{0, 0}, {1, 1}, {2, 2}}, {{0, 1}}, {{0, 1}, {1, 2}, {2, 0}}, {{0, 1}, {1, 2}}};
  for (int mode = 0; mode < 4; ++mode) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.addTriangle()["mode"] = mode;
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    ASSERT_EQ(scene.strokes.size(), 1u);
    EXPECT_FALSE(scene.strokes[0].lit);
    EXPECT_EQ(scene.strokes[0].nodeIndex, 1u);
    Ends ends = scene.strokes[0].ends;
    for (glm::uvec2& pair : ends) pair -= glm::uvec2(3);  // behind the triangle's vertices
    EXPECT_EQ(ends, expected[size_t(mode)]) << mode;
    EXPECT_EQ(anyWarningHas(scene, "/meshes/1/primitives/0: vertices that make no whole line"), mode == 1);
  }
}

TEST(GltfGeometry, PointsAndLinesThatAreScaledToAPointAreHidden) {
  GltfBuilder builder;
  builder.addTriangle()["mode"] = 0;
  builder.root["nodes"][0]["scale"] = {0, 0, 0};
  EXPECT_TRUE(load(builder).strokes.empty());
}

TEST(GltfGeometry, PointsAndLinesAloneHaveBoundsAndKeepTheDefaultMaterial) {
  GltfBuilder builder;
  builder.addTriangle()["mode"] = 3;
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.triangles.empty());
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_FALSE(scene.bounds.empty());
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfGeometry, AMillionTrianglesKeepAllTheirVerticesAndFaces) {
  GltfBuilder builder;
  constexpr uint32_t kSide = 708;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      positions.insert(positions.end(), {float(x), float(y), 0.0f});
      if (x == 0 || y == 0) continue;
      const uint32_t v = y * kSide + x;
      indices.insert(indices.end(), {v, v - 1, v - kSide, v - 1, v - 1 - kSide, v - kSide});
    }
  }
  json& primitive = builder.addMesh({{"POSITION", builder.addAccessor("VEC3", positions)}});
  primitive["indices"] = builder.addAccessor("SCALAR", indices);
  const TemporaryFolder folder;
  const Scene scene = loadGltf(folder.write("large.glb", builder.glb()));
  EXPECT_EQ(scene.triangles.size(), 2 * (kSide - 1) * (kSide - 1));
  EXPECT_EQ(scene.vertices.position.size(), kSide * kSide);
}

}  // namespace
}  // namespace fragtrace::gltf_test
