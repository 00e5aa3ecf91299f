// SPDX-License-Identifier: MIT
#include "options/check_render.h"

#include <gtest/gtest.h>

#include <functional>

namespace fragtrace {
namespace {

using Change = std::function<void(RenderOptions&)>;

RenderOptions changed(const Change& change) {
  RenderOptions options;
  change(options);
  return options;
}

TEST(SamePicture, DependsOnWhatIsShownAndFromWhere) {
  const std::vector<Change> changes = {
      [](RenderOptions& o) { o.scene = "other.gltf"; },
      [](RenderOptions& o) { o.selection.animationTime = 1.0; },
      [](RenderOptions& o) { o.selection.animation = "walk"; },
      [](RenderOptions& o) { o.selection.scene = "1"; },
      [](RenderOptions& o) { o.selection.materialVariant = "red"; },
      [](RenderOptions& o) { o.limits.textureSide = 16; },
      [](RenderOptions& o) { o.camera.overrides.parallelScale = 2.0; },
      [](RenderOptions& o) { o.sampling.bounces = 1; },
      [](RenderOptions& o) { o.light.hdriFile = "sky.pfm"; },
      [](RenderOptions& o) { o.light.studio = true; },
      [](RenderOptions& o) { o.light.backgroundBlur = 1.0; },
      [](RenderOptions& o) { o.light.shadowCatcher = true; },
      [](RenderOptions& o) { o.light.catcherHeight = 1.0; },
      [](RenderOptions& o) { o.camera.lineWidth = 1.0; },
      [](RenderOptions& o) { o.light.backgroundColor = glm::vec3(1.0f); },
      [](RenderOptions& o) { o.stages.set(size_t(Stage::Schlick)); },
      [](RenderOptions& o) { o.camera.pixelFilter = PixelFilter::Gaussian; },
  };
  for (size_t i = 0; i < changes.size(); ++i) {
    EXPECT_FALSE(showSame(RenderOptions(), changed(changes[i]))) << i;
    EXPECT_FALSE(drawSameSamples(RenderOptions(), changed(changes[i]))) << i;
    EXPECT_TRUE(showSame(changed(changes[i]), changed(changes[i]))) << i;
  }
}

TEST(SamePicture, DoesNotDependOnTheSamples) {
  const std::vector<Change> changes = {
      [](RenderOptions& o) { o.sampling.seed = 7; },
      [](RenderOptions& o) { o.sampling.sampleOffset = 64; },
      [](RenderOptions& o) { o.sampling.rouletteDepth = 1; },
      [](RenderOptions& o) { o.sampling.cameraRays = 4; },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Sobol)); },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::LightSampling)); },
  };
  for (size_t i = 0; i < changes.size(); ++i) {
    EXPECT_TRUE(showSame(RenderOptions(), changed(changes[i]))) << i;
    EXPECT_FALSE(drawSameSamples(RenderOptions(), changed(changes[i]))) << i;
  }
}

TEST(SamePicture, DoesNotDependOnHowItIsTracedOrWritten) {
  const std::vector<Change> changes = {
      [](RenderOptions& o) { o.device.traversal = TraversalMethod::Bvh; },
      [](RenderOptions& o) { o.device.dispatch = Dispatch::Compute; },
      [](RenderOptions& o) { o.sampling.spp = 1; },
      [](RenderOptions& o) { o.sampling.noise = 0.1; },
      [](RenderOptions& o) { o.output.file = "x.png"; },
      [](RenderOptions& o) { o.output.exposure = 1.0; },
      [](RenderOptions& o) { o.output.encoding.half = true; },
      [](RenderOptions& o) { o.output.aovSamples = true; },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Watertight)); },
      [](RenderOptions& o) { o.limits.memoryBytes = 1 << 30; },
  };
  for (size_t i = 0; i < changes.size(); ++i)
    EXPECT_TRUE(drawSameSamples(RenderOptions(), changed(changes[i]))) << i;
}

TEST(SamePicture, OfTheHeatMapIsTheWayThroughTheTree) {
  RenderOptions bvh;
  bvh.output.debugView = DebugView::Visits;
  bvh.device.traversal = TraversalMethod::Bvh;
  RenderOptions other = bvh;
  other.device.traversal = TraversalMethod::FrontToBack;
  EXPECT_FALSE(showSame(bvh, other));
}

}  // namespace
}  // namespace fragtrace
