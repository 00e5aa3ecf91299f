// SPDX-License-Identifier: MIT
// The film does not depend on how the work was cut into draws, tiles and calls: bit by bit the same.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <stdexcept>

#include "bvh/bvh.h"
#include "gl_probe.h"
#include "gltf/gltf.h"
#include "pack/pack_tree.h"
#include "render/renderer.h"

namespace fragtrace {
namespace {

/// Everything of a pixel but what draws leave for the next one in its flags.
std::vector<uint64_t> bitsOf(const FilmPixels& film) {
  std::vector<uint64_t> bits;
  for (const FilmPixel& p : film.pixels) {
    for (const double value : {p.sum.x, p.sum.y, p.sum.z, p.alpha, p.m2})
      bits.push_back(std::bit_cast<uint64_t>(value));
    for (const uint32_t value : {p.samples, p.rays, p.nonfinite}) bits.push_back(value);
  }
  return bits;
}

class Draws : public GlProbe {
 protected:
  static constexpr int kSamples = 16;

  void SetUp() override {
    GlProbe::SetUp();
    if (IsSkipped()) return;
    open("cornell-box.gltf", {});
  }

  void open(const std::string& name, const RenderOptions& options) {
    GltfOptions loading;
    loading.instancing = options.device.instancing;
    const Scene scene = loadGltf(std::filesystem::path(FRAGTRACE_SCENES) / name, loading);
    const bool iterative = options.device.traversal == TraversalMethod::Iterative;
    const Bvh bvh = iterative ? listLeaves(scene) : buildSceneBvh(scene);
    const Environment surroundings;
    variant_ = chooseVariant(options, traitsOf(scene, surroundings.kind), surroundings.kind, bvh.stackNeed,
                             BufferReads::Image);
    renderer_ = std::make_unique<Renderer>(context(), packScene(scene, bvh, surroundings, variant_),
                                           BufferReads::Image);
    view_.camera = scene.cameras.front();
    view_.space = scene.space;
    view_.showEnvironment = false;
  }

  /// A film on which `draw` has drawn.
  template <typename Draw>
  FilmPixels drawn(const Draw& draw) {
    Film film(size_);
    renderer_->compile(variant_, film, view_);
    draw(film);
    return film.read();
  }

  void add(Film& film, int from, int to) {
    EXPECT_TRUE(renderer_->addSamples(film, view_, from, to, times_, [](double) { return true; }));
  }
  void add(Film& film, const std::vector<Work>& parts) {
    EXPECT_TRUE(renderer_->addSamples(film, view_, parts, times_, [](double) { return true; }));
  }

  Film& scratch() {
    if (!scratch_) scratch_ = std::make_unique<Film>(size_);
    return *scratch_;
  }

  FilmPixels atOnce() {
    return drawn([&](Film& film) { add(film, 0, kSamples); });
  }

  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Film> scratch_;
  ShaderVariant variant_;
  View view_;
  RenderTimes times_;
  glm::ivec2 size_{150, 139};  ///< more than one tile of the least size, with a rest
};

TEST_P(Draws, CallsOfAnyNumberOfSamples) {
  const FilmPixels expected = atOnce();
  EXPECT_EQ(totalsOf(expected).fewestSamples, uint32_t(kSamples));
  EXPECT_EQ(bitsOf(atOnce()), bitsOf(expected));
  EXPECT_EQ(bitsOf(drawn([&](Film& film) {
              add(film, 0, 5);
              add(film, 5, kSamples);
            })),
            bitsOf(expected));
  EXPECT_EQ(bitsOf(drawn([&](Film& film) {
              for (int i = 0; i < kSamples; ++i) add(film, i, i + 1);
            })),
            bitsOf(expected));
}

TEST_P(Draws, TilesOfAnySizeInAnyOrder) {
  const FilmPixels expected = atOnce();
  for (const int side : {37, 64}) {
    std::vector<Work> tiles;
    for (int y = 0; y < size_.y; y += side) {
      for (int x = 0; x < size_.x; x += side) {
        const glm::ivec2 corner(x, y);
        tiles.push_back({corner, glm::min(glm::ivec2(side), size_ - corner), 0, kSamples, 1.0});
      }
    }
    EXPECT_EQ(bitsOf(drawn([&](Film& film) { add(film, tiles); })), bitsOf(expected)) << side;
    std::reverse(tiles.begin(), tiles.end());
    EXPECT_EQ(bitsOf(drawn([&](Film& film) {
                for (const Work& tile : tiles) add(film, {tile});
              })),
              bitsOf(expected))
        << side;
  }
}

TEST_P(Draws, TwoInFlight) {
  const std::vector<uint64_t> expected = bitsOf(atOnce());
  renderer_->setDrawsInFlight(2);
  for (const bool resumable : {false, true}) {
    variant_.resumable = resumable;
    // A sample of the least tile, or more.
    for (const double ms : {1e-3, 60.0}) {
      renderer_->setDrawTime(ms);
      EXPECT_EQ(bitsOf(atOnce()), expected) << resumable << ms;
    }
    // Stopped after a draw, it continues where it was.
    EXPECT_EQ(
        bitsOf(drawn([&](Film& film) {
          EXPECT_FALSE(renderer_->addSamples(film, view_, 0, kSamples, times_, [](double) { return false; }));
          add(film, 0, kSamples);
        })),
        expected);
  }
}

TEST_P(Draws, PixelsWithTargetsOfTheirOwn) {
  const FilmPixels expected = atOnce();
  // Three samples everywhere, then a third of the pixels continues to 7, then all to the end.
  const FilmPixels film = drawn([&](Film& f) {
    add(f, 0, 3);
    std::vector<uint32_t> targets(size_t(size_.x) * size_t(size_.y));
    for (size_t i = 0; i < targets.size(); ++i) targets[i] = i % 3 == 0 ? 7 : 3;
    f.setTargets(f.read(), targets);
    add(f, {{{0, 0}, size_, 3, 7, 1.0 / 3.0}});
    const FilmPixels then = f.read();
    for (size_t i = 0; i < targets.size(); ++i) ASSERT_EQ(then.pixels[i].samples, targets[i]);
    f.setTargets(then, std::vector<uint32_t>(targets.size(), 0));
    add(f, 3, kSamples);
  });
  EXPECT_EQ(bitsOf(film), bitsOf(expected));
}

TEST_P(Draws, AnOffsetIsWhereAnEarlierPartEnded) {
  // Sample 5 of the sequence is sample 0 of a film that begins there: one sample has no sum to be rounded
  // with.
  const FilmPixels before = drawn([&](Film& film) { add(film, 0, 5); });
  const FilmPixels after = drawn([&](Film& film) { add(film, 0, 6); });
  view_.sampleOffset = 5;
  const FilmPixels own = drawn([&](Film& film) { add(film, 0, 1); });
  double largest = 0.0;
  for (size_t i = 0; i < own.pixels.size(); ++i) {
    const glm::dvec3 apart = after.pixels[i].sum - before.pixels[i].sum - own.pixels[i].sum;
    largest = std::max(largest, glm::length(apart) / (1e-3 + glm::length(after.pixels[i].sum)));
    ASSERT_EQ(after.pixels[i].rays - before.pixels[i].rays, own.pixels[i].rays);
  }
  EXPECT_LT(largest, 1e-6);
}

TEST_P(Draws, TheFirstSampleOfACoarsePictureIsInTheMiddleOfItsPixel) {
  RenderOptions flat;
  flat.stages.reset();
  open("cornell-box.gltf", flat);
  for (const int samples : {1, 2}) {
    for (const bool middle : {true, false}) {
      view_.firstInMiddle = middle;
      view_.seed = 1;
      const FilmPixels one = drawn([&](Film& film) { add(film, 0, samples); });
      view_.seed = 2;
      const FilmPixels other = drawn([&](Film& film) { add(film, 0, samples); });
      EXPECT_EQ(bitsOf(one) == bitsOf(other), middle && samples == 1);
    }
  }
}

/// As draws grow, their step budget ends in the middle of a sample. The next draw begins that sample again.
TEST_P(Draws, SamplesThatBeginAnew) {
  constexpr int kMany = 700;
  size_ = {16, 12};
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, kMany); });
  EXPECT_EQ(totalsOf(expected).fewestSamples, uint32_t(kMany));
  EXPECT_EQ(bitsOf(drawn([&](Film& film) {
              for (int i = 0; i < kMany; i += 20) {
                renderer_->compile(variant_, scratch(), view_);  // forgets the pace
                add(film, i, i + 20);
              }
            })),
            bitsOf(expected));
}

/// Draws are timed by the clock that is named, which misses nothing but what is done between them.
TEST_P(Draws, AreTimed) {
  size_ = {64, 64};
  Film film(size_);
  renderer_->compile(variant_, film, view_);
  RenderTimes times;
  for (int i = 0; i < 3; ++i) {
    const RenderTimes before = times;
    renderer_->addSamples(film, view_, i, i + 1, times, [](double) { return true; });
    const double drawn = times.drawMs - before.drawMs;
    const double all = times.renderMs - before.renderMs;
    EXPECT_GT(drawn, 0.0);
    if (context().software) {
      EXPECT_LE(drawn, all);
      EXPECT_GT(drawn, 0.5 * all);
    }
  }
  EXPECT_STREQ(renderer_->clock(), context().software ? "wall clock" : "gpu timer");
}

/// A variant whose paths can be suspended from the first draw on draws the same, when draws end in their
/// midst.
TEST_P(Draws, AVariantThatSuspendsFromTheStart) {
  constexpr int kMany = 700;
  size_ = {16, 12};
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, kMany); });
  variant_.resumable = true;
  EXPECT_EQ(bitsOf(drawn([&](Film& film) { add(film, 0, kMany); })), bitsOf(expected));
}

/// If work ends by an exception, even between light paths, the renderer is left with the picture's own
/// program.
TEST_P(Draws, WorkThatIsThrownOutOf) {
  constexpr int kFew = 2;
  size_ = {64, 48};
  open("caustics.gltf", {});
  ASSERT_TRUE(has(variant_.traits, Trait::Caustics));
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, kFew); });
  int calls = 0;
  const FilmPixels then = drawn([&](Film& film) {
    for (int last = 1;; ++last) {
      calls = 0;
      try {
        renderer_->addSamples(film, view_, 0, kFew, times_, [&](double) {
          if (++calls == last) throw std::runtime_error("stopped");
          return true;
        });
        return;
      } catch (const std::runtime_error&) {
        film.clear();
      }
    }
  });
  EXPECT_GE(calls, 4);  // a draw of the picture and one of light paths, for each sample
  EXPECT_EQ(bitsOf(then), bitsOf(expected));
}

/// Scatterings at smooth glass are kept apart from the others, and what --bounces cuts is counted once.
TEST_P(Draws, PathsThatAreSuspendedInGlass) {
  constexpr int kMany = 300;
  size_ = {16, 12};
  open("glass-sphere.gltf", {});
  view_.bounces = 1;
  ASSERT_TRUE(has(variant_.traits, Trait::Transmission));
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, kMany); });
  EXPECT_GT(expected.cut, 0.01 * kMany * double(expected.pixels.size()));
  variant_.resumable = true;
  const FilmPixels suspended = drawn([&](Film& film) { add(film, 0, kMany); });
  EXPECT_EQ(bitsOf(suspended), bitsOf(expected));
  EXPECT_NEAR(suspended.cut / expected.cut, 1.0, 1e-3);
}

TEST_P(Draws, PathsThatAreSuspendedInAnInstance) {
  constexpr int kMany = 700;
  RenderOptions options;
  options.device.instancing = Instancing::Share;
  size_ = {16, 12};
  open("transforms.gltf", options);
  ASSERT_TRUE(has(variant_.traits, Trait::Instances));
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, kMany); });
  variant_.resumable = true;
  EXPECT_EQ(bitsOf(drawn([&](Film& film) { add(film, 0, kMany); })), bitsOf(expected));
}

/// Paths that are longer than a draw continue in the next one.
TEST_P(Draws, PathsThatAreSuspended) {
  RenderOptions options;
  options.stages = stagesUpTo(Stage::Flat);
  options.device.traversal = TraversalMethod::Iterative;
  size_ = {40, 30};
  open("mesh-15743.gltf", options);
  const FilmPixels expected = drawn([&](Film& film) { add(film, 0, 3); });
  EXPECT_EQ(bitsOf(drawn([&](Film& film) {
              add(film, 0, 1);
              add(film, {{{17, 0}, {23, 30}, 1, 3, 1.0}, {{0, 0}, {17, 30}, 1, 3, 1.0}});
            })),
            bitsOf(expected));
}

INSTANTIATE_TEST_SUITE_P(Backends, Draws, bothBackends(), backendName);

}  // namespace
}  // namespace fragtrace
