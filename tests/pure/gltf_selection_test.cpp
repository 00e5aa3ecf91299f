// SPDX-License-Identifier: MIT
// Scenes and material variants that the user chooses.
#include <gtest/gtest.h>

#include "gltf/read/diagnostics.h"

#include "gltf_builder.h"

namespace fragtrace::gltf_test {
namespace {

Scene loadSelected(GltfBuilder& builder, const SceneSelection& selection) {
  GltfOptions options;
  options.selection = selection;
  return load(builder, options);
}

std::string usageErrorOf(GltfBuilder& builder, const SceneSelection& selection) {
  try {
    loadSelected(builder, selection);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

GltfBuilder twoScenes() {
  GltfBuilder builder;
  builder.addTriangle();
  builder.root["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  builder.root["scenes"] = {{{"nodes", {0}}, {"name", "first"}}, {{"nodes", {1}}, {"name", "second"}}};
  builder.root["scene"] = 0;
  return builder;
}

/// Materials "a" and "b", and a triangle that is "b" in the variants "night" and "rain".
GltfBuilder variants() {
  GltfBuilder builder;
  json& primitive = builder.addTriangle();
  primitive["material"] = 0;
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1, 2}}}};
  builder.root["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  builder.root["extensionsUsed"] = {"KHR_materials_variants"};
  builder.root["extensions"]["KHR_materials_variants"]["variants"] = {
      {{"name", "day"}}, {{"name", "night"}}, {{"name", "rain"}}};
  return builder;
}

std::string materialOf(const Scene& scene) { return scene.materials[scene.triangles.at(0).material].name; }

TEST(GltfSelection, PartsAreListedByIndexAndNameWithoutTerminalCommands) {
  EXPECT_EQ(listOfParts({"walk", "", "a\nb\x1b[31m"}), "0 \"walk\", 1, 2 \"a?b?[31m\"");
}

TEST(GltfSelection, ScenesAreChosenByNameOrIndex) {
  GltfBuilder builder = twoScenes();
  EXPECT_TRUE(isNear(worldCornerOf(load(builder), 0, 0), {0, 0, 0}));
  for (const std::string name : {"second", "1"}) {
    const Scene scene = loadSelected(builder, {.scene = name});
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_TRUE(isNear(worldCornerOf(scene, 0, 0), {5, 0, 0}));
  }
  EXPECT_EQ(load(builder).sceneNames, (std::vector<std::string>{"first", "second"}));
}

TEST(GltfSelection, WhatIsNotInTheFileIsAnErrorThatListsWhatIs) {
  GltfBuilder scenes = twoScenes();
  EXPECT_EQ(usageErrorOf(scenes, {.scene = "third"}),
            "--scene: \"third\" is not in the file, which has 0 \"first\", 1 \"second\"");
  EXPECT_NE(usageErrorOf(scenes, {.scene = "2"}), "");
  EXPECT_NE(usageErrorOf(scenes, {.scene = "-1"}), "");
  EXPECT_EQ(usageErrorOf(scenes, {.materialVariant = "x"}),
            "--material-variant: \"x\" is not in the file, which has none");
  GltfBuilder builder = variants();
  EXPECT_EQ(usageErrorOf(builder, {.materialVariant = "x"}),
            "--material-variant: \"x\" is not in the file, which has 0 \"day\", 1 \"night\", 2 \"rain\"");
}

TEST(GltfSelection, VariantsGiveTheirMaterials) {
  GltfBuilder builder = variants();
  EXPECT_EQ(materialOf(load(builder)), "a");
  EXPECT_EQ(materialOf(loadSelected(builder, {.materialVariant = "day"})), "a");
  EXPECT_EQ(materialOf(loadSelected(builder, {.materialVariant = "night"})), "b");
  EXPECT_EQ(materialOf(loadSelected(builder, {.materialVariant = "2"})), "b");
  EXPECT_EQ(load(builder).materialVariants, (std::vector<std::string>{"day", "night", "rain"}));
  EXPECT_TRUE(load(builder).warnings.empty());
}

TEST(GltfSelection, AVariantThatChangesNothingIsWarnedAbout) {
  GltfBuilder builder = variants();
  builder.root["extensions"]["KHR_materials_variants"]["variants"].push_back({{"name", "fog"}});
  EXPECT_TRUE(loadSelected(builder, {.materialVariant = "night"}).warnings.empty());
  const Scene scene = loadSelected(builder, {.materialVariant = "fog"});
  EXPECT_EQ(materialOf(scene), "a");
  EXPECT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(
      anyWarningHas(scene, "/extensions/KHR_materials_variants/variants/3: no primitive has a material"));
}

TEST(GltfSelection, VariantsThatAreNotThereAreRefused) {
  GltfBuilder builder = variants();
  builder.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"][0]
              ["variants"][1] = 3;
  EXPECT_TRUE(refusalOf(builder).starts_with(
      "test.gltf: /meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/variants/1: index 3"));
}

}  // namespace
}  // namespace fragtrace::gltf_test
