// SPDX-License-Identifier: MIT
// The viewer's tracing thread: which pictures it gives the window, and when.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gltf_builder.h"
#include "view/live/view_tracer.h"

namespace fragtrace {
namespace {

constexpr glm::ivec2 kSize{64, 48};

/// A triangle that moves along x for two seconds.
std::filesystem::path moving(const gltf_test::TemporaryFolder& folder) {
  gltf_test::GltfBuilder builder;
  builder.addTriangle();
  const int times = builder.addAccessor<float>("SCALAR", {0, 2});
  const int places = builder.addAccessor<float>("VEC3", {-1, 0, 0, 1, 0, 0});
  builder.root["animations"][0] = {
      {"samplers", {{{"input", times}, {"output", places}}}},
      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}};
  return folder.write("moving.gltf", builder.text());
}

class Viewed : public testing::Test {
 protected:
  Viewed() {
    options_.render.scene = moving(folder_);
    options_.render.camera.resolution = kSize;
    options_.render.output.quiet = true;
    options_.render.device.backend = Backend::Egl;
    options_.movingMs = 1e-6;                           // pictures in motion are as coarse as possible
    options_.render.stages = stagesUpTo(Stage::Phong);  // without a preview, which one side has alone
    tracer_.emplace(options_, std::nullopt, exchange_);
    thread_ = std::thread([this] { tracer_->run({}); });
    exchange_.request(&Requests::load, {options_.render});
  }
  ~Viewed() override {
    exchange_.request([](Requests& r) { r.quit = true; });
    thread_.join();
  }

  Results take() {
    Results results = exchange_.take();
    EXPECT_EQ(results.status.error, "");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return results;
  }

  void ask(std::vector<RenderOptions> sides, bool moving) {
    exchange_.request(&Requests::trace, {++asked_, std::move(sides), kSize, moving});
  }

  /// The options of the scene once that is loaded, from in front of it.
  RenderOptions shown() {
    std::optional<RenderOptions> loaded;
    while (!loaded && !HasFailure()) {
      for (const Result& result : take().queue) {
        if (const auto* scene = std::get_if<ViewedScene>(&result)) loaded = scene->options;
      }
    }
    RenderOptions options = loaded.value_or(RenderOptions{});
    options.camera.overrides.position = glm::dvec3(0.0, 0.0, 4.0);
    return options;
  }

  gltf_test::TemporaryFolder folder_;
  ViewOptions options_;
  Exchange exchange_;
  uint64_t asked_ = 0;
  std::optional<ViewTracer> tracer_;
  std::thread thread_;
};

TEST_F(Viewed, BothSidesOfAPlaybackShowTheSameMoment) {
  RenderOptions side = shown();
  side.selection.animation = "0";
  std::vector<Image> shown;
  // A new time is asked for again and again, as the window does, whether pictures come or not.
  // The first waits for the driver's compiler, on a busy machine for seconds.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (int turn = 0; shown.size() < 6 && std::chrono::steady_clock::now() < end && !HasFailure(); ++turn) {
    side.selection.animationTime = 0.05 * (turn % 40);  // moves by a quarter of a pixel of a coarse picture
    ask({side, side}, true);
    const Results results = take();
    if (results.pictures.empty()) continue;
    ASSERT_EQ(results.pictures.size(), 2u) << "one side alone has a new picture";
    EXPECT_EQ(results.pictures[0].request, results.pictures[1].request);
    EXPECT_EQ(results.pictures[0].image.values, results.pictures[1].image.values);
    shown.push_back(results.pictures[0].image);
  }
  ASSERT_EQ(shown.size(), 6u);
  EXPECT_TRUE(std::ranges::any_of(shown, [&](const Image& image) {
    return image.values != shown.front().values;
  })) << "nothing moves";
}

TEST_F(Viewed, ARestingPictureBecomesSharpWhenItsEdgesAreSmooth) {
  RenderOptions side = shown();
  side.sampling.spp = 8;
  const auto next = [&] {
    for (;;) {
      Results results = take();
      if (!results.pictures.empty() || HasFailure()) return std::move(results.pictures);
    }
  };
  ask({side}, true);
  ASSERT_EQ(next().at(0).size, kSize / 4);
  ask({side}, false);
  auto before = std::chrono::steady_clock::now();
  std::vector<TracedPicture> pictures = next();
  while (pictures.at(0).size != kSize) {
    before = std::chrono::steady_clock::now();
    pictures = next();
  }
  const bool soon = std::chrono::steady_clock::now() - before < std::chrono::milliseconds(400);
  if (!soon) GTEST_SKIP() << "the machine is busy";
  EXPECT_GE(pictures.at(0).statistics.samples, 4);
}

}  // namespace
}  // namespace fragtrace
