// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/report.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/render_picture.h"
#include "image/files/process.h"
#include "options/command_text.h"
#include "session/file_light.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/picture_file.h"
#include "session/picture/sequence.h"
#include "session/picture/video.h"
#include "session/sequence_camera.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

/// State that the pictures of a sequence share.
struct SequenceRun {
  Device device;
  Session session;
  std::unique_ptr<Video> video;  ///< the file that all pictures go to; null: there is none
};

/// Pictures after the end of an animation are all the same.
void warnBeyondEnd(const RenderOptions& options, const SequenceOptions& sequence, const Scene& scene) {
  const std::optional<double> length = animationLength(scene, options.selection);
  const int last = rangeOf(sequence).last;
  if (!length || last <= std::ceil(*length * sequence.fps)) return;
  say(options,
      formatted(
          "warning: --frames: the animation ends after %.4g s, at picture %d; those after it show its end",
          *length, int(std::ceil(*length * sequence.fps))));
}

/// The scene as the picture shows it, on the device. A turntable's is another one in each picture where it
/// has lamps that stay, and the rest turns.
Statistics prepareFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  const bool first = !run.session.hasTracer();
  const bool turns = sequence.turntable > 0;
  const auto turnsBeforeLamps = [&] {
    return turns && sequence.turn == Turn::Object && run.session.isLoaded() &&
           !run.session.loaded().scene.lights.empty();
  };
  const auto change = [&](LoadedScene& loaded) {
    if (turns) loaded.scene.motion.camera = frame.sweep > 0.0;
    if (turnsBeforeLamps())
      turnLights(loaded.scene, turningPoint(loaded.camera, loaded.overrides, loaded.framed), frame.turn);
  };
  Statistics stats;
  const Renewal least = turnsBeforeLamps() ? Renewal::Pose : Renewal::None;
  run.session.set(withGuides(frame.options), run.device, stats, {least, change});
  if (first && !turns) warnBeyondEnd(frame.options, sequence, run.session.loaded().scene);
  return stats;
}

Outcome drawFrame(SequenceRun& run, const SequenceFrame& frame, const SequenceOptions& sequence) {
  checkOutputs(outputsOf(frame.options), inputsOf(frame.options));
  nlohmann::ordered_json context = eventContext(frame.options);
  context.update({{"frame", frame.number},
                  {"first_frame", rangeOf(sequence).first},
                  {"last_frame", rangeOf(sequence).last}});
  setReportContext(context);
  Statistics stats = prepareFrame(run, frame, sequence);
  LoadedScene& loaded = run.session.loaded();
  const RenderOptions options = exposed(frame.options, loaded.light);
  const Camera camera = loaded.camera;
  if (sequence.turntable > 0) {
    const glm::dvec3 focalPoint = turningPoint(camera, loaded.overrides, loaded.framed);
    const auto turned = [&](double angle) { return turnedCamera(camera, focalPoint, angle); };
    loaded.camera = turned(frame.turn);
    const int segments = int(std::ceil(frame.sweep / glm::half_pi<double>()));
    std::vector<Camera> poses;
    for (int i = 0; i <= segments && segments > 0; ++i)
      poses.push_back(turned(frame.turn + (double(i) / segments - 0.5) * frame.sweep));
    loaded.motion = segmentsThrough(poses);
    loaded.view = makeView(options, loaded, loaded.camera);
    if (sequence.turn == Turn::Object) loaded.view.hdriRotation += frame.turn;
  }
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  if (!options.output.treeLevel) run.session.releaseGeometry();
  Destination destination{nameOf(options.output)};
  if (isStream(options.output)) {
    destination.name += ", picture " + std::to_string(frame.number);
    if (!run.video && !options.output.toStandardOutput)
      run.video = startVideo(options.output.file, loaded.region.size, picturesPerSecond(sequence));
    destination.video = run.video.get();
  }
  const Outcome outcome =
      drawAndWrite({options, loaded, run.session.tracer(), false}, boxes, destination, run.device, stats);
  loaded.camera = camera;
  return outcome;
}

/// Returns true if there is a complete picture by that name. Files are replaced as a whole, so one with
/// contents is complete.
bool isWhole(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) > 0;
}

/// Numbers of a sequence's pictures.
struct SequenceCounts {
  int all = 0;
  int drawn = 0;
  int failed = 0;
  int skipped = 0;
};

/// Draws all pictures that are wanted. If one fails, a message says so and the others are drawn. A stream
/// ends there.
void drawFrames(const RenderOptions& options, SequenceRun& run, SequenceCounts& counts) {
  const SequenceOptions& sequence = options.output.sequence;
  const bool isStreamed = isStream(options.output);
  for (int i = 0; i < counts.all && interrupts() == 0 && !(isStreamed && counts.failed > 0); ++i) {
    const SequenceFrame frame = frameOf(options, i);
    if (sequence.keep && isWhole(frame.options.output.file)) {
      ++counts.skipped;
      continue;
    }
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
      reportError("picture " + std::to_string(frame.number) + ": " + reason.what());
      ++counts.failed;
    }
  }
}

/// The video holds what was drawn, however the drawing ended. Returns false if there is none.
bool endVideo(const RenderOptions& options, SequenceRun& run) {
  if (!run.video || run.video->encoder < 0 || run.video->count == 0) return false;
  try {
    finishVideo(*run.video);
  } catch (const RenderError&) {
    if (interrupts() == 0) throw;
    return false;
  }
  const glm::ivec2 size = run.video->size;
  const double perSecond = picturesPerSecond(options.output.sequence);
  say(options, nameOf(options.output) + ": " + countText(size_t(run.video->count), "picture") +
                   formatted(" of %d x %d, %.4g s at %.4g per second", size.x, size.y,
                             run.video->count / perSecond, perSecond));
  return true;
}

/// Says how far the pictures of a stream came, and returns the status.
int sayHowStreamEnded(const RenderOptions& options, const SequenceCounts& counts, bool isKept) {
  const bool isCut = interrupts() > 0 && (counts.drawn + counts.failed < counts.all || !isKept);
  std::string held = "nothing is written";
  if (isKept && counts.drawn > 0)
    held = std::to_string(counts.drawn) + " of " + countText(size_t(counts.all), "picture") +
           (options.output.toStandardOutput ? " went to " : " are in ") + nameOf(options.output);
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

}  // namespace

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
  run.video.reset();  // leave() destroys nothing, and the encoder would go on
  return leave(isStream(options.output) ? sayHowStreamEnded(options, counts, isKept)
                                        : sayHowSequenceEnded(options, counts));
}

}  // namespace fragtrace
