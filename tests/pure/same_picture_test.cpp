// SPDX-License-Identifier: MIT
#include "stage/same_picture.h"

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
      [](RenderOptions& o) { o.camera.parallelScale = 2.0; },
      [](RenderOptions& o) { o.bounces = 1; },
      [](RenderOptions& o) { o.hdriFile = "sky.pfm"; },
      [](RenderOptions& o) { o.studio = true; },
      [](RenderOptions& o) { o.backgroundBlur = 1.0; },
      [](RenderOptions& o) { o.shadowCatcher = true; },
      [](RenderOptions& o) { o.catcherHeight = 1.0; },
      [](RenderOptions& o) { o.lineWidth = 1.0; },
      [](RenderOptions& o) { o.backgroundColor = glm::vec3(1.0f); },
      [](RenderOptions& o) { o.stages.set(size_t(Stage::Schlick)); },
      [](RenderOptions& o) { o.pixelFilter = PixelFilter::Gaussian; },
  };
  for (size_t i = 0; i < changes.size(); ++i) {
    EXPECT_FALSE(showSame(RenderOptions(), changed(changes[i]))) << i;
    EXPECT_FALSE(drawSameSamples(RenderOptions(), changed(changes[i]))) << i;
    EXPECT_TRUE(showSame(changed(changes[i]), changed(changes[i]))) << i;
  }
}

TEST(SamePicture, DoesNotDependOnTheSamples) {
  const std::vector<Change> changes = {
      [](RenderOptions& o) { o.seed = 7; },
      [](RenderOptions& o) { o.sampleOffset = 64; },
      [](RenderOptions& o) { o.rouletteDepth = 1; },
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
      [](RenderOptions& o) { o.traversal = TraversalMethod::Bvh; },
      [](RenderOptions& o) { o.dispatch = Dispatch::Compute; },
      [](RenderOptions& o) { o.spp = 1; },
      [](RenderOptions& o) { o.noise = 0.1; },
      [](RenderOptions& o) { o.output = "x.png"; },
      [](RenderOptions& o) { o.exposure = 1.0; },
      [](RenderOptions& o) { o.encoding.half = true; },
      [](RenderOptions& o) { o.aovSamples = true; },
      [](RenderOptions& o) { o.stages.reset(size_t(Stage::Watertight)); },
      [](RenderOptions& o) { o.limits.memoryBytes = 1 << 30; },
  };
  for (size_t i = 0; i < changes.size(); ++i)
    EXPECT_TRUE(drawSameSamples(RenderOptions(), changed(changes[i]))) << i;
}

TEST(SamePicture, OfTheHeatMapIsTheWayThroughTheTree) {
  RenderOptions bvh;
  bvh.stages.set(size_t(Stage::BvhHeatmap));
  bvh.traversal = TraversalMethod::Bvh;
  RenderOptions other = bvh;
  other.traversal = TraversalMethod::FrontToBack;
  EXPECT_FALSE(showSame(bvh, other));
}

}  // namespace
}  // namespace fragtrace
