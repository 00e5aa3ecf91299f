// SPDX-License-Identifier: MIT
// The command line as a pipeline: scene, tree, context, packed scene, renderer, film, picture.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <span>

#include "cli/commands.h"
#include "cli/leave.h"
#include "errors.h"
#include "gl/debug_log.h"
#include "gl/driver_choice.h"
#include "image/files/process.h"
#include "image/format.h"
#include "options/config_file.h"
#include "options/parse_render.h"
#include "render/adaptive.h"
#include "session/denoising.h"
#include "session/draw_picture.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture_file.h"
#include "session/progress_bar.h"
#include "session/provenance.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

constexpr int kInterruptedStatus = 130;

/// `secondsAfter` is what the layers will take.
Drawing draw(Renderer& renderer, Film& film, const RenderOptions& options, const View& view,
             double secondsAfter, Statistics& stats) {
  const bool adaptive = options.noise > 0.0 || options.seconds > 0.0;
  ProgressBar bar("rendering", options.quiet);
  const Renderer::Progress progress = [&](double fraction) {
    bar.show(fraction, secondsAfter);
    return interrupts() == 0;
  };
  Drawing drawing;
  if (adaptive) {
    const AdaptiveGoal goal{options.noise, options.seconds, options.spp};
    AdaptivePicture picture = renderAdaptively(renderer, film.size(), view, goal, stats.times, progress);
    stats.complete = !picture.stopped;
    stats.adaptive = {options.noise,  options.seconds, picture.error, picture.share,
                      picture.rounds, picture.known,   picture.black};
    drawing = {std::move(picture.pixels), std::move(picture.variance), {}};
  } else {
    stats.complete = drawAllSamples(renderer, film, options, view, stats.times, progress, drawing);
  }
  bar.clear();
  return drawing;
}

void sayWhatWentWrong(const RenderOptions& options, const FilmTotals& film) {
  if (film.budgetHits > 0) {
    throw RenderError("the driver ended loops early in " + std::to_string(film.budgetHits) +
                      " pixels (budget_hits); the picture would be wrong, so none is written");
  }
  if (film.emptyPixels > 0) {
    say(options, "warning: stopped before the first sample of " + std::to_string(film.emptyPixels) +
                     " pixels; they are black");
  }
  if (film.nonfinitePixels > 0) {
    say(options, "warning: samples of " + std::to_string(film.nonfinitePixels) +
                     " pixels were not finite and count as black (nonfinite_pixels)");
  }
}

/// Seconds that a sample of each layer takes in all pixels, measured in the middle of the picture; all are
/// compiled, so that none fails when the picture is drawn. The film ends up cleared.
std::vector<double> measureFeatures(const Tracer& tracer, Film& film, const LoadedScene& loaded,
                                    Statistics& stats) {
  constexpr int kSide = 256;
  Work work{{}, glm::min(film.size(), glm::ivec2(kSide)), 0, 1};
  work.corner = (film.size() - work.size) / 2;
  const double parts = double(film.size().x) * film.size().y / (double(work.size.x) * work.size.y);
  std::vector<double> seconds;
  for (const ShaderVariant& variant : tracer.features) {
    stats.compileMs += tracer.renderer->compile(variant, film, loaded.view);
    RenderTimes times;
    tracer.renderer->addSamples(film, loaded.view, {&work, 1}, times);
    seconds.push_back(0.001 * times.renderMs * parts);
    film.clear();
  }
  return seconds;
}

/// What layers will take: those of an adaptive picture have the fewest samples of any pixel, which is not yet
/// known, but these at least.
double secondsOfFeatures(std::span<const double> secondsPerSample, const RenderOptions& options) {
  constexpr int kLeastAdaptive = 64;
  const bool adaptive = options.noise > 0.0 || options.seconds > 0.0;
  const int samples = adaptive ? std::min(options.spp, kLeastAdaptive) : options.spp;
  return samples * std::accumulate(secondsPerSample.begin(), secondsPerSample.end(), 0.0);
}

/// A view that nobody has chosen and that shows nothing is likely to be a mistake: of ours, or a surface's
/// back.
void sayWhatIsNotSeen(const RenderOptions& options, const LoadedScene& loaded, const ShaderVariant& variant,
                      const Statistics& stats) {
  const bool chosen = !loaded.scene.cameras.empty() || options.camera != CameraOverrides();
  const bool nothing = stats.scene.triangles == 0 && stats.scene.spheres == 0;
  const bool seen = stats.film.hitPixels > 0 || stats.film.samples == 0;
  if (chosen || nothing || seen || has(variant.stages, Stage::BvhHeatmap)) return;
  say(options,
      "warning: the default view shows nothing of the scene; --camera-position and --camera-focal-point "
      "choose another");
}

/// What --bounces cut is missing from the picture.
void sayWhatWasCut(const RenderOptions& options, const Statistics& stats) {
  constexpr double kNoticed = 0.01;
  if (cutShare(stats) <= kNoticed) return;
  char share[32];
  std::snprintf(share, sizeof share, "%.2g", cutShare(stats));
  say(options, "warning: --bounces " + std::to_string(options.bounces) +
                   " cut paths that could still carry " + share +
                   " of the light (cut_share); more make the picture brighter");
}

/// Adds the layers of first hits, drawn with the picture's samples: of an adaptive one those that all pixels
/// have, of an interrupted one a few, since somebody waits.
void addFeatures(Image& picture, const Tracer& tracer, const RenderOptions& options,
                 const LoadedScene& loaded, std::span<const double> secondsPerSample, Statistics& stats) {
  const int drawn = int(std::max(1u, stats.adaptive ? stats.film.fewestSamples : stats.film.mostSamples));
  const int all = stats.complete ? drawn : std::min(drawn, kFewLayerSamples);
  const int before = interrupts();
  for (const ShaderVariant& variant : tracer.features) {
    secondsPerSample = secondsPerSample.subspan(1);
    const int samples = samplesOfLayer(options, variant.feature, all);
    const double after = all * std::accumulate(secondsPerSample.begin(), secondsPerSample.end(), 0.0);
    ProgressBar bar("layer " + std::string(rowOf(variant.feature).name), options.quiet);
    const LayerDraw layer =
        addLayer(picture, *tracer.renderer, variant, loaded.view, samples, [&](double fraction) {
          bar.show(fraction, after);
          return interrupts() == before;
        });
    bar.clear();
    stats.complete = stats.complete && layer.complete;
    stats.compileMs += layer.compileMs;
    stats.featureMs += layer.drawMs;
    sayWhatWentWrong(options, layer.totals);
  }
}

/// An .exr says how it was made, as merge needs it.
void setProvenanceOf(Image& picture, const RenderOptions& options, const LoadedScene& loaded,
                     const Tracer& tracer, const Statistics& stats) {
  if (formatOfName(options.output) != ImageFormat::OpenExr || options.debugView != DebugView::None) return;
  const bool uniform =
      stats.complete && stats.film.fewestSamples == stats.film.mostSamples && !stats.adaptive;
  setProvenance(picture, {settingsText(options, loaded, tracer), options.seed, options.sampleOffset,
                          std::llround(samplesPerPixel(stats)), uniform});
}

void sayWhatWasDone(const RenderOptions& options, const Statistics& stats) {
  std::string noise;
  if (stats.adaptive) {
    char text[96];
    std::snprintf(text, sizeof text, ", 95 %% of the pixels within %.3g %% (estimated)",
                  100.0 * stats.adaptive->error);
    noise = stats.adaptive->known ? text : ", error unknown";
  }
  if (stats.denoise && !stats.denoise->filter.empty()) {
    char text[32];
    std::snprintf(text, sizeof text, " in %.2f s", stats.denoise->filterMs / 1000.0);
    noise += ", " + stats.denoise->filter + text;
  }
  sayWhatWasCut(options, stats);
  if (!stats.complete) say(options, "interrupted: what was finished is written");
  if (stats.adaptive && stats.adaptive->black) {
    say(options, "warning: the picture is black, so nothing is known of its noise");
  } else if (stats.complete && options.noise > 0.0 && stats.adaptive->share < 0.95) {
    say(options, "warning: --spp or --time ended the render before the noise asked for");
  }
  if (options.quiet) return;
  // Standard output is the statistics' alone.
  std::fprintf(isStandardOutput(options.statsFile) ? stderr : stdout,
               "%s: %d x %d, %.4g samples per pixel in %.2f s (%.2f million paths/s)%s\n",
               options.output.string().c_str(), stats.size.x, stats.size.y, samplesPerPixel(stats),
               stats.times.renderMs / 1000.0, megaPathsPerSecond(stats), noise.c_str());
}

void sayWhatIsChosen(const RenderOptions& options, const Context& context, const Tracer& tracer,
                     const Statistics& stats) {
  if (options.verbose) {
    say(options, "OpenGL " + context.version + " on " + context.renderer + " (" + context.backend + ")");
    say(options, "variant " + stats.variant);
    for (const std::string& line : stats.skipped) say(options, "skipped " + line);
  }
  if (options.schedule == Schedule::Wavefront && !stats.scheduleReason.empty())
    say(options, "warning: --schedule wavefront: the megakernel draws: " + stats.scheduleReason);
  if (tracer.variant.clampIndirect) say(options, "indirect light is clamped (--clamp-indirect): biased");
}

int leaveUnwritten(const RenderOptions& options) {
  say(options, "interrupted, nothing is written");
  return kInterruptedStatus;
}

/// Throws RenderError when the driver left out samples without a word.
void checkSamples(const RenderOptions& options, const Statistics& stats) {
  if (!stats.complete || stats.adaptive || stats.film.fewestSamples >= unsigned(options.spp)) return;
  throw RenderError("the driver drew " + std::to_string(stats.film.fewestSamples) + " of " +
                    std::to_string(options.spp) + " samples and reported no error; no picture is written");
}

std::unique_ptr<Context> openContext(const RenderOptions& options, const LoadedScene& loaded,
                                     Statistics& stats) {
  const bool quick = preferQuickCompilation(pathsOf(options, loaded.size));
  PhaseTimer timer("context");
  auto context = makeContext(options.backend);
  stats.phases.push_back(timer.end());
  stats.quickCompilation = quick && context->software;
  return context;
}

int runRender(const RenderOptions& asked) {
  checkOutputs(outputsOf(asked), inputsOf(asked));
  RenderOptions options = asked;
  const std::optional<OidnLibrary> oidn = openDenoiser(options);
  Statistics stats;

  // Step: load. The image library opens meanwhile, in its own process, when the output needs it.
  if (options.output.extension() != ".pfm") startImageProcess();
  const RenderOptions drawn = withGuides(options);
  LoadedScene loaded = loadScene(drawn, stats);

  // Step: the shader variant, and the arrays that it reads.
  const auto context = openContext(options, loaded, stats);
  DebugLog driverLog;
  const Tracer tracer = makeTracer(*context, loaded, drawn, stats);
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  releaseGeometry(loaded);
  Film film(loaded.size);
  const std::vector<double> layerSeconds = measureFeatures(tracer, film, loaded, stats);
  PhaseTimer firstDraw("first draw");
  stats.compileMs += tracer.renderer->compile(tracer.variant, film, loaded.view);
  stats.phases.push_back(firstDraw.end());
  sayWhatIsChosen(options, *context, tracer, stats);

  // Step: draw.
  checkPictureWritable(options, loaded.size);
  countInterrupts();
  PhaseTimer drawTimer("draw");
  const Drawing drawing =
      draw(*tracer.renderer, film, options, loaded.view, secondsOfFeatures(layerSeconds, options), stats);
  stats.phases.push_back(drawTimer.end());
  stats.spp = options.spp;
  stats.film = totalsOf(drawing.pixels);
  const auto sayDriverLog = [&] {
    for (const std::string& message : driverLog.take()) say(options, "driver: " + message);
  };
  sayDriverLog();
  if (interrupts() > 1) return leaveUnwritten(options);
  sayWhatWentWrong(options, stats.film);
  sayWhatIsNotSeen(options, loaded, tracer.variant, stats);
  checkSamples(options, stats);
  Image picture = pictureOf(drawing, options, tracer.variant);

  // Step: write. What has been drawn is not lost from here on.
  try {
    addFeatures(picture, tracer, options, loaded, layerSeconds, stats);
    denoise(picture, options, oidn, stats);
    sayDriverLog();
    if (interrupts() > 1) return leaveUnwritten(options);
    setProvenanceOf(picture, options, loaded, tracer, stats);
    PhaseTimer writing("write");
    writePicture(options, picture, boxes);
    stats.phases.push_back(writing.end());
  } catch (const std::exception& error) {
    throw RenderError(rescuePicture(options, picture, error.what()));
  }
  if (!options.statsFile.empty()) replaceText(options.statsFile, statisticsText(stats));
  sayWhatWasDone(options, stats);
  return leave(stats.complete ? 0 : kInterruptedStatus);
}

}  // namespace

RunCommand addRender(CLI::App& app) {
  struct Raw {
    RawRender render;
    std::string config;
  };
  const auto raw = std::make_shared<Raw>();
  app.add_option("file", raw->render.scene, "scene: a .gltf or .glb file")->required();
  app.add_option(
      "-o,--output", raw->render.output,
      "picture to write: .png .jpg (tone-mapped, sRGB), .exr .hdr .pfm (linear radiance); required");
  addRenderOptions(app, raw->render);
  addDenoiseOption(app, raw->render);
  addConfigOption(app, raw->config);
  return [raw, &app] {
    const RenderOptions options = finishConfigured(raw->render, raw->config, app);
    if (options.output.empty()) throw UsageError("--output is required; --help says more");
    return runRender(options);
  };
}

}  // namespace fragtrace
