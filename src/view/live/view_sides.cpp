// SPDX-License-Identifier: MIT
// Begins to draw a side of the viewer: filter, program, camera, and a preview until the program is there.
#include <algorithm>

#include "options/option_row.h"
#include "session/picture/denoising.h"
#include "view/live/view_tracer.h"

namespace fragtrace {

namespace {

/// Triangles of a scene that is previewed: with more, packing them twice takes longer than compiling.
constexpr size_t kMostPreviewed = 300'000;

}  // namespace

RenderOptions ViewTracer::withFilter(RenderOptions options) {
  const bool wanted = options.output.denoise == Denoise::Oidn || options.output.denoise == Denoise::Auto;
  if (wanted && oidn_) options.output.denoise = Denoise::Oidn;
  if (!wanted || oidn_) return options;
  try {
    oidn_ = openDenoiser(options);
  } catch (const UsageError& error) {
    exchange_.set(&TraceStatus::error, error.what());
    options.output.denoise = Denoise::Variance;
  }
  return options;
}

void ViewTracer::setSide(Side& side, const RenderOptions& asked) {
  RenderOptions options = withFilter(asked);
  std::shared_ptr<ViewProgram> program = side.program;
  side.awaited.reset();
  if (!program || !drawsTheSame(side.options, options)) {
    if (!program && !programs_->has(options)) preview(side, options);
    program = programFor(options, side.program != nullptr);
    if (!program) {
      program = side.program;
      side.awaited = std::exchange(options, side.options);
      // The camera moves meanwhile, unless the program there is of another lens.
      if (programOptions(options).camera == programOptions(*side.awaited).camera)
        options.camera = side.awaited->camera;
      // The other processor has nothing to do.
      if (whyNotDenoised(*side.awaited).empty()) maker_->prepareFilter();
    }
  }
  // The last good one keeps drawing.
  if (!program->error.empty()) program = side.program;
  const bool same = side.program && side.program == program && drawsTheSame(side.options, options);
  const bool otherLook = side.options.output.treeLevel != options.output.treeLevel ||
                         side.options.output.denoise != options.output.denoise;
  if (differInCameraAlone(side.options, options)) {
    side.memory.turn();
    if (!side.awaited) programs_->addCones(program);
  } else if (!same) {
    side.memory.forget();
  }
  side.options = options;
  if (same && otherLook && !side.stale && side.samples > 0) publish(side);
  if (same) return;
  if (!side.awaited) side.previews = false;
  // If one side has samples, the other takes its resolution, since another one would lose these samples.
  const bool joins =
      !side.program && std::ranges::any_of(sides_, [](const Side& s) { return !s.stale && s.samples > 0; });
  if (side.program != program && !joins)
    drawSomethingElse(resolution_, request_.size, program->tracer.renderer->msPerSample());
  side.program = program;
  side.view = viewOf(options);
  side.stale = true;
}

/// Returns the view of the options' camera, or of the scene's first one if that does not exist, as when the
/// file has changed.
View ViewTracer::viewOf(const RenderOptions& options) {
  Camera camera = loaded_->camera;
  try {
    camera = chooseCamera(loaded_->scene.cameras, options.camera.index, options.camera.overrides,
                          loaded_->scene.bounds, framedAspect(loadedOptions_));
  } catch (const UsageError& error) {
    exchange_.set(&TraceStatus::error, error.what());
  }
  return makeView(options, *loaded_, camera);
}

/// Shows the stage that compiles soonest, so that the window is not empty while the side's program compiles.
void ViewTracer::preview(Side& side, const RenderOptions& wanted) {
  const bool quick = !has(wanted.stages, Stage::Shadows) && !has(wanted.stages, Stage::Gi);
  if (quick || loaded_->scene.triangles.size() > kMostPreviewed) return;
  RenderOptions o = wanted;
  o.stages = stagesUpTo(Stage::Phong);
  o.output.denoise = Denoise::None;
  o.output.debugView = DebugView::None;
  o.sampling.clampIndirect = 0.0;
  o.light.shadowCatcher = false;
  const std::shared_ptr<ViewProgram> program = programFor(o, false);
  if (!program->error.empty()) return;
  side.options = o;
  side.program = program;
  side.previews = true;
  side.view = viewOf(o);
  keepMoving(resolution_, request_.size);
  fitFilm(side);
  const auto goOn = [&](double) { return !exchange_.ending(); };
  if (!program->tracer.renderer->addSamples(*side.film, side.view, 0, 1, side.times, goOn)) return;
  side.samples = 1;
  publish(side);
}

/// Any thread may call this and the next function.
void ViewTracer::reportWork(const std::string& what) {
  const Shows shown = shows_;
  exchange_.set(&TraceStatus::note,
                what + (shown == Shows::Nothing   ? ""
                        : shown == Shows::Preview ? " (this is a preview in Blinn-Phong)"
                                                  : " (the last picture stays meanwhile)"));
}

void ViewTracer::reportDecoded(size_t decoded, size_t count) {
  reportWork("compiling, " + std::to_string(decoded) + " of " + std::to_string(count) + " textures decoded");
}

std::shared_ptr<ViewProgram> ViewTracer::programFor(const RenderOptions& options, bool aside) {
  if (!programs_->has(options)) reportWork("compiling");
  std::shared_ptr<ViewProgram> program = aside ? programs_->soon(options) : programs_->of(options);
  if (!program) return program;
  for (const std::string& message : std::exchange(program->driverLog, {}))
    exchange_.deliver("driver: " + message);
  exchange_.set(&TraceStatus::note, {});
  exchange_.set(&TraceStatus::error, program->error.empty() ? loadError_ : program->error);
  // The driver's log would only repeat this error.
  if (!program->error.empty()) driverLog_->take();
  return program;
}

bool ViewTracer::awaitsProgram() const {
  return std::ranges::any_of(sides_, [](const Side& side) { return side.awaited.has_value(); });
}

void ViewTracer::takeCompiled() {
  if (!programs_ || !programs_->takeNews()) return;
  for (Side& side : sides_) {
    if (side.awaited) setSide(side, RenderOptions(*side.awaited));
  }
  noteAnswered();
}

void ViewTracer::noteAnswered() {
  if (awaitsProgram()) return;
  answered_ = request_.number;
  exchange_.set(&TraceStatus::note, {});
}

}  // namespace fragtrace
