// SPDX-License-Identifier: MIT
// A picture as a pipeline: scene, tree, context, packed scene and renderer in drawScene(); film and picture
// in drawAndWrite().
#include "cli/render_picture.h"

#include <cstdio>
#include <utility>

#include "base/errors.h"
#include "base/report.h"
#include "base/text.h"
#include "base/timeline.h"
#include "cli/program.h"
#include "options/command_text.h"
#include "session/file_light.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/finished_picture.h"
#include "session/picture/picture_file.h"
#include "session/picture/video.h"
#include "session/sequence_camera.h"
#include "session/tracer.h"

namespace fragtrace {

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

}  // namespace

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
  sayWhatWasDone(options, destination.name, stats);
  return stats.complete ? Outcome::Complete : Outcome::Partial;
}

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
  return output.toStandardOutput ? "standard output" : output.file.string();
}

nlohmann::ordered_json eventContext(const RenderOptions& options) {
  return {{"output", options.output.toStandardOutput ? "-" : options.output.file.string()}};
}

}  // namespace fragtrace
