// SPDX-License-Identifier: MIT
// The viewer copies a whole command, and pasting it gives the same options.
#include "options/command_text.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "options/option_text.h"

namespace fragtrace {
namespace {

std::string refusal(const std::string& text) {
  try {
    withCommandText(RenderOptions(), text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

TEST(CommandText, IsAWholeCommandOfRender) {
  RenderOptions o;
  o.scene = "my scenes/it's.gltf";
  o.output.file = "it's-1.png";
  o.sampling.spp = 17;
  o.camera.resolution = glm::ivec2(640, 480);
  EXPECT_EQ(commandText(o),
            "fragtrace render 'my scenes/it'\\''s.gltf' --output 'it'\\''s-1.png' "
            "--resolution 640,480 --spp 17");
}

TEST(CommandText, LightGroupsAreRefusedWhereLightDoesNotAddUp) {
  const auto with = [](const std::string& words) {
    return refusal("fragtrace render a.gltf -o a.exr --aov light:key,light:rest " + words);
  };
  EXPECT_EQ(with("--clamp-indirect 2 --caustics on --denoise variance"),
            "--caustics on: light paths cannot be clamped (--clamp-indirect)");
  EXPECT_EQ(with("--caustics on --denoise variance"), "taken");
  EXPECT_EQ(with("--shadow-catcher bottom"),
            "--aov light:key: not with --shadow-catcher, whose shadows are a share of all light");
  EXPECT_EQ(with("--light-reuse candidates"),
            "--aov light:key: not with --light-reuse, which chooses light samples by their light");
  EXPECT_EQ(with("--debug-view normal"), "--aov light:key: not with --debug-view, which shows no light");
  EXPECT_EQ(with("--stage phong"), "--aov light:key: only stage gi has it");
  EXPECT_EQ(with("--aov light:"), "--aov light: the name of a light follows, such as light:environment");
  EXPECT_EQ(with("--aov light:a.b,light:a_b"),
            "--aov light:a_b: its layer has the name of that of light:a.b, light_a_b");
}

TEST(CommandText, StagesReadBackAsThemselves) {
  StageSet fewer = stagesUpTo(Stage::Gi);
  fewer.reset(size_t(Stage::Shadows)).reset(size_t(Stage::Sobol)).set(size_t(Stage::Schlick));
  for (const StageSet& stages : {StageSet(), fewer, stagesUpTo(Stage::Phong)}) {
    RenderOptions options;
    options.scene = "-odd.gltf";
    options.stages = stages;
    RenderOptions expected = options;
    expected.scene = "./-odd.gltf";
    EXPECT_EQ(withCommandText(RenderOptions(), commandText(options)), expected) << commandText(options);
  }
}

TEST(CommandText, WhatTheViewerHasOfItsOwnStays) {
  RenderOptions current;
  current.sampling.spp = 1 << 20;
  current.sampling.noise = 0.005;
  current.device.backend = Backend::OsMesa;
  current.camera.resolution = glm::ivec2(320, 240);
  const RenderOptions read = withCommandText(
      current,
      "build/fragtrace  render a.gltf -o x.exr --spp 4 \\\n --time 3 --resolution 64x48 --stage phong");
  EXPECT_EQ(read.sampling.spp, current.sampling.spp);
  EXPECT_EQ(read.sampling.noise, 0.005);
  EXPECT_EQ(read.sampling.seconds, 0.0);
  EXPECT_EQ(read.device.backend, Backend::OsMesa);
  EXPECT_EQ(read.camera.resolution, current.camera.resolution);
  EXPECT_EQ(read.stages, stagesUpTo(Stage::Phong));
  EXPECT_EQ(
      withCommandText(current, "fragtrace view a.gltf --watch --aov albedo --tree-level 2").output.treeLevel,
      2);
}

TEST(CommandText, CameraOptionsAloneChangeTheCameraAlone) {
  RenderOptions current;
  current.scene = "a.gltf";
  current.output.exposure = 2.0;
  const RenderOptions read = withCommandText(current, "--camera-position 1,2,3");
  EXPECT_EQ(read.camera.overrides.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(read.output.exposure, 2.0);
}

TEST(CommandText, RefusesInTheOrderOfTheText) {
  EXPECT_EQ(refusal("fragtrace render a.gltf one two --three && four"),
            "not understood: one two --three && four");
  EXPECT_EQ(refusal("--camera-index 1 one two --spp 3"), "not understood: one two --spp 3");
  EXPECT_EQ(refusal("hello"), "this is no command of fragtrace: hello");
  EXPECT_EQ(refusal("fragtrace info a.gltf"), "this is no command of fragtrace: fragtrace info a.gltf");
  for (const char* blank : {"", " \n\t "}) EXPECT_EQ(refusal(blank), "the clipboard is empty");
  EXPECT_EQ(refusal(std::string(100000, 'x')), "this is longer than any command");
  EXPECT_EQ(refusal("fragtrace render 'a.gltf"), "a ' has no end");
}

TEST(SplitWords, AsAShellDoes) {
  const std::vector<std::string> words{"a b", "c", "it's", "", "d\\e", "f"};
  EXPECT_EQ(splitWords("'a b' c \"it's\" '' 'd\\e' \\\n f\n"), words);
  for (const char* word : {"plain.gltf", "a b", "it's", "$HOME", "", "\\", "\"", "two\nlines"})
    EXPECT_EQ(splitWords(quoted(word)), std::vector<std::string>{word});
}

}  // namespace
}  // namespace fragtrace
