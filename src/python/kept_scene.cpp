// SPDX-License-Identifier: MIT
#include "python/kept_scene.h"

#include <CLI/CLI.hpp>
#include <limits>

#include "base/errors.h"
#include "options/config_file.h"
#include "options/option_row.h"
#include "options/parse_words.h"
#include "session/picture/denoising.h"

namespace fragtrace {

namespace {

/// The device, and the scenes that have data on it.
struct DrawingState {
  Device device;
  std::vector<std::weak_ptr<KeptScene>> scenes;
};

/// The state of the drawing thread. It is never destroyed, since the driver may be unloaded first.
DrawingState& drawing() {
  static auto* const theOne = new DrawingState;
  return *theOne;
}

/// Throws UsageError unless the options draw by the context of the process, which all scenes share.
void checkBackend(const RenderOptions& options) {
  const Device& device = drawing().device;
  if (!device.context) return;
  const std::string& name = device.context->backend;
  const bool other = (options.device.backend == Backend::Egl && name != "egl") ||
                     (options.device.backend == Backend::OsMesa && name != "osmesa");
  if (other)
    throw UsageError("--rendering-backend: this process draws by " + name +
                     " already; another needs another process");
}

/// The driver has lost all that was on the device.
void forgetDevice() {
  DrawingState& state = drawing();
  for (const auto& kept : state.scenes) {
    if (const auto scene = kept.lock()) scene->session.forgetTracer();
  }
  state.device.filter.reset();
  state.device.driverLog.reset();
  state.device.context.reset();
}

std::optional<DrawnPicture> draw(KeptScene& kept, const RenderOptions& asked, DrawJob& job) {
  RenderOptions options = asked;
  Device& device = drawing().device;
  device.oidn = openDenoiser(options);
  checkBackend(options);
  Statistics stats;
  kept.session.set(withGuides(options), device, stats);
  if (!kept.isKept) kept.session.releaseGeometry();
  const PictureJob picture{options, kept.session.loaded(), kept.session.tracer(), false,
                           [&](double fraction) { job.fraction = fraction; }};
  DrawingPlan plan = planDrawing(picture, device, stats);
  CheckpointKeeper keeper(options);
  std::optional<Image> image = drawSamples(picture, plan, device, keeper, 0, stats);
  if (!image || !finishPicture(*image, picture, plan, device, 0, stats)) return std::nullopt;
  sayHowItEnded(options, stats);
  return DrawnPicture{std::move(*image), statisticsText(stats), stats.complete};
}

}  // namespace

std::optional<DrawnPicture> drawKept(const std::shared_ptr<KeptScene>& scene, const RenderOptions& options,
                                     DrawJob& job) {
  if (job.interrupts > 0) return std::nullopt;
  std::vector<std::weak_ptr<KeptScene>>& scenes = drawing().scenes;
  std::erase_if(scenes, [&](const auto& other) { return other.expired() || other.lock() == scene; });
  scenes.push_back(scene);
  try {
    return draw(*scene, options, job);
  } catch (const ContextLost&) {
    forgetDevice();
    throw;
  }
}

void releaseLater(std::shared_ptr<KeptScene> scene) {
  postJob([scene = std::move(scene)](DrawJob&) mutable { scene.reset(); });
}

namespace {

struct RawWords {
  RawRender render;
  std::string config;
};

void addWords(CLI::App& app, RawWords& raw) {
  app.set_help_flag();
  raw.render.anyOutput = true;
  addOption(app, "file", raw.render)->required();
  for (const OptionGroup group : {OptionGroup::Tracing, OptionGroup::Output, OptionGroup::Filter})
    addOptions(app, group, raw.render);
  addConfigOption(app, raw.config);
}

}  // namespace

std::vector<std::string> optionNames() {
  RawWords raw;
  CLI::App app("", "fragtrace.render");
  addWords(app, raw);
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  }
  return names;
}

RenderOptions optionsOfWords(std::vector<std::string> words) {
  RawWords raw;
  CLI::App app("", "fragtrace.render");
  addWords(app, raw);
  parseWords(app, std::move(words));
  RenderOptions options = finishConfigured(raw.render, raw.config, app);
  if (options.output.checkpointSeconds > 0.0 || options.output.resume)
    throw UsageError("--checkpoint: needs a file, so the command `fragtrace render`");
  if (options.output.treeLevel)
    throw UsageError("--tree-level: is drawn over files, so needs the command `fragtrace render`");
  if (!options.output.traceFile.empty())
    throw UsageError("--trace-file: needs the command `fragtrace render`");
  if (!options.output.statsFile.empty()) throw UsageError("--stats: the picture has its statistics with it");
  return options;
}

}  // namespace fragtrace
