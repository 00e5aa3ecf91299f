// SPDX-License-Identifier: MIT
#include "render/adaptive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

namespace fragtrace {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBlock = 8;          // pixels a side that share one number of samples
constexpr int kTile = 256;         // pixels a side of one draw
constexpr int kFirstSamples = 32;  // of each half
constexpr double kPart = 0.95;     // of the pixels that have to be under the noise
constexpr uint32_t kOtherHalf = 0x9e3779b9u;

/// One block of pixels: its samples in each half, and what the next ones are worth.
struct Block {
  int samples = kFirstSamples;
  int pixels = 0;
  int above = 0;       ///< pixels above the noise asked for
  double error = 0.0;  ///< sum of the squared relative errors
  bool chosen = false;

  /// What a sample takes from the picture's squared error; it falls with the square of the samples.
  double worth() const { return error / (double(samples) * pixels); }
};

struct Blocks {
  glm::ivec2 picture{0};
  glm::ivec2 size{0};
  std::vector<Block> blocks;

  explicit Blocks(glm::ivec2 pictureSize)
      : picture(pictureSize),
        size((pictureSize + (kBlock - 1)) / kBlock),
        blocks(size_t(size.x) * size_t(size.y)) {}
  Block& ofPixel(int x, int y) { return blocks[size_t(y / kBlock) * size_t(size.x) + size_t(x / kBlock)]; }
};

void weigh(Blocks& blocks, const std::vector<double>& errors, double noise) {
  for (Block& b : blocks.blocks) b = {b.samples, 0, 0, 0.0, false};
  for (int y = 0; y < blocks.picture.y; ++y) {
    for (int x = 0; x < blocks.picture.x; ++x) {
      const double e = errors[size_t(y) * size_t(blocks.picture.x) + size_t(x)];
      Block& b = blocks.ofPixel(x, y);
      b.pixels += 1;
      b.above += e > noise;
      b.error += e * e;
    }
  }
}

/// Marks the blocks whose samples are to double. Returns the samples that this takes in both halves.
double chooseBlocks(Blocks& blocks, const AdaptiveGoal& goal, double affordable) {
  std::vector<Block*> candidates;
  double spent = 0.0;
  for (Block& b : blocks.blocks) {
    spent += 2.0 * b.samples * b.pixels;
    const bool wanted = goal.noise > 0.0 ? b.above > (1.0 - kPart) * b.pixels : b.error > 0.0;
    if (wanted && b.samples <= goal.mostSamples / 4) candidates.push_back(&b);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Block* a, const Block* b) { return a->worth() > b->worth(); });
  // Without a noise to reach, half as much as so far at a time: worth changes as samples come in.
  const double most = goal.noise > 0.0 ? affordable : std::min(affordable, 0.5 * spent);
  double cost = 0.0;
  for (Block* b : candidates) {
    const double own = 2.0 * b->samples * b->pixels;
    if (cost + own > most && (cost > 0.0 || own > affordable)) break;
    b->chosen = true;
    cost += own;
  }
  return cost;
}

/// The chosen blocks as draws, by tiles and numbers of samples; doubles their samples.
std::vector<Work> takeWork(Blocks& blocks, std::vector<uint32_t>& targets) {
  std::map<std::tuple<int, int, int>, int> busy;  // samples, tile y, tile x: pixels
  targets.resize(size_t(blocks.picture.x) * size_t(blocks.picture.y));
  for (int y = 0; y < blocks.picture.y; ++y) {
    for (int x = 0; x < blocks.picture.x; ++x) {
      const Block& b = blocks.ofPixel(x, y);
      targets[size_t(y) * size_t(blocks.picture.x) + size_t(x)] =
          uint32_t(b.chosen ? 2 * b.samples : b.samples);
      if (b.chosen) ++busy[{b.samples, y / kTile, x / kTile}];
    }
  }
  std::vector<Work> work;
  for (const auto& [key, pixels] : busy) {
    const auto [samples, tileY, tileX] = key;
    const glm::ivec2 corner = glm::ivec2(tileX, tileY) * kTile;
    const glm::ivec2 size = glm::min(glm::ivec2(kTile), blocks.picture - corner);
    work.push_back({corner, size, samples, 2 * samples, double(pixels) / (double(size.x) * size.y)});
  }
  for (Block& b : blocks.blocks) b.samples *= b.chosen ? 2 : 1;
  return work;
}

}  // namespace

AdaptivePicture renderAdaptively(Renderer& renderer, glm::ivec2 size, const View& view,
                                 const AdaptiveGoal& goal, RenderTimes& times,
                                 const Renderer::Progress& progress) {
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  AdaptivePicture picture;
  double roundsDone = 0.0;
  const auto goOn = [&](double) {
    const double timeDone = goal.seconds > 0.0 ? elapsed() / goal.seconds : 0.0;
    picture.stopped = !progress(std::clamp(std::max(roundsDone, timeDone), 0.0, 1.0));
    return !picture.stopped && timeDone < 1.0;
  };

  Film films[2] = {Film(size), Film(size)};
  View views[2] = {view, view};
  views[1].seed ^= kOtherHalf;
  Blocks blocks(size);
  for (Block& b : blocks.blocks) b.samples = std::max(1, std::min(kFirstSamples, goal.mostSamples / 2));
  const int first = blocks.blocks.front().samples;
  bool more = true;
  for (int half : {0, 1}) more = more && renderer.addSamples(films[half], views[half], 0, first, times, goOn);

  for (;;) {
    Halves halves{films[0].read(), films[1].read()};
    picture.pixels = pooled(halves.a, halves.b);
    picture.variance = varianceOfMean(halves);
    const std::vector<double> errors = relativeErrors(picture.pixels, picture.variance);
    picture.error = quantileOf(errors, kPart);
    picture.rounds += 1;
    weigh(blocks, errors, goal.noise);
    double under = double(errors.size());
    for (const Block& b : blocks.blocks) under -= b.above;
    picture.share = goal.noise > 0.0 ? under / double(errors.size()) : 0.0;
    // Errors fall with the root of the samples.
    roundsDone = goal.noise > 0.0 ? std::pow(goal.noise / std::max(picture.error, goal.noise), 2.0) : 0.0;
    if (!more || (goal.noise > 0.0 && picture.share >= kPart)) return picture;

    const double msLeft = (goal.seconds - elapsed()) * 1000.0;
    const double affordable = goal.seconds > 0.0 ? msLeft / std::max(renderer.msPerSample(), 1e-9)
                                                 : std::numeric_limits<double>::infinity();
    if (chooseBlocks(blocks, goal, affordable) <= 0.0) return picture;
    std::vector<uint32_t> targets;
    const std::vector<Work> work = takeWork(blocks, targets);
    films[0].setTargets(halves.a, targets);
    films[1].setTargets(halves.b, targets);
    for (int half : {0, 1}) more = more && renderer.addSamples(films[half], views[half], work, times, goOn);
  }
}

}  // namespace fragtrace
