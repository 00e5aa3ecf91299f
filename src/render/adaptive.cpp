// SPDX-License-Identifier: MIT
#include "render/adaptive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace fragtrace {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBlockSide = 8;      // pixels a side that share one number of samples
constexpr int kTile = 256;         // pixels per side of one draw
constexpr int kFirstSamples = 32;  // samples of each half

/// One block of pixels: its samples in each half, and the worth of the next ones.
struct Block {
  int samples = kFirstSamples;
  int target = kFirstSamples;  ///< samples after this round
  int pixels = 0;
  int noisy = 0;  ///< pixels that can be
  int lit = 0;    ///< pixels among these that light has met
  int above = 0;  ///< pixels above the noise asked for
  int litAbove = 0;
  double error = 0.0;  ///< sum of the squared relative errors
  double rays = 0.0;   ///< of a sample of each pixel
  double worst = 0.0;  ///< largest relative error of those pixels that may not be above the noise asked for

  /// The samples after a round with enough time: twice as many, so that Sobol sequences stay whole, or as
  /// many as are left.
  int next(int mostSamples) const { return int(std::min<int64_t>(int64_t(samples) * 2, mostSamples / 2)); }

  /// The samples in both halves that are needed to get there.
  double cost(int to) const { return 2.0 * (to - samples) * pixels; }

  bool tooNoisy() const {
    constexpr double kOver = 1.0 - kPartUnderGoal;
    return above > kOver * noisy || litAbove > kOver * lit;
  }

  /// The samples in each half that it will take, if errors fall with this power of the samples; at least
  /// `from`.
  int last(const AdaptiveGoal& goal, double power, int from) const {
    if (!tooNoisy()) return from;
    const double needed = samples * std::pow(worst / goal.noise, 1.0 / power);
    Block after = *this;
    after.samples = from;
    while (after.samples < needed && after.next(goal.mostSamples) > after.samples)
      after.samples = after.next(goal.mostSamples);
    return after.samples;
  }

  /// The amount by which one more sample lowers the picture's squared error; it falls with the square of the
  /// samples.
  double worth() const { return error / (double(samples) * pixels); }
};

struct Blocks {
  glm::ivec2 picture{0};
  glm::ivec2 size{0};
  std::vector<Block> blocks;

  explicit Blocks(glm::ivec2 pictureSize)
      : picture(pictureSize),
        size((pictureSize + (kBlockSide - 1)) / kBlockSide),
        blocks(size_t(size.x) * size_t(size.y)) {}
  Block& ofPixel(int x, int y) {
    return blocks[size_t(y / kBlockSide) * size_t(size.x) + size_t(x / kBlockSide)];
  }
};

void weigh(Blocks& blocks, const FilmPixels& pixels, const std::vector<double>& errors, double noise) {
  for (Block& b : blocks.blocks) b = {b.samples, b.samples};
  std::vector<std::vector<double>> noisy(blocks.blocks.size());
  for (int y = 0; y < blocks.picture.y; ++y) {
    for (int x = 0; x < blocks.picture.x; ++x) {
      const size_t i = size_t(y) * size_t(blocks.picture.x) + size_t(x);
      const double e = errors[i];
      Block& b = blocks.ofPixel(x, y);
      b.pixels += 1;
      b.rays += double(pixels.pixels[i].rays) / std::max(1.0, double(pixels.pixels[i].samples));
      const bool canBe = canBeNoisy(pixels.pixels[i]);
      const bool lit = canBe && pixels.pixels[i].luminance() != 0.0;
      b.noisy += canBe;
      if (canBe) noisy[size_t(&b - blocks.blocks.data())].push_back(e);
      b.lit += lit;
      b.above += e > noise;
      b.litAbove += lit && e > noise;
      b.error += e * e;
    }
  }
  for (size_t i = 0; i < noisy.size(); ++i) {
    if (noisy[i].empty()) continue;
    const auto rank = std::min(size_t((1.0 - kPartUnderGoal) * double(noisy[i].size())), noisy[i].size() - 1);
    const auto worst = noisy[i].begin() + std::ptrdiff_t(rank);
    std::ranges::nth_element(noisy[i], worst, std::greater());
    blocks.blocks[i].worst = *worst;
  }
}

/// How far the picture is, in rays.
struct Distance {
  double drawn = 0.0;  ///< before this round
  double round = 0.0;  ///< of this round
  double after = 0.0;  ///< likely to be needed after it

  double all() const { return drawn + round + after; }
};

/// Tells from the rays so far how much of the time is over. It counts from the end of the first draw on, in
/// which programs may be compiled.
struct RayClock {
  struct Mark {
    double rays = 0.0;
    double seconds = 0.0;
  };
  Mark first;
  Mark last;  ///< when the latest draw ended

  void note(double rays, double seconds) {
    if (rays <= last.rays) return;
    last = {rays, seconds};
    if (first.rays == 0.0) first = last;
  }

  /// The rays so far are these: they are counted in another way from now on.
  void recount(double rays) {
    if (last.rays > 0.0) first.rays *= rays / last.rays;
    last.rays = rays;
  }

  /// The share of the time after `seconds`, if there will be so many rays in all.
  double shareDone(double all, double seconds) const {
    if (last.rays == 0.0) return 0.0;
    const Mark since = last.rays > first.rays ? first : Mark();
    const double needed =
        (all - last.rays) * (last.seconds - since.seconds) / std::max(last.rays - since.rays, 1e-9);
    const double left = std::max(needed - (seconds - last.seconds), 0.1 * needed);
    return seconds / std::max(seconds + left, 1e-9);
  }
};

/// Relative errors of a picture's pixels.
struct Errors {
  const FilmPixels& pixels;
  const std::vector<double>& relative;
};

/// What is drawn until the blocks' targets, and is likely to be left then: the picture ends after the round
/// that brings enough of its pixels to the goal, if errors fall with this power of the samples.
Distance distanceOf(Blocks& blocks, const AdaptiveGoal& goal, const Errors& now, double power) {
  std::vector<int> samples;  // of each block after the rounds so far
  for (const Block& b : blocks.blocks) samples.push_back(b.target);
  for (bool grows = goal.noise > 0.0; grows;) {
    std::vector<double> then;
    for (size_t i = 0; i < now.relative.size(); ++i) {
      const Block& b = blocks.ofPixel(int(i) % blocks.picture.x, int(i) / blocks.picture.x);
      const int after = samples[size_t(&b - blocks.blocks.data())];
      then.push_back(now.relative[i] * std::pow(double(b.samples) / std::max(after, 1), power));
    }
    if (distanceTo(goal.noise, now.pixels, then, goal.catcher).share >= kPartUnderGoal) break;
    grows = false;
    for (size_t i = 0; i < samples.size(); ++i) {
      const Block& b = blocks.blocks[i];
      const int more = int(std::min<int64_t>(int64_t(samples[i]) * 2, b.last(goal, power, b.target)));
      grows = grows || more > samples[i];
      samples[i] = std::max(samples[i], more);
    }
  }
  Distance d;
  for (size_t i = 0; i < samples.size(); ++i) {
    const Block& b = blocks.blocks[i];
    d.drawn += 2.0 * b.samples * b.rays;
    d.round += 2.0 * (b.target - b.samples) * b.rays;
    d.after += 2.0 * (samples[i] - b.target) * b.rays;
  }
  return d;
}

/// The present knowledge of the way to the goal.
struct Estimate {
  Distance distance;
  RayClock clock;
  double power = 0.5;    ///< of the samples, with which errors fall; it is larger where these are stratified
  double squares = 0.0;  ///< sum of the squared errors at the latest look

  /// Looks at the first samples of each half; each look at twice as many as the one before.
  void look(const AdaptiveRun& run, const Blocks& blocks, const AdaptiveGoal& goal, int samples) {
    const Halves halves{run.films[0].read(), run.films[1].read()};
    const FilmPixels pixels = pooled(halves.a, halves.b);
    Blocks few = blocks;
    for (Block& b : few.blocks) b.samples = samples;
    const std::vector<double> errors = relativeErrors(pixels, varianceOfMean(halves));
    weigh(few, pixels, errors, goal.noise);
    const double before =
        std::exchange(squares, std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0));
    if (before > 0.0) power = std::clamp(0.5 * std::log2(before / squares), 0.5, 1.0);
    for (size_t i = 0; i < few.blocks.size(); ++i) few.blocks[i].target = blocks.blocks[i].target;
    measure(few, goal, {pixels, errors});
    distance.round += std::exchange(distance.drawn, 0.0);
  }

  void measure(Blocks& blocks, const AdaptiveGoal& goal, const Errors& now) {
    distance = distanceOf(blocks, goal, now, power);
    clock.recount(distance.drawn);
  }

  /// The share of the time after `seconds`, in which this part of the round was drawn.
  double shareDone(double ofRound, double seconds) {
    clock.note(distance.drawn + ofRound * distance.round, seconds);
    return clock.shareDone(distance.all(), seconds);
  }
};

/// Sets the targets of the blocks that get more samples, anywhere if `blind`. Returns the number of samples
/// in both halves, which is at most the affordable one.
double chooseTargets(Blocks& blocks, const AdaptiveGoal& goal, double affordable, bool blind) {
  std::vector<Block*> candidates;
  double spent = 0.0;
  double all = 0.0;
  for (Block& b : blocks.blocks) {
    spent += b.cost(2 * b.samples);
    const bool wanted = goal.noise > 0.0 ? b.tooNoisy() : b.error > 0.0;
    if ((!wanted && !blind) || b.next(goal.mostSamples) <= b.samples) continue;
    candidates.push_back(&b);
    all += b.cost(b.next(goal.mostSamples));
  }
  std::sort(candidates.begin(), candidates.end(), [](const Block* a, const Block* b) {
    return std::pair(-a->worth(), a->samples) < std::pair(-b->worth(), b->samples);
  });
  // Without a noise goal, a round draws half as many samples as so far, since their worth changes as samples
  // come in.
  const double most = goal.noise > 0.0 ? affordable : std::min(affordable, 0.5 * spent);
  double cost = 0.0;
  for (Block* b : candidates) {
    const double own = b->cost(b->next(goal.mostSamples));
    if (cost + own > most && (cost > 0.0 || own > affordable)) break;
    b->target = b->next(goal.mostSamples);
    cost += own;
  }
  if (cost > 0.0) return cost;
  // The time that is left is too short to double any block, so all get a part of it.
  for (Block* b : candidates) {
    b->target = b->samples + int((b->next(goal.mostSamples) - b->samples) * (affordable / all));
    cost += b->cost(b->target);
  }
  return cost;
}

/// The numbers of samples that all pixels should have.
std::vector<uint32_t> targetsOf(Blocks& blocks) {
  std::vector<uint32_t> targets;
  targets.reserve(size_t(blocks.picture.x) * size_t(blocks.picture.y));
  for (int y = 0; y < blocks.picture.y; ++y) {
    for (int x = 0; x < blocks.picture.x; ++x) targets.push_back(uint32_t(blocks.ofPixel(x, y).target));
  }
  return targets;
}

/// The draws that lead to the targets, by tiles and numbers of samples.
std::vector<Work> workOf(Blocks& blocks) {
  std::map<std::tuple<int, int, int, int>, int> busy;  // number of pixels by samples, target, tile y, tile x
  for (int y = 0; y < blocks.picture.y; ++y) {
    for (int x = 0; x < blocks.picture.x; ++x) {
      const Block& b = blocks.ofPixel(x, y);
      if (b.target > b.samples) ++busy[{b.samples, b.target, y / kTile, x / kTile}];
    }
  }
  std::vector<Work> work;
  for (const auto& [key, pixels] : busy) {
    const auto [from, to, tileY, tileX] = key;
    const glm::ivec2 corner = glm::ivec2(tileX, tileY) * kTile;
    const glm::ivec2 size = glm::min(glm::ivec2(kTile), blocks.picture - corner);
    work.push_back({corner, size, from, to, double(pixels) / (double(size.x) * size.y)});
  }
  return work;
}

/// A block before the first round.
Block firstOf(const AdaptiveGoal& goal) {
  Block block;
  block.samples = 0;
  block.target = std::max(1, std::min(kFirstSamples, goal.mostSamples / 2));
  return block;
}

/// Adds a round's samples to both halves; false if it was stopped. If time may end the first round, all
/// pixels get a sample before any gets many; else `look` sees the first few.
bool drawRound(Renderer& renderer, AdaptiveRun& run, Blocks& blocks, std::span<const View> views,
               bool isTimed, RenderTimes& times, const Renderer::Progress& progress,
               const std::function<void(int samples)>& look) {
  constexpr int kFew = 8;  // then twice as many, which tell more
  const int first = blocks.blocks.front().target;
  const bool begins = run.state.rounds == 0;
  const std::vector<Work> work = begins ? std::vector<Work>() : workOf(blocks);
  std::vector<int> steps = {first};
  if (begins && isTimed) steps = {1, std::min(4, first), first};
  if (begins && !isTimed && first > 2 * kFew) steps = {kFew, 2 * kFew, first};
  bool more = true;
  int from = 0;
  for (const int to : steps) {
    const double before = begins ? double(from) / first : 0.0;
    const double share = begins ? double(to - from) / first : 1.0;
    for (size_t half : {0, 1}) {
      if (!more || (begins && to <= from)) continue;
      const auto ofRound = [&](double done) {
        return progress(before + share * 0.5 * (double(half) + done));
      };
      more = begins ? renderer.addSamples(run.films[half], views[half], from, to, times, ofRound)
                    : renderer.addSamples(run.films[half], views[half], work, times, ofRound);
    }
    if (more && begins && !isTimed && to < first) look(to);
    from = std::max(from, to);
    if (!begins) break;
  }
  for (Block& b : blocks.blocks) b.samples = b.target;
  return more;
}

AdaptiveState stateOf(const Blocks& blocks, const AdaptiveState& before) {
  AdaptiveState state{{}, {}, before.rounds, before.seconds};
  for (const Block& b : blocks.blocks) {
    state.samples.push_back(b.samples);
    state.targets.push_back(b.target);
  }
  return state;
}

void loadState(Blocks& blocks, const AdaptiveState& state) {
  if (state.samples.size() != blocks.blocks.size() || state.targets.size() != blocks.blocks.size())
    throw std::invalid_argument("an adaptive picture goes on from the state of another size");
  for (size_t i = 0; i < blocks.blocks.size(); ++i) {
    blocks.blocks[i].samples = state.samples[i];
    blocks.blocks[i].target = state.targets[i];
  }
}

/// Says how far the picture's pixels are from the goal.
void judge(AdaptivePicture& picture, const AdaptiveGoal& goal, const std::vector<double>& errors) {
  const GoalDistance distance = distanceTo(goal.noise, picture.pixels, errors, goal.catcher);
  // An error needs at least two samples in each half.
  const bool enough = totalsOf(picture.pixels).fewestSamples >= 4;
  picture.share = enough && goal.noise > 0.0 ? distance.share : 0.0;
  picture.error = enough ? distance.error : 1.0;
  picture.black =
      std::ranges::all_of(picture.pixels.pixels, [](const FilmPixel& p) { return p.luminance() == 0.0; });
  picture.known = enough && !picture.black;
}

}  // namespace

size_t AdaptiveRun::blocksOf(glm::ivec2 size) { return Blocks(size).blocks.size(); }

uint32_t seedOfOtherHalf(uint32_t seed) { return seed * 0x9e3779b1u + 0x7f4a7c15u; }

AdaptivePicture renderAdaptively(Renderer& renderer, AdaptiveRun& run, const View& view,
                                 const AdaptiveGoal& goal, RenderTimes& times,
                                 const Renderer::Progress& progress) {
  const auto start = Clock::now();
  const double before = run.state.seconds;
  const auto elapsed = [&] { return before + std::chrono::duration<double>(Clock::now() - start).count(); };
  AdaptivePicture picture;
  // Until samples are there, as many as the limit lets, but at most three rounds more, are a guess.
  const double allowed = 0.5 * goal.mostSamples / firstOf(goal).target - 1.0;
  Estimate estimate{{0.0, 1.0, std::clamp(allowed, 0.0, 3.0)}, {}};
  const auto goOn = [&](double ofRound) {
    run.state.seconds = elapsed();
    const double timeDone = goal.seconds > 0.0 ? elapsed() / goal.seconds : 0.0;
    const double roundsDone = goal.noise > 0.0 ? estimate.shareDone(ofRound, elapsed()) : 0.0;
    picture.stopped = !progress(std::clamp(std::max(roundsDone, timeDone), 0.0, 1.0));
    return !picture.stopped && timeDone < 1.0;
  };

  std::array<View, 2> views = {view, view};
  views[1].seed = seedOfOtherHalf(view.seed);
  Blocks blocks(run.films[0].size());
  if (run.state.targets.empty()) {
    for (Block& b : blocks.blocks) b = firstOf(goal);
    run.state = stateOf(blocks, run.state);
  } else {
    loadState(blocks, run.state);
  }

  const auto look = [&](int samples) { estimate.look(run, blocks, goal, samples); };

  for (;;) {
    // Step: draw the round.
    const bool more = drawRound(renderer, run, blocks, views, goal.seconds > 0.0, times, goOn, look);

    // Step: find how far the picture is from the goal.
    const Halves halves{run.films[0].read(), run.films[1].read()};
    picture.pixels = pooled(halves.a, halves.b);
    picture.variance = varianceOfMean(halves);
    const std::vector<double> errors = relativeErrors(picture.pixels, picture.variance);
    run.state.rounds += 1;
    picture.rounds = run.state.rounds;
    weigh(blocks, picture.pixels, errors, goal.noise);
    judge(picture, goal, errors);
    const bool blind = goal.seconds > 0.0 && std::ranges::all_of(errors, [](double e) { return e == 0.0; });
    if (!more) run.state.rounds -= 1;  // the next call continues here
    if (!more || (goal.noise > 0.0 && picture.share >= kPartUnderGoal && !(picture.black && blind)))
      return picture;

    // Step: choose where the next samples go.
    const double msLeft = (goal.seconds - elapsed()) * 1000.0;
    const double affordable = goal.seconds > 0.0 ? msLeft / std::max(renderer.msPerSample(), 1e-9)
                                                 : std::numeric_limits<double>::infinity();
    if (chooseTargets(blocks, goal, affordable, blind) <= 0.0) return picture;
    estimate.measure(blocks, goal, {picture.pixels, errors});
    run.state = stateOf(blocks, run.state);
    const std::vector<uint32_t> targets = targetsOf(blocks);
    run.films[0].setTargets(halves.a, targets);
    run.films[1].setTargets(halves.b, targets);
  }
}

}  // namespace fragtrace
