// SPDX-License-Identifier: MIT
// One fault is one warning, which says what was done.
#include <gtest/gtest.h>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

void expectOne(GltfBuilder& builder, const std::string& warning, const GltfOptions& options = {}) {
  const Scene scene = load(builder, options);
  ASSERT_EQ(scene.warnings.size(), 1u) << testing::PrintToString(scene.warnings);
  EXPECT_TRUE(scene.warnings[0].ends_with("test.gltf: " + warning)) << scene.warnings[0];
}

TEST(GltfWarnings, MissingTextureCoordinates) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", kPixelUri}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}, {"texCoord", 1}}}}};
  builder.addTriangle()["material"] = 0;
  expectOne(builder, "/meshes/0/primitives/0: TEXCOORD_1 is needed and missing, (0, 0) is taken");
}

TEST(GltfWarnings, PrimitivesWithoutPositions) {
  GltfBuilder builder;
  json& attributes = builder.addTriangle()["attributes"];
  attributes = {{"NORMAL", attributes["POSITION"]}};
  expectOne(builder, "/meshes/0/primitives/0: a primitive without vertices is left out");
  builder.root["meshes"][0]["primitives"][0]["attributes"] = json::object();
  expectOne(builder, "/meshes/0/primitives/0: a primitive without vertices is left out");
}

TEST(GltfWarnings, MissingTextureCoordinatesOfAPerlinMap) {
  GltfBuilder builder;
  builder.root["materials"] = {{{"extras", {{"perlinNormal", {{"amplitude", 0.5}}}}}}};
  builder.addTriangle()["material"] = 0;
  expectOne(builder, "/meshes/0/primitives/0: TEXCOORD_0 is needed and missing, (0, 0) is taken");
}

TEST(GltfWarnings, ChannelsThatDriveNothing) {
  const json cases[] = {{{"path", "translation"}},
                        {{"node", 0},
                         {"path", "pointer"},
                         {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/scale"}}}}}}};
  for (const json& target : cases) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = {"KHR_animation_pointer"};
    const int input = builder.addAccessor<float>("SCALAR", {0, 1});
    const int output = builder.addAccessor<float>("SCALAR", {0, 1});
    builder.root["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}},
                                   {"channels", {{{"sampler", 0}, {"target", target}}}}}};
    GltfOptions options;
    options.selection.animationTime = 0.5;
    expectOne(builder,
              "/animations/0/channels/0/target: is nothing that can be animated; the channel is ignored",
              options);
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
