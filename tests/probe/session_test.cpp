// SPDX-License-Identifier: MIT
// Scenes that are told new options: what one leaves to the next.
#include <gtest/gtest.h>

#include "base/errors.h"
#include "session/session.h"

namespace fragtrace {
namespace {

RenderOptions inTheStudio() {
  RenderOptions options;
  options.scene = std::filesystem::path(FRAGTRACE_SCENES) / "wheel.gltf";
  options.light.studio = true;
  options.output.quiet = true;
  options.stages = stagesUpTo(Stage::Gi);
  return options;
}

TEST(Loading, ThatFailsLeavesTheEnvironment) {
  RenderOptions options = inTheStudio();
  Statistics stats;
  Environment environment = loadScene(options, stats).environment;
  const Image image = environment.image;
  ASSERT_GT(image.width, 0);
  // The shadow is in the picture, too, so the environment comes before the camera.
  options.light.shadowCatcher = true;
  options.camera.overrides.fitShadow = true;
  options.limits.memoryBytes = 1 << 20;
  options.camera.resolution = glm::ivec2(4096);
  SceneBefore before;
  before.environment = &environment;
  EXPECT_THROW(loadScene(options, stats, {}, FilmOf::Picture, before), UsageError);
  EXPECT_EQ(environment.image.values, image.values);
}

}  // namespace
}  // namespace fragtrace
