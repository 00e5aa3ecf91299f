// SPDX-License-Identifier: MIT
// Geometry that the libraries' own encoders have compressed.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

#include "gltf_compressed.h"

namespace fragtrace::gltf_test {
namespace {

/// The grid as Draco's encoder makes it, positions in 16 bits, unless it is quantized otherwise.
std::string dracoBytes(const Grid& grid, int method = draco::MESH_EDGEBREAKER_ENCODING) {
  draco::Mesh mesh;
  mesh.set_num_points(uint32_t(grid.vertexCount()));
  draco::GeometryAttribute positions;
  positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int id = mesh.AddAttribute(positions, true, uint32_t(grid.vertexCount()));
  for (uint32_t i = 0; i < grid.vertexCount(); ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &grid.positions[3 * i]);
  for (size_t i = 0; i < grid.indices.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                  draco::PointIndex(grid.indices[i + 2])});
  }
  draco::ExpertEncoder encoder(mesh);
  encoder.SetEncodingMethod(method);
  encoder.SetAttributeQuantization(id, 16);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.size()};
}

GltfBuilder dracoGrid(const Grid& grid, const std::string& bytes) {
  GltfBuilder builder;
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const int view = builder.addView(std::vector<char>(bytes.begin(), bytes.end()));
  const auto empty = [&](size_t count, int componentType, const std::string& type) {
    builder.root["accessors"].push_back({{"componentType", componentType}, {"count", count}, {"type", type}});
    return builder.root["accessors"].size() - 1;
  };
  json& primitive = builder.addMesh({{"POSITION", empty(grid.vertexCount(), 5126, "VEC3")}});
  primitive["indices"] = empty(grid.indices.size(), 5123, "SCALAR");
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                           {"attributes", {{"POSITION", 0}}}};
  return builder;
}

json& dracoOf(GltfBuilder& builder) {
  return builder.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
}

TEST(GltfMeshopt, GeometryComesBackAsItWas) {
  const Grid grid;
  const auto expected = cornersOf(plainScene(grid));
  for (const std::string mode : {"TRIANGLES", "INDICES"}) {
    GltfBuilder builder = meshoptGrid(grid, mode);
    const Scene scene = load(builder);
    EXPECT_EQ(cornersOf(scene), expected) << mode;
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(GltfMeshopt, FiltersAreUndone) {
  const Grid grid;
  const size_t count = grid.vertexCount();
  std::vector<float> normals;  // four numbers each, as the encoder takes them
  for (size_t i = 0; i < count; ++i) {
    const double angle = 0.1 * double(i);
    normals.insert(normals.end(), {float(0.6 * std::cos(angle)), float(0.6 * std::sin(angle)), 0.8f, 0.0f});
  }
  std::vector<int8_t> octahedral(4 * count);
  meshopt_encodeFilterOct(octahedral.data(), count, 4, 8, normals.data());
  std::vector<uint32_t> exponential(3 * count);
#if MESHOPTIMIZER_VERSION >= 200
  meshopt_encodeFilterExp(exponential.data(), count, 12, 15, grid.positions.data(),
                          meshopt_EncodeExpSharedVector);
#else
  meshopt_encodeFilterExp(exponential.data(), count, 12, 15, grid.positions.data());
#endif

  GltfBuilder builder = meshoptGrid(grid);
  builder.root.erase("buffers");
  const int normalView = addMeshoptView(builder, encodedVertices(octahedral.data(), count, 4), count, 4,
                                        "ATTRIBUTES", "OCTAHEDRAL");
  const int positionView = addMeshoptView(builder, encodedVertices(exponential.data(), count, 12), count, 12,
                                          "ATTRIBUTES", "EXPONENTIAL");
  builder.root["bufferViews"][size_t(normalView)]["byteStride"] = 4;
  json& attributes = builder.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = addAccessor(builder, normalView, count, 5120, "VEC3");
  builder.root["accessors"].back()["normalized"] = true;
  attributes["POSITION"] = addAccessor(builder, positionView, count, 5126, "VEC3");
  builder.root["extensionsUsed"].push_back("KHR_mesh_quantization");
  builder.root["extensionsRequired"].push_back("KHR_mesh_quantization");
  builder.embedBuffer();
  builder.root["buffers"].push_back(
      {{"byteLength", 100'000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.vertices.normal.size(), count);
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 expected(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2]);
    EXPECT_TRUE(isNear(scene.vertices.normal[i], expected, 0.02)) << i;
  }
  for (size_t i = 0; i < count; ++i) {
    const glm::dvec3 expected(grid.positions[3 * i], grid.positions[3 * i + 1], grid.positions[3 * i + 2]);
    const glm::dvec3 found = scene.space.worldOf(glm::dvec3(scene.vertices.position[i]));
    EXPECT_TRUE(isNear(found, expected, 1e-3)) << i;
  }
}

TEST(GltfMeshopt, WhatTheLibraryTakesForGrantedIsRefused) {
  const Grid grid;
  const auto refusal = [&](const auto& breakIt) {
    GltfBuilder builder = meshoptGrid(grid);
    breakIt(builder);
    return refusalOf(builder);
  };
  const std::string vertices = "test.gltf: /bufferViews/0/extensions/EXT_meshopt_compression";
  const std::string indices = "test.gltf: /bufferViews/1/extensions/EXT_meshopt_compression";
  EXPECT_EQ(refusal([](GltfBuilder&) {}), "");
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["byteStride"] = 6;
              }).starts_with(vertices + "/byteStride"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["byteStride"] = 260;
              }).starts_with(vertices + "/byteStride"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["byteStride"] = 0;
              }).starts_with(vertices + "/byteStride"));
  EXPECT_TRUE(
      refusal([](GltfBuilder& b) { meshoptOf(b, 0)["count"] = 143; }).starts_with(vertices + "/count"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["count"] = uint64_t(1) << 52;
                meshoptOf(b, 0)["byteStride"] = 256;
              }).starts_with(vertices + "/count"));
  EXPECT_TRUE(
      refusal([](GltfBuilder& b) { meshoptOf(b, 0)["mode"] = "POINTS"; }).starts_with(vertices + "/mode"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["filter"] = "QUATERNION";
              }).starts_with(vertices + "/filter"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 1)["filter"] = "EXPONENTIAL";
              }).starts_with(indices + "/filter"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 1)["byteStride"] = 3;
              }).starts_with(indices + "/byteStride"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 1)["count"] = 725;
                b.root["bufferViews"][1]["byteLength"] = 725 * 4;
              }).starts_with(indices + "/count: 725 is no multiple of 3"));
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                meshoptOf(b, 0)["byteOffset"] = 99'999;
              }).find(" bytes from byte 99999 reach past") != std::string::npos);
  EXPECT_EQ(refusal([](GltfBuilder& b) { meshoptOf(b, 0)["byteOffset"] = 1; }),
            vertices + ": the compressed data are broken");
  EXPECT_TRUE(
      refusal([](GltfBuilder& b) { meshoptOf(b, 0)["buffer"] = 2; }).starts_with(vertices + "/buffer"));
}

TEST(GltfDraco, GeometryComesBackAsItWas) {
  const Grid grid;
  const auto expected = cornersOf(plainScene(grid));
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    GltfBuilder builder = dracoGrid(grid, dracoBytes(grid, method));
    const Scene scene = load(builder);
    const auto found = cornersOf(scene);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      // Sorted by x, which is a whole number: those of 16 bits are off by a little, and may sort otherwise.
      EXPECT_NEAR(found[i][0], expected[i][0], 1e-3f);
    }
    double area = 0.0, expectedArea = 0.0;
    const Scene plain = plainScene(grid);
    for (size_t t = 0; t < plain.triangles.size(); ++t) {
      area += double(frontOf(scene, t).z);
      expectedArea += double(frontOf(plain, t).z);
    }
    EXPECT_NEAR(area, expectedArea, 0.05);
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(GltfDraco, StreamsThatAreNotWhatTheAccessorsSayAreRefused) {
  const Grid grid;
  const std::string bytes = dracoBytes(grid);
  const std::string place = "test.gltf: /meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  const auto refusal = [&](const auto& breakIt) {
    GltfBuilder builder = dracoGrid(grid, bytes);
    breakIt(builder);
    return faultOf(builder);
  };
  const std::string counts = ": has other counts than its accessors; those of the stream are taken";
  EXPECT_EQ(refusal([](GltfBuilder&) {}), "");
  EXPECT_EQ(refusal([](GltfBuilder& b) { b.root["accessors"][0]["count"] = 145; }), place + counts);
  EXPECT_EQ(refusal([](GltfBuilder& b) { b.root["accessors"][1]["count"] = 723; }), place + counts);
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["accessors"][0]["type"] = "VEC2";
              }).starts_with(place + ": has 3 components in attribute 0, not 2"));
  EXPECT_EQ(refusal([](GltfBuilder& b) { dracoOf(b)["attributes"]["POSITION"] = 7; }),
            place + ": has no attribute 7");
  EXPECT_TRUE(
      refusal([](GltfBuilder& b) { dracoOf(b)["bufferView"] = 1; }).starts_with(place + "/bufferView"));
  EXPECT_EQ(refusal([](GltfBuilder& b) { b.root["meshes"][0]["primitives"][0].erase("indices"); }),
            place + counts);
  EXPECT_TRUE(refusal([](GltfBuilder& b) {
                b.root["accessors"][0]["count"] = uint64_t(1) << 40;
              }).starts_with(place + ": has an accessor with too many elements"));
}

/// The schema forbids it; files have it.
TEST(GltfDraco, WithoutAttributesThePrimitivesOwnDataAreTaken) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["indices"] = builder.addAccessor<uint16_t>("SCALAR", {0, 1, 2});
  primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}, {"attributes", json::object()}};
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const Scene scene = load(builder);
  EXPECT_EQ(scene.triangles.size(), 1u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  const std::string place =
      "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes: is empty";
  EXPECT_TRUE(anyWarningHas(scene, place + "; the primitive's own data are taken"));
  builder.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"].erase("attributes");
  EXPECT_TRUE(anyWarningHas(load(builder), place + "; the primitive's own data are taken"));
  // As glTF Transform writes it, for a primitive whose accessors are sparse.
  builder.root["accessors"][1].erase("bufferView");
  builder.root["accessors"][1]["sparse"] = {
      {"count", 3},
      {"indices", {{"bufferView", builder.addView<uint8_t>({0, 1, 2})}, {"componentType", 5121}}},
      {"values", {{"bufferView", builder.addView<uint16_t>({0, 1, 2})}}}};
  EXPECT_EQ(load(builder).triangles.size(), 1u);
  builder.root["accessors"][1].erase("sparse");
  EXPECT_EQ(refusalOf(builder),
            "test.gltf: " + place + ", and not all of the primitive's own accessors have data");
}

TEST(GltfDraco, BrokenStreamsAreRefusedAndEndNothing) {
  const Grid grid;
  const std::string bytes = dracoBytes(grid);
  size_t refused = 0;
  for (size_t i = 0; i < bytes.size(); i += bytes.size() / 24) {
    std::string broken = bytes;
    broken[i] = char(broken[i] ^ 0x5a);
    GltfBuilder builder = dracoGrid(grid, broken);
    const std::string reason = refusalOf(builder);
    refused += !reason.empty();
    EXPECT_TRUE(reason.empty() || reason.find("KHR_draco_mesh_compression") != std::string::npos) << reason;
    GltfBuilder cut = dracoGrid(grid, bytes.substr(0, i + 1));
    EXPECT_NE(refusalOf(cut), "") << i;
  }
  EXPECT_GT(refused, 4u);
}

/// Behind the 11 bytes of the header, some of the next ones are the stream's own counts of triangles and
/// vertices.
TEST(GltfDraco, CountsOfTheStreamTakeNoUnboundedMemory) {
  const Grid grid;
  for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
    const std::string bytes = dracoBytes(grid, method);
    for (size_t i = 11; i < 17; ++i) {
      std::string broken = bytes;
      broken.replace(i, 2, "\xff\xff\xff\xff\x07");
      GltfBuilder builder = dracoGrid(grid, broken);
      EXPECT_NE(refusalOf(builder).find("KHR_draco_mesh_compression"), std::string::npos) << i;
    }
  }
}

TEST(GltfDraco, WhatItDecodesToIsCountedBefore) {
  const Grid grid;
  GltfBuilder builder = dracoGrid(grid, dracoBytes(grid));
  builder.root["accessors"][0]["count"] = 4'000'000'000u;
  GltfOptions options;
  options.limits.memoryBytes = uint64_t(1) << 30;
  try {
    load(builder, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("KHR_draco_mesh_compression: "), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
