// SPDX-License-Identifier: MIT
// One fault is one warning, which says what was done.
#include <utility>

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
  expectOne(
      builder,
      "/meshes/0/primitives/0/material: asks for TEXCOORD_1, which the primitive does not have; (0, 0) is "
      "taken");
}

TEST(GltfWarnings, PrimitivesWithoutPositions) {
  GltfBuilder builder;
  json& attributes = builder.addTriangle()["attributes"];
  attributes = {{"NORMAL", attributes["POSITION"]}};
  expectOne(builder, "/meshes/0/primitives/0: a primitive without POSITION is left out");
  builder.root["meshes"][0]["primitives"][0]["attributes"] = json::object();
  expectOne(builder,
            "/meshes/0/primitives/0/attributes: is empty, which glTF forbids; the primitive is left out");
}

TEST(GltfWarnings, MissingTextureCoordinatesOfAPerlinMap) {
  GltfBuilder builder;
  builder.root["materials"] = {{{"extras", {{"perlinNormal", {{"amplitude", 0.5}}}}}}};
  builder.addTriangle()["material"] = 0;
  expectOne(builder, "/meshes/0/primitives/0: TEXCOORD_0 is needed and missing, (0, 0) is taken");
}

TEST(GltfWarnings, ChannelsThatDriveNothing) {
  const std::string ignored = "; the channel is ignored";
  const std::pair<json, std::string> cases[] = {
      {{{"node", 0}, {"path", "colour"}}, "/path: \"colour\" is nothing that can be animated" + ignored},
      {{{"path", "translation"}}, ": has no node" + ignored},
      {{{"node", 0},
        {"path", "pointer"},
        {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/scale"}}}}}},
       ": has both a pointer and a node" + ignored}};
  for (const auto& [target, warning] : cases) {
    GltfBuilder builder;
    builder.addTriangle();
    builder.root["extensionsUsed"] = {"KHR_animation_pointer"};
    const int input = builder.addAccessor<float>("SCALAR", {0, 1});
    const int output = builder.addAccessor<float>("SCALAR", {0, 1});
    builder.root["animations"] = {{{"samplers", {{{"input", input}, {"output", output}}}},
                                   {"channels", {{{"sampler", 0}, {"target", target}}}}}};
    GltfOptions options;
    options.selection.animationTime = 0.5;
    expectOne(builder, "/animations/0/channels/0/target" + warning, options);
  }
}

/// There are no bytes to check, as of what is compressed.
TEST(GltfWarnings, AccessorsPastABufferViewWithoutData) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.embedBuffer();
  builder.root["buffers"].push_back({{"byteLength", 100}});
  builder.root["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 24}});
  json accessor = {{"bufferView", 1}, {"componentType", 5126}, {"count", 2}, {"type", "VEC3"}};
  builder.root["accessors"].push_back(accessor);
  EXPECT_TRUE(load(builder).warnings.empty());
  const std::string refused = ", which is refused where ";
  for (const char* member : {"count", "byteOffset"}) {
    builder.root["accessors"][1] = accessor;
    builder.root["accessors"][1][member] = 4;
    expectOne(builder, "/accessors/1: reaches past its buffer view" + refused + "it is read");
  }
  accessor["sparse"] = {{"count", 3},
                        {"indices", {{"bufferView", 1}, {"componentType", 5125}}},
                        {"values", {{"bufferView", 1}}}};
  builder.root["accessors"][1] = accessor;
  expectOne(builder,
            "/accessors/1/sparse/count: is more than there are elements" + refused + "they are read");
}

}  // namespace
}  // namespace fragtrace::gltf_test
