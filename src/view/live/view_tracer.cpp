// SPDX-License-Identifier: MIT
#include "view/live/view_tracer.h"

#include <limits>

#include "base/timeline.h"
#include "base/vectors.h"
#include "bvh/exact_tracer.h"
#include "gl/driver_choice.h"
#include "gltf/edit/changed_file.h"
#include "gltf/edit/factors.h"
#include "scene/studio.h"
#include "session/environment.h"
#include "session/outputs.h"
#include "session/picture/picture_file.h"
#include "view/shown_text.h"
#include "view/view_state.h"

namespace fragtrace {

namespace {

constexpr double kLongWait = 3600.0;  ///< seconds
constexpr double kWatchSeconds = 0.25;
constexpr int kMostLosses = 3;  ///< losses of the context in a row, without a picture between them

/// Why a load failed. The first one throws it: a command that cannot be carried out ends the program, except
/// that another file may be shown instead of one that cannot be read.
std::string whatFailed(const std::exception_ptr& error, bool isFirst, const std::filesystem::path& scene) {
  std::error_code none;
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    if (isFirst && !std::filesystem::exists(scene, none)) throw;
    return e.what();
  } catch (const std::exception& e) {
    if (isFirst) throw;
    return e.what();
  }
}

/// The option by which `render` lights the file that holds the numbers as it is shown; empty: none is needed.
std::string lightToName(const RenderOptions& options, const LoadedScene& loaded) {
  if (hasMap(options) || options.light.defaultLight == DefaultLight::None) return "";
  RenderOptions saved = options;
  takePose(saved, {});
  const bool shines = fileLightOf(saved, loaded.scene, nullptr, nullptr).own == OwnLight::Enough;
  if (loaded.environment.kind == Surroundings::Map) return shines ? "--studio" : "";
  return loaded.environment.kind == Surroundings::None && !shines ? "--no-default-light" : "";
}

/// Describes the hit in words, a line a fact: node, mesh, triangle, place, and the material's name.
std::vector<std::string> pickLines(const Scene& scene, const Pick& pick) {
  std::vector<std::string> lines;
  lines.push_back("node " + pick.node);
  if (!pick.mesh.empty())
    lines.push_back("mesh " + pick.mesh + ", triangle " + std::to_string(pick.triangle));
  lines.push_back(
      formatted("at %.4g, %.4g, %.4g; %.4g m away", pick.point.x, pick.point.y, pick.point.z, pick.distance));
  lines.push_back(formatted("normal %.3f, %.3f, %.3f", pick.normal.x, pick.normal.y, pick.normal.z));
  if (pick.material >= scene.materials.size()) return lines;
  const Material& material = scene.materials[pick.material];
  lines.push_back("material " + std::to_string(pick.material) +
                  (material.name.empty() ? "" : ": " + material.name));
  return lines;
}

struct Cancelled {};

/// What the window knows of a scene.
ViewedScene viewedOf(const LoadedScene& loaded, const Statistics& stats, const RenderOptions& options) {
  ViewedScene viewed;
  viewed.options = options;
  // From now on the camera is named by its index, like cameras that are chosen in the window.
  viewed.options.camera.index = loaded.cameraIndex;
  viewed.options.selection.camera.clear();
  // A camera that was placed by the scene's vertices is also kept by its numbers.
  if (loaded.overrides.fit) {
    if (loaded.view.shadowFade != glm::dvec2(0.0)) viewed.options.light.shadowFade = loaded.view.shadowFade;
    viewed.options.camera.overrides = overridesOf(poseOf(loaded.camera, loaded.framed));
  }
  viewed.camera = loaded.camera;
  viewed.cameras = loaded.scene.cameras;
  viewed.bounds = loaded.scene.bounds;
  viewed.present = traitsOf(loaded.scene, loaded.environment);
  viewed.description = stats.scene;
  viewed.light = loaded.light;
  const double exposure = exposureOf(viewed.options, loaded.light);
  if (exposure != 0.0) viewed.exposure = exposure;
  viewed.refersToFiles = loaded.scene.refersToFiles;
  viewed.surroundings = loaded.environment.kind;
  viewed.environments = environmentsNear(options);
  viewed.nodes = loaded.scene.nodes;
  viewed.materials = loaded.scene.materials;
  viewed.lights = loaded.scene.lightSources;
  viewed.sceneNames = loaded.scene.sceneNames;
  viewed.materialVariants = loaded.scene.materialVariants;
  viewed.animationNames = loaded.scene.animationNames;
  viewed.animationSeconds = loaded.scene.animationSeconds;
  return viewed;
}

/// Loads a scene, and reports its progress.
LoadResult loadViewed(const RenderOptions& options, Exchange& exchange, const BackgroundJob& job) {
  LoadResult result;
  result.viewed.options = options;
  const auto progress = [&](const std::string& step, double fraction) {
    const LoadStatus status{true, options.scene.filename().string(), step, fraction};
    if (!job.report([&] { exchange.set(&TraceStatus::load, status); })) throw Cancelled();
  };
  try {
    SceneBefore before;
    before.document = &result.document;
    // Numbers that the user sets are set later: the window shows the file's, too.
    RenderOptions plain = options;
    plain.selection.set.clear();
    if (!options.selection.set.empty()) checkChange(options.scene, options.selection.set);
    for (const std::string& warning : warningsOf(options.selection.set)) say(options, "warning: " + warning);
    Statistics stats;
    auto loaded = std::make_unique<LoadedScene>(loadScene(plain, stats, progress, FilmOf::Picture, before));
    RenderOptions unlit = plain;
    unlit.light.studio = unlit.light.sky.on = false;
    unlit.light.hdriFile.clear();
    const FileLight light =
        hasMap(options) ? fileLightOf(unlit, loaded->scene, nullptr, &result.document) : loaded->light;
    result.viewed = viewedOf(*loaded, stats, options);
    result.viewed.defaultLight = light.own != OwnLight::Enough;
    progress("packing", 0.9);
    result.scene = std::move(loaded);
  } catch (const Cancelled&) {
  } catch (...) {
    result.error = std::current_exception();
  }
  return result;
}

/// Delivers a small picture of each environment (empty: the studio).
void makeThumbnails(const std::vector<std::filesystem::path>& files, uint64_t memoryLimit, Exchange& exchange,
                    const BackgroundJob& job) {
  for (const std::filesystem::path& file : files) {
    if (job.cancelled()) return;
    EnvironmentThumbnail thumbnail{file, {}};
    try {
      thumbnail.image = thumbnailOf(file.empty() ? studioLight() : readLinearImage(file, memoryLimit).image);
    } catch (const std::exception&) {
      // A file that cannot be read is reported when it is chosen.
    }
    job.report([&] { exchange.deliver(std::move(thumbnail)); });
  }
}

}  // namespace

ViewTracer::ViewTracer(const ViewOptions& start, std::optional<OidnLibrary> oidn, Exchange& exchange)
    : start_(start), exchange_(exchange), oidn_(std::move(oidn)), clock_(start.waitsForPasses) {
  passOnWhatIsSaid([&exchange](const std::string& text) { exchange.deliver(text); });
}

void ViewTracer::run(const SharedContexts& shared) {
  try {
    enterContext(shared);
    bool working = false;
    for (;;) {
      Requests requests = exchange_.wait(working ? 0.0 : start_.watch ? kWatchSeconds : kLongWait);
      if (requests.quit) break;
      try {
        carryOut(std::move(requests));
        takeLoaded();
        takeCompiled();
        watchFiles();
        if (loaded_ && sides_.empty() && !request_.sides.empty()) setRequest(request_);
        working = work();
      } catch (const ContextLost& error) {
        recover(error);
        working = true;
      }
      exchange_.set(&TraceStatus::request, request_.number);
      exchange_.set(&TraceStatus::resting, !working && !request_.moving && !awaitsProgram());
      for (const std::string& message : driverLog_->take()) exchange_.deliver("driver: " + message);
    }
  } catch (...) {
    exchange_.fail(std::current_exception());
  }
  loading_.cancel();
  for (Background<bool>& one : thumbnails_) one.cancel();
  leaveContext();
}

void ViewTracer::enterContext(const SharedContexts& shared) {
  const DeviceOptions& device = start_.render.device;
  const auto open = [&](bool shares) {
    context_.reset();
    shares_ = shares;
    context_ = shares ? makeContext(*shared.draws) : makeContext(device);
  };
  open(shared.draws && device.backend == Backend::Auto && device.device.empty());
  // A window may be drawn by software though there is a GPU, as over a network.
  if (shares_ && context_->software && mayHaveGpu()) {
    open(false);
    if (context_->software) open(true);
  }
  compiles_ = shares_ && keepsCompiled(*context_) ? shared.compiles : std::nullopt;
  if (start_.render.output.verbose)
    exchange_.deliver(shares_ ? "pictures stay on the device: " + context_->renderer
                              : "pictures are copied: they are drawn by " + context_->renderer + " (" +
                                    context_->backend + ")");
  if (!context_->software) clock_.askDevice();
  resolution_ = controllerFor(context_->software);
  if (start_.movingMs)
    resolution_.targetMs =
        *start_.movingMs > 0.0 ? *start_.movingMs : std::numeric_limits<double>::infinity();
  driverLog_ = std::make_unique<DebugLog>();
  maker_ = std::make_unique<PictureMaker>(start_.render.device.shaderFolder, oidn_, clock_);
}

/// Makes again what was in the context, in another one, which may be lost meanwhile, too.
void ViewTracer::recover(ContextLost error) {
  for (;;) {
    if (++losses_ > kMostLosses) throw ContextLost(error);
    exchange_.deliver(std::string(error.what()) + "; drawing anew");
    try {
      leaveContext();
      enterContext({});
      if (loaded_) makePrograms();
      return;
    } catch (const ContextLost& again) {
      error = again;
    }
  }
}

void ViewTracer::makePrograms() {
  std::optional<CompileAside> aside;
  if (compiles_) aside = CompileAside{*compiles_, [this] { exchange_.wakeTracer(); }};
  programs_ = std::make_unique<ViewPrograms>(*context_, *loaded_, loadedOptions_, std::move(aside));
}

/// Called in the thread that owns the context.
void ViewTracer::leaveContext() {
  sides_.clear();
  shown_ = {};
  programs_.reset();
  clock_.forgetDevice();
  maker_.reset();
  driverLog_.reset();
  context_.reset();
}

void ViewTracer::carryOut(Requests requests) {
  if (requests.load && *requests.load) {
    loadError_.clear();
    load(**requests.load);
  } else if (requests.load) {
    loading_.cancel();
    exchange_.set(&TraceStatus::load, {});
  }
  if (requests.trace && loaded_) setRequest(*requests.trace);
  if (requests.thumbnails) {
    thumbnails_.emplace_back().start("thumbnails",
                                     [files = *requests.thumbnails, limit = start_.render.limits.memoryBytes,
                                      &exchange = exchange_](const BackgroundJob& job) {
                                       makeThumbnails(files, limit, exchange, job);
                                       return true;
                                     });
  }
  if (requests.reference) takeReference(*requests.reference);
  for (SaveRequest& save : requests.saves) saves_.push_back(std::move(save));
  if (requests.model && loaded_) saveModel(*requests.model);
  if (requests.pick && loaded_) answer(*requests.pick);
}

/// A load before it is cancelled, and ends at its next step.
void ViewTracer::load(const RenderOptions& options) {
  loading_.start(
      "load",
      [options, &exchange = exchange_](const BackgroundJob& job) {
        return loadViewed(options, exchange, job);
      },
      [&exchange = exchange_] { exchange.wakeTracer(); });
}

void ViewTracer::takeLoaded() {
  std::optional<LoadResult> result = loading_.take();
  if (!result) return;
  exchange_.set(&TraceStatus::load, {});
  if (result->error) {
    loadError_ = whatFailed(result->error, !loaded_, result->viewed.options.scene);
    exchange_.set(&TraceStatus::error, loadError_);
    return;
  }
  sides_.clear();
  programs_.reset();
  tree_.reset();
  selected_ = {};
  loaded_ = std::move(result->scene);
  document_ = std::move(result->document);
  loadedOptions_ = result->viewed.options;
  posed_ = loadedOptions_;
  posed_.selection.set.clear();
  posed_.camera.resolution = loaded_->size;
  wasText_ = false;
  fileMaterials_ = result->viewed.materials;
  fileLights_ = result->viewed.lights;
  loaded_->decoding = [this](size_t decoded, size_t count) {
    reportWork("compiling, " + std::to_string(decoded) + " of " + std::to_string(count) +
               " textures decoded");
  };
  makePrograms();
  loadError_.clear();
  exchange_.set(&TraceStatus::error, {});
  exchange_.deliver(std::move(result->viewed));
  if (!start_.watch) return;
  std::vector<std::filesystem::path> files = inputsOf(loadedOptions_);
  for (const auto& file : inputsOf(loaded_->scene)) files.push_back(file);
  for (const auto& file : filesIn(loadedOptions_.scene.parent_path(), ".bin")) files.push_back(file);
  sceneFiles_ = FileWatch(files);
  shaderFiles_ = FileWatch(filesUnder(start_.render.device.shaderFolder));
}

void ViewTracer::watchFiles() {
  if (!start_.watch || !loaded_ || steadyMilliseconds() - watched_ < 1000.0 * kWatchSeconds) return;
  watched_ = steadyMilliseconds();
  if (sceneFiles_.changed()) {
    RenderOptions again = posed_;
    again.camera = loadedOptions_.camera;
    load(again);
  }
  if (shaderFiles_.changed()) rebuildPrograms();
}

/// The shaders have changed; what cannot be compiled now stays as it was.
void ViewTracer::rebuildPrograms() {
  programs_->forget();
  maker_ = std::make_unique<PictureMaker>(start_.render.device.shaderFolder, oidn_, clock_);
  for (Side& side : sides_) {
    const std::shared_ptr<ViewProgram> wanted = programFor(side.options, false);
    if (!wanted->error.empty()) return;
    side.program = wanted;
    side.stale = true;
  }
}

/// The options for a scene that is posed again: its triangles are no shader text, which would be compiled
/// each time.
RenderOptions ViewTracer::asPosed(RenderOptions options) const {
  const SceneSelection& s = options.selection;
  const bool changes = s.animationTime || !s.hiddenNodes.empty() || !loaded_->scene.strokes.empty() ||
                       (!s.set.empty() && wasText_);
  if (changes && options.device.traversal == TraversalMethod::Auto)
    options.device.traversal = TraversalMethod::FrontToBack;
  return options;
}

void ViewTracer::renew(const TraceRequest& request) {
  const RenderOptions& wanted = request.sides[0];
  const bool relit = posed_.light.sky.on && differIn(Renewal::Surroundings, posed_, wanted);
  if (relit) relight(wanted.light.sky);
  RenderOptions next = posed_;
  takePose(next, wanted);
  next.camera.overrides = wanted.camera.overrides;
  next.camera.index = wanted.camera.index;
  next.camera.resolution = request.size;
  const bool otherStrokes =
      !loaded_->scene.strokes.empty() && !request.moving && !seesStrokesAlike(posed_, next);
  const bool posed = renewalBetween(posed_, next) > Renewal::Surroundings || otherStrokes;
  if (posed && !setSurfaces(next, request.sides)) pose(next);
  if (!relit && !posed) return;
  for (Side& side : sides_) side.stale = true;
}

void ViewTracer::pose(const RenderOptions& wanted) {
  const bool sameNodes = posed_.selection.hiddenNodes == wanted.selection.hiddenNodes;
  posed_ = wanted;
  RenderOptions options = asPosed(wanted);
  options.camera.sceneOrigin = loaded_->scene.space.origin;
  if (!sameNodes) reportWork("updating the scene");
  std::vector<std::string> repeated;
  const SaidHere silence(repeated);  // loading the scene has said it
  try {
    Statistics stats;
    SceneBefore before;
    before.environment = &loaded_->environment;
    before.light = loaded_->light;
    if (tree_ && sameNodes) before.tree = &*tree_;
    before.document = &document_;
    before.volume = &loaded_->scene.volume;
    programs_->waitForCompiler();
    *loaded_ = loadScene(options, stats, {}, FilmOf::Picture, before);
    if (!stats.treeRefitted && loaded_->scene.instances.empty())
      tree_ = refittable(loaded_->bvh, loaded_->scene);
    programs_->show(Renewed::Pose, options);
    exchange_.deliver(PosedScene{loaded_->scene.bounds, loaded_->environment.kind});
    selected_.outlined.reset();
    if (!selected_.nodes.empty()) selected_.bounds = boundsOfNodes(loaded_->scene, selected_.nodes);
  } catch (const ContextLost&) {
    throw;
  } catch (const std::exception& error) {
    exchange_.set(&TraceStatus::error, error.what());  // the picture shown stays
  }
  if (!sameNodes) exchange_.set(&TraceStatus::note, {});
}

void ViewTracer::relight(const SkyOptions& sky) {
  if (whyDark(posed_.light.sky).empty() && !whyDark(sky).empty()) exchange_.deliver(whyDark(sky));
  posed_.light.sky = sky;
  const auto shines = [&] {
    const std::optional<SunDisc>& sun = loaded_->environment.sun;
    return sun && luminance(sun->irradiance) > 0.0;
  };
  const bool shone = shines();
  std::vector<std::string> repeated;
  const SaidHere silence(repeated);  // it is reported above
  programs_->waitForCompiler();
  loaded_->environment = skyOf(posed_, repeated);
  // When the sun rises or sets, programs change: light paths begin at it (Trait::Caustics).
  programs_->show(shines() == shone ? Renewed::Surroundings : Renewed::Pose, posed_);
}

void ViewTracer::setRequest(const TraceRequest& request) {
  // The window does not know of the scene that has just been loaded.
  if (request.sides.front().scene != loadedOptions_.scene) return;
  request_ = request;
  const auto isText = [](const Side& side) {
    return side.program && side.program->tracer.variant.traversal == TraversalMethod::Literals;
  };
  wasText_ = wasText_ || std::ranges::any_of(sides_, isText);
  for (RenderOptions& side : request_.sides) side = asPosed(side);
  renew(request_);
  if (request.moving) keepMoving(resolution_, request.size);
  sides_.resize(request.sides.size());
  for (size_t i = 0; i < sides_.size(); ++i) setSide(sides_[i], request_.sides[i]);
  noteAnswered();
}

// Numbers of the file that the viewer's user sets: their way into the scene that is drawn, and into a file.

bool ViewTracer::setSurfaces(const RenderOptions& wanted, const std::vector<RenderOptions>& sides) {
  const auto isText = [](const RenderOptions& side) {
    return side.device.traversal == TraversalMethod::Literals;
  };
  // An animation may drive the same numbers, and lines are built again for another camera.
  if (wanted.selection.animationTime || differIn(Renewal::Pose, posed_, wanted) ||
      !loaded_->scene.strokes.empty() || std::ranges::any_of(sides, isText))
    return false;
  const auto traits = [&](const Scene& scene) { return traitsOf(scene, loaded_->environment); };
  const TraitSet before = traits(loaded_->scene);
  programs_->waitForCompiler();
  if (!setByEye(loaded_->scene, fileMaterials_, fileLights_, wanted.selection.set) ||
      traits(loaded_->scene) != before)
    return false;
  takeStep(posed_, wanted, Renewal::Surfaces);
  programs_->show(Renewed::Surfaces, posed_);
  return true;
}

void ViewTracer::saveModel(const std::filesystem::path& path) {
  const std::vector<SetNumber>& set = request_.sides.front().selection.set;
  try {
    writeChanged(loadedOptions_.scene, path, set);
    exchange_.deliver(SavedModel{set});
    exchange_.deliver("wrote " + path.string());
    if (const std::string light = lightToName(posed_, *loaded_); !light.empty())
      exchange_.deliver("the emission that was set decides how that file is lit: render it with " + light +
                        " to see it as here");
  } catch (const std::exception& error) {
    exchange_.deliver(std::string("not written: ") + error.what());
  }
}

// The tracing thread's knowledge of a place of the picture, and of what was selected there.

void ViewTracer::answer(const PickRequest& request) {
  if (request.clear) return select({});
  PickAnswer answer;
  answer.request = request;
  Selected chosen;
  const Scene& scene = loaded_->scene;
  const auto choose = [&](uint32_t node, NodeSet nodes) {
    answer.node = node;
    answer.bounds = boundsOfNodes(scene, nodes);
    chosen = {std::move(nodes), answer.bounds};
  };
  const Side* side = request.side < sides_.size() ? &sides_[request.side] : nullptr;
  if (request.node) {
    choose(*request.node, nodesBelow(scene, *request.node));
    const auto node = std::ranges::find(scene.nodes, *request.node, &SceneNode::index);
    if (node != scene.nodes.end()) answer.lines = {"node " + node->name};
    const bool hidden = node != scene.nodes.end() && node->hidden;
    if (answer.bounds.empty()) answer.lines.emplace_back(hidden ? "it is hidden" : "it draws nothing");
  } else {
    if (!side || !side->program) return;
    const Projection projection = projectionOf(side->view.camera, double(request_.size.x) / request_.size.y);
    const glm::dvec2 place(2.0 * request.place.x - 1.0, 1.0 - 2.0 * request.place.y);
    if (const std::optional<Pick> pick = pickAt(scene, loaded_->bvh, projection, place)) {
      answer.hit = true;
      answer.point = pick->point;
      answer.lines = pickLines(scene, *pick);
      if (pick->material < scene.materials.size()) answer.material = pick->material;
      NodeSet nodes(size_t(pick->nodeIndex) + 1);
      nodes[pick->nodeIndex] = true;
      choose(pick->nodeIndex, std::move(nodes));
    } else {
      answer.lines = {"nothing is there"};
    }
  }
  if (request.use == PickUse::Select) select(std::move(chosen));
  exchange_.deliver(std::move(answer));
}

/// Its outline is drawn over the pictures from now on.
void ViewTracer::select(Selected selected) {
  if (selected_.nodes.empty() && selected.nodes.empty()) return;
  selected_ = std::move(selected);
  for (Side& side : sides_) {
    if (side.program && !side.stale && side.samples > 0) publish(side);
  }
}

std::vector<PictureLine> ViewTracer::linesOver(const Side& side) {
  std::vector<PictureLine> lines = treeLines(side.options, *loaded_, side.view.camera, request_.size);
  // Straight edges are curves in a panorama and a fisheye, which have no outline.
  if (selected_.bounds.empty() || !isRectilinear(side.view.camera.type)) return lines;
  const LocalSpace& space = loaded_->scene.space;
  const Projection projection = projectionOf(side.view.camera, double(request_.size.x) / request_.size.y);
  if (selected_.outlined != std::pair(projection, request_.size)) {
    selected_.outline = outlineOfNodes(loaded_->scene, selected_.nodes, projection, request_.size);
    selected_.outlined = {projection, request_.size};
  }
  std::vector<PictureLine> around = selected_.outline;
  if (around.empty()) {
    Bounds box;
    box.include(glm::vec3(space.localOf(selected_.bounds.minimum)));
    box.include(glm::vec3(space.localOf(selected_.bounds.maximum)));
    around = boxEdges({&box, 1}, projection, space);
  }
  lines.insert(lines.end(), around.begin(), around.end());
  return lines;
}

}  // namespace fragtrace
