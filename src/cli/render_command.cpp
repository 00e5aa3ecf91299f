// SPDX-License-Identifier: MIT
// `fragtrace render`: one picture by drawScene() of cli/render_picture.cpp, one of each variant, or a
// sequence.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/errors.h"
#include "base/report.h"
#include "base/timeline.h"
#include "cli/commands.h"
#include "cli/program.h"
#include "cli/render_picture.h"
#include "gltf/gltf.h"
#include "image/files/process.h"
#include "options/config_file.h"
#include "options/parse_render.h"
#include "session/interrupt.h"
#include "session/outputs.h"
#include "session/picture/denoising.h"
#include "session/picture/finished_picture.h"
#include "session/picture/sequence.h"

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
