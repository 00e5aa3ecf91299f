// SPDX-License-Identifier: MIT
#include "session/session.h"

#include <algorithm>

#include "gl/driver_choice.h"
#include "session/outputs.h"

namespace fragtrace {

namespace {

/// Returns true if the next pose may refit this one's tree. `merge` tells scenes apart by their arrays, and a
/// small tree is built as fast: in both cases each picture has the bits of a single command, whatever was
/// drawn before.
bool keepsTree(const RenderOptions& options, const Scene& scene) {
  constexpr size_t kLeastTriangles = 4096;
  return !holdsLayers(options) && !keepsCheckpoint(options) && options.output.debugView == DebugView::None &&
         scene.triangles.size() >= kLeastTriangles && scene.motion.segments == 0;
}

/// Opens a context for `paths` camera paths in all. Throws ContextError.
void openContext(const RenderOptions& options, double paths, Device& device, Statistics& stats) {
  // Paths of global illumination have about twice the rays.
  const bool quick = preferQuickCompilation(has(options.stages, Stage::Gi) ? 2.0 * paths : paths);
  PhaseTimer timer("context");
  device.context = makeContext(options.device);
  device.driverLog.emplace();
  stats.phases.push_back(timer.end());
  stats.quickCompilation = quick && device.context->software;
}

}  // namespace

bool seesStrokesAlike(const RenderOptions& a, const RenderOptions& b) {
  return a.camera.overrides == b.camera.overrides && a.camera.index == b.camera.index &&
         a.camera.resolution == b.camera.resolution;
}

Renewal Session::renewalOf(const RenderOptions& options) const {
  if (!isSet_) return Renewal::Scene;
  Renewal renewal = renewalBetween(options_, options);
  if (differIn(Renewal::Surroundings, options_, options)) renewal = Renewal::Scene;
  if (renewal == Renewal::Surfaces) renewal = Renewal::Pose;
  const bool strokes = loaded_ && !loaded_->scene.strokes.empty();
  if (!loaded_ || (strokes && !seesStrokesAlike(options_, options)))
    renewal = std::max(renewal, Renewal::Pose);
  return renewal;
}

void Session::load(const RenderOptions& options, Statistics& stats) {
  SceneBefore before;
  if (pictures_ > 1.0) before.document = &document_;
  if (loaded_) {
    before.environment = &loaded_->environment;
    before.volume = &loaded_->scene.volume;
    before.light = loaded_->light;
    if (tree_) before.tree = &*tree_;
  }
  loaded_ = loadScene(options, stats, {}, FilmOf::Part, before);
  options_ = options;
  released_ = false;
  if (stats.treeRefitted) return;
  tree_.reset();
  if (document_ && !alwaysHashes_ && keepsTree(options, loaded_->scene))
    tree_ = refittable(loaded_->bvh, loaded_->scene);
}

Renewal Session::set(const RenderOptions& options, Device& device, Statistics& stats,
                     const SceneChange& change) {
  Renewal renewal = std::max(renewalOf(options), change.least);
  if (!tracer_) renewal = std::max(renewal, Renewal::Program);
  if (released_ && renewal == Renewal::Program) renewal = Renewal::Pose;
  // Programs that hold the scene in their text are made for each scene.
  const bool repacks = renewal == Renewal::Pose && tracer_ && sameBesidePose(options_, options) &&
                       tracer_->variant.traversal != TraversalMethod::Literals;
  // Before the load: what is of other options takes memory.
  if (renewal != Renewal::None && !repacks) tracer_.reset();
  if (renewal == Renewal::Scene) {
    if (isSet_) document_.reset();
    tree_.reset();
    loaded_.reset();
  }
  isSet_ = true;
  if (renewal >= Renewal::Pose) {
    if (loaded_) {
      std::shared_ptr<const VolumeGrid> grid = loaded_->scene.volume.grid;
      releaseGeometry();
      loaded_->scene.volume.grid = std::move(grid);
    }
    load(options, stats);
    if (change.change) change.change(*loaded_);
  } else {
    options_ = options;
    stats = prepared_;
    stats.phases.clear();
    if (renewal != Renewal::None) stats.skipped.clear();
    stats.clockMs = steadyMilliseconds();
    stats.clockCpuMs = threadMilliseconds();
    stats.loadMs = stats.bvhBuildMs = stats.packMs = stats.uploadMs = stats.compileMs = 0.0;
    if (!released_) aim(*loaded_, options, FilmOf::Part);
    stats.size = loaded_->region.size;
    stats.region = options.camera.region;
  }
  if (renewal == Renewal::None) return renewal;
  if (!device.context)
    openContext(options, pictures_ * pathsOf(options, loaded_->region.size), device, stats);
  if (repacks) {
    replaceScene(*tracer_, *device.context, *loaded_, options, stats);
  } else {
    const bool hashes = alwaysHashes_ || keepsCheckpoint(options) || holdsLayers(options);
    tracer_ = makeTracer(*device.context, *loaded_, options, stats, {.hash = hashes},
                         std::exchange(device.programs, {}));
  }
  prepared_ = stats;
  return renewal;
}

void Session::releaseGeometry() {
  fragtrace::releaseGeometry(*loaded_);
  released_ = true;
}

}  // namespace fragtrace
