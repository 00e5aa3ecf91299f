// SPDX-License-Identifier: MIT
// What the viewer's tracing thread gives out of a side: pictures for the window, and files.
#include <algorithm>

#include "film/noise.h"
#include "image/channels.h"
#include "image/format.h"
#include "live/reference.h"
#include "live/view_tracer.h"
#include "math/summary.h"
#include "picture/denoising.h"
#include "picture/picture_file.h"
#include "picture/provenance.h"
#include "view/picture/composite.h"

namespace fragtrace {

namespace {

using Clock = std::chrono::steady_clock;

/// The network makes little of fewer.
constexpr int kFewestForOidn = 4;
/// Below this many samples the variance of a pixel tells little of its error.
constexpr int kLeastForError = 32;
constexpr double kErrorStep = 1.2;  ///< from one estimate of the error to the next, in samples

double sinceMs(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
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

void ViewTracer::estimate(Side& side, const FilmPixels& pixels) {
  if (side.samples < kLeastForError || side.samples < kErrorStep * side.errorAt) return;
  const std::vector<double> errors = relativeErrors(pixels, independentVariance(pixels));
  side.error = distanceTo(side.options.sampling.noise, pixels, errors).error;
  side.errorAt = side.samples;
}

bool ViewTracer::denoises(const Side& side) { return whyNotDenoised(side.options).empty(); }

bool ViewTracer::denoisesByOidn(const Side& side) const {
  const bool still = !request_.moving && resolution_.step == 0;
  return denoises(side) && oidn_ && side.options.output.denoise == Denoise::Oidn && still &&
         side.samples >= kFewestForOidn;
}

std::optional<Image> ViewTracer::shownOf(Side& side, const FilmPixels& pixels,
                                         const std::function<bool()>& goOn) {
  const bool alpha = !side.options.light.background;
  if (!denoises(side)) return shownPicture(side.options, pixels, {alpha});
  const auto start = Clock::now();
  const Image drawn = shownPicture(side.options, pixels, {true, true, true});
  std::optional<Image> shown;
  try {
    shown = denoiser_->shown(drawn, side.samples, side.options, denoisesByOidn(side), side.program->tracer,
                             side.view, side.memory, goOn);
  } catch (const ContextLost&) {
    throw;
  } catch (const RenderError& error) {
    side.program->tracer.renderer->use(side.program->tracer.variant);  // it may have been at a layer
    exchange_.tellError(error.what());
    shown = onlyChannels(drawn, {"R", "G", "B", "A"});
  }
  if (!denoisesByOidn(side)) filterMsPerPixel_ = sinceMs(start) / double(pixels.pixels.size());
  side.filterMs = sinceMs(start);
  if (shown && !alpha) *shown = withoutAlpha(*shown);
  if (shown) side.shown = *shown;
  return shown;
}

void ViewTracer::publish(Side& side) {
  const auto start = Clock::now();
  const FilmPixels pixels = side.film->read();
  estimate(side, pixels);
  const FilmTotals totals = totalsOf(pixels);
  TracedPicture picture;
  picture.side = size_t(&side - sides_.data());
  picture.request = request_.number;
  std::optional<Image> shown = shownOf(
      side, pixels, [this] { return request_.moving ? !exchange_.ending() : !exchange_.interrupted(); });
  if (!shown) return;
  side.shownAt = side.samples;
  picture.image = std::move(*shown);
  if (side.options.output.debugView == DebugView::Visits) picture.image = colorsOf(picture.image);
  picture.asItIs = showsColors(side.options);
  picture.lines = linesOver(side);
  SideStatistics& s = picture.statistics;
  s.samples = side.samples;
  s.error = side.error;
  s.seconds = side.times.renderMs / 1000.0;
  const Summary frames = summarize(side.times.frameMs);
  s.frameMs = frames.median;
  s.frameP95Ms = frames.p95;
  if (side.times.renderMs > 0.0) {
    s.megaRaysPerSecond = double(totals.rays) / side.times.renderMs / 1000.0;
    s.megaPathsPerSecond = double(totals.samples) / side.times.renderMs / 1000.0;
  }
  if (denoises(side)) {
    s.filtered = filteredShare(side.samples);
    s.filterMs = side.filterMs;
  }
  s.resting = !request_.moving && resolution_.step == 0 && resting(side);
  s.variant = side.program->variant;
  s.deviceBytes = side.program->bytes + pixels.pixels.size() * 48;
  exchange_.deliver(std::move(picture));
  losses_ = 0;
  if (totals.budgetHits > 0)
    exchange_.tellError("the driver ended loops early in " + std::to_string(totals.budgetHits) +
                        " pixels; the picture is wrong");
  published_ = Clock::now();
  publishMs_ = sinceMs(start);
}

/// As the window shows it.
Image ViewTracer::seenOf(Side& side) {
  const FilmPixels pixels = side.film->read();
  const bool seen = denoises(side) && side.shown.width == pixels.size.x && side.shown.height == pixels.size.y;
  return seen ? side.shown : *shownOf(side, pixels, [] { return true; });
}

void ViewTracer::saveBoth(const SaveRequest& request) {
  std::array<ComposedSide, 2> sides;
  for (size_t i = 0; i < 2; ++i) {
    if (i < sides_.size()) {
      if (!sides_[i].program) return exchange_.tell("not written: one of the sides draws no picture");
      sides[i] = {seenOf(sides_[i]), showsColors(sides_[i].options)};
    } else {
      if (!reference_) return exchange_.tell("not written: there is one side alone");
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
  exchange_.tell("wrote " + request.path.string());
}

void ViewTracer::save(const SaveRequest& request) {
  Side& side = sides_[std::min(request.side, sides_.size() - 1)];
  if (!side.program) return exchange_.tell("not written: no picture is drawn");
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
    // A file of radiance is what its samples say, one for a display what is seen.
    Image image = exr ? shownPicture(options, pixels, layers) : seenOf(side);
    loaded_->camera = side.view.camera;
    loaded_->size = pixels.size;
    if (exr && options.output.debugView == DebugView::None)
      setProvenance(
          image, {settingsText(options, *loaded_, side.program->tracer), options.sampling.seed,
                  options.sampling.sampleOffset, side.samples, totals.fewestSamples == totals.mostSamples});
    writePicture(options, image, treeLines(options, *loaded_, side.view.camera, pixels.size));
    exchange_.tell("wrote " + request.path.string());
  } catch (const RenderError& error) {
    exchange_.tellError(error.what());
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
    reference_ = picture.image;
    exchange_.deliver(std::move(picture));
  } catch (const std::exception& error) {
    exchange_.tell(error.what());
  }
}

}  // namespace fragtrace
