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
#include "options/output_options.h"
#include "options/parse_render.h"
#include "options/sequence_options.h"
#include "picture/checkpoints.h"
#include "picture/denoising.h"
#include "picture/draw_parts.h"
#include "picture/picture_file.h"
#include "picture/picture_header.h"
#include "picture/provenance.h"
#include "picture/sequence.h"
#include "render/adaptive.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/tracer.h"

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

/// Throws RenderError when the driver left out samples without a word.
void checkSamples(const RenderOptions& options, const Statistics& stats) {
  if (!stats.complete || stats.adaptive || stats.film.fewestSamples >= unsigned(options.spp)) return;
  throw RenderError("the driver drew " + std::to_string(stats.film.fewestSamples) + " of " +
                    std::to_string(options.spp) + " samples and reported no error; no picture is written");
}

/// What pictures share.
struct Device {
  std::unique_ptr<Context> context;
  std::optional<DebugLog> driverLog;  ///< of the context
  std::optional<OidnLibrary> oidn;
};

/// For so many camera paths in all.
void openContext(const RenderOptions& options, double paths, Device& device, Statistics& stats) {
  const bool quick = preferQuickCompilation(paths);
  PhaseTimer timer("context");
  device.context = makeContext(options.backend);
  device.driverLog.emplace();
  stats.phases.push_back(timer.end());
  stats.quickCompilation = quick && device.context->software;
}

void sayDriverLog(const RenderOptions& options, Device& device) {
  for (const std::string& message : device.driverLog->take()) say(options, "driver: " + message);
}

/// What becomes of a picture: it is written, written as far as it was drawn, or not at all.
enum class Outcome { Complete, Partial, None };

/// From the scene on the device to the files. `boxes` are drawn over it.
Outcome drawAndWrite(const PictureJob& asked, const std::vector<PictureLine>& boxes, Device& device,
                     Statistics& stats) {
  RenderOptions options = asked.options;
  const PictureJob job{options, asked.loaded, asked.tracer, asked.showsProgress};
  PhaseTimer firstDraw("first draw");
  DrawingPlan plan = planDrawing(job, stats);
  stats.phases.push_back(firstDraw.end());
  sayWhatIsChosen(options, *device.context, job.tracer, stats);

  // Step: draw.
  checkPictureWritable(options, job.loaded.region.size);
  countInterrupts();
  PhaseTimer drawTimer("draw");
  CheckpointKeeper keeper(options);
  Image picture = drawPicture(job, plan, stats, keeper);
  if (!isUniform(stats)) options.aovSamples = true;  // merge needs them
  stats.phases.push_back(drawTimer.end());
  stats.spp = options.spp;
  sayDriverLog(options, device);
  // Who goes on with a sequence later takes a picture that is there for a whole one.
  const int most = asked.showsProgress ? 1 : 0;
  if (interrupts() > most) return Outcome::None;
  sayWhatWentWrong(options, stats.film);
  sayWhatIsNotSeen(options, job.loaded, job.tracer.variant, stats);
  checkSamples(options, stats);

  // Step: write. What has been drawn is not lost from here on.
  try {
    addFeatures(picture, job, plan, stats);
    denoise(picture, options, device.oidn, stats);
    sayDriverLog(options, device);
    if (interrupts() > most) return Outcome::None;
    setProvenanceOf(picture, options, job.loaded, job.tracer, stats);
    picture.placement = viewOf(job.loaded, job.loaded.region).placement;
    setCamera(picture, job.loaded.camera, job.loaded.size);
    if (!showsColors(options)) setChromaticities(picture);
    PhaseTimer writing("write");
    writePicture(options, picture, boxes);
    stats.phases.push_back(writing.end());
  } catch (const std::exception& error) {
    throw RenderError(rescuePicture(options, picture, error.what()));
  }
  if (stats.complete) keeper.remove();
  if (!options.statsFile.empty()) replaceText(options.statsFile, statisticsText(stats));
  sayWhatWasDone(options, stats);
  return stats.complete ? Outcome::Complete : Outcome::Partial;
}

int runRender(const RenderOptions& asked) {
  checkOutputs(outputsOf(asked), inputsOf(asked));
  if (isFinished(asked)) return 0;
  RenderOptions options = asked;
  Device device;
  device.oidn = openDenoiser(options);
  Statistics stats;

  // Step: load. The image library opens meanwhile, in its own process, when the output needs it.
  if (options.output.extension() != ".pfm") startImageProcess();
  const RenderOptions drawn = withGuides(options);
  LoadedScene loaded = loadScene(drawn, stats, {}, FilmOf::Part);

  // Step: the shader variant, and the arrays that it reads.
  openContext(options, pathsOf(options, loaded.region.size), device, stats);
  const Tracer tracer = makeTracer(*device.context, loaded, drawn, stats);
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  releaseGeometry(loaded);

  const Outcome outcome = drawAndWrite({options, loaded, tracer}, boxes, device, stats);
  if (outcome == Outcome::None) {
    say(options, "interrupted, nothing is written");
    return kInterruptedStatus;
  }
  return leave(outcome == Outcome::Complete ? 0 : kInterruptedStatus);
}

/// What the pictures of a sequence share, and what the one before leaves to the next.
struct SequenceRun {
  Device device;
  Tracer tracer;
  std::optional<LoadedScene> loaded;  ///< as of the picture before
  Statistics prepared;                ///< of a turntable's scene
};

/// The scene as the picture shows it, on the device. A turntable loads it once; else the environment stays.
Statistics prepareFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  const RenderOptions& options = frame.options;
  const RenderOptions drawn = withGuides(options);
  const bool turntable = sequence.turntable > 0;
  const bool first = run.tracer.renderer == nullptr;
  if (!first && turntable) return run.prepared;
  Statistics stats;
  std::optional<Environment> map;
  if (run.loaded && run.loaded->environment.kind == Surroundings::Map)
    map = std::move(run.loaded->environment);
  run.loaded.reset();
  run.loaded = loadScene(drawn, stats, {}, FilmOf::Part, std::move(map));
  if (first) {
    if (!turntable && run.loaded->scene.animationNames.empty())
      throw UsageError("--frames: " + options.scene.string() + " has no animation");
    openContext(options, frameCount(sequence) * pathsOf(options, run.loaded->region.size), run.device, stats);
    run.tracer = makeTracer(*run.device.context, *run.loaded, drawn, stats);
    run.prepared = stats;
    run.prepared.phases.clear();
  } else {
    replaceScene(run.tracer, *run.device.context, *run.loaded, drawn, stats);
  }
  return stats;
}

Outcome drawFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  const RenderOptions& options = frame.options;
  checkOutputs(outputsOf(options), inputsOf(options));
  Statistics stats = prepareFrame(run, frame, sequence);
  LoadedScene& loaded = *run.loaded;
  const Camera camera = loaded.camera;
  if (sequence.turntable > 0) {
    const glm::dvec3 focalPoint = turningPoint(camera, options.camera, loaded.scene.bounds);
    loaded.camera = turnedCamera(camera, focalPoint, frame.turn);
    loaded.view = makeView(options, loaded.scene, loaded.camera);
  }
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  if (!options.treeLevel) releaseGeometry(loaded);
  const Outcome outcome = drawAndWrite({options, loaded, run.tracer, false}, boxes, run.device, stats);
  loaded.camera = camera;
  return outcome;
}

/// Whether there is a picture by that name: files are replaced as a whole, so that one with contents is
/// whole.
bool isWhole(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > 0;
}

/// Also with --quiet.
void complain(const std::string& text) { std::fprintf(stderr, "fragtrace: %s\n", text.c_str()); }

/// All pictures that are wanted; one that fails is said, and the others are drawn. Returns the status.
int runSequence(const RenderOptions& options) {
  const SequenceOptions& sequence = *options.sequence;
  SequenceRun run;
  RenderOptions settled = options;
  run.device.oidn = openDenoiser(settled);
  passOnWhatIsSaid([](const std::string&) {});  // what all of them say, once
  countInterrupts();
  if (options.output.extension() != ".pfm") startImageProcess();
  const RenderOptions firstOptions = frameOf(settled, 0).options;
  checkOutputs(outputsOf(firstOptions), inputsOf(firstOptions));  // a wrong folder would be wrong for all
  const int count = frameCount(sequence);
  int drawn = 0;
  int failed = 0;
  int skipped = 0;
  for (int i = 0; i < count && interrupts() == 0; ++i) {
    const SequenceFrame frame = frameOf(settled, i);
    if (sequence.keep && isWhole(frame.options.output)) {
      ++skipped;
      continue;
    }
    try {
      drawn += drawFrame(run, frame, sequence) == Outcome::Complete;
    } catch (const UsageError&) {
      throw;  // it would be the same for every picture
    } catch (const ContextLost&) {
      throw;
    } catch (const std::exception& reason) {
      complain("picture " + std::to_string(frame.number) + ": " + reason.what());
      ++failed;
    }
  }
  const std::string all = " of " + std::to_string(count) + " pictures ";
  const int missing = count - skipped - drawn - failed;
  if (skipped > 0) say(options, std::to_string(skipped) + all + "were there already");
  if (failed > 0) complain(std::to_string(failed) + all + "failed");
  if (missing > 0)
    say(options, "interrupted: " + std::to_string(missing) + all + "are missing; --continue draws them");
  return leave(missing > 0 ? kInterruptedStatus : failed > 0 ? 1 : 0);
}

}  // namespace

RunCommand addRender(CLI::App& app) {
  struct Raw {
    RawRender render;
    RawSequence sequence;
    std::string config;
  };
  const auto raw = std::make_shared<Raw>();
  app.add_option("file", raw->render.scene, "scene: a .gltf or .glb file")->required();
  app.add_option(
      "-o,--output", raw->render.output,
      "picture to write: .png .jpg (tone-mapped, sRGB), .exr .hdr .pfm (linear radiance); required");
  addRenderOptions(app, raw->render);
  addHalfOption(app, raw->render.options.encoding);
  addPngDepthOption(app, raw->render.options.encoding);
  addPartOptions(app, raw->render);
  addSequenceOptions(app, raw->sequence);
  addDenoiseOption(app, raw->render);
  addConfigOption(app, raw->config);
  return [raw, &app] {
    RenderOptions options = finishConfigured(raw->render, raw->config, app);
    if (options.output.empty()) throw UsageError("--output is required; --help says more");
    checkEncoding(options.encoding, options.output);
    finishSequence(raw->sequence, options);
    return options.sequence ? runSequence(options) : runRender(options);
  };
}

}  // namespace fragtrace
