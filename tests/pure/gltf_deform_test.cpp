// SPDX-License-Identifier: MIT
// Morph targets and skins.
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

/// The triangle with a morph target that lifts its first vertex by 1.
json& addMorphTriangle(GltfBuilder& builder) {
  json& primitive = builder.addTriangle();
  primitive["targets"] = {{{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 0, 0, 0, 0})}}};
  return primitive;
}

/// Adds a triangle that is bound to two joints, nodes 1 and 2. `second` has the weight of the second joint
/// for each vertex.
json& addSkinnedTriangle(GltfBuilder& builder, const std::vector<float>& second) {
  json& primitive = builder.addTriangle();
  std::vector<uint8_t> joints;
  std::vector<float> weights;
  for (const float w : second) {
    joints.insert(joints.end(), {0, 1, 0, 0});
    weights.insert(weights.end(), {1.0f - w, w, 0, 0});
  }
  primitive["attributes"]["JOINTS_0"] = builder.addAccessor<uint8_t>("VEC4", joints);
  primitive["attributes"]["WEIGHTS_0"] = builder.addAccessor<float>("VEC4", weights);
  builder.root["skins"] = {{{"joints", {1, 2}}}};
  builder.node(0)["skin"] = 0;
  builder.root["nodes"].push_back({{"children", {2}}});
  builder.root["nodes"].push_back(json::object());
  return primitive;
}

TEST(GltfMorph, TargetsAreAddedByTheirWeights) {
  GltfBuilder builder;
  json& primitive = addMorphTriangle(builder);
  primitive["targets"].push_back(
      {{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, 10, 0, 0, 0, 20, 0})}});
  builder.root["meshes"][0]["weights"] = {0.5, 0.25};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, 0, 0.5}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {3.5, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {0, 6, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMorph, WeightsOfANodeCountMoreThanTheMeshsAndAreItsOwn) {
  GltfBuilder builder;
  addMorphTriangle(builder);
  builder.root["meshes"][0]["weights"] = {1};
  builder.root["nodes"].push_back({{"mesh", 0}, {"weights", {-2}}});
  builder.root["nodes"].push_back({{"mesh", 0}, {"weights", {0}}});
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, 0, 1}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 1, 0), {0, 0, -2}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 2, 0), {0, 0, 0}));
}

TEST(GltfMorph, AllAttributesMoveAndColoursAreClamped) {
  GltfBuilder builder;
  json& primitive = addMorphTriangle(builder);
  json& attributes = primitive["attributes"];
  attributes["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TANGENT"] = builder.addAccessor<float>("VEC4", {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1});
  attributes["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  attributes["COLOR_0"] = builder.addAccessor<float>("VEC3", {0.5f, 0.5f, 0.5f, 0, 0, 0, 0, 0, 0});
  json& target = primitive["targets"][0];
  target["NORMAL"] = builder.addAccessor<float>("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, 0});
  target["TANGENT"] = builder.addAccessor<float>("VEC3", {0, 1, 0, 0, 0, 0, 0, 0, 0});
  target["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0.25f, 0.5f, 0, 0, 0, 0});
  target["COLOR_0"] = builder.addAccessor<float>("VEC3", {0.25f, 1, -1, 0, 0, 0, 0, 0, 0});
  primitive["material"] = 0;
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.node(0)["weights"] = {1};
  const Scene scene = load(builder);
  const double c = std::sqrt(0.5);
  EXPECT_TRUE(isNear(scene.vertices.normal.at(0), {c, 0, c}));
  EXPECT_TRUE(isNear(glm::vec3(scene.vertices.tangent.at(0)), {c, c, 0}));
  EXPECT_EQ(scene.vertices.tangent.at(0).w, -1.0f);
  EXPECT_EQ(scene.vertices.texcoord0.at(0), glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(scene.vertices.color.at(0), glm::vec4(0.75f, 1.0f, 0.0f, 1.0f));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMorph, TargetsMayBeSparseOrWithoutBufferView) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  builder.root["accessors"].push_back({{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  builder.root["accessors"].push_back(
      {{"componentType", 5126},
       {"count", 3},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", builder.addView<uint8_t>({2})}, {"componentType", 5121}}},
         {"values", {{"bufferView", builder.addView<float>({0, 0, 4})}}}}}});
  primitive["targets"] = {{{"POSITION", 1}}, {{"POSITION", 2}}};
  builder.node(0)["weights"] = {1, 1};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {0, 1, 4}));
}

TEST(GltfMorph, TargetsOfAnotherSizeAreRefused) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["targets"] = {{{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 1})}}};
  builder.node(0)["weights"] = {1};
  EXPECT_TRUE(refusalOf(builder).starts_with(
      "test.gltf: /meshes/0/primitives/0/targets/0/POSITION: has 1 elements for 3 vertices"));
}

TEST(GltfSkin, VerticesFollowTheirJointsAndNotTheirNode) {
  GltfBuilder builder;
  addSkinnedTriangle(builder, {0.0f, 1.0f, 0.25f});
  builder.node(0)["translation"] = {100, 0, 0};
  builder.node(1)["translation"] = {0, 0, 2};
  builder.node(2)["scale"] = {4, 4, 4};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, 0, 2}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {4, 0, 2}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {0, 0.75 + 0.25 * 4, 2}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfSkin, InverseBindMatricesComeFirst) {
  GltfBuilder builder;
  addSkinnedTriangle(builder, {1.0f, 1.0f, 1.0f});
  const std::vector<float> matrices = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
  builder.root["accessors"].push_back(
      {{"bufferView", builder.addView(matrices)}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
  builder.root["skins"][0]["inverseBindMatrices"] = builder.root["accessors"].size() - 1;
  const double h = std::sqrt(0.5);
  builder.node(2)["rotation"] = {0, 0, h, h};  // x becomes y
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, -1, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {0, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {-1, -1, 0}));
}

TEST(GltfSkin, MorphTargetsComeBeforeJoints) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {1.0f, 1.0f, 1.0f});
  primitive["targets"] = {{{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 0, 0, 0, 0})}}};
  builder.node(0)["weights"] = {0.5};
  builder.node(2)["scale"] = {1, 1, 6};
  EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 0), {0, 0, 3}));
}

TEST(GltfSkin, NormalsFollowTheCofactorsOfTheBlendedMatrix) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {0.5f, 0.5f, 0.5f});
  const float c = float(std::sqrt(0.5));
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {c, 0, c, c, 0, c, c, 0, c});
  builder.node(2)["scale"] = {3, 1, 1};  // blended: 2, 1, 1
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(scene.vertices.normal.at(0), glm::normalize(glm::dvec3(0.5, 0, 1))));
}

TEST(GltfSkin, JointsThatMirrorKeepFrontsOutside) {
  GltfBuilder builder;
  addSkinnedTriangle(builder, {1.0f, 1.0f, 1.0f});
  builder.node(2)["scale"] = {-1, 1, 1};
  EXPECT_GT(frontOf(load(builder), 0).z, 0.0f);
}

TEST(GltfSkin, CornersThatArePartedKeepTheirJoints) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {0.0f, 1.0f, 0.0f});
  primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  primitive["material"] = 0;
  primitive["indices"] = builder.addAccessor<uint8_t>("SCALAR", {0, 1, 2, 2, 1, 0});
  builder.root["materials"] = {{{"extras", {{"perlinNormal", {{"amplitude", 1.0}}}}}}};
  builder.node(2)["translation"] = {0, 0, 5};
  const Scene scene = load(builder);
  EXPECT_EQ(scene.vertices.position.size(), 6u);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 5}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 1, 1), {1, 0, 5}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 1, 0), {0, 1, 0}));
}

TEST(GltfSkin, WeightsInBytesAndEightInfluences) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {0.0f, 0.0f, 0.0f});
  json& attributes = primitive["attributes"];
  attributes["WEIGHTS_0"] =
      builder.addAccessor<uint8_t>("VEC4", {51, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, true);
  attributes["JOINTS_1"] = builder.addAccessor<uint16_t>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  attributes["WEIGHTS_1"] =
      builder.addAccessor<uint8_t>("VEC4", {204, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, true);
  builder.node(2)["translation"] = {0, 0, 10};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, 0, 8}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfSkin, WeightsThatDoNotAddUpAreScaledWithAWarning) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {0.0f, 0.0f, 0.0f});
  primitive["attributes"]["WEIGHTS_0"] =
      builder.addAccessor<float>("VEC4", {3, 1, 0, 0, 0, 0, 0, 0, 1, -1, NAN, 0});
  builder.node(2)["translation"] = {0, 0, 8};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {0, 0, 2}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), {1, 0, 0}));
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 2), {0, 1, 0}));
  EXPECT_TRUE(anyWarningHas(scene, "/WEIGHTS_0: weights of joints that do not add up to 1 are scaled"));
  EXPECT_TRUE(anyWarningHas(scene, "a vertex whose joints all weigh 0"));
  EXPECT_TRUE(anyWarningHas(scene, "negative or not finite is taken as 0 (2 times"));
}

TEST(GltfSkin, WhatIsNotThereIsRefused) {
  const auto refusal = [](const auto& breakIt) {
    GltfBuilder builder;
    addSkinnedTriangle(builder, {0.5f, 0.5f, 0.5f});
    breakIt(builder);
    return refusalOf(builder);
  };
  EXPECT_EQ(refusal([](GltfBuilder&) {}), "");
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["skins"][0]["joints"] = {1};
              }).starts_with("test.gltf: /meshes/0/primitives/0/attributes/JOINTS_0: joint 1 is past the 1"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["scenes"] = {{{"nodes", {0}}}};
              }).starts_with("test.gltf: /nodes/0/skin: its joint, node 1, is not in the scene"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) { b.node(0)["skin"] = 1; }).starts_with("test.gltf: /nodes/0/skin"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["skins"][0]["inverseBindMatrices"] = 0;
              }).starts_with("test.gltf: /skins/0/inverseBindMatrices: accessor 0 does not hold floats"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = 0;
              }).starts_with("test.gltf: /meshes/0/primitives/0/attributes/JOINTS_0: accessor 0"));
}

TEST(GltfSkin, AMeshWithoutJointsStandsWhereItsNodeDoes) {
  GltfBuilder builder;
  json& primitive = addSkinnedTriangle(builder, {1.0f, 1.0f, 1.0f});
  primitive["attributes"].erase("JOINTS_0");
  primitive["attributes"].erase("WEIGHTS_0");
  builder.node(0)["translation"] = {7, 0, 0};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {7, 0, 0}));
  EXPECT_TRUE(anyWarningHas(scene, "/nodes/0/skin: has a mesh without joints"));
}

}  // namespace
}  // namespace fragtrace::gltf_test
