// SPDX-License-Identifier: MIT
// Scenes that are told new options: what one leaves to the next.
#include <gtest/gtest.h>

#include "base/errors.h"
#include "gl_probe.h"
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

class Told : public GlProbe {
 protected:
  void SetUp() override {
    GlProbe::SetUp();
    options_ = inTheStudio();
    options_.light.studio = false;
    options_.light.sky.on = true;
    options_.stages = stagesUpTo(Stage::Phong);
    options_.camera.resolution = glm::ivec2(32);
    std::shared_ptr<KeptDocument> document;
    session_.open(loaded(&document), document, options_);
    session_.openPrograms(context(), {});
  }

  LoadedScene loaded(std::shared_ptr<KeptDocument>* document = nullptr) const {
    Statistics stats;
    SceneBefore before;
    before.document = document;
    return loadScene(options_, stats, {}, FilmOf::Picture, before);
  }

  Renewal renew() { return session_.renewScene(options_, false); }

  RenderOptions options_;
  Session session_{std::numeric_limits<double>::infinity()};
};

TEST_P(Told, ASceneRenewsWhatTheOptionsChange) {
  const auto positions = [](const LoadedScene& scene) { return scene.scene.vertices.position; };
  const auto sun = [&] { return session_.loaded().environment.sun->irradiance; };
  const std::shared_ptr<SceneProgram> program = session_.programs().of(options_);
  ASSERT_EQ(program->error, "");
  EXPECT_EQ(renew(), Renewal::None);
  const auto before = sun();
  options_.light.sky.sun.elevation = 10.0;
  EXPECT_EQ(renew(), Renewal::Surroundings);
  EXPECT_NE(sun(), before);
  options_.selection.set = {{"/materials/0/pbrMetallicRoughness/roughnessFactor", {0.125}}};
  EXPECT_EQ(renew(), Renewal::Surfaces);
  EXPECT_EQ(session_.loaded().scene.materials[0].roughnessFactor, 0.125f);
  options_.light.sky.sun.elevation = 60.0;
  options_.selection.animationTime = 0.2;
  EXPECT_EQ(renew(), Renewal::Pose);
  EXPECT_NE(sun(), before);
  EXPECT_EQ(positions(session_.loaded()), positions(loaded()));
  EXPECT_TRUE(session_.programs().has(options_)) << "the program that is held draws other poses, too";
}

TEST_P(Told, ALowerTreeKeepsTheProgram) {
  options_.device.traversal = TraversalMethod::FrontToBack;
  const std::shared_ptr<SceneProgram> program = session_.programs().of(options_);
  ASSERT_EQ(program->error, "");
  const int size = program->tracer.variant.stackSize;
  options_.selection.hiddenNodes = {"tyre"};
  EXPECT_EQ(renew(), Renewal::Pose);
  EXPECT_LE(session_.loaded().bvh.stackNeed, size - 4) << "it would do with a smaller stack";
  EXPECT_EQ(program->tracer.variant.stackSize, size);
}

TEST_P(Told, APoseThatCannotBeLoadedLeavesTheScene) {
  const RenderOptions asked = options_;
  const auto nodes = [&] { return session_.loaded().scene.nodes.size(); };
  const size_t before = nodes();
  options_.selection.hiddenNodes = {"nowhere"};
  EXPECT_THROW(renew(), UsageError);
  EXPECT_EQ(nodes(), before);
  EXPECT_GT(session_.loaded().environment.image.width, 0);
  EXPECT_EQ(renew(), Renewal::None) << "it is tried again";
  options_ = asked;
  EXPECT_EQ(renew(), Renewal::Pose);
}

INSTANTIATE_TEST_SUITE_P(Backends, Told, testing::Values(Backend::Egl), backendName);

}  // namespace
}  // namespace fragtrace
