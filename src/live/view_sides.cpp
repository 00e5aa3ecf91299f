// SPDX-License-Identifier: MIT
// How the viewer's tracing thread begins to draw what a side asks for: filter, program, camera, and a quick
// picture until the program is there.
#include "live/view_tracer.h"
#include "picture/denoising.h"

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
    exchange_.tellError(error.what());
    options.output.denoise = Denoise::Variance;
  }
  return options;
}

void ViewTracer::adoptSide(Side& side, const RenderOptions& asked) {
  const RenderOptions options = withFilter(asked);
  const bool same = side.program && drawsTheSame(side.options, options);
  const bool otherLook = side.options.output.treeLevel != options.output.treeLevel ||
                         side.options.output.denoise != options.output.denoise;
  if (differInCameraAlone(side.options, options))
    side.memory.turn();
  else if (!same)
    side.memory.forget();
  side.options = options;
  if (same && otherLook && !side.stale && side.samples > 0) publish(side);
  if (same) return;
  if (!side.program && !programs_->has(options)) preview(side);
  const std::shared_ptr<ViewProgram> wanted = programFor(options);
  // The last good one keeps drawing.
  if (wanted->error.empty()) side.program = wanted;
  side.view = viewOf(options);
  side.stale = true;
}

/// Through the scene's first camera where it does not have the one asked for, as when its file has changed.
View ViewTracer::viewOf(const RenderOptions& options) {
  Camera camera = loaded_->camera;
  try {
    camera = chooseCamera(loaded_->scene.cameras, options.camera.index, options.camera.overrides,
                          loaded_->scene.bounds, framedAspect(loadedOptions_));
  } catch (const UsageError& error) {
    exchange_.tellError(error.what());
  }
  return makeView(options, *loaded_, camera);
}

/// Shows what compiles soonest, so that the window is not empty while what the side draws is compiled.
void ViewTracer::preview(Side& side) {
  const RenderOptions wanted = side.options;
  const bool quick = !has(wanted.stages, Stage::Shadows) && !has(wanted.stages, Stage::Gi);
  if (quick || loaded_->scene.triangles.size() > kMostPreviewed) return;
  RenderOptions& o = side.options;
  o.stages = stagesUpTo(Stage::Phong);
  o.output.denoise = Denoise::None;
  o.output.debugView = DebugView::None;
  o.sampling.clampIndirect = 0.0;
  o.light.shadowCatcher = false;
  const std::shared_ptr<ViewProgram> program = programFor(o);
  if (program->error.empty()) {
    side.program = program;
    side.view = viewOf(o);
    keepMoving(resolution_, request_.size);
    fitFilm(side);
    const auto goOn = [&](double) { return !exchange_.ending(); };
    if (program->tracer.renderer->addSamples(*side.film, side.view, 0, 1, side.times, goOn)) {
      side.samples = 1;
      publish(side);
      shows_ = Shows::Preview;
    }
  }
  side = {};
  side.options = wanted;
}

void ViewTracer::tellWork(const std::string& what) {
  switch (shows_) {
    case Shows::Nothing:
      return exchange_.tellNote(what);
    case Shows::Preview:
      return exchange_.tellNote(what + " (this is a preview in Blinn-Phong)");
    case Shows::Picture:
      return exchange_.tellNote(what + " (the last picture stays meanwhile)");
  }
}

std::shared_ptr<ViewProgram> ViewTracer::programFor(const RenderOptions& options) {
  if (!programs_->has(options)) tellWork("compiling");
  std::shared_ptr<ViewProgram> program = programs_->of(options);
  exchange_.tellNote({});
  exchange_.tellError(program->error);
  // It says the same again.
  if (!program->error.empty()) driverLog_->take();
  return program;
}

}  // namespace fragtrace
