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
      [](RenderOptions& o) { o.camera.position = glm::dvec3(-0.1, 1e-7, 3.0); },
      [](RenderOptions& o) { o.cameraIndex = 2; },
      [](RenderOptions& o) { o.camera.parallelScale = 0.7; },
      [](RenderOptions& o) { o.sceneOrigin = glm::dvec3(1.0, 2.0, -1.0 / 3.0); },
      [](RenderOptions& o) { o.stages = stagesUpTo(Stage::Phong); },
      [](RenderOptions& o) { o.stages = StageSet(); },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Shadows)).set(size_t(Stage::Schlick)); },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Sobol)).reset(size_t(Stage::Watertight)); },
      [](RenderOptions& o) { o.sampleOffset = 7; },
      [](RenderOptions& o) { o.seed = 4294967295u; },
      [](RenderOptions& o) { o.bounces = kUnlimitedBounces; },
      [](RenderOptions& o) { o.bounces = 0; },
      [](RenderOptions& o) { o.rouletteDepth = 3; },
      [](RenderOptions& o) { o.clampIndirect = 0.1; },
      [](RenderOptions& o) { o.pixelFilter = PixelFilter::BlackmanHarris; },
      [](RenderOptions& o) {
        o.selection = {
            .scene = "-a b's", .animation = "run", .animationTime = 1.25, .materialVariant = "red"};
      },
      [](RenderOptions& o) { o.selection.camera = "the side"; },
      [](RenderOptions& o) { o.hdriFile = "the sky/noon.hdr"; },
      [](RenderOptions& o) { o.hdriRotationDegrees = double(-0.3f); },
      [](RenderOptions& o) {
        o.selection.hiddenNodes = {"a node", "7", "/nodes/3"};
      },
      [](RenderOptions& o) { o.lens.fStop = double(0.1f); },
      [](RenderOptions& o) {
        o.lens = {2.8, double(0.7f), 5};
      },
      [](RenderOptions& o) { o.hdriIntensity = double(0.3f); },
      [](RenderOptions& o) { o.backgroundColor = glm::vec3(0.1f, 0.2f, 1.0f / 3.0f); },
      [](RenderOptions& o) { o.background = false; },
      [](RenderOptions& o) { o.studio = true; },
      [](RenderOptions& o) { o.backgroundBlur = 2.5; },
      [](RenderOptions& o) { o.shadowCatcher = true; },
      [](RenderOptions& o) {
        o.shadowCatcher = true;
        o.catcherHeight = -0.1;
      },
      [](RenderOptions& o) { o.defaultLight = DefaultLight::None; },
      [](RenderOptions& o) { o.defaultLight = DefaultLight::Studio; },
      [](RenderOptions& o) { o.instancing = Instancing::Share; },
      [](RenderOptions& o) {
        o.limits = {12345678, 512, true};
      },
      [](RenderOptions& o) { o.exposure = -1.5; },
      [](RenderOptions& o) { o.toneMap = ToneMap::Agx; },
      [](RenderOptions& o) {
        o.aovFeatures = {Feature::Normal, Feature::Albedo};
      },
      [](RenderOptions& o) { o.aovSamples = o.aovVariance = true; },
      [](RenderOptions& o) { o.debugView = DebugView::Depth; },
      [](RenderOptions& o) { o.treeLevel = 3; },
      [](RenderOptions& o) {
        o.encoding = {true, 16};
      },
      [](RenderOptions& o) { o.limits.drawMissingTextures = true; },
      [](RenderOptions& o) { o.traversal = TraversalMethod::Iterative; },
      [](RenderOptions& o) { o.bufferReads = BufferReads::Texel; },
      [](RenderOptions& o) { o.dispatch = Dispatch::Compute; },
  };
}

TEST(CommandText, IsAWholeCommandOfRender) {
  RenderOptions o;
  o.scene = "my scenes/it's.gltf";
  o.output = "it's-1.png";
  o.spp = 17;
  o.resolution = glm::ivec2(640, 480);
  EXPECT_EQ(commandText(o),
            "fragtrace render 'my scenes/it'\\''s.gltf' --output 'it'\\''s-1.png' "
            "--resolution 640,480 --spp 17");
}

TEST(CommandText, EveryOptionReadsBackAsItself) {
  RenderOptions all;
  const auto check = [](const RenderOptions& options) {
    RenderOptions current;
    current.spp = options.spp;
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
  all.studio = false;
  all.selection.camera.clear();
  all.camera.viewAngleDegrees.reset();
  check(all);
}

TEST(CommandText, WhatTheViewerHasOfItsOwnStays) {
  RenderOptions current;
  current.spp = 1 << 20;
  current.noise = 0.005;
  current.backend = Backend::OsMesa;
  current.resolution = glm::ivec2(320, 240);
  const RenderOptions read = withCommandText(
      current,
      "build/fragtrace  render a.gltf -o x.exr --spp 4 \\\n --time 3 --resolution 64x48 --stage phong");
  EXPECT_EQ(read.spp, current.spp);
  EXPECT_EQ(read.noise, 0.005);
  EXPECT_EQ(read.seconds, 0.0);
  EXPECT_EQ(read.backend, Backend::OsMesa);
  EXPECT_EQ(read.resolution, current.resolution);
  EXPECT_EQ(read.stages, stagesUpTo(Stage::Phong));
  EXPECT_EQ(withCommandText(current, "fragtrace view a.gltf --watch --aov albedo --tree-level 2").treeLevel,
            2);
}

TEST(CommandText, CameraOptionsAloneChangeTheCameraAlone) {
  RenderOptions current;
  current.scene = "a.gltf";
  current.exposure = 2.0;
  const RenderOptions read = withCommandText(current, "--camera-position 1,2,3");
  EXPECT_EQ(read.camera.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(read.exposure, 2.0);
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
