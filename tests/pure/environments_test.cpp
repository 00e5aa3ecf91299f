// SPDX-License-Identifier: MIT
#include "view/files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "image_test_folder.h"
#include "view/view_state.h"

namespace fragtrace {
namespace {

struct EnvironmentsFiles : ImageTestFolder {};

TEST_F(EnvironmentsFiles, AreThoseBesideTheSceneAndBesideTheCurrentOne) {
  std::filesystem::create_directories(folder / "skies");
  for (const char* name : {"scene.gltf", "b.hdr", "a.EXR", "photo.png", "skies/c.pfm"})
    std::ofstream(folder / name) << "x";
  RenderOptions options;
  options.scene = folder / "scene.gltf";
  const auto names = [&] {
    std::string text;
    for (const auto& file : environmentsNear(options)) text += file.filename().string() + " ";
    return text;
  };
  EXPECT_EQ(names(), "a.EXR b.hdr ");
  options.light.hdriFile = folder / "skies/c.pfm";
  EXPECT_EQ(names(), "a.EXR b.hdr c.pfm ");
  options.light.hdriFile = folder / "b.hdr";
  EXPECT_EQ(names(), "a.EXR b.hdr ");
  options.scene = folder / "gone/scene.gltf";
  options.light.hdriFile.clear();
  EXPECT_EQ(names(), "");
}

TEST(Environments, EachChoiceIsTheCurrentOneOnceItIsTaken) {
  for (const bool unlit : {false, true}) {
    ViewedScene scene;
    scene.defaultLight = unlit;
    scene.environments = {"/maps/a.hdr", "/maps/b.hdr"};
    scene.options.light.hdriFile = "/elsewhere/c.exr";
    const std::vector<EnvironmentChoice> choices = environmentChoices(scene);
    EXPECT_EQ(choices.size(), unlit ? 7u : 6u);
    EXPECT_EQ(choices[currentChoice(scene, choices)].name, "c.exr");
    for (const EnvironmentChoice& choice : choices) {
      ViewedScene chosen = scene;
      chosen.options = withEnvironment(scene.options, choice);
      if (hasMap(chosen.options)) chosen.surroundings = Surroundings::Map;
      const std::vector<EnvironmentChoice> now = environmentChoices(chosen);
      EXPECT_EQ(now[currentChoice(chosen, now)], choice) << choice.name;
    }
  }
}

TEST(Environments, TheStudioByDefaultIsTheStudio) {
  ViewedScene scene;
  scene.defaultLight = true;
  scene.surroundings = Surroundings::Map;
  scene.options.light.defaultLight = DefaultLight::Studio;
  const std::vector<EnvironmentChoice> choices = environmentChoices(scene);
  EXPECT_EQ(choices[currentChoice(scene, choices)].name, "Studio");
}

TEST(Environments, WhatEmissionByEyeCouldChangeIsNamed) {
  const auto named = [](Surroundings surroundings, const char* place) {
    ViewedScene scene;
    scene.surroundings = surroundings;
    RenderOptions options;
    options.selection.set = {{place, {0.0}}};
    nameLight(options, scene);
    return std::pair(options.light.studio, options.light.defaultLight);
  };
  const char* emission = "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength";
  using enum DefaultLight;
  EXPECT_EQ(named(Surroundings::Map, emission), std::pair(true, Studio));
  EXPECT_EQ(named(Surroundings::None, "/materials/0/emissiveFactor"), std::pair(false, None));
  EXPECT_EQ(named(Surroundings::DefaultLight, emission), std::pair(false, Studio));
  EXPECT_EQ(named(Surroundings::Map, "/materials/0/alphaCutoff"), std::pair(false, Studio));
}

TEST(Environments, WhatTheProgramDecidedIsNamed) {
  ViewedScene scene;
  scene.surroundings = Surroundings::Map;
  RenderOptions options;
  nameLight(options, scene);
  EXPECT_EQ(options, RenderOptions());
  scene.light.own = OwnLight::Dim;
  scene.light.lampScale = 1.0 / kLumensPerWatt;
  nameLight(options, scene);
  EXPECT_TRUE(options.light.studio);
  EXPECT_EQ(options.light.lampUnits, LampUnits::Radiometric);
}

}  // namespace
}  // namespace fragtrace
