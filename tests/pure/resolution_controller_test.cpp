// SPDX-License-Identifier: MIT
#include "view/resolution_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace fragtrace {
namespace {

constexpr glm::ivec2 kFull{1280, 720};

/// A machine: milliseconds of a frame of so many pixels.
struct Machine {
  double overheadMs = 0.0;
  double msPerPixel = 1e-4;
  double noise = 0.0;         ///< standard deviation of the logarithm
  double hiccupChance = 0.0;  ///< probability of a frame that takes five times as long
};

struct Frames {
  std::vector<double> ms;
  std::vector<size_t> steps;
};

/// Frames while moving, from a controller that knows nothing.
Frames move(const Machine& machine, int frames, ResolutionController& controller, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  Frames run;
  for (int i = 0; i < frames; ++i) {
    keepMoving(controller, kFull);
    const glm::ivec2 size = sizeAtStep(kFull, controller.step);
    double ms = (machine.overheadMs + machine.msPerPixel * size.x * size.y) *
                std::exp(machine.noise * normal(random));
    if (chance(random) < machine.hiccupChance) ms *= 5.0;
    run.ms.push_back(ms);
    run.steps.push_back(controller.step);
    frameTaken(controller, kFull, size, ms);
  }
  return run;
}

size_t changesAfter(const Frames& run, size_t first) {
  size_t changes = 0;
  for (size_t i = first + 1; i < run.steps.size(); ++i) changes += run.steps[i] != run.steps[i - 1] ? 1 : 0;
  return changes;
}

double medianAfter(const Frames& run, size_t first) {
  std::vector<double> ms(run.ms.begin() + std::ptrdiff_t(first), run.ms.end());
  std::ranges::nth_element(ms, ms.begin() + std::ptrdiff_t(ms.size() / 2));
  return ms[ms.size() / 2];
}

TEST(Resolution, StepsRoundUpAndNeverVanish) {
  EXPECT_EQ(sizeAtStep({1280, 720}, 0), glm::ivec2(1280, 720));
  EXPECT_EQ(sizeAtStep({1280, 721}, 2), glm::ivec2(640, 361));
  EXPECT_EQ(sizeAtStep({3, 1}, kResolutionSteps.size() - 1), glm::ivec2(1, 1));
}

TEST(Resolution, AFastMachineComesToFullResolution) {
  ResolutionController controller;
  const Frames run = move({.msPerPixel = 1e-5}, 20, controller);
  EXPECT_EQ(controller.step, 0u);
  EXPECT_EQ(changesAfter(run, 10), 0u);
}

TEST(Resolution, HoldsTheTargetAtTheFinestStepThatDoes) {
  for (const double msPerPixel : {3e-5, 1e-4, 3e-4, 1e-3, 1.5e-3}) {
    ResolutionController controller;
    const Frames run = move({.msPerPixel = msPerPixel}, 100, controller);
    EXPECT_EQ(changesAfter(run, 20), 0u) << msPerPixel;
    EXPECT_LE(run.ms.back(), controller.targetMs) << msPerPixel;
    const glm::ivec2 finer = sizeAtStep(kFull, controller.step > 0 ? controller.step - 1 : 0);
    if (controller.step > 0) {
      EXPECT_GT(msPerPixel * finer.x * finer.y, 0.8 * controller.targetMs) << msPerPixel;
    }
  }
}

TEST(Resolution, AHopelessMachineKeepsAQuarterOfWidthAndHeight) {
  EXPECT_EQ(sizeAtStep(kFull, kResolutionSteps.size() - 1), kFull / 4);
  ResolutionController controller;
  const Frames run = move({.overheadMs = 50.0, .msPerPixel = 0.1}, 50, controller);
  EXPECT_EQ(run.steps.back(), kResolutionSteps.size() - 1);
  EXPECT_EQ(changesAfter(run, 5), 0u);
}

TEST(Resolution, OverheadDoesNotMakeItOscillate) {
  for (const double overhead : {15.0, 45.0, 75.0, 96.0}) {
    for (const double msPerPixel : {1e-5, 1e-4, 1e-3}) {
      ResolutionController controller;
      const Frames run = move({overhead, msPerPixel}, 200, controller);
      EXPECT_EQ(changesAfter(run, 50), 0u) << overhead << " " << msPerPixel;
    }
  }
}

/// Times that scatter by a fifth, with one frame of a hundred five times as long, on machines of any speed:
/// the median holds the target, and the step changes once a second at most.
TEST(Resolution, NoiseHardlyMovesIt) {
  for (const double msPerPixel : {5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 1.2e-3}) {
    ResolutionController controller;
    const Frames run = move({.overheadMs = 2.0, .msPerPixel = msPerPixel, .noise = 0.2, .hiccupChance = 0.01},
                            3000, controller);
    EXPECT_LE(medianAfter(run, 30), controller.targetMs) << msPerPixel;
    EXPECT_LE(changesAfter(run, 30), 100u) << msPerPixel;
  }
}

TEST(Resolution, OneHiccupBelowTwiceTheTargetChangesNothing) {
  ResolutionController controller;
  const Machine machine{.msPerPixel = 3e-4};
  move(machine, 50, controller);
  const size_t step = controller.step;
  frameTaken(controller, kFull, sizeAtStep(kFull, step), 1.9 * controller.targetMs);
  EXPECT_EQ(controller.step, step);
  frameTaken(controller, kFull, sizeAtStep(kFull, step), 1.9 * controller.targetMs);
  EXPECT_GT(controller.step, step);
}

TEST(Resolution, ASuddenlyDearViewIsAnsweredWithinOneFrame) {
  ResolutionController controller;
  move({.msPerPixel = 1e-5}, 20, controller);
  const Frames dear = move({.msPerPixel = 1e-3}, 3, controller);
  EXPECT_GT(dear.ms[0], 500.0);
  EXPECT_LE(dear.ms[1], controller.targetMs);
}

TEST(Resolution, ACheapViewIsRefinedWithinASecond) {
  ResolutionController controller;
  move({.msPerPixel = 1e-3}, 30, controller);
  const Frames cheap = move({.msPerPixel = 1e-5}, 30, controller);
  EXPECT_EQ(cheap.steps.back(), 0u);
}

TEST(Resolution, StandingStillRefinesStepByStep) {
  ResolutionController controller;
  move({.msPerPixel = 1e-3}, 30, controller);
  const size_t moving = controller.step;
  for (size_t step = moving; step-- > 0;) {
    refine(controller, kFull);
    EXPECT_EQ(controller.step, step);
    const glm::ivec2 size = sizeAtStep(kFull, controller.step);
    frameTaken(controller, kFull, size, 1e-3 * size.x * size.y);
  }
  refine(controller, kFull);
  EXPECT_EQ(controller.step, 0u);
  // Moving again: at once at the step that holds the target.
  keepMoving(controller, kFull);
  EXPECT_EQ(controller.step, moving);
}

TEST(Resolution, StandingStillOnAFastMachineIsAtOnceAtFull) {
  ResolutionController controller;
  move({.msPerPixel = 1.05e-4}, 30, controller);
  EXPECT_GT(controller.step, 0u);
  refine(controller, kFull);
  EXPECT_EQ(controller.step, 0u);
}

TEST(Resolution, SomethingElseBeginsAtTheStepThatItsOwnTimesAllow) {
  ResolutionController controller;
  move({.msPerPixel = 1e-6}, 30, controller);
  refine(controller, kFull);
  ASSERT_EQ(controller.step, 0u);
  drawSomethingElse(controller, kFull, 0.0);
  EXPECT_EQ(controller.step, kResolutionSteps.size() - 1) << "not known";
  drawSomethingElse(controller, kFull, 1e-6);
  EXPECT_EQ(controller.step, 0u) << "drawn before, and cheap";
  refine(controller, kFull);
  EXPECT_FALSE(controller.moving);
}

/// Moving frames of a device: samples until no more fits, each as long as the machine takes.
Frames moveWithSamples(double msPerPixel, int frames, ResolutionController& controller,
                       std::vector<int>& samples) {
  Frames run;
  for (int i = 0; i < frames; ++i) {
    keepMoving(controller, kFull);
    const glm::ivec2 size = sizeAtStep(kFull, controller.step);
    const double sampleMs = msPerPixel * size.x * size.y;
    const int taken = 1 + samplesThatFit(controller, sampleMs, 1);
    EXPECT_EQ(samplesThatFit(controller, taken * sampleMs, taken), 0);
    frameTaken(controller, kFull, size, sampleMs);
    run.ms.push_back(taken * sampleMs);
    run.steps.push_back(controller.step);
    samples.push_back(taken);
  }
  return run;
}

TEST(Resolution, AGpuFillsARefreshWithSamplesAndNoMore) {
  ResolutionController controller = controllerFor(false);
  std::vector<int> samples;
  const double pixels = double(kFull.x) * kFull.y;
  const Frames fast = moveWithSamples(0.3 / pixels, 30, controller, samples);
  EXPECT_EQ(controller.step, 0u);
  EXPECT_EQ(samples.back(), 16) << "the most";
  const Frames medium = moveWithSamples(4.0 / pixels, 30, controller, samples);
  EXPECT_EQ(samples.back(), 3);
  // A view that takes ten times as long costs one frame, below 50 ms, of one sample.
  const Frames dear = moveWithSamples(40.0 / pixels, 30, controller, samples);
  EXPECT_LT(*std::ranges::max_element(dear.ms), 50.0);
  EXPECT_LE(dear.ms.back(), controller.targetMs);
  EXPECT_GT(controller.step, 0u);
  for (const Frames& run : {fast, medium}) EXPECT_LE(run.ms.back(), controller.targetMs);
}

TEST(Resolution, SoftwareTakesOneSampleOfAMovingFrame) {
  ResolutionController controller = controllerFor(true);
  std::vector<int> samples;
  moveWithSamples(1e-7, 20, controller, samples);
  EXPECT_EQ(controller.step, 0u);
  EXPECT_EQ(*std::ranges::max_element(samples), 1);
}

TEST(Resolution, TimesThatAreNoneCountNothing) {
  ResolutionController controller;
  keepMoving(controller, kFull);
  const ResolutionController before = controller;
  for (const double ms : {0.0, -1.0, std::nan(""), double(INFINITY)})
    frameTaken(controller, kFull, {80, 45}, ms);
  frameTaken(controller, kFull, {0, 0}, 5.0);
  EXPECT_EQ(controller.msPerPixel, before.msPerPixel);
  EXPECT_EQ(controller.step, before.step);
}

}  // namespace
}  // namespace fragtrace
