// SPDX-License-Identifier: MIT
// KHR_node_visibility, and its animation.
#include <gtest/gtest.h>

#include <algorithm>

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

json visibility(bool visible) { return {{"KHR_node_visibility", {{"visible", visible}}}}; }

/// Node 0 holds a triangle, node 1 its parent, node 2 another triangle below no one, node 3 a lamp below node
/// 1 and node 4 a camera there.
GltfBuilder family() {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual", "KHR_animation_pointer"};
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  builder.root["nodes"].push_back({{"children", {0, 3, 4}}});
  builder.root["nodes"].push_back({{"mesh", 0}});
  builder.root["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  builder.root["nodes"].push_back({{"camera", 0}});
  return builder;
}

TEST(GltfVisibility, AHiddenNodeHidesAllBelowItButCameras) {
  GltfBuilder all = family();
  EXPECT_EQ(load(all).triangles.size(), 2u);
  for (const bool belowIsShown : {false, true}) {
    GltfBuilder builder = family();
    builder.node(1)["extensions"] = visibility(false);
    if (belowIsShown) builder.node(0)["extensions"] = visibility(true);
    const Scene scene = load(builder);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(GltfVisibility, TheUserHidesByNamePointerOrIndex) {
  for (const char* name : {"parent", "/nodes/1", "1"}) {
    GltfBuilder builder = family();
    builder.node(1)["name"] = "parent";
    GltfOptions options;
    options.selection.hiddenNodes = {name};
    const Scene scene = load(builder, options);
    EXPECT_EQ(scene.triangles.size(), 1u) << name;
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_EQ(scene.cameras.size(), 1u);
  }
  GltfBuilder builder = family();
  GltfOptions options;
  options.selection.hiddenNodes = {"5"};
  EXPECT_THROW(load(builder, options), UsageError);
}

TEST(GltfVisibility, NodesAreListedWithWhatTheyHold) {
  GltfBuilder builder = family();
  builder.node(2)["name"] = "beside";
  builder.node(2)["extensions"] = visibility(false);
  GltfOptions options;
  options.selection.hiddenNodes = {"/nodes/1"};
  const std::vector<SceneNode> nodes = load(builder, options).nodes;
  ASSERT_EQ(nodes.size(), 5u);
  const auto one = [&](uint32_t index) { return *std::ranges::find(nodes, index, &SceneNode::index); };
  EXPECT_EQ(one(1).depth, 0);
  EXPECT_EQ(one(0).depth, 1);
  EXPECT_TRUE(one(0).hidden && !one(0).hiddenInFile && one(0).mesh);
  EXPECT_TRUE(one(2).hidden && one(2).hiddenInFile);
  EXPECT_TRUE(one(3).light && !one(3).mesh);
  EXPECT_TRUE(one(4).camera);
  EXPECT_EQ(one(2).name, "beside");
  EXPECT_EQ(one(4).name, "/nodes/4");
}

TEST(GltfVisibility, OneThatIsShownOrSaysNothingIsDrawn) {
  GltfBuilder builder = family();
  builder.node(1)["extensions"] = visibility(true);
  builder.node(2)["extensions"] = {{"KHR_node_visibility", json::object()}};
  EXPECT_EQ(load(builder).triangles.size(), 2u);
  EXPECT_EQ(load(builder).lights.size(), 1u);
}

TEST(GltfVisibility, WhatIsNoFlagIsAbsent) {
  GltfBuilder builder = family();
  builder.node(1)["extensions"] = {{"KHR_node_visibility", {{"visible", 0}}}};
  EXPECT_TRUE(anyWarningHas(load(builder), "/visible: is not true or false; it is taken as absent"));
}

/// Hidden from 1 to 2 seconds, in steps whatever the sampler says.
TEST(GltfVisibility, IsAnimatedAsAStep) {
  GltfBuilder builder = family();
  builder.node(1)["extensions"] = visibility(true);
  const int times = builder.addAccessor<float>("SCALAR", {0, 1, 2});
  const int values = builder.addAccessor<uint8_t>("SCALAR", {1, 0, 1});
  const json target = {
      {"path", "pointer"},
      {"extensions",
       {{"KHR_animation_pointer", {{"pointer", "/nodes/1/extensions/KHR_node_visibility/visible"}}}}}};
  for (const char* interpolation : {"STEP", "LINEAR"}) {
    builder.root["animations"] = {
        {{"samplers", {{{"input", times}, {"output", values}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", target}}}}}};
    const auto shown = [&](double seconds) {
      GltfOptions options;
      options.selection.animationTime = seconds;
      return load(builder, options).triangles.size();
    };
    EXPECT_EQ(shown(0.9), 2u) << interpolation;
    EXPECT_EQ(shown(1.0), 1u) << interpolation;
    EXPECT_EQ(shown(1.9), 1u) << interpolation;
    EXPECT_EQ(shown(2.5), 2u) << interpolation;
  }
}

}  // namespace
}  // namespace fragtrace::gltf_test
