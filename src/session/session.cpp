// SPDX-License-Identifier: MIT
#include "session/session.h"

#include <algorithm>

#include "base/vectors.h"
#include "gl/driver_choice.h"
#include "gltf/edit/factors.h"
#include "session/environment.h"
#include "session/outputs.h"
#include "session/say.h"

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

/// Points and lines get their width from the camera and the picture's size.
bool seesStrokesAlike(const RenderOptions& a, const RenderOptions& b) {
  return a.camera.overrides == b.camera.overrides && a.camera.index == b.camera.index &&
         a.camera.resolution == b.camera.resolution;
}

}  // namespace

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

void Session::load(const RenderOptions& options, FilmOf film, Statistics& stats) {
  SceneBefore before;
  if (pictures_ > 1.0) before.document = &document_;
  if (loaded_) {
    before.environment = &loaded_->environment;
    before.volume = &loaded_->scene.volume;
    before.light = loaded_->light;
    if (tree_) before.tree = &*tree_;
  }
  loaded_ = loadScene(options, stats, {}, film, before);
  released_ = false;
  if (stats.treeRefitted) return;
  tree_.reset();
  const bool keeps = programs_ ? loaded_->scene.instances.empty()
                               : document_ && !alwaysHashes_ && keepsTree(options, loaded_->scene);
  if (keeps) tree_ = refittable(loaded_->bvh, loaded_->scene);
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
    load(options, FilmOf::Part, stats);
    options_ = options;
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

void Session::open(LoadedScene loaded, std::shared_ptr<KeptDocument> document, const RenderOptions& options) {
  forgetTracer();
  tree_.reset();
  loaded_ = std::move(loaded);
  document_ = std::move(document);
  options_ = options;
  options_.selection.set.clear();
  options_.camera.resolution = loaded_->size;
  fileMaterials_ = loaded_->scene.materials;
  fileLights_ = loaded_->scene.lightSources;
}

void Session::openPrograms(const Context& context, std::optional<CompileAside> aside) {
  programs_ = std::make_unique<ScenePrograms>(context, *loaded_, options_, std::move(aside));
}

RenderOptions Session::asPosed(RenderOptions options) const {
  const SceneSelection& s = options.selection;
  const bool changes = s.animationTime || !s.hiddenNodes.empty() || !loaded_->scene.strokes.empty() ||
                       (!s.set.empty() && programs_ && programs_->heldText());
  if (changes && options.device.traversal == TraversalMethod::Auto)
    options.device.traversal = TraversalMethod::FrontToBack;
  return options;
}

Renewal Session::renewScene(const RenderOptions& options, bool keepsStrokes) {
  const bool relit =
      options_.light.sky.on && options.light.sky.on && differIn(Renewal::Surroundings, options_, options);
  const bool set = differIn(Renewal::Surfaces, options_, options);
  const bool hasStrokes = !loaded_->scene.strokes.empty();
  const bool posed = differIn(Renewal::Pose, options_, options) ||
                     (hasStrokes && !keepsStrokes && !seesStrokesAlike(options_, options));
  if (!relit && !set && !posed) return Renewal::None;
  std::vector<std::string> repeated;
  const SaidHere silence(repeated);  // loading the scene has said it
  programs_->waitForCompiler();
  if (relit) relight(options);
  if (!set && !posed) return Renewal::Surroundings;
  if (!posed && setSurfaces(options)) return Renewal::Surfaces;
  if (options_.selection.hiddenNodes != options.selection.hiddenNodes) tree_.reset();
  takePose(options_, options);
  options_.camera.overrides = options.camera.overrides;
  options_.camera.index = options.camera.index;
  options_.camera.resolution = options.camera.resolution;
  RenderOptions loading = asPosed(options_);
  loading.camera.sceneOrigin = loaded_->scene.space.origin;
  Statistics stats;
  load(loading, FilmOf::Picture, stats);
  programs_->show(Renewal::Pose, loading);
  return Renewal::Pose;
}

void Session::relight(const RenderOptions& options) {
  options_.light.sky = options.light.sky;
  const auto shines = [&] {
    const std::optional<SunDisc>& sun = loaded_->environment.sun;
    return sun && luminance(sun->irradiance) > 0.0;
  };
  const bool shone = shines();
  std::vector<std::string> warnings;
  loaded_->environment = skyOf(options_, warnings);
  // When the sun rises or sets, programs change: light paths begin at it (Trait::Caustics).
  programs_->show(shines() == shone ? Renewal::Surroundings : Renewal::Program, options_);
}

/// Returns false if more may have to change than the numbers of surfaces and lights: the scene is then to be
/// posed.
bool Session::setSurfaces(const RenderOptions& options) {
  // An animation may drive the same numbers, and lines are built again for another camera.
  if (options.selection.animationTime || !loaded_->scene.strokes.empty() ||
      options.device.traversal == TraversalMethod::Literals)
    return false;
  const auto traits = [&] { return traitsOf(loaded_->scene, loaded_->environment); };
  const TraitSet before = traits();
  if (!setByEye(loaded_->scene, fileMaterials_, fileLights_, options.selection.set) || traits() != before)
    return false;
  takeStep(options_, options, Renewal::Surfaces);
  programs_->show(Renewal::Surfaces, options_);
  return true;
}

}  // namespace fragtrace
