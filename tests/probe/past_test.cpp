// SPDX-License-Identifier: MIT
// Tests the viewer's picture after a turn of the camera: reused samples may make it better, never wrong.
#include <gtest/gtest.h>

#include "gl_probe.h"
#include "gltf_builder.h"
#include "image/channels.h"
#include "image/compare/difference.h"
#include "image/compare/flip.h"
#include "image/display/tone_map.h"
#include "image/image.h"
#include "pack/textures/pack_textures.h"
#include "view/camera_controller.h"
#include "view/live/view_picture.h"

namespace fragtrace {
namespace {

constexpr glm::ivec2 kSize{96, 72};

struct Turned {
  std::string scene;
  double turn;  ///< radians
};

class PastOfATurn : public GlProbe {
 protected:
  void load(const Turned& turned) {
    options_.scene = std::filesystem::path(FRAGTRACE_SCENES) / turned.scene;
    options_.light.defaultLight = DefaultLight::Studio;
    options_.camera.resolution = kSize;
    options_.output.denoise = Denoise::Variance;
    options_.output.aovs = {Aov::Guides};
    options_.output.quiet = true;
    Statistics stats;
    loaded_.emplace(loadScene(options_, stats));
    tracer_ = makeTracer(context(), *loaded_, options_, stats, TracerExtras{.levels = true});
    film_.emplace(kSize);
    tracer_.renderer->compile(tracer_.variant, *film_, loaded_->view);
    maker_.emplace(std::filesystem::path(), oidn_, clock_);
  }

  View viewAt(double angle) const {
    const CameraPose pose = orbit(poseOf(loaded_->camera, loaded_->scene.bounds), angle, 0.0);
    const Camera camera = withOverrides(loaded_->camera, overridesOf(pose), loaded_->scene.bounds);
    return makeView(options_, *loaded_, camera);
  }

  /// Adds samples to the film, and shows it.
  Image shown(const View& view, int from, int to, bool filtered, bool cones = false) {
    RenderTimes times;
    tracer_.renderer->use(cones ? tracer_.cones.front() : tracer_.variant);
    tracer_.renderer->addSamples(*film_, view, from, to, times);
    ShownTexture into;
    const Showing showing{.filtered = filtered, .samples = to, .cones = cones};
    maker_->show(*film_, showing, options_, tracer_, view, memory_, into, [] { return true; });
    return onlyChannels(imageOf(into), {"R", "G", "B"});
  }

  RenderOptions options_;
  std::optional<LoadedScene> loaded_;
  Tracer tracer_;
  std::optional<Film> film_;
  std::optional<OidnLibrary> oidn_;
  PassClock clock_{false};
  std::optional<PictureMaker> maker_;
  SideMemory memory_;
};

double flip(const Image& a, const Image& b) {
  return flipError(toDisplay(a, 0.0, ToneMap::Neutral), toDisplay(b, 0.0, ToneMap::Neutral)).mean;
}

/// Errors of the pictures of 1, 4 and 16 samples after a turn in four steps: FLIP, and the last picture.
struct Errors {
  std::array<double, 3> flip{};
  Image last;
};

class AfterTurns : public PastOfATurn {
 protected:
  Errors errorsOf(const Turned& turned, const Image& reference, bool past, bool cones = false) {
    memory_ = {};
    constexpr int kSteps = 4;
    for (int step = 0; past && step < kSteps; ++step) {
      film_->clear();
      shown(viewAt(turned.turn * step / kSteps), 0, 4, true, cones);
      memory_.turn();
    }
    film_->clear();
    Errors errors;
    int from = 0;
    for (size_t i = 0; i < errors.flip.size(); ++i) {
      const int to = 1 << (2 * i);
      errors.last = shown(viewAt(turned.turn), from, to, true);
      from = to;
      errors.flip[i] = flip(errors.last, reference);
    }
    return errors;
  }
};

TEST_P(AfterTurns, ThePastHelpsAndIsGoneAtSixteenSamples) {
  for (const Turned& turned : {Turned{"mirror-sphere.gltf", 0.4}, Turned{"rough-metals.gltf", 0.3},
                               Turned{"room-ball.gltf", 0.2}, Turned{"cornell-box.gltf", 0.2}}) {
    load(turned);
    const Image reference = shown(viewAt(turned.turn), 0, 256, false);
    const Errors without = errorsOf(turned, reference, false);
    const Errors with = errorsOf(turned, reference, true);
    EXPECT_LT(with.flip[0], 0.8 * without.flip[0]) << turned.scene;
    EXPECT_LT(with.flip[1], without.flip[1]) << turned.scene;
    EXPECT_EQ(with.last.values, without.last.values) << turned.scene;
  }
}

/// A floor of checkers, most of which are smaller than a pixel.
std::filesystem::path checkers(const gltf_test::TemporaryFolder& folder) {
  Image image{64, 64, {"R", "G", "B"}, {}, {}};
  for (int i = 0; i < 64 * 64; ++i) image.values.insert(image.values.end(), 3, float((i + i / 64) % 2));
  writeImage(folder.path() / "checkers.png", image);
  gltf_test::GltfBuilder builder;
  const int places = builder.addAccessor<float>("VEC3", {-9, 0, -9, 9, 0, -9, 9, 0, 9, -9, 0, 9});
  const int uvs = builder.addAccessor<float>("VEC2", {0, 0, 16, 0, 16, 16, 0, 16});
  auto& primitive = builder.addMesh({{"POSITION", places}, {"TEXCOORD_0", uvs}});
  primitive["indices"] = builder.addAccessor<uint8_t>("SCALAR", {0, 2, 1, 0, 3, 2});
  primitive["material"] = 0;
  builder.root["images"] = {{{"uri", "checkers.png"}}};
  builder.root["textures"] = {{{"source", 0}}};
  builder.root["materials"] = {
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}}}};
  return folder.write("checkers.gltf", builder.text());
}

TEST_P(AfterTurns, ConesHelpWhileItMovesAndAreGoneAtSixteenSamples) {
  const gltf_test::TemporaryFolder folder;
  const Turned turned{checkers(folder).string(), 0.3};
  options_.device.traversal = TraversalMethod::FrontToBack;  // cones read the leaves
  load(turned);
  ASSERT_EQ(tracer_.cones.size(), 2u);
  addLevels(tracer_.textures, tracer_.renderer->textures().memory());
  for (const ShaderVariant& cones : tracer_.cones) tracer_.renderer->compile(cones, *film_, loaded_->view);
  const Image reference = shown(viewAt(turned.turn), 0, 1024, false);
  std::array<double, 2> moving{};
  for (const bool cones : {false, true}) {
    memory_ = {};
    film_->clear();
    moving[size_t(cones)] = flip(shown(viewAt(turned.turn), 0, 1, true, cones), reference);
  }
  const Errors without = errorsOf(turned, reference, false);
  const Errors with = errorsOf(turned, reference, true, true);
  std::printf("FLIP of a sample: %.4f, moving by cones %.4f; at rest after cones %.4f\n", moving[0],
              moving[1], with.flip[0]);
  EXPECT_LT(moving[1], 0.8 * moving[0]);
  EXPECT_LT(with.flip[0], without.flip[0]);
  EXPECT_EQ(with.last.values, without.last.values);
}

INSTANTIATE_TEST_SUITE_P(Backends, AfterTurns, testing::Values(Backend::Egl), backendName);

}  // namespace
}  // namespace fragtrace
