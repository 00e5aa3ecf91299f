// SPDX-License-Identifier: MIT
#include "view/live/view_tracer.h"

#include <limits>

#include "base/timeline.h"
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

/// Describes a scene to the window.
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
        if (session_.isLoaded() && sides_.empty() && !request_.sides.empty()) setRequest(request_);
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
      if (session_.isLoaded()) makePrograms();
      return;
    } catch (const ContextLost& again) {
      error = again;
    }
  }
}

void ViewTracer::makePrograms() {
  std::optional<CompileAside> aside;
  if (compiles_) aside = CompileAside{*compiles_, [this] { exchange_.wakeTracer(); }};
  session_.openPrograms(*context_, std::move(aside));
}

/// Called in the thread that owns the context.
void ViewTracer::leaveContext() {
  sides_.clear();
  shown_ = {};
  session_.forgetTracer();
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
  if (requests.trace && session_.isLoaded()) setRequest(*requests.trace);
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
  if (requests.model && session_.isLoaded()) saveModel(*requests.model);
  if (requests.pick && session_.isLoaded()) answer(*requests.pick);
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
    loadError_ = whatFailed(result->error, !session_.isLoaded(), result->viewed.options.scene);
    exchange_.set(&TraceStatus::error, loadError_);
    return;
  }
  sides_.clear();
  selected_ = {};
  const RenderOptions options = result->viewed.options;
  loadedCamera_ = options.camera;
  session_.open(std::move(*result->scene), std::move(result->document), options);
  session_.loaded().decoding = [this](size_t decoded, size_t count) {
    reportWork("compiling, " + std::to_string(decoded) + " of " + std::to_string(count) +
               " textures decoded");
  };
  makePrograms();
  loadError_.clear();
  exchange_.set(&TraceStatus::error, {});
  exchange_.deliver(std::move(result->viewed));
  if (!start_.watch) return;
  std::vector<std::filesystem::path> files = inputsOf(options);
  for (const auto& file : inputsOf(session_.loaded().scene)) files.push_back(file);
  for (const auto& file : filesIn(options.scene.parent_path(), ".bin")) files.push_back(file);
  sceneFiles_ = FileWatch(files);
  shaderFiles_ = FileWatch(filesUnder(start_.render.device.shaderFolder));
}

void ViewTracer::watchFiles() {
  if (!start_.watch || !session_.isLoaded() || steadyMilliseconds() - watched_ < 1000.0 * kWatchSeconds)
    return;
  watched_ = steadyMilliseconds();
  if (sceneFiles_.changed()) {
    RenderOptions again = session_.options();
    again.camera = loadedCamera_;
    load(again);
  }
  if (shaderFiles_.changed()) rebuildPrograms();
}

/// The shaders have changed; what cannot be compiled now stays as it was.
void ViewTracer::rebuildPrograms() {
  session_.programs().forget();
  maker_ = std::make_unique<PictureMaker>(start_.render.device.shaderFolder, oidn_, clock_);
  for (Side& side : sides_) {
    const std::shared_ptr<SceneProgram> wanted = programFor(side.options, false);
    if (!wanted->error.empty()) return;
    side.program = wanted;
    side.stale = true;
  }
}

void ViewTracer::renew(const TraceRequest& request) {
  const RenderOptions& before = session_.options();
  RenderOptions wanted = request.sides[0];
  wanted.camera.resolution = request.size;
  const bool hasSky = before.light.sky.on && wanted.light.sky.on;
  if (hasSky && whyDark(before.light.sky).empty() && !whyDark(wanted.light.sky).empty())
    exchange_.deliver(whyDark(wanted.light.sky));
  const bool sameNodes = before.selection.hiddenNodes == wanted.selection.hiddenNodes;
  if (!sameNodes) reportWork("updating the scene");
  Renewal renewed = Renewal::Pose;
  try {
    renewed = session_.renewScene(wanted, request.moving);
    const LoadedScene& loaded = session_.loaded();
    if (renewed == Renewal::Pose) {
      exchange_.deliver(PosedScene{loaded.scene.bounds, loaded.environment.kind});
      selected_.outlined.reset();
      if (!selected_.nodes.empty()) selected_.bounds = boundsOfNodes(loaded.scene, selected_.nodes);
    }
  } catch (const ContextLost&) {
    throw;
  } catch (const std::exception& error) {
    exchange_.set(&TraceStatus::error, error.what());  // the picture shown stays
  }
  if (!sameNodes) exchange_.set(&TraceStatus::note, {});
  if (renewed == Renewal::None) return;
  for (Side& side : sides_) side.stale = true;
}

void ViewTracer::setRequest(const TraceRequest& request) {
  // The window does not know of the scene that has just been loaded.
  if (request.sides.front().scene != session_.options().scene) return;
  request_ = request;
  for (RenderOptions& side : request_.sides) side = session_.asPosed(side);
  renew(request_);
  if (request.moving) keepMoving(resolution_, request.size);
  sides_.resize(request.sides.size());
  for (size_t i = 0; i < sides_.size(); ++i) setSide(sides_[i], request_.sides[i]);
  noteAnswered();
}

void ViewTracer::saveModel(const std::filesystem::path& path) {
  const std::vector<SetNumber>& set = request_.sides.front().selection.set;
  try {
    writeChanged(session_.options().scene, path, set);
    exchange_.deliver(SavedModel{set});
    exchange_.deliver("wrote " + path.string());
    if (const std::string light = lightToName(session_.options(), session_.loaded()); !light.empty())
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
  const Scene& scene = session_.loaded().scene;
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
    if (const std::optional<Pick> pick = pickAt(scene, session_.loaded().bvh, projection, place)) {
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
  std::vector<PictureLine> lines =
      treeLines(side.options, session_.loaded(), side.view.camera, request_.size);
  // Straight edges are curves in a panorama and a fisheye, which have no outline.
  if (selected_.bounds.empty() || !isRectilinear(side.view.camera.type)) return lines;
  const LocalSpace& space = session_.loaded().scene.space;
  const Projection projection = projectionOf(side.view.camera, double(request_.size.x) / request_.size.y);
  if (selected_.outlined != std::pair(projection, request_.size)) {
    selected_.outline = outlineOfNodes(session_.loaded().scene, selected_.nodes, projection, request_.size);
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
