// SPDX-License-Identifier: MIT
#include "session/tracer.h"

#include <algorithm>
#include <future>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/text.h"
#include "base/words.h"
#include "gl/driver_choice.h"
#include "image/channels.h"
#include "pack/literals.h"
#include "pack/textures/texture_plan.h"
#include "render/film/film_pixels.h"
#include "scene/casters.h"
#include "scene/light_bounds.h"
#include "session/environment.h"
#include "session/outputs.h"
#include "session/say.h"
#include "shader/variant.h"

namespace fragtrace {

namespace {

/// A scene that is small enough becomes part of the shader's text, unless another traversal was asked for, or
/// first hits or visits are drawn.
/// Throws UsageError.
void useLiterals(const LoadedScene& loaded, const GpuScene& packed, const RenderOptions& options,
                 ShaderVariant& variant) {
  if (loaded.scene.motion.segments > 0) return;
  const bool asked = options.device.traversal == TraversalMethod::Literals;
  // Cones read the leaves.
  if (variant.rayCones && asked) throw UsageError("--traversal literals: not with --texture-filter cones");
  if (loaded.bvh.besideTree > 0) {
    variant.literals = largeFirst(loaded.scene, loaded.bvh, variant);
    return;
  }
  if (variant.aov != Aov::None && !isLightPart(variant.aov)) return;
  if (variant.countsVisits) {
    if (asked) throw UsageError("--traversal literals: has no tree whose nodes the heat map could count");
    return;
  }
  if (!asked && (options.device.traversal != TraversalMethod::Auto || variant.rayCones)) return;
  if (!options.output.lightGroups.empty()) {
    if (asked) throw UsageError("--traversal literals: not with --aov light:NAME, whose light is no literal");
    return;
  }
  // A wavefront that was asked for needs a tree, so there are no literals then.
  if (!asked && options.device.schedule == Schedule::Wavefront && has(variant.stages, Stage::Gi)) return;
  const std::string reason = asked ? whyNoLiterals(loaded.scene, packed) : "";
  if (!reason.empty()) throw UsageError("--traversal literals: " + reason);
  if (!asked && !paysAsLiterals(loaded.scene, loaded.bvh, packed, pathsOf(options, loaded.size))) return;
  variant.traversal = TraversalMethod::Literals;
  variant.literals = literalScene(loaded.scene, loaded.bvh, packed, variant);
}

/// Reads texels in a variant from where the plan places them.
void useTextures(const TexturePlan& textures, ShaderVariant& variant) {
  variant.textureArrays = textures.reads == TexelReads::Arrays;
  variant.texelBuffers = std::max(int(textures.sizes.size()), 1);
}

/// Settles the parts of a picture's variant that the packed scene and the driver decide. Returns why the
/// megakernel draws.
std::string settleVariant(ShaderVariant& variant, const LoadedScene& loaded, const GpuScene& packed,
                          const RenderOptions& options, const Context& context, BufferReads reads) {
  useLiterals(loaded, packed, options, variant);
  variant.reads = reads;
  useTextures(packed.textures, variant);
  variant.dispatch =
      chooseDispatch(options.device.dispatch, context, variant.traversal == TraversalMethod::Literals);
  variant.gpu = isForGpu(options.device.tune, context);
  return chooseSchedule(variant, options,
                        {context.software, pathsOf(options, loaded.size), loaded.bvh.nodes.size()});
}

/// Keeps the arrays that hold light, where light groups are asked for.
void keepForLightGroups(Tracer& tracer, const GpuScene& packed, const RenderOptions& options) {
  if (options.output.lightGroups.empty()) return;
  tracer.materials = packed.buffers[layout::kMaterialsBinding];
  tracer.lights = packed.buffers[layout::kLightsBinding];
}

Phase buildProgram(ProgramCache& programs, const ShaderVariant& variant) {
  PhaseTimer timer("program");
  programs.tracerProgram(variant);
  return timer.end();
}

/// Returns a hash of the hashes of all arrays. `arrays` already has those of unchanged arrays.
uint64_t sceneHash(const GpuScene& scene, ArrayHashes& arrays) {
  for (size_t i = 0; i < scene.buffers.size(); ++i) {
    if (!scene.unchanged[i]) arrays[i] = hashOf(scene.buffers[i]);
  }
  std::vector<uint64_t> pictures;
  for (const PackedPicture& picture : scene.pictures) pictures.push_back(hashOf(picture.words));
  if (!pictures.empty()) arrays.back() = hashOf(pictures);
  return hashOf(arrays);
}

void describeLightSelection(const ShaderVariant& variant, const LoadedScene& loaded, LightSelection wanted,
                            Statistics& stats) {
  if (!hasLamps(variant.traits) || !has(variant.stages, Stage::Gi)) return;
  const bool tree = has(variant.traits, Trait::LightTree);
  stats.lightSelection = variant.uniformLights ? "uniform" : tree ? "tree" : "power";
  stats.lightSelectionReason = "--light-selection";
  if (wanted != LightSelection::Auto) return;
  const double gain = gainByPlace(loaded.scene);
  const std::string times = formatted("%.3g times less", gain);
  stats.lightSelectionReason = tree           ? "chosen by place, light samples vary " + times
                               : gain < 1.005 ? "chosen by place, light samples would vary as much"
                               : loaded.environment.kind == Surroundings::DefaultLight
                                   ? "the scene is lit by default, not by its lamps"
                                   : "chosen by place, light samples would vary only " + times;
}

/// Returns true if light paths, which could begin at dim lamps alone, would bring nothing that is seen.
bool haveNothingToBring(const RenderOptions& options, const TraitSet& present, const LoadedScene& loaded) {
  return options.light.caustics == Caustics::Auto && has(present, Trait::Caustics) &&
         countedLight(options, loaded.light) == OwnLight::Dim && !samplesSun(present);
}

/// Returns true if the picture has fewer paths than are traced in the time that the program of light paths
/// takes to compile, and camera paths alone find the light of its casters, too. Clocks decide nothing.
bool isTooShortForLightPaths(const RenderOptions& options, const TraitSet& present,
                             const LoadedScene& loaded) {
  constexpr double kShortPicture = 3e6;  // paths
  return options.light.caustics == Caustics::Auto && has(present, Trait::Caustics) && !samplesSun(present) &&
         pathsOf(options, loaded.size) < kShortPicture && areLampsWide(loaded.scene, castersOf(loaded.scene));
}

/// Why light paths are traced for the picture, or are not.
std::string whyCaustics(const ShaderVariant& variant, const TraitSet& present, const RenderOptions& options) {
  if (has(variant.traits, Trait::Caustics)) {
    if (options.sampling.bounces == 0) return "--bounces";
    return options.light.caustics == Caustics::On
               ? "--caustics"
               : "there are lamps or a sun, and glass or metal that is smooth enough";
  }
  if (options.light.caustics == Caustics::Off) return "--caustics";
  if (!has(present, Trait::Caustics)) return traitRows()[size_t(Trait::Caustics)].absence;
  const std::string excluded = whyNoLightPaths(options, present);
  return excluded.empty() ? "a stage that they need is off" : excluded;
}

/// The options as this driver can draw such a scene; says what it cannot.
RenderOptions asDrawn(const RenderOptions& options, const TraitSet& present) {
  if (options.light.caustics == Caustics::Off || !has(present, Trait::Caustics) || canSplat()) return options;
  say(options,
      "warning: this driver cannot add points to 32-bit floats: caustics are left to paths from the camera");
  RenderOptions able = options;
  able.light.caustics = Caustics::Off;
  return able;
}

/// Four camera rays of a sample pay if light samples vary so many times less where lamps are chosen by place.
/// In the city, the corridor and many-lights (19, 63 and 6 times) they take 1.5 to 1.7 of the time for 0.4 to
/// 0.65 of the variance. In lights.gltf and water-cube.gltf (1.7 and 1.3) they take 2.2 and 1.6 of it for
/// 0.53 and 0.94.
constexpr double kLeastGainOfRays = 4.0;
constexpr int kRaysOfManyLamps = 4;

/// The options with the number of camera rays that the scene asks for.
RenderOptions withCameraRays(RenderOptions options, const TraitSet& present, const Scene& scene) {
  const bool chosen = options.sampling.cameraRays > 0;
  const bool tree = has(present, Trait::LightTree) && options.light.selection == LightSelection::Auto;
  if (!chosen && tree && gainByPlace(scene) >= kLeastGainOfRays)
    options.sampling.cameraRays = kRaysOfManyLamps;
  return options;
}

/// Returns true if light paths, which the scene has, give way to another option.
bool lightPathsGiveWay(const ShaderVariant& variant, const TraitSet& present, const RenderOptions& options) {
  return options.light.caustics == Caustics::Auto && !whyNoLightPaths(options, present).empty() &&
         has(present, Trait::Caustics) && has(variant.stages, Stage::Gi) &&
         has(variant.stages, Stage::Shadows);
}

/// Warns of options that change nothing in this picture, and of options that are turned off by others.
void warnOfNoEffect(const ShaderVariant& variant, const TraitSet& present, const RenderOptions& options,
                    Statistics& stats) {
  const auto warn = [&](const std::string& text) {
    stats.warnings.push_back(text);
    say(options, "warning: " + text);
  };
  const bool global = has(variant.stages, Stage::Gi);
  const bool lightPaths = has(variant.traits, Trait::Caustics) && options.sampling.bounces > 0;
  if (options.light.caustics == Caustics::On && !lightPaths)
    warn("--caustics on: no light paths: " + (global ? stats.lightPathReason : "only stage gi has them"));
  // A scene that is lit by default has lamps too dim to be missed.
  if (!stats.defaultLight && lightPathsGiveWay(variant, present, options))
    warn("no light paths for caustics (" + stats.lightPathReason +
         "): paths from the camera find fewer of them, and none of point, spot and directional lights");
  if (options.light.selection != LightSelection::Auto && stats.lightSelection.empty())
    warn(std::string("--light-selection: ") +
         (global ? "no lamp in the scene" : "only stage gi samples one light of many"));
  if (options.light.reuse != LightReuse::None && !variant.neighbours && !variant.lightCandidates)
    warn(std::string("--light-reuse: ") +
         (global ? "no light of this scene is sampled" : "only stage gi samples one light of many"));
  if (options.sampling.cameraRays > 1 && variant.cameraRays == 1)
    warn(std::string("--camera-rays: one per sample: ") +
         (global ? "media, a shadow catcher, --light-reuse and --debug-view have no more"
                 : "only stage gi has more"));
}

/// The variants that the options ask for, as far as the scene alone decides them. Returns what all of them
/// read.
ShaderVariant chooseVariants(Tracer& tracer, const LoadedScene& loaded, const RenderOptions& asked,
                             Statistics& stats) {
  const TraitSet present = traitsOf(loaded.scene, loaded.environment);
  RenderOptions options = asDrawn(asked, present);
  const char* const waste = haveNothingToBring(options, present, loaded) ? "lamps are too dim"
                            : isTooShortForLightPaths(options, present, loaded)
                                ? "few paths find the light of such wide lamps, too"
                                : nullptr;
  if (waste != nullptr) options.light.caustics = Caustics::Off;
  const RenderOptions drawn = withCameraRays(options, present, loaded.scene);
  // A tracer that draws keeps the stack of its programs: a pose with a lower tree needs no other ones.
  const uint32_t need =
      std::max(loaded.bvh.stackNeed, tracer.renderer ? uint32_t(tracer.variant.stackSize) : 0U);
  const BufferReads undecided = options.device.bufferReads;  // packed data do not depend on it
  tracer.variant = choosePictureVariant(drawn, present, loaded.environment.kind, need, undecided);
  ShaderVariant everything = tracer.variant;
  tracer.aovs.clear();
  for (const Aov aov : options.output.aovs) {
    tracer.aovs.push_back(chooseAovVariant(drawn, present, loaded.environment.kind, need, undecided, aov));
    everything.traits |= tracer.aovs.back().traits;
  }
  const bool gi = has(tracer.variant.stages, Stage::Gi);
  describeLightSelection(tracer.variant, loaded, options.light.selection, stats);
  if (gi)
    stats.lightReuse = tracer.variant.neighbours        ? "spatial"
                       : tracer.variant.lightCandidates ? "candidates"
                                                        : "none";
  stats.cameraRays = tracer.variant.cameraRays;
  if (gi) stats.lightPathReason = waste != nullptr ? waste : whyCaustics(tracer.variant, present, options);
  warnOfNoEffect(tracer.variant, present, options, stats);
  if (tracer.variant.clampIndirect) stats.clampIndirect = options.sampling.clampIndirect;
  for (const StageRow& row : stageRows()) {
    const std::string reason = has(options.stages, row.stage) ? whyOff(row.stage, present, gi) : "";
    if (!reason.empty()) stats.skipped.push_back(std::string(row.name) + ": " + reason);
  }
  const bool compensates = has(tracer.variant.stages, Stage::EnergyCompensation);
  if (compensates && has(tracer.variant.traits, Trait::RoughGlass) && !usesGlassTables(tracer.variant))
    stats.skipped.emplace_back(
        "energy-compensation of rough glass: the scene or --enable schlick changes what its facets reflect");
  return everything;
}

/// Settles the parts of all variants that the packed scene decides.
void settleVariants(Tracer& tracer, const LoadedScene& loaded, const GpuScene& packed,
                    const RenderOptions& options, const Context& context, Statistics& stats) {
  stats.scheduleReason = settleVariant(tracer.variant, loaded, packed, options, context, tracer.reads);
  for (ShaderVariant& aov : tracer.aovs) {
    useLiterals(loaded, packed, options, aov);
    aov.reads = tracer.reads;
    useTextures(packed.textures, aov);
    aov.dispatch = chooseDispatch(options.device.dispatch, context, false);
    aov.gpu = isForGpu(options.device.tune, context);
  }
  tracer.cones.clear();
  if (tracer.textures.levels == MipLevels::Later && readsTextures(tracer.variant.traits) &&
      tracer.variant.traversal != TraversalMethod::Literals) {
    tracer.cones = tracer.aovs;
    tracer.cones.insert(tracer.cones.begin(), tracer.variant);
    for (ShaderVariant& variant : tracer.cones) variant.rayCones = readsTextures(variant.traits);
  }
  stats.variant = variantName(tracer.variant);
  stats.countsWork = tracer.variant.countsWork;
}

/// Warns of textures that are scaled down.
void warnOfShrunk(const ShrunkTextures& shrunk, const RenderOptions& options, Statistics& stats) {
  if (shrunk.count == 0) return;
  stats.warnings.push_back(countText(shrunk.count, "texture") + " of up to " + std::to_string(shrunk.from) +
                           " pixels a side are scaled down to at most " + std::to_string(shrunk.to) +
                           ": together they are larger than what this driver holds");
  say(options, "warning: " + stats.warnings.back());
}

/// Makes room for the textures of the scene. Where a device has not enough memory, half as much is tried, and
/// so on. Returns where they are to be written.
TexelMemory prepareTextures(Tracer& tracer, const LoadedScene& loaded, const ShaderVariant& everything,
                            const RenderOptions& options, const Context& context, SceneTextures& textures,
                            bool later, Statistics& stats) {
  constexpr size_t kLeastBytes = size_t(16) << 20;  // that are worth another try
  TextureRoom room = textureRoom(options, context);
  if (later && room.levels == MipLevels::None && room.reads == TexelReads::Words)
    room.levels = MipLevels::Later;
  for (;; room.bytes = tracer.textures.bytes() / 2) {
    tracer.textures = planTextures(loaded.scene, everything.traits, room);
    if (room.levels == MipLevels::Later && tracer.textures.shrunk.count > 0) {
      // Level 0 has more detail.
      room.levels = MipLevels::None;
      tracer.textures = planTextures(loaded.scene, everything.traits, room);
    }
    if (tracer.textures.bytes() == 0) return {};
    try {
      TexelMemory memory = textures.prepare(tracer.textures);
      warnOfShrunk(tracer.textures.shrunk, options, stats);
      return memory;
    } catch (const RenderError&) {
      if (tracer.textures.bytes() < kLeastBytes) throw;
    }
  }
}

/// Warns of pictures that could not be decoded, or refuses them.
void sayBroken(const RenderOptions& options, const GpuScene& packed, Statistics& stats) {
  for (const std::string& reason : packed.brokenPictures) {
    if (!options.limits.drawMissingTextures)
      throw InputError(reason + " (--missing-textures magenta draws the scene without it)");
    if (options.limits.strict) throw InputError(reason + " (--strict refuses it)");
    stats.warnings.push_back(reason + "; a base colour is drawn in magenta, other textures are left out");
    say(options, "warning: " + stats.warnings.back());
  }
}

/// Notes the context and the packed scene for --stats.
void describe(Statistics& stats, const Context& context, const GpuScene& packed, const Phase& packing) {
  stats.backend = context.backend;
  stats.glRenderer = context.renderer;
  stats.glVersion = context.version;
  stats.vectorWidth = vectorWidthOf(context.renderer);
  stats.phases.push_back(packing);
  stats.packMs = packing.end - packing.begin;
  stats.casters = packed.casters.size();
  stats.cutOut = size_t(std::ranges::count(packed.cutOut, true));
  stats.sceneBytes = packed.bytes();
  stats.geometryBytes = packed.geometryBytes();
}

/// Builds the picture's program while its scene is being packed, unless the scene may become part of its
/// text. Where buffers turn out too large for the fastest reads, another one is built later.
std::optional<Phase> buildAhead(ProgramCache& programs, ShaderVariant variant, const LoadedScene& loaded,
                                const RenderOptions& options, const Context& context,
                                const TexturePlan& textures) {
  const bool asked = options.device.traversal == TraversalMethod::Literals;
  const bool large = loaded.scene.triangles.size() > kLeastBesideLarge;
  if (asked || !large) return std::nullopt;
  GpuScene unknown;
  unknown.textures = textures;
  const BufferReads reads =
      chooseReads(options.device.bufferReads, context.software, unknown, readLimits()).reads;
  settleVariant(variant, loaded, unknown, options, context, reads);
  return buildProgram(programs, variant);
}

}  // namespace

Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats, std::optional<ProgramCache> programs) {
  return makeTracer(context, loaded, options, stats,
                    TracerExtras{.hash = keepsCheckpoint(options) || holdsLayers(options)},
                    std::move(programs));
}

Tracer makeTracer(const Context& context, const LoadedScene& loaded, const RenderOptions& options,
                  Statistics& stats, TracerExtras extras, std::optional<ProgramCache> before) {
  Tracer tracer;
  const ShaderVariant everything = chooseVariants(tracer, loaded, options, stats);
  SceneTextures textures;
  const TexelMemory memory =
      prepareTextures(tracer, loaded, everything, options, context, textures, extras.levels, stats);
  ProgramCache programs =
      before ? std::move(*before) : ProgramCache(shaderSource(options.device.shaderFolder));
  Phase packing;  // outlives the thread that sets it
  std::future<GpuScene> packedLater = std::async(kThreadIfGranted, [&] {
    PhaseTimer timer("pack", "second");
    GpuScene scene = packScene(loaded.scene, loaded.bvh, loaded.environment, everything, tracer.textures,
                               &tracer.kept, loaded.decoding, memory);
    packing = timer.end();
    return scene;
  });
  const std::optional<Phase> ahead =
      buildAhead(programs, tracer.variant, loaded, options, context, tracer.textures);
  GpuScene packed = packedLater.get();
  sayBroken(options, packed, stats);
  describe(stats, context, packed, packing);
  if (extras.hash) tracer.sceneHash = sceneHash(packed, tracer.arrayHashes);
  const ReadChoice choice = chooseReads(options.device.bufferReads, context.software, packed, readLimits());
  tracer.reads = choice.reads;
  stats.readFallback = choice.fallback;
  settleVariants(tracer, loaded, packed, options, context, stats);
  keepForLightGroups(tracer, packed, options);
  const Phase building = ahead ? *ahead : buildProgram(programs, tracer.variant);
  stats.phases.push_back(building);
  tracer.programMs = building.end - building.begin;
  stats.compileMs += tracer.programMs;
  PhaseTimer uploading("upload");
  tracer.renderer = std::make_unique<Renderer>(context, std::move(packed), choice.reads, std::move(programs),
                                               std::move(textures));
  stats.phases.push_back(uploading.end());
  stats.uploadMs = stats.phases.back().end - stats.phases.back().begin;
  return tracer;
}

void replaceScene(Tracer& tracer, const Context& context, const LoadedScene& loaded,
                  const RenderOptions& options, Statistics& stats, bool surfacesAlone) {
  const ShaderVariant everything = chooseVariants(tracer, loaded, options, stats);
  PhaseTimer timer("pack");
  TexelMemory memory;
  if (!holdsTextures(tracer.textures, loaded.scene, everything.traits))
    memory = prepareTextures(tracer, loaded, everything, options, context, tracer.renderer->textures(),
                             tracer.textures.levels == MipLevels::Later, stats);
  tracer.kept.geometry = surfacesAlone;
  GpuScene packed = packScene(loaded.scene, loaded.bvh, loaded.environment, everything, tracer.textures,
                              &tracer.kept, loaded.decoding, memory);
  tracer.kept.geometry = false;
  sayBroken(options, packed, stats);
  describe(stats, context, packed, timer.end());
  const ArrayHashes before = tracer.arrayHashes;
  if (tracer.sceneHash != 0) {
    tracer.sceneHash = sceneHash(packed, tracer.arrayHashes);
    for (size_t i = 0; i < packed.unchanged.size(); ++i)
      packed.unchanged[i] = packed.unchanged[i] || before[i] == tracer.arrayHashes[i];
  }
  settleVariants(tracer, loaded, packed, options, context, stats);
  keepForLightGroups(tracer, packed, options);
  PhaseTimer uploading("upload");
  tracer.renderer->replaceScene(std::move(packed));
  stats.phases.push_back(uploading.end());
  stats.uploadMs = stats.phases.back().end - stats.phases.back().begin;
}

void replaceSurroundings(Tracer& tracer, const LoadedScene& loaded) {
  ShaderVariant everything = tracer.variant;
  for (const ShaderVariant& aov : tracer.aovs) everything.traits |= aov.traits;
  tracer.renderer->replaceSurroundings(
      packSurroundings(loaded.bvh, loaded.environment, everything, tracer.kept));
}

namespace {

/// The bytes per pixel of the film: three images on the device, a copy of them, and the pixels made from it,
/// as measured at 16384 x 2000. Layers need one more film, adaptive pictures two, which are joined.
uint64_t bytesOfFilm(const RenderOptions& options) {
  constexpr uint64_t kOne = 48 + 48 + sizeof(FilmPixel);
  constexpr uint64_t kWithLayers = kOne + 48 + sizeof(FilmPixel);
  constexpr uint64_t kAdaptive = kOne + 96 + 2 * sizeof(FilmPixel) + 2 * sizeof(double);
  if (isAdaptive(options)) return kAdaptive;
  constexpr uint64_t kMattes = 64;  // the numbers that are counted for a pixel
  if (std::ranges::any_of(options.output.aovs, isMatte)) return kWithLayers + kMattes;
  return options.output.aovs.empty() && options.output.lightGroups.empty() ? kOne : kWithLayers;
}

/// Bytes that filtering takes for a pixel: textures and the sources of two of them, earlier copies of the
/// film, the picture with its layers twice, and the colours.
uint64_t bytesOfFilter(const RenderOptions& options) {
  constexpr uint64_t kDenoised = 7 * 16 + 20 + 20 + 2 * sizeof(FilmPixel) + 8 + 2 * 14 * 4 + 12;
  return options.output.denoise == Denoise::None ? 0 : kDenoised;
}

/// A pixel of a picture that is drawn in parts: the picture, and what encoding makes of it.
uint64_t bytesOfPicture(const RenderOptions& options) { return 4 * sizeof(float) * channelsOf(options); }

uint64_t pixelsOf(glm::ivec2 size) { return uint64_t(size.x) * uint64_t(size.y); }

[[noreturn]] void refuse(glm::ivec2 size, uint64_t limit, uint64_t bytes, const char* how) {
  try {
    MemoryBudget(limit).take(bytes);
    throw std::logic_error("there is memory enough");
  } catch (const std::runtime_error& error) {
    throw UsageError("a picture of " + std::to_string(size.x) + " x " + std::to_string(size.y) + " pixels" +
                     how + " " + error.what());
  }
}

}  // namespace

size_t channelsOf(const RenderOptions& options) {
  size_t channels = 3 + size_t(keepsAlpha(options)) + size_t(options.output.aovSamples) +
                    size_t(options.output.aovVariance);
  for (const Aov aov : options.output.aovs)
    channels += aov == Aov::Guides ? kGuideChannels.size() + 1
                : isMatte(aov)     ? size_t(2 * kMatteRanks)
                                   : rowOf(aov).channels.size();
  channels += 3 * options.output.lightGroups.size();
  if (options.output.denoise != Denoise::None) channels += 3;  // the noisy picture
  return channels;
}

void checkFilmMemory(const RenderOptions& options, glm::ivec2 size) {
  const uint64_t bytes = pixelsOf(size) * (bytesOfFilm(options) + bytesOfFilter(options));
  if (bytes > options.limits.memoryBytes) refuse(size, options.limits.memoryBytes, bytes, "");
}

uint64_t mostFilmPixels(const RenderOptions& options, glm::ivec2 size) {
  constexpr uint64_t kSmall = 1 << 16;
  const uint64_t pixels = pixelsOf(size);
  const uint64_t limit = options.limits.memoryBytes;
  const uint64_t film = bytesOfFilm(options);
  const uint64_t filter = bytesOfFilter(options);
  if (pixels * (film + filter) <= limit) return pixels;
  const uint64_t picture = pixels * (bytesOfPicture(options) + filter);
  const uint64_t left = picture < limit ? (limit - picture) / film : 0;
  if (left >= std::min(pixels, kSmall)) return left;
  refuse(size, limit, picture + std::min(pixels, kSmall) * film, ", drawn in parts,");
}

}  // namespace fragtrace
