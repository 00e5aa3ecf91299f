// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

/// A triangle whose node has the extension with these attributes.
void instance(GltfBuilder& builder, const json& attributes) {
  if (!builder.root.contains("meshes")) builder.addTriangle();
  builder.root["extensionsUsed"] = {kExtension};
  builder.node(0)["extensions"][kExtension]["attributes"] = attributes;
}

std::string placeOf(const std::string& attribute) {
  return "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/" + attribute;
}

TEST(GltfInstancing, EveryInstanceIsTranslatedRotatedAndScaledBelowTheNode) {
  GltfBuilder builder;
  const auto h = float(std::sqrt(0.5));
  instance(builder, {{"TRANSLATION", builder.addAccessor<float>("VEC3", {1, 0, 0, 0, 5, 0})},
                     {"ROTATION", builder.addAccessor<float>("VEC4", {0, 0, 0, 1, 0, 0, h, h})},
                     {"SCALE", builder.addAccessor<float>("VEC3", {1, 1, 1, 2, 3, 4})}});
  builder.node(0)["translation"] = {0, 0, 10};
  builder.node(0)["scale"] = {2, 2, 2};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_TRUE(scene.warnings.empty());
  const glm::dvec3 expected[2][3] = {{{2, 0, 10}, {4, 0, 10}, {2, 2, 10}},
                                     {{0, 10, 10}, {0, 14, 10}, {-6, 10, 10}}};
  for (size_t i = 0; i < 2; ++i) {
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_TRUE(isNear(worldCornerOf(scene, i, corner), expected[i][corner])) << i << ", " << corner;
  }
}

TEST(GltfInstancing, ChildrenOfTheNodeAreThereOnce) {
  GltfBuilder builder;
  instance(builder, {{"TRANSLATION", builder.addAccessor<float>("VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0})}});
  builder.root["nodes"].push_back({{"mesh", 0}});
  builder.node(0)["children"] = {1};
  EXPECT_EQ(load(builder).triangles.size(), 4u);
}

TEST(GltfInstancing, RotationsMayBeNormalizedBytesAndShorts) {
  for (const bool bytes : {true, false}) {
    GltfBuilder builder;
    const int rotation = bytes ? builder.addAccessor<int8_t>("VEC4", {0, 0, 127, 0}, true)
                               : builder.addAccessor<int16_t>("VEC4", {0, 0, 32767, 0}, true);
    instance(builder, {{"ROTATION", rotation}});
    EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 1), {-1, 0, 0}));
  }
}

TEST(GltfInstancing, WithoutAttributesTheMeshIsThereOnce) {
  GltfBuilder builder;
  instance(builder, json::object());
  EXPECT_EQ(load(builder).triangles.size(), 1u);
  builder.node(0)["extensions"][kExtension].erase("attributes");
  EXPECT_EQ(load(builder).triangles.size(), 1u);
}

TEST(GltfInstancing, AttributesOfUnlikeCountsAreRefused) {
  GltfBuilder builder;
  instance(builder, {{"TRANSLATION", builder.addAccessor<float>("VEC3", {1, 0, 0, 2, 0, 0})},
                     {"SCALE", builder.addAccessor<float>("VEC3", {1, 1, 1, 1, 1, 1, 1, 1, 1})}});
  EXPECT_EQ(refusalOf(builder),
            "test.gltf: " + placeOf("SCALE") + ": has 3 elements where TRANSLATION has 2");
}

TEST(GltfInstancing, WrongTypesAreRefused) {
  GltfBuilder shorts;
  instance(shorts, {{"TRANSLATION", shorts.addAccessor<int16_t>("VEC3", {1, 0, 0}, true)}});
  EXPECT_EQ(refusalOf(shorts), "test.gltf: " + placeOf("TRANSLATION") + ": is not of floats");
  GltfBuilder unscaled;
  instance(unscaled, {{"ROTATION", unscaled.addAccessor<int8_t>("VEC4", {0, 0, 127, 0})}});
  EXPECT_EQ(faultOf(unscaled), "test.gltf: " + placeOf("ROTATION") +
                                   ": holds integers that are not normalized, and read as if they were");
  GltfBuilder three;
  instance(three, {{"ROTATION", three.addAccessor<float>("VEC3", {0, 0, 1})}});
  EXPECT_EQ(refusalOf(three), "test.gltf: " + placeOf("ROTATION") + ": accessor 0 is not of type VEC4");
}

TEST(GltfInstancing, WrongReferencesAndValuesAreRefused) {
  GltfBuilder builder;
  instance(builder, {{"SCALE", 7}});
  EXPECT_TRUE(refusalOf(builder).starts_with("test.gltf: " + placeOf("SCALE") + ": index 7 is past"));
  GltfBuilder zero;
  instance(zero, {{"ROTATION", zero.addAccessor<float>("VEC4", {0, 0, 0, 1, 0, 0, 0, 0})}});
  EXPECT_EQ(faultOf(zero),
            "test.gltf: " + placeOf("ROTATION") + ": a quaternion of zeros is read as no rotation");
  GltfBuilder infinite;
  instance(infinite, {{"TRANSLATION", infinite.addAccessor<float>("VEC3", {0, 0, 0, 0, INFINITY, 0})}});
  EXPECT_EQ(faultOf(infinite),
            "test.gltf: /nodes/0/extensions/EXT_mesh_gpu_instancing/attributes: the world transform of an "
            "instance is not finite, or overflows; the instance is left out");
  EXPECT_EQ(load(infinite).triangles.size(), 1u);
}

TEST(GltfInstancing, OtherAttributesAreWarnedAboutUnlessTheyAreTheAuthorsOwn) {
  GltfBuilder builder;
  const int three = builder.addAccessor<float>("VEC3", {1, 1, 1});
  instance(builder, {{"SCALE", three}, {"_ID", three}});
  EXPECT_TRUE(load(builder).warnings.empty());
  instance(builder, {{"SCALE", three}, {"COLOR_0", three}});
  EXPECT_TRUE(anyWarningHas(load(builder), placeOf("COLOR_0")));
}

TEST(GltfInstancing, InstancesThatCoincideAreDrawnOnceWithAWarning) {
  GltfBuilder builder;
  instance(builder, {{"TRANSLATION", builder.addAccessor<float>(
                                         "VEC3", {1, 0, 0, 2, 0, 0, 2, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0})}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangles.size(), 3u);
  EXPECT_EQ(worldCornerOf(scene, 0, 0).x, 1.0);
  EXPECT_EQ(worldCornerOf(scene, 1, 0).x, 2.0);
  EXPECT_EQ(worldCornerOf(scene, 2, 0).x, 0.0);
  EXPECT_TRUE(anyWarningHas(scene,
                            "/attributes: an instance that stands exactly where another one does is left "
                            "out (3 times)"));
  instance(builder, {{"TRANSLATION", builder.addAccessor<float>("VEC3", {1, 0, 0, 1, 0, 0})},
                     {"SCALE", builder.addAccessor<float>("VEC3", {1, 1, 1, 1, 2, 1})}});
  EXPECT_EQ(load(builder).triangles.size(), 2u);
  EXPECT_TRUE(load(builder).warnings.empty());
}

/// Elements without a buffer view take no room in the file.
TEST(GltfInstancing, MemoryIsCountedBeforeItIsTaken) {
  GltfBuilder builder;
  instance(builder, {{"TRANSLATION", 1}});
  builder.root["accessors"].push_back({{"componentType", 5126}, {"count", 1 << 25}, {"type", "VEC3"}});
  GltfOptions options;
  options.limits.memoryBytes = 100000000;
  EXPECT_THROW(load(builder, options), InputError);
}

}  // namespace
}  // namespace fragtrace::gltf_test
