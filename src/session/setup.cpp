// SPDX-License-Identifier: MIT
#include "session/setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <iterator>
#include <limits>
#include <ranges>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/component_wise.hpp>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "bvh/build.h"
#include "bvh/bvh.h"
#include "image/files/process.h"
#include "image/files/video_format.h"
#include "image/format.h"
#include "image/image.h"
#include "options/check_render.h"
#include "options/option_row.h"
#include "pack/literals.h"
#include "pack/pack_tree.h"
#include "pack/textures/pack_textures.h"
#include "scene/camera.h"
#include "scene/describe.h"
#include "scene/fit.h"
#include "scene/solids.h"
#include "scene/strokes.h"
#include "scene/volume/read_grid.h"
#include "session/environment.h"
#include "session/outputs.h"
#include "session/shutter.h"
#include "session/tracer.h"

namespace fragtrace {

namespace {

/// Refuses what would not leave shaders room to multiply lengths (src/gltf/assemble/gltf.cpp): in the
/// options, if the camera's place is theirs, or in the file.
void checkDistance(const Camera& camera, const LocalSpace& space, const RenderOptions& options) {
  constexpr double kFarthest = 1e12;  // local space
  const bool parallel = camera.type == CameraType::Orthographic;
  const double size = !parallel ? 0.0 : camera.halfHeight * std::max(1.0, camera.aspectRatio);
  if (!(std::max(glm::length(camera.position - space.origin), size) <= kFarthest * space.unit)) {
    const std::string reason =
        "the camera is too far away for a scene of this size, or sees too much of its surroundings";
    for (const char* name : {"--camera-position", "--camera-parallel-scale", "--scene-origin"}) {
      if (!rowOf(name).isDefault(options)) throw UsageError(std::string(name) + ": " + reason);
    }
    throw InputError(options.scene.string() + ": " + reason);
  }
}

/// The region asked for, else all of the picture.
Region chooseRegion(glm::ivec2 size, const RenderOptions& options) {
  const Region region = options.camera.region.value_or(Region{{0, 0}, size});
  if (glm::all(glm::lessThanEqual(region.size, size - region.corner))) return region;
  const auto text = [](glm::ivec2 v, const char* between) {
    return std::to_string(v.x) + between + std::to_string(v.y);
  };
  throw UsageError("--region: " + text(region.corner, ",") + "," + text(region.size, ",") +
                   " is not inside the picture of " + text(size, " x ") + " pixels");
}

/// Only trees hold instances.
bool walksTree(const RenderOptions& options) {
  return options.device.traversal != TraversalMethod::Iterative &&
         options.device.traversal != TraversalMethod::Literals;
}

/// Poses refit the tree by whole triangles, and text has each triangle once.
bool mayCutLong(const Scene& scene) {
  return scene.animationNames.empty() && scene.triangles.size() > kLeastBesideLarge;
}

bool besideAllowed(const RenderOptions& options) {
  return options.device.traversal == TraversalMethod::Auto && options.output.debugView != DebugView::Visits;
}

/// The height of the shadow catcher's plane (Y, metres).
double catcherHeightOf(const RenderOptions& options, const BoundsDouble& bounds) {
  return options.light.catcherHeight.value_or(bounds.empty() ? 0.0 : bounds.minimum.y);
}

}  // namespace

Camera fitCamera(const Camera& camera, const FittedPoints& points, const CameraOverrides& overrides,
                 glm::ivec2 size) {
  const auto seesCatcher = [&](const Camera& from) {
    const bool parallel = from.type == CameraType::Orthographic;
    return parallel ? from.forward.y < 0.0 : from.position.y > points.catcherHeight;
  };
  const double aspect = double(size.x) / size.y;
  const double share = overrides.fill.value_or(kFitted);
  Camera result = fitted(camera, points.scene, aspect, share);
  if (!points.shadow.empty() && seesCatcher(result)) {
    std::vector<glm::dvec3> all = points.scene;
    all.insert(all.end(), points.shadow.begin(), points.shadow.end());
    const Camera farther = fitted(camera, all, aspect, share);
    if (seesCatcher(farther)) result = farther;
  }
  return zoomed(result, overrides.orbit.value_or(Orbit()).zoom);
}

glm::ivec2 chooseSize(const Camera& camera, const RenderOptions& options) {
  if (options.camera.resolution) return *options.camera.resolution;
  if (camera.aspectRatio <= 0.0) return {1280, 720};
  const VideoFormat* const video = videoFormatOf(options.output.file);
  const int step = video != nullptr && video->evenSize ? 2 : 1;
  return {std::clamp(int(std::lround(720.0 * camera.aspectRatio)) / step * step, step, 16384), 720};
}

double pathsOf(const RenderOptions& options, glm::ivec2 size) {
  return double(size.x) * size.y * options.sampling.spp;
}

bool isInStudio(const RenderOptions& options, const LoadedScene& loaded) {
  return loaded.environment.kind == Surroundings::Map && options.light.hdriFile.empty() &&
         !options.light.sky.on;
}

Bvh buildTree(const Scene& scene, const RenderOptions& options) {
  if (scene.motion.segments > 0) return buildMovingBvh(scene);
  if (!scene.instances.empty()) {
    if (!walksTree(options))
      throw UsageError("--traversal: only trees hold the meshes that this scene shares");
    return buildSceneBvh(scene);
  }
  if (options.device.traversal == TraversalMethod::Iterative) return listLeaves(scene);
  std::vector<Bounds> bounds = primitiveBounds(scene);
  const uint32_t triangles = uint32_t(scene.triangles.size());
  if (mayCutLong(scene)) {
    if (std::vector<BuildItem> pieces = cutLong(scene, bounds); !pieces.empty())
      return buildFromItems(std::move(pieces), triangles);
  }
  std::vector<uint32_t> large;
  if (besideAllowed(options) && bounds.size() >= kLeastBesideLarge) large = largeTriangles(bounds, triangles);
  // Literals know neither of coincidence nor of alpha.
  std::erase_if(large, [&](uint32_t i) {
    const Triangle& t = scene.triangles[i];
    return t.reach > 0 || scene.materials[t.material].testsAlpha();
  });
  if (large.empty()) return buildBvh(std::move(bounds), triangles);
  Bvh bvh = buildBvh(bounds, triangles);
  Bvh beside = buildBvhBeside(bounds, triangles, large);
  return paysBeside(bvh, beside) ? beside : bvh;
}

bool sameTree(const RenderOptions& a, const RenderOptions& b) {
  const auto iterative = [](const RenderOptions& o) {
    return o.device.traversal == TraversalMethod::Iterative;
  };
  return iterative(a) == iterative(b) && besideAllowed(a) == besideAllowed(b);
}

GltfOptions gltfOptionsOf(const RenderOptions& options) {
  GltfOptions loading;
  loading.recenterOn =
      options.camera.sceneOrigin ? options.camera.sceneOrigin : options.camera.overrides.focalPoint;
  loading.cameraPosition = options.camera.overrides.position;
  loading.cameraIndex = options.camera.index.value_or(0);
  loading.selection = options.selection;
  const bool flattens = !walksTree(options) || shutterSeconds(options) > 0.0;
  loading.instancing = !flattens ? options.device.instancing : Instancing::Flatten;
  loading.limits = options.limits;
  loading.readsVolume = options.volume.file.empty();
  return loading;
}

namespace {

/// Warns of lights of the scene that a shadow catcher cannot show.
void checkCatcher(const RenderOptions& options, const FileLight& light, Scene& scene) {
  constexpr size_t kMostLights = 1000;  // each of them is asked at every point
  if (!options.light.shadowCatcher) return;
  if (!has(options.stages, Stage::Gi)) {
    scene.warnings.emplace_back("--shadow-catcher: only stage gi has it");
    return;
  }
  if (scene.lights.size() > kMostLights)
    throw UsageError("--shadow-catcher: the scene has " + std::to_string(scene.lights.size()) +
                     " lights, at most " + std::to_string(kMostLights) + " can be caught");
  const bool isLit =
      hasMap(options) || !scene.lights.empty() || options.light.defaultLight == DefaultLight::None;
  if (isLit || countedLight(options, light) != OwnLight::Enough) return;
  const auto emits = [&](const auto& primitive) { return scene.materials[primitive.material].emissive(); };
  if (std::ranges::any_of(scene.triangles, emits) || std::ranges::any_of(scene.spheres, emits))
    scene.warnings.push_back(
        options.scene.string() +
        ": only emissive surfaces light it, whose shadows --shadow-catcher does not show "
        "(--studio)");
}

/// A plane that catches no shadow, most likely, since it is farther away than the scene is large.
void checkCatcherPlace(const RenderOptions& options, Scene& scene) {
  const std::optional<double>& height = options.light.catcherHeight;
  if (!options.light.shadowCatcher || !height || scene.bounds.empty()) return;
  const double below = scene.bounds.minimum.y - *height;
  const double size = glm::length(scene.bounds.extent());
  if (std::abs(below) <= size) return;
  scene.warnings.push_back(
      formatted("--shadow-catcher: the plane is %.3g m %s the bottom of the scene, whose diagonal is %.3g m",
                std::abs(below), below > 0.0 ? "below" : "above", size));
}

/// A camera whose rays begin on a plane that cuts a solid: that of an orthographic view, or a lens.
void checkCameraPlane(const RenderOptions& options, LoadedScene& loaded) {
  const Camera& camera = loaded.camera;
  const LocalSpace& space = loaded.scene.space;
  const Projection seen = projectionOf(camera, double(loaded.size.x) / loaded.size.y);
  const double lens = loaded.view.lens.radius;
  const bool parallel = camera.type == CameraType::Orthographic;
  if (!has(options.stages, Stage::Refraction) || !(parallel || lens > 0.0)) return;
  const glm::dvec3 right = parallel ? seen.right : lens * glm::normalize(seen.right);
  const glm::dvec3 up = parallel ? seen.up : lens * glm::normalize(seen.up);
  const glm::dvec3 middle = camera.position + seen.shift.x * right + seen.shift.y * up;
  if (!crossesSolid(loaded.scene.solids, {space.localOf(middle), right / space.unit, up / space.unit}))
    return;
  loaded.scene.warnings.push_back(
      std::string(parallel ? "the plane from which the orthographic camera looks" : "the lens") +
      " cuts a solid that lets light in: all rays count as beginning " +
      (loaded.view.cameraSolids == layout::kPrimitiveNone ? "outside" : "inside") +
      ", as the camera's position is (--camera-position moves it)");
}

/// Makes fog from the options, around a scene with these bounds.
Fog fogOf(const FogOptions& options, const BoundsDouble& bounds) {
  constexpr double kReach = 1.5;  // the reach in radii of the ball round the scene's box
  Fog fog;
  fog.extinction = options.density;
  fog.albedo = options.color.value_or(glm::vec3(1.0f));
  fog.anisotropy = float(options.anisotropy);
  fog.height = options.height.value_or(fog.height);
  fog.base = options.base.value_or(bounds.empty() ? 0.0 : bounds.minimum.y);
  if (!bounds.empty()) fog.center = bounds.center();
  fog.radius = options.distance.value_or(kReach * 0.5 * glm::length(bounds.extent()));
  return fog;
}

/// Fog so thick that paths are long, and that nearly nothing is seen through it.
void checkFogDepth(const RenderOptions& options, Scene& scene) {
  constexpr double kMost = 20.0;  // mean free paths
  const Fog fog = fogOf(options.fog, scene.bounds);
  const double depth = 2.0 * fog.radius;
  if (!has(options.stages, Stage::Gi) || options.fog.height || fog.extinction * depth <= kMost) return;
  scene.warnings.push_back(formatted(
      "--fog-density: light goes %.2g m on average in fog that is %.3g m deep (--fog-distance): little "
      "is seen, and paths are long; a density of %.1g is a haze",
      1.0 / fog.extinction, depth, 1.0 / depth));
}

/// Options of an environment, where there is none, or one that is alike on all sides.
void checkMapOptions(const RenderOptions& options, OwnLight light, Scene& scene) {
  const bool byDefault = light != OwnLight::Enough;
  const bool map = hasMap(options) || (byDefault && options.light.defaultLight == DefaultLight::Studio);
  const auto check = [&](const char* name, bool hasUse) {
    if (hasUse || rowOf(name).isDefault(options)) return;
    scene.warnings.push_back(std::string(name) +
                             ": the scene is lit by no --hdri-file, no --sky and no studio (--studio)");
  };
  check("--hdri-rotation", map);
  check("--hdri-intensity", map || byDefault);
}

/// Says what lights the scene, and notes it.
void addLight(const RenderOptions& options, const LoadedScene& loaded, FilmOf film, Statistics& stats) {
  sayLight(options, loaded.light, film == FilmOf::Part);
  stats.defaultLightReason = defaultLightReason(options, loaded.light);
  stats.defaultLight = !stats.defaultLightReason.empty();
  if (!loaded.scene.lights.empty())
    stats.lampUnits = loaded.light.lampScale == 1.0 ? "photometric" : "radiometric";
  stats.exposure = exposed(options, loaded.light).output.exposure;
}

/// Says the warnings of the scene, with those about options in vain, and of a node far off, if the scene is
/// framed.
void sayWarnings(const RenderOptions& options, bool isFramed, Scene& scene) {
  std::ranges::move(vainOptions(options), std::back_inserter(scene.warnings));
  for (const std::string& vain : setInVain(scene, options.selection))
    scene.warnings.push_back("--set: " + vain);
  if (const std::string stray = isFramed ? strayNode(scene) : ""; !stray.empty())
    scene.warnings.push_back(options.scene.string() + ": " + stray);
  for (const std::string& warning : scene.warnings) say(options, "warning: " + warning);
  if (const std::string empty = whyEmpty(scene, options.selection); !empty.empty())
    say(options, "warning: " + options.scene.string() + ": " + empty);
}

/// The tree: an earlier one refitted, if it fits the scene, or a new one.
Bvh refitOrBuild(const RefittableTree* earlier, const Scene& scene, const RenderOptions& options,
                 Statistics& stats) {
  PhaseTimer timer("tree");
  std::optional<Bvh> tree;
  if (earlier != nullptr) tree = refitted(*earlier, scene);
  stats.treeRefitted = tree.has_value();
  Bvh bvh = tree ? std::move(*tree) : buildTree(scene, options);
  stats.phases.push_back(timer.end());
  stats.bvh = bvhQuality(bvh);
  return bvh;
}

/// The file's scene with its volume.
Scene readScene(const RenderOptions& options, const LoadProgress& progress, const SceneBefore& before,
                Statistics& stats) {
  PhaseTimer timer("scene");
  GltfOptions loading = gltfOptionsOf(options);
  loading.progress = progress;
  Scene scene = loadGltf(options.scene, loading, before.document);
  stats.phases.push_back(timer.end());
  const bool readsVolume = !options.volume.file.empty() || !scene.volume.source.file.empty();
  if (readsVolume && progress) progress("reading the volume", 0.48);
  placeVolume(scene, options, before.volume);
  if (options.device.instancing == Instancing::Share && !walksTree(options))
    scene.warnings.emplace_back("--instancing share: only trees hold shared meshes; all are copied");
  if (!scene.images.empty()) startImageProcess();
  return scene;
}

/// Reads the environment's map in another thread, which sets `reading` at its end.
std::future<LinearImage> startMap(const RenderOptions& options, Phase& reading) {
  return std::async(kThreadIfGranted, [&options, &reading] {
    PhaseTimer timer("environment", "second");
    LinearImage image = readMap(options);
    reading = timer.end();
    return image;
  });
}

}  // namespace

glm::dvec2 shadowFadeOf(const RenderOptions& options, const CameraOverrides& settled, const Camera& camera,
                        std::span<const glm::dvec3> points, glm::ivec2 size) {
  constexpr double kLeast = 0.08;
  constexpr double kFoot = 0.1;  // of the height
  const bool fades = options.light.shadowCatcher && settled.fit && !settled.fitShadow;
  if (options.light.shadowFade || !fades || points.empty())
    return options.light.shadowFade.value_or(glm::dvec2(0.0));
  const Projection projection = projectionOf(camera, double(size.x) / size.y);
  const auto ends = std::ranges::minmax(points, {}, &glm::dvec3::y);
  glm::dvec2 filled(0.0);
  for (const glm::dvec3& point : points) {
    if (point.y > glm::mix(ends.min.y, ends.max.y, kFoot)) continue;
    const glm::dvec3 place = projected(projection, point);
    filled = glm::max(filled, place.z > 0.0 ? glm::abs(glm::dvec2(place) / place.z) : glm::dvec2(1.0));
  }
  const glm::dvec2 sides = glm::dvec2(size) / double(std::min(size.x, size.y));
  return glm::max(0.5 * (1.0 - glm::min(filled, 1.0)) * sides, kLeast);
}

FittedPoints pointsToFit(const Scene& scene, const Environment& environment, const RenderOptions& options,
                         const CameraOverrides& overrides) {
  FittedPoints points;
  points.scene = outlineOf(scene, overrides.fitTo);
  points.bounds = scene.bounds;
  if (overrides.leavesStrays) {
    const size_t all = points.scene.size();
    points.scene = withoutStrays(std::move(points.scene));
    points.strays = all - points.scene.size();
  }
  if (points.strays > 0 || !overrides.fitTo.empty()) {
    points.bounds = {};
    for (const glm::dvec3& point : points.scene) points.bounds.include(point);
  }
  if (!fitsShadow(options, overrides)) return points;
  points.catcherHeight = catcherHeightOf(options, scene.bounds);
  points.shadow = shadowOutline(farthest(points.scene), points.catcherHeight,
                                caughtLights(scene, environment, options, points.catcherHeight));
  return points;
}

void aim(LoadedScene& loaded, const RenderOptions& options, FilmOf film) {
  const Scene& scene = loaded.scene;
  loaded.cameraIndex = cameraIndexOf(options.camera.index, options.selection.camera, scene.cameras);
  const CameraOverrides& overrides = loaded.overrides = settledOverrides(options.camera.overrides, scene);
  FittedPoints points;
  if (overrides.fit) points = pointsToFit(scene, loaded.environment, options, overrides);
  loaded.strays = points.strays;
  loaded.framed = overrides.fit ? points.bounds : scene.bounds;
  loaded.camera =
      chooseCamera(scene.cameras, loaded.cameraIndex, overrides, loaded.framed, framedAspect(options.camera));
  loaded.size = chooseSize(loaded.camera, options);
  if (overrides.fit) {
    for (std::vector<glm::dvec3>* some : {&points.scene, &points.shadow}) {
      if (overrides.turns) *some = sweptAbout(turningPoint(loaded.camera, overrides, loaded.framed), *some);
    }
    loaded.camera = fitCamera(loaded.camera, points, overrides, loaded.size);
  }
  loaded.shadowFade = shadowFadeOf(options, overrides, loaded.camera, points.scene, loaded.size);
  if (options.camera.lens.fStop && loaded.camera.type == CameraType::Orthographic)
    throw UsageError("--f-stop: the camera is orthographic, and has no lens");
  checkDistance(loaded.camera, scene.space, options);
  loaded.region = chooseRegion(loaded.size, options);
  if (film == FilmOf::Picture) checkFilmMemory(options, loaded.region.size);
  loaded.view = makeView(options, loaded, loaded.camera);
}

namespace {

/// Adds what hangs on the camera, and warns of what it leaves out.
void addByCamera(LoadedScene& loaded, const RenderOptions& options) {
  if (loaded.strays > 0)
    loaded.scene.warnings.push_back(
        "the default view leaves out " + countText(loaded.strays, "point") +
        " of the scene, far away from all others; --fit moves the camera until all are in the picture");
  addGround(loaded.scene, options, loaded.scene.bounds);
  addStrokes(loaded.scene, loaded.camera, loaded.size, options.camera.lineWidth);
  checkCatcherPlace(options, loaded.scene);
  checkFogDepth(options, loaded.scene);
  checkCameraPlane(options, loaded);
}

/// Decides who lights the scene, by the tree of the file's surfaces where there is one already.
void settleLight(LoadedScene& loaded, const RenderOptions& options, const Bvh* tree,
                 const SceneBefore& before, Statistics& stats) {
  PhaseTimer timer("light");
  // The document holds the key times of its latest pose, which the shutter reads.
  const auto document = shutterSeconds(options) > 0.0 ? nullptr : before.document;
  loaded.light = before.light ? *before.light : fileLightOf(options, loaded.scene, tree, document);
  setLampScale(loaded.scene, loaded.light.lampScale);
  stats.phases.push_back(timer.end());
}

/// loadScene() into `loaded`, which has the environment of before already, if there is one.
void loadInto(LoadedScene& loaded, const RenderOptions& options, Statistics& stats,
              const LoadProgress& progress, FilmOf film, SceneBefore before) {
  const auto step = [&](const std::string& name, double fraction) {
    if (progress) progress(name, fraction);
  };
  Stopwatch watch;
  step("reading the scene", 0.0);
  // Another process decodes the environment, so this thread loads the scene meanwhile.
  Phase reading;  // outlives the thread that sets it
  std::future<LinearImage> map;
  const bool readsMap = !options.light.hdriFile.empty() && !before.environment;
  if (readsMap) map = startMap(options, reading);
  const bool opens = shutterSeconds(options) > 0.0;
  std::shared_ptr<KeptDocument> posed;  // read once for all poses of the shutter
  if (opens && before.document == nullptr) before.document = &posed;
  loaded.scene = readScene(options, progress, before, stats);
  const Scene& scene = loaded.scene;
  checkOutputs(outputsOf(options), inputsOf(scene));
  std::vector<std::string> ofEnvironment;  // warnings, which are printed at once
  const auto settleEnvironment = [&] {
    PhaseTimer timer("sky");
    if (!before.environment)
      loaded.environment = makeEnvironment(options, map, countedLight(options, loaded.light), ofEnvironment);
    if (!options.light.sky.on) return;
    stats.phases.push_back(timer.end());
    stats.sun = sunOf(options.light.sky);
  };
  // The tree is built while the map is decoded, unless the camera depends on the map. It serves the decision
  // about the light, too, where it holds the file's surfaces alone.
  const bool early = fitsShadow(options, settledOverrides(options.camera.overrides, scene));
  const bool apart = early || options.light.ground || !scene.strokes.empty() || opens;
  if (apart) settleLight(loaded, options, nullptr, before, stats);
  if (early) settleEnvironment();
  aim(loaded, options, film);
  addByCamera(loaded, options);
  stats.scene = describe(scene);
  if (opens) {
    step("reading the motion", 0.4);
    PhaseTimer timer("shutter");
    openShutter(loaded, options, *before.document, stats);
    stats.phases.push_back(timer.end());
  }
  stats.loadMs = watch.lap();
  step("building the tree", 0.5);
  loaded.bvh = refitOrBuild(scene.motion.segments > 0 ? nullptr : before.tree, scene, options, stats);
  stats.bvhBuildMs = watch.lap();
  if (!apart) settleLight(loaded, options, &loaded.bvh, before, stats);
  checkCatcher(options, loaded.light, loaded.scene);
  checkMapOptions(options, countedLight(options, loaded.light), loaded.scene);
  sayWarnings(options, loaded.overrides.fit && loaded.strays == 0, loaded.scene);
  step("reading the environment", 0.9);
  if (!early) settleEnvironment();
  std::ranges::move(ofEnvironment, std::back_inserter(loaded.scene.warnings));
  loaded.view = makeView(options, loaded, loaded.camera);
  if (readsMap) stats.phases.push_back(reading);
  stats.warnings = scene.warnings;
  stats.size = loaded.region.size;
  stats.region = options.camera.region;
  stats.loadMs += watch.lap();
  addLight(options, loaded, film, stats);
}

}  // namespace

LoadedScene loadScene(const RenderOptions& options, Statistics& stats, const LoadProgress& progress,
                      FilmOf film, SceneBefore before) {
  LoadedScene loaded;
  if (before.environment) loaded.environment = std::move(*before.environment);
  try {
    loadInto(loaded, options, stats, progress, film, before);
  } catch (...) {
    if (before.environment) *before.environment = std::move(loaded.environment);
    throw;
  }
  return loaded;
}

void releaseGeometry(LoadedScene& loaded) {
  loaded.scene.triangles = std::vector<Triangle>();
  loaded.scene.vertices = Vertices();
  loaded.scene.instances = std::vector<Instance>();
  loaded.scene.images = std::vector<EncodedImage>();
  loaded.scene.volume.grid.reset();
  loaded.bvh = Bvh();
}

namespace {

bool sameGrid(const VolumeSource& a, const VolumeSource& b) {
  return a.file == b.file && a.grid == b.grid && a.emits() == b.emits();
}

/// Replaces the members that the other sets.
void takeOver(VolumeSource& source, const VolumeSource& other) {
  const auto take = [](auto& value, const auto& from) {
    if (from) value = from;
  };
  if (!other.file.empty()) {
    source.file = other.file;
    source.grid = other.grid;
  }
  take(source.position, other.position);
  take(source.scale, other.scale);
  take(source.density, other.density);
  take(source.color, other.color);
  take(source.anisotropy, other.anisotropy);
  take(source.emission, other.emission);
}

/// The first option that says something of a grid but which; empty: none does.
std::string firstGiven(const RenderOptions& options) {
  for (const char* name : {"--volume-position", "--volume-scale", "--volume-density", "--volume-color",
                           "--volume-anisotropy", "--volume-emission"}) {
    if (!rowOf(name).isDefault(options)) return name;
  }
  return {};
}

/// Warns of grids that are not seen as their numbers promise, or that take long.
void warnOfVolume(const RenderOptions& options, Scene& scene) {
  constexpr double kMostDepth = 100.0;  // mean free paths
  const Volume& volume = scene.volume;
  const std::string name = volume.source.file.string() + ": ";
  if (!has(options.stages, Stage::Gi)) {
    scene.warnings.push_back(name + "only stage gi has grids of densities");
    return;
  }
  const glm::vec3 albedo = volume.source.color.value_or(glm::vec3(1.0f));
  if (volume.source.emits() && glm::compMin(albedo) >= 1.0f)
    scene.warnings.push_back(name + "only what absorbs light glows, and the color 1,1,1 absorbs none");
  const double extinction = volume.source.density.value_or(1.0) * volume.grid->largest;
  const std::array<glm::dvec3, 8> corners = volume.corners();
  double size = std::numeric_limits<double>::infinity();
  for (const size_t side : {1, 2, 4}) size = std::min(size, glm::distance(corners[0], corners[side]));
  if (extinction * size <= kMostDepth) return;
  scene.warnings.push_back(
      name + formatted("light goes %.2g m on average where the grid is densest, and the grid is %.3g m deep: "
                       "paths are long",
                       1.0 / extinction, size));
}

Lens lensOf(const RenderOptions& options, const Camera& camera, const BoundsDouble& bounds,
            const LocalSpace& space) {
  Lens lens;
  if (!options.camera.lens.fStop || camera.type != CameraType::Perspective) return lens;
  lens.radius = 0.5 * focalLengthOf(camera.fovY) / *options.camera.lens.fStop;
  const glm::dvec3 focalPoint = options.camera.overrides.focalPoint.value_or(focalPointOf(camera, bounds));
  lens.focusDistance =
      options.camera.lens.focusDistance.value_or(glm::dot(focalPoint - camera.position, camera.forward));
  // Beyond, rays are parallel, and the squares of longer ones are no floats.
  constexpr double kParallel = 0x1p50;  // local space
  lens.focusDistance = std::min(lens.focusDistance, kParallel * space.unit);
  lens.blades = options.camera.lens.blades;
  return lens;
}

}  // namespace

void placeVolume(Scene& scene, const RenderOptions& options, const Volume* before) {
  Volume& volume = scene.volume;
  // A grid of the options replaces the scene's, its node's place included.
  if (!options.volume.file.empty()) volume = Volume();
  const std::string given = firstGiven(options);
  if (!given.empty() && options.volume.file.empty() && volume.source.file.empty())
    throw UsageError(given + ": goes with --volume, or with a scene that brings a grid");
  takeOver(volume.source, options.volume);
  const VolumeSource& source = volume.source;
  if (source.file.empty()) return;
  if (options.light.shadowCatcher)
    throw UsageError("--shadow-catcher: its plane stands in clear air, but the scene brings a grid: " +
                     source.file.string());
  volume.toWorld = glm::translate(volume.toWorld, source.position.value_or(glm::dvec3(0.0)));
  volume.toWorld = glm::scale(volume.toWorld, glm::dvec3(source.scale.value_or(1.0)));
  volume.grid =
      before != nullptr && before->grid && sameGrid(before->source, source)
          ? before->grid
          : std::make_shared<const VolumeGrid>(readGrid(source, volume.file, options.limits.memoryBytes));
  volume.file = {};
  const bool hasSize = std::abs(glm::determinant(volume.voxelsToWorld())) > 0.0;
  if (volume.grid->empty() || !hasSize) {
    scene.warnings.push_back(source.file.string() + (hasSize ? ": the grid has no density above 0"
                                                             : ": the grid's node has no size"));
    volume.grid.reset();
    return;
  }
  for (const glm::dvec3& corner : volume.corners()) scene.bounds.include(corner);
  warnOfVolume(options, scene);
}

View makeView(const RenderOptions& options, const LoadedScene& loaded, const Camera& camera) {
  const Scene& scene = loaded.scene;
  View view;
  view.camera = camera;
  view.motion = loaded.motion;
  view.lens = lensOf(options, camera, loaded.framed, scene.space);
  view.space = scene.space;
  view.hdriRotation = glm::radians(environmentTurn(options.light));
  view.hdriIntensity = options.light.hdriIntensity;
  if (options.light.background) view.background = options.light.backgroundColor.value_or(glm::vec3(0.0f));
  const bool map = loaded.environment.kind == Surroundings::Map;
  view.showEnvironment = map && options.light.background && !options.light.backgroundColor;
  view.seesNothing = !options.light.background;
  view.cameraSolids = cameraSolids(scene.solids, scene.space.localOf(camera.position));
  view.volume = scene.volume;
  view.volume.grid.reset();
  view.fog = fogOf(options.fog, scene.bounds);
  view.catcherHeight = catcherHeightOf(options, scene.bounds);
  view.shadowFade = options.light.shadowFade.value_or(loaded.shadowFade);
  view.bounces = options.sampling.bounces;
  view.rouletteDepth = options.sampling.rouletteDepth;
  view.seed = options.sampling.seed;
  view.sampleOffset = options.sampling.sampleOffset;
  view.needsLightPaths = options.light.caustics == Caustics::On;
  view.clampIndirect = float(options.sampling.clampIndirect);
  return view;
}

}  // namespace fragtrace
