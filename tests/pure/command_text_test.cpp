// SPDX-License-Identifier: MIT
// What the viewer copies is a whole command, and what it pastes gives the same options.
#include "options/command_text.h"

#include <gtest/gtest.h>

#include <functional>

#include "errors.h"
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

/// One change of each option that makes the picture another.
std::vector<std::function<void(RenderOptions&)>> changes() {
  return {
      [](RenderOptions& o) { o.camera.overrides.position = glm::dvec3(-0.1, 1e-7, 3.0); },
      [](RenderOptions& o) { o.camera.index = 2; },
      [](RenderOptions& o) { o.camera.overrides.parallelScale = 0.7; },
      [](RenderOptions& o) { o.camera.sceneOrigin = glm::dvec3(1.0, 2.0, -1.0 / 3.0); },
      [](RenderOptions& o) { o.stages = stagesUpTo(Stage::Phong); },
      [](RenderOptions& o) { o.stages = StageSet(); },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Shadows)).set(size_t(Stage::Schlick)); },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Sobol)).reset(size_t(Stage::Watertight)); },
      [](RenderOptions& o) { o.sampling.sampleOffset = 7; },
      [](RenderOptions& o) { o.sampling.seed = 4294967295u; },
      [](RenderOptions& o) { o.sampling.bounces = kUnlimitedBounces; },
      [](RenderOptions& o) { o.sampling.bounces = 0; },
      [](RenderOptions& o) { o.sampling.rouletteDepth = 3; },
      [](RenderOptions& o) { o.sampling.clampIndirect = 0.1; },
      [](RenderOptions& o) { o.camera.pixelFilter = PixelFilter::BlackmanHarris; },
      [](RenderOptions& o) {
        o.selection = {
            .scene = "-a b's", .animation = "run", .animationTime = 1.25, .materialVariant = "red"};
      },
      [](RenderOptions& o) { o.selection.camera = "the side"; },
      [](RenderOptions& o) { o.light.hdriFile = "the sky/noon.hdr"; },
      [](RenderOptions& o) { o.light.hdriRotationDegrees = double(-0.3f); },
      [](RenderOptions& o) {
        o.selection.hiddenNodes = {"a node", "7", "/nodes/3"};
      },
      [](RenderOptions& o) { o.camera.lens.fStop = double(0.1f); },
      [](RenderOptions& o) {
        o.camera.lens = {2.8, double(0.7f), 5};
      },
      [](RenderOptions& o) { o.light.hdriIntensity = double(0.3f); },
      [](RenderOptions& o) { o.light.backgroundColor = glm::vec3(0.1f, 0.2f, 1.0f / 3.0f); },
      [](RenderOptions& o) { o.light.background = false; },
      [](RenderOptions& o) { o.light.studio = true; },
      [](RenderOptions& o) { o.light.backgroundBlur = 2.5; },
      [](RenderOptions& o) { o.light.shadowCatcher = true; },
      [](RenderOptions& o) {
        o.light.shadowCatcher = true;
        o.light.catcherHeight = -0.1;
      },
      [](RenderOptions& o) { o.light.defaultLight = DefaultLight::None; },
      [](RenderOptions& o) { o.light.defaultLight = DefaultLight::Studio; },
      [](RenderOptions& o) { o.device.instancing = Instancing::Share; },
      [](RenderOptions& o) {
        o.limits = {12345678, 512, true};
      },
      [](RenderOptions& o) { o.output.exposure = -1.5; },
      [](RenderOptions& o) { o.output.toneMap = ToneMap::Agx; },
      [](RenderOptions& o) {
        o.output.aovFeatures = {Feature::Normal, Feature::Albedo};
      },
      [](RenderOptions& o) { o.output.aovSamples = o.output.aovVariance = true; },
      [](RenderOptions& o) { o.output.debugView = DebugView::Depth; },
      [](RenderOptions& o) { o.output.treeLevel = 3; },
      [](RenderOptions& o) {
        o.output.encoding = {true, 16};
      },
      [](RenderOptions& o) { o.limits.drawMissingTextures = true; },
      [](RenderOptions& o) { o.device.traversal = TraversalMethod::Iterative; },
      [](RenderOptions& o) { o.device.bufferReads = BufferReads::Texel; },
      [](RenderOptions& o) { o.device.dispatch = Dispatch::Compute; },
  };
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

TEST(CommandText, EveryOptionReadsBackAsItself) {
  RenderOptions all;
  const auto check = [](const RenderOptions& options) {
    RenderOptions current;
    current.sampling.spp = options.sampling.spp;
    EXPECT_EQ(withCommandText(current, commandText(options)), options) << commandText(options);
  };
  for (const auto& change : changes()) {
    RenderOptions one;
    one.scene = "-odd.gltf";
    change(one);
    RenderOptions expected = one;
    expected.scene = "./-odd.gltf";
    EXPECT_EQ(withCommandText(RenderOptions(), commandText(one)), expected) << commandText(one);
    change(all);
  }
  all.scene = "a.gltf";
  // An index excludes a name, a scale an angle, a file what is built in.
  all.light.studio = false;
  all.selection.camera.clear();
  all.camera.overrides.viewAngleDegrees.reset();
  check(all);
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
