// SPDX-License-Identifier: MIT
// Scenes whose trees are the worst: every sample must find what double precision finds, however the work is
// cut into draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "bvh/exact_tracer.h"
#include "gl_probe.h"
#include "glsl.h"
#include "pack/pack_tree.h"
#include "render/renderer.h"
#include "tests/instruments/rays/hit_check.h"
#include "tests/instruments/stress/tree_shapes.h"

namespace fragtrace {
namespace {

constexpr int kSamples = 64;
constexpr float kFar = 3e38f;

class TreeShapes : public GlProbe {
 protected:
  void open(Scene scene) {
    scene_ = std::move(scene);
    bvh_ = buildBvh(primitiveBounds(scene_), uint32_t(scene_.triangles.size()));
    RenderOptions options;
    options.stages = stagesUpTo(Stage::Flat);
    options.device.traversal = TraversalMethod::FrontToBack;
    variant_ = chooseVariant(options, traitsOf(scene_, Surroundings::None), Surroundings::None,
                             bvh_.stackNeed, BufferReads::Image);
    renderer_ =
        std::make_unique<Renderer>(context(), packScene(scene_, bvh_, {}, variant_), BufferReads::Image);
    view_.camera.position = {0.0, 0.0, 3.0};
    view_.showEnvironment = false;
    view_.background = glm::vec3(0.25f, 0.0f, 0.5f);
  }

  /// Draws in calls of `step` samples.
  FilmPixels drawn(int step, bool resumable = false) {
    Film film(size_);
    variant_.resumable = resumable;
    renderer_->compile(variant_, film, view_);
    RenderTimes times;
    for (int from = 0; from < kSamples; from += step) {
      EXPECT_TRUE(renderer_->addSamples(film, view_, from, std::min(from + step, kSamples), times,
                                        [](double) { return true; }));
    }
    return film.read();
  }

  /// The sample's camera ray, as shaders/path.glsl begins a path.
  Ray cameraRay(glm::ivec2 pixel, uint32_t sample) const {
    using namespace glsl_float;
    const uint32_t key = pixelKey(uint32_t(pixel.x), uint32_t(size_.y - 1 - pixel.y), view_.seed);
    const glm::vec2 jitter = drawPair(makeSampler(key, sample), 0u);
    const glm::vec2 place = glm::vec2(pixel) + 0.5f + samplePixelFilter(0, jitter.x, jitter.y);
    const glm::vec2 point = place / glm::vec2(size_) * 2.0f - 1.0f;
    const float height = float(std::tan(0.5 * view_.camera.fovY));
    const float width = height * float(size_.x) / float(size_.y);
    const auto ray = makeCameraRay(glm::vec3(view_.camera.position), {width, 0, 0}, {0, height, 0},
                                   {0, 0, -1}, false, point.x, point.y);
    return {ray.origin, ray.direction, kFar};
  }

  /// Holds every sample of the film against double precision.
  void expectExact(const FilmPixels& film) const {
    const FilmTotals totals = totalsOf(film);
    EXPECT_EQ(totals.budgetHits, 0u);
    EXPECT_EQ(totals.fewestSamples, uint32_t(kSamples));
    EXPECT_EQ(totals.rays, uint64_t(kSamples) * film.pixels.size());
    const ExactTracer tracer(scene_, bvh_);
    double apart = 0.0;
    for (int y = 0; y < size_.y; ++y) {
      for (int x = 0; x < size_.x; ++x) {
        std::vector<Ray> rays;
        for (uint32_t s = 0; s < uint32_t(kSamples); ++s) rays.push_back(cameraRay({x, y}, s));
        glm::dvec3 sum(0.0);
        for (const ExactHit& hit : tracer.nearest(rays)) {
          const bool missed = hit.primitive == kMissIndex;
          sum += missed
                     ? glm::dvec3(view_.background)
                     : glm::dvec3(scene_.materials[scene_.triangles[hit.primitive].material].baseColorFactor);
        }
        const FilmPixel& p = film.pixels[size_t(y) * size_t(size_.x) + size_t(x)];
        apart += glm::length(p.sum - sum);
      }
    }
    // A sample that is another one changes its pixel by at most 1.5.
    EXPECT_LE(apart, 1.5 * double(wrongRaysAllowed(totals.samples)));
  }

  static void expectSame(const FilmPixels& a, const FilmPixels& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i) {
      EXPECT_EQ(a.pixels[i].sum, b.pixels[i].sum) << i;
      EXPECT_EQ(a.pixels[i].samples, b.pixels[i].samples);
      EXPECT_EQ(a.pixels[i].rays, b.pixels[i].rays);
    }
  }

  Scene scene_;
  Bvh bvh_;
  std::unique_ptr<Renderer> renderer_;
  ShaderVariant variant_;
  View view_;
  glm::ivec2 size_{8, 6};
};

/// No box is ever farther away than a hit: every ray that hits visits every leaf, and takes many draws.
TEST_P(TreeShapes, TwentyThousandIdenticalTriangles) {
  open(identicalTriangles(20000));
  const FilmPixels whole = drawn(kSamples);
  expectExact(whole);
  expectSame(whole, drawn(7));
  expectSame(whole, drawn(kSamples, true));
  open(identicalTriangles(1));
  expectSame(whole, drawn(kSamples));
}

TEST_P(TreeShapes, SizesInAGeometricProgression) {
  size_ = {32, 24};
  open(shrinkingTriangles(5000));
  const FilmPixels whole = drawn(kSamples);
  expectExact(whole);
  expectSame(whole, drawn(5));
  // The camera looks towards the point at which the triangles end.
  view_.camera.position = {0.9999, 0.0, 0.0005};
  view_.camera.fovY = 1.5;
  expectExact(drawn(kSamples));
}

TEST_P(TreeShapes, OneTriangle) {
  size_ = {32, 24};
  open(identicalTriangles(1));
  expectExact(drawn(kSamples));
}

TEST_P(TreeShapes, NoTriangleShowsTheBackground) {
  open(sceneWithoutTriangles());
  const FilmPixels film = drawn(kSamples);
  for (const FilmPixel& p : film.pixels) EXPECT_EQ(p.mean(), glm::dvec3(view_.background));
  EXPECT_EQ(totalsOf(film).budgetHits, 0u);
}

INSTANTIATE_TEST_SUITE_P(Backends, TreeShapes, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
