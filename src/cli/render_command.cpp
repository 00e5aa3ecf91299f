// SPDX-License-Identifier: MIT
// The command line as a pipeline: scene, tree, context, packed scene, renderer, film, picture.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/leave.h"
#include "errors.h"
#include "gl/debug_log.h"
#include "gl/driver_choice.h"
#include "image/files/process.h"
#include "image/format.h"
#include "options/config_file.h"
#include "options/parse_render.h"
#include "picture/checkpoints.h"
#include "picture/denoising.h"
#include "picture/draw_parts.h"
#include "picture/picture_file.h"
#include "picture/provenance.h"
#include "render/adaptive.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/setup.h"

namespace fragtrace {

namespace {

constexpr int kInterruptedStatus = 130;

/// A view that nobody has chosen and that shows nothing is likely to be a mistake: of ours, or a surface's
/// back.
void sayWhatIsNotSeen(const RenderOptions& options, const LoadedScene& loaded, const ShaderVariant& variant,
                      const Statistics& stats) {
  const bool chosen = !loaded.scene.cameras.empty() || options.camera != CameraOverrides();
  const bool nothing = stats.scene.triangles == 0 && stats.scene.spheres == 0;
  const bool seen = stats.film.hitPixels > 0 || stats.film.samples == 0;
  if (chosen || options.region || nothing || seen || has(variant.stages, Stage::BvhHeatmap)) return;
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

/// Whether every pixel has the same samples: neither adaptive nor interrupted.
bool isUniform(const Statistics& stats) {
  return stats.complete && stats.film.fewestSamples == stats.film.mostSamples && !stats.adaptive;
}

/// An .exr says how it was made, as merge needs it.
void setProvenanceOf(Image& picture, const RenderOptions& options, const LoadedScene& loaded,
                     const Tracer& tracer, const Statistics& stats) {
  if (formatOfName(options.output) != ImageFormat::OpenExr || options.debugView != DebugView::None) return;
  Provenance made{settingsText(options, loaded, tracer), options.seed, options.sampleOffset,
                  std::llround(samplesPerPixel(stats)), isUniform(stats)};
  const int64_t most = stats.film.mostSamples;
  if (stats.adaptive)
    made.ranges = joinedRanges({{options.seed, 0, most}, {seedOfOtherHalf(options.seed), 0, most}});
  else if (!made.uniform)
    made.ranges = {{options.seed, options.sampleOffset, most}};
  setProvenance(picture, made);
  if (!stats.complete) picture.attributes[kInterruptedAttribute] = "1";
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
  const bool quick = preferQuickCompilation(pathsOf(options, loaded.region.size));
  PhaseTimer timer("context");
  auto context = makeContext(options.backend);
  stats.phases.push_back(timer.end());
  stats.quickCompilation = quick && context->software;
  return context;
}

int runRender(const RenderOptions& asked) {
  checkOutputs(outputsOf(asked), inputsOf(asked));
  if (isFinished(asked)) return 0;
  RenderOptions options = asked;
  const std::optional<OidnLibrary> oidn = openDenoiser(options);
  Statistics stats;

  // Step: load. The image library opens meanwhile, in its own process, when the output needs it.
  if (options.output.extension() != ".pfm") startImageProcess();
  const RenderOptions drawn = withGuides(options);
  LoadedScene loaded = loadScene(drawn, stats, {}, FilmOf::Part);

  // Step: the shader variant, and the arrays that it reads.
  const auto context = openContext(options, loaded, stats);
  DebugLog driverLog;
  const Tracer tracer = makeTracer(*context, loaded, drawn, stats);
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  releaseGeometry(loaded);
  const PictureJob job{options, loaded, tracer};
  PhaseTimer firstDraw("first draw");
  DrawingPlan plan = planDrawing(job, stats);
  stats.phases.push_back(firstDraw.end());
  sayWhatIsChosen(options, *context, tracer, stats);

  // Step: draw.
  checkPictureWritable(options, loaded.region.size);
  countInterrupts();
  PhaseTimer drawTimer("draw");
  CheckpointKeeper keeper(options);
  Image picture = drawPicture(job, plan, stats, keeper);
  if (!isUniform(stats)) options.aovSamples = true;  // merge needs them
  stats.phases.push_back(drawTimer.end());
  stats.spp = options.spp;
  const auto sayDriverLog = [&] {
    for (const std::string& message : driverLog.take()) say(options, "driver: " + message);
  };
  sayDriverLog();
  if (interrupts() > 1) return leaveUnwritten(options);
  sayWhatWentWrong(options, stats.film);
  sayWhatIsNotSeen(options, loaded, tracer.variant, stats);
  checkSamples(options, stats);

  // Step: write. What has been drawn is not lost from here on.
  try {
    addFeatures(picture, job, plan, stats);
    denoise(picture, options, oidn, stats);
    sayDriverLog();
    if (interrupts() > 1) return leaveUnwritten(options);
    setProvenanceOf(picture, options, loaded, tracer, stats);
    picture.placement = viewOf(loaded, loaded.region).placement;
    PhaseTimer writing("write");
    writePicture(options, picture, boxes);
    stats.phases.push_back(writing.end());
  } catch (const std::exception& error) {
    throw RenderError(rescuePicture(options, picture, error.what()));
  }
  if (stats.complete) keeper.remove();
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
  addPartOptions(app, raw->render);
  addDenoiseOption(app, raw->render);
  addConfigOption(app, raw->config);
  return [raw, &app] {
    const RenderOptions options = finishConfigured(raw->render, raw->config, app);
    if (options.output.empty()) throw UsageError("--output is required; --help says more");
    return runRender(options);
  };
}

}  // namespace fragtrace
