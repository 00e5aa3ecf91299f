// SPDX-License-Identifier: MIT
#include "session/setup.h"

#include <cmath>
#include <future>

#include "bvh/large_first.h"
#include "bvh/two_level.h"
#include "errors.h"
#include "gl/driver_choice.h"
#include "gl/schedule.h"
#include "gltf/gltf.h"
#include "image/files/process.h"
#include "image/format.h"
#include "image/image.h"
#include "pack/literals.h"
#include "pack/own_light.h"
#include "pack/pack_textures.h"
#include "pack/pack_tree.h"
#include "process/parallel.h"
#include "session/outputs.h"
#include "session/picture_memory.h"

namespace fragtrace {

namespace {

/// Smaller scenes are literals as a whole, or not at all.
constexpr size_t kLeastBesideLarge = 256;

/// Refuses what would not leave shaders room to multiply lengths (src/gltf/build/gltf.cpp): in the options,
/// if the camera's place is theirs, or in the file.
void checkDistance(const Camera& camera, const LocalSpace& space, const RenderOptions& options) {
  constexpr double kFarthest = 1e12;  // local space
  const double size = camera.perspective ? 0.0 : camera.halfHeight * std::max(1.0, camera.aspectRatio);
  if (!(std::max(glm::length(camera.position - space.origin), size) <= kFarthest * space.unit)) {
    const std::string reason =
        "the camera is too far away for a scene of this size, or sees too much of its surroundings";
    if (options.camera.position || options.camera.parallelScale || options.sceneOrigin)
      throw UsageError(reason);
    throw InputError(options.scene.string() + ": " + reason);
  }
}

glm::ivec2 chooseSize(const Camera& camera, const RenderOptions& options) {
  if (options.resolution) return *options.resolution;
  if (camera.aspectRatio <= 0.0) return {1280, 720};
  return {std::clamp(int(std::lround(720.0 * camera.aspectRatio)), 1, 16384), 720};
}

/// The region asked for, else all of the picture.
Region chooseRegion(glm::ivec2 size, const RenderOptions& options) {
  const Region region = options.region.value_or(Region{{0, 0}, size});
  if (glm::all(glm::lessThanEqual(region.size, size - region.corner))) return region;
  const auto text = [](glm::ivec2 v, const char* between) {
    return std::to_string(v.x) + between + std::to_string(v.y);
  };
  throw UsageError("--region: " + text(region.corner, ",") + "," + text(region.size, ",") +
                   " is not inside the picture of " + text(size, " x ") + " pixels");
}

/// Throws InputError for the first pixel that is NaN or infinite.
void checkFinite(const Image& image, const std::filesystem::path& path) {
  for (size_t i = 0; i < image.values.size(); ++i) {
    if (std::isfinite(image.values[i])) continue;
    const size_t pixel = i / image.channelCount();
    throw InputError(path.string() + ": pixel (" + std::to_string(pixel % size_t(image.width)) + ", " +
                     std::to_string(pixel / size_t(image.width)) + ") is not finite");
  }
}

void warn(const RenderOptions& options, const std::string& what, std::vector<std::string>& warnings) {
  warnings.push_back(options.hdriFile.string() + what);
  say(options, "warning: " + warnings.back());
}

Environment makeEnvironment(const RenderOptions& options, std::future<LinearImage>& map, OwnLight light,
                            std::vector<std::string>& warnings) {
  Environment environment;
  if (map.valid()) {
    LinearImage read = map.get();
    environment.kind = Surroundings::Map;
    environment.image = std::move(read.image);
    const Image& image = environment.image;
    if (image.channelCount() < 3) throw InputError(options.hdriFile.string() + ": has no colour");
    checkFinite(image, options.hdriFile);
    if (read.wasEncoded)
      warn(options, ": holds no light above 1, so no sun and no lamp; an .hdr, .exr or .pfm does", warnings);
    // Mirror balls and faces of cubes are square; there is one reading of an environment here.
    if (image.width == image.height && image.width > 1)
      warn(options, ": is square, and drawn as latitude and longitude: 360 degrees wide, 180 high", warnings);
  } else if (options.defaultLight && light != OwnLight::Enough) {
    environment.kind = Surroundings::DefaultLight;
    environment.image = {1, 1, {"R", "G", "B"}, {1.0f, 1.0f, 1.0f}, {}};
  }
  return environment;
}

/// FNV-1a over the words of all buffers.
uint64_t hashOf(const GpuScene& scene) {
  uint64_t hash = 0xcbf29ce484222325u;
  for (const Words& buffer : scene.buffers) {
    for (const uint32_t word : buffer) hash = (hash ^ word) * 0x100000001b3u;
    hash = (hash ^ buffer.size()) * 0x100000001b3u;
  }
  return hash;
}

/// Only trees hold instances.
bool walksTree(const RenderOptions& options) {
  return options.traversal != TraversalMethod::Iterative && options.traversal != TraversalMethod::Literals;
}

bool besideAllowed(const RenderOptions& options) {
  return options.traversal == TraversalMethod::Auto && !has(options.stages, Stage::BvhHeatmap);
}

}  // namespace

double pathsOf(const RenderOptions& options, glm::ivec2 size) {
  const bool adaptive = options.noise > 0.0 || options.seconds > 0.0;
  return double(size.x) * size.y * (adaptive ? std::numeric_limits<double>::infinity() : options.spp);
}

View makeView(const RenderOptions& options, const Scene& scene, const Camera& camera) {
  View view;
  view.camera = camera;
  view.space = scene.space;
  view.hdriRotation = glm::radians(options.hdriRotationDegrees);
  if (options.background) view.background = options.backgroundColor.value_or(glm::vec3(0.0f));
  view.showEnvironment = seesEnvironment(options);
  view.bounces = options.bounces;
  view.rouletteDepth = options.rouletteDepth;
  view.seed = options.seed;
  view.sampleOffset = options.sampleOffset;
  view.clampIndirect = float(options.clampIndirect);
  return view;
}

Bvh buildTree(const Scene& scene, const RenderOptions& options) {
  if (!scene.instances.empty()) {
    if (!walksTree(options))
      throw UsageError("--traversal: only trees hold the meshes that this scene shares");
    return buildSceneBvh(scene);
  }
  if (options.traversal == TraversalMethod::Iterative) return listLeaves(scene);
  std::vector<Bounds> bounds = primitiveBounds(scene);
  const uint32_t triangles = uint32_t(scene.triangles.size());
  std::vector<uint32_t> large;
  if (besideAllowed(options) && bounds.size() >= kLeastBesideLarge) large = largeTriangles(bounds, triangles);
  if (large.empty()) return buildBvh(std::move(bounds), triangles);
  Bvh bvh = buildBvh(bounds, triangles);
  Bvh beside = buildBvhBeside(bounds, triangles, large);
  return paysBeside(bvh, beside) ? beside : bvh;
}

bool sameTree(const RenderOptions& a, const RenderOptions& b) {
  const auto iterative = [](const RenderOptions& o) { return o.traversal == TraversalMethod::Iterative; };
  return iterative(a) == iterative(b) && besideAllowed(a) == besideAllowed(b);
}

namespace {

GltfOptions gltfOptionsOf(const RenderOptions& options) {
  GltfOptions loading;
  loading.recenterOn = options.sceneOrigin ? options.sceneOrigin : options.camera.focalPoint;
  loading.cameraPosition = options.camera.position;
  loading.cameraIndex = options.cameraIndex.value_or(0);
  loading.selection = options.selection;
  loading.instancing = walksTree(options) ? options.instancing : Instancing::Flatten;
  loading.limits = options.limits;
  return loading;
}

void sayDefaultLight(const RenderOptions& options, OwnLight light, Statistics& stats) {
  stats.defaultLightReason = light == OwnLight::None
                                 ? "no light in the scene"
                                 : "the scene's emissive textures are too dim to light it";
  say(options, stats.defaultLightReason +
                   ": a white environment that the camera does not see lights it (--no-default-light)");
}

}  // namespace

LoadedScene loadScene(const RenderOptions& options, Statistics& stats, const LoadProgress& progress,
                      FilmOf film) {
  const auto step = [&](const char* name, double fraction) {
    if (progress) progress(name, fraction);
  };
  Stopwatch watch;
  step("reading the scene", 0.0);
  LoadedScene loaded;
  // The environment is decoded in another process, so it is read meanwhile.
  Phase reading;  // outlives the thread that sets it
  std::future<LinearImage> map;
  if (!options.hdriFile.empty()) {
    map = std::async(kThreadIfGranted, [&] {
      PhaseTimer timer("environment", "second");
      LinearImage image = readLinearImage(options.hdriFile, options.limits.memoryBytes);
      image.image = wholeOf(std::move(image.image));
      reading = timer.end();
      return image;
    });
  }
  PhaseTimer sceneTimer("scene");
  loaded.scene = loadGltf(options.scene, gltfOptionsOf(options));
  stats.phases.push_back(sceneTimer.end());
  if (options.instancing == Instancing::Share && !walksTree(options))
    loaded.scene.warnings.emplace_back("--instancing share: only trees hold shared meshes; all are copied");
  if (!loaded.scene.images.empty()) startImageProcess();
  const Scene& scene = loaded.scene;
  checkOutputs(outputsOf(options), inputsOf(scene));
  for (const std::string& warning : scene.warnings) say(options, "warning: " + warning);
  if (scene.triangles.empty() && scene.spheres.empty()) {
    say(options, "warning: " + options.scene.string() + ": no triangle and no sphere, nothing to draw");
  }
  loaded.cameraIndex = cameraIndexOf(options.cameraIndex, options.selection.camera, scene.cameras);
  loaded.camera =
      chooseCamera(scene.cameras, loaded.cameraIndex, options.camera, scene.bounds, framedAspect(options));
  checkDistance(loaded.camera, scene.space, options);
  loaded.size = chooseSize(loaded.camera, options);
  loaded.region = chooseRegion(loaded.size, options);
  if (film == FilmOf::Picture) checkFilmMemory(options, loaded.region.size);
  loaded.view = makeView(options, scene, loaded.camera);
  stats.loadMs = watch.lap();
  step("building the tree", 0.5);
  PhaseTimer treeTimer("tree");
  loaded.bvh = buildTree(scene, options);
  stats.phases.push_back(treeTimer.end());
  stats.bvh = bvhQuality(loaded.bvh);
  stats.bvhBuildMs = watch.lap();
  step("reading the environment", 0.9);
  const bool isAsked = options.hdriFile.empty() && options.defaultLight;
  const OwnLight light = isAsked ? ownLight(scene) : OwnLight::Enough;
  loaded.environment = makeEnvironment(options, map, light, loaded.scene.warnings);
  if (!options.hdriFile.empty()) stats.phases.push_back(reading);
  stats.scene = describe(scene);
  stats.warnings = scene.warnings;
  stats.size = loaded.region.size;
  stats.region = options.region;
  stats.loadMs += watch.lap();
  stats.defaultLight = loaded.environment.kind == Surroundings::DefaultLight;
  if (stats.defaultLight) sayDefaultLight(options, light, stats);
  return loaded;
}

void useLiterals(const LoadedScene& loaded, const GpuScene& packed, const RenderOptions& options,
                 ShaderVariant& variant) {
  if (loaded.bvh.besideTree > 0) {
    variant.literals = largeFirst(loaded.scene, loaded.bvh, variant);
    return;
  }
  if (variant.feature != Feature::None) return;
  const bool asked = options.traversal == TraversalMethod::Literals;
  if (has(variant.stages, Stage::BvhHeatmap)) {
    if (asked) throw UsageError("--traversal literals: has no tree whose nodes the heat map could count");
    return;
  }
  if (!asked && options.traversal != TraversalMethod::Auto) return;
  // Who asks for the wavefront gets it, which needs a tree.
  if (!asked && options.schedule == Schedule::Wavefront && has(variant.stages, Stage::Gi)) return;
  const std::string reason = asked ? whyNoLiterals(loaded.scene, packed) : "";
  if (!reason.empty()) throw UsageError("--traversal literals: " + reason);
  if (!asked && !paysAsLiterals(loaded.scene, loaded.bvh, packed, pathsOf(options, loaded.size))) return;
  variant.traversal = TraversalMethod::Literals;
  variant.literals = literalScene(loaded.scene, loaded.bvh, packed, variant);
}

namespace {

/// What the packed scene and the driver decide of a picture's variant. Returns why the megakernel draws.
std::string settleVariant(ShaderVariant& variant, const LoadedScene& loaded, const GpuScene& packed,
                          const RenderOptions& options, const Context& context, BufferReads reads) {
  useLiterals(loaded, packed, options, variant);
  variant.reads = reads;
  variant.dispatch =
      chooseDispatch(options.dispatch, context, variant.traversal == TraversalMethod::Literals);
  return chooseSchedule(variant, options,
                        {context.software, pathsOf(options, loaded.size), loaded.bvh.nodes.size()});
}

Phase buildProgram(ProgramCache& programs, const ShaderVariant& variant) {
  PhaseTimer timer("program");
  programs.tracer(variant);
  return timer.end();
}

/// Builds the picture's program while its scene is being packed, unless the scene may become part of its
/// text. Where buffers turn out too large for the fastest reads, another one is built later.
std::optional<Phase> buildAhead(ProgramCache& programs, ShaderVariant variant, const LoadedScene& loaded,
                                const RenderOptions& options, const Context& context) {
  const bool asked = options.traversal == TraversalMethod::Literals;
  const bool large = loaded.scene.triangles.size() > kLeastBesideLarge;
  if (asked || !large) return std::nullopt;
  const GpuScene unknown;
  const BufferReads reads = chooseReads(options.bufferReads, context.software, unknown, readLimits()).reads;
  settleVariant(variant, loaded, unknown, options, context, reads);
  return buildProgram(programs, variant);
}

}  // namespace

Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats) {
  const bool kept = options.checkpointSeconds > 0.0 || options.resume;
  return makeTracer(context, loaded, options, stats,
                    kept || formatOfName(options.output) == ImageFormat::OpenExr);
}

Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats, bool withHash) {
  const TraitSet present = traitsOf(loaded.scene, loaded.environment.kind);
  const uint32_t depth = loaded.bvh.depth;
  const BufferReads undecided = options.bufferReads;  // what is packed does not depend on it
  Tracer tracer;
  tracer.variant = choosePictureVariant(options, present, loaded.environment.kind, depth, undecided);
  ShaderVariant everything = tracer.variant;
  for (const Feature feature : options.aovFeatures) {
    tracer.features.push_back(
        chooseFeatureVariant(options, present, loaded.environment.kind, depth, undecided, feature));
    everything.traits |= tracer.features.back().traits;
  }
  if (tracer.variant.clampIndirect) stats.clampIndirect = options.clampIndirect;
  stats.backend = context.backend;
  stats.glRenderer = context.renderer;
  stats.glVersion = context.version;
  for (const StageRow& row : stageRows()) {
    const std::string reason = has(options.stages, row.stage) ? whyOff(row.stage, present) : "";
    if (!reason.empty()) stats.skipped.push_back(std::string(row.name) + ": " + reason);
  }
  const int textureSide = textureSideWithin(loaded.scene, mostTexelBytes(options.bufferReads, readLimits()));
  if (textureSide < kLargestTextureSide) {
    say(options, "warning: the textures are larger than what this driver reads; those wider or higher than " +
                     std::to_string(textureSide) + " pixels are scaled down");
  }
  ProgramCache programs(shaderSource(options.shaderFolder));
  Phase packing;  // outlives the thread that sets it
  std::future<GpuScene> packedLater = std::async(kThreadIfGranted, [&] {
    PhaseTimer timer("pack", "second");
    GpuScene scene = packScene(loaded.scene, loaded.bvh, loaded.environment, everything, textureSide);
    packing = timer.end();
    return scene;
  });
  const std::optional<Phase> ahead = buildAhead(programs, tracer.variant, loaded, options, context);
  GpuScene packed = packedLater.get();
  stats.phases.push_back(packing);
  stats.packMs = packing.end - packing.begin;
  stats.sceneBytes = packed.bytes();
  stats.geometryBytes = packed.geometryBytes();
  if (withHash) tracer.sceneHash = hashOf(packed);
  const ReadChoice choice = chooseReads(options.bufferReads, context.software, packed, readLimits());
  stats.scheduleReason = settleVariant(tracer.variant, loaded, packed, options, context, choice.reads);
  const Phase building = ahead ? *ahead : buildProgram(programs, tracer.variant);
  stats.phases.push_back(building);
  tracer.programMs = building.end - building.begin;
  stats.compileMs += tracer.programMs;
  for (ShaderVariant& feature : tracer.features) {
    useLiterals(loaded, packed, options, feature);
    feature.reads = choice.reads;
    feature.dispatch = chooseDispatch(options.dispatch, context, false);
  }
  stats.variant = variantName(tracer.variant);
  stats.readFallback = choice.fallback;
  PhaseTimer uploading("upload");
  tracer.renderer = std::make_unique<Renderer>(context, std::move(packed), choice.reads, std::move(programs));
  stats.phases.push_back(uploading.end());
  stats.uploadMs = stats.phases.back().end - stats.phases.back().begin;
  return tracer;
}

void releaseGeometry(LoadedScene& loaded) {
  loaded.scene.triangles = std::vector<Triangle>();
  loaded.scene.vertices = Vertices();
  loaded.scene.instances = std::vector<Instance>();
  loaded.scene.images = std::vector<EncodedImage>();
  loaded.bvh = Bvh();
}

}  // namespace fragtrace
