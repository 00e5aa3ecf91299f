// SPDX-License-Identifier: MIT
#include "session/picture/draw_samples.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/errors.h"
#include "base/text.h"
#include "base/worker.h"
#include "gl/driver_choice.h"
#include "image/channels.h"
#include "options/option_text.h"
#include "render/adaptive.h"
#include "render/denoise.h"
#include "render/film/noise.h"
#include "session/environment.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/joined_parts.h"
#include "session/picture/picture_file.h"

namespace fragtrace {

bool looksOnTheWay(const RenderOptions& options) {
  constexpr int kFewest = 4;
  const RenderOptions drawn = withGuides(options);
  return drawn.output.aovVariance && hasGuides(drawn) && options.sampling.spp >= kFewest;
}

bool drawAllSamples(Renderer& renderer, SampledFilm& sampled, const RenderOptions& options, const View& view,
                    RenderTimes& times, const Renderer::Progress& progress, Drawing& drawing) {
  const bool looks = looksOnTheWay(options);
  std::vector<int> steps;
  if (looks) steps = {options.sampling.spp / 4, options.sampling.spp / 2};
  steps.push_back(options.sampling.spp);
  int from = sampled.fewest;
  for (size_t step = sampled.looks.size(); step < steps.size(); ++step) {
    const int to = steps[step];
    const auto partly = [&](double fraction) {
      return progress((from + fraction * (to - from)) / options.sampling.spp);
    };
    if (!renderer.addSamples(sampled.film, view, from, to, times, partly)) {
      drawing.pixels = sampled.film.read();
      return false;
    }
    from = to;
    if (to < options.sampling.spp) sampled.looks.push_back(sampled.film.read());
  }
  drawing.pixels = sampled.film.read();
  if (looks) drawing.observed = observedVariance(sampled.looks[0], sampled.looks[1], drawing.pixels);
  return true;
}

Image pictureOf(const Drawing& drawing, const RenderOptions& options, bool withSamples) {
  const RenderOptions drawn = withGuides(options);
  Image picture =
      shownPicture(options, drawing.pixels,
                   {keepsAlpha(options), drawn.output.aovSamples || withSamples, drawn.output.aovVariance},
                   drawing.variance);
  if (drawing.observed.empty()) return picture;
  const auto observed = [&](size_t i) { return drawing.observed[i]; };
  appendChannels(picture, imageOfNumbers(drawing.pixels.size, observed), {kObservedChannel});
  return picture;
}

int samplesOfLayer(const RenderOptions& options, Aov aov, int ofPicture) {
  if (aov == Aov::Object || aov == Aov::Material) return std::min(ofPicture, 1);
  if (aov == Aov::Guides) return std::min(ofPicture, kFewLayerSamples);
  const bool asked = std::ranges::find(options.output.aovs, aov) != options.output.aovs.end();
  return asked ? ofPicture : std::min(ofPicture, kFewLayerSamples);
}

double useOrCompile(Renderer& renderer, const ShaderVariant& variant, Film& film, const View& view) {
  if (!renderer.knows(variant)) return renderer.compile(variant, film, view);
  renderer.use(variant);
  return 0.0;
}

LayerDraw drawLayer(glm::ivec2 size, Renderer& renderer, const ShaderVariant& variant, const View& view,
                    int samples, const Renderer::Progress& progress) {
  LayerDraw layer;
  Film film(size);
  layer.compileMs = useOrCompile(renderer, variant, film, view);
  layer.complete = renderer.addSamples(film, view, 0, samples, layer.times, progress);
  if (variant.aov == Aov::Guides) {
    Film::Guides guides = film.readGuides();
    layer.totals = totalsOf(guides.counts);
    layer.image = std::move(guides.layers);
    return layer;
  }
  const FilmPixels pixels = film.read();
  layer.totals = totalsOf(pixels);
  if (variant.aov == Aov::None) {
    layer.image = imageOf(pixels, {});
    return layer;
  }
  const AovRow& row = rowOf(variant.aov);
  std::vector<std::string> names = {"R", "G", "B"};
  names.resize(row.channels.size());
  layer.image = onlyChannels(imageOf(pixels, {}), names);
  for (size_t c = 0; c < names.size(); ++c)
    layer.image.channels[c] = std::string(row.name) + "." + row.channels[c];
  return layer;
}

namespace {

/// Says that light is missing from the picture because --bounces ended paths.
void sayWhatWasCut(const RenderOptions& options, const Statistics& stats) {
  constexpr double kNoticed = 0.01;
  if (cutShare(stats) <= kNoticed) return;
  say(options, "warning: --bounces " + std::to_string(options.sampling.bounces) +
                   " cut paths that could still carry " + formatted("%.2g", cutShare(stats)) +
                   " of the light (cut_share); a larger value makes the picture brighter");
}

/// Returns true if every pixel has the same samples: the picture is neither adaptive nor interrupted.
bool isUniform(const Statistics& stats) {
  return stats.complete && stats.film.fewestSamples == stats.film.mostSamples && !stats.adaptive;
}

/// Writes into an .exr how it was made, as merge needs it.
void setProvenanceOf(Image& picture, const RenderOptions& options, const LoadedScene& loaded,
                     const Tracer& tracer, const Statistics& stats) {
  if (!holdsLayers(options) || options.output.debugView != DebugView::None) return;
  Provenance made{settingsText(options, loaded, tracer), options.sampling.seed, options.sampling.sampleOffset,
                  std::llround(samplesPerPixel(stats)), isUniform(stats)};
  const int64_t most = stats.film.mostSamples;
  if (stats.adaptive)
    made.ranges =
        joinedRanges({{options.sampling.seed, 0, most}, {seedOfOtherHalf(options.sampling.seed), 0, most}});
  else if (!made.uniform)
    made.ranges = {{options.sampling.seed, options.sampling.sampleOffset, most}};
  setProvenance(picture, made);
  if (const double exposure = exposureOf(options, loaded.light); exposure != 0.0)
    picture.attributes[kExposureAttribute] = exactText(exposure);
  if (!stats.complete) picture.attributes[kInterruptedAttribute] = "1";
}

void sayWhatIsChosen(const RenderOptions& options, const Context& context, const Tracer& tracer,
                     const Statistics& stats) {
  if (options.output.verbose) {
    say(options, "OpenGL " + context.version + " on " + context.renderer + " (" + context.backend + ")");
    say(options, "variant " + stats.variant);
    say(options, "dispatch " + std::string(kDispatchNames[size_t(tracer.variant.dispatch)]) + ": " +
                     whyDispatch(options.device.dispatch, context, tracer.variant) +
                     "; `fragtrace bench frame FILE --config 'fragment=--dispatch fragment' --config "
                     "'compute=--dispatch compute'` compares both");
    for (const std::string& line : stats.skipped) say(options, "skipped " + line);
    if (stats.sun)
      say(options, formatted("the sun stands %.1f degrees above the horizon, at %.1f degrees from north",
                             stats.sun->elevation, stats.sun->azimuth));
  }
  if (options.device.schedule == Schedule::Wavefront && !stats.scheduleReason.empty())
    say(options, "warning: --schedule wavefront: the megakernel draws: " + stats.scheduleReason);
  const std::string width(kVectorWidthNames[size_t(options.device.vectorWidth)]);
  if (options.device.vectorWidth != VectorWidth::Auto && width != std::to_string(stats.vectorWidth))
    say(options, "warning: --vector-width " + width + " changes nothing: " +
                     (stats.vectorWidth == 0
                          ? "the driver is not Mesa's software driver"
                          : "this process computes with " + std::to_string(stats.vectorWidth) + " bits"));
  if (tracer.variant.clampIndirect) say(options, "indirect light is clamped (--clamp-indirect): biased");
}

/// Throws RenderError if the driver silently left out samples.
void checkSamples(const RenderOptions& options, const Statistics& stats) {
  if (!stats.complete || stats.adaptive || stats.film.fewestSamples >= unsigned(options.sampling.spp)) return;
  throw RenderError("the driver drew " + std::to_string(stats.film.fewestSamples) + " of " +
                    std::to_string(options.sampling.spp) +
                    " samples and reported no error; no picture is written");
}

void sayDriverLog(const RenderOptions& options, Device& device) {
  std::vector<std::string> messages = device.driverLog->take();
  if (device.filter) std::ranges::copy(device.filter->takeMessages(), std::back_inserter(messages));
  for (const std::string& message : messages) say(options, "driver: " + message);
}

}  // namespace

std::optional<Image> drawSamples(const PictureJob& job, DrawingPlan& plan, Device& device,
                                 CheckpointKeeper& keeper, int most, Statistics& stats) {
  const RenderOptions& options = job.options;
  sayWhatIsChosen(options, *device.context, job.tracer, stats);
  PhaseTimer drawTimer("draw");
  Image picture = drawPicture(job, plan, stats, keeper);
  stats.phases.push_back(drawTimer.end());
  stats.spp = options.sampling.spp;
  stats.seed = options.sampling.seed;
  sayDriverLog(options, device);
  if (interrupts() > most) return std::nullopt;
  sayWhatWentWrong(options, stats.film);
  const std::string why = whyNothingIsSeen({options, job.loaded, picture, stats});
  if (!why.empty() && !(job.sequence && std::exchange(job.sequence->saidWhyUnseen, true)))
    say(options, "warning: " + pictureIn(job.sequence) + why +
                     (job.sequence ? " (nothing is said of later ones)" : ""));
  checkSamples(options, stats);
  return picture;
}

bool finishPicture(Image& picture, const PictureJob& job, const DrawingPlan& plan, Device& device, int most,
                   Statistics& stats) {
  RenderOptions options = job.options;
  if (!isUniform(stats)) options.output.aovSamples = true;  // merge needs them
  addAovs(picture, {options, job.loaded, job.tracer, job.showsProgress, job.told, job.sequence}, plan, stats);
  stats.programs = job.tracer.renderer->programs().count();
  stats.shaderCharacters = job.tracer.renderer->programs().characters();
  const ShaderVariant& variant = job.tracer.variant;
  if (findChannel(picture, "A") &&
      (has(variant.traits, Trait::Alpha) || variant.shadowCatcher || variant.transparentGlass))
    picture.attributes[kNoisyAlphaAttribute] = "1";
  denoise(picture, options, device, stats, job.sequence);
  sayDriverLog(options, device);
  if (interrupts() > most) return false;
  setProvenanceOf(picture, options, job.loaded, job.tracer, stats);
  picture.placement = viewOf(job.loaded, job.loaded.region).placement;
  setCamera(picture, job.loaded.camera, job.loaded.size);
  if (!showsColors(options)) setChromaticities(picture);
  return true;
}

void sayHowItEnded(const RenderOptions& options, const Statistics& stats) {
  sayWhatWasCut(options, stats);
  if (stats.adaptive && stats.adaptive->black) {
    say(options, "warning: the picture is black, so nothing is known of its noise");
  } else if (stats.complete && options.sampling.noise > 0.0 && stats.adaptive->share < 0.95) {
    const bool own = options.sampling.quality == Quality::None;
    say(options, own ? "warning: --spp or --time ended the render before the noise asked for"
                     : "some pixels are noisier than --quality " +
                           std::string(kQualityNames[size_t(options.sampling.quality)]) + " asks for after " +
                           countText(size_t(options.sampling.spp), "sample"));
  }
  if (const std::string why = whyUnconfined(); options.output.verbose && !why.empty())
    say(options, "the processes that decode files have all system calls: " + why);
}

}  // namespace fragtrace
