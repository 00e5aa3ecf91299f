// SPDX-License-Identifier: MIT
// KHR_meshopt_compression, where it differs from EXT_meshopt_compression.
#include <gtest/gtest.h>

#include "gltf_compressed.h"

namespace fragtrace::gltf_test {
namespace {

/// The same document with the ratified extension instead of its predecessor.
GltfBuilder khrGrid(const Grid& grid) {
  GltfBuilder builder = meshoptGrid(grid);
  std::string text = builder.root.dump();
  for (size_t at = text.find("EXT_meshopt"); at != std::string::npos; at = text.find("EXT_meshopt"))
    text.replace(at, 3, "KHR");
  builder.root = json::parse(text);
  return builder;
}

TEST(GltfMeshopt, TheRatifiedExtensionIsReadTheSame) {
  const Grid grid;
  GltfBuilder ext = meshoptGrid(grid);
  GltfBuilder khr = khrGrid(grid);
  const Scene expected = load(ext);
  const Scene scene = load(khr);
  EXPECT_EQ(scene.vertices.position, expected.vertices.position);
  EXPECT_EQ(scene.triangles.size(), expected.triangles.size());
  EXPECT_GT(scene.triangles.size(), 0U);
}

TEST(GltfMeshopt, WhatOnlyTheRatifiedExtensionHasIsNamed) {
  const Grid grid;
  const std::string extension = "/bufferViews/0/extensions/KHR_meshopt_compression";
  const auto objectOf = [](GltfBuilder& b) -> json& {
    return b.root["bufferViews"][0]["extensions"]["KHR_meshopt_compression"];
  };
  GltfBuilder colors = khrGrid(grid);
  objectOf(colors)["filter"] = "COLOR";
  EXPECT_EQ(refusalOf(colors),
            "test.gltf: " + extension + "/filter: does not go with its mode or its byteStride");
  GltfBuilder both = khrGrid(grid);
  both.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = objectOf(both);
  EXPECT_EQ(faultOf(both),
            "test.gltf: " + extension + ": stands beside EXT_meshopt_compression, which is ignored");
  GltfBuilder old = meshoptGrid(grid);
  meshoptOf(old, 0)["filter"] = "COLOR";
  EXPECT_NE(refusalOf(old).find("\"COLOR\" is no filter"), std::string::npos);
}

#if MESHOPTIMIZER_VERSION < 230
TEST(GltfMeshopt, WhatTheLibraryIsTooOldForIsRefusedByName) {
  const std::vector<uint32_t> elements(16, 0x01020304);
  for (const bool isColor : {true, false}) {
    GltfBuilder builder;
    std::vector<unsigned char> bytes = encodedVertices(elements.data(), elements.size(), 4);
    if (!isColor) bytes[0] = 0xa1;
    const int view =
        addMeshoptView(builder, bytes, elements.size(), 4, "ATTRIBUTES", isColor ? "COLOR" : "NONE");
    json& extensions = builder.root["bufferViews"][size_t(view)]["extensions"];
    extensions = {{"KHR_meshopt_compression", extensions["EXT_meshopt_compression"]}};
    builder.addTriangle();
    builder.embedBuffer();
    builder.root["buffers"].push_back({{"byteLength", 1000}});
    const std::string refusal = faultOf(builder);
    EXPECT_NE(
        refusal.find(isColor ? "the filter COLOR needs meshoptimizer 0.25" : "the stream has version 1, and"),
        std::string::npos)
        << refusal;
    EXPECT_NE(refusal.find("/extensions/KHR_meshopt_compression: "), std::string::npos) << refusal;
  }
}
#endif

}  // namespace
}  // namespace fragtrace::gltf_test
