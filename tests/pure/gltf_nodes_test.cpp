// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtx/string_cast.hpp>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

TEST(GltfNodes, NestedTransformsEqualTheirProductAsMatrix) {
  // Turned by 90 degrees about z, scaled, moved; then the parent moves by (10, 0, 0).
  GltfBuilder nested;
  nested.addTriangle();
  const double h = std::sqrt(0.5);
  nested.node(0)["rotation"] = {0, 0, h, h};
  nested.node(0)["scale"] = {2, 3, 4};
  nested.node(0)["translation"] = {0, 1, 0};
  nested.root["nodes"].push_back({{"children", {0}}, {"translation", {10, 0, 0}}});
  GltfBuilder direct;
  direct.addTriangle();
  direct.node(0)["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 10, 1, 0, 1};
  const Scene a = load(nested);
  const Scene b = load(direct);
  const glm::dvec3 expected[3] = {{10, 1, 0}, {10, 3, 0}, {7, 1, 0}};
  for (int corner = 0; corner < 3; ++corner) {
    EXPECT_TRUE(isNear(worldCornerOf(a, 0, corner), expected[corner]));
    EXPECT_TRUE(isNear(worldCornerOf(b, 0, corner), expected[corner]));
  }
}

TEST(GltfNodes, MirroringKeepsFrontsOutsideAndNormalsOnTheFront) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  builder.node(0)["scale"] = {-1, 1, 1};
  const Scene scene = load(builder);
  EXPECT_GT(frontOf(scene, 0).z, 0.0f);
  EXPECT_EQ(scene.vertices.normal.at(0), glm::vec3(0, 0, 1));
}

TEST(GltfNodes, NormalsStayPerpendicularUnderUnevenScale) {
  GltfBuilder builder;
  // The plane x + y = 1, stretched tenfold along x.
  builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", {1, 0, 0, 0, 1, 0, 0, 1, 1})},
                   {"NORMAL", builder.addAccessor<float>("VEC3", {1, 1, 0, 1, 1, 0, 1, 1, 0})}});
  builder.node(0)["scale"] = {10, 1, 1};
  const Scene scene = load(builder);
  const glm::vec3 front = glm::normalize(frontOf(scene, 0));
  EXPECT_NEAR(std::abs(glm::dot(front, scene.vertices.normal.at(0))), 1.0f, 1e-6f);
  EXPECT_NEAR(glm::length(scene.vertices.normal.at(0)), 1.0f, 1e-6f);
}

TEST(GltfNodes, AMatrixThatFlattensEverythingGivesNoNaN) {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["attributes"]["NORMAL"] = builder.addAccessor<float>("VEC3", {1, 0, 0, 1, 0, 0, 1, 0, 0});
  builder.node(0)["scale"] = {0, 0, 0};
  const Scene scene = load(builder);
  EXPECT_NEAR(glm::length(scene.vertices.normal.at(0)), 1.0f, 1e-6f);
  EXPECT_EQ(cornerOf(scene, 0, 0), cornerOf(scene, 0, 1));
}

TEST(GltfNodes, AMeshSharedByNodesAppearsOncePerNode) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["nodes"].push_back({{"mesh", 0}, {"name", "second"}, {"translation", {5, 0, 0}}});
  const Scene scene = load(builder);
  ASSERT_EQ(scene.triangles.size(), 2u);
  ASSERT_EQ(scene.origins.size(), 2u);
  EXPECT_TRUE(isNear(worldCornerOf(scene, 1, 0), {5, 0, 0}));
  EXPECT_EQ(scene.origins[0].node, "/nodes/0");
  EXPECT_EQ(scene.origins[1].node, "second");
  EXPECT_EQ(scene.origins[1].firstTriangle, 1u);
}

/// The light of the file shines along its -Z, the triangle lies in its XY plane.
TEST(GltfNodes, TheUpAxisOfAFileIsTurnedToY) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.node(0)["translation"] = {1, 2, 3};
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  builder.root["nodes"].push_back({{"camera", 0}, {"translation", {4, 5, 6}}});
  struct Case {
    glm::dvec3 up;
    glm::dvec3 x, y, z;  ///< directions to which the file's axes turn
  };
  const Case cases[] = {
      {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},   {{0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},   {{-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
      {{0, -1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
  for (const auto& [up, x, y, z] : cases) {
    GltfOptions options;
    options.selection.up = up;
    const Scene scene = load(builder, options);
    EXPECT_NEAR(glm::dot(glm::cross(x, y), z), 1.0, 0.0);
    EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), x + 2.0 * y + 3.0 * z)) << glm::to_string(up);
    EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 1), 2.0 * x + 2.0 * y + 3.0 * z)) << glm::to_string(up);
    EXPECT_EQ(scene.cameras.at(0).position, 4.0 * x + 5.0 * y + 6.0 * z) << glm::to_string(up);
    EXPECT_EQ(scene.cameras.at(0).forward, -z) << glm::to_string(up);
  }
}

TEST(GltfNodes, OnlyTheDefaultSceneIsLoaded) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.addTriangle();
  builder.node(1)["translation"] = {7, 0, 0};
  builder.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  builder.root["scene"] = 1;
  EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 0), {7, 0, 0}));
  builder.root.erase("scene");
  EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 0), {0, 0, 0}));
  builder.root.erase("scenes");
  EXPECT_EQ(load(builder).triangles.size(), 2u);
}

TEST(GltfNodes, RecentringKeepsPrecisionFarFromTheOrigin) {
  GltfBuilder builder;
  builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, 0.001f, 0, 0, 0, 0.001f, 0})}});
  builder.node(0)["translation"] = {1e6, -1e6, 1e6};
  const Scene scene = load(builder);
  EXPECT_TRUE(isNear(scene.space.origin, {1e6, -1e6, 1e6}, 1.0));
  const double edge = scene.space.unit * double(glm::distance(cornerOf(scene, 0, 0), cornerOf(scene, 0, 1)));
  EXPECT_NEAR(edge, 0.001, 0.001 * 1e-6);
  EXPECT_TRUE(isNear(scene.bounds.maximum, {1e6 + 0.001, -1e6 + 0.001, 1e6}, 1e-9));
}

/// Numbers that drivers flush to zero, and those whose squares overflow.
TEST(GltfNodes, LocalSpaceIsOfAnOrdinarySize) {
  for (const float size : {1e-44f, 1e-39f, 1e-6f, 1e9f, 1e30f}) {
    GltfBuilder builder;
    builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, size, 0, 0, 0, size, 0})}});
    const Scene scene = load(builder);
    const float edge = glm::distance(cornerOf(scene, 0, 0), cornerOf(scene, 0, 1));
    EXPECT_GT(edge, 1.0f) << size;
    EXPECT_LE(edge, 2048.0f) << size;
    EXPECT_EQ(double(edge) * scene.space.unit, double(size));
    EXPECT_EQ(worldCornerOf(scene, 0, 1), glm::dvec3(double(size), 0, 0));
  }
}

/// Found by fuzzing.
TEST(GltfNodes, VerticesThatNoTriangleUsesAreFiniteHoweverFarAway) {
  GltfBuilder builder;
  const std::vector<float> positions = {0, 0, 0, 1e-40f, 0, 0, 0, 1e-40f, 0, 0, 0, 3e38f};
  builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", positions)}})["indices"] =
      builder.addAccessor<uint32_t>("SCALAR", {0, 1, 2});
  for (const glm::vec3& position : load(builder).vertices.position) EXPECT_TRUE(std::isfinite(position.z));
}

TEST(GltfNodes, WhatIsTooSmallToCalculateWithIsLeftOutWithAWarning) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["nodes"].push_back({{"mesh", 0}, {"scale", {1e-300, 1e-300, 1e-300}}});
  builder.root["nodes"].push_back({{"mesh", 0}, {"scale", {0, 0, 0}}});
  const Scene scene = load(builder);
  EXPECT_EQ(scene.triangles.size(), 2u);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].ends_with(
      "test.gltf: /nodes/1/scale: its mesh is less than 1e-75 m in size, and left out"));
  builder.root["nodes"].push_back({{"children", {1}}, {"scale", {1e-200, 1e-200, 1e-200}}});
  EXPECT_EQ(faultOf(builder), "test.gltf: /nodes/1: its world transform underflows; the node is left out");
}

/// Wherever its other parts are.
TEST(GltfNodes, WhatIsTooFarAwayIsLeftOut) {
  GltfBuilder builder;
  builder.addMesh(
      {{"POSITION", builder.addAccessor<float>("VEC3", {1.5e38f, 0, 0, 1.5e38f, 1, 0, 1.5e38f, 0, 1})}});
  const std::string reason = "its mesh reaches farther than 1e30 m from the origin";
  EXPECT_EQ(refusalOf(builder), "test.gltf: /nodes/0: " + reason);
  builder.node(0)["scale"] = {1e-38, 1, 1};
  EXPECT_EQ(load(builder).triangles.size(), 1u);
  builder.root["nodes"].push_back({{"mesh", 0}, {"scale", {1e-38, 1, 1}}, {"translation", {0, -1e31, 0}}});
  EXPECT_EQ(faultOf(builder), "test.gltf: /nodes/1: " + reason + "; the mesh here is left out");
  EXPECT_EQ(load(builder).triangles.size(), 1u);
}

/// The nearest point of the scene to the camera, unless it stands far outside.
TEST(GltfNodes, TheOriginIsNearTheCamera) {
  GltfBuilder builder;
  builder.addMesh({{"POSITION", builder.addAccessor<float>("VEC3", {0, 0, 0, 8, 0, 0, 0, 8, 8})}});
  EXPECT_EQ(load(builder).space.origin, glm::dvec3(4, 4, 4));
  EXPECT_EQ(load(builder, {.cameraPosition = glm::dvec3(1, 2, 3)}).space.origin, glm::dvec3(1, 2, 3));
  EXPECT_EQ(load(builder, {.cameraPosition = glm::dvec3(1, 9, 3)}).space.origin, glm::dvec3(1, 8, 3));
  EXPECT_EQ(load(builder, {.cameraPosition = glm::dvec3(1, 20, 3)}).space.origin, glm::dvec3(4, 4, 4));
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  builder.root["nodes"].push_back({{"camera", 0}, {"translation", {7, 7, 7}}});
  EXPECT_EQ(load(builder).space.origin, glm::dvec3(7, 7, 7));
  EXPECT_EQ(load(builder, {.recenterOn = glm::dvec3(2, 2, 2)}).space.origin, glm::dvec3(2, 2, 2));
}

TEST(GltfNodes, TheOriginMayBeChosen) {
  GltfBuilder builder;
  builder.addTriangle();
  const Scene scene = load(builder, {.recenterOn = glm::dvec3(0, 0, 2)});
  EXPECT_EQ(scene.space.origin, glm::dvec3(0, 0, 2));
  EXPECT_EQ(cornerOf(scene, 0, 1), glm::vec3(1, 0, -2));
}

TEST(GltfNodes, PerspectiveCameraIsFreeOfItsNodesScale) {
  GltfBuilder builder;
  builder.root["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}}};
  const double h = std::sqrt(0.5);
  builder.root["nodes"] = {
      {{"camera", 0}, {"rotation", {0, h, 0, h}}, {"scale", {3, 2, 5}}, {"translation", {1e7, 0.125, 0}}}};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.type, CameraType::Perspective);
  EXPECT_EQ(camera.fovY, 0.5);
  EXPECT_EQ(camera.aspectRatio, 1.5);
  EXPECT_EQ(camera.position, glm::dvec3(1e7, 0.125, 0));
  EXPECT_TRUE(isNear(camera.forward, {-1, 0, 0}, 1e-12));
  EXPECT_TRUE(isNear(camera.up, {0, 1, 0}, 1e-12));
}

TEST(GltfNodes, OrthographicCameraHasHalfHeightAndAspectRatio) {
  GltfBuilder builder;
  builder.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}}}};
  builder.root["nodes"] = {{{"camera", 0}}};
  const Camera camera = load(builder).cameras.at(0);
  EXPECT_EQ(camera.type, CameraType::Orthographic);
  EXPECT_EQ(camera.halfHeight, 2.0);
  EXPECT_EQ(camera.aspectRatio, 2.0);
}

TEST(GltfNodes, LightsAreRecentredAndKeepTheirIntensityUnderScale) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}},
      {{"type", "spot"}, {"range", 4}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
      {{"type", "directional"}}};
  const auto lightNode = [](int light) {
    return json{{"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
  };
  json point = lightNode(0);
  point["translation"] = {0, 0, 3};
  point["scale"] = {2, 2, 2};
  json directional = lightNode(2);
  directional["rotation"] = {1, 0, 0, 0};
  builder.root["nodes"].push_back(point);
  builder.root["nodes"].push_back(lightNode(1));
  builder.root["nodes"].push_back(directional);
  const Scene scene = load(builder, {.recenterOn = glm::dvec3(0, 0, 1)});
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].type, LightType::Point);
  EXPECT_EQ(scene.lights[0].intensity, glm::vec3(10, 5, 0));
  EXPECT_EQ(scene.lights[0].position, glm::vec3(0, 0, 2));
  EXPECT_TRUE(std::isinf(scene.lights[0].range));
  EXPECT_EQ(scene.lights[1].type, LightType::Spot);
  EXPECT_FLOAT_EQ(scene.lights[1].outerConeAngle, 0.2f);
  EXPECT_EQ(scene.lights[1].range, 4.0f);
  EXPECT_EQ(scene.lights[2].type, LightType::Directional);
  EXPECT_TRUE(isNear(scene.lights[2].direction, {0, 0, 1}));
}

GltfBuilder sphereScene() {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_implicit_shapes"]["shapes"] = {
      {{"type", "box"}}, {{"type", "sphere"}, {"sphere", {{"radius", 0.25}}}}};
  builder.root["materials"] = {{{"name", "first"}}};
  builder.root["nodes"] = {{{"extras", {{"shape", 1}, {"material", 0}}}, {"translation", {1, 2, 3}}}};
  return builder;
}

TEST(GltfNodes, SphereIsPlacedByItsNode) {
  GltfBuilder builder = sphereScene();
  builder.node(0)["scale"] = {2, 2, 2};
  const Scene scene = load(builder);
  ASSERT_EQ(scene.spheres.size(), 1u);
  EXPECT_EQ(scene.spheres[0].radius, 0.5f);
  EXPECT_EQ(scene.spheres[0].material, 0u);
  EXPECT_TRUE(isNear(glm::dvec3(scene.spheres[0].center) + scene.space.origin, {1, 2, 3}));
  EXPECT_EQ(scene.spheres[0].node, "/nodes/0");
  EXPECT_EQ(scene.bounds.minimum, glm::dvec3(0.5, 1.5, 2.5));
  EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(GltfNodes, SpheresAndLightsOfNoSizeOrTooFarAwayAreLeftOut) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["extensions"] = {
      {"KHR_implicit_shapes", {{"shapes", {{{"type", "sphere"}, {"sphere", {{"radius", 1}}}}}}}},
      {"KHR_lights_punctual", {{"lights", {{{"type", "point"}}}}}}};
  builder.root["extensionsUsed"] = {"KHR_implicit_shapes", "KHR_lights_punctual"};
  builder.root["nodes"].push_back(
      {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 1e30, 0}}});
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(anyWarningHas(scene, "/nodes/1: its light is too far away for a scene of this size"));
  builder.node(1) = {{"extras", {{"shape", 0}}}, {"translation", {0, 0, 1e31}}};
  EXPECT_EQ(
      faultOf(builder),
      "test.gltf: /nodes/1: its sphere reaches farther than 1e30 m from the origin; the sphere is left out");
  for (const double scale : {0.0, 1e-300, 1e-150}) {
    builder.node(1) = {{"extras", {{"shape", 0}}}, {"scale", {scale, scale, scale}}};
    EXPECT_EQ(faultOf(builder),
              "test.gltf: /nodes/1: its sphere has no radius above 0; the sphere is left out");
  }
}

TEST(GltfNodes, SphereWithoutMaterialGetsTheDefaultOne) {
  GltfBuilder builder = sphereScene();
  builder.node(0)["extras"].erase("material");
  const Scene scene = load(builder);
  EXPECT_EQ(scene.spheres.at(0).material, 1u);
  EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(GltfNodes, UnevenlyScaledSphereIsRefused) {
  GltfBuilder builder = sphereScene();
  builder.node(0)["scale"] = {2, 2, 1};
  EXPECT_EQ(refusalOf(builder), "test.gltf: /nodes/0: scales a sphere unevenly");
}

TEST(GltfNodes, OtherImplicitShapesAreLeftOutWithAWarning) {
  GltfBuilder builder = sphereScene();
  builder.node(0)["extras"]["shape"] = 0;
  const Scene scene = load(builder);
  EXPECT_TRUE(scene.spheres.empty());
  EXPECT_TRUE(anyWarningHas(scene, "/nodes/0/extras/shape: a shape of type \"box\" is left out"));
}

TEST(GltfNodes, ExtrasNamedShapeMeanNothingWithoutTheExtension) {
  GltfBuilder builder;
  builder.addTriangle();
  builder.node(0)["extras"] = {{"shape", 12}};
  EXPECT_TRUE(load(builder).spheres.empty());
}

}  // namespace
}  // namespace fragtrace::gltf_test
