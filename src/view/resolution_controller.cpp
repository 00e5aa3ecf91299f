// SPDX-License-Identifier: MIT
#include "view/resolution_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fragtrace {

namespace {

/// Part of the target that a finer step may be expected to take: what lies between this and the target is
/// where the step stays, wider than the noise of a median.
constexpr double kFinerShare = 0.8;
/// A frame this many times the target is answered at once.
constexpr double kFarTooLong = 2.0;
/// Milliseconds that somebody waits without noticing that the picture stands still.
constexpr double kUnnoticedMs = 100.0;

double pixelsAt(glm::ivec2 full, size_t step) {
  const glm::ivec2 size = sizeAtStep(full, step);
  return double(size.x) * size.y;
}

/// The finest step whose frames take at most `ms` at that cost, else the coarsest.
size_t finestWithin(glm::ivec2 full, double msPerPixel, double ms) {
  for (size_t step = 0; step < kResolutionSteps.size(); ++step) {
    if (pixelsAt(full, step) * msPerPixel <= ms) return step;
  }
  return kResolutionSteps.size() - 1;
}

/// The upper median of the latest three, or of as many as there are: two slow frames count, one does not.
double medianCost(const ResolutionController& controller) {
  std::array<double, 3> latest{controller.msPerPixel[0], controller.msPerPixel[1], controller.msPerPixel[2]};
  if (latest[1] <= 0.0) return latest[0];
  if (latest[2] <= 0.0) return std::max(latest[0], latest[1]);
  std::ranges::sort(latest);
  return latest[1];
}

}  // namespace

glm::ivec2 sizeAtStep(glm::ivec2 full, size_t step) {
  const double divisor = kResolutionSteps.at(step);
  return {std::max(1, int(std::ceil(full.x / divisor))), std::max(1, int(std::ceil(full.y / divisor)))};
}

void keepMoving(ResolutionController& controller, glm::ivec2 full) {
  if (controller.moving) return;
  controller.moving = true;
  const double cost = medianCost(controller);
  controller.step = cost > 0.0 ? finestWithin(full, cost, controller.targetMs) : kResolutionSteps.size() - 1;
}

ResolutionController controllerFor(bool software) {
  constexpr double kRefreshMs = 1000.0 / 60.0;
  constexpr int kMostSamples = 16;
  ResolutionController controller;
  if (software) return controller;
  controller.targetMs = kRefreshMs;
  controller.mostSamples = kMostSamples;
  return controller;
}

int samplesThatFit(const ResolutionController& controller, double elapsedMs, int samples) {
  if (!controller.moving || controller.step > 0) return 0;
  const double fit = kFinerShare * controller.targetMs * samples / std::max(elapsedMs, 1e-6);
  return std::max(0, int(std::min(fit, double(controller.mostSamples))) - samples);
}

void drawSomethingElse(ResolutionController& controller, glm::ivec2 full, double msPerPixel) {
  controller.msPerPixel = {msPerPixel};
  const bool moving = std::exchange(controller.moving, false);
  keepMoving(controller, full);
  controller.moving = moving;
}

void refine(ResolutionController& controller, glm::ivec2 full) {
  controller.moving = false;
  if (controller.step == 0) return;
  const double cost = medianCost(controller);
  const bool unnoticed = cost > 0.0 && pixelsAt(full, 0) * cost <= kUnnoticedMs;
  controller.step = unnoticed ? 0 : controller.step - 1;
}

void frameTaken(ResolutionController& controller, glm::ivec2 full, glm::ivec2 drawn, double ms) {
  if (!(ms > 0.0) || !std::isfinite(ms) || drawn.x <= 0 || drawn.y <= 0) return;
  std::array<double, 8>& costs = controller.msPerPixel;
  std::shift_right(costs.begin(), costs.end(), 1);
  costs[0] = ms / (double(drawn.x) * drawn.y);
  if (!controller.moving) return;

  const double pixels = pixelsAt(full, controller.step);
  if (costs[0] * pixels > kFarTooLong * controller.targetMs) {
    controller.step = std::max(controller.step, finestWithin(full, costs[0], controller.targetMs));
    return;
  }
  const double median = medianCost(controller);
  if (median * pixels > controller.targetMs) {
    controller.step = std::max(controller.step, finestWithin(full, median, controller.targetMs));
    return;
  }
  const bool known = costs.back() > 0.0;
  if (known) {
    const double worst = *std::ranges::max_element(costs);
    controller.step = std::min(controller.step, finestWithin(full, worst, kFinerShare * controller.targetMs));
  }
}

}  // namespace fragtrace
