// SPDX-License-Identifier: MIT
// The command line as a pipeline: scene, tree, context, packed scene, renderer, film, picture.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/count_text.h"
#include "base/errors.h"
#include "base/report.h"
#include "cli/commands.h"
#include "cli/leave.h"
#include "gltf/gltf.h"
#include "image/files/process.h"
#include "options/camera_text.h"
#include "options/config_file.h"
#include "options/parse_render.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/finished_picture.h"
#include "session/picture/picture_file.h"
#include "session/picture/sequence.h"
#include "session/sequence_camera.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

void sayWhatWasDone(const RenderOptions& options, const Statistics& stats) {
  std::string noise;
  if (stats.adaptive) {
    char text[96];
    std::snprintf(text, sizeof text, ", 95 %% of the pixels within %.3g %% (estimated)",
                  100.0 * stats.adaptive->error);
    const bool tells = stats.adaptive->known && stats.adaptive->error <= 1.0;
    noise = tells ? text : stats.adaptive->known ? ", noise above 100 % (estimated)" : ", error unknown";
  }
  if (stats.denoise && !stats.denoise->filter.empty()) {
    char text[32];
    std::snprintf(text, sizeof text, " in %.2f s", stats.denoise->filterMs / 1000.0);
    noise += ", " + stats.denoise->filter + text;
  }
  sayHowItEnded(options, stats);
  if (!stats.complete) say(options, "interrupted: what was finished is written");
  reportEvent("picture", {{"width", stats.size.x},
                          {"height", stats.size.y},
                          {"samples", samplesPerPixel(stats)},
                          {"complete", stats.complete}});
  // Standard output is the statistics' or the picture's alone.
  const bool taken = isStandardOutput(options.output.statsFile) || options.output.toStandardOutput;
  if (options.output.quiet || (taken ? reportsAsJson() : standardOutputIsClosed())) return;
  char samples[32];
  std::snprintf(samples, sizeof samples, "%.4g", samplesPerPixel(stats));
  std::fprintf(taken ? stderr : stdout, "%s: %d x %d, %s per pixel in %.2f s (%.2f million paths/s)%s\n",
               options.output.toStandardOutput ? "standard output" : options.output.file.string().c_str(),
               stats.size.x, stats.size.y, countText(samples, "sample").c_str(),
               stats.times.renderMs / 1000.0, megaPathsPerSecond(stats), noise.c_str());
}

/// A picture is written, written as far as it was drawn, or not written.
enum class Outcome { Complete, Partial, None };

/// From the scene on the device to the files. `boxes` are drawn over it.
Outcome drawAndWrite(const PictureJob& job, const std::vector<PictureLine>& boxes, Device& device,
                     Statistics& stats) {
  const RenderOptions& options = job.options;
  // Who goes on with a sequence later takes a picture that is there for a whole one.
  const int most = job.showsProgress ? 1 : 0;
  PhaseTimer firstDraw("first draw");
  DrawingPlan plan = planDrawing(job, stats);
  stats.phases.push_back(firstDraw.end());

  // Step: draw.
  checkPictureWritable(options, job.loaded.region.size);
  countInterrupts();
  CheckpointKeeper keeper(options);
  std::optional<Image> drawn = drawSamples(job, plan, device, keeper, most, stats);
  if (!drawn) return Outcome::None;

  // Step: write. What has been drawn is not lost from here on.
  try {
    if (!finishPicture(*drawn, job, plan, device, most, stats)) return Outcome::None;
    PhaseTimer writing("write");
    writePicture(options, *drawn, boxes);
    stats.phases.push_back(writing.end());
  } catch (const std::exception& error) {
    throw RenderError(rescuePicture(options, *drawn, error.what()));
  }
  if (stats.complete) keeper.remove();
  if (!options.output.statsFile.empty()) replaceText(options.output.statsFile, statisticsText(stats));
  sayWhatWasDone(options, stats);
  return stats.complete ? Outcome::Complete : Outcome::Partial;
}

/// The context of a picture's events: its file, and its place in a sequence.
nlohmann::ordered_json eventContext(const RenderOptions& options) {
  return {{"output", options.output.toStandardOutput ? "-" : options.output.file.string()}};
}

/// Returns the status.
int renderOne(const RenderOptions& asked) {
  setReportContext(eventContext(asked));
  checkOutputs(outputsOf(asked), inputsOf(asked));
  if (isFinished(asked)) return 0;
  RenderOptions options = asked;
  Device device;
  device.oidn = openDenoiser(options);
  Statistics stats;

  // Step: load. The image library opens meanwhile, in its own process, when the output needs it.
  if (options.output.file.extension() != ".pfm") startImageProcess();
  const RenderOptions drawn = withGuides(options);
  LoadedScene loaded = loadScene(drawn, stats, {}, FilmOf::Part);
  if (options.output.verbose && loaded.overrides.fit) {
    RenderOptions placed = options;
    placed.camera.overrides = asPlaced(loaded.camera, loaded.scene.bounds);
    say(options, "--fit: the camera stands at " + cameraText(placed));
  }

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
  return outcome == Outcome::Complete ? 0 : kInterruptedStatus;
}

/// A picture of each of the scene's variants, with its name in the place of #, or with its index, where that
/// is no name of a file, or of several. Returns the status.
int renderVariants(const RenderOptions& options) {
  RenderOptions own = options;
  own.selection.materialVariant.clear();
  const std::vector<std::string> names = loadGltf(own.scene, gltfOptionsOf(own)).materialVariants;
  if (names.empty()) throw UsageError("--material-variant: " + own.scene.string() + " has no variants");
  int status = 0;
  for (size_t i = 0; i < names.size() && status == 0; ++i) {
    own.selection.materialVariant = std::to_string(i);
    const std::string name = std::ranges::count(names, names[i]) == 1 ? names[i] : std::to_string(i);
    own.output.file = namedFile(options.output.file, name, int(i));
    if (!options.output.statsFile.empty())
      own.output.statsFile = namedFile(options.output.statsFile, name, int(i));
    status = renderOne(own);
  }
  return status;
}

/// State that the pictures of a sequence share, or that one leaves to the next.
struct SequenceRun {
  Device device;
  Tracer tracer;
  std::optional<LoadedScene> loaded;       ///< the scene of the picture before
  std::optional<RefittableTree> tree;      ///< the latest tree, where the next picture may refit it
  std::shared_ptr<KeptDocument> document;  ///< the document that is posed for each picture
  Statistics prepared;                     ///< time spent on a turntable's scene
};

/// Returns true if the next picture may refit this one's tree. `merge` tells scenes apart by their arrays,
/// and a small tree is built as fast: in both cases each picture has the bits of a single command, whatever
/// was drawn before.
bool keepsTree(const RenderOptions& options, const Scene& scene) {
  constexpr size_t kLeastTriangles = 4096;
  return !holdsLayers(options) && !keepsCheckpoint(options) && options.output.debugView == DebugView::None &&
         scene.triangles.size() >= kLeastTriangles;
}

/// Pictures after the end of an animation are all the same.
void warnBeyondEnd(const RenderOptions& options, const SequenceOptions& sequence, const Scene& scene) {
  const std::optional<double> length = animationLength(scene, options.selection);
  const int last = rangeOf(sequence).last;
  if (!length || last <= std::ceil(*length * sequence.fps)) return;
  char text[128];
  std::snprintf(
      text, sizeof text,
      "warning: --frames: the animation ends after %.4g s, at picture %d; those after it show its end",
      *length, int(std::ceil(*length * sequence.fps)));
  say(options, text);
}

/// The scene as the picture shows it, on the device. A turntable loads it once; else the environment stays.
Statistics prepareFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  const RenderOptions& options = frame.options;
  const RenderOptions drawn = withGuides(options);
  const bool turntable = sequence.turntable > 0;
  const bool first = run.tracer.renderer == nullptr;
  if (!first && turntable) return run.prepared;
  Statistics stats;
  SceneBefore before;
  Environment environment;
  if (run.loaded && run.loaded->environment.kind == Surroundings::Map) {
    environment = std::move(run.loaded->environment);
    before.environment = &environment;
  }
  if (run.tree) before.tree = &*run.tree;
  const Volume volume = run.loaded ? run.loaded->scene.volume : Volume();
  before.volume = &volume;
  if (!turntable) before.document = &run.document;
  run.loaded.reset();
  run.loaded = loadScene(drawn, stats, {}, FilmOf::Part, before);
  if (!stats.treeRefitted) {
    run.tree.reset();
    if (!turntable && keepsTree(options, run.loaded->scene))
      run.tree = refittable(run.loaded->bvh, run.loaded->scene);
  }
  if (first) {
    if (!turntable) warnBeyondEnd(options, sequence, run.loaded->scene);
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
  nlohmann::ordered_json context = eventContext(options);
  context.update({{"frame", frame.number},
                  {"first_frame", rangeOf(sequence).first},
                  {"last_frame", rangeOf(sequence).last}});
  setReportContext(context);
  Statistics stats = prepareFrame(run, frame, sequence);
  LoadedScene& loaded = *run.loaded;
  const Camera camera = loaded.camera;
  if (sequence.turntable > 0) {
    const glm::dvec3 focalPoint = turningPoint(camera, loaded.overrides, loaded.scene.bounds);
    loaded.camera = turnedCamera(camera, focalPoint, frame.turn);
    loaded.view = makeView(options, loaded, loaded.camera);
  }
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  if (!options.output.treeLevel) releaseGeometry(loaded);
  const Outcome outcome = drawAndWrite({options, loaded, run.tracer, false}, boxes, run.device, stats);
  loaded.camera = camera;
  return outcome;
}

/// Returns true if there is a complete picture by that name. Files are replaced as a whole, so one with
/// contents is complete.
bool isWhole(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > 0;
}

/// All pictures that are wanted; one that fails is said, and the others are drawn. Returns the status.
int runSequence(const RenderOptions& options) {
  const SequenceOptions& sequence = options.output.sequence;
  SequenceRun run;
  RenderOptions settled = options;
  if (sequence.frames) {
    settled.camera.overrides = overridesOfAllPoses(options, run.document);
    if (settled.camera.overrides != options.camera.overrides)
      say(options, "one camera shows the whole animation: " + cameraText(settled));
  }
  run.device.oidn = openDenoiser(settled);
  passOnWhatIsSaid([](const std::string&) {});  // they would all say the same
  countInterrupts();
  if (options.output.file.extension() != ".pfm") startImageProcess();
  const RenderOptions firstOptions = frameOf(settled, 0).options;
  checkOutputs(outputsOf(firstOptions), inputsOf(firstOptions));  // a wrong folder would be wrong for all
  const int count = frameCount(sequence);
  int drawn = 0;
  int failed = 0;
  int skipped = 0;
  for (int i = 0; i < count && interrupts() == 0; ++i) {
    const SequenceFrame frame = frameOf(settled, i);
    if (sequence.keep && isWhole(frame.options.output.file)) {
      ++skipped;
      continue;
    }
    try {
      drawn += drawFrame(run, frame, sequence) == Outcome::Complete;
    } catch (const UsageError&) {
      throw;  // it would be the same for every picture
    } catch (const ContextLost&) {
      throw;
    } catch (const InputError& reason) {
      if (sequence.turntable > 0 && !run.loaded) throw;  // likewise
      reportError("picture " + std::to_string(frame.number) + ": " + reason.what());
      ++failed;
    } catch (const std::exception& reason) {
      reportError("picture " + std::to_string(frame.number) + ": " + reason.what());
      ++failed;
    }
  }
  const std::string all = " of " + countText(size_t(count), "picture") + " ";
  const int missing = count - skipped - drawn - failed;
  if (skipped > 0) say(options, std::to_string(skipped) + all + "were there already");
  if (failed > 0) reportError(std::to_string(failed) + all + "failed");
  if (missing > 0)
    say(options, "interrupted: " + std::to_string(missing) + all + "are missing; --continue draws them");
  return leave(missing > 0 ? kInterruptedStatus : failed > 0 ? 1 : 0);
}

int runAny(const RenderOptions& options) {
  if (options.output.file.empty()) throw UsageError("--output is required; --help says more");
  checkEncoding(options.output.encoding, options.output.file);
  checkSequence(options);
  if (options.output.progress == ProgressForm::Json) reportAsJson(options.output.quiet);
  if (options.output.toStandardOutput && isatty(STDOUT_FILENO) != 0)
    throw UsageError("--output -: standard output is a terminal; send it to a file or a program");
  if (isSequence(options)) return runSequence(options);
  return leave(options.selection.materialVariant == kAllVariants ? renderVariants(options)
                                                                 : renderOne(options));
}

}  // namespace

RunCommand addRender(CLI::App& app) {
  struct Raw {
    RawRender render;
    std::string config;
  };
  const auto raw = std::make_shared<Raw>();
  addOption(app, "file", raw->render)->required();
  addOption(app, "--output", raw->render);
  for (const OptionGroup group : {OptionGroup::Tracing, OptionGroup::Encoding, OptionGroup::Output,
                                  OptionGroup::Sequence, OptionGroup::Filter})
    addOptions(app, group, raw->render);
  addConfigOption(app, raw->config);
  return [raw, &app] { return runConfigured(raw->render, raw->config, app, runAny); };
}

}  // namespace fragtrace
