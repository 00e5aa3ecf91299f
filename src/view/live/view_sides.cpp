// SPDX-License-Identifier: MIT
// Begins to draw a side of the viewer: filter, program, camera, and a preview until the program is there.
#include <algorithm>
#include <array>
#include <utility>

#include "base/summary.h"
#include "base/timeline.h"
#include "image/channels.h"
#include "image/display/tone_map.h"
#include "image/format.h"
#include "render/film/noise.h"
#include "session/environment.h"
#include "session/picture/joined_parts.h"
#include "session/picture/picture_file.h"
#include "view/live/view_tracer.h"
#include "view/pictures.h"

namespace fragtrace {

namespace {

/// Triangles of a scene that is previewed: with more, packing them twice takes longer than compiling.
constexpr size_t kMostPreviewed = 300'000;

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

/// The network makes little of fewer.
constexpr int kFewestForOidn = 4;
/// Below this many samples the variance of a pixel tells little of its error.
constexpr int kLeastForError = 32;
constexpr double kErrorStep = 1.2;  ///< samples grow by this factor between estimates of the error
constexpr double kCountMs = 200.0;  ///< time between looks at the film's counts

/// Returns true if they draw different samples, and would draw the same with the same camera.
bool differInCameraAlone(const RenderOptions& a, const RenderOptions& b) {
  const auto fixed = [](const RenderOptions& o) { return withoutEffects(o, {Effect::View}); };
  return !drawsTheSame(a, b) && drawsTheSame(fixed(a), fixed(b));
}

/// The bytes per pixel of films, and of pictures on their way to the window.
size_t bytesPerPixel(const SideMemory& memory) {
  constexpr size_t kFilm = 48;
  constexpr size_t kShown = kSlots * 16;
  // Bytes per pixel: guides; past, present and fresh pictures; their differences; the picture; the filter.
  constexpr size_t kFiltered = kFilm + 3 * 56 + 32 + 16 + 80;
  return kFilm + kShown + (memory.guides ? kFiltered : 0);
}

}  // namespace

RenderOptions ViewTracer::withFilter(RenderOptions options) {
  const bool wanted = options.output.denoise == Denoise::Oidn || options.output.denoise == Denoise::Auto;
  if (wanted && oidn_) options.output.denoise = Denoise::Oidn;
  if (!wanted || oidn_) return options;
  try {
    oidn_ = openDenoiser(options);
  } catch (const UsageError& error) {
    exchange_.set(&TraceStatus::error, error.what());
    options.output.denoise = Denoise::Variance;
  }
  return options;
}

void ViewTracer::setSide(Side& side, const RenderOptions& asked) {
  RenderOptions options = withFilter(asked);
  std::shared_ptr<SceneProgram> program = side.program;
  side.awaited.reset();
  if (!program || !drawsTheSame(side.options, options)) {
    if (!program && !session_.programs().has(options)) preview(side, options);
    program = programFor(options, side.program != nullptr);
    if (!program) {
      program = side.program;
      side.awaited = std::exchange(options, side.options);
      // The camera moves meanwhile, unless the program there is of another lens.
      if (programOptions(options).camera == programOptions(*side.awaited).camera)
        options.camera = side.awaited->camera;
      // The other processor has nothing to do.
      if (whyNotDenoised(*side.awaited).empty()) maker_->prepareFilter();
    }
  }
  // The last good one keeps drawing.
  if (!program->error.empty()) program = side.program;
  const bool same = side.program && side.program == program && drawsTheSame(side.options, options);
  const bool otherLook = side.options.output.treeLevel != options.output.treeLevel ||
                         side.options.output.denoise != options.output.denoise;
  if (differInCameraAlone(side.options, options)) {
    side.memory.turn();
    if (!side.awaited) session_.programs().addCones(program);
  } else if (!same) {
    side.memory.forget();
  }
  side.options = options;
  if (same && otherLook && !side.stale && side.samples > 0) publish(side);
  if (same) return;
  if (!side.awaited) side.previews = false;
  // If one side has samples, the other takes its resolution, since another one would lose these samples.
  const bool joins =
      !side.program && std::ranges::any_of(sides_, [](const Side& s) { return !s.stale && s.samples > 0; });
  if (side.program != program && !joins)
    drawSomethingElse(resolution_, request_.size, program->tracer.renderer->msPerSample());
  side.program = program;
  side.view = viewOf(options);
  side.stale = true;
}

/// Returns the view of the options' camera, or of the scene's first one if that does not exist, as when the
/// file has changed.
View ViewTracer::viewOf(const RenderOptions& options) {
  Camera camera = session_.loaded().camera;
  try {
    camera = chooseCamera(session_.loaded().scene.cameras, options.camera.index, options.camera.overrides,
                          session_.loaded().scene.bounds, framedAspect(loadedCamera_));
  } catch (const UsageError& error) {
    exchange_.set(&TraceStatus::error, error.what());
  }
  return makeView(options, session_.loaded(), camera);
}

/// Shows the stage that compiles soonest, so that the window is not empty while the side's program compiles.
void ViewTracer::preview(Side& side, const RenderOptions& wanted) {
  const bool quick = !has(wanted.stages, Stage::Shadows) && !has(wanted.stages, Stage::Gi);
  if (quick || session_.loaded().scene.triangles.size() > kMostPreviewed) return;
  RenderOptions o = wanted;
  o.stages = stagesUpTo(Stage::Phong);
  o.output.denoise = Denoise::None;
  o.output.debugView = DebugView::None;
  o.sampling.clampIndirect = 0.0;
  o.light.shadowCatcher = false;
  const std::shared_ptr<SceneProgram> program = programFor(o, false);
  if (!program->error.empty()) return;
  side.options = o;
  side.program = program;
  side.previews = true;
  side.view = viewOf(o);
  keepMoving(resolution_, request_.size);
  fitFilm(side);
  const auto goOn = [&](double) { return !exchange_.ending(); };
  if (!program->tracer.renderer->addSamples(*side.film, side.view, 0, 1, side.times, goOn)) return;
  side.samples = 1;
  publish(side);
}

/// Any thread may call this.
void ViewTracer::reportWork(const std::string& what) {
  const Shows shown = shows_;
  exchange_.set(&TraceStatus::note,
                what + (shown == Shows::Nothing   ? ""
                        : shown == Shows::Preview ? " (this is a preview in Blinn-Phong)"
                                                  : " (the last picture stays meanwhile)"));
}

std::shared_ptr<SceneProgram> ViewTracer::programFor(const RenderOptions& options, bool aside) {
  if (!session_.programs().has(options)) reportWork("compiling");
  std::shared_ptr<SceneProgram> program =
      aside ? session_.programs().soon(options) : session_.programs().of(options);
  if (!program) return program;
  for (const std::string& message : std::exchange(program->driverLog, {}))
    exchange_.deliver("driver: " + message);
  exchange_.set(&TraceStatus::note, {});
  exchange_.set(&TraceStatus::error, program->error.empty() ? loadError_ : program->error);
  // The driver's log would only repeat this error.
  if (!program->error.empty()) driverLog_->take();
  return program;
}

bool ViewTracer::awaitsProgram() const {
  return std::ranges::any_of(sides_, [](const Side& side) { return side.awaited.has_value(); });
}

void ViewTracer::takeCompiled() {
  if (!session_.hasPrograms() || !session_.programs().takeCompiled()) return;
  for (Side& side : sides_) {
    if (side.awaited) setSide(side, RenderOptions(*side.awaited));
  }
  noteAnswered();
}

void ViewTracer::noteAnswered() {
  if (awaitsProgram()) return;
  answered_ = request_.number;
  exchange_.set(&TraceStatus::note, {});
}

// One turn of the viewer's tracing thread: it chooses the side that is drawn next, the resolution and the
// samples.

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
  renderer.use(side.drawsCones() ? tracer.cones.front() : tracer.variant);
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
  const double filterMs = side.denoises() && !isStill() ? filterMsPerPixel_ * size.x * size.y : 0.0;
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
  const double pause = (side.denoises() ? kFilteredShare : kPublishShare) * publishMs_;
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
  if (still && whole && !awaitsProgram() && !session_.programs().compiling()) {
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
  // A film of the next finer step may hold its frame already: one more turn then goes to the step after.
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

// The tracing thread's results of a side: pictures for the window, and files.

void ViewTracer::estimate(Side& side) {
  if (side.samples < kLeastForError || side.samples < kErrorStep * side.errorAt) return;
  const FilmPixels pixels = side.film->read();
  const std::vector<double> errors = relativeErrors(pixels, independentVariance(pixels));
  side.error =
      distanceTo(side.options.sampling.noise, pixels, errors, side.options.light.shadowCatcher).error;
  side.errorAt = side.samples;
}

bool ViewTracer::denoisesByOidn(const Side& side) const {
  return side.denoises() && oidn_ && side.options.output.denoise == Denoise::Oidn && isStill() &&
         side.samples >= kFewestForOidn;
}

int ViewTracer::nextSlot(Side& side) {
  const auto number = size_t(&side - sides_.data());
  side.shownIn = -1;
  if (!shares_) return 0;
  const auto [slot, done] = exchange_.freeSlot(number, request_.moving);
  awaitFence(done);
  ShownTexture& shown = shown_[number][size_t(slot)];
  releaseFence(std::exchange(shown.ready, nullptr));
  return slot;
}

ShownTexture& ViewTracer::shownOf(const Side& side, int slot) {
  return shown_[size_t(&side - sides_.data())][size_t(slot)];
}

bool ViewTracer::show(Side& side, bool past, const std::function<bool()>& goOn) {
  const int slot = nextSlot(side);
  ShownTexture& into = shownOf(side, slot);
  if (showsColors(side.options)) {
    const Image picture = shownPicture(side.options, side.film->read(), {!side.options.light.background});
    const bool counts = side.options.output.debugView == DebugView::Visits;  // in a channel of their own
    maker_->show(counts ? onlyChannels(picture, {"R", "G", "B"}) : picture, into);
    side.shownIn = slot;
    return true;
  }
  const double start = steadyMilliseconds();
  Tracer& tracer = side.program->tracer;
  const bool filtered = side.denoises();
  const double pixels = double(side.film->size().x) * side.film->size().y;
  const bool byOidn = denoisesByOidn(side);
  const double expectedMs = filtered && !byOidn ? filterMsPerPixel_ * pixels : 0.0;
  const Showing showing{filtered, byOidn, side.samples, past, side.drawsCones(), expectedMs};
  bool complete = false;
  try {
    complete = maker_->show(*side.film, showing, side.options, tracer, side.view, side.memory, into, goOn);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError& error) {
    if (!filtered) throw;
    tracer.renderer->use(tracer.variant);  // the renderer may have drawn a layer
    exchange_.set(&TraceStatus::error, error.what());
    complete = maker_->show(*side.film, {}, side.options, tracer, side.view, side.memory, into, goOn);
  }
  if (complete) side.shownIn = slot;
  if (!filtered) return complete;
  waitForDevice(context_->software ? 0.0 : expectedMs);
  side.filterMs = steadyMilliseconds() - start;
  if (!byOidn) filterMsPerPixel_ = side.filterMs / pixels;
  return complete;
}

void ViewTracer::count(Side& side) {
  if (steadyMilliseconds() - side.counted < kCountMs && !resting(side)) return;
  side.counted = steadyMilliseconds();
  const glm::vec3 totals = maker_->count(*side.film);
  if (side.times.renderMs > 0.0) side.megaRaysPerSecond = double(totals.y) / side.times.renderMs / 1000.0;
  if (totals.z > 0.0f)
    exchange_.set(&TraceStatus::error, "the driver ended loops early in " +
                                           std::to_string(int64_t(totals.z)) +
                                           " pixels; the picture is wrong");
}

std::optional<TracedPicture> ViewTracer::pictureOf(Side& side) {
  const double start = steadyMilliseconds();
  if (!show(side, start_.keepsPast,
            [this] { return request_.moving ? !exchange_.ending() : !exchange_.interrupted(); }))
    return std::nullopt;
  estimate(side);
  count(side);
  side.shownAt = side.samples;
  const glm::ivec2 size = side.film->size();
  TracedPicture picture;
  picture.side = size_t(&side - sides_.data());
  picture.request = awaitsProgram() ? answered_ : request_.number;
  picture.size = size;
  ShownTexture& shown = shownOf(side, side.shownIn);
  if (shares_) {
    shown.ready = makeFence();
    picture.shared = {side.shownIn, shown.texture.name(), shown.ready};
  } else if (request_.values) {
    picture.image = imageOf(shown);
  }
  picture.asItIs = showsColors(side.options);
  picture.lines = linesOver(side);
  SideStatistics& s = picture.statistics;
  s.samples = side.samples;
  s.error = side.error;
  s.seconds = side.times.renderMs / 1000.0;
  const Summary frames = summarize(side.times.frameMs);
  s.frameMs = frames.median;
  s.frameP95Ms = frames.p95;
  s.megaRaysPerSecond = side.megaRaysPerSecond;
  if (side.times.renderMs > 0.0)
    s.megaPathsPerSecond = double(side.samples) * size.x * size.y / side.times.renderMs / 1000.0;
  if (side.denoises()) {
    s.filtered = filteredShare(side.samples);
    s.filterMs = side.filterMs;
  }
  s.resting = isStill() && !side.awaited && resting(side);
  s.variant = side.drawsCones() ? variantName(side.program->tracer.cones.front()) : side.program->variant;
  s.deviceBytes = side.program->bytes + size_t(size.x) * size_t(size.y) * bytesPerPixel(side.memory);
  s.copied = !shares_;
  s.passes = clock_.take();
  s.movedBytes = movedBytes() - std::exchange(side.movedBytes, movedBytes());
  shows_ = side.previews ? Shows::Preview : Shows::Picture;
  markMoment(side.previews ? "first preview" : "first picture");
  losses_ = 0;
  side.published = steadyMilliseconds();
  publishMs_ = side.published - start;
  return picture;
}

void ViewTracer::publish(Side& side) {
  if (std::optional<TracedPicture> picture = pictureOf(side)) exchange_.deliver(std::move(*picture));
}

/// Returns a side's picture as the window shows it, but without reused samples of earlier views.
Image ViewTracer::seenOf(Side& side) {
  const bool hasPast = side.samples < kNoPastFrom && side.memory.past.size.x > 0;
  const bool seen = side.denoises() && !hasPast && side.shownIn >= 0 &&
                    shownOf(side, side.shownIn).size == side.film->size();
  if (!seen) show(side, false, [] { return true; });
  const Image picture = imageOf(shownOf(side, side.shownIn));
  const bool opaque = side.options.light.background && !side.options.light.backgroundColor;
  return opaque ? onlyChannels(picture, {"R", "G", "B"}) : picture;
}

void ViewTracer::saveAll(const SaveRequest& request) {
  std::vector<ComposedSide> sides;
  for (Side& side : sides_) {
    if (!side.program) return exchange_.deliver("not written: one of the sides draws no picture");
    RenderOptions shown = side.options;
    shown.output.file = request.path;
    sides.push_back({seenOf(side), showsColors(shown), pageOf(shown)});
  }
  if (sides.size() == 1 && !reference_) return exchange_.deliver("not written: there is one side alone");
  if (sides.size() == 1) sides.push_back({reference_->image, reference_->wasEncoded});
  RenderOptions options = sides_[0].options;
  options.output.file = request.path;
  options.output.exposure = 0.0;
  options.output.toneMap = ToneMap::Linear;
  options.output.debugView = DebugView::None;
  writePicture(options, composite(sides, request_.size, request.composition), {});
  exchange_.deliver("wrote " + request.path.string());
}

void ViewTracer::save(const SaveRequest& request) {
  Side& side = sides_[std::min(request.side, sides_.size() - 1)];
  if (!side.program) return exchange_.deliver("not written: no picture is drawn");
  try {
    if (request.all) return saveAll(request);
    RenderOptions options = side.options;
    options.output.file = request.path;
    options.output.exposure = request.composition.exposure;
    options.output.toneMap = request.composition.toneMap;
    const FilmPixels pixels = side.film->read();
    const FilmTotals totals = totalsOf(pixels);
    const bool exr = formatOfName(options.output.file) == ImageFormat::OpenExr;
    const Layers layers{!options.light.background, options.output.aovSamples, options.output.aovVariance};
    // An .exr holds the unfiltered samples, other files the picture as shown.
    Image image = exr ? shownPicture(options, pixels, layers) : seenOf(side);
    session_.loaded().camera = side.view.camera;
    session_.loaded().size = pixels.size;
    if (exr && options.output.debugView == DebugView::None)
      setProvenance(
          image, {settingsText(options, session_.loaded(), side.program->tracer), options.sampling.seed,
                  options.sampling.sampleOffset, side.samples, totals.fewestSamples == totals.mostSamples});
    writePicture(options, image, treeLines(options, session_.loaded(), side.view.camera, pixels.size));
    exchange_.deliver("wrote " + request.path.string());
  } catch (const RenderError& error) {
    exchange_.set(&TraceStatus::error, error.what());
  }
}

void ViewTracer::takeReference(const std::filesystem::path& path) {
  reference_.reset();
  if (path.empty()) return;
  try {
    TracedPicture picture;
    picture.side = 1;
    picture.file = path;
    reference_ = readReference(path, start_.render.limits.memoryBytes);
    picture.image = reference_->image;
    picture.asItIs = reference_->wasEncoded;
    picture.size = {picture.image.width, picture.image.height};
    exchange_.deliver(std::move(picture));
  } catch (const std::exception& error) {
    exchange_.deliver(error.what());
  }
}

LinearImage readReference(const std::filesystem::path& path, uint64_t memoryLimit) {
  LinearImage read = readLinearImage(path, memoryLimit);
  const Image whole = wholeOf(std::move(read.image));
  const auto color = findColorChannels(whole);
  if (!color) throw InputError(path.string() + ": has no colour");
  std::vector<std::string> names;
  for (const size_t channel : *color) names.push_back(whole.channels[channel]);
  const bool alpha = findChannel(whole, "A").has_value();
  if (alpha) names.emplace_back("A");
  read.image = onlyChannels(whole, names);
  std::copy_n(std::array{"R", "G", "B"}.begin(), 3, read.image.channels.begin());
  for (size_t first = 0; alpha && read.wasEncoded && first < read.image.values.size(); first += 4) {
    float* pixel = &read.image.values[first];
    pixel[3] = float(encodeSrgb(double(pixel[3])));  // alpha is no light
    for (int c = 0; c < 3; ++c) pixel[c] *= pixel[3];
  }
  return read;
}

}  // namespace fragtrace
