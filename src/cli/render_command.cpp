// SPDX-License-Identifier: MIT
// `fragtrace render` as a pipeline: scene, tree, context, packed scene and renderer here; film and picture in
// drawAndWrite() of cli/render_picture.cpp.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/errors.h"
#include "base/report.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "cli/render_picture.h"
#include "gltf/gltf.h"
#include "image/files/process.h"
#include "options/command_text.h"
#include "options/config_file.h"
#include "options/parse_render.h"
#include "session/file_light.h"
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
  options = exposed(options, loaded.light);
  if (options.output.verbose && loaded.overrides.fit) {
    RenderOptions placed = options;
    placed.camera.overrides = asPlaced(loaded.camera, loaded.framed);
    say(options, "--fit: the camera stands at " + viewText(placed));
  }

  // Step: the shader variant, and the arrays that it reads.
  openContext(options, pathsOf(options, loaded.region.size), device, stats);
  const Tracer tracer = makeTracer(*device.context, loaded, drawn, stats);
  const std::vector<PictureLine> boxes = treeLines(options, loaded, loaded.camera, loaded.size);
  releaseGeometry(loaded);

  const Outcome outcome =
      drawAndWrite({options, loaded, tracer}, boxes, {nameOf(options.output)}, device, stats);
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
