// SPDX-License-Identifier: MIT
#include "session/picture/finished_picture.h"

#include <algorithm>

#include "base/errors.h"
#include "base/text.h"
#include "base/worker.h"
#include "gl/driver_choice.h"
#include "image/channels.h"
#include "render/adaptive.h"
#include "scene/describe.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/picture_file.h"
#include "session/picture/picture_header.h"
#include "session/picture/provenance.h"

namespace fragtrace {

namespace {

/// A view that shows nothing is likely to be a mistake: the user's, ours, or the back of a surface.
void sayWhatIsNotSeen(const RenderOptions& options, const LoadedScene& loaded, const ShaderVariant& variant,
                      const Statistics& stats) {
  const bool chosen = loaded.overrides == options.camera.overrides;
  const bool nothing =
      (stats.scene.triangles == 0 && stats.scene.spheres == 0) || hasNoArea(loaded.scene);  // which is said
  const bool seen = stats.film.hitPixels > 0 || stats.film.samples == 0;
  if (options.camera.region || nothing || seen || variant.countsVisits) return;
  say(options,
      std::string("warning: ") + (chosen ? "this" : "the default") + " view shows nothing of the scene; " +
          (chosen && !loaded.overrides.fit ? "--fit moves the camera until it does"
                                           : "--camera-position and --camera-focal-point choose another"));
}

/// The share of pixels that are exactly black, 0..1.
double blackShare(const Image& picture) {
  const auto colors = findColorChannels(picture);
  if (!colors || picture.values.empty()) return 0.0;
  size_t black = 0;
  for (size_t i = 0; i < picture.values.size(); i += picture.channelCount())
    black +=
        std::ranges::all_of(*colors, [&](size_t channel) { return picture.values[i + channel] == 0.0f; });
  return double(black) * double(picture.channelCount()) / double(picture.values.size());
}

/// Says that a picture is nearly black although surfaces fill it, and why: most likely the camera stands in a
/// shell.
void sayWhatIsDark(const RenderOptions& options, const LoadedScene& loaded, const Image& picture,
                   const Statistics& stats) {
  constexpr double kNearlyAll = 0.95;
  constexpr double kEnoughSamples = 16.0;  // with this many samples, chance explains no black pixel
  const double pixels = double(stats.size.x) * stats.size.y;
  const bool isLit = has(options.stages, Stage::Gi) && options.output.debugView == DebugView::None;
  const bool filled = double(stats.film.hitPixels) >= kNearlyAll * pixels;
  if (!isLit || !filled || samplesPerPixel(stats) < kEnoughSamples) return;
  const double share = blackShare(picture);
  if (share < kNearlyAll) return;
  const BoundsDouble& bounds = loaded.scene.bounds;
  const glm::dvec3& place = loaded.camera.position;
  const bool inside = glm::all(glm::lessThanEqual(bounds.minimum, place)) &&
                      glm::all(glm::lessThanEqual(place, bounds.maximum));
  say(options,
      "warning: " + std::to_string(int(100.0 * share)) +
          " % of the pixels are black: nearly all camera paths end in the dark; " +
          (inside ? "the camera stands inside the scene, perhaps in a closed shell; --fit moves it out"
                  : "no light reaches what it sees (--studio, --sky, --hdri-file)"));
}

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
  if (!stats.complete) picture.attributes[kInterruptedAttribute] = "1";
}

void sayWhatIsChosen(const RenderOptions& options, const Context& context, const Tracer& tracer,
                     const Statistics& stats) {
  if (options.output.verbose) {
    say(options, "OpenGL " + context.version + " on " + context.renderer + " (" + context.backend + ")");
    say(options, "variant " + stats.variant);
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
  for (const std::string& message : device.driverLog->take()) say(options, "driver: " + message);
}

}  // namespace

void openContext(const RenderOptions& options, double paths, Device& device, Statistics& stats) {
  const bool quick = preferQuickCompilation(paths);
  PhaseTimer timer("context");
  device.context = makeContext(options.device.backend, options.device.vectorWidth);
  device.driverLog.emplace();
  stats.phases.push_back(timer.end());
  stats.quickCompilation = quick && device.context->software;
}

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
  sayWhatIsNotSeen(options, job.loaded, job.tracer.variant, stats);
  sayWhatIsDark(options, job.loaded, picture, stats);
  checkSamples(options, stats);
  return picture;
}

bool finishPicture(Image& picture, const PictureJob& job, const DrawingPlan& plan, Device& device, int most,
                   Statistics& stats) {
  RenderOptions options = job.options;
  if (!isUniform(stats)) options.output.aovSamples = true;  // merge needs them
  addAovs(picture, {options, job.loaded, job.tracer, job.showsProgress, job.told}, plan, stats);
  stats.programs = job.tracer.renderer->programs().count();
  stats.shaderCharacters = job.tracer.renderer->programs().characters();
  denoise(picture, options, device.oidn, stats);
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
