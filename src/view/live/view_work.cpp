// SPDX-License-Identifier: MIT
// One turn of the viewer's tracing thread: it chooses the side that is drawn next, the resolution and the
// samples.
#include <algorithm>

#include "base/timeline.h"
#include "view/live/view_tracer.h"

namespace fragtrace {

namespace {

/// Samples between two looks at the clock, while nothing moves.
constexpr double kRoundMs = 100.0;
/// Pictures are published at most this often, and take at most a fifth of the time; half of it where they are
/// filtered, which shows more than the samples that this time would bring.
constexpr double kPublishMs = 100.0;
constexpr double kPublishShare = 4.0;
constexpr double kFilteredShare = 1.0;
constexpr size_t kFrames = 64;        ///< whose times are summarised
constexpr int kMeanwhileSamples = 4;  ///< samples of a picture that another one replaces soon
/// With fewer samples, edges are ragged. So the coarser picture before, which is smooth, stays until there
/// are kSmoothSamples, but for at most kSmoothMs.
constexpr int kSmoothSamples = 4;
constexpr double kSmoothMs = 500.0;

}  // namespace

void ViewTracer::fitFilm(Side& side) {
  const glm::ivec2 size = sizeAtStep(request_.size, resolution_.step);
  side.view.firstInMiddle = resolution_.step > 0;
  const bool fits = side.film && side.film->size() == size;
  const bool wasMoving = side.guessesLightPaths || side.byCones;
  if (fits && !side.stale && !(wasMoving && isStill())) return;
  // A moving picture does not wait to see if it needs light paths: it does as the one before.
  side.guessesLightPaths = !isStill() && side.program->tracer.renderer->weighsLightPaths(side.view);
  const int before = side.film ? side.film->pixelsPerPath() : 0;
  side.view.pixelsPerPath = !side.guessesLightPaths ? 0 : before > 0 ? before : kPixelsPerPath;
  if (!fits || side.byCones) side.memory.turn();
  side.byCones = !isStill() && side.program->hasCones;
  side.shownAt = 0;
  if (side.film)
    side.film->restart(size);
  else
    side.film = std::make_unique<Film>(size);
  side.stale = false;
  side.samples = 0;
  side.times = {};
  side.error = -1.0;
  side.errorAt = 0;
}

bool ViewTracer::drawsCones(const Side& side) { return side.byCones && side.program->hasCones; }

bool ViewTracer::resting(const Side& side) const {
  if (!side.program) return true;
  if (side.stale || side.samples == 0) return false;
  // Processors are left to the compiler.
  if (side.awaited && side.samples >= kMeanwhileSamples) return true;
  const RenderOptions& o = side.options;
  const bool converged = o.sampling.noise > 0.0 && side.error >= 0.0 && side.error <= o.sampling.noise;
  return converged || side.samples >= o.sampling.spp ||
         (o.sampling.seconds > 0.0 && side.times.renderMs >= 1000.0 * o.sampling.seconds);
}

bool ViewTracer::isStill() const { return !request_.moving && resolution_.step == 0; }

bool ViewTracer::draw(Side& side) {
  Renderer& renderer = *side.program->tracer.renderer;
  const glm::ivec2 size = side.film->size();
  const double frameMs = renderer.msPerSample() * size.x * size.y;
  const double affordable = frameMs > 0.0 ? kRoundMs / frameMs : 1.0;
  const int most = std::max(1, std::min(side.samples, side.options.sampling.spp - side.samples));
  int count = isStill() ? int(std::clamp(affordable, 1.0, double(most))) : 1;
  const double before = side.times.renderMs;
  clock_.restart();
  const Tracer& tracer = side.program->tracer;
  renderer.use(drawsCones(side) ? tracer.cones.front() : tracer.variant);
  // A frame of a moving picture is short, and worth its end: else nothing would be seen before the hand
  // rests. Its first sample says how many more it may have, which are drawn at once.
  int added = 0;
  do {
    const bool complete = renderer.addSamples(
        *side.film, side.view, side.samples, side.samples + count, side.times,
        [&](double) { return !(request_.moving ? exchange_.ending() : exchange_.interrupted()); });
    if (!complete) return false;
    side.samples += count;
    added += count;
    const double elapsedMs = (side.times.renderMs - before) * double(sides_.size());
    count = std::min(samplesThatFit(resolution_, elapsedMs, added), side.options.sampling.spp - side.samples);
  } while (request_.moving && count > 0);
  clock_.end(Pass::Trace);
  const double filterMs = denoises(side) && !isStill() ? filterMsPerPixel_ * size.x * size.y : 0.0;
  frameTaken(resolution_, request_.size, size,
             ((side.times.renderMs - before) / added + filterMs) * double(sides_.size()));
  std::vector<double>& frames = side.times.frameMs;
  if (frames.size() > kFrames) frames.erase(frames.begin(), frames.end() - kFrames);
  return true;
}

bool ViewTracer::worthShowing(const Side& side) const {
  if (resting(side)) return true;
  const double shownFor = steadyMilliseconds() - side.published;
  if (side.shownAt == 0) return side.samples >= kSmoothSamples || shownFor > kSmoothMs;
  if (denoisesByOidn(side)) return side.samples >= 2 * side.shownAt;
  const double pause = (denoises(side) ? kFilteredShare : kPublishShare) * publishMs_;
  return shownFor > std::max(kPublishMs, pause) * double(sides_.size());
}

bool ViewTracer::work() {
  if (sides_.empty()) return false;
  // Step: one frame at each resolution on the way to the full one.
  const bool drawn =
      std::ranges::all_of(sides_, [](const Side& s) { return !s.program || (!s.stale && s.samples > 0); });
  if (drawn && !request_.moving) refine(resolution_, request_.size);
  for (Side& side : sides_) {
    if (side.program) fitFilm(side);
  }
  const bool still = isStill();
  // A film that has just become this large holds nothing yet.
  const bool whole = std::ranges::all_of(sides_, [](const Side& s) { return !s.program || s.samples > 0; });
  if (still && whole && !awaitsProgram() && !programs_->compiling()) {
    saving_ = !saves_.empty();
    for (const SaveRequest& request : saves_) save(request);
    saves_.clear();
    saving_ = false;
  }
  // Step: the side that has the fewest samples; while something moves, all of them.
  std::vector<Side*> next;
  for (Side& side : sides_) {
    if (!resting(side)) next.push_back(&side);
  }
  // A film of the next finer step may hold its frame already: one more turn then goes on to the step after.
  if (next.empty()) return !request_.moving && resolution_.step > 0;
  if (!request_.moving) next = {*std::ranges::min_element(next, {}, &Side::samples)};
  // They are handed over at once, so that all show the same moment.
  std::vector<TracedPicture> pictures;
  for (Side* side : next) {
    if (!draw(*side)) return true;
    if (still && !worthShowing(*side)) continue;
    if (std::optional<TracedPicture> picture = pictureOf(*side)) pictures.push_back(std::move(*picture));
  }
  exchange_.deliver(std::move(pictures));
  return true;
}

}  // namespace fragtrace
