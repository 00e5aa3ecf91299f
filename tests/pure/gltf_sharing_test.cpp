// SPDX-License-Identifier: MIT
// Tests which meshes the scene holds once, and that they stand where their copies would.
#include "gltf/assemble/meshes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "bvh/bvh.h"
#include "bvh/exact_tracer.h"
#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

constexpr uint64_t kMegabyte = 1000000;
constexpr uint64_t kPlenty = uint64_t(1) << 40;

GltfOptions sharing() {
  GltfOptions options;
  options.instancing = Instancing::Share;
  return options;
}

/// The triangle of GltfBuilder in three nodes.
GltfBuilder threeTriangles() {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  builder.root["nodes"].push_back({{"mesh", 0}, {"name", "moved"}, {"translation", {5, 0, -3}}});
  builder.root["nodes"].push_back({{"mesh", 0}, {"name", "mirrored"}, {"scale", {-2, 3, 1}}});
  return builder;
}

/// A grid of 2 * side * side triangles that its node shows so many times.
GltfBuilder manyGrids(uint32_t side, int count) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y <= side; ++y) {
    for (uint32_t x = 0; x <= side; ++x) {
      positions.insert(positions.end(), {float(x) / float(side), float(y) / float(side), 0.0f});
      if (x == side || y == side) continue;
      const uint32_t i = y * (side + 1) + x;
      indices.insert(indices.end(), {i, i + 1, i + side + 1, i + 1, i + side + 2, i + side + 1});
    }
  }
  GltfBuilder builder;
  json& primitive = builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", positions)}});
  primitive["indices"] = builder.addAccessor<uint32_t>("SCALAR", indices);
  std::vector<float> places;
  for (int i = 0; i < count; ++i) {
    const int row = i / 30;
    places.insert(places.end(), {float(i % 30), float(row), float(i % 7)});
  }
  const int accessor = builder.addAccessor<float>("VEC3", places);
  builder.node(0)["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = accessor;
  return builder;
}

TEST(GltfSharing, PaysWhereItSavesHalfOfMuchMemory) {
  EXPECT_FALSE(paysToShare({60 * kMegabyte, 1 * kMegabyte}, kPlenty));
  EXPECT_TRUE(paysToShare({80 * kMegabyte, 1 * kMegabyte}, kPlenty));
  EXPECT_TRUE(paysToShare({80 * kMegabyte, 39 * kMegabyte}, kPlenty));
  EXPECT_FALSE(paysToShare({80 * kMegabyte, 41 * kMegabyte}, kPlenty));
}

TEST(GltfSharing, PaysWhereTheLimitAllowsNoCopies) {
  EXPECT_TRUE(paysToShare({80 * kMegabyte, 70 * kMegabyte}, 75 * kMegabyte));
  EXPECT_FALSE(paysToShare({80 * kMegabyte, 80 * kMegabyte}, 75 * kMegabyte));
}

TEST(GltfSharing, IsChosenForManyInstancesOfMuch) {
  GltfBuilder builder = manyGrids(30, 400);
  GltfOptions options;
  options.instancing = Instancing::Auto;
  const Scene shared = load(builder, options);
  EXPECT_EQ(shared.sharedMeshes.size(), 1u);
  EXPECT_EQ(shared.instances.size(), 400u);
  EXPECT_EQ(shared.triangles.size(), 1800u);
  EXPECT_EQ(flatTriangleCount(shared), 0u);
  EXPECT_TRUE(shared.sharing.starts_with("saves memory: ")) << shared.sharing;
  GltfBuilder few = manyGrids(30, 20);
  const Scene flat = load(few, options);
  EXPECT_TRUE(flat.instances.empty());
  EXPECT_EQ(flat.triangles.size(), 36000u);
  EXPECT_TRUE(flat.sharing.starts_with("too little to save: ")) << flat.sharing;
}

TEST(GltfSharing, OnlyWhatIsUniqueCountsAgainstTheMemoryLimit) {
  GltfBuilder builder = manyGrids(30, 400);
  GltfOptions options;
  options.limits.memoryBytes = 20 * kMegabyte;
  EXPECT_THROW(load(builder, options), InputError);
  options.instancing = Instancing::Auto;
  EXPECT_EQ(load(builder, options).instances.size(), 400u);
}

TEST(GltfSharing, InstancesStandWhereCopiesWould) {
  GltfBuilder builder = threeTriangles();
  const Scene shared = load(builder, sharing());
  const Scene flat = load(builder);
  EXPECT_EQ(shared.bounds.minimum, flat.bounds.minimum);
  EXPECT_EQ(shared.bounds.maximum, flat.bounds.maximum);
  ASSERT_EQ(shared.instances.size(), 3u);
  ASSERT_EQ(shared.triangles.size(), 1u);
  ASSERT_EQ(flat.triangles.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const bool mirrors = glm::determinant(glm::dmat3(shared.instances[i].toLocal)) < 0.0;
    EXPECT_EQ(mirrors, i == 2);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3 inMesh = cornerOf(shared, 0, corner);
      for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(inMesh[axis]), 1.0f);
      const glm::dvec3 found(shared.instances[i].toLocal * glm::dvec4(inMesh, 1.0));
      // The copy of a mirrored triangle is turned round.
      const int other = mirrors ? (3 - corner) % 3 : corner;
      EXPECT_TRUE(isNear(cornerOf(flat, i, other), found)) << i << ", " << corner;
    }
  }
}

TEST(GltfSharing, WhatShinesOrIsScaledTooUnevenlyOrStandsThereOnceIsCopied) {
  GltfBuilder shining = threeTriangles();
  shining.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
  shining.root["meshes"][0]["primitives"][0]["material"] = 0;
  const Scene copied = load(shining, sharing());
  EXPECT_EQ(copied.triangles.size(), 3u);
  EXPECT_TRUE(
      anyWarningHas(copied,
                    "nothing is shared: no mesh that can be shared appears often enough in the scene; "
                    "always copied: emissive meshes (1)"));

  GltfBuilder uneven = threeTriangles();
  uneven.node(2)["scale"] = {1, 1, 1000};
  uneven.root["nodes"].push_back({{"mesh", 0}, {"scale", {1, 1, 0}}});
  const Scene scene = load(uneven, sharing());
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(flatTriangleCount(scene), 2u);
  EXPECT_EQ(scene.triangles.size(), 3u);
  EXPECT_TRUE(anyWarningHas(scene,
                            "not all is shared: --instancing share: 0 MB instead of 0 MB; always copied: "
                            "unevenly scaled instances (2)"));
  EXPECT_TRUE(load(uneven).warnings.empty());

  GltfBuilder once;
  once.addTriangle();
  EXPECT_TRUE(load(once, sharing()).instances.empty());
}

TEST(GltfSharing, EverythingUnderThePointerHasItsNode) {
  GltfBuilder builder = threeTriangles();
  const Scene scene = load(builder, sharing());
  const Bvh bvh = buildSceneBvh(scene);
  Camera camera;
  camera.position = {5.25, 0.25, 2.0};
  const Projection projection = projectionOf(camera, 1.0);
  const auto pick = pickAt(scene, bvh, projection, {0.0, 0.0});
  ASSERT_TRUE(pick.has_value());
  EXPECT_EQ(pick->node, "moved");
  EXPECT_EQ(pick->mesh, "/meshes/0");
  EXPECT_EQ(pick->triangle, 0u);
  EXPECT_TRUE(isNear(pick->point, {5.25, 0.25, -3.0}));
  EXPECT_TRUE(isNear(pick->normal, {0, 0, 1}));
}

}  // namespace
}  // namespace fragtrace::gltf_test
