// SPDX-License-Identifier: MIT
// The tracing thread's results of a side: pictures for the window, and files.
#include <algorithm>

#include "base/summary.h"
#include "base/timeline.h"
#include "gl/gl.h"
#include "image/channels.h"
#include "image/format.h"
#include "render/film/noise.h"
#include "session/picture/denoising.h"
#include "session/picture/picture_file.h"
#include "session/picture/provenance.h"
#include "view/live/reference.h"
#include "view/live/view_tracer.h"
#include "view/picture/composite.h"

namespace fragtrace {

namespace {

/// The network makes little of fewer.
constexpr int kFewestForOidn = 4;
/// Below this many samples the variance of a pixel tells little of its error.
constexpr int kLeastForError = 32;
constexpr double kErrorStep = 1.2;  ///< samples grow by this factor between estimates of the error
constexpr double kCountMs = 200.0;  ///< time between looks at the film's counts

/// The bytes per pixel of films, and of pictures on their way to the window.
size_t bytesPerPixel(const SideMemory& memory) {
  constexpr size_t kFilm = 48;
  constexpr size_t kShown = kSlots * 16;
  // Bytes per pixel: guides; past, present and fresh pictures; their differences; the picture; the filter.
  constexpr size_t kFiltered = kFilm + 3 * 56 + 32 + 16 + 80;
  return kFilm + kShown + (memory.guides ? kFiltered : 0);
}

/// R, G and B alone.
Image colorsOf(const Image& image) {
  Image colors{image.width, image.height, {"R", "G", "B"}, {}, {}};
  colors.values.reserve(size_t(image.width) * size_t(image.height) * 3);
  for (size_t i = 0; i < image.values.size(); i += image.channelCount())
    colors.values.insert(colors.values.end(), {image.values[i], image.values[i + 1], image.values[i + 2]});
  return colors;
}

}  // namespace

void ViewTracer::estimate(Side& side) {
  if (side.samples < kLeastForError || side.samples < kErrorStep * side.errorAt) return;
  const FilmPixels pixels = side.film->read();
  const std::vector<double> errors = relativeErrors(pixels, independentVariance(pixels));
  side.error =
      distanceTo(side.options.sampling.noise, pixels, errors, side.options.light.shadowCatcher).error;
  side.errorAt = side.samples;
}

bool ViewTracer::denoises(const Side& side) { return whyNotDenoised(side.options).empty(); }

bool ViewTracer::denoisesByOidn(const Side& side) const {
  return denoises(side) && oidn_ && side.options.output.denoise == Denoise::Oidn && isStill() &&
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
    maker_->show(side.options.output.debugView == DebugView::Visits ? colorsOf(picture) : picture, into);
    side.shownIn = slot;
    return true;
  }
  const double start = steadyMilliseconds();
  Tracer& tracer = side.program->tracer;
  const bool filtered = denoises(side);
  const double pixels = double(side.film->size().x) * side.film->size().y;
  const bool byOidn = denoisesByOidn(side);
  const double expectedMs = filtered && !byOidn ? filterMsPerPixel_ * pixels : 0.0;
  const Showing showing{filtered, byOidn, side.samples, past, drawsCones(side), expectedMs};
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
  if (denoises(side)) {
    s.filtered = filteredShare(side.samples);
    s.filterMs = side.filterMs;
  }
  s.resting = isStill() && !side.awaited && resting(side);
  s.variant = drawsCones(side) ? variantName(side.program->tracer.cones.front()) : side.program->variant;
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
  const bool seen = denoises(side) && !hasPast && side.shownIn >= 0 &&
                    shownOf(side, side.shownIn).size == side.film->size();
  if (!seen) show(side, false, [] { return true; });
  const Image picture = imageOf(shownOf(side, side.shownIn));
  const bool opaque = side.options.light.background && !side.options.light.backgroundColor;
  return opaque ? onlyChannels(picture, {"R", "G", "B"}) : picture;
}

void ViewTracer::saveBoth(const SaveRequest& request) {
  std::array<ComposedSide, 2> sides;
  for (size_t i = 0; i < 2; ++i) {
    if (i < sides_.size()) {
      if (!sides_[i].program) return exchange_.deliver("not written: one of the sides draws no picture");
      RenderOptions shown = sides_[i].options;
      shown.output.file = request.path;
      sides[i] = {seenOf(sides_[i]), showsColors(shown), pageOf(shown)};
    } else {
      if (!reference_) return exchange_.deliver("not written: there is one side alone");
      sides[i] = {*reference_, false};
    }
  }
  RenderOptions options = sides_[0].options;
  options.output.file = request.path;
  options.output.exposure = 0.0;
  options.output.toneMap = ToneMap::Linear;
  options.output.debugView = DebugView::None;
  writePicture(options,
               composite(sides, request_.size,
                         {request.bar, request.both == CompareMode::Difference, request.differenceStops,
                          request.exposure, request.toneMap}),
               {});
  exchange_.deliver("wrote " + request.path.string());
}

void ViewTracer::save(const SaveRequest& request) {
  Side& side = sides_[std::min(request.side, sides_.size() - 1)];
  if (!side.program) return exchange_.deliver("not written: no picture is drawn");
  try {
    if (request.both) return saveBoth(request);
    RenderOptions options = side.options;
    options.output.file = request.path;
    options.output.exposure = request.exposure;
    options.output.toneMap = request.toneMap;
    const FilmPixels pixels = side.film->read();
    const FilmTotals totals = totalsOf(pixels);
    const bool exr = formatOfName(options.output.file) == ImageFormat::OpenExr;
    const Layers layers{!options.light.background, options.output.aovSamples, options.output.aovVariance};
    // An .exr holds the unfiltered samples, other files the picture as shown.
    Image image = exr ? shownPicture(options, pixels, layers) : seenOf(side);
    loaded_->camera = side.view.camera;
    loaded_->size = pixels.size;
    if (exr && options.output.debugView == DebugView::None)
      setProvenance(
          image, {settingsText(options, *loaded_, side.program->tracer), options.sampling.seed,
                  options.sampling.sampleOffset, side.samples, totals.fewestSamples == totals.mostSamples});
    writePicture(options, image, treeLines(options, *loaded_, side.view.camera, pixels.size));
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
    picture.image = readReference(path, start_.render.limits.memoryBytes);
    picture.size = {picture.image.width, picture.image.height};
    reference_ = picture.image;
    exchange_.deliver(std::move(picture));
  } catch (const std::exception& error) {
    exchange_.deliver(error.what());
  }
}

}  // namespace fragtrace
