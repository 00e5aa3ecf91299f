// SPDX-License-Identifier: MIT
#include "cli/render_command.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "base/errors.h"
#include "base/report.h"
#include "base/text.h"
#include "base/timeline.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "gl/program.h"
#include "gltf/gltf.h"
#include "image/files/header.h"
#include "image/files/process.h"
#include "image/files/whole_file.h"
#include "options/command_text.h"
#include "options/parse_render.h"
#include "session/environment.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/picture_file.h"
#include "session/picture/sequence.h"
#include "session/shutter.h"
#include "session/tracer.h"

namespace fragtrace {

// A picture as a pipeline: scene, tree, context, packed scene and renderer in drawScene(); film and picture
// in drawAndWrite().

namespace {

void sayWhatWasDone(const RenderOptions& options, const std::string& name, const Statistics& stats) {
  std::string noise;
  if (stats.adaptive) {
    const AdaptiveStatistics& a = *stats.adaptive;
    noise = !a.known         ? ", error unknown"
            : a.error <= 1.0 ? formatted(", 95 %% of the pixels within %.3g %% (estimated)", 100.0 * a.error)
                             : ", noise above 100 % (estimated)";
  }
  if (stats.denoise && !stats.denoise->filter.empty())
    noise += ", " + stats.denoise->filter + formatted(" in %.2f s", stats.denoise->filterMs / 1000.0);
  sayHowItEnded(options, stats);
  if (!stats.complete) say(options, "interrupted: what was finished is written");
  reportEvent("picture", {{"width", stats.size.x},
                          {"height", stats.size.y},
                          {"samples", samplesPerPixel(stats)},
                          {"complete", stats.complete}});
  // Standard output is the statistics' or the picture's alone.
  const bool taken = isStandardOutput(options.output.statsFile) || options.output.toStandardOutput;
  if (options.output.quiet || (taken ? reportsAsJson() : standardOutputIsClosed())) return;
  const std::string samples = formatted("%.4g", samplesPerPixel(stats));
  std::fprintf(taken ? stderr : stdout, "%s: %d x %d, %s per pixel in %.2f s (%.2f million paths/s)%s\n",
               name.c_str(), stats.size.x, stats.size.y, countText(samples, "sample").c_str(),
               stats.times.renderMs / 1000.0, megaPathsPerSecond(stats), noise.c_str());
}

/// Draws, finishes and writes. `boxes` are drawn over it. Throws RenderError, UsageError, InputError (of a
/// checkpoint).
Outcome drawAndWrite(const PictureJob& job, const std::vector<PictureLine>& boxes,
                     const Destination& destination, Device& device, Statistics& stats) {
  const RenderOptions& options = job.options;
  // --continue skips the pictures of a sequence that are there, so a partial one must not be.
  const int most = job.showsProgress ? 1 : 0;
  DrawingPlan plan = planDrawing(job, device, stats);

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
    if (destination.video != nullptr)
      addFrame(*destination.video, displayedPicture(options, *drawn, boxes));
    else
      writePicture(options, *drawn, boxes);
    stats.phases.push_back(writing.end());
  } catch (const std::exception& error) {
    throw RenderError(rescuePicture(options, *drawn, error.what()));
  }
  markMoment("picture");
  if (stats.complete) keeper.remove();
  if (!options.output.statsFile.empty()) replaceText(options.output.statsFile, statisticsText(stats));
  if (!options.output.shaderText.empty()) {
    const ShaderVariant& variant = job.tracer.variant;
    replaceText(options.output.shaderText,
                readableShader(shaderSource(options.device.shaderFolder), tracerEntry(variant), variant));
  }
  sayWhatWasDone(options, destination.name, stats);
  return stats.complete ? Outcome::Complete : Outcome::Partial;
}

/// The context of a picture's events: its file.
nlohmann::ordered_json eventContext(const RenderOptions& options) {
  return {{"output", options.output.toStandardOutput ? "-" : placeOf(options.output).string()}};
}

/// State that the pictures of a sequence share.
struct SequenceRun {
  Device device;
  Session session;
  SequenceProgress progress;
  std::unique_ptr<Video> video;  ///< the file that all pictures go to; null: there is none
};

Outcome drawFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  checkOutputs(outputsOf(frame.options), inputsOf(frame.options));
  nlohmann::ordered_json context = eventContext(frame.options);
  context.update({{"frame", frame.number},
                  {"first_frame", rangeOf(sequence).first},
                  {"last_frame", rangeOf(sequence).last}});
  setReportContext(context);
  Statistics stats = prepareFrame(run.session, run.device, frame, sequence);
  LoadedScene& loaded = run.session.loaded();
  const RenderOptions options = exposed(frame.options, loaded.light);
  const Camera camera = loaded.camera;
  turnView(loaded, options, frame, sequence);
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  if (!options.output.treeLevel) run.session.releaseGeometry();
  Destination destination{nameOf(options.output)};
  if (isStream(options.output)) {
    destination.name += ", picture " + std::to_string(frame.number);
    if (!run.video && !options.output.toStandardOutput)
      run.video = startVideo(options.output.file, loaded.region.size, picturesPerSecond(sequence));
    destination.video = run.video.get();
  }
  const PictureJob job{options, loaded, run.session.tracer(), false, {}, &run.progress};
  const Outcome outcome = drawAndWrite(job, boxes, destination, run.device, stats);
  loaded.camera = camera;
  return outcome;
}

/// Says why the file of a sequence's picture is not what `options` ask for; empty: it is, as far as its size
/// tells. A .png, .jpg or .pfm is read to its end.
std::string whyDrawnAgain(const RenderOptions& options) {
  const std::filesystem::path& path = options.output.file;
  try {
    const std::vector<uint8_t> bytes = readBytes(path, defaultMemoryLimit());
    const ImageHeader header = readImageHeader(bytes);
    const bool isPart = options.camera.region && header.format != ImageFormat::OpenExr;
    const glm::ivec2 size(header.width, header.height);
    const glm::ivec2 asked = isPart ? options.camera.region->size : options.camera.resolution.value_or(size);
    if (size != asked) return formatted("%d x %d pixels, not %d x %d", size.x, size.y, asked.x, asked.y);
    const bool isCut =
        header.format == ImageFormat::Pfm && bytes.size() < decodedValues(header) * sizeof(float);
    return isCut ? "the file is truncated" : "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// Returns true if the picture of --continue is there. A line tells of one that is not right.
bool isKept(const RenderOptions& options) {
  std::error_code unknown;
  if (!std::filesystem::exists(options.output.file, unknown)) return false;
  const std::string why = whyDrawnAgain(options);
  if (!why.empty()) say(options, options.output.file.string() + ": " + why + "; it is drawn again");
  return why.empty();
}

/// Numbers of a sequence's pictures.
struct SequenceCounts {
  int all = 0;
  int drawn = 0;
  int failed = 0;
  int skipped = 0;
};

std::string withoutName(std::string text, const std::string& name) {
  for (size_t at = text.find(name); at != std::string::npos; at = text.find(name))
    text.erase(at, name.size());
  return text;
}

/// Draws all pictures that are wanted. If one fails, a message says so, unless it is that of the one before,
/// and the others are drawn. A stream ends there.
void drawFrames(const RenderOptions& options, SequenceRun& run, SequenceCounts& counts) {
  const SequenceOptions& sequence = options.output.sequence;
  const bool isStreamed = isStream(options.output);
  // An estimate for the progress: pictures are not read yet, and another process may draw some of them.
  int asked = 0;
  for (int i = 0; i < counts.all; ++i)
    asked += !sequence.keep || !std::filesystem::exists(frameOf(options, i).options.output.file);
  std::string failedBefore;
  for (int i = 0; i < counts.all && interrupts() == 0 && !(isStreamed && counts.failed > 0); ++i) {
    const SequenceFrame frame = frameOf(options, i);
    if (sequence.keep && isKept(frame.options)) {
      ++counts.skipped;
      continue;
    }
    run.progress.begin(frame.number, i, counts.all, counts.drawn + counts.failed, asked);
    try {
      counts.drawn += drawFrame(run, frame, sequence) == Outcome::Complete;
    } catch (const UsageError&) {
      throw;  // the same error would follow for every picture
    } catch (const ContextLost&) {
      throw;
    } catch (const std::exception& reason) {
      // A turntable's scene would be the same for every picture.
      const bool isInput = dynamic_cast<const InputError*>(&reason) != nullptr;
      if (isInput && sequence.turntable > 0 && !run.session.isLoaded()) throw;
      const std::string said = withoutName(reason.what(), frame.options.output.file.string());
      if (said != failedBefore) reportError(pictureIn(&run.progress) + reason.what());
      failedBefore = said;
      ++counts.failed;
    }
  }
}

/// The video holds what was drawn, however the drawing ended. Returns false if there is none.
bool endVideo(const RenderOptions& options, SequenceRun& run) {
  if (!run.video || run.video->encoder < 0 || run.video->count == 0) return false;
  try {
    finishVideo(*run.video, frameCount(options.output.sequence));
  } catch (const RenderError&) {
    if (interrupts() == 0) throw;
    return false;
  }
  const glm::ivec2 size = run.video->size;
  const double perSecond = picturesPerSecond(options.output.sequence);
  say(options, run.video->kept.string() + ": " + countText(size_t(run.video->count), "picture") +
                   formatted(" of %d x %d, %.4g s at %.4g per second", size.x, size.y,
                             run.video->count / perSecond, perSecond));
  return true;
}

/// Says how far the pictures of a stream came, and returns the status. `kept`: the file that holds them.
int sayHowStreamEnded(const RenderOptions& options, const SequenceCounts& counts, bool isKept,
                      const std::filesystem::path& kept) {
  const bool isCut = interrupts() > 0 && (counts.drawn + counts.failed < counts.all || !isKept);
  std::string held =
      kept.empty() ? "nothing is written" : "what was encoded before that is in " + kept.string();
  if (isKept && counts.drawn > 0)
    held = std::to_string(counts.drawn) + " of " + countText(size_t(counts.all), "picture") +
           (options.output.toStandardOutput ? " went to standard output" : " are in " + kept.string());
  if (counts.failed > 0)
    reportError(held);
  else if (isCut)
    say(options, "interrupted: " + held);
  return isCut ? kInterruptedStatus : counts.failed > 0 ? 1 : 0;
}

/// Says what is missing, and returns the status.
int sayHowSequenceEnded(const RenderOptions& options, const SequenceCounts& counts) {
  const std::string all = " of " + countText(size_t(counts.all), "picture") + " ";
  const int missing = counts.all - counts.skipped - counts.drawn - counts.failed;
  if (counts.skipped > 0) say(options, std::to_string(counts.skipped) + all + "were there already");
  if (counts.failed > 0) reportError(std::to_string(counts.failed) + all + "failed");
  if (missing > 0)
    say(options, "interrupted: " + std::to_string(missing) + all + "are missing; --continue draws them");
  return missing > 0 ? kInterruptedStatus : counts.failed > 0 ? 1 : 0;
}

/// Draws all pictures that are wanted of a sequence, to numbered files, a video or standard output, and ends
/// as leave() does. Returns the status. Throws what all pictures have in common.
int runSequence(const RenderOptions& options) {
  const SequenceOptions& sequence = options.output.sequence;
  SequenceRun run;
  std::shared_ptr<KeptDocument> document;
  RenderOptions settled = options;
  if (sequence.frames) {
    settled = placedForAllPoses(options, document);
    if (settled.camera.overrides != options.camera.overrides)
      say(options, "one camera shows the whole animation: " + cameraText(settled));
  }
  run.session = Session(frameCount(sequence), false, std::move(document));
  run.device.oidn = openDenoiser(settled);
  passOnWhatIsSaid([](const std::string&) {});  // they would all say the same
  countInterrupts();
  if (options.output.file.extension() != ".pfm") startImageProcess();
  const RenderOptions firstOptions = frameOf(settled, 0).options;
  checkOutputs(outputsOf(firstOptions), inputsOf(firstOptions));  // a wrong folder would be wrong for all
  if (videoFormatOf(options.output.file) != nullptr) checkVideo(options.output.file);
  SequenceCounts counts;
  counts.all = frameCount(sequence);
  try {
    drawFrames(settled, run, counts);
  } catch (...) {
    endVideo(options, run);
    throw;
  }
  const bool isKept = endVideo(options, run) || options.output.toStandardOutput;
  const std::filesystem::path kept = run.video ? run.video->kept : std::filesystem::path();
  run.video.reset();  // leave() destroys nothing, and the encoder would continue
  return leave(isStream(options.output) ? sayHowStreamEnded(options, counts, isKept, kept)
                                        : sayHowSequenceEnded(options, counts));
}

}  // namespace

Outcome drawScene(const RenderOptions& asked, const Destination& destination, Device& device,
                  Statistics& stats, bool showsProgress) {
  // Step: load, and put what the shader variant reads on the device.
  const RenderOptions drawn = withGuides(asked);
  Session session;
  session.set(drawn, device, stats);
  LoadedScene& loaded = session.loaded();
  const RenderOptions options = exposed(asked, loaded.light);
  if (options.output.verbose && loaded.overrides.fit) {
    RenderOptions placed = options;
    placed.camera.overrides = asPlaced(loaded.camera, loaded.framed);
    say(options, "--fit: the camera stands at " + viewText(placed));
  }
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  session.releaseGeometry();

  // Step: draw, and write.
  const Outcome outcome =
      drawAndWrite({options, loaded, session.tracer(), showsProgress}, boxes, destination, device, stats);
  device.programs = session.tracer().renderer->takePrograms();
  return outcome;
}

std::string nameOf(const OutputOptions& output) {
  return output.toStandardOutput ? "standard output" : placeOf(output).string();
}

// `fragtrace render`: one picture by drawScene() of cli/render_command.cpp, one of each variant, or a
// sequence.

namespace {

/// Returns the status.
int renderOne(const RenderOptions& asked) {
  setReportContext(eventContext(asked));
  checkOutputs(outputsOf(asked), inputsOf(asked));
  if (isFinished(asked)) return 0;
  RenderOptions options = asked;
  Device device;
  device.oidn = openDenoiser(options);
  Statistics stats;
  // The image library opens meanwhile, in its own process, when the output needs it.
  if (options.output.file.extension() != ".pfm") startImageProcess();
  const Outcome outcome = drawScene(options, {nameOf(options.output)}, device, stats, true);
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

int runAny(const RenderOptions& options) {
  if (options.output.file.empty()) throw UsageError("--output is required; --help says more");
  if (options.output.countWork && options.output.statsFile.empty())
    throw UsageError("--count-work: goes with --stats FILE, which has the counts");
  checkEncoding(options.output.encoding, options.output.file);
  checkSequence(options);
  if (options.output.progress == ProgressForm::Json) reportAsJson(options.output.quiet);
  if (options.output.toStandardOutput && isatty(STDOUT_FILENO) != 0)
    throw UsageError("--output -: standard output is a terminal; send it to a file or a program");
  if (!options.output.traceFile.empty()) startTimeline(options.output.traceFile);
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
  raw->render.hasQuality = true;
  addOption(app, "file", raw->render)->required();
  addOption(app, "--output", raw->render);
  for (const OptionGroup group : {OptionGroup::Tracing, OptionGroup::Encoding, OptionGroup::Output,
                                  OptionGroup::Sequence, OptionGroup::Filter})
    addOptions(app, group, raw->render);
  addConfigOption(app, raw->config);
  return [raw, &app] { return runConfigured(raw->render, raw->config, app, runAny); };
}

}  // namespace fragtrace
